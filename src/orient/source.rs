//! What may decide which side is out.

use serde::Serialize;

/// What a source says of a sub-domain counts from here on.
pub(crate) const SOME: f32 = 0.1;

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
    /// That the cloud's or the option's up is out.
    Up,
    /// Nothing but a rule for sheets.
    Guess,
}

impl Source {
    /// All of them.
    pub const ALL: [Source; 7] = [
        Source::Normals,
        Source::Viewpoints,
        Source::Above,
        Source::Camera,
        Source::Shell,
        Source::Up,
        Source::Guess,
    ];
}
