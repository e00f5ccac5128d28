"""Sorted points of a tile's neighbours, as far as the tile needs them: those of the cells at its border.

`pkg/tiles/cells.js` says how such a file is laid out. What is not needed of it is a hole in the local copy.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

from .errors import PointweaveError

#: Bytes from one place of a file to another.
Read = Callable[[int, int], bytes]
Box = tuple[list[float], list[float]]

_LATTICE = 2**32
_TAIL = 1 << 16
#: Blocks that are nearer than this are read at once.
_NEAR = 1 << 16


def surroundings(tile: str, size: float, reach: float) -> Box:
    """The part of the root's lattice whose points a leaf is made with. ``size`` is the root's side, in the unit of ``reach``."""
    corner, side = _cube(tile)
    around = math.floor(max(1.0, min(reach / (size / _LATTICE), side / 2)))
    return [x - around for x in corner], [x + side + around for x in corner]


def sampled(tile: str) -> Box:
    """What is measured of a leaf: it and a quarter of its side around it, as `pkg/tiles/steps.js` has it."""
    _, side = _cube(tile)
    return surroundings(tile, _LATTICE, side / 4)


def copy_cells(read: Read, size: int, tile: str, box: Box, local: Path) -> int:
    """Copies the blocks of a leaf's file that meet a box, and its index, to their places in a local file; how many bytes."""
    start = max(0, size - _TAIL)
    tail = read(start, size)
    length = int.from_bytes(tail[-4:], "little")
    if length + 4 > len(tail):
        start = max(0, size - 4 - length)
        tail = read(start, size)
    try:
        index = json.loads(tail[len(tail) - 4 - length : -4])
        spans = _spans([(begin, end) for cell, begin, end in index["blocks"] if _meets(cell, tile, index["cells"], box)])
    except (ValueError, TypeError, KeyError) as error:
        raise PointweaveError("bad-file", f"the sorted points of {tile} are damaged: remove them, and run again") from error
    with local.open("wb") as file:
        file.truncate(size)
        for begin, end in spans:
            file.seek(begin)
            file.write(read(begin, end))
        file.seek(start)
        file.write(tail)
    return sum(end - begin for begin, end in spans) + len(tail)


def _cube(tile: str) -> tuple[list[int], int]:
    """Lower corner and side of a tile, on the root's lattice."""
    depth, *at = map(int, tile.split("-"))
    side = _LATTICE >> depth
    return [x * side for x in at], side


def _meets(cell: int, tile: str, cells: int, box: Box) -> bool:
    corner, side = _cube(tile)
    step = side / cells
    at = (cell // (cells * cells), cell // cells % cells, cell % cells)
    places = [x + i * step for x, i in zip(corner, at, strict=True)]
    return all(x < high and x + step > low for x, low, high in zip(places, *box, strict=True))


def _spans(blocks: list[tuple[int, int]]) -> list[tuple[int, int]]:
    spans: list[tuple[int, int]] = []
    for begin, end in blocks:
        if spans and begin - spans[-1][1] < _NEAR:
            spans[-1] = (spans[-1][0], end)
        else:
            spans.append((begin, end))
    return spans


def neighbours(task: dict[str, Any]) -> dict[str, str]:
    """The files of a task that hold other tiles' sorted points, each with its tile."""
    if task["stage"] not in ("measure", "make"):
        return {}
    files = {path: Path(path).stem for path in task["needs"] if path.startswith("work/sorted/")}
    return {path: tile for path, tile in files.items() if tile != task["tile"]}
