//! Finished frames as picture files, in memory: PNG for people, PPM for pipes.
//!
//! Both take what the renderer makes, 0RGB rows from top to bottom, and hold exactly these bytes. The
//! compressor is our own because the intro has no room for a library: one block, fixed codes, and a
//! predictor that turns smooth shading into small repeating numbers.

mod deflate;
mod png;

pub use self::png::png;

/// Appends `n` in decimal, padded with zeros to `digits`; the standard library's formatting is too large.
pub fn decimal(out: &mut Vec<u8>, mut n: u64, digits: usize) {
    let start = out.len();
    while n > 0 || out.len() < start + digits.max(1) {
        out.push(b'0' + (n % 10) as u8);
        n /= 10;
    }
    out[start..].reverse();
}

/// A binary PPM (P6, 8 bit) of `pixels`, which holds `width * height` values 0RGB.
pub fn ppm(width: u32, height: u32, pixels: &[u32]) -> Vec<u8> {
    assert_eq!(pixels.len(), width as usize * height as usize, "one value a pixel");
    let mut out = Vec::with_capacity(24 + 3 * pixels.len());
    out.extend_from_slice(b"P6\n");
    decimal(&mut out, width.into(), 1);
    out.push(b' ');
    decimal(&mut out, height.into(), 1);
    out.extend_from_slice(b"\n255\n");
    for p in pixels {
        out.extend_from_slice(&p.to_be_bytes()[1..]);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(n: u64, digits: usize) -> String {
        let mut out = vec![b'>'];
        decimal(&mut out, n, digits);
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn decimal_appends_at_least_the_asked_digits() {
        assert_eq!(text(0, 0), ">0");
        assert_eq!(text(0, 6), ">000000");
        assert_eq!(text(1234, 6), ">001234");
        assert_eq!(text(1234567, 6), ">1234567");
        assert_eq!(text(u64::MAX, 6), ">18446744073709551615");
    }

    #[test]
    fn ppm_is_header_then_rgb_bytes() {
        assert_eq!(ppm(2, 1, &[0x0001_0203, 0xffff_0a0d]), b"P6\n2 1\n255\n\x01\x02\x03\xff\x0a\x0d");
    }
}
