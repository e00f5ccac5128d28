"""Cuts objects out by Open3D, for the example prepare_truth, one scan after the other.

On standard input, for each scan: its count and how many planes carry it (uint32), its spacing (float64), and the points (float64
x y z). On standard output: milliseconds (float64), and for each point 1 where it is kept (uint8). Planes are those of segment_plane
within a spacing; what is kept is the largest cluster of cluster_dbscan within three.
"""
import struct
import sys
import time

import numpy as np
import open3d as o3d

while len(head := sys.stdin.buffer.read(16)) == 16:
    count, planes, spacing = struct.unpack('<IId', head)
    points = np.frombuffer(sys.stdin.buffer.read(24 * count), '<f8').reshape(-1, 3).copy()
    o3d.utility.random.seed(0)
    start = time.perf_counter()
    left = np.arange(count)
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points))
    cloud, near = cloud.remove_statistical_outlier(20, 2.0)
    left = left[near]
    for _ in range(planes):
        _, own = cloud.segment_plane(spacing, 3, 1000)
        left = np.delete(left, own)
        cloud = cloud.select_by_index(own, invert=True)
    labels = np.asarray(cloud.cluster_dbscan(3 * spacing, 10))
    kept = np.zeros(count, np.uint8)
    if (labels >= 0).any():
        kept[left[labels == np.bincount(labels[labels >= 0]).argmax()]] = 1
    ms = 1e3 * (time.perf_counter() - start)
    sys.stdout.buffer.write(struct.pack('<d', ms) + kept.tobytes())
    sys.stdout.buffer.flush()
