"""Batches: each scan gets what the plain command line makes of it, and a bad one stops no other."""

from __future__ import annotations

import json
import random
import re
from pathlib import Path

import pytest
from conftest import contents
from distributed import Client

from pointweave_dask import PointweaveError, catalogue, npm, reduce_many


@pytest.fixture(scope="module")
def shelf(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two balls whose names become the same word, a scan that is damaged, and a file that is no scan."""
    folder = tmp_path_factory.mktemp("shelf")
    chance = random.Random(2)
    for place in ("deep/ball.xyz", "deep-ball.xyz"):
        points = [[chance.gauss(0, 1) for _ in range(3)] for _ in range(400)]
        lengths = [sum(x * x for x in point) ** 0.5 for point in points]
        lines = [" ".join(f"{x / length:.5f}" for x in point) for point, length in zip(points, lengths, strict=True)]
        (folder / place).parent.mkdir(exist_ok=True)
        (folder / place).write_text("\n".join(lines) + "\n")
    (folder / "bad.ply").write_text("garbage\n")
    (folder / "notes.md").write_text("no scan\n")
    return folder


def test_reduced_as_by_the_plain_command_line(client: Client, shelf: Path, tmp_path: Path) -> None:
    entries = reduce_many(client, str(shelf), str(tmp_path / "out"), format="xyz", ratio=0.2)
    assert [entry["input"].removeprefix(f"{shelf}/") for entry in entries] == ["bad.ply", "deep-ball.xyz", "deep/ball.xyz"]
    assert entries[0]["error"]["code"] == "failed"
    assert entries[0]["error"]["message"].startswith("bad PLY file")
    for entry in entries[1:]:
        alone = tmp_path / "alone.xyz"
        npm.pointweave(["reduce", entry["input"], "-o", str(alone), "--ratio=0.2"])
        assert (tmp_path / "out" / entry["output"]).read_bytes() == alone.read_bytes()
        assert entry["report"]["outputPoints"] == 80

    again = reduce_many(client, str(shelf), str(tmp_path / "out"), format="xyz", ratio=0.2, resume=True)
    assert again == entries  # reports and their times are those of before


def test_two_scans_for_one_result_are_refused(client: Client, shelf: Path, tmp_path: Path) -> None:
    inputs = [str(shelf / "deep"), str(shelf / "deep/ball.xyz")]
    with pytest.raises(PointweaveError, match=r"would both become 'ball\.ply'") as caught:
        reduce_many(client, inputs, str(tmp_path))
    assert caught.value.code == "usage"


def test_a_catalogue_as_by_the_plain_command_line(client: Client, shelf: Path, tmp_path: Path) -> None:
    with pytest.raises(PointweaveError):
        npm.pointweave(
            ["catalogue", str(shelf), "-o", str(tmp_path / "plain"), "--triangles=200", "--texture=64", "--threads=1", "--jobs=2"]
        )
    site = tmp_path / "site"
    entries = catalogue(client, str(shelf), str(site), triangles=200, texture=64)
    assert [entry["name"] for entry in entries] == ["bad", "deep-ball", "deep-ball-xyz"]
    assert untimed(contents(site)) == untimed(contents(tmp_path / "plain"))
    assert not (site / ".pointweave").exists()

    # Another's folder that only looks like one of ours is not touched.
    manifest = json.loads((site / "catalogue.json").read_text())
    (site / "catalogue.json").write_text(json.dumps([*manifest, {"name": "../plain", "key": "1"}]))

    before = {path: path.stat().st_mtime_ns for path in site.glob("*/*")}
    (shelf / "deep/ball.xyz").rename(tmp_path / "ball.xyz")
    assert catalogue(client, str(shelf), str(site), triangles=200, texture=64) == entries[:2]
    assert {path: path.stat().st_mtime_ns for path in site.glob("*/*")} == {
        path: time for path, time in before.items() if path.parent.name != "deep-ball-xyz"
    }
    assert (tmp_path / "plain").exists()


def untimed(files: dict[str, bytes]) -> dict[str, bytes]:
    """Without the seconds that reports and pages tell."""
    times = rb'"(seconds|totalMs|peakMemoryBytes)": [\d.e-]+|[\d.]+ s\b|"ms": \{[^}]*\}'
    return {name: re.sub(times, b"", data) if name.endswith((".json", ".html")) else data for name, data in files.items()}
