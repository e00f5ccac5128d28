//! A file read slice by slice.

use super::block::{Block, Verdict};
use super::detect;
use super::faces::triangles::Faces;
use super::faces::{self, FaceMode, Picture, Sampling, Want};
use super::format::Format;
use super::input::{Input, Place};
use super::opening::parser;
use super::options::ReadOptions;
use super::parser::{Parser, Step};
use super::preview::Preview;
use super::raw_cloud::{Positions, RawCloud, Skin};
use super::sentinels::LeftOut;
use super::stations::Stations;
use super::table::Table;
use super::text::MARK;
use crate::base::error::Result;
use crate::cloud::{Crs, Unit};

/// Whether any format that is compiled in has faces; the modules for LAS and E57 files leave the sampling out by this.
const HAVE_FACES: bool = cfg!(any(feature = "files", feature = "packed"));

/// So many bytes, or the whole file, are looked at to tell its format.
const HEAD: usize = 1 << 16;

/// Reads a file in slices, of any size: [`Reading::push`] each, then call [`Reading::end`] until it says that it is done.
/// After every call [`Reading::take_block`] has the points that came with it.
pub struct Reading {
    format: Option<Format>,
    name: Option<String>,
    size: u64,
    /// Faces that wait for what they need besides.
    faces: Option<Faces>,
    /// What they are as triangles.
    triangles: u64,
    sampled: Sampling,
    /// The triangles, where they come along.
    indices: Vec<u32>,
    /// The pictures on them.
    skin: Option<Skin>,
    parser: Option<Box<dyn Parser>>,
    table: Option<Table>,
    /// What the parser has not taken yet, and where it starts.
    kept: Vec<u8>,
    place: Place,
    done: bool,
    options: ReadOptions,
}

/// What is known at the end of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// The format that was read.
    pub format: Format,
    /// Points.
    pub points: u64,
    /// How the blocks become the cloud's arrays.
    pub verdict: Verdict,
    /// As in [`RawCloud`].
    pub dropped: usize,
    /// As in [`RawCloud`].
    pub replaced: usize,
    /// As in [`RawCloud`].
    pub faces: u64,
    /// What was made of them.
    pub sampling: Sampling,
    /// Where the points were seen from.
    pub stations: Stations,
    /// As in [`RawCloud`].
    pub up: Option<[f64; 3]>,
    /// As in [`RawCloud`].
    pub seen_from_above: bool,
    /// As in [`RawCloud`].
    pub unit: Option<Unit>,
    /// As in [`RawCloud`].
    pub crs: Option<Crs>,
    /// As in [`RawCloud`], but for what [`Verdict::left_out`] says.
    pub skipped: Vec<(&'static str, u64)>,
    /// As in [`RawCloud`].
    pub columns: Vec<String>,
    /// As in [`RawCloud`].
    pub notes: Vec<String>,
    /// The first rows of a table of text.
    pub preview: Option<Preview>,
}

impl Reading {
    /// Starts to read a file of `size` bytes: of the format, or of that which its content or else its name tells.
    pub fn new(format: Option<Format>, name: Option<&str>, size: u64) -> Reading {
        Reading {
            format,
            name: name.map(String::from),
            size,
            faces: None,
            triangles: 0,
            sampled: Sampling::default(),
            indices: Vec::new(),
            skin: None,
            parser: None,
            table: None,
            kept: Vec::new(),
            place: Place::default(),
            done: false,
            options: ReadOptions::default(),
        }
    }

    /// With what the caller says of the file.
    ///
    /// # Errors
    /// [`crate::Error::BadOption`].
    pub fn with_options(mut self, options: ReadOptions) -> Result<Reading> {
        options.check()?;
        self.options = options;
        // A mesh keeps its vertices.
        self.options.keep_sentinels |= self.options.faces == FaceMode::Mesh;
        Ok(self)
    }

    /// The next bytes.
    ///
    /// # Errors
    /// Those of [`super::read`] and of [`super::detect()`].
    pub fn push(&mut self, bytes: &[u8]) -> Result<()> {
        if self.done {
            return Ok(());
        }
        if self.kept.is_empty() {
            let taken = self.parse(bytes, false)?;
            self.keep(&bytes[taken..]);
            return Ok(());
        }
        self.keep(bytes);
        self.parse_kept(false)
    }

    /// After the last bytes: goes on, and says whether all is read. Where it is not, [`Reading::want`] may say what is needed.
    ///
    /// # Errors
    /// The same.
    pub fn end(&mut self) -> Result<bool> {
        if !self.done {
            self.parse_kept(true)?;
        }
        if self.done && self.want().is_none() {
            self.sample();
        }
        Ok(self.done && self.faces.is_none())
    }

    /// What the faces need besides the file, one after the other; [`Reading::give_file`] or [`Reading::give_picture`] answers.
    pub fn want(&self) -> Option<Want> {
        self.faces
            .as_ref()
            .filter(|_| HAVE_FACES)
            .and_then(Faces::want)
    }

    /// The content of the file that is wanted; `None` where there is none: what it would have said is then left out.
    pub fn give_file(&mut self, content: Option<&[u8]>) {
        if let Some(faces) = self.faces.as_mut().filter(|_| HAVE_FACES) {
            faces.give_file(content);
        }
    }

    /// The pixels of the picture that is wanted; `None` where it is of no kind that is read.
    pub fn give_picture(&mut self, picture: Option<Picture>) {
        if let Some(faces) = self.faces.as_mut().filter(|_| HAVE_FACES) {
            faces.give_picture(picture);
        }
    }

    /// The first rows of a table of text, once they are there; after an error, too.
    pub fn preview(&self) -> Option<Preview> {
        self.parser.as_ref().and_then(|parser| parser.preview())
    }

    /// The triangles over the points, three indices each; none unless [`FaceMode::Mesh`] asks for them.
    pub fn take_indices(&mut self) -> Vec<u32> {
        std::mem::take(&mut self.indices)
    }

    /// The pictures on the triangles, and where the points are in them: those of a GLB whose triangles all wear the same; none unless
    /// [`FaceMode::Mesh`] asks for them.
    pub fn take_skin(&mut self) -> Option<Skin> {
        self.skin.take()
    }

    /// Puts points of the faces in the place of the vertices, or the triangles beside them.
    fn sample(&mut self) {
        let Some(faces) = self.faces.take().filter(|_| HAVE_FACES) else {
            return;
        };
        let Some(mut vertices) = self.table.take() else {
            return;
        };
        let gone = vertices.gone.take().unwrap_or_default();
        let (dropped, replaced, invalid) = (vertices.dropped, vertices.replaced, vertices.invalid);
        let cloud = vertices.finish(true);
        if self.options.faces == FaceMode::Mesh {
            let (cloud, indices, sampled) = faces::mesh(faces, cloud, &gone);
            let mut table = Table::of(cloud);
            (table.dropped, table.replaced, table.invalid) = (dropped, replaced, invalid);
            (self.indices, self.sampled) = (indices, sampled);
            let skin = self.parser.as_mut().and_then(|parser| parser.take_skin());
            self.skin = skin.filter(|skin| skin.uvs.len() as u64 == 2 * table.rows);
            self.table = Some(table);
            return;
        }
        let (table, sampled) = faces::sample(faces, &cloud, &gone);
        let mut table = table.unwrap_or_else(|| Table::of(cloud));
        (table.dropped, table.replaced, table.invalid) = (dropped, replaced, invalid);
        self.sampled = sampled;
        self.table = Some(table);
    }

    /// The points since the last call, and how many there can be in all, where that is known.
    pub fn take_block(&mut self) -> Option<(Block, Option<u64>)> {
        let waits = |parser: &dyn Parser| parser.waits_for_faces();
        if self.faces.is_some() || self.parser.as_deref().is_some_and(waits) {
            return None;
        }
        let table = self.table.as_mut()?;
        Some((table.take_block(), table.most_rows))
    }

    /// What the end of the file told.
    pub fn summary(&self) -> Summary {
        let none = || Verdict {
            narrow: true,
            color_scale: 1.0,
            has_colors: false,
            has_normals: false,
            left_out: LeftOut::default(),
            attributes: Vec::new(),
        };
        let table = self.table.as_ref();
        let format = self.format.unwrap_or(Format::Xyz);
        let parser = self.parser.as_ref();
        let keep = self.options.keep_sentinels;
        let crs = parser.and_then(|parser| parser.crs());
        // Strips are no faces that a file counts.
        let faces = match parser.map_or(0, |parser| parser.faces()) {
            0 if self.sampled.points > 0 => self.triangles,
            faces => faces,
        };
        Summary {
            format,
            points: table.map_or(0, |table| table.rows),
            verdict: table.map_or_else(none, |table| table.verdict(keep)),
            dropped: table.map_or(0, |table| table.dropped + table.invalid),
            replaced: table.map_or(0, |table| table.replaced),
            faces,
            skipped: table.map_or(Vec::new(), |table| {
                [table.skipped([0; 2]), self.sampled.skipped()].concat()
            }),
            columns: parser.map_or(Vec::new(), |parser| parser.columns()),
            notes: parser.map_or(Vec::new(), |parser| parser.notes()),
            preview: self.preview(),
            sampling: self.sampled.clone(),
            stations: table.map_or_else(Stations::default, |table| table.stations.clone()),
            up: self.up(format),
            seen_from_above: format.is_airborne(),
            unit: crs
                .as_ref()
                .and_then(Crs::unit)
                .or_else(|| parser.and_then(|parser| parser.unit()))
                .or(format.unit()),
            crs,
        }
    }

    /// Which way is up: as the format has it. Of a PCD file, which says nothing, z as robots have it, but where all points lie before
    /// a camera at the origin that looks along z, -y as such cameras have it.
    fn up(&self, format: Format) -> Option<[f64; 3]> {
        match (format, &self.table) {
            (Format::Pcd, Some(table)) if table.rows > 0 => Some(match table.before_camera {
                true => [0.0, -1.0, 0.0],
                false => [0.0, 0.0, 1.0],
            }),
            _ => format.up(),
        }
    }

    /// Reads a file that is all there, without a copy of it; `beside` gives the files that its faces name.
    pub(super) fn whole(
        mut self,
        bytes: &[u8],
        beside: &mut dyn FnMut(&str) -> Option<Vec<u8>>,
    ) -> Result<RawCloud> {
        let mut taken = 0;
        while !self.done {
            taken += self.parse(&bytes[taken..], true)?;
        }
        while let Some(want) = self.want() {
            match want {
                Want::File(name) => self.give_file(beside(&name).as_deref()),
                Want::Picture(bytes) => self.give_picture(super::pictures::decode(&bytes)),
            }
        }
        self.sample();
        let Summary {
            faces,
            columns,
            notes,
            up,
            seen_from_above,
            unit,
            crs,
            ..
        } = self.summary();
        let empty = || RawCloud::new(Positions::F32(Vec::new()));
        let keep = self.options.keep_sentinels;
        let cloud = self.table.map_or_else(empty, |table| table.finish(keep));
        Ok(RawCloud {
            faces,
            columns,
            notes,
            up,
            seen_from_above,
            unit,
            crs,
            skipped: [cloud.skipped, self.sampled.skipped()].concat(),
            sampling: self.sampled,
            ..cloud
        })
    }

    fn keep(&mut self, bytes: &[u8]) {
        if self.kept.is_empty()
            && self.parser.is_some()
            && !bytes.is_empty()
            && self.place.byte == 0
        {
            // Nothing of the first slice was taken: this format is kept until all of it is there.
            self.kept
                .reserve_exact(usize::try_from(self.size).unwrap_or(0).min(1 << 31));
        }
        self.kept.extend_from_slice(bytes);
    }

    fn parse_kept(&mut self, last: bool) -> Result<()> {
        let mut kept = std::mem::take(&mut self.kept);
        let taken = self.parse(&kept, last)?;
        kept.drain(..taken);
        if !self.done {
            self.kept = kept;
        }
        Ok(())
    }

    /// Has the parser take what it can of the bytes; how many it took.
    fn parse(&mut self, bytes: &[u8], last: bool) -> Result<usize> {
        let Some(format) = self.tell(bytes, last)? else {
            return Ok(0);
        };
        if self.place.byte == 0 && bytes.len() < MARK.len() && !last {
            return Ok(0);
        }
        let parser = match &mut self.parser {
            Some(parser) => parser,
            None => self.parser.insert(parser(format, &self.options)?),
        };
        let mut input = Input::new(bytes, format, self.size, last, self.place);
        if self.place.byte == 0 && format.is_text() && bytes.starts_with(MARK) {
            input.skip(MARK.len() as u64);
        }
        self.done = parser.parse(&mut input, &mut self.table)? == Step::Done;
        if self.done {
            self.faces = parser
                .take_faces()
                .filter(|faces| HAVE_FACES && !faces.corners.is_empty());
            let triangles = |faces: &Faces| faces.corners.len() as u64;
            self.triangles = self.faces.as_ref().map_or(0, triangles);
        }
        self.place = input.place;
        Ok(if self.done {
            bytes.len()
        } else {
            bytes.len() - input.rest().len()
        })
    }

    /// The format, once enough bytes are there to tell.
    fn tell(&mut self, bytes: &[u8], last: bool) -> Result<Option<Format>> {
        if self.format.is_none() && (last || bytes.len() >= HEAD) {
            let head = &bytes[..bytes.len().min(HEAD)];
            let found = detect::detect_head(head, self.size, self.name.as_deref());
            self.format = Some(match found {
                // Who says what the columns are has a table.
                Err(_) if self.options.is_of_a_table() => Format::Xyz,
                found => found?,
            });
        }
        Ok(self.format)
    }
}
