"""Of a neighbour's sorted points those at the border are brought, from an object store as from a disk."""

from __future__ import annotations

import json
import random
from pathlib import Path

from pointweave_dask import npm
from pointweave_dask.cells import copy_cells, surroundings


def sorted_file(folder: Path) -> tuple[Path, str]:
    """The largest file of sorted points of a flat scan."""
    chance = random.Random(2)
    lines = [f"{8 * chance.random():.4f} {8 * chance.random():.4f} 0" for _ in range(160_000)]
    (folder / "flat.xyz").write_text("\n".join(lines) + "\n")
    npm.pointweave(["tiles", "plan", "flat.xyz", "-o", "out", "--tile-points", "100000"], folder)
    npm.pointweave(["tiles", "sort", "-o", "out", "--tile", "0"], folder)
    largest = max((folder / "out/work/sorted/0").iterdir(), key=lambda path: path.stat().st_size)
    return largest, largest.stem


def test_blocks_at_a_border_are_copied_to_their_places(tmp_path: Path) -> None:
    path, tile = sorted_file(tmp_path)
    whole = path.read_bytes()
    size = json.loads((tmp_path / "out/work/plan.json").read_text())["octree"]["size"]
    depth, x, y, z = map(int, tile.split("-"))
    box = surroundings(f"{depth}-{x + 1}-{y}-{z}", size, size / 2**depth / 50)
    got: list[tuple[int, int]] = []

    def read(begin: int, end: int) -> bytes:
        got.append((begin, end))
        return whole[begin:end]

    copied = copy_cells(read, len(whole), tile, box, tmp_path / "copy")
    copy = (tmp_path / "copy").read_bytes()
    assert len(copy) == len(whole)
    assert sum(end - begin for begin, end in got) == copied < 0.6 * len(whole)
    assert all(copy[begin:end] == whole[begin:end] for begin, end in got)
    index = json.loads(whole[-4 - int.from_bytes(whole[-4:], "little") : -4])
    cells = index["cells"]
    assert cells > 1
    # The cells of the tile's upper side along x are all there.
    for cell, begin, end in index["blocks"]:
        if cell // cells**2 == cells - 1:
            assert copy[begin:end] == whole[begin:end]
