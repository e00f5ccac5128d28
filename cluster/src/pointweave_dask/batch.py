"""Many scans, each reduced on its own."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import PurePosixPath
from typing import Any

from distributed import Client

from . import npm
from .errors import PointweaveError
from .graph import Job, Progress, run
from .options import Flags, flags_of
from .scans import Scan, bring, scans_in
from .scratch import scratch
from .store import ASIDE, StorageOptions, Store


def reduce_many(
    client: Client,
    inputs: str | Iterable[str],
    output: str,
    *,
    format: str = "ply",
    resume: bool = False,
    retries: int = 3,
    storage_options: StorageOptions | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> list[dict[str, Any]]:
    """Reduces each scan to a file of its name in the folder ``output``, with its report beside it.

    Returns one entry a scan, in their order: ``input``, and ``output`` and ``report``, or ``error`` with ``code`` and
    ``message``. A scan that cannot be read stops no other. ``options`` are those of ``pointweave reduce``: ``ratio=0.2``.

    ``resume`` leaves results that are there. The other arguments are those of `tiles`.
    """
    storage = storage_options or {}
    flags = flags_of("reduce", f"out.{format}", options)
    scans = scans_in(inputs, storage)
    store = Store.at(output, storage)
    jobs = [
        Job("reduce", result, _reduce, (store, scan, result, flags, resume), alone=True)
        for result, scan in _results(scans, format).items()
    ]
    done = run(client, jobs, retries, progress)
    store.remove(ASIDE)
    return [_entry(scan, job.name, done[job.key]) for scan, job in zip(scans, jobs, strict=True)]


def _results(scans: list[Scan], format: str) -> dict[str, Scan]:
    """Scans by the names of their results. Two that would become one file are refused."""
    results: dict[str, Scan] = {}
    for scan in scans:
        result = str(PurePosixPath(scan.name).with_suffix(f".{format}"))
        if result in results:
            raise PointweaveError("usage", f"'{results[result].url}' and '{scan.url}' would both become '{result}'")
        results[result] = scan
    return results


def _reduce(store: Store, scan: Scan, result: str, flags: Flags, resume: bool) -> Any:
    report = f"{result}.json"
    if resume and store.has(result):
        return store.json(report)
    with scratch() as folder:
        bring(scan, store.options, folder / "in")
        made = folder / "out" / result
        made.parent.mkdir(parents=True)
        words = [scan.name, f"--out={made}", "--json", "--threads=1", *flags.laid(folder / "in")]
        told = npm.pointweave(["reduce", *words], folder / "in")
        (folder / "out" / report).write_text(told, encoding="utf-8")
        store.put([report, result], folder / "out")
    return json.loads(told)


def _entry(scan: Scan, result: str, done: Any) -> dict[str, Any]:
    if isinstance(done, PointweaveError):
        message = done.message.removeprefix(f"{scan.name}: ")
        return {"input": scan.url, "error": {"code": done.code, "message": message}}
    return {"input": scan.url, "output": result, "report": done}
