//! [`Doubt`]s: what may be wrong with a result, as codes for programs and sentences for people.

use crate::orient::account::{Account, Source};
use serde::Serialize;

/// Something about a result that may not be as it should, for machines and for people.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Doubt {
    /// Stable, in kebab case.
    pub code: &'static str,
    /// A sentence.
    pub message: String,
    /// The share of the surface (0-1) that it is about, where that is known.
    pub share: Option<f64>,
}

/// Shares of the surface that are not worth a word.
const LITTLE: f64 = 0.01;
/// The share of what a sensor says that the result may contradict: grazing views and outlines.
const GRAZING: f64 = 0.03;
/// Sources that agree over less than this share disagree.
const AGREE: f64 = 0.8;
/// [`crate::orient::account::WeakestTie::strength`] under which a side is as good as a guess.
const WEAK: f64 = 0.3;

/// A mesh that is farther from the points than this share of the diagonal (root mean square) is none to rely on.
const FAR: f64 = 0.01;
/// A piece of land is at most so many degrees wide, and hardly a hundredth as many metres high.
const DEGREES: f64 = 5.0;
const STRETCHED: f64 = 100.0;

/// What may be wrong with the shape as a whole: `low` and `high` are the corners of the points' bounding box in world coordinates,
/// `rms` is their distance to the mesh.
pub(crate) fn doubts_of_shape(low: [f64; 3], high: [f64; 3], rms: f64) -> Vec<Doubt> {
    let doubt = |code, message: &str| Doubt {
        code,
        message: message.into(),
        share: None,
    };
    let [width, depth, height] = [0, 1, 2].map(|a| high[a] - low[a]);
    let on_globe = |axis: usize, most: f64| low[axis] >= -most && high[axis] <= most;
    let across = width.max(depth);
    let is_land = across > 0.0 && across < DEGREES && height > STRETCHED * across;
    if is_land && on_globe(0, 180.0) && on_globe(1, 90.0) {
        return vec![doubt(
            "degrees-as-lengths",
            "x and y look like degrees of longitude and latitude, and z like metres, so the shape is drawn out: convert the \
             scan to a projected coordinate system first.",
        )];
    }
    if rms > FAR {
        return vec![doubt(
            "far-from-points",
            "The mesh is not close to the points: there are too few of them to tell where the surface is, or some lie far \
             from the rest.",
        )];
    }
    Vec::new()
}

/// What is to be said of coordinates that were rounded: `steps` is the standard deviation of that (fraction of the diagonal).
pub(crate) fn doubts_of_steps(steps: f32) -> Vec<Doubt> {
    if steps == 0.0 {
        return Vec::new();
    }
    vec![Doubt {
        code: "steps",
        message: format!(
            "The coordinates were rounded to steps of {:.2} % of the diagonal: detail as fine as that is smoothed away.",
            100.0 * steps * 12f32.sqrt()
        ),
        share: None,
    }]
}

/// What was looked at of a surface.
#[derive(Debug, Clone, Default)]
pub(crate) struct Looked {
    /// Share of the input points through which there is no surface, and whether the mesh leaves them out.
    pub(crate) scatter: f64,
    pub(crate) drops: bool,
    /// Share of the fitted points whose wall is thinner than can be known.
    pub(crate) thin: f64,
    /// Share of the area that is far from all points.
    pub(crate) invented: f64,
    /// Handles of all components.
    pub(crate) tunnels: usize,
    /// Fitted points.
    pub(crate) points: usize,
    pub(crate) triangles: usize,
    /// Triangles that cross others.
    pub(crate) crossings: usize,
    /// Share of the fitted points whose pieces were left out as too small.
    pub(crate) islands: f64,
}

/// So many tunnels may be real, and one for so many points.
const TUNNELS: (usize, usize) = (20, 400);

/// What is to be said of it.
pub(crate) fn doubts_of_surface(looked: &Looked) -> Vec<Doubt> {
    let mut doubts = Vec::new();
    let mut doubt = |code, share: f64, message: String| {
        doubts.push(Doubt {
            code,
            message,
            share: Some(share),
        });
    };
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    if looked.scatter > LITTLE {
        let kept = if looked.drops {
            "the mesh leaves them out"
        } else {
            "the surface there is made up"
        };
        let message = format!(
            "{} of the points lie as in foliage, dust or a filled volume, with no surface through them: {kept}.",
            percent(looked.scatter)
        );
        doubt("scatter", looked.scatter, message);
    }
    if looked.thin > LITTLE {
        let message = format!(
            "{} of the surface belongs to walls that are about as thin as the points are apart, or as the noise: their shape is \
             not known there.",
            percent(looked.thin)
        );
        doubt("thin", looked.thin, message);
    }
    if looked.invented > LITTLE {
        let message = format!(
            "{} of the area is far from any point.",
            percent(looked.invented)
        );
        doubt("far-area", looked.invented, message);
    }
    if looked.tunnels > TUNNELS.0.max(looked.points / TUNNELS.1) {
        let message = format!(
            "The surface has {} tunnels: the points do not tell well what is inside.",
            looked.tunnels
        );
        let share = looked.tunnels as f64 / looked.points.max(1) as f64;
        doubt("tunnels", share, message);
    }
    if looked.crossings > 0 {
        let message = format!("{} triangles cross others.", looked.crossings);
        let share = looked.crossings as f64 / looked.triangles.max(1) as f64;
        doubt("self-intersections", share, message);
    }
    if looked.islands > LITTLE {
        let message = format!(
            "Pieces too small to be a surface were left out: {} of the points.",
            percent(looked.islands)
        );
        doubt("islands-dropped", looked.islands, message);
    }
    doubts
}

/// What is to be said of scan lines far apart, on which this share of the points is.
pub(crate) fn doubts_of_lines(share: f32) -> Vec<Doubt> {
    if share == 0.0 {
        return Vec::new();
    }
    vec![Doubt {
        code: "lines",
        message: format!(
            "{:.0} % of the points are on scan lines much farther apart than the points of a line: the surface between lines \
             is drawn from one to the next.",
            100.0 * share
        ),
        share: Some(share.into()),
    }]
}

/// What is to be said of points that were taken from `faces`, where they were.
pub(crate) fn doubts_of_faces(faces: u64) -> Vec<Doubt> {
    if faces == 0 {
        return Vec::new();
    }
    vec![Doubt {
        code: "sampled-from-faces",
        message: format!(
            "The file is a mesh: its points were taken from {faces} faces, evenly over their area."
        ),
        share: None,
    }]
}

/// What may be wrong with the sides.
pub(crate) fn doubts(account: &Account) -> Vec<Doubt> {
    let mut doubts = Vec::new();
    let percent = |share: f64| format!("{:.0} %", 100.0 * share);
    let mut doubt = |code, share: f64, message: String| {
        doubts.push(Doubt {
            code,
            message,
            share: Some(share),
        });
    };
    if account.guessed > LITTLE {
        let share = percent(account.guessed);
        let message = format!("Which side is out is a guess for {share} of the surface.");
        doubt("side-guessed", account.guessed, message);
    }
    let mut disagree = 0.0;
    for said in &account.sources {
        let (name, is_sensor) = match said.source {
            Source::Normals => ("normals", false),
            Source::Viewpoints => ("viewpoints", true),
            Source::Camera => ("camera", true),
            _ => continue,
        };
        let against = 1.0 - said.agreement;
        if said.agreement < AGREE {
            disagree = f64::max(disagree, against);
        } else if is_sensor && against > GRAZING {
            let message = format!(
                "{} of what the {name} saw shows its inner side.",
                percent(against)
            );
            doubt("contradicts-sensor", against, message);
        }
    }
    if disagree > 0.0 {
        let message = format!(
            "What is known of the outer side contradicts itself or the surface over {} of it.",
            percent(disagree)
        );
        doubt("sources-disagree", disagree, message);
    }
    if let Some(tie) = account.weakest_tie.filter(|tie| tie.strength < WEAK) {
        let message = format!(
            "Next to nothing ties {} of the surface to the rest: it may be inside out.",
            percent(tie.share)
        );
        doubt("weak-tie", tie.share, message);
    }
    doubts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn codes(center: [f64; 3], size: [f64; 3], rms: f64) -> Vec<&'static str> {
        let corner = |side: f64| [0, 1, 2].map(|a| center[a] + side * size[a]);
        let doubts = doubts_of_shape(corner(-0.5), corner(0.5), rms);
        doubts.iter().map(|doubt| doubt.code).collect()
    }

    #[test]
    fn a_shape_that_is_better_not_relied_on() {
        assert!(codes([0.0; 3], [1.0, 2.0, 3.0], 5e-4).is_empty());
        assert_eq!(codes([0.0; 3], [1.0, 2.0, 3.0], 0.03), ["far-from-points"]);
        let tile = [0.0228, 0.0106, 39.0];
        assert_eq!(
            codes([-95.0, 31.0, 60.0], tile, 1e-4),
            ["degrees-as-lengths"]
        );
        // A pole on a map in metres; a statue in metres; points on a line.
        assert!(codes([637_000.0, 849_000.0, 60.0], [0.02, 0.01, 39.0], 1e-4).is_empty());
        assert!(codes([0.0; 3], [0.5, 0.5, 2.0], 1e-4).is_empty());
        assert!(codes([0.0; 3], [0.0, 0.0, 2.0], 1e-4).is_empty());
    }
}
