"""Turns normals by Open3D, for the example orient_truth, one cloud after the other.

On standard input, for each cloud: its count (uint32), the place of the camera and the points (float64 x y z). On standard
output: its normals (float32), by orient_normals_consistent_tangent_plane and by orient_normals_towards_camera_location.
"""
import sys

import numpy as np
import open3d as o3d

while len(head := sys.stdin.buffer.read(4)) == 4:
    count = int(np.frombuffer(head, '<u4')[0])
    values = np.frombuffer(sys.stdin.buffer.read(24 * (count + 1)), '<f8').reshape(-1, 3).copy()
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(values[1:]))
    cloud.estimate_normals(o3d.geometry.KDTreeSearchParamKNN(30))
    cloud.orient_normals_consistent_tangent_plane(15)
    sys.stdout.buffer.write(np.asarray(cloud.normals, '<f4').tobytes())
    cloud.orient_normals_towards_camera_location(values[0])
    sys.stdout.buffer.write(np.asarray(cloud.normals, '<f4').tobytes())
    sys.stdout.buffer.flush()
