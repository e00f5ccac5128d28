"""A cluster of two workers on this machine, scans, and what the plain command line makes of them."""

from __future__ import annotations

import random
from collections.abc import Iterator
from pathlib import Path

import pytest
from distributed import Client, LocalCluster

from pointweave_dask import npm

OPTIONS = {"spacing": 0.1, "tile_points": 1000}


@pytest.fixture(scope="session")
def scans(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three strips of a relief, so that tiles have points of several files."""
    folder = tmp_path_factory.mktemp("scans")
    chance = random.Random(1)
    for strip, name in enumerate("abc"):
        places = [(strip + chance.random(), 3 * chance.random()) for _ in range(450)]
        lines = [f"{x:.4f} {y:.4f} {0.2 * x * x - 0.1 * x * y:.4f}" for x, y in places]
        (folder / f"{name}.xyz").write_text("\n".join(lines) + "\n")
    return folder


@pytest.fixture(scope="session")
def plain(scans: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The tileset that `pointweave tiles` makes, by path."""
    folder = tmp_path_factory.mktemp("plain") / "tiles"
    flags = [f"--{name.replace('_', '-')}={value}" for name, value in OPTIONS.items()]
    npm.pointweave(["tiles", *sorted(path.name for path in scans.iterdir()), "-o", str(folder), *flags], scans)
    return contents(folder)


@pytest.fixture(scope="session")
def cluster() -> Iterator[LocalCluster]:
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address="127.0.0.1:0", silence_logs=60) as cluster:
        yield cluster


@pytest.fixture
def client(cluster: LocalCluster) -> Iterator[Client]:
    with Client(cluster) as client:
        yield client


def contents(folder: Path) -> dict[str, bytes]:
    """Files of a folder by path, without those of the work."""
    files = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*") if path.is_file()}
    return {name: path.read_bytes() for name, path in files.items() if not name.startswith(("work/", ".pointweave/"))}
