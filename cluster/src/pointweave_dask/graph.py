"""Runs jobs on a Dask cluster in the order of what they need, tries them again, and says how far they are."""

from __future__ import annotations

import uuid
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from dataclasses import dataclass
from typing import Any

from distributed import Client, Future, KilledWorker, as_completed

from . import npm
from .errors import PointweaveError

#: Called with a stage, how many of its jobs are done, and how many it has.
Progress = Callable[[str, int, int], None]

#: Errors that every other job would have, too.
_OF_THE_CLUSTER = {"cancelled", "version", "no-node", "no-package"}


@dataclass(frozen=True)
class Job:
    """A call on some worker. Its stage and name are what the dashboard shows."""

    stage: str
    name: str
    call: Callable[..., Any]
    arguments: tuple[Any, ...]
    #: Keys of the jobs that have to be done before.
    needs: tuple[tuple[str, str], ...] = ()
    #: Where it fails the others go on, and its result is the error.
    alone: bool = False

    @property
    def key(self) -> tuple[str, str]:
        return (self.stage, self.name)


def run(client: Client, jobs: Sequence[Job], retries: int, progress: Progress | None) -> dict[tuple[str, str], Any]:
    """Runs all jobs and gives what they returned, by key. A job stands behind those that it needs.

    The first error that stays after all retries ends the run: what was not begun is dropped, what is done is in the store.
    """
    run_id = uuid.uuid4().hex[:8]
    futures: dict[tuple[str, str], Future] = {}
    for job in jobs:
        before = [futures[key] for key in job.needs]
        key = (*job.key, run_id)
        futures[job.key] = client.submit(_call, npm.version(), job, before, key=key, retries=retries, pure=False)
    try:
        return dict(_finished(client, jobs, futures, progress))
    finally:
        client.cancel(list(futures.values()))


def _finished(
    client: Client, jobs: Sequence[Job], futures: dict[tuple[str, str], Future], progress: Progress | None
) -> Iterator[tuple[tuple[str, str], Any]]:
    """Jobs and what they returned, as they end."""
    by_future = {futures[job.key].key: job for job in jobs}
    totals, done = Counter(job.stage for job in jobs), Counter[str]()
    for future in as_completed(futures.values(), loop=client.loop):
        job = by_future[future.key]
        try:
            result = future.result()
        except Exception as error:
            result = _explained(error)
            if not job.alone or result.code in _OF_THE_CLUSTER:
                raise PointweaveError(result.code, f"{job.stage} {job.name}: {result.message}") from error
        done[job.stage] += 1
        if progress is not None:
            progress(job.stage, done[job.stage], totals[job.stage])
        yield job.key, result


def _call(version: str, job: Job, _before: list[None]) -> Any:
    """On the worker. The jobs before hand over nothing: their results are in the store."""
    if npm.version() != version:
        message = f"a worker has pointweave {npm.version()} and the client {version}: install the same everywhere"
        raise PointweaveError("version", message)
    try:
        return job.call(*job.arguments)
    except PointweaveError as error:
        if job.alone and error.code in ("failed", "usage"):
            return error  # the scan's own fault: not tried again
        raise


def _explained(error: Exception) -> PointweaveError:
    """What Dask and fsspec raise, as one of ours. An error of another kind is a defect, and stays."""
    if isinstance(error, PointweaveError):
        return error
    if isinstance(error, KilledWorker):
        return PointweaveError("worker-lost", "its worker died again and again, most often for want of memory")
    if isinstance(error, CancelledError):
        return PointweaveError("cancelled", "the scheduler dropped it, or is gone")
    if isinstance(error, ImportError) or "different environments" in str(error):
        message = "the scheduler or a worker has no pointweave-dask, or another Dask: install the same everywhere"
        return PointweaveError("version", message)
    if isinstance(error, OSError):
        return PointweaveError("store", str(error))
    raise error
