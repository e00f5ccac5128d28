//! 3MF (3MF Consortium): a ZIP archive with a model as XML. The vertices of its objects, where the build places them, objects of objects
//! too; the unit is the file's. Without a build all objects are where they are. Colours are those of colour groups and of base
//! materials, by vertex.

use super::super::colors::ColorRange;
use super::super::faces::triangles::{Face, Faces};
use super::super::input::Input;
use super::super::parser::{Parser, Step};
use super::super::table::{Columns, Table};
use super::super::text::number;
use super::archive::Archive;
use crate::base::error::Result;
use crate::cloud::Unit;
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
    triangles: Vec<[u32; 3]>,
    /// Of the vertices that triangles colour.
    colors: BTreeMap<u32, [u8; 3]>,
    /// Group and number of a colour that triangles have which name none.
    look: Option<(String, usize)>,
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
    unit: Option<Unit>,
    /// Groups of colours, by file and name.
    colors: BTreeMap<(String, String), Vec<[u8; 3]>>,
}

/// Reads the vertices.
#[derive(Default)]
pub(in super::super) struct ThreeMf {
    triangles: u64,
    unit: Option<Unit>,
    /// Where they are wanted.
    faces: Option<Faces>,
}

impl ThreeMf {
    pub(in super::super) fn new(faces: Option<Faces>) -> ThreeMf {
        ThreeMf {
            faces,
            ..ThreeMf::default()
        }
    }
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
        self.unit = model.unit;
        let columns = Columns {
            color: (!model.colors.is_empty()).then_some([3, 4, 5]),
            colors: ColorRange::Bytes,
            ..Columns::xyz()
        };
        let table = table.insert(Table::new(columns, None));
        table.gone = self.faces.is_some().then(Vec::new);
        let mut out = Out {
            table,
            faces: &mut self.faces,
            left: MOST_POINTS,
        };
        let whole = if model.build.is_empty() {
            model
                .objects
                .values()
                .all(|object| push_object(object, &IDENTITY, &mut out))
        } else {
            model
                .build
                .iter()
                .all(|placed| push(&model, placed, &IDENTITY, DEEPEST, &mut out))
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

    fn waits_for_faces(&self) -> bool {
        self.faces.is_some()
    }

    fn take_faces(&mut self) -> Option<Faces> {
        self.faces.take()
    }

    fn unit(&self) -> Option<Unit> {
        self.unit
    }
}

/// Where vertices and triangles go, and how many more are believed.
struct Out<'a> {
    table: &'a mut Table,
    faces: &'a mut Option<Faces>,
    left: u64,
}

/// Puts an object, where it is placed, into the table; `false` where it is too deep or too much.
fn push(model: &Model, placed: &Placed, outer: &Matrix, depth: usize, out: &mut Out) -> bool {
    let Some(object) = model.objects.get(&placed.name) else {
        return true;
    };
    let matrix = times(&placed.matrix, outer);
    depth > 0
        && push_object(object, &matrix, out)
        && object.parts.iter().all(|part| {
            // Objects that only hold others make work, too.
            out.left = out.left.saturating_sub(1);
            out.left > 0 && push(model, part, &matrix, depth - 1, out)
        })
}

fn push_object(object: &Object, matrix: &Matrix, out: &mut Out) -> bool {
    let size = object.vertices.len().max(object.triangles.len()) as u64;
    if size > out.left {
        return false;
    }
    out.left -= size;
    let first = out.table.next_row() as u32;
    for (i, &vertex) in object.vertices.iter().enumerate() {
        let [x, y, z] = apply(matrix, vertex);
        let [r, g, b] = object
            .colors
            .get(&(i as u32))
            .unwrap_or(&[255; 3])
            .map(f64::from);
        out.table.push(&[x, y, z, r, g, b]);
    }
    if let Some(faces) = out.faces {
        let mirrored = mirrors(matrix);
        for &[a, b, c] in &object.triangles {
            // What is no vertex of the object is none of the file: beyond all numbers of rows.
            let row = |i: u32| {
                if (i as usize) < object.vertices.len() {
                    first + i
                } else {
                    u32::MAX
                }
            };
            let rows = if mirrored { [a, c, b] } else { [a, b, c] }.map(row);
            faces.push(
                Face {
                    rows: &rows,
                    ..Face::default()
                },
                |_| None,
            );
        }
    }
    true
}

/// Whether triangles run the other way round.
fn mirrors(m: &Matrix) -> bool {
    let cofactor = |a: usize, b: usize| m[3 + a] * m[6 + b] - m[3 + b] * m[6 + a];
    m[0] * cofactor(1, 2) + m[1] * cofactor(2, 0) + m[2] * cofactor(0, 1) < 0.0
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
    let mut group = String::new();
    loop {
        let event = reader.read_event().map_err(|error| error.to_string())?;
        match event {
            Event::Eof => return Ok(()),
            Event::Start(tag) | Event::Empty(tag) => {
                let get = |name: &str| attribute(&tag, name);
                match tag.local_name().as_ref() {
                    "model" => model.unit = model.unit.or(unit(get("unit").as_deref())),
                    "colorgroup" | "basematerials" => group = get("id").unwrap_or_default(),
                    "color" | "base" => {
                        let text = get("color").or_else(|| get("displaycolor"));
                        let colors = model
                            .colors
                            .entry((path.into(), group.clone()))
                            .or_default();
                        colors.push(text.as_deref().and_then(color).unwrap_or([255; 3]));
                    }
                    "object" => {
                        let look = get("pid").zip(get("pindex").and_then(|text| text.parse().ok()));
                        object = Some((
                            get("id").unwrap_or_default(),
                            Object {
                                look,
                                ..Object::default()
                            },
                        ));
                    }
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
                    "triangle" => {
                        model.triangles += 1;
                        if let Some((_, object)) = &mut object {
                            let index =
                                |name: &str| get(name).and_then(|text| text.parse::<u32>().ok());
                            let corners =
                                ["v1", "v2", "v3"].map(|name| index(name).unwrap_or(u32::MAX));
                            object.triangles.push(corners);
                            let first = index("p1").map(|i| i as usize);
                            let own = get("pid")
                                .or_else(|| object.look.as_ref().map(|(group, _)| group.clone()));
                            let colors = own.and_then(|own| model.colors.get(&(path.into(), own)));
                            let places = [
                                first,
                                index("p2").map(|i| i as usize),
                                index("p3").map(|i| i as usize),
                            ];
                            let whole = object.look.as_ref().map(|(_, i)| *i);
                            for (corner, place) in corners.into_iter().zip(places) {
                                let place = place.or(first).or(whole);
                                if let Some(color) =
                                    colors.zip(place).and_then(|(colors, i)| colors.get(i))
                                {
                                    object.colors.insert(corner, *color);
                                }
                            }
                        }
                    }
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

/// The unit of a model; millimetres where it says none.
fn unit(name: Option<&str>) -> Option<Unit> {
    match name {
        None | Some("millimeter") => Some(Unit::Millimetre),
        Some("centimeter") => Some(Unit::Centimetre),
        Some("meter") => Some(Unit::Metre),
        Some("inch") => Some(Unit::Inch),
        Some("foot") => Some(Unit::Foot),
        Some(_) => None,
    }
}

/// `#RRGGBB`, or with two more digits that say how opaque.
fn color(text: &str) -> Option<[u8; 3]> {
    let digits = text.strip_prefix('#')?;
    let byte = |at: usize| u8::from_str_radix(digits.get(at..at + 2)?, 16).ok();
    Some([byte(0)?, byte(2)?, byte(4)?])
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
