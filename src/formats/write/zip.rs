//! ZIP archives (PKWARE), deflated, or stored as USDZ asks for it: no times, so that equal content gives equal bytes.

use miniz_oxide::deflate::compress_to_vec;

/// Level of the compression: half as fast as the fastest, and near the best of text.
const LEVEL: u8 = 6;

/// How the files lie in an archive.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Packing {
    Deflated,
    /// As they are, each from a multiple of 64 bytes on.
    StoredAt64,
}

/// An archive of these files, by name. Names are ASCII.
pub(super) fn archive(files: &[(&str, &[u8])], packing: Packing) -> Vec<u8> {
    let mut out = Vec::new();
    let mut directory = Vec::new();
    for (name, content) in files {
        let compressed;
        let (method, packed): (u16, &[u8]) = match packing {
            Packing::StoredAt64 => (0, content),
            Packing::Deflated => {
                compressed = compress_to_vec(content, LEVEL);
                (8, &compressed)
            }
        };
        let start = out.len() as u32;
        // Version 2.0, no flags, the method, the first day of 1980.
        let mut entry = Vec::new();
        [20, 0, method, 0, 0x21u16]
            .iter()
            .for_each(|x| entry.extend(x.to_le_bytes()));
        let sizes = [crc32(content), packed.len() as u32, content.len() as u32];
        sizes.iter().for_each(|x| entry.extend(x.to_le_bytes()));
        entry.extend((name.len() as u16).to_le_bytes());
        out.extend(b"PK\x03\x04");
        out.extend(&entry);
        let padding = match packing {
            Packing::Deflated => Vec::new(),
            Packing::StoredAt64 => padding(out.len() + 2 + name.len()),
        };
        out.extend((padding.len() as u16).to_le_bytes());
        out.extend(name.as_bytes());
        out.extend(padding);
        out.extend(packed);
        directory.extend(b"PK\x01\x02");
        directory.extend(20u16.to_le_bytes());
        directory.extend(&entry);
        // No extra field, no comment, first disk, no attributes.
        directory.extend([0; 12]);
        directory.extend(start.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let at = out.len() as u32;
    out.extend(&directory);
    out.extend(b"PK\x05\x06");
    let count = files.len() as u16;
    [0, 0, count, count]
        .iter()
        .for_each(|x| out.extend(x.to_le_bytes()));
    out.extend((directory.len() as u32).to_le_bytes());
    out.extend(at.to_le_bytes());
    out.extend(0u16.to_le_bytes());
    out
}

/// An extra field that ends at a multiple of 64 bytes where it starts at byte `at`. Its number is the one that USD gives it.
fn padding(at: usize) -> Vec<u8> {
    const NUMBER: u16 = 0x1986;
    let head = 4;
    let length = (64 - (at + head) % 64) % 64;
    let mut field = Vec::from(NUMBER.to_le_bytes());
    field.extend((length as u16).to_le_bytes());
    field.resize(head + length, 0);
    field
}

/// The checksum of ISO 3309, by the byte.
fn crc32(bytes: &[u8]) -> u32 {
    let table: [u32; 256] = std::array::from_fn(|i| {
        (0..8).fold(i as u32, |c, _| {
            if c & 1 == 1 {
                0xedb8_8320 ^ (c >> 1)
            } else {
                c >> 1
            }
        })
    });
    let step = |crc: u32, &byte: &u8| table[(crc as u8 ^ byte) as usize] ^ (crc >> 8);
    !bytes.iter().fold(!0, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_the_known_one() {
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
    }
}
