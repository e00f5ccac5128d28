"""Options of Python to flags of the command line: ``tile_points=1000`` is ``--tile-points=1000``."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import npm
from .errors import PointweaveError


@dataclass(frozen=True)
class Flags:
    """Flags as they travel to workers: with the recipe of ``--prepare`` itself, since its file lies where the client is."""

    words: list[str]
    recipe: str | None

    def laid(self, folder: Path) -> list[str]:
        """The flags for a command that starts in a folder on the worker."""
        if self.recipe is None:
            return self.words
        # Beside the scans, where no scan lies.
        (folder.parent / "recipe.json").write_text(self.recipe, encoding="utf-8")
        return [*self.words, "--prepare=../recipe.json"]


def flags_of(command: str, out: str, options: dict[str, Any]) -> Flags:
    """Checked by the command line's own rules. ``False`` is ``--no-…``, ``None`` is left out, a list is repeated."""
    recipe = options.pop("prepare", None)
    words = [flag for name, value in options.items() for flag in _flags(name.replace("_", "-"), value)]
    wrong = npm.ask("check", [command, "scan.ply", "-o", out, *words, *_flags("prepare", recipe)])
    if wrong is not None:
        raise PointweaveError("usage", wrong)
    try:
        return Flags(words, recipe and Path(recipe).read_text(encoding="utf-8"))
    except OSError as error:
        raise PointweaveError("usage", f"--prepare: {error}") from None


def _flags(name: str, value: Any) -> Iterable[str]:
    if value is None:
        return []
    if isinstance(value, bool):
        return [f"--{name}" if value else f"--no-{name}"]
    values = value if isinstance(value, (list, tuple)) else [value]
    return [f"--{name}={one}" for one in values]
