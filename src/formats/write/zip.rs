//! ZIP archives (PKWARE), deflated: no times, so that equal content gives equal bytes.

use miniz_oxide::deflate::compress_to_vec;

/// Level of the compression: half as fast as the fastest, and near the best of text.
const LEVEL: u8 = 6;

/// An archive of these files, by name. Names are ASCII.
pub(super) fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut out = Vec::new();
    let mut directory = Vec::new();
    for (name, content) in files {
        let packed = compress_to_vec(content, LEVEL);
        let start = out.len() as u32;
        // Version 2.0, no flags, deflated, the first day of 1980.
        let mut entry = Vec::new();
        [20, 0, 8, 0, 0x21u16]
            .iter()
            .for_each(|x| entry.extend(x.to_le_bytes()));
        let sizes = [crc32(content), packed.len() as u32, content.len() as u32];
        sizes.iter().for_each(|x| entry.extend(x.to_le_bytes()));
        entry.extend((name.len() as u16).to_le_bytes());
        entry.extend(0u16.to_le_bytes());
        out.extend(b"PK\x03\x04");
        out.extend(&entry);
        out.extend(name.as_bytes());
        out.extend(&packed);
        directory.extend(b"PK\x01\x02");
        directory.extend(20u16.to_le_bytes());
        directory.extend(&entry);
        // No comment, first disk, no attributes.
        directory.extend([0; 10]);
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
