//! Text without formatting: pieces are joined, numbers are read and written by hand.

use luc_core::output::decimal;
use std::ffi::OsStr;

/// What is said to the user; bytes, because arguments need not be UTF-8.
pub type Text = Vec<u8>;

/// The pieces one after another.
pub fn join(pieces: &[&[u8]]) -> Text {
    pieces.concat()
}

/// `n` in decimal.
pub fn number(n: u64) -> Text {
    let mut out = Text::new();
    decimal(&mut out, n, 1);
    out
}

/// Digits, letters and dots as part of a file's name.
pub fn ascii(text: &[u8]) -> &OsStr {
    debug_assert!(text.is_ascii());
    // SAFETY: ASCII is a valid encoding of itself on every system.
    unsafe { OsStr::from_encoded_bytes_unchecked(text) }
}

/// What the user typed, in quotes, fit for one line of a terminal: no control characters, not endless.
pub fn quoted(typed: &[u8]) -> Text {
    const LONGEST: usize = 60;
    let shown = typed.iter().take(LONGEST).map(|&b| if b < b' ' || b == 0x7f { b'?' } else { b });
    let mut out = vec![b'\''];
    out.extend(shown);
    if typed.len() > LONGEST {
        out.extend_from_slice(b"...");
    }
    out.push(b'\'');
    out
}

/// Reads digits and nothing else as a number from `least` to `most`.
pub fn whole(typed: &[u8], least: u64, most: u64) -> Option<u64> {
    if typed.is_empty() {
        return None;
    }
    let mut n = 0u64;
    for c in typed {
        let digit = c.wrapping_sub(b'0');
        if digit > 9 {
            return None;
        }
        n = n.checked_mul(10)?.checked_add(digit.into())?;
    }
    (least..=most).contains(&n).then_some(n)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_are_digits_within_bounds() {
        assert_eq!(whole(b"0", 0, u64::MAX), Some(0));
        assert_eq!(whole(b"007", 0, u64::MAX), Some(7));
        assert_eq!(whole(b"18446744073709551615", 0, u64::MAX), Some(u64::MAX));
        for bad in ["18446744073709551616", "99999999999999999999999", "", "-1", "+1", "1 ", "1.0", "x", "١"]
        {
            assert_eq!(whole(bad.as_bytes(), 0, u64::MAX), None, "{bad:?}");
        }
        assert_eq!(whole(b"0", 1, 256), None);
        assert_eq!(whole(b"256", 1, 256), Some(256));
        assert_eq!(whole(b"257", 1, 256), None);
    }

    #[test]
    fn quoted_text_is_one_short_line() {
        assert_eq!(quoted(b"a\nb\x1b[31m\x7f"), b"'a?b?[31m?'");
        assert_eq!(quoted(&[b'x'; 1000]).len(), 65);
    }
}
