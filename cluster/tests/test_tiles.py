"""A tileset from a cluster has the bytes of that from the plain command line, whatever happens on the way."""

from __future__ import annotations

import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from conftest import OPTIONS, contents
from distributed import Client, LocalCluster
from faults import FailTwice, Kill

from pointweave_dask import PointweaveError, tiles

STAGES = {"count", "plan", "sort", "measure", "density", "make", "level", "finish"}


def test_same_bytes_and_progress(client: Client, scans: Path, plain: dict[str, bytes], tmp_path: Path) -> None:
    told: list[tuple[str, int, int]] = []
    manifest = tiles(client, str(scans), str(tmp_path), progress=lambda *line: told.append(line), **OPTIONS)
    assert contents(tmp_path) == plain
    assert manifest["points"] == 1350
    assert not (tmp_path / "work").exists()
    assert {stage for stage, *_ in told} == STAGES
    assert ("count", 3, 3) in told


def test_a_worker_is_killed_in_each_stage(client: Client, scans: Path, plain: dict[str, bytes], tmp_path: Path) -> None:
    struck = tmp_path / "struck"
    struck.mkdir()
    client.register_plugin(Kill(struck))
    try:
        tiles(client, str(scans), str(tmp_path / "out"), **OPTIONS)
    finally:
        client.unregister_worker_plugin("kill")
    assert {path.name for path in struck.iterdir()} == STAGES
    assert contents(tmp_path / "out") == plain


def test_tasks_fail_twice(client: Client, scans: Path, plain: dict[str, bytes], tmp_path: Path) -> None:
    struck = tmp_path / "struck"
    struck.mkdir()
    client.register_plugin(FailTwice(struck))
    try:
        tiles(client, str(scans), str(tmp_path / "out"), **OPTIONS)
    finally:
        client.unregister_worker_plugin("fail-twice")
    assert len([*struck.iterdir()]) == 2 * len(STAGES)
    assert contents(tmp_path / "out") == plain


def test_every_task_is_done_twice(cluster: LocalCluster, scans: Path, plain: dict[str, bytes], tmp_path: Path) -> None:
    def work() -> None:
        with Client(cluster, set_as_default=False) as client:
            tiles(client, str(scans), str(tmp_path), resume=True, keep_work=True, **OPTIONS)

    both = [threading.Thread(target=work) for _ in range(2)]
    for one in both:
        one.start()
    for one in both:
        one.join()
    assert contents(tmp_path) == plain


def test_resume_after_the_client_was_killed(client: Client, scans: Path, plain: dict[str, bytes], tmp_path: Path) -> None:
    flags = [f"--{name.replace('_', '-')}={value}" for name, value in OPTIONS.items()]
    command = [sys.executable, "-m", "pointweave_dask.cli", "tiles", str(scans), str(tmp_path), *flags]
    running = subprocess.Popen([*command, "--scheduler", client.scheduler.address])
    until = time.monotonic() + 60
    while not (made := sorted(tmp_path.glob("points/*.glb"))) and time.monotonic() < until:
        time.sleep(0.02)
    running.kill()
    running.wait()
    before = made[0].stat().st_mtime_ns
    with pytest.raises(PointweaveError, match="has the work of an earlier run"):
        tiles(client, str(scans), str(tmp_path), **OPTIONS)
    with pytest.raises(PointweaveError, match="has the work of other scans or options"):
        tiles(client, f"{scans}/a.xyz", str(tmp_path), resume=True, **OPTIONS)
    again = subprocess.run([*command, "--scheduler", client.scheduler.address, "--resume"], capture_output=True, text=True)
    assert again.returncode == 0, again.stderr
    assert contents(tmp_path) == plain
    assert made[0].stat().st_mtime_ns == before
    assert "count" not in again.stderr
    assert tiles(client, str(scans), str(tmp_path), resume=True, **OPTIONS)["points"] == 1350  # nothing to do
    with pytest.raises(PointweaveError, match="has a tileset"):
        tiles(client, str(scans), str(tmp_path), **OPTIONS)


def test_a_bad_input_has_one_line_and_the_others_stay(
    client: Client, scans: Path, plain: dict[str, bytes], tmp_path: Path
) -> None:
    given = tmp_path / "in"
    given.mkdir()
    for path in scans.iterdir():
        (given / path.name).write_bytes(path.read_bytes())
    bad = given / "b.xyz"
    bad.write_text("no scan\n")
    with pytest.raises(PointweaveError) as caught:
        tiles(client, str(given), str(tmp_path / "out"), **OPTIONS)
    assert caught.value.code == "failed"
    assert caught.value.message.startswith("b.xyz: ")
    assert "\n" not in caught.value.message
    assert sorted(path.name for path in (tmp_path / "out/work/counts").iterdir()) == ["0.json", "2.json"]

    class Enough(Exception):
        """Ends a run: the rest of it is what other tests see."""

    def progress(*line: object) -> None:
        assert line == ("count", 1, 1)
        raise Enough

    bad.write_bytes((scans / "b.xyz").read_bytes())
    with pytest.raises(Enough):
        tiles(client, str(given), str(tmp_path / "out"), resume=True, progress=progress, **OPTIONS)
