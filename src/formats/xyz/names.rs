//! Names of columns as instruments, geographic information systems and viewers write them.
//!
//! A name is read without case, quotes, accents, units in brackets (`X [m]`, `Z (US ft)`) and marks between its words.
//! `Points:0`, `Points_1` and `Points[2]` are the components of what is before the number.

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Role {
    /// An axis of a pair that belongs together: x y, east north, longitude latitude.
    Across {
        axis: usize,
        family: usize,
    },
    /// The third axis; the lower rank is meant where there are several.
    Up {
        rank: usize,
    },
    Normal(usize),
    Color(usize),
    /// A colour in one value.
    Packed,
}

/// What a table's names say together: a role for each column, `x y z`, `nx ny nz`, `red green blue`, `rgb`, `-` for one
/// that is passed over, or its own name. `None` where x, y or z is missing.
pub(super) fn roles(names: &[String]) -> Option<Vec<String>> {
    let known: Vec<Option<Role>> = names.iter().map(|name| role(name)).collect();
    let find = |wanted: Role| known.iter().position(|role| *role == Some(wanted));
    let pair = (0..FAMILIES).find_map(|family| {
        let across = |axis| find(Role::Across { axis, family });
        Some([across(0)?, across(1)?])
    })?;
    let up = (0..RANKS).find_map(|rank| find(Role::Up { rank }))?;
    let triple = |of: fn(usize) -> Role| Some([find(of(0))?, find(of(1))?, find(of(2))?]);
    let mut roles: Vec<String> = names.iter().map(|name| plain(name)).collect();
    let mut say = |columns: Option<[usize; 3]>, names: [&str; 3]| {
        let columns = columns.into_iter().flatten();
        columns
            .zip(names)
            .for_each(|(i, name)| roles[i] = name.into());
    };
    say(Some([pair[0], pair[1], up]), ["x", "y", "z"]);
    say(triple(Role::Normal), ["nx", "ny", "nz"]);
    let color = triple(Role::Color);
    say(color, ["red", "green", "blue"]);
    if color.is_none()
        && let Some(packed) = find(Role::Packed)
    {
        roles[packed] = "rgb".into();
    }
    Some(distinct(roles))
}

/// What a caller calls a column.
pub(super) fn asked(names: &[String]) -> Vec<String> {
    roles(names).unwrap_or_else(|| names.to_vec())
}

/// Whether two columns claim to be the same axis.
pub(super) fn contradict(names: &[String]) -> bool {
    let mut lower: Vec<String> = names
        .iter()
        .map(|name| name.trim().to_lowercase())
        .collect();
    lower.retain(|name| ["x", "y", "z"].contains(&name.as_str()));
    lower.sort_unstable();
    lower.windows(2).any(|pair| pair[0] == pair[1])
}

/// Names of attributes differ: the second of a name gets a number.
fn distinct(mut roles: Vec<String>) -> Vec<String> {
    for i in 0..roles.len() {
        let first = roles[i].clone();
        let mut count = 1;
        while roles[i] != "-" && roles[..i].contains(&roles[i]) {
            count += 1;
            roles[i] = format!("{first}_{count}");
        }
    }
    roles
}

/// A name of an attribute; one that is none is passed over.
fn plain(name: &str) -> String {
    let name = name.trim();
    let passed_over = name.is_empty() || name.starts_with("Unnamed:") || name.contains("[]");
    if passed_over { "-" } else { name }.into()
}

const FAMILIES: usize = 3;
const RANKS: usize = 3;

/// Words for an axis: x, y and z, then east and north, then longitude and latitude; of heights the first line comes first.
const ACROSS: [[&[&str]; 2]; FAMILIES] = [
    [&["x"], &["y"]],
    [
        &[
            "e",
            "east",
            "easting",
            "eastings",
            "est",
            "ost",
            "ostwert",
            "rechtswert",
            "rechts",
            "estx",
            "utme",
            "este",
        ],
        &[
            "n",
            "north",
            "northing",
            "northings",
            "nord",
            "nordwert",
            "hochwert",
            "hoch",
            "utmn",
            "norte",
        ],
    ],
    [
        &[
            "lon",
            "long",
            "lng",
            "longitude",
            "laenge",
            "laengengrad",
            "lange",
            "langengrad",
        ],
        &["lat", "latitude", "breite", "breitengrad"],
    ],
];
const UP: [&[&str]; RANKS] = [
    &["z"],
    &[
        "elevation",
        "elev",
        "height",
        "hgt",
        "altitude",
        "alt",
        "hoehe",
        "hohe",
        "hauteur",
        "altitud",
        "cote",
        "ellipsoidalheight",
        "orthometricheight",
        "ellipsoidischehoehe",
        "level",
        "rl",
        "quota",
        "altura",
    ],
    &["h", "u", "up"],
];
const NORMAL: [&[&str]; 3] = [&["nx"], &["ny"], &["nz"]];
const COLOR: [&[&str]; 3] = [
    &["r", "red", "rouge", "rot", "rojo", "rosso", "rf"],
    &["g", "green", "vert", "gruen", "grun", "verde", "gf"],
    &["b", "blue", "bleu", "blau", "azul", "blu", "bf"],
];
const PACKED: [&str; 12] = [
    "rgb",
    "rgba",
    "argb",
    "color",
    "colour",
    "couleur",
    "farbe",
    "hex",
    "rgbhex",
    "hexcolor",
    "packedrgb",
    "rgbpacked",
];

/// Words that say nothing beside those of an axis.
const BESIDE: [&str; 24] = [
    "coord",
    "coords",
    "coordinate",
    "coordinates",
    "koordinate",
    "coordonnee",
    "pos",
    "position",
    "point",
    "pt",
    "utm",
    "lambert",
    "l93",
    "wgs84",
    "deg",
    "dd",
    "value",
    "wert",
    "m",
    "mm",
    "cm",
    "ft",
    "in",
    "gps",
];
const BESIDE_COLOR: [&str; 9] = [
    "diffuse", "color", "colour", "farbe", "couleur", "rgb", "channel", "kanal", "camera",
];
/// Names of arrays of three, whose components are numbered or lettered.
const PLACES: [&str; 17] = [
    "points",
    "point",
    "pointsmxyz",
    "xyz",
    "coords",
    "coord",
    "coordinates",
    "coordinate",
    "position",
    "positions",
    "pos",
    "location",
    "p",
    "vertex",
    "vertices",
    "koordinate",
    "koordinaten",
];
const NORMALS: [&str; 6] = ["normals", "normal", "norm", "n", "normale", "normalen"];
const COLORS: [&str; 8] = [
    "colors",
    "color",
    "colours",
    "colour",
    "rgb",
    "rgba",
    "rgbacolor",
    "farbe",
];

fn role(name: &str) -> Option<Role> {
    let words = words(name);
    let joined = words.concat();
    let is = |list: &[&str], word: &str| list.contains(&word);
    if is(&PACKED, &joined) {
        return Some(Role::Packed);
    }
    if let Some(role) = single(&joined) {
        return Some(role);
    }
    if let Some((last, first)) = words.split_last()
        && !first.is_empty()
    {
        let array = first.concat();
        let component = ["0", "1", "2"].iter().position(|number| number == last);
        let lettered = ["x", "y", "z"].iter().position(|letter| letter == last);
        if let Some(axis) = component.or(lettered) {
            if is(&NORMALS, &array) {
                return Some(Role::Normal(axis));
            }
            if is(&PLACES, &array) {
                return Some(place(axis));
            }
        }
        if let Some(channel) = component
            && is(&COLORS, &array)
        {
            return Some(Role::Color(channel));
        }
    }
    let without = |beside: &[&str]| -> String {
        let kept = words.iter().filter(|word| !is(beside, word));
        kept.map(String::as_str).collect()
    };
    let color = COLOR
        .iter()
        .position(|channel| is(channel, &without(&BESIDE_COLOR)));
    if let Some(channel) = color {
        return Some(Role::Color(channel));
    }
    single(&without(&BESIDE)).filter(|role| matches!(role, Role::Across { .. } | Role::Up { .. }))
}

fn place(axis: usize) -> Role {
    match axis {
        2 => Role::Up { rank: 0 },
        axis => Role::Across { axis, family: 0 },
    }
}

/// The role of a name that is one word, or whose words are one.
fn single(word: &str) -> Option<Role> {
    let is = |list: &&[&str]| list.contains(&word);
    for (family, axes) in ACROSS.iter().enumerate() {
        if let Some(axis) = axes.iter().position(&is) {
            return Some(Role::Across { axis, family });
        }
    }
    let up = UP.iter().position(&is);
    let glued = [
        ("coord", ""),
        ("", "coord"),
        ("", "coordinate"),
        ("point", ""),
        ("pos", ""),
    ];
    let letter = ["x", "y", "z"].iter().position(|letter| {
        let whole = |(before, after): &(&str, &str)| word == format!("{before}{letter}{after}");
        glued.iter().any(whole)
    });
    let lettered = ["x", "y", "z"]
        .iter()
        .position(|letter| word == format!("normal{letter}") || word == format!("norm{letter}"));
    up.map(|rank| Role::Up { rank })
        .or(letter.map(place))
        .or(NORMAL.iter().position(&is).or(lettered).map(Role::Normal))
        .or(COLOR.iter().position(is).map(Role::Color))
}

/// Lower case, without units in brackets and accents, taken apart at what is neither letter nor digit.
fn words(name: &str) -> Vec<String> {
    let mut inside = 0;
    let mut text = String::new();
    for c in name.chars().flat_map(char::to_lowercase) {
        match c {
            '(' | '{' => inside += 1,
            ')' | '}' => inside -= 1,
            _ if inside > 0 => {}
            'ä' | 'à' | 'â' | 'á' => text.push('a'),
            'ö' | 'ô' | 'ó' => text.push('o'),
            'ü' | 'ù' | 'û' => text.push('u'),
            'é' | 'è' | 'ê' => text.push('e'),
            c => text.push(c),
        }
    }
    // Brackets hold a unit, `X [m]`, or a component, `Points[0]`.
    if let Some((before, rest)) = text.split_once('[')
        && !rest.starts_with(|c: char| c.is_ascii_digit())
    {
        text = before.into();
    }
    let parts = text.split(|c: char| !c.is_alphanumeric());
    parts
        .filter(|part| !part.is_empty())
        .map(String::from)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(names: &str) -> Option<String> {
        let names: Vec<String> = names.split(',').map(String::from).collect();
        roles(&names).map(|roles| roles.join(","))
    }

    #[test]
    fn names_of_many_programs() {
        for (names, expected) in [
            ("X,Y,Z", "x,y,z"),
            ("X(m),Y (m),Z [m]", "x,y,z"),
            ("x_m,y_m,z_m", "x,y,z"),
            ("Northing,Easting,Elevation", "y,x,z"),
            ("E,N,H", "x,y,z"),
            ("Pt,N,E,Z,Code", "Pt,y,x,z,Code"),
            ("latitude,longitude,altitude", "y,x,z"),
            ("lon,lat,height", "x,y,z"),
            ("alt,Lat (deg),Lon (deg)", "z,y,x"),
            ("T,Points:0,Points:1,Points:2", "T,x,y,z"),
            ("Points_m_XYZ:0,Points_m_XYZ:1,Points_m_XYZ:2", "x,y,z"),
            (
                "RGB:0,RGB:1,RGB:2,Points_0,Points_1,Points_2",
                "red,green,blue,x,y,z",
            ),
            (
                "Normals:0,Normals:1,Normals:2,coords[0],coords[1],coords[2]",
                "nx,ny,nz,x,y,z",
            ),
            ("Rechtswert,Hochwert,Höhe", "x,y,z"),
            ("Ostwert [m],Nordwert [m],Hoehe [m]", "x,y,z"),
            ("Est,Nord,Altitude", "x,y,z"),
            ("x,y,z,rouge,vert,bleu", "x,y,z,red,green,blue"),
            ("X,Y,Z,Rot,Grün,Blau", "x,y,z,red,green,blue"),
            (",x,y,z", "-,x,y,z"),
            ("Unnamed: 0,x,y,z", "-,x,y,z"),
            (
                "X,Y,Z,Easting,Northing,Elevation",
                "x,y,z,Easting,Northing,Elevation",
            ),
            ("POINT_X,POINT_Y,POINT_Z", "x,y,z"),
            ("x_coord,y_coord,z_coord,rgb", "x,y,z,rgb"),
            (
                "pos_x,pos_y,pos_z,normal_x,normal_y,normal_z",
                "x,y,z,nx,ny,nz",
            ),
            ("Coord. X,Coord. Y,Coord. Z", "x,y,z"),
            (
                "POINT3D_ID,X,Y,Z,R,G,B,ERROR,TRACK[] as (IMAGE_ID",
                "POINT3D_ID,x,y,z,red,green,blue,ERROR,-",
            ),
            ("x,y,z,d,d", "x,y,z,d,d_2"),
        ] {
            assert_eq!(of(names).as_deref(), Some(expected), "{names}");
        }
    }

    #[test]
    fn what_names_no_place_is_none() {
        for names in [
            "x,y",
            "a,b,c",
            "red,green,blue",
            "x,lat,z",
            "hello world",
            "",
        ] {
            assert_eq!(of(names), None, "{names}");
        }
    }
}
