//! The finest tiles against the truth.

use crate::scene::{CORNER, NOISE, distance, side_of};
use glam::{DVec3, Vec3};
use pointweave::cloud::octree::Octree;
use pointweave::formats::{Format, read};
use pointweave::tiles::Tile;
use serde_json::Value;
use std::error::Error;
use std::path::Path;

/// Points of a leaf, in the survey's frame, and how far each is from the cut next to it.
struct Leaf {
    points: Vec<DVec3>,
    tile: Tile,
}

/// Prints what it finds.
pub fn check(folder: &Path) -> Result<(), Box<dyn Error>> {
    let json = |name: &str| -> Result<Value, Box<dyn Error>> {
        Ok(serde_json::from_slice(&std::fs::read(folder.join(name))?)?)
    };
    let (tileset, manifest) = (json("tileset.json")?, json("manifest.json")?);
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let transform = &tileset["root"]["transform"];
    let corner = DVec3::new(
        number(&transform[12]),
        number(&transform[13]),
        number(&transform[14]),
    );
    let spacing = number(&manifest["spacing"]);
    let side = side_of(manifest["points"].as_u64().unwrap_or_default());
    let mut leaves = Vec::new();
    collect(&tileset["root"], folder, corner, &mut leaves)?;
    let size = leaves
        .iter()
        .map(|leaf| extent(&leaf.points))
        .fold(0.0, f64::max);
    let all: Vec<DVec3> = leaves
        .iter()
        .flat_map(|leaf| leaf.points.iter().copied())
        .collect();
    let mut off: Vec<f64> = all.iter().map(|&p| distance(p, side)).collect();
    off.sort_by(f64::total_cmp);
    let at = |q: f64| off[((off.len() - 1) as f64 * q) as usize];
    let rms = (off.iter().map(|d| d * d).sum::<f64>() / off.len() as f64).sqrt();
    println!(
        "{} points in {} leaves, largest {size:.1} m, spacing {spacing:.4} m",
        all.len(),
        leaves.len()
    );
    println!(
        "distance from the truth, m: rms {rms:.5} (noise of the scan {NOISE}), 99 % {:.5}, most {:.5}",
        at(0.99),
        at(1.0)
    );

    // In a frame of single precision, the nearest neighbour of every point, next to cuts and elsewhere.
    let low = all.iter().copied().reduce(DVec3::min).unwrap_or_default();
    let longest = extent(&all);
    let unit = |p: DVec3| -> Vec3 { ((p - low) / longest - 0.5).as_vec3() };
    let tree = Octree::build(&all.iter().map(|&p| unit(p)).collect::<Vec<_>>());
    let boxes: Vec<(DVec3, DVec3)> = leaves
        .iter()
        .map(|leaf| cell(leaf.tile, &tileset, corner))
        .collect();
    let (mut inside, mut beside) = (Vec::new(), Vec::new());
    let mut found = Vec::new();
    for (leaf, (from, to)) in leaves.iter().zip(boxes) {
        for &p in &leaf.points {
            tree.knn(unit(p), 2, &mut found);
            let apart =
                found.last().map_or(0.0, |n| f64::from(n.distance2).sqrt()) * longest / spacing;
            let margin = (p - from).min(to - p).min_element() / spacing;
            if margin < 2.0 {
                beside.push(apart)
            } else {
                inside.push(apart)
            }
        }
    }
    for (name, mut values) in [("inside", inside), ("within two spacings of a cut", beside)] {
        values.sort_by(f64::total_cmp);
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        let quantile = |q: f64| {
            values
                .get(((values.len().max(1) - 1) as f64 * q) as usize)
                .copied()
                .unwrap_or(0.0)
        };
        println!(
            "nearest neighbour, spacings, {name}: mean {mean:.4}, closest 1 % {:.4}, farthest 1 % {:.4} ({} points)",
            quantile(0.01),
            quantile(0.99),
            values.len()
        );
    }
    Ok(())
}

fn extent(points: &[DVec3]) -> f64 {
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    (high - low).max_element()
}

/// A tile's cube in the survey's frame.
fn cell(tile: Tile, tileset: &Value, corner: DVec3) -> (DVec3, DVec3) {
    let size = tileset["asset"]["extras"]["pointweave"]["size"]
        .as_f64()
        .unwrap_or(f64::NAN);
    let side = size / f64::from(1u32 << tile.depth);
    let at = DVec3::from_array(tile.at.map(f64::from)) * side + corner - DVec3::from_array(CORNER);
    (at, at + side)
}

fn collect(
    node: &Value,
    folder: &Path,
    corner: DVec3,
    leaves: &mut Vec<Leaf>,
) -> Result<(), Box<dyn Error>> {
    if let Some(children) = node["children"].as_array() {
        return children
            .iter()
            .try_for_each(|child| collect(child, folder, corner, leaves));
    }
    let uri = node["content"]["uri"]
        .as_str()
        .ok_or("a leaf without content")?;
    let cloud = read(&std::fs::read(folder.join(uri))?, Format::Glb)?.to_cloud()?;
    let values = cloud.positions_f64();
    // glTF's axes are turned back, as what shows tilesets does.
    let points = values
        .chunks_exact(3)
        .map(|p| DVec3::new(p[0], -p[2], p[1]) + corner - DVec3::from_array(CORNER));
    let name = uri.trim_start_matches("points/").trim_end_matches(".glb");
    leaves.push(Leaf {
        points: points.collect(),
        tile: name.parse().map_err(|()| "a name that is no tile's")?,
    });
    Ok(())
}
