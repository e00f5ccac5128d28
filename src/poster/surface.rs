//! The light on a mesh: the material that `write` gives GLB files, as three.js shows it in the neutral studio.

use super::camera::Camera;
use super::picture::Mipmaps;
use super::scene::{Pixels, Scene};
use super::strip::SAMPLES;
use super::studio::Studio;
use super::triangles::Placed;
use crate::base::srgb::{self, srgb};
use glam::{DMat3, DVec3};

/// Of the material: `formats/write/glb.rs`.
const ROUGHNESS: f64 = 0.9;
/// What is reflected of light that falls in straight, of what is no metal.
const STRAIGHT: f64 = 0.04;

/// A mesh and what lights it, upright.
pub(super) struct Surface<'a> {
    corners: &'a [[u32; 3]],
    points: &'a [DVec3],
    normals: Vec<DVec3>,
    /// Linear, one a vertex.
    colors: Vec<[f64; 3]>,
    tangents: Vec<(DVec3, f64)>,
    uvs: Option<&'a [[f32; 2]]>,
    color: Option<Mipmaps>,
    relief: Option<Mipmaps>,
    shade: Option<Mipmaps>,
    matt: Studio,
    glossy: Studio,
}

impl<'a> Surface<'a> {
    pub(super) fn new(
        scene: &Scene<'a>,
        corners: &'a [[u32; 3]],
        points: &'a [DVec3],
        stand: DMat3,
    ) -> Surface<'a> {
        let normals = match scene.normals {
            Some(normals) => normals.iter().map(|n| stand * n.as_dvec3()).collect(),
            None => normals(points, corners),
        };
        let linear: [f64; 256] = std::array::from_fn(|byte| srgb::linear(byte as f64 / 255.0));
        let colors = scene.colors.unwrap_or_default().iter();
        let turned = |t: &[f32; 4]| {
            let along = DVec3::new(t[0].into(), t[1].into(), t[2].into());
            (stand * along, f64::from(t[3]))
        };
        let tangents: Vec<_> = scene
            .tangents
            .unwrap_or_default()
            .iter()
            .map(turned)
            .collect();
        let picture = |pixels: Option<Pixels>, meaning: fn(u8) -> f32| {
            let pixels = pixels.filter(|_| scene.uvs.is_some());
            pixels.map(|pixels| Mipmaps::of(pixels, meaning))
        };
        let relief = scene.normal.filter(|_| !tangents.is_empty());
        Surface {
            corners,
            points,
            normals,
            colors: colors
                .map(|c| c.map(|byte| linear[usize::from(byte)]))
                .collect(),
            uvs: scene.uvs,
            color: picture(scene.color, |byte| {
                srgb::linear(f64::from(byte) / 255.0) as f32
            }),
            relief: picture(relief, |byte| f32::from(byte) / 127.5 - 1.0),
            shade: picture(scene.occlusion, |byte| f32::from(byte) / 255.0),
            tangents,
            matt: Studio::of(1.0),
            glossy: Studio::of(ROUGHNESS),
        }
    }

    /// sRGB at a sample of the picture, where that triangle is seen.
    pub(super) fn color(&self, triangle: &Placed, sample: [f64; 2], camera: &Camera) -> [u8; 3] {
        let corner = self.corners[triangle.index as usize].map(|v| v as usize);
        let [x, y] = [0, 1].map(|k| sample[k] - camera.middle()[k]);
        let share = shares(triangle, x, y);
        let [a, b, c] = corner.map(|v| self.points[v]);
        let place = a * share[0] + b * share[1] + c * share[2];
        let view = (camera.place - place).normalize_or(DVec3::Z);
        let outside = (b - a).cross(c - a).dot(camera.place - place) >= 0.0;
        let side = if outside { 1.0 } else { -1.0 };
        let mixed = |of: &dyn Fn(usize) -> DVec3| {
            (0..3).fold(DVec3::ZERO, |sum, k| sum + of(corner[k]) * share[k])
        };
        let mut normal = mixed(&|v| self.normals[v]).normalize_or(view) * side;
        let (mut base, mut open) = ([1.0; 3], 1.0);
        if let Some(uvs) = self.uvs {
            let at = |share: [f64; 3]| {
                [0, 1].map(|k| {
                    (0..3)
                        .map(|i| share[i] * f64::from(uvs[corner[i]][k]))
                        .sum::<f64>()
                })
            };
            let here = at(share);
            let step = SAMPLES as f64;
            let beside = [shares(triangle, x + step, y), shares(triangle, x, y + step)].map(at);
            let wide = |picture: &Mipmaps| {
                let [width, height] = picture.size();
                let length = |p: [f64; 2]| {
                    let [u, v] = [(p[0] - here[0]) * width, (p[1] - here[1]) * height];
                    u * u + v * v
                };
                0.5 * libm::log2(length(beside[0]).max(length(beside[1])).max(1.0))
            };
            if let Some(picture) = &self.color {
                base = picture.at(here, wide(picture));
            }
            if let Some(picture) = &self.shade {
                [open, ..] = picture.at(here, wide(picture));
            }
            if let Some(picture) = &self.relief {
                let [u, v, w] = picture.at(here, wide(picture));
                let along = mixed(&|v| self.tangents[v].0).normalize_or(DVec3::X) * side;
                let sign = self.tangents[corner[0]].1;
                let across = mixed(&|v| self.normals[v].cross(self.tangents[v].0));
                let across = across.normalize_or(DVec3::Y) * (sign * side);
                normal = (along * u + across * v + normal * w).normalize_or(normal);
            }
        }
        if self.color.is_none() && !self.colors.is_empty() {
            base = [0, 1, 2].map(|c| (0..3).map(|k| share[k] * self.colors[corner[k]][c]).sum());
        }
        shown(self.lit(base, open, normal, view))
    }

    /// Linear light towards the camera; `open` is the share of the light around that comes to the place.
    fn lit(&self, base: [f64; 3], open: f64, normal: DVec3, view: DVec3) -> [f64; 3] {
        let facing = normal.dot(view).clamp(0.0, 1.0);
        let mirrored = normal * (2.0 * normal.dot(view)) - view;
        let rough = ROUGHNESS * ROUGHNESS * ROUGHNESS * ROUGHNESS;
        let towards = mirrored.lerp(normal, rough).normalize_or(normal);
        let (matt, glossy) = (self.matt.from(normal), self.glossy.from(towards));
        let [scale, bias] = reflected(facing);
        let single = STRAIGHT * scale + bias;
        let missing = 1.0 - scale - bias;
        let mean = STRAIGHT + (1.0 - STRAIGHT) / 21.0;
        let multiple = single * mean / (1.0 - missing * mean) * missing;
        // S. Lagarde, C. de Rousiers, "Moving Frostbite to physically based rendering", 2014, section 4.10.2.
        let sharp = libm::exp2(-16.0 * ROUGHNESS - 1.0);
        let mirror = (libm::pow(facing + open, sharp) - 1.0 + open).clamp(0.0, 1.0);
        base.map(|c| {
            (glossy * single + matt * multiple) * mirror
                + matt * c * (1.0 - single - multiple) * open
        })
    }
}

/// The shares of the corners at a place, in samples from the picture's middle.
fn shares(triangle: &Placed, x: f64, y: f64) -> [f64; 3] {
    let weights = triangle.weights.map(|w| w.x * x + w.y * y + w.z);
    let sum: f64 = weights.iter().sum();
    weights.map(|w| w / sum)
}

/// How much of what is reflected straight, and of all, comes back (B. Karis, "Physically based shading on mobile", 2014).
fn reflected(facing: f64) -> [f64; 2] {
    let r = [
        1.0 - ROUGHNESS,
        0.0425 - 0.0275 * ROUGHNESS,
        1.04 - 0.572 * ROUGHNESS,
        0.022 * ROUGHNESS - 0.04,
    ];
    let a = (r[0] * r[0]).min(libm::exp2(-9.28 * facing)) * r[0] + r[1];
    [r[2] - 1.04 * a, r[3] + 1.04 * a]
}

/// Linear light as the display has it: the neutral tone mapper of the Khronos group, and sRGB.
fn shown(light: [f64; 3]) -> [u8; 3] {
    const START: f64 = 0.8 - 0.04;
    const DESATURATION: f64 = 0.15;
    let least = light[0].min(light[1]).min(light[2]);
    let offset = if least < 0.08 {
        least - 6.25 * least * least
    } else {
        0.04
    };
    let mut color = light.map(|c| c - offset);
    let peak = color[0].max(color[1]).max(color[2]);
    if peak >= START {
        let room = 1.0 - START;
        let pressed = 1.0 - room * room / (peak + room - START);
        let white = 1.0 - 1.0 / (DESATURATION * (peak - pressed) + 1.0);
        color = color.map(|c| (1.0 - white) * c * pressed / peak + white * pressed);
    }
    color.map(|c| (255.0 * srgb(c.clamp(0.0, 1.0))).round() as u8)
}

/// The mean of the triangles' normals at each vertex, weighted by area.
fn normals(points: &[DVec3], corners: &[[u32; 3]]) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; points.len()];
    for corner in corners {
        let [a, b, c] = corner.map(|v| points[v as usize]);
        let cross = (b - a).cross(c - a);
        corner.iter().for_each(|&v| sums[v as usize] += cross);
    }
    sums.into_iter()
        .map(|sum| sum.normalize_or_zero())
        .collect()
}
