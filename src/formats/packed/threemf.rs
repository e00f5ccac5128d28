//! 3MF (3MF Consortium): a ZIP archive with a model as XML. The vertices of its objects, where the build places them, objects of objects
//! too; the unit is the file's. Without a build all objects are where they are.

use super::super::input::Input;
use super::super::reading::{Parser, Step};
use super::super::table::{Columns, Table};
use super::super::text::number;
use super::Archive;
use crate::base::error::Result;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::collections::BTreeMap;

/// Objects of objects are not deeper than this.
const DEEPEST: usize = 32;
/// Objects that are placed many times make many points of few bytes: no more than these are believed.
const MOST_POINTS: u64 = 1 << 27;

/// Rows `x y z 1` times this: the last three numbers are the place.
type Matrix = [f64; 12];
const IDENTITY: Matrix = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0];

#[derive(Default)]
struct Object {
    vertices: Vec<[f64; 3]>,
    /// Objects that it is made of.
    parts: Vec<Placed>,
}

/// An object's name, of its file and in it, and where it is.
struct Placed {
    name: (String, String),
    matrix: Matrix,
}

#[derive(Default)]
struct Model {
    objects: BTreeMap<(String, String), Object>,
    build: Vec<Placed>,
    triangles: u64,
}

/// Reads the vertices.
#[derive(Default)]
pub(in super::super) struct ThreeMf {
    triangles: u64,
}

impl Parser for ThreeMf {
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step> {
        if !input.last {
            return Ok(Step::More);
        }
        let archive = Archive::open(input.rest(), None)?;
        let is_model = |name: &str| name.to_ascii_lowercase().ends_with(".model");
        let mut model = Model::default();
        let mut found = false;
        for entry in archive.entries.iter().filter(|entry| is_model(&entry.name)) {
            found = true;
            let content = archive.unpack(entry)?;
            let path = format!("/{}", entry.name.trim_start_matches('/'));
            read_model(&content, &path, &mut model)
                .map_err(|wrong| input.bad_byte(0, &format!("a model in {}", entry.name), wrong))?;
        }
        if !found {
            return Err(input.bad_byte(0, "a model (3D/3dmodel.model) in the archive", "none"));
        }
        self.triangles = model.triangles;
        let table = table.insert(Table::new(Columns::xyz(), None));
        let mut left = MOST_POINTS;
        let whole = if model.build.is_empty() {
            model
                .objects
                .values()
                .all(|object| push_vertices(object, &IDENTITY, &mut left, table))
        } else {
            model
                .build
                .iter()
                .all(|placed| push(&model, placed, &IDENTITY, DEEPEST, &mut left, table))
        };
        if !whole {
            let expected = format!("at most {MOST_POINTS} vertices, and objects {DEEPEST} deep");
            return Err(input.unsupported(&expected, "more"));
        }
        if table.rows == 0 && table.dropped == 0 {
            return Err(input.bad_byte(0, "vertices in the model", "none"));
        }
        Ok(Step::Done)
    }

    fn faces(&self) -> u64 {
        self.triangles
    }
}

/// Puts an object, where it is placed, into the table; `false` where it is too deep or too much.
fn push(
    model: &Model,
    placed: &Placed,
    outer: &Matrix,
    depth: usize,
    left: &mut u64,
    table: &mut Table,
) -> bool {
    let Some(object) = model.objects.get(&placed.name) else {
        return true;
    };
    let matrix = times(&placed.matrix, outer);
    depth > 0
        && push_vertices(object, &matrix, left, table)
        && object.parts.iter().all(|part| {
            // Objects that only hold others make work, too.
            *left = left.saturating_sub(1);
            *left > 0 && push(model, part, &matrix, depth - 1, left, table)
        })
}

fn push_vertices(object: &Object, matrix: &Matrix, left: &mut u64, table: &mut Table) -> bool {
    if object.vertices.len() as u64 > *left {
        return false;
    }
    *left -= object.vertices.len() as u64;
    for &vertex in &object.vertices {
        table.push(&apply(matrix, vertex));
    }
    true
}

fn apply(m: &Matrix, [x, y, z]: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| x * m[axis] + y * m[3 + axis] + z * m[6 + axis] + m[9 + axis])
}

/// First `a`, then `b`.
fn times(a: &Matrix, b: &Matrix) -> Matrix {
    let zero = [b[9], b[10], b[11]];
    let mut product = [0.0; 12];
    for row in 0..4 {
        let vector = [a[3 * row], a[3 * row + 1], a[3 * row + 2]];
        let moved = apply(b, vector);
        for axis in 0..3 {
            // A direction is not moved.
            let place = if row == 3 { 0.0 } else { zero[axis] };
            product[3 * row + axis] = moved[axis] - place;
        }
    }
    product
}

/// Reads a model's XML; what is wrong with it in words.
fn read_model(content: &[u8], path: &str, model: &mut Model) -> std::result::Result<(), String> {
    let text = String::from_utf8_lossy(content);
    let mut reader = Reader::from_str(&text);
    let mut object: Option<(String, Object)> = None;
    loop {
        let event = reader.read_event().map_err(|error| error.to_string())?;
        match event {
            Event::Eof => return Ok(()),
            Event::Start(tag) | Event::Empty(tag) => {
                let get = |name: &str| attribute(&tag, name);
                match tag.local_name().as_ref() {
                    "object" => object = Some((get("id").unwrap_or_default(), Object::default())),
                    "vertex" => {
                        let axis = |name: &str| {
                            get(name)
                                .and_then(|text| number(text.as_bytes()))
                                .ok_or_else(|| format!("a vertex without {name}"))
                        };
                        let vertex = [axis("x")?, axis("y")?, axis("z")?];
                        if let Some((_, object)) = &mut object {
                            object.vertices.push(vertex);
                        }
                    }
                    "triangle" => model.triangles += 1,
                    "component" => {
                        if let Some((_, object)) = &mut object {
                            object.parts.push(placed(&tag, path)?);
                        }
                    }
                    "item" => model.build.push(placed(&tag, path)?),
                    _ => {}
                }
            }
            Event::End(tag) if tag.local_name().as_ref() == "object" => {
                if let Some((id, object)) = object.take() {
                    model.objects.insert((path.into(), id), object);
                }
            }
            _ => {}
        }
    }
}

/// What a component or an item of the build places.
fn placed(tag: &BytesStart, path: &str) -> std::result::Result<Placed, String> {
    let id = attribute(tag, "objectid").ok_or("an item without objectid")?;
    let path = attribute(tag, "path").unwrap_or_else(|| path.into());
    let matrix = match attribute(tag, "transform") {
        None => IDENTITY,
        Some(text) => {
            let values: Vec<f64> = text
                .split_ascii_whitespace()
                .filter_map(|word| number(word.as_bytes()))
                .collect();
            Matrix::try_from(values)
                .map_err(|_| format!("a transform of other than 12 numbers: {text:.40}"))?
        }
    };
    Ok(Placed {
        name: (path, id),
        matrix,
    })
}

fn attribute(tag: &BytesStart, name: &str) -> Option<String> {
    let mut attributes = tag.attributes();
    let mut attributes = attributes
        .with_checks(false)
        .filter_map(std::result::Result::ok);
    let found = attributes.find(|attribute| attribute.key.local_name().as_ref() == name)?;
    Some(found.value.into_owned())
}
