//! The display's scale and linear light (IEC 61966-2-1), both from 0 to 1.

/// Linear light of a share of the display's scale.
pub fn linear(srgb: f64) -> f64 {
    if srgb <= 0.04045 {
        srgb / 12.92
    } else {
        libm::pow((srgb + 0.055) / 1.055, 2.4)
    }
}

/// A share of the display's scale of linear light.
pub fn srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
    }
}
