//! Solids described by signed distances: a few exact primitives, placed, and joined or cut one after the other.
//!
//! Distances are negative inside. Every primitive is the exact Euclidean signed distance; every operation keeps the
//! field 1-Lipschitz (`|f(a) - f(b)| ≤ |a - b|`), so `|f|` never exceeds the distance to the surface and a ray may
//! always step by it. Smooth joins are the quadratic polynomial minimum: a convex combination of the two gradients.

use glam::DVec3;

/// A primitive in its own frame, centred at 0.
pub(super) enum Shape {
    /// Half axes.
    Ellipsoid(DVec3),
    /// Two spheres (centre, radius) and the cone that is tangent to both.
    RoundCone(DVec3, f64, DVec3, f64),
    /// Ring around the y axis: radius of the centre line, radius of the tube.
    Torus(f64, f64),
    /// Part of a ring in the xy plane, open at +y: radius of the centre line, half of the opening's complement as
    /// (sin, cos), radius of the tube.
    Arc(f64, [f64; 2], f64),
    /// Cylinder along x: half length, radius, and how much of these is rounded off at the rims.
    Disc(f64, f64, f64),
    /// Box: half sizes, and how much of these is rounded off at the edges.
    Block(DVec3, f64),
    /// Tube of one radius along a chain of points.
    Tube(Vec<DVec3>, f64),
}

impl Shape {
    /// The exact signed distance where that is less than `limit`, else some value not less than `limit`.
    fn distance_below(&self, p: DVec3, limit: f64) -> f64 {
        if let Shape::Ellipsoid(half_axes) = self {
            // |p / r| grows by at most 1 / min r a unit of length.
            let bound = ((p / *half_axes).length() - 1.0) * half_axes.min_element();
            if bound >= limit {
                return bound;
            }
        }
        self.distance(p)
    }

    /// Exact signed distance.
    fn distance(&self, p: DVec3) -> f64 {
        match self {
            Shape::Ellipsoid(half_axes) => ellipsoid(p, *half_axes),
            Shape::RoundCone(a, radius_a, b, radius_b) => {
                round_cone(p, *a, *radius_a, *b, *radius_b)
            }
            Shape::Torus(ring, tube) => length2(length2(p.x, p.z) - ring, p.y) - tube,
            Shape::Arc(ring, [sin, cos], tube) => {
                let x = p.x.abs();
                let y = -p.y;
                let in_opening = cos * x > sin * y;
                let from_line = if in_opening {
                    length2(x - ring * sin, y - ring * cos)
                } else {
                    length2(x, y) - ring
                };
                length2(from_line, p.z) - tube
            }
            Shape::Disc(half, radius, round) => {
                let across = length2(p.y, p.z) - (radius - round);
                let along = p.x.abs() - (half - round);
                corner(across, along) - round
            }
            Shape::Block(half, round) => {
                let q = p.abs() - (*half - DVec3::splat(*round));
                q.max(DVec3::ZERO).length() + q.max_element().min(0.0) - round
            }
            Shape::Tube(points, radius) => {
                let nearest = points
                    .windows(2)
                    .map(|ends| segment_squared(p, ends[0], ends[1]))
                    .fold(f64::INFINITY, f64::min);
                nearest.sqrt() - radius
            }
        }
    }

    /// Centre and radius of a ball around the shape, in its own frame.
    fn ball(&self) -> (DVec3, f64) {
        match self {
            Shape::Ellipsoid(half_axes) => (DVec3::ZERO, half_axes.max_element()),
            Shape::RoundCone(a, radius_a, b, radius_b) => {
                let half = (*b - *a).length() / 2.0;
                ((*a + *b) / 2.0, half + radius_a.max(*radius_b))
            }
            Shape::Torus(ring, tube) | Shape::Arc(ring, _, tube) => (DVec3::ZERO, ring + tube),
            Shape::Disc(half, radius, _) => (DVec3::ZERO, length2(*half, *radius)),
            Shape::Block(half, _) => (DVec3::ZERO, half.length()),
            Shape::Tube(points, radius) => {
                let center = points.iter().sum::<DVec3>() / points.len() as f64;
                let reach = points
                    .iter()
                    .map(|q| q.distance(center))
                    .fold(0.0, f64::max);
                (center, reach + radius)
            }
        }
    }
}

/// What a part does to the solid made so far.
enum Join {
    Add,
    Cut,
}

/// A placed primitive and how it joins the parts before it.
pub(super) struct Part {
    shape: Shape,
    at: DVec3,
    /// Rows of the rotation from the solid's frame to the shape's.
    turn: [DVec3; 3],
    mirrored: bool,
    join: Join,
    /// Width of the smooth seam; 0 joins sharply.
    blend: f64,
    color: [u8; 3],
    /// Ball around the placed shape; [`Solid::new`] finds it.
    ball: (DVec3, f64),
}

impl Part {
    /// A part that adds `shape` at the origin with a sharp seam, white.
    pub(super) fn add(shape: Shape) -> Part {
        Part {
            ball: (DVec3::ZERO, f64::INFINITY),
            shape,
            at: DVec3::ZERO,
            turn: [DVec3::X, DVec3::Y, DVec3::Z],
            mirrored: false,
            join: Join::Add,
            blend: 0.0,
            color: [255; 3],
        }
    }

    /// A part that takes `shape` away.
    pub(super) fn cut(shape: Shape) -> Part {
        Part {
            join: Join::Cut,
            ..Part::add(shape)
        }
    }

    pub(super) fn at(mut self, x: f64, y: f64, z: f64) -> Part {
        self.at = DVec3::new(x, y, z);
        self
    }

    /// Turns the shape around an axis of the solid's frame, counter-clockwise; turns add up in order.
    pub(super) fn turned(mut self, axis: DVec3, degrees: f64) -> Part {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        // Rows of (R · previous)ᵀ are the old rows turned by R.
        self.turn = self
            .turn
            .map(|v| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos)));
        self
    }

    /// Adds the mirror image in the plane z = 0 as well; the shape itself must lie at z > 0.
    pub(super) fn mirrored(mut self) -> Part {
        self.mirrored = true;
        self
    }

    pub(super) fn blend(mut self, width: f64) -> Part {
        self.blend = width;
        self
    }

    pub(super) fn color(mut self, color: [u8; 3]) -> Part {
        self.color = color;
        self
    }

    /// Its distance where that is less than `limit`, else some value not less than `limit`.
    fn distance_below(&self, p: DVec3, limit: f64) -> f64 {
        let folded = if self.mirrored {
            DVec3::new(p.x, p.y, p.z.abs())
        } else {
            p
        };
        let reach = limit + self.ball.1;
        if reach <= 0.0 || folded.distance_squared(self.ball.0) >= reach * reach {
            return f64::INFINITY;
        }
        let q = folded - self.at;
        let local = DVec3::new(
            self.turn[0].dot(q),
            self.turn[1].dot(q),
            self.turn[2].dot(q),
        );
        self.shape.distance_below(local, limit)
    }
}

/// Parts joined in order.
pub(super) struct Solid(Vec<Part>);

impl Solid {
    pub(super) fn new(mut parts: Vec<Part>) -> Solid {
        for part in &mut parts {
            let (center, radius) = part.shape.ball();
            let [x, y, z] = part.turn;
            part.ball = (part.at + x * center.x + y * center.y + z * center.z, radius);
        }
        Solid(parts)
    }

    /// Signed distance.
    pub(super) fn distance(&self, p: DVec3) -> f64 {
        self.fold(p, |_, _| ())
    }

    /// Colour near the surface; blended where the parts are.
    pub(super) fn color(&self, p: DVec3) -> [u8; 3] {
        let mut mixed = DVec3::ZERO;
        self.fold(p, |part, share| {
            let [r, g, b] = part.color.map(f64::from);
            mixed += (DVec3::new(r, g, b) - mixed) * share;
        });
        mixed.to_array().map(|c| c.round() as u8)
    }

    /// Joins the parts' distances; `see` is told each part's share (0 to 1) in the value made so far.
    fn fold(&self, p: DVec3, mut see: impl FnMut(&Part, f64)) -> f64 {
        let mut d = f64::INFINITY;
        for part in &self.0 {
            // Beyond these limits the part changes nothing, so its distance need not be known.
            let share;
            (d, share) = match part.join {
                Join::Add => smooth_min(d, part.distance_below(p, d + part.blend), part.blend),
                Join::Cut => {
                    let cut = part.distance_below(p, part.blend - d);
                    let (value, share) = smooth_min(-d, cut, part.blend);
                    (-value, share)
                }
            };
            see(part, share);
        }
        d
    }
}

/// Quadratic smooth minimum of width `k`, and the share of `b` in it (0 to 1).
fn smooth_min(a: f64, b: f64, k: f64) -> (f64, f64) {
    let gap = (a - b).abs();
    if gap >= k {
        return if a < b { (a, 0.0) } else { (b, 1.0) };
    }
    let h = (k - gap) / k;
    let minor = h / 2.0;
    (
        a.min(b) - h * h * k / 4.0,
        if a < b { minor } else { 1.0 - minor },
    )
}

fn length2(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

/// Signed distance of the quadrant x ≤ 0, y ≤ 0.
pub(super) fn corner(x: f64, y: f64) -> f64 {
    length2(x.max(0.0), y.max(0.0)) + x.max(y).min(0.0)
}

fn segment_squared(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let ab = b - a;
    let t = ((p - a).dot(ab) / ab.length_squared()).clamp(0.0, 1.0);
    (p - a - ab * t).length_squared()
}

/// Signed distance of a round cone, in the half plane through the axis a-b and p.
fn round_cone(p: DVec3, a: DVec3, radius_a: f64, b: DVec3, radius_b: f64) -> f64 {
    let axis = b - a;
    let length = axis.length();
    let along = (p - a).dot(axis) / length;
    let across = ((p - a).length_squared() - along * along).max(0.0).sqrt();
    // The flank is turned from the axis by the angle of this sine.
    let sin = (radius_a - radius_b) / length;
    let cos = (1.0 - sin * sin).sqrt();
    let foot = cos * along - sin * across;
    if foot < 0.0 {
        length2(across, along) - radius_a
    } else if foot > cos * length {
        length2(across, along - length) - radius_b
    } else {
        cos * across + sin * along - radius_a
    }
}

/// Signed distance of an ellipsoid: the nearest point is `r² y / (t + r²)`, t the largest root of
/// `F(t) = Σ (r y / (t + r²))² - 1` (Eberly, "Distance from a Point to an Ellipse, an Ellipsoid, or a
/// Hyperellipsoid", 2013, §2). F falls and is convex there, so Newton's method from the left climbs to it without
/// overshooting.
fn ellipsoid(p: DVec3, r: DVec3) -> f64 {
    const STEPS: usize = 40;
    let r2 = r * r;
    // Off the symmetry planes by a hair, so that no term of F vanishes.
    let y = p.abs().max(r * 1e-12);
    let ry = r * y;
    // Each term alone, and all with the longest axis, bound the root from below.
    let mut t = (ry - r2).max_element().max(ry.length() - r2.max_element());
    for _ in 0..STEPS {
        let inverse = (r2 + DVec3::splat(t)).recip();
        let terms = ry * inverse;
        let terms = terms * terms;
        let value = terms.element_sum() - 1.0;
        let step = value / (2.0 * terms.dot(inverse));
        t += step;
        if step <= 1e-14 * r2.max_element() {
            break;
        }
    }
    let nearest = r2 * y / (r2 + DVec3::splat(t));
    let outside = (y / r).length_squared() >= 1.0;
    let gap = nearest.distance(y);
    if outside { gap } else { -gap }
}
