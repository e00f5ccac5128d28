"""A folder of scans as a web page of light models, each scan on its own worker."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from pathlib import Path, PurePosixPath
from typing import Any

from distributed import Client

from . import npm
from .errors import PointweaveError
from .graph import Job, Progress, run
from .options import Flags, flags_of
from .scans import Scan, bring, scans_in
from .scratch import scratch
from .store import ASIDE, StorageOptions, Store

MANIFEST = "catalogue.json"
ENTRIES = f"{ASIDE}/entries"
#: What `pointweave catalogue` calls a folder of its own.
_NAME = re.compile("[a-z0-9]+(-[a-z0-9]+)*")


def catalogue(
    client: Client,
    inputs: str | Iterable[str],
    output: str,
    *,
    title: str = "Catalogue",
    retries: int = 3,
    storage_options: StorageOptions | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> list[dict[str, Any]]:
    """Makes the site that ``pointweave catalogue`` makes, in the folder ``output``, and returns its ``catalogue.json``.

    Each entry has ``name``, ``source``, ``key``, and ``made`` or ``error`` with ``code`` and ``message``. A scan that cannot be
    read stops no other. What an earlier run made of the same bytes with the same options stays, also of a run that was killed.
    ``options`` are those of ``pointweave catalogue``: ``triangles=5000``. The other arguments are those of `tiles`.
    """
    storage = storage_options or {}
    flags = flags_of("catalogue", "out", {"title": title, **options})
    scans = scans_in(inputs, storage)
    names = npm.ask("names", [scan.name for scan in scans])
    store = Store.at(output, storage)
    known = _known(store)
    jobs = [
        Job("catalogue", name, _make, (store, scan, name, flags, known.get(name)), alone=True)
        for name, scan in zip(names, scans, strict=True)
    ]
    done = run(client, jobs, retries, progress)
    entries = [_entry(scan, job.name, done[job.key]) for scan, job in zip(scans, jobs, strict=True)]
    _pages(store, title, entries)
    for gone in [*(known.keys() - set(names)), ASIDE]:
        store.remove(gone)
    return entries


def _known(store: Store) -> dict[str, dict[str, Any]]:
    """What earlier runs made, by name: those that ended, and one that did not. Whose files are not all there is made anew."""
    there = store.files()
    manifests = [MANIFEST] if MANIFEST in there else []
    unfinished = sorted(path for path in there if path.startswith(f"{ENTRIES}/"))
    entries = [entry for path in [*manifests, *unfinished] for entry in _entries(store, path)]
    known = {entry["name"]: entry for entry in entries if _NAME.fullmatch(entry["name"])}
    return {name: entry for name, entry in known.items() if there.issuperset(_files(entry))}


def _entries(store: Store, path: str) -> list[dict[str, Any]]:
    """Of a file that another run wrote; one that is damaged holds none."""
    try:
        entries: list[dict[str, Any]] = store.json(path)
        return [entry for entry in entries if entry["key"]]
    except (ValueError, TypeError, KeyError):
        return []


def _make(store: Store, scan: Scan, name: str, flags: Flags, known: dict[str, Any] | None) -> dict[str, Any]:
    """One scan as a site of its own. The command line itself says whether what is known of it still holds."""
    own = npm.ask("names", [PurePosixPath(scan.name).name])[0]  # its folder where it is the only scan
    with scratch() as folder:
        site = folder / "out"
        site.mkdir()
        if known is not None:
            store.fetch(_files(known), site)
            _rename(site, name, own)
            (site / MANIFEST).write_text(json.dumps([{**known, "name": own}]), encoding="utf-8")
        bring(scan, store.options, folder / "in")
        try:
            npm.pointweave(["catalogue", scan.name, "-o", "../out", "--threads=1", *flags.laid(folder / "in")], folder / "in")
        except PointweaveError as error:
            if error.code != "failed" or not (site / MANIFEST).exists():
                raise
        told = json.loads((site / MANIFEST).read_text(encoding="utf-8"))[0]
        entry: dict[str, Any] = {**told, "name": name, "source": scan.name}
        if entry == known:
            return entry
        _rename(site, own, name)
        path = f"{ENTRIES}/{name}.json"
        (site / path).parent.mkdir(parents=True)
        (site / path).write_text(json.dumps([entry]), encoding="utf-8")
        store.put([*_files(entry), path], site)
        for stale in set(_files(known) if known else []) - set(_files(entry)):
            store.remove(stale)
        return entry


def _files(entry: dict[str, Any]) -> list[str]:
    return [f"{entry['name']}/{file}" for file in entry.get("made", {}).get("files", [])]


def _rename(site: Path, before: str, after: str) -> None:
    if (site / before).exists():
        (site / before).rename(site / after)


def _entry(scan: Scan, name: str, done: Any) -> dict[str, Any]:
    """Without a key, so that the next run tries again, where the scan's worker died or its file did not come."""
    if isinstance(done, PointweaveError):
        return {"name": name, "source": scan.name, "key": "", "error": {"code": done.code, "message": done.message}}
    entry: dict[str, Any] = done
    return entry


def _pages(store: Store, title: str, entries: list[dict[str, Any]]) -> None:
    element = npm.package() / "element.min.js"
    pages = {element.name: element.read_text(encoding="utf-8"), **npm.ask("pages", title, entries)}
    for name, text in pages.items():
        store.write(name, text)
