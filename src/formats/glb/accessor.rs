//! Typed values in the data of a glTF file.

use super::super::input::Input;
use super::scene::{BufferView, Document};
use crate::base::error::Result;
use std::collections::BTreeMap;

/// Values of up to four components; only those that the data really has.
pub(super) struct Accessor<'a> {
    /// From the first value on; `None` where all are 0 but the sparse ones.
    bytes: Option<&'a [u8]>,
    stride: usize,
    component: Component,
    components: usize,
    pub(super) count: usize,
    /// Values that replace others.
    sparse: BTreeMap<usize, [f64; 4]>,
}

impl<'a> Accessor<'a> {
    pub(super) fn open(
        document: &Document,
        index: usize,
        buffer: &'a [u8],
        input: &Input,
    ) -> Result<Accessor<'a>> {
        let wrong =
            |what: &str| input.bad_byte(20, &format!("accessor {index} to be of the data"), what);
        let entry = document
            .accessors
            .get(index)
            .ok_or_else(|| wrong("no such accessor"))?;
        let components = match entry.kind.as_str() {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => return Err(wrong("a type that is no vector")),
        };
        let component = Component::of(entry.component_type, entry.normalized)
            .ok_or_else(|| wrong("a component type that does not exist"))?;
        let size = components * component.size();
        let data =
            |view: usize, offset: usize, size: usize, stride: Option<usize>, count: usize| {
                let view = document
                    .buffer_views
                    .get(view)
                    .filter(|view| view.buffer == 0)
                    .ok_or_else(|| wrong("no buffer view"))?;
                // In files after glTF 1.0, 0 means one value behind the other.
                let own = view.byte_stride.filter(|&stride| stride > 0);
                let stride = stride.or(own).unwrap_or(size);
                let bytes = within(view, offset, buffer)
                    .ok_or_else(|| wrong("bytes beyond the end of the data"))?;
                let needed = count
                    .checked_sub(1)
                    .and_then(|before| before.checked_mul(stride)?.checked_add(size));
                match needed {
                    Some(needed) if needed > bytes.len() => {
                        Err(wrong("more values than the data has bytes for"))
                    }
                    None if count > 0 => Err(wrong("more values than the data has bytes for")),
                    _ => Ok((bytes, stride)),
                }
            };
        let (bytes, stride) = match entry.buffer_view {
            Some(view) => {
                let (bytes, stride) = data(view, entry.byte_offset, size, None, entry.count)?;
                (Some(bytes), stride)
            }
            // Values that are all 0 take no bytes: so many are not believed.
            None if entry.count > buffer.len() => {
                return Err(wrong("more values than the data has bytes"));
            }
            None => (None, size),
        };
        let mut accessor = Accessor {
            bytes,
            stride,
            component,
            components,
            count: entry.count,
            sparse: BTreeMap::new(),
        };
        if let Some(sparse) = &entry.sparse {
            let kind = Component::of(sparse.indices.component_type, false)
                .ok_or_else(|| wrong("indices of no type"))?;
            let part = &sparse.indices;
            let (indices, _) = data(
                part.buffer_view,
                part.byte_offset,
                kind.size(),
                Some(kind.size()),
                sparse.count,
            )?;
            let part = &sparse.values;
            let (values, _) = data(
                part.buffer_view,
                part.byte_offset,
                size,
                Some(size),
                sparse.count,
            )?;
            for i in 0..sparse.count {
                let at = kind.value(&indices[i * kind.size()..]) as usize;
                let value = accessor.components_of(&values[i * size..]);
                accessor.sparse.insert(at, value);
            }
        }
        Ok(accessor)
    }

    /// The first three components of value `i`; those that there are not are 0.
    pub(super) fn triple(&self, i: usize) -> [f64; 3] {
        let [x, y, z, _] = self.values(i);
        [x, y, z]
    }

    /// All four.
    pub(super) fn values(&self, i: usize) -> [f64; 4] {
        match (self.sparse.get(&i), self.bytes) {
            (Some(value), _) => *value,
            (None, Some(bytes)) => self.components_of(&bytes[i * self.stride..]),
            (None, None) => [0.0; 4],
        }
    }

    fn components_of(&self, bytes: &[u8]) -> [f64; 4] {
        let value = |c: usize| {
            if c < self.components {
                self.component.value(&bytes[c * self.component.size()..])
            } else {
                0.0
            }
        };
        [0, 1, 2, 3].map(value)
    }
}

/// What of a view lies within the data, from `offset` on.
pub(super) fn within<'a>(view: &BufferView, offset: usize, buffer: &'a [u8]) -> Option<&'a [u8]> {
    let end = view.byte_offset.checked_add(view.byte_length)?;
    buffer.get(view.byte_offset..end)?.get(offset..)
}

/// A number's type; normalised integers run from 0, or -1, to 1.
#[derive(Clone, Copy)]
struct Component {
    kind: Kind,
    normalized: bool,
}

#[derive(Clone, Copy)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(number: u32, normalized: bool) -> Option<Component> {
        let kind = match number {
            5120 => Kind::I8,
            5121 => Kind::U8,
            5122 => Kind::I16,
            5123 => Kind::U16,
            5125 => Kind::U32,
            5126 => Kind::F32,
            _ => return None,
        };
        Some(Component { kind, normalized })
    }

    fn size(self) -> usize {
        match self.kind {
            Kind::I8 | Kind::U8 => 1,
            Kind::I16 | Kind::U16 => 2,
            Kind::U32 | Kind::F32 => 4,
        }
    }

    /// The value of the first `size()` bytes.
    fn value(self, bytes: &[u8]) -> f64 {
        let mut raw = [0u8; 4];
        raw[..self.size()].copy_from_slice(&bytes[..self.size()]);
        let [a, b, ..] = raw;
        let (value, most) = match self.kind {
            Kind::I8 => (f64::from(a as i8), 127.0),
            Kind::U8 => (f64::from(a), 255.0),
            Kind::I16 => (f64::from(i16::from_le_bytes([a, b])), 32767.0),
            Kind::U16 => (f64::from(u16::from_le_bytes([a, b])), 65535.0),
            Kind::U32 => (f64::from(u32::from_le_bytes(raw)), f64::from(u32::MAX)),
            Kind::F32 => (f64::from(f32::from_le_bytes(raw)), 1.0),
        };
        if self.normalized {
            (value / most).max(-1.0)
        } else {
            value
        }
    }
}
