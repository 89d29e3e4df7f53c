//! The PNG container: signature, header, one data chunk, end; 8 bit RGB, every row predicted from above.
//!
//! "Up" is the only predictor: vertical change is small in rendered pictures, and one predictor needs
//! no choice. The format is RFC 2083.

use super::deflate::zlib;
use crate::features;

/// The check value of a chunk. The table is built when called, because as data it would not pack.
fn crc32(data: &[u8]) -> u32 {
    let mut table = [0u32; 256];
    for (i, entry) in table.iter_mut().enumerate() {
        *entry = (0..8).fold(i as u32, |c, _| c >> 1 ^ (0xedb8_8320 & (c & 1).wrapping_neg()));
    }
    !data.iter().fold(!0, |c, &byte| c >> 8 ^ table[usize::from(c as u8 ^ byte)])
}

fn chunk(out: &mut Vec<u8>, name: &[u8; 4], data: &[u8]) {
    out.extend_from_slice(&(data.len() as u32).to_be_bytes());
    let start = out.len();
    out.extend_from_slice(name);
    out.extend_from_slice(data);
    let crc = crc32(&out[start..]);
    out.extend_from_slice(&crc.to_be_bytes());
}

/// A PNG of `pixels`, which holds `width * height` values 0RGB, neither of the sides 0.
pub fn png(width: u32, height: u32, pixels: &[u32]) -> Vec<u8> {
    write(width, height, pixels, features::DEFLATE)
}

fn write(width: u32, height: u32, pixels: &[u32], coded: bool) -> Vec<u8> {
    assert_eq!(pixels.len(), width as usize * height as usize, "one value a pixel");
    let row = width as usize;
    let mut rows = Vec::with_capacity((1 + 3 * row) * height as usize);
    for (i, &p) in pixels.iter().enumerate() {
        if i % row == 0 {
            rows.push(2); // each row names its predictor: 2 is Up
        }
        let above = if i < row { 0 } else { pixels[i - row] };
        for shift in [16, 8, 0] {
            rows.push(((p >> shift) as u8).wrapping_sub((above >> shift) as u8));
        }
    }
    let mut header = [0; 13];
    header[..4].copy_from_slice(&width.to_be_bytes());
    header[4..8].copy_from_slice(&height.to_be_bytes());
    header[8..10].copy_from_slice(&[8, 2]); // bits a channel, RGB
    let mut out = b"\x89PNG\r\n\x1a\n".to_vec();
    chunk(&mut out, b"IHDR", &header);
    chunk(&mut out, b"IDAT", &zlib(&rows, coded));
    chunk(&mut out, b"IEND", b"");
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Decodes with an independent reader and gives back 0RGB.
    fn decode(file: &[u8]) -> (u32, u32, Vec<u32>) {
        let mut reader = ::png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        assert_eq!((info.color_type, info.bit_depth), (::png::ColorType::Rgb, ::png::BitDepth::Eight));
        let pixels = bytes.chunks(3).map(|c| u32::from_be_bytes([0, c[0], c[1], c[2]])).collect();
        (info.width, info.height, pixels)
    }

    fn comes_back(width: u32, height: u32, pixels: &[u32]) {
        for coded in [true, false] {
            let decoded = decode(&write(width, height, pixels, coded));
            assert!(decoded == (width, height, pixels.to_vec()), "{width}x{height}, coded: {coded}");
        }
    }

    fn hash(n: u32) -> u32 {
        let n = (n ^ n >> 16).wrapping_mul(0x7feb_352d);
        let n = (n ^ n >> 15).wrapping_mul(0x846c_a68b);
        n ^ n >> 16
    }

    #[test]
    fn crc32_matches_the_published_value() {
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
    }

    #[test]
    fn awkward_sizes_come_back_exactly() {
        for (width, height) in [(1, 1), (1, 300), (300, 1), (7, 5), (1919, 3), (257, 129)] {
            let noise: Vec<u32> = (0..width * height).map(|i| hash(i) & 0xff_ffff).collect();
            comes_back(width, height, &noise);
            comes_back(width, height, &vec![0xff_8001; (width * height) as usize]);
        }
    }

    #[test]
    fn a_dithered_gradient_comes_back_and_is_at_least_halved() {
        let (width, height) = (640, 360);
        let pixels: Vec<u32> = (0..width * height)
            .map(|i| {
                let level = (256 * (i % width + i / width) + hash(i) % 1024) / 1024;
                level << 16 | level << 8 | level
            })
            .collect();
        comes_back(width, height, &pixels);
        let bytes = write(width, height, &pixels, true).len() as u32;
        assert!(2 * bytes < 3 * width * height, "{bytes} bytes");
    }

    #[test]
    fn repeats_at_every_distance_and_length_come_back() {
        // Blocks of noise repeated after growing gaps reach each length and distance code.
        let width = 4096;
        let pixels: Vec<u32> = (0..width * 16)
            .map(|i| {
                let block = i / 97;
                hash(i % 97 + 1000 * (block % (1 + block / 13 % 29))) & 0xff_ffff
            })
            .collect();
        comes_back(width, 16, &pixels);
    }

    proptest! {
        #[test]
        fn any_small_picture_comes_back(
            width in 1u32..20,
            colours in prop::collection::vec(0u32..0x100_0000, 1..5),
            picks in prop::collection::vec(any::<prop::sample::Index>(), 400),
        ) {
            let height = 400 / width;
            let pixels: Vec<u32> =
                picks.iter().take((width * height) as usize).map(|i| *i.get(&colours)).collect();
            comes_back(width, height, &pixels);
        }
    }
}
