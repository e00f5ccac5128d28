"""Registers scans by Open3D, for the example register_truth, one list after the other.

On standard input, for each list: how many scans there are (uint32), and for each its count (uint32) and points (float64 x y z). On
standard output: milliseconds (float64), and for each scan 1 where it is placed, else 0, and its pose (float64, 16 numbers by rows) in the
frame of the first placed one.

As its tutorials on global registration and on multiway registration do: voxels of a 60th of the diagonal, FPFH, RANSAC, point-to-plane ICP
for every pair; pairs with a fitness of 0.3 and more within 0.4 voxels are edges of a pose graph, which is optimised. What no edge connects
with the largest part is left out.
"""
import struct
import sys
import time

import numpy as np
import open3d as o3d

registration = o3d.pipelines.registration


def sampled(points, voxel):
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points)).voxel_down_sample(voxel)
    cloud.estimate_normals(o3d.geometry.KDTreeSearchParamHybrid(2 * voxel, 30))
    return cloud


def pair(a, b, voxel):
    (source, features), (target, others) = a, b
    near = 1.5 * voxel
    found = registration.registration_ransac_based_on_feature_matching(
        source, target, features, others, True, near, registration.TransformationEstimationPointToPoint(False), 3,
        [registration.CorrespondenceCheckerBasedOnEdgeLength(0.9), registration.CorrespondenceCheckerBasedOnDistance(near)],
        registration.RANSACConvergenceCriteria(100000, 0.999))
    plane = registration.TransformationEstimationPointToPlane()
    found = registration.registration_icp(source, target, 0.4 * voxel, found.transformation, plane)
    information = registration.get_information_matrix_from_point_clouds(source, target, 0.4 * voxel, found.transformation)
    return found.fitness, found.transformation, information


def largest(count, edges):
    of = list(range(count))
    for a, b in edges:
        of = [of[b] if x == of[a] else x for x in of]
    best = max(range(count), key=lambda k: (of.count(of[k]), -k))
    return [k for k in range(count) if of[k] == of[best]]


def register(scans):
    diagonal = max(np.linalg.norm(np.ptp(points, axis=0)) for points in scans)
    voxel = diagonal / 60
    clouds = [sampled(points, voxel) for points in scans]
    search = o3d.geometry.KDTreeSearchParamHybrid(5 * voxel, 100)
    seen = [(cloud, registration.compute_fpfh_feature(cloud, search)) for cloud in clouds]
    found = {}
    for a in range(len(scans)):
        for b in range(a + 1, len(scans)):
            fitness, pose, information = pair(seen[a], seen[b], voxel)
            if fitness >= 0.3:
                found[a, b] = (fitness, pose, information)
    members = largest(len(scans), found)
    place = {k: i for i, k in enumerate(members)}
    inner = {edge: value for edge, value in found.items() if edge[0] in place}
    # Poses along the surest edges, which the others correct.
    poses = {members[0]: np.eye(4)}
    while len(poses) < len(members):
        open_ = [(f, a, b, p) for (a, b), (f, p, _) in inner.items() if (a in poses) != (b in poses)]
        _, a, b, p = max(open_, key=lambda edge: edge[0])
        if a in poses:
            poses[b] = poses[a] @ np.linalg.inv(p)
        else:
            poses[a] = poses[b] @ p
    graph = registration.PoseGraph()
    for k in members:
        graph.nodes.append(registration.PoseGraphNode(poses[k]))
    for (a, b), (_, p, information) in inner.items():
        graph.edges.append(registration.PoseGraphEdge(place[a], place[b], p, information, uncertain=True))
    if len(members) > 1:
        options = registration.GlobalOptimizationOption(0.4 * voxel, 0.25, 1.0, 0)
        registration.global_optimization(
            graph, registration.GlobalOptimizationLevenbergMarquardt(), registration.GlobalOptimizationConvergenceCriteria(), options)
    return {k: graph.nodes[i].pose for k, i in place.items()}


o3d.utility.set_verbosity_level(o3d.utility.VerbosityLevel.Error)
while len(head := sys.stdin.buffer.read(4)) == 4:
    scans = []
    for _ in range(struct.unpack('<I', head)[0]):
        count = struct.unpack('<I', sys.stdin.buffer.read(4))[0]
        scans.append(np.frombuffer(sys.stdin.buffer.read(24 * count), '<f8').reshape(-1, 3).copy())
    o3d.utility.random.seed(0)
    start = time.perf_counter()
    poses = register(scans)
    sys.stdout.buffer.write(struct.pack('<d', 1e3 * (time.perf_counter() - start)))
    for k in range(len(scans)):
        placed = k in poses
        values = poses[k] if placed else np.zeros((4, 4))
        sys.stdout.buffer.write(struct.pack('<d', float(placed)) + np.ascontiguousarray(values, '<f8').tobytes())
    sys.stdout.buffer.flush()
