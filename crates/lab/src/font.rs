//! Small capitals of five by five squares, for labels in pictures.

use crate::metric::Picture;

/// A character and its rows from the top, the leftmost square in the highest of five bits.
#[rustfmt::skip]
const GLYPHS: [(u8, [u8; 5]); 53] = [
    (b'A', [0b01110, 0b10001, 0b11111, 0b10001, 0b10001]),
    (b'B', [0b11110, 0b10001, 0b11110, 0b10001, 0b11110]),
    (b'C', [0b01111, 0b10000, 0b10000, 0b10000, 0b01111]),
    (b'D', [0b11110, 0b10001, 0b10001, 0b10001, 0b11110]),
    (b'E', [0b11111, 0b10000, 0b11110, 0b10000, 0b11111]),
    (b'F', [0b11111, 0b10000, 0b11110, 0b10000, 0b10000]),
    (b'G', [0b01111, 0b10000, 0b10011, 0b10001, 0b01111]),
    (b'H', [0b10001, 0b10001, 0b11111, 0b10001, 0b10001]),
    (b'I', [0b01110, 0b00100, 0b00100, 0b00100, 0b01110]),
    (b'J', [0b00111, 0b00010, 0b00010, 0b10010, 0b01100]),
    (b'K', [0b10010, 0b10100, 0b11000, 0b10100, 0b10010]),
    (b'L', [0b10000, 0b10000, 0b10000, 0b10000, 0b11111]),
    (b'M', [0b10001, 0b11011, 0b10101, 0b10001, 0b10001]),
    (b'N', [0b10001, 0b11001, 0b10101, 0b10011, 0b10001]),
    (b'O', [0b01110, 0b10001, 0b10001, 0b10001, 0b01110]),
    (b'P', [0b11110, 0b10001, 0b11110, 0b10000, 0b10000]),
    (b'Q', [0b01110, 0b10001, 0b10101, 0b10010, 0b01101]),
    (b'R', [0b11110, 0b10001, 0b11110, 0b10010, 0b10001]),
    (b'S', [0b01111, 0b10000, 0b01110, 0b00001, 0b11110]),
    (b'T', [0b11111, 0b00100, 0b00100, 0b00100, 0b00100]),
    (b'U', [0b10001, 0b10001, 0b10001, 0b10001, 0b01110]),
    (b'V', [0b10001, 0b10001, 0b10001, 0b01010, 0b00100]),
    (b'W', [0b10001, 0b10001, 0b10101, 0b11011, 0b10001]),
    (b'X', [0b10001, 0b01010, 0b00100, 0b01010, 0b10001]),
    (b'Y', [0b10001, 0b01010, 0b00100, 0b00100, 0b00100]),
    (b'Z', [0b11111, 0b00010, 0b00100, 0b01000, 0b11111]),
    (b'0', [0b01110, 0b10011, 0b10101, 0b11001, 0b01110]),
    (b'1', [0b00100, 0b01100, 0b00100, 0b00100, 0b01110]),
    (b'2', [0b11110, 0b00001, 0b01110, 0b10000, 0b11111]),
    (b'3', [0b11110, 0b00001, 0b01110, 0b00001, 0b11110]),
    (b'4', [0b10010, 0b10010, 0b11111, 0b00010, 0b00010]),
    (b'5', [0b11111, 0b10000, 0b11110, 0b00001, 0b11110]),
    (b'6', [0b01110, 0b10000, 0b11110, 0b10001, 0b01110]),
    (b'7', [0b11111, 0b00001, 0b00010, 0b00100, 0b00100]),
    (b'8', [0b01110, 0b10001, 0b01110, 0b10001, 0b01110]),
    (b'9', [0b01110, 0b10001, 0b01111, 0b00001, 0b01110]),
    (b'.', [0b00000, 0b00000, 0b00000, 0b00000, 0b00100]),
    (b',', [0b00000, 0b00000, 0b00000, 0b00100, 0b01000]),
    (b':', [0b00000, 0b00100, 0b00000, 0b00100, 0b00000]),
    (b'-', [0b00000, 0b00000, 0b01110, 0b00000, 0b00000]),
    (b'+', [0b00000, 0b00100, 0b01110, 0b00100, 0b00000]),
    (b'/', [0b00001, 0b00010, 0b00100, 0b01000, 0b10000]),
    (b'%', [0b11001, 0b11010, 0b00100, 0b01011, 0b10011]),
    (b'(', [0b00010, 0b00100, 0b00100, 0b00100, 0b00010]),
    (b')', [0b01000, 0b00100, 0b00100, 0b00100, 0b01000]),
    (b'[', [0b00110, 0b00100, 0b00100, 0b00100, 0b00110]),
    (b']', [0b01100, 0b00100, 0b00100, 0b00100, 0b01100]),
    (b'=', [0b00000, 0b01110, 0b00000, 0b01110, 0b00000]),
    (b'*', [0b00000, 0b10101, 0b01110, 0b10101, 0b00000]),
    (b'<', [0b00010, 0b00100, 0b01000, 0b00100, 0b00010]),
    (b'>', [0b01000, 0b00100, 0b00010, 0b00100, 0b01000]),
    (b'_', [0b00000, 0b00000, 0b00000, 0b00000, 0b11111]),
    (b'|', [0b00100, 0b00100, 0b00100, 0b00100, 0b00100]),
];

/// Squares from one character, and one line, to the next.
const ADVANCE: (usize, usize) = (6, 8);

/// Paper under text, and how much of the picture it leaves, of 256.
const PAPER: u32 = 0x0a_0a12;
const LEAVES: u32 = 90;

/// Width and height of lines of text with its paper, px, in squares of `scale` px.
pub fn size(text: &str, scale: usize) -> (usize, usize) {
    let longest = text.lines().map(|line| line.chars().count()).max().unwrap_or(0);
    ((longest * ADVANCE.0 + 3) * scale, (text.lines().count() * ADVANCE.1 + 1) * scale)
}

/// Writes lines of text on dark paper, its upper left corner at (x, y). Capitals stand for all letters;
/// what has no glyph is left blank, what lies outside is cut off.
pub fn write(out: &mut Picture, (x, y): (usize, usize), text: &str, scale: usize, colour: u32) {
    let (width, height) = (out.size.0 as usize, out.size.1 as usize);
    let (w, h) = size(text, scale);
    for row in y..(y + h).min(height) {
        for pixel in &mut out.pixels[row * width..][x.min(width)..(x + w).min(width)] {
            let mix = |shift: u32| {
                let (under, paper) = (*pixel >> shift & 255, PAPER >> shift & 255);
                ((under * LEAVES + paper * (256 - LEAVES)) >> 8) << shift
            };
            *pixel = mix(16) | mix(8) | mix(0);
        }
    }
    for (line, text) in text.lines().enumerate() {
        for (column, c) in text.chars().enumerate() {
            let c = c.to_ascii_uppercase();
            let Some((_, glyph)) = GLYPHS.iter().find(|g| char::from(g.0) == c) else { continue };
            let left = x + (2 + column * ADVANCE.0) * scale;
            let top = y + (2 + line * ADVANCE.1) * scale;
            for i in 0..25 * scale * scale {
                let (px, py) = (i % (5 * scale), i / (5 * scale));
                let (px_out, py_out) = (left + px, top + py);
                if glyph[py / scale] >> (4 - px / scale) & 1 == 1 && px_out < width && py_out < height {
                    out.pixels[py_out * width + px_out] = colour;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glyphs_differ_and_have_five_columns() {
        for (i, (c, rows)) in GLYPHS.iter().enumerate() {
            assert!(rows.iter().all(|row| *row < 32), "{}", char::from(*c));
            let other = GLYPHS[..i].iter().find(|g| g.1 == *rows || g.0 == *c);
            assert!(other.is_none(), "{} twice", char::from(*c));
        }
    }

    #[test]
    fn text_stays_within_its_paper_and_the_picture() {
        let mut out = Picture { size: (40, 50), pixels: vec![0xff_ffff; 2000] };
        write(&mut out, (3, 4), "ab\n1", 2, 0xff_0000);
        let (w, h) = size("ab\n1", 2);
        for (i, &pixel) in out.pixels.iter().enumerate() {
            let (x, y) = (i % 40, i / 40);
            let inside = (3..3 + w).contains(&x) && (4..4 + h).contains(&y);
            assert_eq!(pixel != 0xff_ffff, inside, "({x}, {y})");
        }
        assert!(out.pixels.contains(&0xff_0000));
        write(&mut out, (30, 20), "cut off here\nand below", 3, 0xff_0000);
        write(&mut out, (300, 200), "outside", 1, 0xff_0000);
    }
}
