//! A file read slice by slice.

use super::input::{Input, Place};
use super::table::{Block, Table, Verdict};
use super::{Format, Positions, RawCloud, Stations, detect};
#[cfg(feature = "files")]
use super::{glb, obj, off, pcd, ply, stl, xyz};
use crate::base::error::Result;

/// So many bytes, or the whole file, are looked at to tell its format.
const HEAD: usize = 1 << 16;

/// A format's reader. Some take what is at hand and keep what they need; those that jump about in a file take nothing
/// before all of it is there.
pub(super) trait Parser {
    /// Takes what it can from the front of the input, and puts the points into the table, which it makes.
    fn parse(&mut self, input: &mut Input, table: &mut Option<Table>) -> Result<Step>;

    /// Faces that the file has, once all was parsed.
    fn faces(&self) -> u64 {
        0
    }
}

/// How far a parser is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Step {
    /// It wants more bytes; or, where there are no more, to be called again with the same.
    More,
    /// All points are in the table.
    Done,
}

/// Reads a file in slices, of any size: [`Reading::push`] each, then call [`Reading::end`] until it says that it is done.
/// After every call [`Reading::take_block`] has the points that came with it.
pub struct Reading {
    format: Option<Format>,
    name: Option<String>,
    size: u64,
    parser: Option<Box<dyn Parser>>,
    table: Option<Table>,
    /// What the parser has not taken yet, and where it starts.
    kept: Vec<u8>,
    place: Place,
    done: bool,
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
    /// Where the points were seen from.
    pub stations: Stations,
    /// As in [`RawCloud`].
    pub up: Option<[f64; 3]>,
    /// As in [`RawCloud`].
    pub seen_from_above: bool,
}

impl Reading {
    /// Starts to read a file of `size` bytes: of the format, or of that which its content or else its name tells.
    pub fn new(format: Option<Format>, name: Option<&str>, size: u64) -> Reading {
        Reading {
            format,
            name: name.map(String::from),
            size,
            parser: None,
            table: None,
            kept: Vec::new(),
            place: Place::default(),
            done: false,
        }
    }

    /// The next bytes.
    ///
    /// # Errors
    /// Those of [`super::read`] and of [`super::detect`].
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

    /// After the last bytes: goes on, and says whether all is read.
    ///
    /// # Errors
    /// The same.
    pub fn end(&mut self) -> Result<bool> {
        if !self.done {
            self.parse_kept(true)?;
        }
        Ok(self.done)
    }

    /// The points since the last call, and how many there can be in all, where that is known.
    pub fn take_block(&mut self) -> Option<(Block, Option<u64>)> {
        let table = self.table.as_mut()?;
        Some((table.take_block(), table.most_rows))
    }

    /// What the end of the file told.
    pub fn summary(&self) -> Summary {
        let none = Verdict {
            narrow: true,
            color_scale: 1.0,
            has_colors: false,
            has_normals: false,
        };
        let table = self.table.as_ref();
        let format = self.format.unwrap_or(Format::Xyz);
        Summary {
            format,
            points: table.map_or(0, |table| table.rows),
            verdict: table.map_or(none, Table::verdict),
            dropped: table.map_or(0, |table| table.dropped),
            replaced: table.map_or(0, Table::replaced),
            faces: self.parser.as_ref().map_or(0, |parser| parser.faces()),
            stations: table.map_or_else(Stations::default, |table| table.stations.clone()),
            up: format.is_airborne().then_some([0.0, 0.0, 1.0]),
            seen_from_above: format.is_airborne(),
        }
    }

    /// Reads a file that is all there, without a copy of it.
    pub(super) fn whole(mut self, bytes: &[u8]) -> Result<RawCloud> {
        let mut taken = 0;
        while !self.done {
            taken += self.parse(&bytes[taken..], true)?;
        }
        let Summary {
            faces,
            up,
            seen_from_above,
            ..
        } = self.summary();
        let empty = || RawCloud::new(Positions::F32(Vec::new()));
        let mut cloud = self.table.map_or_else(empty, Table::finish);
        cloud.faces = faces;
        cloud.up = up;
        cloud.seen_from_above = seen_from_above;
        Ok(cloud)
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
        let parser = match &mut self.parser {
            Some(parser) => parser,
            None => self.parser.insert(parser(format)?),
        };
        let mut input = Input::new(bytes, format, self.size, last, self.place);
        self.done = parser.parse(&mut input, &mut self.table)? == Step::Done;
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
            self.format = Some(detect::detect_head(head, self.size, self.name.as_deref())?);
        }
        Ok(self.format)
    }
}

fn parser(format: Format) -> Result<Box<dyn Parser>> {
    Ok(match format {
        #[cfg(feature = "files")]
        Format::Ply => Box::new(ply::Ply::default()),
        #[cfg(feature = "files")]
        Format::Xyz => Box::new(xyz::Xyz::default()),
        #[cfg(feature = "files")]
        Format::Pcd => Box::new(pcd::Pcd::default()),
        #[cfg(feature = "files")]
        Format::Obj => Box::new(obj::Obj::default()),
        #[cfg(feature = "files")]
        Format::Off => Box::new(off::Off::default()),
        #[cfg(feature = "files")]
        Format::Stl => Box::new(stl::Stl::default()),
        #[cfg(feature = "files")]
        Format::Glb => Box::new(glb::Glb::default()),
        #[cfg(feature = "las")]
        Format::Las => Box::new(super::las::Las::default()),
        #[cfg(feature = "e57")]
        Format::E57 => Box::new(super::e57::E57::default()),
        #[cfg(not(all(feature = "e57", feature = "files", feature = "las")))]
        other => {
            return Err(crate::Error::UnsupportedFile {
                format: other.title(),
                expected: "a build with its reader".into(),
                found: "one without".into(),
            });
        }
    })
}
