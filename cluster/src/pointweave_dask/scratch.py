"""A folder for one task, gone with it."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from distributed import get_worker


@contextmanager
def scratch() -> Iterator[Path]:
    """In the worker's local directory: Dask cleans up what killed workers left there."""
    with tempfile.TemporaryDirectory(prefix="pointweave-", dir=get_worker().local_directory) as folder:
        yield Path(folder)
