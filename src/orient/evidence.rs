//! What is known of the outer side besides the points themselves, and how far it is believed.

use crate::base::params::Orientation;
use crate::cloud::Cloud;
use crate::cloud::octree::Octree;
use crate::orient::account::Account;
use crate::orient::camera;
use crate::orient::domains::Domains;
use crate::orient::graph::{Edge, energy};
use crate::orient::parts::Parts;
use crate::orient::source::{SOME, Source};
use crate::reduce::shares::Shares;
use glam::Vec3;

/// The evidence of a cloud: vectors that outward normals agree with, up to unit length by how much they count; empty where a
/// source has nothing to say.
#[derive(Debug, Clone, Default)]
pub struct Evidence {
    /// The cloud's own normals.
    pub normals: Vec<Vec3>,
    /// To where it was seen from.
    pub viewpoints: Vec<Vec3>,
    /// To the origin, where the cloud looks as a camera there sees.
    pub camera: Vec<Vec3>,
    /// Up, if it is known.
    pub up: Option<Vec3>,
    /// Whether all was seen from above.
    pub above: bool,
}

/// Up where nobody says otherwise.
const UP: Vec3 = Vec3::Z;
/// Least energy, negated, of signs that a source gives sub-domains by itself, for it to be believed. Random signs have 0.02,
/// files 0.57 to 0.76, viewpoints of merged scans 0.89.
const CONSISTENT: f64 = 0.4;
/// Share of what a guessed camera sees of each part that must show it one side. Frames have 0.95 to 1, one scan of an object
/// in another frame 0.86.
const ONE_SIDED: f32 = 0.8;
/// Mean winding number from which on a part is a body that "up" says nothing of.
const BODY: f64 = 0.25;
/// Weights of sources against an edge of full agreement. What was seen is right whatever neighbours say; normals of files are
/// in part wrong (with 4, 5 to 10 % of two depth frames whose files contradict their camera follow them).
const SEEN: f32 = 4.0;
const GIVEN: f32 = 1.0;
const UPWARD: f32 = 1.0;

impl Evidence {
    /// Of each of `count` reduced points, by the input points that have most of their share in it; `shares` in the order of
    /// the cloud's `tree`.
    pub fn of(cloud: &Cloud, tree: &Octree, shares: &[Shares], count: usize) -> Evidence {
        let mut weight = vec![0.0f32; count];
        for share in shares {
            weight[share.center[0] as usize] += 1.0;
        }
        let mean = |of: &dyn Fn(usize, Vec3) -> Vec3| {
            let mut sums = vec![Vec3::ZERO; count];
            for ((share, &i), &p) in shares.iter().zip(&tree.order).zip(&tree.points) {
                sums[share.center[0] as usize] += of(i as usize, p);
            }
            let sums = sums.into_iter().zip(&weight);
            sums.map(|(sum, w)| sum / w.max(1.0)).collect()
        };
        let towards = |eye: Vec3, p: Vec3| (eye - p).normalize_or_zero();
        let eyes: Option<Vec<Vec3>> = cloud.viewpoints.as_ref().map(|viewpoints| {
            let positions = viewpoints.positions.iter();
            positions
                .map(|v| cloud.frame.to_unit(v.to_array()))
                .collect()
        });
        let origin = cloud.origin.unwrap_or_default().map(|x| -x);
        let origin = cloud.frame.to_unit(origin);
        let is_free = cloud.viewpoints.is_none() && !cloud.seen_from_above;
        Evidence {
            normals: cloud
                .normals
                .as_ref()
                .map_or(Vec::new(), |normals| mean(&|i, _| normals[i])),
            viewpoints: eyes.zip(cloud.viewpoints.as_ref()).map_or(
                Vec::new(),
                |(eyes, viewpoints)| {
                    let eye = |i: usize| {
                        let of = viewpoints.of.as_ref();
                        eyes.get(of.map_or(0, |of| of[i] as usize))
                    };
                    mean(&|i, p| eye(i).map_or(Vec3::ZERO, |&eye| towards(eye, p)))
                },
            ),
            camera: if is_free && camera::sees(origin, &tree.points) {
                mean(&|_, p| towards(origin, p))
            } else {
                Vec::new()
            },
            up: cloud.up,
            above: cloud.seen_from_above,
        }
    }

    /// Of `count` sites, from that of the reduced points; `site_of` has the site of each, if any.
    pub fn at_sites(&self, site_of: &[Option<u32>], count: usize) -> Evidence {
        let sums = |of: &[Vec3]| {
            let mut sums = vec![Vec3::ZERO; if of.is_empty() { 0 } else { count }];
            for (&v, site) in of.iter().zip(site_of) {
                if let Some(site) = site {
                    sums[*site as usize] += v;
                }
            }
            sums.into_iter().map(|v| v.clamp_length_max(1.0)).collect()
        };
        Evidence {
            normals: sums(&self.normals),
            viewpoints: sums(&self.viewpoints),
            camera: sums(&self.camera),
            ..*self
        }
    }

    /// Which way is up.
    pub(crate) fn axis(&self) -> Vec3 {
        self.up.unwrap_or(UP)
    }

    /// To the sensor that saw each site, where one is known and decided something; empty where none did.
    pub fn sensor(&self, account: &Account) -> Vec<Vec3> {
        let decided = |source| {
            let mut sources = account.sources.iter();
            sources.any(|s| s.source == source && s.share > 0.0)
        };
        if decided(Source::Viewpoints) {
            self.viewpoints.clone()
        } else if decided(Source::Camera) {
            self.camera.clone()
        } else {
            Vec::new()
        }
    }

    /// What it says of every sub-domain, and how far it is believed. `signs` and `parts` are those without evidence.
    pub(crate) fn weighed(
        &self,
        domains: &Domains,
        edges: &[Edge],
        (signs, parts): (&[f32], &Parts),
        orientation: Orientation,
    ) -> Known {
        let auto = orientation == Orientation::Auto;
        let mut known = Known {
            values: vec![0.0; domains.len()],
            unary: vec![0.0; domains.len()],
            sources: vec![Source::Guess; domains.len()],
            said: Vec::new(),
        };
        let by_vector = |vectors: &[Vec3]| -> Vec<f32> {
            let says = |s: u32| {
                let size = domains.fits.subdomains[s as usize].core.max(1);
                let all = domains.core(s).map(|(i, g)| g.dot(vectors[i as usize]));
                all.sum::<f32>() / size as f32
            };
            (0..domains.len() as u32).map(says).collect()
        };
        if (auto || orientation == Orientation::Normals) && !self.normals.is_empty() {
            let says = by_vector(&self.normals);
            let is_believed = !auto || is_consistent(edges, &says);
            known.add(Source::Normals, says, GIVEN, is_believed);
        }
        if (auto || orientation == Orientation::Viewpoints) && !self.viewpoints.is_empty() {
            let says = by_vector(&self.viewpoints);
            let is_believed = !auto || is_consistent(edges, &says);
            known.add(Source::Viewpoints, says, SEEN, is_believed);
        }
        if auto && !self.camera.is_empty() {
            let says = by_vector(&self.camera);
            if is_one_sided(&says, signs, parts) {
                known.add(Source::Camera, says, SEEN, true);
            }
        }
        if orientation == Orientation::Up || auto && self.above {
            let source = if auto { Source::Above } else { Source::Up };
            let axis = self.axis();
            let normals = domains.mean_normals(&vec![1.0; domains.len()]);
            let mut says: Vec<f32> = normals.iter().map(|n| n.dot(axis)).collect();
            for part in parts.members.iter().filter(|part| part.len() > 1) {
                if domains.enclosed(part, signs).abs() > BODY {
                    part.iter().for_each(|&s| says[s as usize] = 0.0);
                }
            }
            known.add(source, says, UPWARD, true);
        }
        known
    }
}

/// What is known of every sub-domain's side before its neighbours are asked.
#[derive(Debug)]
pub(crate) struct Known {
    /// How far its function's gradient agrees with what is believed, −1 to 1; 0 where nothing is known.
    pub(crate) values: Vec<f32>,
    /// The same as terms of the energy.
    pub(crate) unary: Vec<f32>,
    /// What that comes from.
    pub(crate) sources: Vec<Source>,
    /// All that was said, believed or not.
    pub(crate) said: Vec<(Source, Vec<f32>)>,
}

impl Known {
    /// Adds a source, which counts where those before it say nothing.
    fn add(&mut self, source: Source, says: Vec<f32>, weight: f32, is_believed: bool) {
        if is_believed {
            for (s, &x) in says.iter().enumerate() {
                if self.sources[s] == Source::Guess && x.abs() > SOME {
                    self.values[s] = x;
                    self.unary[s] = weight * x;
                    self.sources[s] = source;
                }
            }
        }
        self.said.push((source, says));
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.values.iter().all(|&x| x == 0.0)
    }
}

/// Whether signs after `says` agree with those of their neighbours.
fn is_consistent(edges: &[Edge], says: &[f32]) -> bool {
    let is_said = |s: u32| says[s as usize].abs() > SOME;
    let both: Vec<Edge> = edges
        .iter()
        .filter(|e| is_said(e.a) && is_said(e.b))
        .copied()
        .collect();
    let signs: Vec<f32> = says.iter().map(|x| x.signum()).collect();
    -energy(&both, &signs) > CONSISTENT
}

/// Whether nearly all of what is said agrees with the signs, or contradicts them, part by part.
fn is_one_sided(says: &[f32], signs: &[f32], parts: &Parts) -> bool {
    let net = parts.sums(|s| says[s as usize] * signs[s as usize]);
    let net: f32 = net.into_iter().map(f32::abs).sum();
    let all: f32 = says.iter().map(|x| x.abs()).sum();
    net > ONE_SIDED * all
}
