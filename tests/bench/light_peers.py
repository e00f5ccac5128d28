"""Measures light meshes for light.mjs, which gives a folder of raw arrays: NAME.xyz (float32), NAME.tri (uint32).

  python tests/bench/light_peers.py simplify FOLDER TRIANGLES   full, ours, meshopt; Open3D and PyMeshLab simplify full themselves
  python tests/bench/light_peers.py texture FOLDER              points and models with colours of vertices or pictures

Prints JSON.
"""
import json
import sys
from pathlib import Path

import numpy as np
import open3d as o3d

folder = Path(sys.argv[2])


def array(name, kind, width):
    return np.fromfile(folder / name, kind).reshape(-1, width)


def mesh_of(name):
    mesh = o3d.geometry.TriangleMesh()
    mesh.vertices = o3d.utility.Vector3dVector(array(f'{name}.xyz', '<f4', 3).astype(float))
    mesh.triangles = o3d.utility.Vector3iVector(array(f'{name}.tri', '<u4', 3).astype(np.int32))
    return mesh


def scene_of(mesh):
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(o3d.t.geometry.TriangleMesh.from_legacy(mesh))
    return scene


def places(mesh):
    """Even ones for the mean; the vertices, too, for the largest distance."""
    o3d.utility.random.seed(1)
    even = np.asarray(mesh.sample_points_uniformly(300_000).points)
    return even, np.vstack([even, np.asarray(mesh.vertices)])


def distance(scene, points):
    return scene.compute_distance(o3d.core.Tensor(points.astype(np.float32))).numpy()


def simplify(most):
    import pymeshlab

    full = mesh_of('full')
    diagonal = np.linalg.norm(full.get_max_bound() - full.get_min_bound())
    meshes = {'ours': mesh_of('ours'), 'meshoptimizer': mesh_of('meshopt'), 'Open3D': full.simplify_quadric_decimation(most)}
    lab = pymeshlab.MeshSet()
    lab.add_mesh(pymeshlab.Mesh(np.asarray(full.vertices), np.asarray(full.triangles)))
    lab.meshing_decimation_quadric_edge_collapse(targetfacenum=most)
    theirs = lab.current_mesh()
    meshes['PyMeshLab'] = o3d.geometry.TriangleMesh(
        o3d.utility.Vector3dVector(theirs.vertex_matrix()), o3d.utility.Vector3iVector(theirs.face_matrix()))
    scene, (even, all_of_full) = scene_of(full), places(full)
    rows = {}
    for name, mesh in meshes.items():
        own, (own_even, own_all) = scene_of(mesh), places(mesh)
        rows[name] = {
            'triangles': len(mesh.triangles),
            'mean': float((distance(own, even).mean() + distance(scene, own_even).mean()) / 2 / diagonal),
            'hausdorff': float(max(distance(own, all_of_full).max(), distance(scene, own_all).max()) / diagonal),
        }
    return rows


def normals_at(name, triangles, weights):
    normals = array(f'{name}.nor', '<f4', 3)[triangles]
    mixed = (normals * weights[..., None]).sum(1)
    return mixed / np.linalg.norm(mixed, axis=1, keepdims=True)


def shown(picture, uv):
    """Between texels."""
    pixels = np.asarray(o3d.io.read_image(str(folder / picture)))[..., :3].astype(float)
    height, width, _ = pixels.shape
    x, y = uv[:, 0] * width - 0.5, uv[:, 1] * height - 0.5
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    right, low = (x - left)[:, None], (y - top)[:, None]
    at = lambda dx, dy: pixels[np.clip(top + dy, 0, height - 1), np.clip(left + dx, 0, width - 1)]
    return (at(0, 0) * (1 - right) + at(1, 0) * right) * (1 - low) + (at(0, 1) * (1 - right) + at(1, 1) * right) * low


def texture():
    points, colors = array('scan.xyz', '<f4', 3), array('scan.rgb', 'u1', 3).astype(float)
    truth = array('scan.nor', '<f4', 3)
    rows = {}
    for file in sorted(folder.glob('*.tri')):
        name = file.stem
        mesh = mesh_of(name)
        found = scene_of(mesh).compute_closest_points(o3d.core.Tensor(points))
        second = found['primitive_uvs'].numpy()
        triangles = np.asarray(mesh.triangles)[found['primitive_ids'].numpy()]
        weights = np.column_stack([1 - second.sum(1), second])
        normals = normals_at(name, triangles, weights)
        if (folder / f'{name}.uv').exists():
            corner = lambda values: (values[triangles] * weights[..., None]).sum(1)
            uv = corner(array(f'{name}.uv', '<f4', 2))
            seen = shown(f'{name}.color.png', uv)
            frames = array(f'{name}.tan', '<f4', 4)
            tangents = corner(frames[:, :3])
            tangents /= np.linalg.norm(tangents, axis=1, keepdims=True)
            bitangents = np.cross(normals, tangents) * frames[triangles[:, 0], 3:]
            bitangents /= np.linalg.norm(bitangents, axis=1, keepdims=True)
            told = shown(f'{name}.normal.png', uv) / 127.5 - 1
            normals = tangents * told[:, :1] + bitangents * told[:, 1:2] + normals * told[:, 2:]
            normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        else:
            seen = (array(f'{name}.rgb', 'u1', 3).astype(float)[triangles] * weights[..., None]).sum(1)
        known = np.linalg.norm(truth, axis=1) > 0.5
        cosines = np.clip((normals * truth).sum(1)[known], -1, 1)
        rows[name] = {
            'triangles': len(mesh.triangles),
            'rms': float(np.sqrt(((seen - colors) ** 2).mean())),
            'angle': float(np.degrees(np.arccos(cosines)).mean()),
        }
    return rows


print(json.dumps(simplify(int(sys.argv[3])) if sys.argv[1] == 'simplify' else texture()))
