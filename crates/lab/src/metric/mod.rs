//! How far a picture is from the truth, by four measures that disagree in instructive ways.
//!
//! All take display values as 0RGB pixels. Linear light is what those bytes stand for by the sRGB
//! curve, from 0 to 1.

mod filter;
mod flip;
mod linear;
mod ssim;

pub use flip::flip;
pub use linear::{flicker, greatest, linear_rmse, psnr, psnr_of_rmse};
pub use ssim::ssim;

/// A finished picture: 0RGB rows from the top.
#[derive(Clone, Default)]
pub struct Picture {
    /// Width and height, px.
    pub size: (u32, u32),
    /// Its pixels.
    pub pixels: Vec<u32>,
}

impl Picture {
    /// A black picture.
    pub fn new(size: (u32, u32)) -> Self {
        Self { size, pixels: vec![0; size.0 as usize * size.1 as usize] }
    }
}

/// Red, green and blue of a pixel as display values from 0 to 1.
pub fn channels(pixel: u32) -> [f64; 3] {
    [16, 8, 0].map(|shift| f64::from(pixel >> shift & 255) / 255.0)
}

/// The sRGB curve from display values to linear light (IEC 61966-2-1).
pub fn decode(v: f64) -> f64 {
    if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// Pictures by which the measures are tested.
#[cfg(test)]
mod examples {
    use super::Picture;

    /// A picture of `f` of column and row.
    pub fn picture(size: (u32, u32), f: impl Fn(u32, u32) -> [u32; 3]) -> Picture {
        let pixel = |i: u32| {
            let [r, g, b] = f(i % size.0, i / size.0).map(|c| c.min(255));
            r << 16 | g << 8 | b
        };
        Picture { size, pixels: (0..size.0 * size.1).map(pixel).collect() }
    }

    /// Waves of all lengths, and the same with blocks, a shift in colour and single wrong pixels.
    pub fn pair() -> (Picture, Picture) {
        let wave = |x: u32, y: u32| [(x * x / 7 + 3 * y) % 256, (x * y / 5) % 256, (5 * x + y * y / 3) % 256];
        let wrong = move |x: u32, y: u32| {
            let [r, g, b] = if x < 24 { wave(x / 4 * 4, y / 4 * 4) } else { wave(x, y) };
            match (x / 24, x * 7 + y * 13) {
                (1, _) => [r, (g + 9).min(255), b / 2],
                (2, k) if k % 29 == 0 => [255 - r, 255 - g, 255 - b],
                _ => [r, g, b],
            }
        };
        (picture((96, 64), wave), picture((96, 64), wrong))
    }
}
