#!/usr/bin/env bash
# bash slurm.sh OUT "OPTIONS" INPUT…
set -euo pipefail
mkdir -p "$1/work/slurm"
out=$(realpath "$1") options=$2
lists=$out/work/slurm
inputs=("${@:3}")

# A job array that does a command for each line of a list. In it, $line is the line and $k its number, from 0.
each() { # NAME COMMAND
  local list=$lists/$1 tasks
  tasks=$(wc -l < "$list")
  tasks=$((tasks < 500 ? tasks : 500))
  sbatch --wait --job-name="$1" --cpus-per-task=1 --mem=3G --array="0-$((tasks - 1))" --output="$lists/%x-%a.log" << EOF
#!/usr/bin/env bash
set -euo pipefail
mapfile -t lines < '$list'
for ((k = SLURM_ARRAY_TASK_ID; k < \${#lines[@]}; k += $tasks)); do
  line=\${lines[k]}
  $2
done
EOF
}
tiles_of() { pointweave tiles list -o "$out" --stage "$1"; }

printf '%s\n' "${inputs[@]}" | xargs -d '\n' realpath > "$lists/count"
each count "pointweave tiles count -o '$out' --tile \$k $options \"\$line\""
xargs -d '\n' pointweave tiles plan -o "$out" $options < "$lists/count"
for stage in sort measure; do
  tiles_of $stage > "$lists/$stage"
  each $stage "pointweave tiles $stage -o '$out' --tile \$line"
done
pointweave tiles density -o "$out"
tiles_of make > "$lists/make"
each make "pointweave tiles make -o '$out' --tile \$line"
# The deepest first: a level is made of the one below it.
for depth in $(tiles_of level | cut -d- -f1 | sort -nru); do
  tiles_of level | grep "^$depth-" > "$lists/level"
  each level "pointweave tiles level -o '$out' --tile \$line"
done
# With --mesh alone there are any.
tiles_of mesh > "$lists/mesh"
[ ! -s "$lists/mesh" ] || each mesh "pointweave tiles mesh -o '$out' --tile \$line"
pointweave tiles finish -o "$out"
rm -r "$out/work"
