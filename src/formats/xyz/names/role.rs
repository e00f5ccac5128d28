//! What one name of a column says.

use super::lists::{
    ACROSS, BESIDE, BESIDE_COLOR, COLOR, COLORS, NORMAL, NORMALS, PACKED, PLACES, UNLIKE, UP, is_in,
};

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Role {
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

pub(super) const FAMILIES: usize = ACROSS.len();
pub(super) const RANKS: usize = UP.len();
/// The rank of depths.
pub(super) const DEPTH: usize = RANKS - 1;

/// What a name says as a whole.
pub(super) fn role(name: &str) -> Option<Role> {
    let words = words(name);
    let joined = words.concat();
    if is_in(PACKED, &joined) {
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
            let is_normal = |word: &String| word.len() > 1 && is_in(NORMALS, word);
            if is_in(NORMALS, &array) || first.iter().any(is_normal) {
                return Some(Role::Normal(axis));
            }
            if is_in(PLACES, &array) {
                return Some(place(axis));
            }
        }
        if let Some(channel) = component
            && is_in(COLORS, &array)
        {
            return Some(Role::Color(channel));
        }
    }
    let without = |beside: &str| -> String {
        let kept = words.iter().filter(|word| !is_in(beside, word));
        kept.map(String::as_str).collect()
    };
    let color = COLOR
        .iter()
        .position(|channel| is_in(channel, &without(BESIDE_COLOR)));
    if let Some(channel) = color {
        return Some(Role::Color(channel));
    }
    single(&without(BESIDE)).filter(|role| matches!(role, Role::Across { .. } | Role::Up { .. }))
}

fn place(axis: usize) -> Role {
    match axis {
        2 => Role::Up { rank: 0 },
        axis => Role::Across { axis, family: 0 },
    }
}

/// The role of a name that is one word, or whose words are one.
fn single(word: &str) -> Option<Role> {
    let is = |list: &&str| is_in(list, word);
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

/// What one word of a name says, and the words beside it: those of a number behind it, too (`R8`).
pub(super) fn loose(name: &str) -> Option<(Role, String)> {
    let words = words(name);
    if words.iter().any(|word| is_in(UNLIKE, word)) {
        return None;
    }
    let last = words.len().checked_sub(1)?;
    let (at, role, digits) = [0, last].into_iter().chain(1..last).find_map(|at| {
        let letters = words[at].trim_end_matches(|c: char| c.is_ascii_digit());
        let ends = at == 0 || at == last;
        // A letter in the middle is a word like others.
        let role = single(letters).filter(|_| ends || letters.chars().nth(1).is_some())?;
        Some((at, role, words[at][letters.len()..].to_owned()))
    })?;
    let mut beside = digits;
    let others = words.iter().enumerate().filter(|(i, _)| *i != at);
    others.for_each(|(_, word)| beside.push_str(word));
    (!beside.is_empty()).then_some((role, beside))
}

/// Lower case, without units in brackets and accents, taken apart at what is neither letter nor digit, and before a capital
/// behind a small letter.
pub(super) fn words(name: &str) -> Vec<String> {
    let mut inside = 0;
    let mut text = String::new();
    let mut small = false;
    for whole in name.chars() {
        if small && whole.is_ascii_uppercase() && inside == 0 {
            text.push(' ');
        }
        small = whole.is_ascii_lowercase();
        for c in whole.to_lowercase() {
            match c {
                '(' | '{' => inside += 1,
                ')' | '}' => inside -= 1,
                _ if inside > 0 => {}
                // Accents that stand behind their letter.
                '\u{300}'..='\u{36f}' => {}
                c => text.push(without_accent(c)),
            }
        }
    }
    // Brackets hold a unit, `X [m]`, or a component, `Points[0]`.
    if let Some((before, rest)) = text.split_once('[')
        && !before.trim().is_empty()
        && !rest
            .trim_end_matches([']', ' '])
            .chars()
            .all(|c| c.is_ascii_digit() || "xyz".contains(c))
    {
        text = before.into();
    }
    let parts = text.split(|c: char| !c.is_alphanumeric());
    parts
        .filter(|part| !part.is_empty())
        .map(String::from)
        .collect()
}

fn without_accent(c: char) -> char {
    const LETTERS: [(char, &str); 16] = [
        ('a', "äàâáãåāą"),
        ('c', "çćč"),
        ('d', "ďđ"),
        ('e', "éèêëēęě"),
        ('g', "ğ"),
        ('i', "íìîïīı"),
        ('l', "ł"),
        ('n', "ñńň"),
        ('o', "öôóòõøőō"),
        ('r', "ř"),
        ('s', "śşš"),
        ('t', "ťţ"),
        ('u', "üùûúůűū"),
        ('y', "ýÿ"),
        ('z', "źżž"),
        ('е', "ё"),
    ];
    let found = LETTERS.iter().find(|(_, accented)| accented.contains(c));
    found.map_or(c, |(letter, _)| *letter)
}
