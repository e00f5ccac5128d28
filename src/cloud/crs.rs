//! The coordinate reference system of a georeferenced cloud, as LAS files describe it, and its unit.

use super::Unit;

/// A coordinate reference system in the words of a file, handed on as it is.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Crs {
    /// Well-known text of OGC.
    pub wkt: Option<String>,
    /// GeoTIFF's keys: four numbers for the directory, then four a key.
    pub keys: Vec<u16>,
    /// Values of keys that are floating-point numbers.
    pub doubles: Vec<f64>,
    /// Values of keys that are text.
    pub ascii: String,
}

/// Numbers of GeoTIFF's keys and of their values.
const MODEL_TYPE: u16 = 1024;
const GEOGRAPHIC: u16 = 2;
const PROJECTED_SYSTEM: u16 = 3072;
const LINEAR_UNITS: u16 = 3076;

impl Crs {
    /// Whether it says nothing.
    pub fn is_empty(&self) -> bool {
        self.wkt.is_none() && self.keys.is_empty()
    }

    /// The unit of horizontal coordinates, where it is one of [`Unit`]'s.
    pub fn unit(&self) -> Option<Unit> {
        let text = self.wkt.as_deref().and_then(unit_of_text);
        text.or_else(|| self.unit_of_keys())
    }

    fn unit_of_keys(&self) -> Option<Unit> {
        let keys = self.keys.get(4..)?.chunks_exact(4);
        // A value is in the key itself where no table holds it.
        let value = |wanted: u16| {
            keys.clone()
                .find(|key| key[0] == wanted && key[1] == 0)
                .map(|key| key[3])
        };
        if value(MODEL_TYPE) == Some(GEOGRAPHIC) {
            return Some(Unit::Degree);
        }
        match (value(LINEAR_UNITS), value(PROJECTED_SYSTEM)) {
            (Some(9001), _) => Some(Unit::Metre),
            (Some(9002), _) => Some(Unit::Foot),
            (Some(9003), _) => Some(Unit::SurveyFoot),
            // UTM: WGS 84 north and south, NAD 83, ETRS 89.
            (None, Some(32601..=32660 | 32701..=32760 | 26901..=26923 | 25828..=25838)) => {
                Some(Unit::Metre)
            }
            _ => None,
        }
    }
}

/// The last unit of length in the projected system, or else what kind of system there is.
fn unit_of_text(text: &str) -> Option<Unit> {
    const PROJECTED: [&str; 3] = ["PROJCS", "PROJCRS", "PROJECTEDCRS"];
    const GEOGRAPHIC: [&str; 4] = ["GEOGCS", "GEOGCRS", "GEOGRAPHICCRS", "GEODCRS"];
    const LOCAL: [&str; 3] = ["LOCAL_CS", "ENGCRS", "ENGINEERINGCRS"];
    // Units of angles, heights and parameters are of these.
    const OTHERS: [&str; 6] = [
        "BASEGEOGCRS",
        "BASEGEODCRS",
        "CONVERSION",
        "VERT_CS",
        "VERTCRS",
        "ANGLEUNIT",
    ];
    let mut open: Vec<String> = Vec::new();
    let (mut geographic, mut found) = (false, None);
    for (keyword, inside) in nodes(text) {
        open.truncate(inside);
        let is_in = |names: &[&str]| open.iter().any(|name| names.contains(&name.as_str()));
        let is_unit = keyword.name == "UNIT" || keyword.name == "LENGTHUNIT";
        if is_unit && (is_in(&PROJECTED) || is_in(&LOCAL)) && !is_in(&GEOGRAPHIC) && !is_in(&OTHERS)
        {
            found = keyword.number.and_then(Unit::of_metres);
        }
        geographic |= GEOGRAPHIC.contains(&keyword.name.as_str()) && !is_in(&PROJECTED);
        open.push(keyword.name);
    }
    found.or(geographic.then_some(Unit::Degree))
}

/// `NAME["text", number, …]`.
struct Keyword {
    name: String,
    number: Option<f64>,
}

/// All keywords of a text, each with how many others it is inside of.
fn nodes(text: &str) -> Vec<(Keyword, usize)> {
    let mut found = Vec::new();
    let (mut depth, mut quoted) = (0usize, false);
    let mut word = String::new();
    for (at, c) in text.char_indices() {
        match c {
            '"' => quoted = !quoted,
            _ if quoted => {}
            '[' | '(' => {
                let number = first_number(&text[at + 1..]);
                let name = std::mem::take(&mut word).to_uppercase();
                found.push((Keyword { name, number }, depth));
                depth += 1;
            }
            ']' | ')' => {
                depth = depth.saturating_sub(1);
                word.clear();
            }
            ',' => word.clear(),
            c if !c.is_whitespace() => word.push(c),
            _ => {}
        }
    }
    found
}

/// The number behind a quoted name.
fn first_number(content: &str) -> Option<f64> {
    let (_, behind) = content.strip_prefix('"')?.split_once('"')?;
    let value = behind.trim_start().strip_prefix(',')?;
    let end = value.find([',', ']', ')']).unwrap_or(value.len());
    value[..end].trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_text(text: &str) -> Option<Unit> {
        let wkt = Some(text.to_string());
        Crs {
            wkt,
            ..Crs::default()
        }
        .unit()
    }

    #[test]
    fn units_of_well_known_text() {
        let geographic = r#"GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.25]],UNIT["degree",0.0174532925]]"#;
        let projected = |unit: &str| {
            format!(r#"PROJCS["a [b]",{geographic},PROJECTION["x"],{unit},AXIS["X",EAST]]"#)
        };
        assert_eq!(of_text(geographic), Some(Unit::Degree));
        assert_eq!(
            of_text(&projected(r#"UNIT["metre", 1]"#)),
            Some(Unit::Metre)
        );
        assert_eq!(
            of_text(&projected(r#"UNIT["US survey foot",0.3048006096012192]"#)),
            Some(Unit::SurveyFoot)
        );
        let both = format!(
            r#"COMPD_CS["c",{},VERT_CS["v",UNIT["foot",0.3048]]]"#,
            projected(r#"UNIT["metre",1]"#)
        );
        assert_eq!(of_text(&both), Some(Unit::Metre));
        let new = r#"PROJCRS["n",BASEGEOGCRS["b",ELLIPSOID["e",6378137,298,LENGTHUNIT["metre",1]]],CONVERSION["c",PARAMETER["p",1,LENGTHUNIT["metre",1]]],CS[Cartesian,2],AXIS["e",east],LENGTHUNIT["foot",0.3048]]"#;
        assert_eq!(of_text(new), Some(Unit::Foot));
        assert_eq!(of_text("nothing"), None);
        assert_eq!(of_text(&projected(r#"UNIT["rod",5.03]"#)), None);
    }

    #[test]
    fn units_of_keys() {
        let of = |keys: &[[u16; 4]]| {
            let keys = [[1, 1, 0, keys.len() as u16]]
                .iter()
                .chain(keys)
                .flatten()
                .copied()
                .collect();
            Crs {
                keys,
                ..Crs::default()
            }
            .unit()
        };
        assert_eq!(of(&[[1024, 0, 1, 1], [3076, 0, 1, 9002]]), Some(Unit::Foot));
        assert_eq!(of(&[[1024, 0, 1, 2]]), Some(Unit::Degree));
        assert_eq!(
            of(&[[1024, 0, 1, 1], [3072, 0, 1, 32633]]),
            Some(Unit::Metre)
        );
        assert_eq!(of(&[[1024, 0, 1, 1]]), None);
    }

    #[test]
    fn units_convert_by_whole_numbers_where_they_can() {
        assert_eq!(Unit::Metre.per(Unit::Millimetre), Some(1000.0));
        assert_eq!(Unit::Millimetre.per(Unit::Metre), Some(0.001));
        assert_eq!(Unit::Foot.per(Unit::Inch), Some(12.0));
        assert_eq!(Unit::Degree.per(Unit::Metre), None);
    }
}
