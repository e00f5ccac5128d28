"""`python peers.py FOLDER`: what laspy, pye57, plyfile, Open3D, trimesh, lib3mf and USD read of Pointweave's files in FOLDER/ours,
beside truth.json; and their own files of the same cloud and mesh, in FOLDER/theirs, with what each of them holds. Of formats that
Pointweave only reads, what rasterio (GeoTIFF, ASCII grids), pymeshlab (PTX), plyfile and spz (Gaussian splats) read of the same files."""

import importlib.util
import json
import os
import sys

import laspy
import lib3mf
import numpy as np
import open3d as o3d
import plyfile
import pye57
import pymeshlab
import rasterio
import rasterio.shutil
import trimesh
from pxr import Usd, UsdGeom, UsdUtils, UsdValidation

FOLDER = sys.argv[1]
TRUTH = json.load(open(os.path.join(FOLDER, "truth.json")))
CLOUD, MESH = TRUTH["cloud"], TRUTH["mesh"]
ORIGIN = np.array(TRUTH["origin"], float)


def triples(values, kind=float):
    return np.array(values, kind).reshape(-1, 3)


POSITIONS = triples(CLOUD["positions"])
NORMALS = triples(CLOUD["normals"])
COLORS = triples(CLOUD["colors"], np.uint8)
ATTRIBUTES = {name: np.array(values) for name, values in CLOUD["attributes"].items()}
VERTICES = triples(MESH["positions"])
VERTEX_NORMALS = triples(MESH["normals"])
VERTEX_COLORS = triples(MESH["colors"], np.uint8)
TRIANGLES = triples(MESH["indices"], int)

rows = []


def ours(name):
    return os.path.join(FOLDER, "ours", name)


def check(file, by, **pairs):
    """Each pair is (found, wanted, tolerance)."""
    wrong = []
    for what, (found, wanted, tolerance) in pairs.items():
        if isinstance(wanted, (str, int, list, type(None))):
            if found != wanted:
                wrong.append(f"{what} {found}, not {wanted}")
            continue
        found, wanted = np.asarray(found, float), np.asarray(wanted, float)
        if found.shape != wanted.shape:
            wrong.append(f"{what} {found.shape}, not {wanted.shape}")
        elif not np.all(np.abs(found - wanted) <= tolerance):
            at = np.unravel_index(np.argmax(np.abs(found - wanted)), found.shape)
            wrong.append(f"{what}{list(map(int, at))} {found[at]}, not {wanted[at]}")
    rows.append([file, by, "; ".join(wrong) or "equal"])


def guarded(call, *arguments):
    try:
        call(*arguments)
    except Exception as error:
        rows.append([str(arguments[0]), call.__name__, f"{type(error).__name__}: {error}"])


def y_up(points):
    return np.stack([points[:, 0], points[:, 2], -points[:, 1]], axis=1)


def linear(colors):
    x = colors / 255
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


def encoded(colors):
    """What linear bytes are as sRGB."""
    x = colors / 255
    return np.round(255 * np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)).astype(np.uint8)


def of(name):
    """Positions, normals, colours in world coordinates."""
    if name.startswith("mesh"):
        return VERTICES, VERTEX_NORMALS, VERTEX_COLORS
    return POSITIONS + (ORIGIN if name.startswith("surveyed") else 0), NORMALS, COLORS


# --- theirs reads ours -----------------------------------------------------------------------------------------------


def by_plyfile(name):
    data = plyfile.PlyData.read(ours(name))
    vertex = data["vertex"]
    positions, normals, colors = of(name)
    pick = lambda *names: np.stack([np.asarray(vertex[n], float) for n in names], axis=1)
    pairs = dict(
        positions=(pick("x", "y", "z"), positions, 1e-9),
        normals=(pick("nx", "ny", "nz"), normals, 1e-7),
        colors=(pick("red", "green", "blue"), colors, 0),
    )
    if name.startswith("mesh"):
        pairs["triangles"] = (np.stack(data["face"]["vertex_indices"]), TRIANGLES, 0)
    else:
        for attribute, values in ATTRIBUTES.items():
            pairs[attribute] = (vertex[attribute], values, 1e-6 * np.abs(values).max())
    check(name, "plyfile", **pairs)


def by_open3d(name):
    positions, normals, colors = of(name)
    if name.startswith("mesh"):
        mesh = o3d.io.read_triangle_mesh(ours(name))
        if name.endswith(".stl"):
            # Three corners a triangle, in millimetres.
            corners = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
            return check(name, "open3d", corners=(corners, 1000 * VERTICES[TRIANGLES], 1e-3))
        pairs = dict(positions=(mesh.vertices, positions, 1e-6), triangles=(mesh.triangles, TRIANGLES, 0))
        if mesh.has_vertex_colors():
            pairs["colors"] = (np.round(np.asarray(mesh.vertex_colors) * 255), colors, 0)
        return check(name, "open3d", **pairs)
    cloud = o3d.t.io.read_point_cloud(ours(name))
    pairs = dict(
        positions=(cloud.point.positions.numpy(), positions, 1e-6),
        normals=(cloud.point.normals.numpy(), normals, 1e-6),
        colors=(cloud.point.colors.numpy(), colors, 0),
    )
    if name.endswith(".pcd"):
        # The tensor reader (0.20) takes normals of four bytes for ones of eight where positions are of eight; the other one does not.
        pairs["normals"] = (o3d.io.read_point_cloud(ours(name)).normals, normals, 1e-6)
    for attribute, values in ATTRIBUTES.items():
        pairs[attribute] = (cloud.point[attribute].numpy()[:, 0], values, 1e-6 * np.abs(values).max())
    check(name, "open3d", **pairs)


def by_trimesh(name):
    scene = trimesh.load(ours(name), process=False, maintain_order=True)
    geometry = scene.to_geometry() if isinstance(scene, trimesh.Scene) else scene
    positions, normals, colors = of(name)
    if name.endswith(".glb"):
        positions = y_up(positions)
        # Single precision around the node's place.
        tolerance = {"quantize": 1e-4}.get(name.split(".")[0].split("-")[-1], 1e-9)
    else:
        tolerance = 1e-6
    if name.endswith((".stl", ".3mf")):
        # Its unit is the millimetre.
        tolerance = 1e-3
        positions = 1000 * positions
    if name.endswith(".stl"):
        return check(name, "trimesh", corners=(geometry.triangles, positions[TRIANGLES], tolerance))
    pairs = dict(positions=(geometry.vertices, positions, tolerance))
    if name.startswith("mesh"):
        pairs["triangles"] = (geometry.faces, TRIANGLES, 0)
        if name.endswith((".ply", ".obj")):
            pairs["colors"] = (geometry.visual.vertex_colors[:, :3], colors, 0)
    elif name.endswith(".ply"):
        pairs["colors"] = (geometry.colors[:, :3], colors, 0)
    check(name, "trimesh", **pairs)


def by_numpy(name):
    positions, normals, colors = of(name)
    names = open(ours(name)).readline().lstrip("#/ ").split()
    values = np.loadtxt(ours(name), comments=["#", "//"], skiprows=1)
    wanted = np.column_stack([positions, normals, colors, *ATTRIBUTES.values()])
    check(name, "numpy", names=(names[9:], list(ATTRIBUTES), 0), columns=(values, wanted, 1e-6 * np.maximum(1, np.abs(wanted))))


def by_laspy(name):
    las = laspy.read(ours(name))
    positions, normals, colors = of(name)
    pick = lambda *names: np.stack([np.asarray(las[n], float) for n in names], axis=1)
    pairs = dict(
        positions=(las.xyz, positions, 1e-6),
        colors=(pick("red", "green", "blue"), 257 * colors.astype(float), 0),
        normals=(pick("NormalX", "NormalY", "NormalZ"), normals, 1e-7),
        bounds=(np.array([las.header.mins, las.header.maxs]), np.array([positions.min(0), positions.max(0)]), 1e-6),
        extra=(sorted(las.point_format.extra_dimension_names), sorted(["quality", "NormalX", "NormalY", "NormalZ"]), 0),
    )
    for attribute, values in ATTRIBUTES.items():
        found = np.asarray(las[attribute], float) * (0.006 if attribute == "scan_angle" else 1)
        pairs[attribute] = (found, values, 1e-6 * np.abs(values).max())
    check(name, "laspy", **pairs)


def by_lib3mf(name):
    wrapper = lib3mf.get_wrapper()
    model = wrapper.CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(ours(name))
    objects = model.GetMeshObjects()
    objects.MoveNext()
    body = objects.GetCurrentMeshObject()
    vertices = np.array([list(v.Coordinates) for v in body.GetVertices()])
    triangles = np.array([list(t.Indices) for t in body.GetTriangleIndices()])
    colors = np.zeros((len(vertices), 3))
    for corners, properties in zip(triangles, body.GetAllTriangleProperties()):
        group = model.GetColorGroupByID(properties.ResourceID)
        for corner, color in zip(corners, properties.PropertyIDs):
            value = group.GetColor(color)
            colors[corner] = [value.Red, value.Green, value.Blue]
    check(
        name, "lib3mf",
        unit=(int(model.GetUnit()), int(lib3mf.ModelUnit.MilliMeter), 0),
        warnings=(reader.GetWarningCount(), 0, 0),
        positions=(vertices, 1000 * VERTICES, 1e-3),
        triangles=(triangles, TRIANGLES, 0),
        colors=(colors, VERTEX_COLORS, 0),
    )


def by_usd(name):
    stage = Usd.Stage.Open(ours(name))
    prim = next(p for p in stage.Traverse() if p.IsA(UsdGeom.PointBased))
    geometry = UsdGeom.PointBased(prim)
    positions, normals, colors = of(name)
    matrix = np.array(UsdGeom.XformCache().GetLocalToWorldTransform(prim))
    world = np.asarray(geometry.GetPointsAttr().Get(), float) @ matrix[:3, :3] + matrix[3, :3]
    primvars = UsdGeom.PrimvarsAPI(prim)
    pairs = dict(
        up=(UsdGeom.GetStageUpAxis(stage), "Y", 0),
        unit=(float(UsdGeom.GetStageMetersPerUnit(stage)), np.array(1.0), 0),
        default=(stage.GetDefaultPrim().IsValid(), True, 0),
        positions=(world, y_up(positions), 1e-9),
        normals=(geometry.GetNormalsAttr().Get(), y_up(normals), 1e-7),
        colors=(primvars.GetPrimvar("displayColor").Get(), linear(colors), 1e-6),
        extent=(np.array(geometry.GetExtentAttr().Get()), np.array(UsdGeom.PointBased.ComputeExtent(geometry.GetPointsAttr().Get())), 1e-6),
        errors=(errors_of(stage), [], 0),
    )
    if "pictures" in name:
        pairs["colors"] = (primvars.GetPrimvar("displayColor").HasValue(), False, 0)
        pairs["places"] = (primvars.GetPrimvar("st").Get(), np.array(MESH["uvs"]).reshape(-1, 2) * [1, -1] + [0, 1], 1e-7)
        layers, assets, missing = UsdUtils.ComputeAllDependencies(ours(name))
        pairs["pictures"] = ([os.path.basename(asset) for asset in assets], [name + "[color.png]", name + "[normal.png]"], 0)
        pairs["missing"] = (missing, [], 0)
    if name.startswith("mesh"):
        mesh = UsdGeom.Mesh(prim)
        pairs["triangles"] = (np.asarray(mesh.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3), TRIANGLES, 0)
    check(name, "usd-core", **pairs)


def errors_of(stage):
    """What all of USD's own rules find, those of packages included."""
    rules = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    return [error.GetMessage() for error in UsdValidation.ValidationContext(rules).Validate(stage)]


for name in sorted(os.listdir(os.path.join(FOLDER, "ours"))):
    readers = {
        "ply": [by_plyfile, by_open3d, by_trimesh], "xyz": [by_numpy], "pcd": [by_open3d], "las": [by_laspy], "laz": [by_laspy],
        "glb": [by_trimesh], "stl": [by_open3d, by_trimesh], "3mf": [by_lib3mf, by_trimesh], "usdz": [by_usd],
        "obj": [by_open3d, by_trimesh] if name.startswith("mesh") else [by_trimesh],
    }
    for reader in readers[name.split(".")[-1]]:
        guarded(reader, name)
json.dump(rows, open(os.path.join(FOLDER, "theirs-read.json"), "w"))


# --- theirs writes ----------------------------------------------------------------------------------------------------


def meant(file, by, positions, **more):
    plain = {name: np.asarray(value).ravel().tolist() if isinstance(value, np.ndarray) else value for name, value in more.items()}
    if "attributes" in plain:
        plain["attributes"] = {name: np.asarray(values, float).tolist() for name, values in plain["attributes"].items()}
    what = dict(file=file, by=by, positions=np.asarray(positions, float).ravel().tolist(), **plain)
    json.dump(what, open(os.path.join(FOLDER, "theirs", file + ".json"), "w"))


def theirs(name):
    return os.path.join(FOLDER, "theirs", name)


def write_las(file, version, number, at=ORIGIN):
    header = laspy.LasHeader(version=version, point_format=number)
    header.offsets, header.scales = at, np.full(3, 2.0**-10)
    header.add_extra_dim(laspy.ExtraBytesParams(name="quality", type=np.float32))
    header.add_extra_dim(laspy.ExtraBytesParams(name="height", type=np.int16, scales=np.array([0.01]), offsets=np.array([10.0])))
    las = laspy.LasData(header)
    las.x, las.y, las.z = (POSITIONS + at).T
    count = len(POSITIONS)
    values = {
        "intensity": ATTRIBUTES["intensity"], "classification": ATTRIBUTES["classification"],
        "return_number": 1 + np.arange(count) % 3, "number_of_returns": np.full(count, 3),
        "user_data": np.arange(count) % 200, "point_source_id": 7 + np.arange(count) % 9,
    }
    for name, column in values.items():
        las[name] = column.astype(np.int64)
    times = 3e8 + ATTRIBUTES["gps_time"]
    if "gps_time" in las.point_format.dimension_names:
        las.gps_time = times
        values["gps_time"] = times - times[0]
    if number >= 6:
        las.scan_angle = np.round(ATTRIBUTES["scan_angle"] / 0.006).astype(np.int16)
        values["scan_angle"] = ATTRIBUTES["scan_angle"]
    else:
        las.scan_angle_rank = (np.arange(count) % 61 - 30).astype(np.int8)
        values["scan_angle"] = np.arange(count) % 61 - 30.0
    colored = "red" in las.point_format.dimension_names
    if colored:
        las.red, las.green, las.blue = 257 * COLORS.T.astype(np.uint16)
    las.quality = ATTRIBUTES["quality"].astype(np.float32)
    las.height = 10 + (np.arange(count) % 500) * 0.01
    values["quality"] = ATTRIBUTES["quality"]
    values["height"] = 10 + (np.arange(count) % 500) * 0.01
    las.write(theirs(file))
    meant(file, "laspy", POSITIONS + at, attributes=values, up=[0, 0, 1], tolerance=1e-6, **({"colors": COLORS} if colored else {}))


def write_e57():
    file = "room.e57"
    e57 = pye57.E57(theirs(file), mode="w")
    data = {f"cartesian{axis}": POSITIONS[:, i] for i, axis in enumerate("XYZ")}
    data.update({f"color{name}": COLORS[:, i] for i, name in enumerate(["Red", "Green", "Blue"])})
    data["intensity"] = ATTRIBUTES["intensity"].astype(np.float32)
    # Half a turn about z, and a place.
    place = np.array([10.0, 20.0, 1.5])
    e57.write_scan_raw(data, rotation=np.array([0.0, 0.0, 0.0, 1.0]), translation=place)
    e57.close()
    turned = POSITIONS * np.array([-1, -1, 1]) + place
    meant(file, "pye57", turned, colors=COLORS, attributes={"intensity": ATTRIBUTES["intensity"]}, up=[0, 0, 1], unit="m", tolerance=1e-9)

    # The rows and columns of the scanner, and every seventh point without a return.
    file = "states.e57"
    e57 = pye57.E57(theirs(file), mode="w")
    count = len(POSITIONS)
    invalid = np.where(np.arange(count) % 7 == 0, 2, 0)
    data = {f"cartesian{axis}": POSITIONS[:, i] for i, axis in enumerate("XYZ")}
    data.update({"cartesianInvalidState": invalid, "rowIndex": np.arange(count) % 40, "columnIndex": np.arange(count) // 40})
    e57.write_scan_raw(data)
    e57.close()
    valid = invalid == 0
    attributes = {name: data[name][valid] for name in ["rowIndex", "columnIndex"]}
    skipped = {"invalid": int((~valid).sum())}
    meant(file, "pye57", POSITIONS[valid], attributes=attributes, up=[0, 0, 1], unit="m", tolerance=1e-9, skipped=skipped)


def write_plyfile(file, **how):
    kinds = [("x", "f8"), ("y", "f8"), ("z", "f8"), ("nx", "f4"), ("ny", "f4"), ("nz", "f4"), ("red", "u1"), ("green", "u1"), ("blue", "u1")]
    kinds += [(name, "f4") for name in ATTRIBUTES]
    table = np.empty(len(POSITIONS), dtype=kinds)
    columns = [*(POSITIONS + ORIGIN).T, *NORMALS.T, *COLORS.T, *ATTRIBUTES.values()]
    for (name, _), column in zip(kinds, columns):
        table[name] = column
    plyfile.PlyData([plyfile.PlyElement.describe(table, "vertex")], **how).write(theirs(file))
    meant(file, "plyfile", POSITIONS + ORIGIN, normals=NORMALS, colors=COLORS, attributes=ATTRIBUTES)


def write_open3d(file, normals=True, colors=True, attributes=True, **how):
    cloud = o3d.t.geometry.PointCloud(o3d.core.Tensor(POSITIONS.astype(np.float32)))
    what = {}
    if normals:
        cloud.point.normals = o3d.core.Tensor(NORMALS.astype(np.float32))
        what["normals"] = NORMALS
    if colors:
        cloud.point.colors = o3d.core.Tensor(COLORS)
        what["colors"] = COLORS
    if attributes:
        cloud.point["quality"] = o3d.core.Tensor(ATTRIBUTES["quality"].astype(np.float32)[:, None])
        what["attributes"] = {"quality": ATTRIBUTES["quality"]}
    assert o3d.t.io.write_point_cloud(theirs(file), cloud, **how)
    if file.endswith(".pcd"):
        what["up"] = [0, 0, 1]
    meant(file, "open3d", POSITIONS, tolerance=1e-6, **what)


def write_trimesh(file, **what):
    colors = np.column_stack([VERTEX_COLORS, np.full(len(VERTICES), 255, np.uint8)])
    mesh = trimesh.Trimesh(VERTICES, TRIANGLES, vertex_colors=colors, vertex_normals=VERTEX_NORMALS, process=False)
    mesh.export(theirs(file))
    meant(file, "trimesh", VERTICES, faces=len(TRIANGLES), tolerance=1e-6, sorted=True, **what)


def write_lib3mf():
    file = "body.3mf"
    wrapper = lib3mf.get_wrapper()
    model = wrapper.CreateModel()
    model.SetUnit(lib3mf.ModelUnit.Inch)
    body = model.AddMeshObject()

    def position(p):
        out = lib3mf.Position()
        out.Coordinates[:] = [float(x) for x in p]
        return out

    def triangle(t):
        out = lib3mf.Triangle()
        out.Indices[:] = [int(x) for x in t]
        return out

    body.SetGeometry([position(p) for p in VERTICES], [triangle(t) for t in TRIANGLES])
    group = model.AddColorGroup()
    places = [group.AddColor(wrapper.RGBAToColor(int(r), int(g), int(b), 255)) for r, g, b in VERTEX_COLORS]
    for i, corners in enumerate(TRIANGLES):
        properties = lib3mf.TriangleProperties()
        properties.ResourceID = group.GetResourceID()
        properties.PropertyIDs[:] = [places[c] for c in corners]
        body.SetTriangleProperties(i, properties)
    body.SetObjectLevelProperty(group.GetResourceID(), places[0])
    model.AddBuildItem(body, wrapper.GetIdentityTransform())
    model.QueryWriter("3mf").WriteToFile(theirs(file))
    meant(file, "lib3mf", VERTICES, colors=VERTEX_COLORS, faces=len(TRIANGLES), up=[0, 0, 1], unit="in", tolerance=1e-5, sorted=True)


def write_rasters():
    """Heights with holes; what they are is what GDAL reads."""
    rows, columns = 30, 40
    heights = (300 + np.add.outer(np.sin(np.arange(rows) / 5), np.cos(np.arange(columns) / 7))).astype(np.float32)
    heights[::7, ::5] = -9999
    turned = rasterio.Affine(2.0, 0.0, 455_000.0, 0.0, -2.5, 5_412_000.0)
    square = rasterio.Affine(2.0, 0.0, 455_000.0, 0.0, -2.0, 5_412_000.0)
    kinds = {
        "stored.tif": dict(), "deflate.tif": dict(compress="deflate", predictor=3), "lzw.tif": dict(compress="lzw", predictor=2, dtype="int16"),
        "tiled.tif": dict(tiled=True, blockxsize=16, blockysize=16, compress="packbits"), "double.tif": dict(dtype="float64", BIGTIFF="YES"), "fraction.tif": dict(nodata=-9999.9),
        "heights.asc": dict(driver="AAIGrid"),
    }
    for file, how in kinds.items():
        profile = dict(driver="GTiff", width=columns, height=rows, count=1, dtype="float32", nodata=-9999, transform=turned, crs="EPSG:25832") | how
        if profile["driver"] == "AAIGrid":
            # It writes copies alone, with cells that are square.
            with rasterio.open(theirs("copied.tif"), "w", **(profile | dict(driver="GTiff", transform=square))) as raster:
                raster.write(heights, 1)
            rasterio.shutil.copy(theirs("copied.tif"), theirs(file), driver="AAIGrid")
            os.remove(theirs("copied.tif"))
        else:
            with rasterio.open(theirs(file), "w", **profile) as raster:
                raster.write(np.where(heights == -9999, profile["nodata"], heights).astype(profile["dtype"]), 1)
        with rasterio.open(theirs(file)) as raster:
            values = raster.read(1, masked=True)
            row, column = np.nonzero(~values.mask)
            east, north = raster.xy(row, column)
            positions = np.column_stack([east, north, values[row, column]])
            skipped = {"no-data": int(values.mask.sum())}
        # Pointweave goes from tile to tile.
        unit = None if file.endswith(".asc") else "m"
        meant(file, "rasterio", positions, up=[0, 0, 1], unit=unit, skipped=skipped, tolerance=1e-6, sorted=file == "tiled.tif")


def write_ptx():
    """Two scans; where their points are is what MeshLab reads."""
    file = "stations.ptx"
    places = [np.array([10.0, 20.0, 1.5]), np.array([-4.0, 2.0, 1.5])]
    lines = []
    for place in places:
        lines += ["20", "25", " ".join(map(str, place)), "0 1 0", "-1 0 0", "0 0 1"]
        lines += ["0 1 0 0", "-1 0 0 0", "0 0 1 0", " ".join(map(str, [*place, 1]))]
        for i in range(500):
            # Every ninth has no return.
            point = np.zeros(3) if i % 9 == 4 else POSITIONS[i] + 1
            color = COLORS[i] if i % 9 != 4 else np.zeros(3, int)
            lines.append(" ".join(map(str, [*point, round(i / 500, 3), *color])))
    open(theirs(file), "w").write("\n".join(lines) + "\n")
    positions, colors = [], []
    for i, place in enumerate(places):
        meshes = pymeshlab.MeshSet()
        meshes.load_new_mesh(theirs(file), meshindex=i, pointsonly=False, pointcull=False, anglecull=False)
        found = meshes.current_mesh()
        seen = np.linalg.norm(found.vertex_matrix() - place, axis=1) > 1e-6
        positions.append(found.vertex_matrix()[seen])
        colors.append(np.round(255 * found.vertex_color_matrix()[seen, :3]).astype(int))
    seen = np.arange(500) % 9 != 4
    intensity = np.tile(np.round(np.arange(500) / 500, 3)[seen], 2)
    meant(
        file, "pymeshlab", np.vstack(positions), colors=np.vstack(colors), attributes={"intensity": intensity}, up=[0, 0, 1],
        skipped={"no-return": 2 * int((~seen).sum())}, tolerance=1e-5,
    )


def write_splats():
    """Gaussian splats; what they are is what spz and plyfile read."""
    count = 400
    harmonic = 0.28209479177387814
    band = ((COLORS[:count] / 255 - 0.5) / harmonic).astype(np.float32)
    opacity = np.linspace(-4, 4, count).astype(np.float32)
    scales = np.full((count, 3), -5, np.float32)
    rotations = np.tile(np.array([1, 0, 0, 0], np.float32), (count, 1))
    # The package's own __init__ imports itself; its module does not need it.
    folder = importlib.util.find_spec("spz").submodule_search_locations[0]
    [module] = [name for name in os.listdir(folder) if name.startswith("spz.") and name.endswith((".so", ".pyd"))]
    spec = importlib.util.spec_from_file_location("spz", os.path.join(folder, module))
    spz = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(spz)
    file = "splats.spz"
    spz.GaussianSplat(POSITIONS[:count].astype(np.float32), scales, rotations, opacity, band).save(theirs(file))
    found = spz.GaussianSplat.load(theirs(file))
    colors = np.clip(np.round(255 * (0.5 + harmonic * np.asarray(found.colors).reshape(-1, 3))), 0, 255).astype(int)
    attributes = {"opacity": 1 / (1 + np.exp(-np.asarray(found.alphas, float)))}
    meant(file, "spz", np.asarray(found.positions).reshape(-1, 3), colors=colors, attributes=attributes, tolerance=1e-6)

    file = "splats.ply"
    names = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"]
    table = np.empty(count, dtype=[(name, "f4") for name in names])
    for name, column in zip(names, [*POSITIONS[:count].T, *band.T, opacity, *scales.T, *rotations.T]):
        table[name] = column
    plyfile.PlyData([plyfile.PlyElement.describe(table, "vertex")]).write(theirs(file))
    vertex = plyfile.PlyData.read(theirs(file))["vertex"]
    colors = np.clip(np.round(255 * (0.5 + harmonic * np.stack([vertex[f"f_dc_{i}"] for i in range(3)], axis=1))), 0, 255).astype(int)
    positions = np.stack([vertex[axis] for axis in "xyz"], axis=1)
    meant(file, "plyfile", positions, colors=colors, attributes={name: vertex[name] for name in names[6:]}, tolerance=1e-9)


for number in [0, 1, 2, 3]:
    write_las(f"format{number}.las", "1.2", number)
    write_las(f"format{number}.laz", "1.2", number)
for number in [6, 7, 8]:
    write_las(f"format{number}.las", "1.4", number)
    write_las(f"format{number}.laz", "1.4", number)
write_e57()
write_plyfile("big.ply", byte_order=">")
write_plyfile("little.ply", byte_order="<")
write_plyfile("text.ply", text=True)
for file, how in [("compressed.pcd", {"compressed": True}), ("binary.pcd", {}), ("text.pcd", {"write_ascii": True})]:
    write_open3d(file, **how)
write_open3d("open3d.ply")
write_open3d("plain.xyz", normals=False, colors=False, attributes=False)
write_trimesh("body.ply", normals=VERTEX_NORMALS, colors=VERTEX_COLORS, also=["alpha"])
write_trimesh("body.obj", normals=VERTEX_NORMALS, colors=VERTEX_COLORS)
write_trimesh("body.off")
write_trimesh("body.stl")
# It writes its bytes as they are, and those of a GLB are linear.
write_trimesh("body.glb", normals=VERTEX_NORMALS, colors=encoded(VERTEX_COLORS), up=[0, 1, 0], unit="m")
write_lib3mf()
write_rasters()
write_ptx()
write_splats()
