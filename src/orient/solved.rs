//! [`Solved`]: the signs of the sub-domains, and the source that decided each.

use crate::orient::parts::Parts;
use crate::orient::source::Source;

/// Signs and where they come from.
pub(crate) struct Solved {
    pub(crate) signs: Vec<f32>,
    pub(crate) energy_before: f64,
    /// What decided for each sub-domain.
    pub(crate) sources: Vec<Source>,
    /// What sources said of each.
    pub(crate) said: Vec<(Source, Vec<f32>)>,
    /// The parts, and whether the whole surface encloses something at each: its winding number there is near ½.
    pub(crate) parts: Option<(Parts, Vec<bool>)>,
}
