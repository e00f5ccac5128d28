"""Scans of any size to a tileset: count, plan, sort, measure, density, make, level, finish.

Each step is `pointweave tiles STEP` in a folder of its own. What it needs comes from the store, and what it makes goes
there. `work/plan.json` says what needs what.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from distributed import Client

from . import npm
from .errors import PointweaveError
from .graph import Job, Progress, run
from .options import Flags, flags_of
from .scans import Scan, bring, scans_in
from .scratch import scratch
from .store import ASIDE, StorageOptions, Store

WORK = "work"
PLAN = f"{WORK}/plan.json"


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
    ``pointweave tiles``: ``spacing=0.05``, ``tile_points=1_000_000``, ``mesh=True``.

    ``resume`` goes on with what an earlier run left; without it, that is made anew. ``retries`` is how often a task is tried
    again. ``storage_options`` are fsspec's, by protocol.

    Raises `PointweaveError`. What was done until then is in the store.
    """
    storage = storage_options or {}
    flags = flags_of("tiles", "out", options)
    scans = sorted(scans_in(inputs, storage), key=lambda scan: scan.url)
    store = Store.at(output, storage)
    if not resume:
        store.remove(WORK)

    there = store.files() if resume else set()
    counts = {f"{WORK}/counts/{k}.json": scan for k, scan in enumerate(scans)}
    count = [
        Job("count", scan.name, _count, (store, k, scan), alone=True)
        for k, (path, scan) in enumerate(counts.items())
        if path not in there
    ]
    counted = run(client, count, retries, progress)
    failures = {name: error for (_, name), error in counted.items() if isinstance(error, PointweaveError)}
    if failures:
        lines = [f"{name}: {error.message.removeprefix(f'{name}: ')}" for name, error in sorted(failures.items())]
        raise PointweaveError(next(iter(failures.values())).code, "\n".join(lines))

    plan = Job("plan", "all", _plan, (store, list(counts), scans, flags))
    run(client, [plan], retries, progress)
    run(client, _jobs(store, scans, there), retries, progress)
    manifest: dict[str, Any] = store.json("manifest.json")
    for ours in [ASIDE] if keep_work else [ASIDE, WORK]:
        store.remove(ours)
    return manifest


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


def _count(store: Store, k: int, scan: Scan) -> None:
    made = f"{WORK}/counts/{k}.json"
    if store.has(made):
        return
    with scratch() as folder:
        bring(scan, store.options, folder / "in")
        _tiles(folder, "count", f"--tile={k}", scan.name)
        store.put([made], folder / "out")


def _plan(store: Store, counts: list[str], scans: list[Scan], flags: Flags) -> None:
    with scratch() as folder:
        store.fetch(counts, folder / "out")
        _tiles(folder, "plan", *flags.laid(folder / "in"), *(scan.name for scan in scans))
        store.put([PLAN], folder / "out")


def _step(store: Store, task: dict[str, Any], scan: Scan | None) -> None:
    """One task of the plan. Done once more, it makes the same bytes; so it does nothing where they are."""
    if store.has(task["makes"][-1]):
        return
    with scratch() as folder:
        store.fetch(task["needs"], folder / "out")
        tile = [f"--tile={task['tile']}"] if "tile" in task else []
        given = [f"--input={scan.name}"] if scan is not None else []
        if scan is not None:
            bring(scan, store.options, folder / "in")
        _tiles(folder, task["stage"], *tile, *given)
        store.put(task["makes"], folder / "out")


def _tiles(folder: Path, *arguments: str) -> None:
    """Started beside the scans, so that its messages have their names and not those of a scratch folder."""
    beside = folder / "in"
    beside.mkdir(exist_ok=True)
    npm.pointweave(["tiles", *arguments, "-o", "../out"], beside)
