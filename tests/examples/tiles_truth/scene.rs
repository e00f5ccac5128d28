//! The survey: solids on a relief.

use glam::DVec3;
use pointweave::base::rng::Rng;
use pointweave::samples::{Model, sample_with_noise};
use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// Side of a plot, in metres.
const PLOT: f64 = 10.0;
/// Points of a plot: of the ground, and of the solid on it.
const GROUND: usize = 7000;
const SOLID: usize = 3000;
/// Standard deviation of the range, in metres.
pub const NOISE: f64 = 0.01;
/// A solid's longest extent, in metres.
const TALL: f64 = 4.0;
/// Where the survey lies.
pub const CORNER: [f64; 3] = [400_000.0, 5_700_000.0, 100.0];

/// Height of the ground over a place of the survey.
pub fn ground(x: f64, y: f64) -> f64 {
    3.0 * (x / 23.0).sin() * (y / 31.0).cos() + 0.5 * (x / 5.3 + 1.0).sin() * (y / 4.1).sin()
}

/// A solid as it stands in a plot.
pub struct Standing {
    pub model: Model,
    /// Metres for one of its centimetres.
    scale: f64,
    /// Its middle and its lowest point.
    foot: DVec3,
}

impl Standing {
    /// Of a plot by its row and column.
    pub fn of(row: usize, column: usize) -> Standing {
        let model = Model::ALL[(row * 7 + column * 3) % Model::ALL.len()];
        let (low, high) = model.bounds();
        let middle = (low + high) / 2.0;
        Standing {
            model,
            scale: TALL / (high - low).max_element(),
            foot: DVec3::new(middle.x, middle.y, low.z),
        }
    }

    /// From the survey to the model's own frame.
    fn local(&self, p: DVec3, base: DVec3) -> DVec3 {
        (p - base) / self.scale + self.foot
    }

    fn survey(&self, p: DVec3, base: DVec3) -> DVec3 {
        (p - self.foot) * self.scale + base
    }
}

/// Where the solid of a plot stands: a little above the ground.
fn base(row: usize, column: usize) -> DVec3 {
    let (x, y) = (PLOT * (column as f64 + 0.5), PLOT * (row as f64 + 0.5));
    DVec3::new(x, y, ground(x, y) + 1.5)
}

/// Distance of a place of the survey from the nearest surface.
pub fn distance(p: DVec3, side: usize) -> f64 {
    let slope = 1e-3;
    let z = ground(p.x, p.y);
    let dx = (ground(p.x + slope, p.y) - z) / slope;
    let dy = (ground(p.x, p.y + slope) - z) / slope;
    let to_ground = (p.z - z).abs() / (1.0 + dx * dx + dy * dy).sqrt();
    let plot = |x: f64| ((x / PLOT) as usize).min(side - 1);
    let (row, column) = (plot(p.y), plot(p.x));
    let standing = Standing::of(row, column);
    let at = standing.local(p, base(row, column));
    to_ground.min(standing.model.distance(at).abs() * standing.scale)
}

/// Plots along a side of a survey of so many points.
pub fn side_of(points: u64) -> usize {
    ((points as f64 / (GROUND + SOLID) as f64).sqrt().round() as usize).max(1)
}

/// Writes about so many points, rows of plots to each file.
pub fn write(points: u64, files: usize, folder: &Path) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    let side = side_of(points);
    let scans: Vec<_> = Model::ALL
        .map(|model| sample_with_noise(model, 40 * SOLID, 3, 0.0))
        .into_iter()
        .collect();
    for file in 0..files {
        let path = folder.join(format!("survey-{file:03}.laz"));
        let mut writer = las::Writer::new(BufWriter::new(File::create(path)?), header()?)?;
        for row in side * file / files..side * (file + 1) / files {
            for column in 0..side {
                plot((row, column), &scans, &mut |p, color| {
                    let [x, y, z] = [0, 1, 2].map(|axis| p[axis] + CORNER[axis]);
                    writer.write_point(las::Point {
                        x,
                        y,
                        z,
                        intensity: u16::from(color[0]) * 100,
                        classification: las::point::Classification::new(if color[2] == 80 {
                            2
                        } else {
                            6
                        })?,
                        color: Some(las::Color::new(
                            u16::from(color[0]) * 257,
                            u16::from(color[1]) * 257,
                            u16::from(color[2]) * 257,
                        )),
                        ..Default::default()
                    })
                })?;
            }
        }
        writer.close()?;
    }
    println!(
        "{} points on {side} x {side} plots",
        side * side * (GROUND + SOLID)
    );
    Ok(())
}

fn header() -> Result<las::Header, Box<dyn Error>> {
    let mut builder = las::Builder::from((1, 2));
    builder.point_format = las::point::Format::new(2)?;
    builder.point_format.is_compressed = true;
    let transform = |offset| las::Transform {
        scale: 0.001,
        offset,
    };
    builder.transforms = las::Vector {
        x: transform(CORNER[0]),
        y: transform(CORNER[1]),
        z: transform(CORNER[2]),
    };
    Ok(builder.into_header()?)
}

/// The points of a plot, with their colours.
fn plot(
    (row, column): (usize, usize),
    scans: &[pointweave::samples::Sample],
    write: &mut dyn FnMut(DVec3, [u8; 3]) -> las::Result<()>,
) -> las::Result<()> {
    let mut rng = Rng::new((row as u64) << 32 | column as u64);
    for _ in 0..GROUND {
        let x = PLOT * (column as f64 + rng.uniform());
        let y = PLOT * (row as f64 + rng.uniform());
        let shade = (120.0 + 60.0 * (x / 3.0).sin() * (y / 4.0).cos()) as u8;
        write(
            DVec3::new(x, y, ground(x, y) + NOISE * rng.normal()),
            [shade, 140, 80],
        )?;
    }
    let standing = Standing::of(row, column);
    let scan = &scans[Model::ALL
        .iter()
        .position(|&model| model == standing.model)
        .unwrap_or(0)];
    let first = (rng.uniform() * 37.0) as usize;
    for i in (first..).step_by(40).take(SOLID) {
        let triple = |values: &[f32]| {
            DVec3::new(
                f64::from(values[3 * i]),
                f64::from(values[3 * i + 1]),
                f64::from(values[3 * i + 2]),
            )
        };
        let along = triple(&scan.normals) * NOISE * rng.normal();
        let p = standing.survey(triple(&scan.positions), base(row, column)) + along;
        write(
            p,
            [
                scan.colors[3 * i],
                scan.colors[3 * i + 1],
                scan.colors[3 * i + 2],
            ],
        )?;
    }
    Ok(())
}
