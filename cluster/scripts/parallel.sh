#!/usr/bin/env bash
# bash parallel.sh OUT "OPTIONS" INPUT…
set -euo pipefail
out=$1 options=$2
inputs=("${@:3}")

# Does a command for each line, with {} as the line, as many at a time as there are cores.
each() {
  if command -v parallel > /dev/null; then
    parallel --quote --halt soon,fail=1 --retries 3 "$@"
  else
    xargs -P "$(nproc)" -I '{}' "$@"
  fi
}
tiles_of() { pointweave tiles list -o "$out" --stage "$1"; }

mkdir -p "$out/work"
printf '%s\n' "${inputs[@]}" > "$out/work/list"
seq "${#inputs[@]}" | each bash -c 'pointweave tiles count -o "$0" --tile "$(({} - 1))" $1 "$(sed -n {}p "$0/work/list")"' "$out" "$options"
pointweave tiles plan -o "$out" $options "${inputs[@]}"
for stage in sort measure; do
  tiles_of $stage | each pointweave tiles $stage -o "$out" --tile '{}'
done
pointweave tiles density -o "$out"
tiles_of make | each pointweave tiles make -o "$out" --tile '{}'
# The deepest first: a level is made of the one below it.
for depth in $(tiles_of level | cut -d- -f1 | sort -nru); do
  tiles_of level | grep "^$depth-" | each pointweave tiles level -o "$out" --tile '{}'
done
# With --mesh alone there are any.
tiles_of mesh | each pointweave tiles mesh -o "$out" --tile '{}'
pointweave tiles finish -o "$out"
rm -r "$out/work"
