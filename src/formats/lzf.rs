//! LZF (Marc Lehmann, 2000): the compression of PCD files. The crate for it, `lzf`, is deprecated.

/// Unpacks `input`; the byte at which it breaks the rules, or has more than `size` bytes.
///
/// A control byte below 32 is followed by one more byte than it says, to be copied. Any other begins a reference: its upper
/// three bits are the length less 2 (7: a byte to add follows), the lower five and the next byte the distance less 1.
pub(super) fn unpack(input: &[u8], size: usize) -> Result<Vec<u8>, usize> {
    let mut out: Vec<u8> = Vec::new();
    let mut at = 0;
    while let Some(&control) = input.get(at) {
        let start = at;
        at += 1;
        if control < 32 {
            let end = at + usize::from(control) + 1;
            out.extend_from_slice(input.get(at..end).ok_or(start)?);
            at = end;
        } else {
            let mut next = || {
                at += 1;
                input.get(at - 1).copied().map(usize::from).ok_or(start)
            };
            let mut length = usize::from(control >> 5) + 2;
            if length == 9 {
                length += next()?;
            }
            let distance = (usize::from(control & 31) << 8) + next()? + 1;
            let from = out.len().checked_sub(distance).ok_or(start)?;
            // Byte by byte: what is copied may be what this very reference has written.
            for i in from..from + length {
                out.push(out[i]);
            }
        }
        if out.len() > size {
            return Err(start);
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn literals_and_references() {
        assert_eq!(unpack(&[], 0), Ok(vec![]));
        assert_eq!(unpack(&[2, b'a', b'b', b'c'], 3), Ok(b"abc".to_vec()));
        // Four bytes from two back, which overlap themselves.
        assert_eq!(
            unpack(&[1, b'a', b'b', 0b010_00000, 1], 6),
            Ok(b"ababab".to_vec())
        );
        // A length of 9 and 3 more.
        assert_eq!(
            unpack(&[0, b'x', 0b111_00000, 3, 0], 13),
            Ok(vec![b'x'; 13])
        );
    }

    #[test]
    fn what_breaks_the_rules_is_placed() {
        assert_eq!(unpack(&[5, b'a'], 10), Err(0));
        assert_eq!(unpack(&[0, b'a', 0b010_00000, 1], 10), Err(2));
        assert_eq!(unpack(&[0, b'a', 0b010_00000], 10), Err(2));
        assert_eq!(unpack(&[0, b'a', 0b111_00000, 255, 0], 10), Err(2));
    }
}
