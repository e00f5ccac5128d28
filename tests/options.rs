//! Options as JavaScript gives them: the names and defaults of the package's table are those of the crate.
#![cfg(not(target_arch = "wasm32"))]

use pointweave::base::params::Value;
use pointweave::{ReduceParams, SurfaceParams};

/// A value of JavaScript's.
#[derive(Clone, Debug, PartialEq)]
enum Js {
    Number(f64),
    Switch(bool),
    Word(String),
    Object(Vec<(String, Js)>),
}

impl Value for Js {
    fn number(&self) -> Option<f64> {
        match *self {
            Js::Number(number) => Some(number),
            _ => None,
        }
    }

    fn switch(&self) -> Option<bool> {
        match *self {
            Js::Switch(switch) => Some(switch),
            _ => None,
        }
    }

    fn word(&self) -> Option<String> {
        match self {
            Js::Word(word) => Some(word.clone()),
            _ => None,
        }
    }

    fn entries(&self) -> Option<Vec<(String, Box<dyn Value>)>> {
        match self {
            Js::Object(entries) => Some(
                entries
                    .iter()
                    .map(|(name, value)| (name.clone(), Box::new(value.clone()) as Box<dyn Value>))
                    .collect(),
            ),
            _ => None,
        }
    }
}

fn word(text: &str) -> Js {
    Js::Word(text.trim().trim_matches('\'').into())
}

fn object(name: &str, value: Js) -> Js {
    Js::Object(vec![(name.into(), value)])
}

/// A row of the package's table: its name, its default where it has one, and a value that is not the default.
struct Row {
    name: String,
    default: Option<Js>,
    other: Js,
}

/// `name: kind(facts),` of `pkg/engine/options-table.js`.
fn row(line: &str) -> Row {
    let (name, rest) = line.trim().split_once(": ").expect("a name");
    let (kind, facts) = rest.trim_end_matches("),").split_once('(').expect("a kind");
    let facts: Vec<&str> = facts.split(", ").collect();
    let number = |text: &str| text.trim().parse::<f64>().ok().map(Js::Number);
    let (default, other) = match kind {
        "choice" => (Some(word(facts[0])), word(facts[1])),
        "toggle" => {
            let yes = facts[0] == "true";
            (Some(Js::Switch(yes)), Js::Switch(!yes))
        }
        "integer" => {
            let low: f64 = facts[0].parse().expect("the lowest");
            let default = facts.get(2).and_then(|text| number(text));
            (default, Js::Number(low + 1.0))
        }
        "number" => {
            let fallback = rest.split_once("fallback: ");
            let default = fallback.map(|(_, end)| end.trim_end_matches(" }),"));
            let default = default.map(|text| number(text).unwrap_or_else(|| word(text)));
            let [low, high] = [0, 1].map(|i| facts[i].parse::<f64>().expect("an end"));
            (default, Js::Number(0.25 * low + 0.75 * high))
        }
        "oneOf" => {
            assert!(rest.contains("{ ratio: 1 / 3 }"), "{line}");
            let third = object("ratio", Js::Number(1.0 / 3.0));
            (Some(third), object("count", Js::Number(7.0)))
        }
        "named" => (Some(Js::Object(vec![])), object("height", word("majority"))),
        "nested" => (Some(Js::Object(vec![])), Js::Switch(false)),
        _ => panic!("{line}"),
    };
    let name = name.into();
    Row {
        name,
        default,
        other,
    }
}

/// The rows of a table of the package's.
fn rows(table: &str) -> Vec<Row> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/pkg/engine/options-table.js");
    let source = std::fs::read_to_string(path).expect("the package's table");
    let start = format!("export const {table} = {{\n");
    let (_, rest) = source.split_once(&start).expect("a table of that name");
    let (body, _) = rest.split_once("\n};").expect("its end");
    body.lines().map(row).collect()
}

fn check<T: PartialEq + std::fmt::Debug>(
    table: &str,
    default: T,
    given: impl Fn(&Js) -> pointweave::Result<T>,
) {
    let rows = rows(table);
    assert!(rows.len() > 12);
    let defaults = rows
        .iter()
        .filter_map(|row| Some((row.name.clone(), row.default.clone()?)));
    assert_eq!(given(&Js::Object(defaults.collect())).unwrap(), default);
    for Row { name, other, .. } in rows {
        let changed = given(&object(&name, other)).unwrap();
        assert_ne!(changed, default, "{name} is not taken");
        let wrong = given(&object(&name, word("nothing of the kind"))).unwrap_err();
        assert_eq!(wrong.code(), "bad-option");
        assert!(wrong.to_string().contains(&name), "{wrong}");
    }
}

#[test]
fn every_option_of_the_package_is_taken_and_has_the_default_of_the_crate() {
    check("REDUCE", ReduceParams::default(), |js| {
        ReduceParams::given(js)
    });
    check("RECONSTRUCT", SurfaceParams::default(), |js| {
        SurfaceParams::given(js)
    });
}

#[test]
fn an_integer_is_one_and_a_target_is_one() {
    let reduce = |name: &str, value: Js| ReduceParams::given(&object(name, value));
    for number in [-1.0, 0.5, f64::NAN, f64::INFINITY, 1e17] {
        assert!(reduce("seed", Js::Number(number)).is_err(), "{number}");
    }
    assert!(reduce("maxDepth", Js::Number(5e9)).is_err());
    let both = [("ratio", 0.5), ("count", 7.0)].map(|(name, x)| (name.into(), Js::Number(x)));
    assert!(reduce("target", Js::Object(both.into())).is_err());
    assert!(reduce("target", Js::Object(vec![])).is_err());
    let nested = object("reduce", object("seed", Js::Number(5.0)));
    let reduce = SurfaceParams::given(&nested).unwrap().reduce;
    assert_eq!(reduce.map(|params| params.seed), Some(5));
}
