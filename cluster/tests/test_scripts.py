"""The steps as plain commands, by GNU parallel or xargs."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

from conftest import OPTIONS, contents

from pointweave_dask import npm

SCRIPT = Path(__file__).parents[1] / "scripts" / "parallel.sh"


def test_the_same_bytes_by_plain_commands(scans: Path, plain: dict[str, bytes], tmp_path: Path) -> None:
    command = tmp_path / "bin" / "pointweave"
    command.parent.mkdir()
    command.write_text(f'#!/bin/sh\nexec {npm.node()} {npm.package() / "cli.js"} "$@"\n')
    command.chmod(0o755)
    options = " ".join(f"--{name.replace('_', '-')}={value}" for name, value in OPTIONS.items())
    inputs = [str(path) for path in sorted(scans.iterdir())]
    environment = {**os.environ, "PATH": f"{command.parent}:{os.environ['PATH']}"}
    subprocess.run(["bash", SCRIPT, tmp_path / "out", options, *inputs], env=environment, check=True, stdin=subprocess.DEVNULL)
    assert contents(tmp_path / "out") == plain
