//! A recipe: steps as plain data, in the order in which they are done.
//!
//! ```text
//! { step: 'register' }                                             scans in frames of their own, first of all
//! { step: 'outliers' }                                             isolated points
//! { step: 'flying' }                                               points beside a surface, or between two on a line of sight
//! { step: 'plane', drop: 'floor', behind, minShare, seed }         'floor', 'all', 'none', or numbers of planes
//! { step: 'pieces', keep: 'largest', gap }                         'largest', 'all', a count, { minShare }, or numbers of pieces
//! { step: 'box', min, max, turn, keep }                            turn: a quaternion x y z w about the middle
//! { step: 'sphere', center, radius, keep }
//! { step: 'half-space', point, normal, keep }                      the side that the normal points into
//! { step: 'polygon', points, camera, keep }                        x y … on the screen, and a matrix of 16 numbers
//! ```

use crate::base::error::{Error, Result};
use crate::base::params::Value;
use crate::prepare::pieces::{self, Keep};
use crate::prepare::planes::{self, Drop};
use crate::prepare::regions::Region;

/// Steps of a recipe, at most: a label of a point fits a byte.
pub const MOST: usize = 255;

/// One step.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// Brings several scans into one frame ([`crate::prepare::register`]), and drops those that do not fit. It is the first step.
    Register,
    /// Drops isolated points ([`crate::features::outliers`]).
    Outliers,
    /// Drops flying pixels ([`crate::prepare::strays`]).
    Flying,
    /// Drops planes ([`crate::prepare::planes`]).
    Plane {
        /// Which.
        drop: Drop,
        /// Whether what is behind them goes, too.
        behind: bool,
        /// Least share of the scan's area that a plane has, above 0 to 1.
        min_share: f64,
        /// Of the search.
        seed: u64,
    },
    /// Keeps pieces ([`crate::prepare::pieces`]).
    Pieces {
        /// Which.
        keep: Keep,
        /// Largest gap within a piece in spacings, above 0 to 100.
        gap: f32,
    },
    /// Keeps, or drops, what is inside of a region.
    Region {
        /// Which.
        region: Region,
        /// Whether the inside is what is kept.
        keep: bool,
    },
}

impl Step {
    /// The name that a recipe has for it.
    pub fn name(&self) -> &'static str {
        match self {
            Step::Register => "register",
            Step::Outliers => "outliers",
            Step::Flying => "flying",
            Step::Plane { .. } => "plane",
            Step::Pieces { .. } => "pieces",
            Step::Region { region, .. } => match region {
                Region::Box { .. } => "box",
                Region::Sphere { .. } => "sphere",
                Region::HalfSpace { .. } => "half-space",
                Region::Screen { .. } => "polygon",
            },
        }
    }

    /// The steps of a recipe.
    ///
    /// # Errors
    /// [`Error::BadOption`], whose option is as `prepare[0].keep`.
    pub fn recipe(value: &dyn Value) -> Result<Vec<Step>> {
        let steps = list(value).ok_or_else(|| bad("prepare", "an array of steps", value))?;
        if steps.len() > MOST {
            return Err(bad("prepare", &format!("at most {MOST} steps"), value));
        }
        let each = steps.iter().enumerate();
        each.map(|(i, step)| Step::of(&**step, &format!("prepare[{i}]")))
            .collect()
    }

    fn of(value: &dyn Value, path: &str) -> Result<Step> {
        const NAMES: &str = "'register', 'outliers', 'flying', 'plane', 'pieces', 'box', 'sphere', 'half-space' or 'polygon'";
        let entries = value
            .entries()
            .ok_or_else(|| bad(path, "an object with step", value))?;
        let mut fields = Fields {
            path,
            entries: entries.into_iter().map(Some).collect(),
        };
        let name = fields.take("step");
        let word = name.as_ref().and_then(|name| name.word());
        let step = match word.as_deref() {
            Some("register") => Step::Register,
            Some("outliers") => Step::Outliers,
            Some("flying") => Step::Flying,
            Some("plane") => fields.plane()?,
            Some("pieces") => fields.pieces()?,
            Some("box") => fields.cuboid()?,
            Some("sphere") => fields.sphere()?,
            Some("half-space") => fields.half_space()?,
            Some("polygon") => fields.polygon()?,
            _ => {
                let found = name.as_deref().map_or("nothing".into(), described);
                return Err(Error::bad_option(&format!("{path}.step"), NAMES, &found));
            }
        };
        fields.none_left(step)
    }
}

/// The properties of a step's object, each of which is taken once.
struct Fields<'a> {
    path: &'a str,
    entries: Vec<Option<(String, Box<dyn Value>)>>,
}

impl Fields<'_> {
    fn take(&mut self, name: &str) -> Option<Box<dyn Value>> {
        let is_it = |entry: &&mut Option<(String, Box<dyn Value>)>| {
            entry.as_ref().is_some_and(|(own, _)| own == name)
        };
        let entry = self.entries.iter_mut().find(is_it)?.take();
        entry.map(|(_, value)| value)
    }

    /// What `read` makes of a property, `fallback` where there is none.
    fn read<T>(
        &mut self,
        name: &str,
        expected: &str,
        fallback: Option<T>,
        read: impl Fn(&dyn Value) -> Option<T>,
    ) -> Result<T> {
        let option = format!("{}.{name}", self.path);
        match self.take(name) {
            Some(value) => read(&*value).ok_or_else(|| bad(&option, expected, &*value)),
            None => fallback.ok_or_else(|| Error::bad_option(&option, expected, "nothing")),
        }
    }

    fn numbers<const N: usize>(&mut self, name: &str) -> Result<[f64; N]> {
        let expected = format!("{N} numbers");
        self.read(name, &expected, None, |value| {
            numbers(value)?.try_into().ok()
        })
    }

    fn switch(&mut self, name: &str, fallback: bool) -> Result<bool> {
        self.read(name, "true or false", Some(fallback), |value| {
            value.switch()
        })
    }

    fn number(&mut self, name: &str, expected: &str, most: f64, fallback: f64) -> Result<f64> {
        let is_in = move |x: &f64| *x > 0.0 && *x <= most;
        self.read(name, expected, Some(fallback), move |value| {
            value.number().filter(is_in)
        })
    }

    fn plane(&mut self) -> Result<Step> {
        let which = |value: &dyn Value| match value.word().as_deref() {
            Some("floor") => Some(Drop::Floor),
            Some("all") => Some(Drop::All),
            Some("none") => Some(Drop::None),
            Some(_) => None,
            None => indices(value).map(Drop::Numbers),
        };
        let expected = "'floor', 'all', 'none' or an array of planes' numbers";
        let drop = self.read("drop", expected, Some(Drop::Floor), which)?;
        let carries = matches!(drop, Drop::Floor | Drop::All);
        Ok(Step::Plane {
            drop,
            behind: self.switch("behind", carries)?,
            min_share: self.number("minShare", "a number in (0, 1]", 1.0, planes::MIN_SHARE)?,
            seed: self.read("seed", "an integer of at least 0", Some(0), |value| {
                whole(value, 9e15)
            })?,
        })
    }

    fn pieces(&mut self) -> Result<Step> {
        let which = |value: &dyn Value| match value.word().as_deref() {
            Some("largest") => Some(Keep::Largest(1)),
            Some("all") => Some(Keep::All),
            Some(_) => None,
            None if value.number().is_some() => whole(value, 4e9)
                .filter(|&n| n > 0)
                .map(|n| Keep::Largest(n as usize)),
            None => min_share(value)
                .map(Keep::MinShare)
                .or_else(|| indices(value).map(Keep::Numbers)),
        };
        let expected =
            "'largest', 'all', a count, { minShare } from 0 to 1, or an array of pieces' numbers";
        Ok(Step::Pieces {
            keep: self.read("keep", expected, Some(Keep::Largest(1)), which)?,
            gap: self.number("gap", "a number in (0, 100]", 100.0, f64::from(pieces::GAP))? as f32,
        })
    }

    fn cuboid(&mut self) -> Result<Step> {
        let (min, max) = (self.numbers("min")?, self.numbers("max")?);
        let turn = self.read("turn", "4 numbers", Some(None), |value| {
            Some(Some(numbers(value)?.try_into().ok()?))
        })?;
        self.region(Region::cuboid(min, max, turn))
    }

    fn sphere(&mut self) -> Result<Step> {
        let center = self.numbers("center")?;
        let radius = self.read("radius", "a number", None, |value| value.number())?;
        self.region(Region::sphere(center, radius))
    }

    fn half_space(&mut self) -> Result<Step> {
        let (point, normal) = (self.numbers("point")?, self.numbers("normal")?);
        self.region(Region::half_space(point, normal))
    }

    fn polygon(&mut self) -> Result<Step> {
        let points = self.read("points", "an array of x y …", None, numbers)?;
        let camera: [f64; 16] = self.numbers("camera")?;
        self.region(Region::screen(&points, &camera))
    }

    fn region(&mut self, region: Result<Region>) -> Result<Step> {
        let region = region.map_err(|error| match error {
            Error::BadOption {
                option,
                expected,
                found,
            } => Error::bad_option(&format!("{}.{option}", self.path), &expected, &found),
            other => other,
        })?;
        let keep = self.switch("keep", true)?;
        Ok(Step::Region { region, keep })
    }

    /// The step, unless something was given that it does not know.
    fn none_left(self, step: Step) -> Result<Step> {
        match self.entries.into_iter().flatten().next() {
            None => Ok(step),
            Some((name, value)) => Err(Error::bad_option(
                &format!("{}.{name}", self.path),
                &format!("no such property of the step '{}'", step.name()),
                &described(&*value),
            )),
        }
    }
}

/// The entries of an array, whose names are 0, 1, 2 …
fn list(value: &dyn Value) -> Option<Vec<Box<dyn Value>>> {
    let entries = value.entries()?;
    let in_order = entries
        .iter()
        .enumerate()
        .all(|(i, (name, _))| *name == i.to_string());
    in_order.then(|| entries.into_iter().map(|(_, value)| value).collect())
}

fn numbers(value: &dyn Value) -> Option<Vec<f64>> {
    list(value)?.iter().map(|value| value.number()).collect()
}

fn indices(value: &dyn Value) -> Option<Vec<u32>> {
    let list = list(value)?;
    list.iter()
        .map(|value| whole(&**value, 4e9).map(|i| i as u32))
        .collect()
}

fn whole(value: &dyn Value, most: f64) -> Option<u64> {
    let number = value.number()?;
    let is_whole = (0.0..=most).contains(&number) && number == libm::trunc(number);
    is_whole.then_some(number as u64)
}

/// Of `{ minShare }` and nothing else.
fn min_share(value: &dyn Value) -> Option<f64> {
    let entries = value.entries()?;
    let [(name, share)] = &entries[..] else {
        return None;
    };
    let share = share.number().filter(|x| (0.0..=1.0).contains(x));
    share.filter(|_| name == "minShare")
}

fn described(value: &dyn Value) -> String {
    if let Some(number) = value.number() {
        return number.to_string();
    }
    if let Some(yes) = value.switch() {
        return yes.to_string();
    }
    match value.word() {
        Some(word) => format!("'{word}'"),
        None => value.entries().map_or("nothing", |_| "an object").into(),
    }
}

fn bad(option: &str, expected: &str, value: &dyn Value) -> Error {
    Error::bad_option(option, expected, &described(value))
}
