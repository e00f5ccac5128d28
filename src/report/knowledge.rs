//! How a result knows what it says: sources, shares, doubts.

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

/// What decides which side of a piece of surface is out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub enum Source {
    /// The cloud's own normals.
    Normals,
    /// The places that it was seen from.
    Viewpoints,
    /// That it was seen from above.
    Above,
    /// That it looks as a camera at the origin sees.
    Camera,
    /// That it encloses something.
    Shell,
    /// The option, or the rule for sheets, that up is out.
    Up,
    /// Nothing.
    Guess,
}

/// What a source had to say.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct SourceShare {
    /// Which.
    pub source: Source,
    /// Share of the surface (0-1) whose side it decided.
    pub share: f64,
    /// Share of what it says anything about (0-1) where the result agrees with it.
    pub agreement: f64,
}

/// The part of the surface whose side hangs on the least.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct WeakestTie {
    /// Share of the surface (0-1) that would turn.
    pub share: f64,
    /// What holds it: the sum of weights that speak for its side, less those against it. Neighbouring sub-domains of one sheet
    /// have a weight of about 0.5.
    pub strength: f64,
}

/// What decided which side is out.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct OrientationReport {
    /// Every source that said anything; the shares add up to 1.
    pub sources: Vec<SourceShare>,
    /// Share of the surface (0-1) whose side is a guess.
    pub guessed: f64,
    /// Of the parts that are not alone and have over 1 % of the surface.
    pub weakest_tie: Option<WeakestTie>,
}
