//! PNG files, packed as small as the library can.

use crate::metric::Picture;
use png::{BitDepth, ColorType, Compression, Encoder, Filter};
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// Colours from nothing to much: the ends and eighths of matplotlib's magma.
const MAGMA: [[u8; 3]; 9] = [
    [0, 0, 4],
    [28, 16, 68],
    [79, 18, 123],
    [129, 37, 129],
    [181, 54, 122],
    [229, 80, 100],
    [251, 135, 97],
    [254, 194, 135],
    [252, 253, 191],
];

/// Steps of a map's colours: few, so that the file is small.
const STEPS: usize = 48;

fn write(path: &Path, size: (u32, u32), palette: Option<Vec<u8>>, bytes: &[u8]) -> Result<(), String> {
    let fault = |e: &dyn std::fmt::Display| format!("{}: {e}", path.display());
    let file = File::create(path).map_err(|e| fault(&e))?;
    let mut encoder = Encoder::new(BufWriter::new(file), size.0, size.1);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::High);
    match palette {
        Some(palette) => {
            encoder.set_color(ColorType::Indexed);
            encoder.set_palette(palette);
            encoder.set_filter(Filter::NoFilter);
        }
        None => {
            encoder.set_color(ColorType::Rgb);
            encoder.set_filter(Filter::Adaptive);
        }
    }
    let mut writer = encoder.write_header().map_err(|e| fault(&e))?;
    writer.write_image_data(bytes).map_err(|e| fault(&e))?;
    writer.finish().map_err(|e| fault(&e))
}

/// Writes a picture.
pub fn picture(path: &Path, picture: &Picture) -> Result<(), String> {
    let bytes: Vec<u8> = picture.pixels.iter().flat_map(|p| p.to_be_bytes().into_iter().skip(1)).collect();
    write(path, picture.size, None, &bytes)
}

/// Writes numbers from 0 to 1 as a map of colours.
pub fn map(path: &Path, size: (u32, u32), values: &[f64]) -> Result<(), String> {
    let colour = |i: usize| {
        let at = i as f64 / (STEPS - 1) as f64 * (MAGMA.len() - 1) as f64;
        let (low, x) = (at as usize, at.fract());
        let high = MAGMA[(low + 1).min(MAGMA.len() - 1)];
        std::array::from_fn::<u8, 3, _>(|k| {
            (f64::from(MAGMA[low][k]) * (1.0 - x) + f64::from(high[k]) * x + 0.5) as u8
        })
    };
    let palette = (0..STEPS).flat_map(colour).collect();
    let index = |v: &f64| (v.clamp(0.0, 1.0) * (STEPS - 1) as f64 + 0.5) as u8;
    write(path, size, Some(palette), &values.iter().map(index).collect::<Vec<u8>>())
}
