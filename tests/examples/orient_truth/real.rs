//! Real scans whose outer side is known: by the mesh that was made of them, by their camera, by gravity.

use crate::scenes::{Scene, Sure};
use glam::{DQuat, DVec3, Vec3};
use pointweave::cloud::octree::Octree;
use pointweave::formats::{RawCloud, detect, read};
use std::path::PathBuf;
use std::sync::Arc;

type Make = fn() -> Option<Scene>;

/// Their names, and how they are made; `None` where the files are not there.
pub const ALL: &[(&str, Make)] = &[
    ("real: raw bunny", || Some(bunny()?.0)),
    ("real: raw bunny with poses", || {
        let (scene, eyes, of, _) = bunny()?;
        Some(scene.seen_from_each(eyes, of))
    }),
    ("real: raw bunny with normals", || {
        let (scene, .., normals) = bunny()?;
        Some(scene.with_normals(normals))
    }),
    ("real: redwood", || {
        seen_from_origin("scans/redwood_fragment_002.ply")
    }),
    ("real: range hood, surroundings", || {
        seen_from_origin("scans/cad_scans/Range_Hood_4_BB1.6.ply")
    }),
    ("real: range hood", || {
        seen_from_origin("scans/cad_scans/Range_Hood_4_filtered.ply")
    }),
    ("real: chair", || {
        let lies = |_: DVec3, n: DVec3| (n.y.abs() > 0.9).then_some(n.y > 0.0);
        file("scans/iphone_chair.obj", lies).map(|s| s.0)
    }),
    ("real: autzen", || airborne("lidar/autzen_trim.las")),
    ("real: conifers", || airborne("lidar/lidR_MixedConifer.laz")),
    ("real: simple", || airborne("lidar/simple.laz")),
];

fn path(name: &str) -> PathBuf {
    PathBuf::from("../shared/data").join(name)
}

fn raw(name: &str) -> Option<RawCloud> {
    let bytes = std::fs::read(path(name)).ok()?;
    let format = detect(&bytes, Some(name)).expect("a known format");
    Some(read(&bytes, format).expect("a file that can be read"))
}

fn file(
    name: &str,
    truth: impl Fn(DVec3, DVec3) -> Option<bool> + Send + Sync + 'static,
) -> Option<(Scene, RawCloud)> {
    let raw = raw(name)?;
    let cloud = raw.to_cloud().expect("a cloud");
    let origin = DVec3::from_array(raw.origin.unwrap_or_default());
    let positions = cloud.positions_f64();
    let points = positions
        .chunks_exact(3)
        .map(|p| DVec3::from_slice(p) + origin);
    let mut scene = Scene::new(Sure::Told, points.collect(), truth);
    scene.told.normals = cloud
        .normals
        .map(|normals| normals.iter().map(|n| n.as_dvec3()).collect());
    Some((scene, raw))
}

fn seen_from_origin(name: &str) -> Option<Scene> {
    file(name, |p, n| Some(n.dot(-p) > 0.0)).map(|s| s.0)
}

/// Points that are classified as ground look up; of the others, those whose surface lies.
fn airborne(name: &str) -> Option<Scene> {
    let lies = |_: DVec3, n: DVec3| (n.z.abs() > 0.5).then_some(n.z > 0.0);
    let (mut scene, raw) = file(name, lies)?;
    let classes = raw.attributes.iter().find(|a| a.name == "classification")?;
    let ground: Vec<DVec3> = scene
        .points
        .iter()
        .zip(&classes.values)
        .filter(|(_, class)| **class == 2.0)
        .map(|(p, _)| *p)
        .collect();
    if let Some(&first) = ground.first() {
        let near: Vec<Vec3> = ground.iter().map(|&p| (p - first).as_vec3()).collect();
        let all: Vec<Vec3> = scene
            .points
            .iter()
            .map(|&p| (p - first).as_vec3())
            .collect();
        let (near, all) = (Octree::build(&near), Octree::build(&all));
        scene.truth = Arc::new(move |p, n| {
            let mut found = Vec::new();
            let q = (p - first).as_vec3();
            near.knn(q, 1, &mut found);
            let ground = found[0].distance2;
            all.knn(q, 1, &mut found);
            // The point that is nearest is one of the ground.
            (ground <= found[0].distance2).then_some(n.z > 0.0)
        });
    }
    Some(scene.seen_from_above())
}

/// Ten range images in one frame, with the place that each was seen from, and the normals of the mesh that its authors made.
fn bunny() -> Option<(Scene, Vec<DVec3>, Vec<u32>, Vec<DVec3>)> {
    let poses = std::fs::read_to_string(path("scans/bunny_raw/bun.conf")).ok()?;
    let mut points = Vec::new();
    let (mut eyes, mut of) = (Vec::new(), Vec::new());
    for line in poses.lines().filter(|l| l.starts_with("bmesh")) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let x: Vec<f64> = words[2..]
            .iter()
            .map(|w| w.parse().expect("a number"))
            .collect();
        let turn = DQuat::from_xyzw(x[3], x[4], x[5], -x[6]).normalize();
        let place = |p: DVec3| turn * p + DVec3::new(x[0], x[1], x[2]);
        let scan = raw(&format!("scans/bunny_raw/{}", words[1]))?;
        let cloud = scan.to_cloud().expect("a cloud");
        let positions = cloud.positions_f64();
        let moved = positions
            .chunks_exact(3)
            .map(|p| place(DVec3::from_slice(p)));
        points.extend(moved);
        of.resize(points.len(), eyes.len() as u32);
        eyes.push(place(DVec3::Z * 10.0));
    }
    let (vertices, normals) = zipper()?;
    let tree = Octree::build(&vertices);
    let outward = move |p: DVec3| {
        let mut found = Vec::new();
        tree.knn(p.as_vec3(), 1, &mut found);
        normals[tree.order[found[0].index as usize] as usize]
    };
    let known = points.iter().map(|&p| outward(p)).collect();
    let truth = move |p: DVec3, n: DVec3| Some(outward(p).dot(n) > 0.0);
    Some((Scene::new(Sure::Told, points, truth), eyes, of, known))
}

/// The vertices of the bunny and their normals, from its text.
fn zipper() -> Option<(Vec<Vec3>, Vec<DVec3>)> {
    let text = std::fs::read_to_string(path("meshes/bun_zipper.ply")).ok()?;
    let (head, body) = text.split_once("end_header\n")?;
    let count = |element: &str| -> Option<usize> {
        let line = head.lines().find(|l| l.starts_with(element))?;
        line.rsplit(' ').next()?.trim().parse().ok()
    };
    let (count, faces) = (count("element vertex")?, count("element face")?);
    let mut lines = body.lines().map(|l| l.split_whitespace());
    let number = |w: &str| w.parse::<f64>().expect("a number");
    let vertices: Vec<DVec3> = lines
        .by_ref()
        .take(count)
        .map(|w| w.take(3).map(number).collect::<Vec<f64>>())
        .map(|p| DVec3::from_slice(&p))
        .collect();
    let mut normals = vec![DVec3::ZERO; count];
    for words in lines.take(faces) {
        let t: Vec<usize> = words.skip(1).map(|w| number(w) as usize).collect();
        let [a, b, c] = [0, 1, 2].map(|k| vertices[t[k]]);
        for &v in &t {
            normals[v] += (b - a).cross(c - a);
        }
    }
    let used = normals
        .iter()
        .zip(&vertices)
        .filter(|(n, _)| **n != DVec3::ZERO);
    let (normals, vertices): (Vec<DVec3>, Vec<Vec3>) =
        used.map(|(n, v)| (n.normalize(), v.as_vec3())).unzip();
    Some((vertices, normals))
}
