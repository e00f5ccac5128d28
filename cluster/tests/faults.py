"""Faults that workers are given: each strikes once for every stage, whichever worker it meets."""

from __future__ import annotations

import os
import signal
import threading
from pathlib import Path
from typing import Any

from distributed import Worker, WorkerPlugin

from pointweave_dask import PointweaveError, npm


class Fault(WorkerPlugin):
    """`folder` remembers what has struck, since a killed worker forgets."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def strikes(self, name: str) -> bool:
        try:
            (self.folder / name).touch(exist_ok=False)
        except FileExistsError:
            return False
        return True


class Kill(Fault):
    """Kills a worker while it does a task, in each stage once."""

    name = "kill"

    def transition(self, key: Any, start: str, finish: str, **_: Any) -> None:
        if finish == "executing" and self.strikes(key[0]):
            threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGKILL)).start()


class FailTwice(Fault):
    """The command line fails twice in each stage, before it works."""

    name = "fail-twice"

    def setup(self, worker: Worker) -> None:
        self.pointweave = npm.pointweave
        npm.pointweave = self.call

    def teardown(self, worker: Worker) -> None:
        npm.pointweave = self.pointweave

    def call(self, arguments: list[str], folder: Path | None = None) -> str:
        if any(self.strikes(f"{arguments[1]}-{time}") for time in (1, 2)):
            raise PointweaveError("killed", "the fault of a test")
        return self.pointweave(arguments, folder)
