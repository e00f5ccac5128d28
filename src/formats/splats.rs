//! What is said of Gaussian splats.

/// A word on what the points are.
pub(super) const SPLATS: &str = "The file holds Gaussian splats. Their centres are the points, and their colours those of no \
    direction of view: size, rotation and opacity are not looked at, and many centres lie off the surface.";
