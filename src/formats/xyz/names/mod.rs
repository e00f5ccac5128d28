//! Names of columns as instruments, geographic information systems and viewers write them.
//!
//! A name is read without case, quotes, accents, units in brackets (`X [m]`, `Z (US ft)`) and marks between its words.
//! `Points:0`, `Points_1` and `Points[2]` are the components of what is before the number. Where no name is an axis by itself,
//! one word of it says the axis (`world_x`, `E_UTM32`), and the other words are those of its neighbours.

mod lists;
mod role;
mod unit;

use role::{Role, loose, role};
pub(super) use unit::{unit, unit_of_line};

/// What a table's names say together.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Named {
    /// A role for each column: `x y z`, `nx ny nz`, `red green blue`, `rgb`, `-` for one that is passed over, or its own name.
    pub(super) roles: Vec<String>,
    /// The third axis is one of a name that could mean something else: a depth, or a height beside x and y.
    pub(super) weak: bool,
}

/// What the names say; `None` where x, y or z is missing.
pub(super) fn named(names: &[String]) -> Option<Named> {
    by(names, loose)
}

/// `beside` gives what one word of a name says, and its other words.
fn by(names: &[String], beside: fn(&str) -> Option<(Role, String)>) -> Option<Named> {
    let known: Vec<Option<Role>> = names.iter().map(|name| role(name)).collect();
    let find = |wanted: Role| known.iter().position(|role| *role == Some(wanted));
    let beside: Vec<Option<(Role, String)>> = names
        .iter()
        .zip(&known)
        .map(|(name, known)| beside(name).filter(|_| known.is_none()))
        .collect();
    let is_beside = |i: usize, wanted: Role, stem: Option<&str>| {
        let found = beside[i].as_ref();
        found.is_some_and(|(role, own)| *role == wanted && stem.is_none_or(|stem| stem == own))
    };
    let find_beside =
        |wanted: Role, stem: Option<&str>| (0..names.len()).find(|&i| is_beside(i, wanted, stem));
    // Columns of these roles whose names have the same other words.
    let alike = |wanted: &[Role]| -> Option<Vec<usize>> {
        (0..names.len()).find_map(|i| {
            let (role, stem) = beside[i].as_ref()?;
            let all = || wanted.iter().map(|w| find_beside(*w, Some(stem))).collect();
            (wanted[0] == *role).then(all)?
        })
    };
    let across = |axis, family| Role::Across { axis, family };
    let strict = (0..role::FAMILIES)
        .find_map(|family| Some([find(across(0, family))?, find(across(1, family))?]));
    let pair = strict.or_else(|| {
        (0..role::FAMILIES).find_map(|family| {
            let wanted = [across(0, family), across(1, family)];
            let any = || {
                Some(vec![
                    find_beside(wanted[0], None)?,
                    find_beside(wanted[1], None)?,
                ])
            };
            // Letters of two things are no pair; words of a map are.
            let found = alike(&wanted).or_else(|| if family == 0 { None } else { any() })?;
            Some([found[0], found[1]])
        })
    })?;
    let stem = beside[pair[0]].as_ref().map(|(_, stem)| stem.as_str());
    let ranks = || (0..role::RANKS).map(|rank| Role::Up { rank });
    let (up, exact) = ranks()
        .find_map(|up| Some((find(up)?, up)))
        .or_else(|| ranks().find_map(|up| Some((find_beside(up, stem)?, up))))
        .or_else(|| ranks().find_map(|up| Some((find_beside(up, None)?, up))))?;
    let is_deep = exact == Role::Up { rank: role::DEPTH };
    let is_other =
        known[up].is_none() && exact != Role::Up { rank: 0 } && find(across(0, 0)).is_some();

    let triple = |of: fn(usize) -> Role| -> Option<[usize; 3]> {
        let strict = || Some([find(of(0))?, find(of(1))?, find(of(2))?]);
        strict().or_else(|| alike(&[of(0), of(1), of(2)])?.try_into().ok())
    };
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
    Some(Named {
        roles: distinct(roles),
        weak: is_deep || is_other,
    })
}

/// The roles of [`named`].
pub(super) fn roles(names: &[String]) -> Option<Vec<String>> {
    named(names).map(|named| named.roles)
}

/// Names that only number the columns: `V1, V2, V3`, `column_0 …`.
pub(super) fn only_number(names: &[String]) -> bool {
    let parts = |name: &String| -> Option<(String, u64)> {
        let name = name.trim();
        let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
        Some((stem.to_lowercase(), name[stem.len()..].parse().ok()?))
    };
    let parts: Option<Vec<(String, u64)>> = names.iter().map(parts).collect();
    parts.is_some_and(|parts| {
        let follows = |pair: &[(String, u64)]| pair[0].0 == pair[1].0 && pair[0].1 + 1 == pair[1].1;
        parts.len() >= 3 && parts[0].1 <= 1 && parts.windows(2).all(follows)
    })
}

/// What a caller calls a column.
pub(super) fn asked(names: &[String]) -> Vec<String> {
    by(names, |_| None).map_or_else(|| names.to_vec(), |named| named.roles)
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
