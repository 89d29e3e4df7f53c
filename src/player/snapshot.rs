//! One frame as a file: no window, no clock, the same bytes on every machine.

use super::args::Options;
use super::text::{Text, join};
use luc::show;
use luc_core::output::{decimal, png, ppm};
use luc_core::quality::Quality;
use luc_core::render::{Renderer, View};
use std::mem::ManuallyDrop;

/// The name of a picture whose name is not given.
pub fn name(options: &Options) -> Text {
    let mut name = Text::from(*b"frame-");
    decimal(&mut name, options.frame.unwrap_or(0), 6);
    name.extend_from_slice(b".png");
    name
}

/// Renders the frame that the options name, as a file.
pub fn bytes(options: &Options) -> Result<Vec<u8>, Text> {
    let n = options.frame.unwrap_or(0);
    let (width, height) = options.size;
    let count = width as usize * height as usize;
    let mut pixels = Vec::new();
    if pixels.try_reserve_exact(count).is_err() {
        return Err(join(&[b"not enough memory for a picture of this --size"]));
    }
    pixels.resize(count, 0);
    let n = match options.scene {
        Some(part) => show::start(part) + n % show::PARTS[part].frames,
        None => n,
    };
    let (_, preset) = Quality::PRESETS[options.quality.unwrap_or(Quality::DEFAULT)];
    let quality = &Quality { average: options.average, ..preset };
    match options.view {
        Some(view) if cfg!(not(luc_size)) => {
            View::ALL[view].1.draw(&show::scene(n), show::at(n).1, options.size, quality, &mut pixels);
        }
        // The program ends with it: nothing is freed.
        _ => show::frame(&mut ManuallyDrop::new(Renderer::default()), n, options.size, quality, &mut pixels),
    }

    let is_png = options.output.is_none_or(|name| name.as_encoded_bytes().ends_with(b".png"));
    Ok(if is_png { png(width, height, &pixels) } else { ppm(width, height, &pixels) })
}
