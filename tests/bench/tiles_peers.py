"""`pointweave tiles` beside py3dtiles and a voxel grid, on one survey whose surface is known: python tiles_peers.py CLI POINTS.

The error of a result is the rms distance of places on the true surface from the plane through the eight points that are nearest to each.
A voxel grid keeps the mean of the points of each cell, as PDAL's and Open3D's filters do; its points are counted as they would be in the
GLBs of `pointweave tiles`, and its time is that of numpy alone. Prints JSON.
"""

import json
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import laspy
import numpy as np
from scipy.spatial import cKDTree

CORNER = np.array([400_000.0, 5_700_000.0, 100.0])
NOISE = 0.01
#: Side of a square with a ball in it, in metres, and the balls' radius.
PLOT, RADIUS = 10.0, 2.0
#: Points a square metre.
DENSITY = 100
QUERIES = 40_000
RATIO = 0.1


def ground(x, y):
    return 3 * np.sin(x / 23) * np.cos(y / 31) + 0.5 * np.sin(x / 5.3 + 1) * np.sin(y / 4.1)


def surface(count, side, rng):
    """Places on the ground and on balls that stand above it, with their normals; those of balls three tenths."""
    x, y = side * rng.random((2, count * 7 // 10))
    step = 1e-4
    slopes = [(ground(x + step, y) - ground(x, y)) / step, (ground(x, y + step) - ground(x, y)) / step]
    up = np.stack([-slopes[0], -slopes[1], np.ones_like(x)], axis=1)
    flat = np.stack([x, y, ground(x, y)], axis=1)
    balls = count - len(flat)
    middle = PLOT * (rng.integers(0, int(side / PLOT), (balls, 2)) + 0.5)
    out = rng.normal(size=(balls, 3))
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    middle = np.column_stack([middle, ground(*middle.T) + RADIUS + 1.5])
    normals = np.concatenate([up / np.linalg.norm(up, axis=1, keepdims=True), out])
    return np.concatenate([flat, middle + RADIUS * out]), normals


def write_survey(path, points):
    header = laspy.LasHeader(point_format=2, version="1.2")
    header.scales, header.offsets = [0.001] * 3, CORNER
    las = laspy.LasData(header)
    las.x, las.y, las.z = (points + CORNER).T
    las.red = las.green = las.blue = (30_000 + 20_000 * np.sin(points[:, 0] / 3)).astype(np.uint16)
    las.write(path)


def error(kept, queries):
    tree = cKDTree(kept)
    _, near = tree.query(queries, k=8)
    around = kept[near]
    middle = around.mean(axis=1)
    _, _, axes = np.linalg.svd(around - middle[:, None])
    off = np.einsum("ij,ij->i", queries - middle, axes[:, 2])
    return float(np.sqrt(np.mean(off**2)))


def timed(command, folder):
    start = time.perf_counter()
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    return time.perf_counter() - start


def size_of(folder, suffixes):
    return sum(path.stat().st_size for path in folder.rglob("*") if path.suffix in suffixes)


def glb_points(path):
    """Positions of a GLB of points, whose axes are turned back."""
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    gltf = json.loads(data[20 : 20 + length])
    node = next(node for node in gltf["nodes"] if "mesh" in node)
    accessor = gltf["accessors"][gltf["meshes"][node["mesh"]]["primitives"][0]["attributes"]["POSITION"]]
    view = gltf["bufferViews"][accessor["bufferView"]]
    kind = {5126: "<f4", 5123: "<u2", 5122: "<i2"}[accessor["componentType"]]
    width = np.dtype(kind).itemsize
    start = 28 + length + view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    stride = view.get("byteStride", 3 * width)
    raw = np.frombuffer(data, np.uint8, stride * (accessor["count"] - 1) + 3 * width, start)
    rows = np.lib.stride_tricks.as_strided(raw, (accessor["count"], 3 * width), (stride, 1))
    values = np.ascontiguousarray(rows).view(kind).astype(float)
    if accessor.get("normalized"):
        values /= np.iinfo(np.dtype(kind)).max
    values = values * np.array(node.get("scale", [1, 1, 1])) + np.array(node.get("translation", [0, 0, 0]))
    index = gltf["nodes"].index(node)
    for parent in gltf["nodes"]:
        if index in parent.get("children", []):
            values = values + np.array(parent.get("translation", [0, 0, 0]))
    x, y, z = values.T
    return np.stack([x, -z, y], axis=1)


def finest(folder):
    tileset = json.loads((folder / "tileset.json").read_text())
    corner = np.array(tileset["root"]["transform"][12:15]) - CORNER
    found, waiting = [], [tileset["root"]]
    while waiting:
        node = waiting.pop()
        waiting.extend(node.get("children", []))
        if not node.get("children"):
            found.append(glb_points(folder / node["content"]["uri"]) + corner)
    return np.concatenate(found)


def voxels(points, cell):
    _, index = np.unique(np.floor(points / cell).astype(np.int64), axis=0, return_inverse=True)
    counts = np.bincount(index)
    return np.stack([np.bincount(index, points[:, axis]) / counts for axis in range(3)], axis=1)


def cell_for(wanted, measure, low, high, falls):
    """The cell at which a measure has a value, by halving."""
    for _ in range(12):
        middle = np.sqrt(low * high)
        if (measure(middle) > wanted) == falls:
            low = middle
        else:
            high = middle
    return float(np.sqrt(low * high))


def main(cli, count):
    rng = np.random.default_rng(1)
    side = PLOT * max(1, round(np.sqrt(count / DENSITY) / PLOT))
    places, normals = surface(count, side, rng)
    points = places + NOISE * rng.normal(size=(count, 1)) * normals
    rng.shuffle(points)
    queries, _ = surface(QUERIES, side, rng)
    inside = ((queries[:, :2] > 1) & (queries[:, :2] < side - 1)).all(axis=1)
    queries = queries[inside]
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_survey(folder / "survey.las", points)
        rows.append(("the survey", count, (folder / "survey.las").stat().st_size, error(points, queries), 0.0))
        ours = timed(["node", cli, "tiles", "survey.las", "-o", "ours", "--ratio", str(RATIO), "--jobs", "2"], folder)
        kept = finest(folder / "ours")
        size = size_of(folder / "ours", {".glb"})
        target = error(kept, queries)
        rows.append(("pointweave tiles, all levels", len(kept), size, target, ours))
        bytes_a_point = size / len(kept)
        other = timed([Path(sys.executable).parent / "py3dtiles", "convert", "survey.las", "--out", "theirs", "--jobs", "2"], folder)
        rows.append(("py3dtiles, all levels", count, size_of(folder / "theirs", {".pnts", ".glb"}), error(points, queries), other))
        as_many = cell_for(len(kept), lambda cell: len(voxels(points, cell)), 0.05, 2.0, True)
        as_good = cell_for(target, lambda cell: error(voxels(points, cell), queries), 0.02, as_many * 1.5, False)
        for label, cell in (("voxel grid, as many points", as_many), ("voxel grid, its nearest error", as_good)):
            start = time.perf_counter()
            grid = voxels(points, cell)
            seconds = time.perf_counter() - start
            rows.append((label, len(grid), round(bytes_a_point * len(grid)), error(grid, queries), seconds))
    keys = ("by", "points", "bytes", "error", "seconds")
    print(json.dumps([dict(zip(keys, row)) for row in rows]))


main(sys.argv[1], int(sys.argv[2]))
