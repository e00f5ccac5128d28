//! The pipeline's input: the caller's points, without the isolated ones where these are dropped, with their octree and features.

use crate::base::error::{Error, Result};
use crate::base::params::{COLORS, Outliers, ReduceParams};
use crate::base::progress::{Part, Progress, Stage};
use crate::cloud::Cloud;
use crate::cloud::octree::Octree;
use crate::features::Features;
use crate::features::known::Clues;
use crate::features::outliers;
use crate::reduce::Reduced;
use glam::Vec3;
use std::borrow::Cow;

/// Length of the mean direction from which on points are all on one side: those of half a ball have 0.5, of a picture 60° to
/// either side wide 0.75.
const AHEAD: f32 = 0.7;

/// The octree and the features of a cloud. Normals that it has help where it is noisy, and tell the side of all.
pub(crate) fn measure(cloud: &Cloud, progress: &mut dyn Progress) -> Result<(Octree, Features)> {
    progress.update(Stage::Octree, 0.0)?;
    let tree = Octree::build(&cloud.points);
    progress.update(Stage::Octree, 1.0)?;
    // The frame of a depth camera has the camera at its origin, with all points ahead of it.
    let origin = cloud.frame.to_unit([0.0; 3]);
    let directions = tree
        .points
        .iter()
        .map(|&p| (p - origin).normalize_or_zero());
    let ahead = directions.sum::<Vec3>().length() > AHEAD * tree.points.len() as f32;
    let eye = |i: usize| match &cloud.viewpoints {
        Some(viewpoints) => {
            let seeing = viewpoints.seeing(tree.order[i] as usize)?;
            Some(cloud.frame.to_unit(seeing.to_array()))
        }
        None => ahead.then_some(origin),
    };
    let own = |i: usize| match &cloud.normals {
        Some(normals) => normals[tree.order[i] as usize],
        None => Vec3::ZERO,
    };
    let clues = Clues {
        eye: &eye,
        normal: cloud.normals.is_some().then_some(&own),
    };
    let mut features = Features::measure_with(&tree, &clues, progress)?;
    if cloud.normals.is_some() {
        let measured = features.normals.iter_mut().zip(&mut features.residual);
        for (i, (normal, residual)) in measured.enumerate() {
            if *normal == Vec3::ZERO {
                *normal = own(i);
            } else if own(i).dot(*normal) < 0.0 {
                *normal = -*normal;
                *residual = -*residual;
            }
        }
    }
    Ok((tree, features))
}

/// What a job starts from: the caller's points, or those that are not isolated. A job uses up an input that it owns, and
/// copies what it changes of one that is lent.
#[derive(Debug)]
pub(crate) struct Input<'a> {
    /// Without points where nobody else owns them: the tree has them.
    pub(crate) cloud: Cow<'a, Cloud>,
    pub(crate) tree: Cow<'a, Octree>,
    pub(crate) features: Cow<'a, Features>,
    pub(crate) origin: Origin,
}

/// Where the points of an [`Input`] come from.
#[derive(Debug, Clone)]
pub(crate) struct Origin {
    /// Points that the caller gave.
    pub(crate) given: usize,
    /// The caller's index of each point, where some were dropped.
    pub(crate) kept: Option<Vec<u32>>,
    /// Why nothing was dropped although much is isolated; else empty.
    pub(crate) reason: String,
}

impl<'a> Input<'a> {
    pub(crate) fn new(
        cloud: Cow<'a, Cloud>,
        outliers: Outliers,
        progress: &mut dyn Progress,
    ) -> Result<Input<'a>> {
        let origin = |kept, reason| Origin {
            given: cloud.len(),
            kept,
            reason,
        };
        if outliers == Outliers::Keep {
            let origin = origin(None, String::new());
            let measured = measure(&cloud, progress)?;
            return Ok(Input::of(cloud, measured, origin));
        }
        // Two measurements with the search between them.
        let (tree, features) = measure(&cloud, &mut Part::new(progress, 0.0..0.4))?;
        let isolated =
            outliers::isolated(&tree, features.noise, &mut Part::new(progress, 0.4..0.6))?;
        let dropped = isolated.iter().filter(|&&is| is).count();
        if dropped == 0 || 2 * dropped > cloud.len() {
            let reason = match dropped {
                0 => String::new(),
                _ => format!("{dropped} points, more than half, are isolated: none was dropped"),
            };
            let origin = origin(None, reason);
            return Ok(Input::of(cloud, (tree, features), origin));
        }
        let mut kept: Vec<u32> = tree
            .order
            .iter()
            .zip(isolated)
            .filter(|&(_, is)| !is)
            .map(|(&i, _)| i)
            .collect();
        kept.sort_unstable();
        let rest = cloud.select(&kept)?;
        let origin = origin(Some(kept), String::new());
        drop((cloud, tree, features));
        let measured = measure(&rest, &mut Part::new(progress, 0.6..1.0))?;
        Ok(Input::of(Cow::Owned(rest), measured, origin))
    }

    fn of(
        mut cloud: Cow<'a, Cloud>,
        (tree, features): (Octree, Features),
        origin: Origin,
    ) -> Input<'a> {
        if let Cow::Owned(cloud) = &mut cloud {
            cloud.points = Vec::new();
        }
        Input {
            cloud,
            tree: Cow::Owned(tree),
            features: Cow::Owned(features),
            origin,
        }
    }
}

impl Input<'_> {
    /// The same input, for a job that may not use it up.
    pub(crate) fn lent(&self) -> Input<'_> {
        Input {
            cloud: Cow::Borrowed(&self.cloud),
            tree: Cow::Borrowed(&self.tree),
            features: Cow::Borrowed(&self.features),
            origin: self.origin.clone(),
        }
    }

    /// Whether this was measured of these very points, colours and whatever else there is.
    pub(crate) fn is_of(&self, cloud: &Cloud) -> bool {
        let Cloud {
            points,
            frame,
            colors,
            normals,
            attributes,
            origin,
            viewpoints,
            up,
            seen_from_above,
            floor,
            unit,
            crs,
            faces,
        } = cloud;
        let (of, tree) = (&self.cloud, &self.tree);
        let place = |(&p, &i): (&Vec3, &u32)| points[i as usize] == p;
        self.origin.kept.is_none()
            && tree.points.len() == points.len()
            && (of.frame, of.origin) == (*frame, *origin)
            && tree.points.iter().zip(&tree.order).all(place)
            && (&of.colors, &of.normals, &of.attributes) == (colors, normals, attributes)
            && (&of.viewpoints, of.up, of.seen_from_above) == (viewpoints, *up, *seen_from_above)
            && (of.unit, of.floor, &of.crs, of.faces) == (*unit, *floor, crs, *faces)
    }
}

impl Origin {
    /// How many points were dropped.
    pub(crate) fn dropped(&self) -> usize {
        self.kept.as_ref().map_or(0, |kept| self.given - kept.len())
    }

    /// The caller's index of a point of this cloud.
    pub(crate) fn callers(&self, point: u32) -> u32 {
        self.kept
            .as_ref()
            .map_or(point, |kept| kept[point as usize])
    }

    /// Indices of this cloud's points become the caller's.
    pub(crate) fn restore(&self, reduced: &mut Reduced) {
        let Some(kept) = &self.kept else { return };
        for i in &mut reduced.nearest {
            *i = kept[*i as usize];
        }
        if let Some(assignment) = &mut reduced.assignment {
            let mut all = vec![outliers::DROPPED; self.given];
            for (&i, &reduced) in kept.iter().zip(assignment.iter()) {
                all[i as usize] = reduced;
            }
            *assignment = all;
        }
    }
}

/// Names of `attributes` that the cloud does not have.
pub(crate) fn check_attributes(cloud: &Cloud, params: &ReduceParams) -> Result<()> {
    let scalars = cloud.attributes.iter().map(|a| a.name.as_str());
    let names: Vec<&str> = scalars
        .chain(cloud.colors.as_ref().map(|_| COLORS))
        .collect();
    match params
        .attributes
        .keys()
        .find(|key| !names.contains(&key.as_str()))
    {
        None => Ok(()),
        Some(key) => Err(Error::BadOption {
            option: "attributes".into(),
            expected: if names.is_empty() {
                "an empty object, as the cloud has no attributes".into()
            } else {
                format!("names of the cloud's attributes: {}", names.join(", "))
            },
            found: format!("an object with {key}"),
        }),
    }
}
