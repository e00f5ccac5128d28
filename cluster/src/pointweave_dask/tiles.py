"""Scans of any size to a tileset: count, plan, sort, measure, density, make, level, mesh, finish.

Each step is `pointweave tiles STEP` in a folder of its own. What it needs comes from the store, and what it makes goes
there. `work/plan.json` says what needs what.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from distributed import Client

from . import npm
from .cells import Box, neighbours, sampled, surroundings
from .errors import PointweaveError
from .graph import Job, Progress, run
from .options import Flags, flags_of
from .scans import Scan, bring, scans_in
from .scratch import scratch
from .store import ASIDE, StorageOptions, Store

WORK = "work"
INPUTS = f"{WORK}/inputs.json"
PLAN = f"{WORK}/plan.json"
DENSITY = f"{WORK}/density.json"
TILESET, MANIFEST = "tileset.json", "manifest.json"


def tiles(
    client: Client,
    inputs: str | Iterable[str],
    output: str,
    *,
    resume: bool = False,
    keep_work: bool = False,
    retries: int = 3,
    storage_options: StorageOptions | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> dict[str, Any]:
    """Makes a tileset of scans, and returns its ``manifest.json``.

    ``inputs`` are URLs of files, folders and patterns, ``output`` is the URL of a folder. ``options`` are those of
    ``pointweave tiles``: ``spacing=0.05``, ``tile_points=1_000_000``.

    ``resume`` goes on with what an earlier run of the same scans with the same options left. ``keep_work`` leaves the folder
    ``work``. ``retries`` is how often a task is tried again. ``storage_options`` are fsspec's, by protocol.

    Raises `PointweaveError`. What was done until then is in the store.
    """
    storage = storage_options or {}
    flags = flags_of("tiles", "out", options)
    scans = scans_in(inputs, storage)
    store = Store.at(output, storage)
    there = store.files()
    if {TILESET, MANIFEST} <= there and not any(map(_is_work, there)):
        if not resume:
            raise PointweaveError("usage", f"'{output}' has a tileset: remove it, or choose another folder")
        return _manifest(store)
    counts = [f"{WORK}/counts/{k}.json" for k in range(len(scans))]
    _begin(store, there, resume, flags, scans, counts)

    counting = [
        Job("count", f"{k} {scan.name}", _count, (store, counts[k], k, scan, flags), alone=True)
        for k, scan in enumerate(scans)
        if counts[k] not in there
    ]
    _check(run(client, counting, retries, progress))
    if PLAN not in there:
        run(client, [Job("plan", "all", _plan, (store, counts, scans, flags))], retries, progress)
    run(client, _jobs(store, scans, there), retries, progress)
    manifest = _manifest(store)
    for ours in [ASIDE] if keep_work else [ASIDE, WORK]:
        store.remove(ours)
    return manifest


def _is_work(path: str) -> bool:
    return path.startswith(f"{WORK}/")


def _begin(store: Store, there: set[str], resume: bool, flags: Flags, scans: list[Scan], counts: list[str]) -> None:
    """Writes down what is made of what, as `pointweave tiles` does. The work of something else is not gone on with."""
    sizes = [scan.bytes for scan in scans]
    run = {"flags": flags.words, "urls": [scan.url for scan in scans], "bytes": sizes}
    if any(map(_is_work, there)):
        remedy = f"remove {store.url}/{WORK}"
        if not resume:
            raise PointweaveError("usage", f"'{store.url}' has the work of an earlier run: --resume goes on with it, or {remedy}")
        known = store.json(INPUTS) if INPUTS in there else {}
        if {**known, "bytes": sizes} != run or (PLAN in there and known != run):
            raise PointweaveError("usage", f"'{store.url}' has the work of other scans or options: {remedy}")
        for path, before, now in zip(counts, known["bytes"], sizes, strict=True):
            if before != now and path in there:  # a scan that was mended
                store.remove(path)
                there.discard(path)
    store.write(INPUTS, json.dumps(run))


def _manifest(store: Store) -> dict[str, Any]:
    manifest: dict[str, Any] = store.json(MANIFEST)
    return manifest


def _check(counted: dict[tuple[str, str], Any]) -> None:
    """All inputs that cannot be read are told at once, each in one line."""
    failures = [error for error in counted.values() if isinstance(error, PointweaveError)]
    if failures:
        raise PointweaveError(failures[0].code, "\n".join(sorted(error.message for error in failures)))


def _jobs(store: Store, scans: list[Scan], there: set[str]) -> list[Job]:
    """The plan's tasks that are not done. One waits for those whose files it needs."""
    makers: dict[str, tuple[str, str]] = {}
    jobs = []
    for task in store.json(PLAN)["tasks"]:
        if task["makes"][-1] in there:
            continue
        scan = scans[task["input"]] if "input" in task else None
        needs = {makers[path] for path in task["needs"] if path in makers}
        job = Job(task["stage"], task.get("tile", "all"), _step, (store, task, scan), tuple(sorted(needs)))
        makers.update((path, job.key) for path in task["makes"])
        jobs.append(job)
    return jobs


def _count(store: Store, made: str, k: int, scan: Scan, flags: Flags) -> None:
    if store.has(made):
        return
    with scratch() as folder:
        bring(scan, store.options, folder / "in")
        _tiles(folder, "count", f"--tile={k}", *flags.words, scan.name)
        store.put([made], folder / "out")


def _plan(store: Store, counts: list[str], scans: list[Scan], flags: Flags) -> None:
    with scratch() as folder:
        store.fetch(counts, folder / "out")
        _tiles(folder, "plan", *flags.words, *(scan.name for scan in scans))
        store.put([PLAN], folder / "out")


def _step(store: Store, task: dict[str, Any], scan: Scan | None) -> None:
    """One task of the plan. Done once more, it makes the same bytes; so it does nothing where they are."""
    if store.has(task["makes"][-1]):
        return
    with scratch() as folder:
        _bring_needs(store, task, folder / "out")
        tile = [f"--tile={task['tile']}"] if "tile" in task else []
        given = [f"--input={scan.name}"] if scan is not None else []
        if scan is not None:
            bring(scan, store.options, folder / "in")
        _tiles(folder, task["stage"], *tile, *given)
        store.put(task["makes"], folder / "out")


def _bring_needs(store: Store, task: dict[str, Any], folder: Path) -> None:
    """What a task needs: of its neighbours' sorted points those that are near."""
    around = neighbours(task)
    store.fetch([path for path in task["needs"] if path not in around], folder)
    if not around:
        return
    store.fetch_cells(around, _near(task, folder), folder)


def _near(task: dict[str, Any], folder: Path) -> Box:
    if task["stage"] == "measure":
        return sampled(task["tile"])
    octree = json.loads((folder / PLAN).read_text(encoding="utf-8"))["octree"]
    reach = json.loads((folder / DENSITY).read_text(encoding="utf-8"))["reach"]
    return surroundings(task["tile"], octree["size"], reach)


def _tiles(folder: Path, *arguments: str) -> None:
    """Started beside the scans, so that its messages have their names and not those of a scratch folder."""
    beside = folder / "in"
    beside.mkdir(exist_ok=True)
    npm.pointweave(["tiles", *arguments, "-o", "../out"], beside)
