//! Pictures of 0RGB pixels: read from files, compared, and shown next to each other.

use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::Scene;
use std::path::Path;

/// Rows of 0RGB pixels, top to bottom.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width, px.
    pub width: u32,
    /// Height, px.
    pub height: u32,
    /// `width * height` pixels.
    pub pixels: Vec<u32>,
}

/// Red, green and blue of a pixel.
pub fn channels(pixel: u32) -> [i32; 3] {
    [16, 8, 0].map(|shift| (pixel >> shift & 255) as i32)
}

/// Largest difference of a channel of two pixels, in steps of 1/255.
pub fn distance(a: u32, b: u32) -> i32 {
    let (a, b) = (channels(a), channels(b));
    a.into_iter().zip(b).map(|(a, b)| (a - b).abs()).max().unwrap_or(0)
}

/// Peak signal-to-noise ratio of two pictures of equal size, dB; infinite if they are equal.
pub fn psnr(a: &[u32], b: &[u32]) -> f64 {
    assert_eq!(a.len(), b.len(), "pictures of equal size");
    let square = |(&a, &b): (&u32, &u32)| -> u64 {
        let (a, b) = (channels(a), channels(b));
        a.into_iter().zip(b).map(|(a, b)| u64::from(a.abs_diff(b)).pow(2)).sum()
    };
    let mse = a.iter().zip(b).map(square).sum::<u64>() as f64 / (3 * a.len()) as f64;
    #[allow(clippy::disallowed_methods, reason = "a figure to read, not a pixel")]
    let db = 10.0 * (255.0 * 255.0 / mse).log10();
    db
}

/// The pixels of a scene at frame 0 by a new renderer, and that.
pub fn draw(scene: &Scene, (width, height): (u32, u32), quality: &Quality) -> (Vec<u32>, Renderer) {
    let (mut renderer, mut pixels) = (Renderer::default(), vec![0; (width * height) as usize]);
    renderer.frame(scene, 0, (width, height), quality, &mut pixels);
    (pixels, renderer)
}

impl Picture {
    /// Reads a PNG of 8 bit RGB with an independent decoder.
    pub fn read_png(path: &Path) -> Result<Picture, String> {
        let told = |e: &dyn std::fmt::Display| format!("{}: {e}", path.display());
        let file = std::fs::File::open(path).map_err(|e| told(&e))?;
        let mut reader =
            png::Decoder::new(std::io::BufReader::new(file)).read_info().map_err(|e| told(&e))?;
        let mut bytes = vec![0; reader.output_buffer_size().ok_or("a picture too large to read")?];
        let info = reader.next_frame(&mut bytes).map_err(|e| told(&e))?;
        if (info.color_type, info.bit_depth) != (png::ColorType::Rgb, png::BitDepth::Eight) {
            return Err(told(&"not 8 bit RGB"));
        }
        Ok(Picture { width: info.width, height: info.height, pixels: packed(&bytes) })
    }

    /// Reads a binary PPM as [`luc_core::output::ppm`] writes it.
    pub fn read_ppm(file: &[u8]) -> Result<Picture, String> {
        let mut parts = file.splitn(4, |&b| b == b'\n');
        let mut line = || parts.next().and_then(|l| std::str::from_utf8(l).ok()).ok_or("a PPM cut short");
        let (kind, size, depth) = (line()?, line()?, line()?);
        let (width, height) = size.split_once(' ').ok_or("a PPM without a size")?;
        let (Ok(width), Ok(height)) = (width.parse(), height.parse()) else { return Err(size.into()) };
        let pixels = packed(parts.next().ok_or("a PPM without pixels")?);
        if (kind, depth) != ("P6", "255") || pixels.len() != width as usize * height as usize {
            return Err(format!("not a whole PPM: {kind} {size} {depth}, {} pixels", pixels.len()));
        }
        Ok(Picture { width, height, pixels })
    }

    /// What the picture and `other`, of the same size, differ in, for the message of a test:
    /// nothing if they are equal.
    pub fn compare(&self, other: &Picture) -> Option<String> {
        if (self.width, self.height) != (other.width, other.height) {
            let Picture { width, height, .. } = other;
            return Some(format!("{width}x{height} px instead of {}x{}", self.width, self.height));
        }
        let differs = |&i: &usize| self.pixels[i] != other.pixels[i];
        let first = (0..self.pixels.len()).find(differs)?;
        let count = (first..self.pixels.len()).filter(differs).count();
        Some(format!(
            "{count} of {} pixels differ, {:.2} dB; the first at ({}, {}) is {:06x} instead of {:06x}",
            self.pixels.len(),
            psnr(&self.pixels, &other.pixels),
            first % self.width as usize,
            first / self.width as usize,
            other.pixels[first],
            self.pixels[first],
        ))
    }

    /// The picture, `other` (of the same size) and their difference times eight, side by side.
    pub fn difference(&self, other: &Picture) -> Picture {
        let amplified = |(&a, &b): (&u32, &u32)| {
            let (a, b) = (channels(a), channels(b));
            let step = |i: usize| ((a[i] - b[i]).unsigned_abs() * 8).min(255);
            step(0) << 16 | step(1) << 8 | step(2)
        };
        let apart: Vec<u32> = self.pixels.iter().zip(&other.pixels).map(amplified).collect();
        let width = self.width as usize;
        let rows = (0..self.height as usize).flat_map(|y| {
            let row = y * width..(y + 1) * width;
            [&self.pixels[row.clone()], &other.pixels[row.clone()], &apart[row]].concat()
        });
        Picture { width: 3 * self.width, height: self.height, pixels: rows.collect() }
    }
}

fn packed(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(3).map(|c| u32::from_be_bytes([0, c[0], c[1], c[2]])).collect()
}
