"""Times Open3D from points to a mesh, on the cloud on standard input (little-endian float32 x y z), for bench.mjs.

  python tests/bench/surface_open3d.py DEPTH RUNS < cloud

Prints JSON: the median seconds of the processor that a run takes, with one thread, and the triangles of the mesh.
"""
import json
import statistics
import sys
import time

import numpy as np
import open3d as o3d

depth, runs = int(sys.argv[1]), int(sys.argv[2])
points = o3d.utility.Vector3dVector(np.frombuffer(sys.stdin.buffer.read(), '<f4').reshape(-1, 3).astype(float))
seconds = []
for _ in range(runs):
    start = time.process_time()
    cloud = o3d.geometry.PointCloud(points)
    cloud.estimate_normals(o3d.geometry.KDTreeSearchParamKNN(30))
    cloud.orient_normals_consistent_tangent_plane(15)
    mesh, _ = o3d.geometry.TriangleMesh.create_from_point_cloud_poisson(cloud, depth=depth, n_threads=1)
    seconds.append(time.process_time() - start)
print(json.dumps({'seconds': statistics.median(seconds), 'triangles': len(mesh.triangles)}))
