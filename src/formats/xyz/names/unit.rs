//! The unit that names of columns say: `X [mm]`, `Easting (US ft)`, `x_m`; longitude and latitude are degrees.

use super::role::{Role, loose, role, words};
use crate::cloud::Unit;

/// Families of axes whose values are degrees.
const DEGREES: usize = 2;

/// The unit of x, y and z; `None` where they say none, or several.
pub(in super::super) fn unit(names: &[String], roles: &[String]) -> Option<Unit> {
    let of = |axis: &str| names.get(roles.iter().position(|role| role == axis)?);
    let [x, y, z] = [of("x")?, of("y")?, of("z")?];
    let is_degree = |name: &String| {
        let said = role(name).or_else(|| Some(loose(name)?.0));
        matches!(
            said,
            Some(Role::Across {
                family: DEGREES,
                ..
            })
        )
    };
    if is_degree(x) && is_degree(y) {
        return Some(Unit::Degree);
    }
    let unit = unit_in(x)?;
    [y, z]
        .iter()
        .all(|name| unit_in(name) == Some(unit))
        .then_some(unit)
}

/// The unit of a line that has nothing but units.
pub(in super::super) fn unit_of_line<'a>(values: impl Iterator<Item = &'a str>) -> Option<Unit> {
    let units: Option<Vec<Unit>> = values.map(known).collect();
    let units = units?;
    let [first, _, _, ..] = units.as_slice() else {
        return None;
    };
    units.iter().all(|unit| unit == first).then_some(*first)
}

/// The unit in a name's brackets, or its last word.
fn unit_in(name: &str) -> Option<Unit> {
    match name.find(['(', '[']) {
        Some(at) if at > 0 => known(&name[at..]),
        _ => {
            let words = words(name);
            words
                .split_last()
                .filter(|(_, before)| !before.is_empty())
                .and_then(|(last, _)| known(last))
        }
    }
}

fn known(text: &str) -> Option<Unit> {
    let is_letter = |c: &char| c.is_ascii_alphabetic();
    let letters: String = text
        .to_ascii_lowercase()
        .chars()
        .filter(is_letter)
        .collect();
    Some(match letters.as_str() {
        "mm" | "millimeter" | "millimeters" | "millimetre" | "millimetres" => Unit::Millimetre,
        "cm" | "centimeter" | "centimeters" | "centimetre" | "centimetres" => Unit::Centimetre,
        "m" | "meter" | "meters" | "metre" | "metres" => Unit::Metre,
        "in" | "inch" | "inches" => Unit::Inch,
        "ft" | "foot" | "feet" => Unit::Foot,
        "usft" | "ftus" | "ussurveyfoot" | "ussurveyfeet" | "sft" => Unit::SurveyFoot,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_names() {
        let of =
            |names: [&str; 3]| unit(&names.map(String::from), &["x", "y", "z"].map(String::from));
        for (names, expected) in [
            (["X [mm]", "Y [mm]", "Z [mm]"], Some(Unit::Millimetre)),
            (["X(m)", "Y (m)", "Z[m]"], Some(Unit::Metre)),
            (["x_cm", "y_cm", "z_cm"], Some(Unit::Centimetre)),
            (
                ["Easting (US ft)", "Northing (US ft)", "Elev. (US ft)"],
                Some(Unit::SurveyFoot),
            ),
            (["X (ft)", "Y (ft)", "Z (m)"], None),
            (["X", "Y", "Z"], None),
            (["Points:0", "Points:1", "Points:2"], None),
            (["lon", "lat", "alt (m)"], Some(Unit::Degree)),
        ] {
            assert_eq!(of(names), expected, "{names:?}");
        }
        assert_eq!(unit_of_line(["m", "m", "m"].into_iter()), Some(Unit::Metre));
        assert_eq!(
            unit_of_line(["[mm]", "[mm]", "[mm]"].into_iter()),
            Some(Unit::Millimetre)
        );
        assert_eq!(unit_of_line(["m", "m"].into_iter()), None);
        assert_eq!(unit_of_line(["m", "m", "[-]"].into_iter()), None);
    }
}
