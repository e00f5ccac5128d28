//! Meshes of a few points, which no fit has enough of: the convex hull of what is convex, the Delaunay triangulation of what
//! is nearly flat. Neither leaves the hull of the points.
//!
//! Both come from the facets of a convex hull: the triangulation's are the lower ones of the points lifted to a paraboloid
//! (H. Edelsbrunner, R. Seidel, "Voronoi diagrams and arrangements", 1986). With so few points all planes through three
//! of them are tried, so that points in one plane or on one circle need no special case.

use crate::base::linalg::Spread;
use crate::base::params::Boundary;
use crate::fit::cells::Sites;
use crate::mesh::topology::topology;
use crate::mesh::{Extracted, Ground, Mesh, fill_normals};
use crate::orient::Signs;
use glam::{DVec2, DVec3, Vec3};

/// Most points that are meshed like this.
pub(crate) const FEW: usize = 50;
/// Points in a plane, or on one circle, are within this of it (unit frame): some times what single precision rounds.
const SAME: f64 = 1e-6;
/// Least height of a triangle that gives a plane, as a share of its longest side.
const THIN: f64 = 1e-4;
/// Convex points are no deeper than this below their hull (fraction of the diagonal).
const DEEP: f64 = 0.05;
/// Points are a sheet when they are flat to this share of their diagonal.
const FLAT: f64 = 0.02;
/// They are a height field over their plane, too, when they are flat to this share of their middle extent, and neighbours
/// keep this share of their distance there.
const SHALLOW: (f64, f64) = (0.25, 0.5);
/// Sides of a sheet's rim are at most this many times as long as the distance between nearest neighbours: the diagonal of a
/// square, and some more.
const GAP: f64 = 1.6;

/// Share of the signs, less those for it, that turn a hull.
const AGREED: f64 = 0.8;

/// A mesh of few points.
pub(crate) struct Few {
    pub(crate) mesh: Mesh,
    /// Whether it is a hull, which has an outer side.
    pub(crate) closed: bool,
}

/// The mesh through distinct points, if they are few, and convex or nearly flat.
pub(crate) fn mesh(points: &[Vec3]) -> Option<Few> {
    if !(4..=FEW).contains(&points.len()) {
        return None;
    }
    let at: Vec<DVec3> = points.iter().map(|p| p.as_dvec3()).collect();
    let plane = Plane::of(&at);
    let [_, middle, thick] = plane.extent.to_array();
    let flat = thick <= FLAT * plane.extent.length();
    let made = (!flat)
        .then(|| hull(&at))
        .flatten()
        .map(|triangles| (triangles, true))
        .or_else(|| {
            let is_sheet = flat || thick <= SHALLOW.0 * middle && plane.keeps_distances(&at);
            let triangles = is_sheet.then(|| sheet(&at, &plane)).flatten()?;
            Some((triangles, false))
        });
    let (triangles, closed) = made?;
    let whole = topology(&triangles, points.len());
    let closes = closed == (whole.boundary_edges == 0);
    if !(whole.is_manifold() && closes && whole.components == 1 && whole.genus == [0]) {
        return None;
    }
    let mut index = vec![u32::MAX; points.len()];
    let mut mesh = Mesh::default();
    for corner in triangles.as_flattened() {
        let index = &mut index[*corner as usize];
        if *index == u32::MAX {
            *index = mesh.vertices.len() as u32;
            mesh.vertices.push(points[*corner as usize]);
        }
    }
    mesh.triangles = triangles
        .iter()
        .map(|t| t.map(|corner| index[corner as usize]))
        .collect();
    mesh.normals = vec![Vec3::ZERO; mesh.vertices.len()];
    fill_normals(&mut mesh);
    Some(Few { mesh, closed })
}

impl Few {
    /// The mesh as the signs have it, and the signs' normals as the mesh has them, if they are free to be `turned`. A hull has an
    /// outer side of its own: only signs that agree with each other turn it, as those of given normals do.
    pub(crate) fn placed(
        self,
        (sites, signs): (&Sites, &mut Signs),
        (turned, boundary, ground): (bool, Boundary, &Ground),
    ) -> Extracted {
        let Few { mut mesh, closed } = self;
        let points = sites.tree.points.iter();
        let own: Vec<Vec3> = points.map(|&p| normal(&mesh, p)).collect();
        let agree = |(a, b): (&Vec3, &Vec3)| f64::from(a.dot(*b)).signum();
        let agreement = own.iter().zip(&signs.normals).map(agree).sum::<f64>() / own.len() as f64;
        let inverted = agreement < if closed { -AGREED } else { 0.0 };
        if inverted {
            mesh.invert();
        }
        if turned {
            let own = own.into_iter().map(|n| if inverted { -n } else { n });
            signs.normals = own.collect();
        }
        Extracted::of(mesh, boundary, ground)
    }
}

/// Which way a mesh looks at a point: the normal of the nearest vertex.
fn normal(mesh: &Mesh, point: Vec3) -> Vec3 {
    let away = |&v: &usize| mesh.vertices[v].distance_squared(point);
    let nearest =
        (0..mesh.vertices.len()).min_by(|a, b| away(a).total_cmp(&away(b)).then(a.cmp(b)));
    nearest.map_or(Vec3::ZERO, |v| mesh.normals[v])
}

/// The plane of least extent of some points.
struct Plane {
    /// Two tangents and the normal: right-handed.
    axes: [DVec3; 3],
    /// Of the points along these: longest, middle, shortest.
    extent: DVec3,
}

impl Plane {
    fn of(points: &[DVec3]) -> Plane {
        let [normal, _, long] = Spread::of(points.iter().copied()).eigen.vectors;
        let axes = [long, normal.cross(long), normal];
        let extent = axes.map(|axis| {
            let along = points.iter().map(|p| p.dot(axis));
            let (lo, hi) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| {
                (lo.min(x), hi.max(x))
            });
            hi - lo
        });
        Plane {
            axes,
            extent: DVec3::from_array(extent),
        }
    }

    fn on(&self, p: DVec3) -> DVec2 {
        DVec2::new(p.dot(self.axes[0]), p.dot(self.axes[1]))
    }

    /// Whether no two points fall together when they are laid into the plane.
    fn keeps_distances(&self, points: &[DVec3]) -> bool {
        (0..points.len()).all(|i| {
            let others = || points.iter().enumerate().filter(move |&(j, _)| j != i);
            let apart = others().map(|(_, q)| q.distance(points[i]));
            let along = others().map(|(_, q)| self.on(*q).distance(self.on(points[i])));
            let least = |distances: &mut dyn Iterator<Item = f64>| distances.fold(1e9, f64::min);
            least(&mut along.into_iter()) >= SHALLOW.1 * least(&mut apart.into_iter())
        })
    }
}

/// The corners of a facet of a convex hull, counter-clockwise seen from outside.
struct Facet {
    normal: DVec3,
    corners: Vec<u32>,
}

/// The facets of the convex hull of at most 64 points.
fn facets(points: &[DVec3]) -> Vec<Facet> {
    let mut found: Vec<(u64, DVec3)> = Vec::new();
    for i in 0..points.len() {
        for j in i + 1..points.len() {
            for k in j + 1..points.len() {
                let these = 1u64 << i | 1 << j | 1 << k;
                if found.iter().any(|(members, _)| members & these == these) {
                    continue;
                }
                let (u, v) = (points[j] - points[i], points[k] - points[i]);
                let longest = u.length().max(v.length()).max((v - u).length());
                let cross = u.cross(v);
                if cross.length() <= THIN * longest * longest {
                    continue;
                }
                let mut normal = cross.normalize();
                let away = |p: &DVec3| normal.dot(*p - points[i]);
                let (lo, hi) = points
                    .iter()
                    .map(away)
                    .fold((0.0f64, 0.0f64), |(lo, hi), d| (lo.min(d), hi.max(d)));
                if lo < -SAME && hi > SAME {
                    continue;
                }
                let on = |(p, bit): (&DVec3, u64)| if away(p).abs() <= SAME { bit } else { 0 };
                let bits = (0..).map(|bit| 1u64 << bit);
                let members = points.iter().zip(bits).map(on).fold(0, |a, b| a | b);
                if hi > SAME {
                    normal = -normal;
                }
                found.push((members, normal));
            }
        }
    }
    found
        .into_iter()
        .map(|(members, normal)| Facet {
            normal,
            corners: outline(points, members, normal),
        })
        .collect()
}

/// The strictly convex outline of points in a plane, counter-clockwise seen against the normal (A. M. Andrew, 1979).
fn outline(points: &[DVec3], members: u64, normal: DVec3) -> Vec<u32> {
    let u = normal.any_orthonormal_vector();
    let v = normal.cross(u);
    let at = |i: u32| DVec2::new(points[i as usize].dot(u), points[i as usize].dot(v));
    let mut order: Vec<u32> = (0..points.len() as u32)
        .filter(|i| members >> i & 1 == 1)
        .collect();
    order.sort_by(|&a, &b| {
        let (a, b) = (at(a), at(b));
        a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
    });
    let half = |order: &mut dyn Iterator<Item = u32>| {
        let mut chain: Vec<u32> = Vec::new();
        for c in order {
            while let [.., a, b] = chain[..] {
                let (ab, ac) = (at(b) - at(a), at(c) - at(a));
                // A point that is on the line between its neighbours is no corner.
                if ab.perp_dot(ac) > THIN * ac.length() * ab.length() {
                    break;
                }
                chain.pop();
            }
            chain.push(c);
        }
        chain.pop();
        chain
    };
    let mut corners = half(&mut order.iter().copied());
    corners.extend(half(&mut order.iter().rev().copied()));
    corners
}

fn fan(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    corners
        .windows(2)
        .skip(1)
        .map(|pair| [corners[0], pair[0], pair[1]])
}

/// The hull of convex points.
fn hull(points: &[DVec3]) -> Option<Vec<[u32; 3]>> {
    let facets = facets(points);
    let depth = |p: &DVec3| {
        let below = facets.iter().filter_map(|f| {
            let corner = points[*f.corners.first()? as usize];
            Some(f.normal.dot(corner - *p))
        });
        below.fold(f64::INFINITY, f64::min)
    };
    let diagonal = Plane::of(points).extent.length();
    let convex = points.iter().all(|p| depth(p) <= DEEP * diagonal);
    convex.then(|| facets.iter().flat_map(|f| fan(&f.corners)).collect())
}

/// The Delaunay triangulation of points in a plane, without long triangles at its rim; it looks along the plane's normal.
fn sheet(points: &[DVec3], plane: &Plane) -> Option<Vec<[u32; 3]>> {
    let flat: Vec<DVec2> = points.iter().map(|&p| plane.on(p)).collect();
    let middle = flat.iter().sum::<DVec2>() / flat.len() as f64;
    let lifted: Vec<DVec3> = flat
        .iter()
        .map(|p| p.extend((*p - middle).length_squared()))
        .collect();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for facet in facets(&lifted).iter().filter(|f| f.normal.z < 0.0) {
        // Seen from below they are clockwise from above.
        triangles.extend(fan(&facet.corners).map(|[a, b, c]| [a, c, b]));
    }
    // Points in a line at the rim make triangles that are nothing but rounding.
    triangles.retain(|t| {
        let [a, b, c] = t.map(|v| flat[v as usize]);
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        (b - a).perp_dot(c - a) > 10.0 * THIN * longest * longest
    });
    peel(&mut triangles, points);
    (!triangles.is_empty()).then_some(triangles)
}

/// Takes away triangles at the rim whose side there is longer than [`GAP`] allows, as long as that leaves a sheet.
fn peel(triangles: &mut Vec<[u32; 3]>, points: &[DVec3]) {
    let apart = |a: u32, b: u32| points[a as usize].distance(points[b as usize]);
    let all = 0..points.len() as u32;
    let nearest = all.clone().map(|a| {
        let others = all.clone().filter(|&b| b != a);
        others.map(|b| apart(a, b)).fold(f64::INFINITY, f64::min)
    });
    let longest = GAP * nearest.fold(0.0, f64::max);
    loop {
        let sides = |t: &[u32; 3]| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
        let all: Vec<(u32, u32)> = triangles.iter().flat_map(sides).collect();
        let is_rim = |&(a, b): &(u32, u32)| !all.contains(&(b, a));
        let rim: Vec<(u32, u32)> = all.iter().copied().filter(is_rim).collect();
        let on_rim = |v: u32| rim.iter().any(|&(a, b)| a == v || b == v);
        let far = triangles.iter().position(|t| {
            (0..3).any(|k| {
                let (a, b, c) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
                rim.contains(&(a, b)) && apart(a, b) > longest && !on_rim(c)
            })
        });
        match far {
            Some(t) => _ = triangles.remove(t),
            None => break,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::rng::Rng;
    use crate::mesh::topology::{area, volume};

    fn unit(points: Vec<DVec3>) -> Vec<Vec3> {
        points.into_iter().map(|p| (0.4 * p).as_vec3()).collect()
    }

    #[test]
    fn corners_sides_and_faces_of_a_cube_are_the_cube() {
        let grid = |n: i32, keep: fn(i32, i32) -> bool| {
            let at =
                move |i: i32| DVec3::new((i % n).into(), (i / n % n).into(), (i / n / n).into());
            let on = move |p: &DVec3| {
                let sides = p
                    .to_array()
                    .into_iter()
                    .filter(|&x| x == 0.0 || x == f64::from(n - 1));
                keep(sides.count() as i32, n)
            };
            unit(
                (0..n * n * n)
                    .map(at)
                    .filter(on)
                    .map(|p| p / f64::from(n - 1))
                    .collect(),
            )
        };
        let corners = grid(2, |_, _| true);
        let sides = grid(3, |sides, _| sides >= 2);
        let faces = grid(3, |sides, _| sides >= 1);
        for (points, count) in [(corners, 8), (sides, 20), (faces, 26)] {
            assert_eq!(points.len(), count);
            let few = mesh(&points).unwrap();
            assert!(few.closed);
            let Mesh {
                vertices,
                triangles,
                ..
            } = &few.mesh;
            assert_eq!((vertices.len(), triangles.len()), (8, 12));
            assert!((volume(vertices, triangles) - 0.4f64.powi(3)).abs() < 1e-6);
        }
    }

    #[test]
    fn points_of_a_ball_are_closed_inside_of_it() {
        for n in [4, 6, 12, 25, 50] {
            let mut rng = Rng::new(n);
            let mut random = || DVec3::new(rng.normal(), rng.normal(), rng.normal()).normalize();
            let points = unit((0..n).map(|_| random()).collect());
            let few = mesh(&points).unwrap();
            assert_eq!((few.closed, few.mesh.vertices.len()), (true, n as usize));
            assert!(volume(&few.mesh.vertices, &few.mesh.triangles) > 0.0);
        }
    }

    #[test]
    fn a_flat_grid_is_its_square_and_an_l_stays_an_l() {
        let grid = |keep: fn(i32, i32) -> bool| {
            let all = (0..25).map(|i| (i % 5, i / 5)).filter(|&(x, y)| keep(x, y));
            // Tilted, so that single precision rounds it.
            let at = |(x, y): (i32, i32)| {
                let (x, y) = (f64::from(x) / 5.0, f64::from(y) / 5.0);
                DVec3::new(0.6 * x + 0.1 * y, 0.8 * y, 0.3 * x - 0.2 * y)
            };
            unit(all.map(at).collect())
        };
        let [square, l] = [grid(|_, _| true), grid(|x, y| x < 2 || y < 2)];
        let cell = {
            let [a, b, c] = [square[0], square[1], square[5]].map(|p| p.as_dvec3());
            (b - a).cross(c - a).length()
        };
        for (points, cells) in [(square, 16.0), (l, 7.0)] {
            let few = mesh(&points).unwrap();
            assert!(!few.closed);
            assert_eq!(few.mesh.vertices.len(), points.len());
            let area = area(&few.mesh.vertices, &few.mesh.triangles) / cell;
            // The inner corner of the L may keep half a cell.
            assert!(
                (cells - 0.01..cells + 0.51).contains(&area),
                "{area} of {cells}"
            );
        }
    }

    #[test]
    fn what_is_neither_convex_nor_flat_is_left_to_the_fit() {
        let mut rng = Rng::new(3);
        let mut random = || DVec3::new(rng.uniform(), rng.uniform(), rng.uniform());
        let cloud = unit((0..40).map(|_| random()).collect());
        assert!(mesh(&cloud).is_none());
        let saddle = (0..36).map(|i| {
            let (x, y) = (f64::from(i % 6) / 5.0 - 0.5, f64::from(i / 6) / 5.0 - 0.5);
            DVec3::new(x, y, 0.4 * (x * x - y * y))
        });
        // A shallow saddle is a sheet: a height field.
        assert!(!mesh(&unit(saddle.collect())).unwrap().closed);
    }
}
