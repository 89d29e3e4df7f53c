//! YUV4MPEG2 with full resolution of colour: a line of text, then for each frame a short line and three
//! planes.
//!
//! Y' = 0.2126 R' + 0.7152 G' + 0.0722 B' (BT.709), Cb = (B' - Y') / 1.8556, Cr = (R' - Y') / 1.5748,
//! in the narrow range 16..235 and 16..240, rounded, in whole numbers of 2^-16.

/// Line before each frame.
const FRAME: &[u8] = b"FRAME\n";

/// The file's first line. `note` tells what is captured and must hold no spaces.
pub fn header((width, height): (u32, u32), fps: u64, note: &str) -> Vec<u8> {
    assert!(!note.contains(char::is_whitespace), "notes have no spaces");
    format!("YUV4MPEG2 W{width} H{height} F{fps}:1 Ip A1:1 C444 XCOLORRANGE=LIMITED XLUC={note}\n")
        .into_bytes()
}

/// Bytes of a frame.
pub fn frame_bytes((width, height): (u32, u32)) -> u64 {
    FRAME.len() as u64 + 3 * u64::from(width) * u64::from(height)
}

/// Coefficients of red, green and blue in 2^-16, and the offset.
const ROWS: [([i32; 3], i32); 3] =
    [([11_966, 40_254, 4_064], 16), ([-6_596, -22_188, 28_784], 128), ([28_784, -26_145, -2_639], 128)];

/// Appends a frame of 0RGB pixels to `out`.
pub fn frame(pixels: &[u32], out: &mut Vec<u8>) {
    out.extend_from_slice(FRAME);
    for ([r, g, b], offset) in ROWS {
        let value = |&p: &u32| {
            let [red, green, blue] = [16, 8, 0].map(|shift| (p >> shift & 255) as i32);
            (((r * red + g * green + b * blue + (1 << 15)) >> 16) + offset) as u8
        };
        out.extend(pixels.iter().map(value));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ycc(pixel: u32) -> [u8; 3] {
        let mut out = Vec::new();
        frame(&[pixel], &mut out);
        assert_eq!(out.len() as u64, frame_bytes((1, 1)));
        assert_eq!(&out[..6], FRAME);
        out[6..].try_into().unwrap()
    }

    #[test]
    fn primaries_have_the_values_of_the_standard() {
        for (pixel, expected) in [
            (0x00_0000, [16, 128, 128]),
            (0xff_ffff, [235, 128, 128]),
            (0xff_0000, [63, 102, 240]),
            (0x00_ff00, [173, 42, 26]),
            (0x00_00ff, [32, 240, 118]),
        ] {
            assert_eq!(ycc(pixel), expected, "{pixel:06x}");
        }
    }

    #[test]
    fn greys_have_no_colour_and_all_values_are_in_range() {
        for v in 0..256 {
            let [y, cb, cr] = ycc(v << 16 | v << 8 | v);
            assert!((16..=235).contains(&y) && cb == 128 && cr == 128, "{v}");
        }
        for p in (0..1 << 24).step_by(4099) {
            let [y, cb, cr] = ycc(p);
            assert!((16..=235).contains(&y) && (16..=240).contains(&cb) && (16..=240).contains(&cr));
        }
    }

    #[test]
    fn within_half_a_step_of_the_formula() {
        for p in (0..1 << 24).step_by(7919) {
            let [r, g, b] = [16, 8, 0].map(|s| f64::from(p >> s & 255) / 255.0);
            let y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            let exact =
                [16.0 + 219.0 * y, 128.0 + 224.0 * (b - y) / 1.8556, 128.0 + 224.0 * (r - y) / 1.5748];
            for (value, exact) in ycc(p).into_iter().zip(exact) {
                assert!((f64::from(value) - exact).abs() < 0.502, "{p:06x}: {value}, not {exact}");
            }
        }
    }

    #[test]
    fn the_header_is_one_line() {
        let line = String::from_utf8(header((640, 360), 60, "high,0-100")).unwrap();
        assert_eq!(line, "YUV4MPEG2 W640 H360 F60:1 Ip A1:1 C444 XCOLORRANGE=LIMITED XLUC=high,0-100\n");
    }
}
