//! The sequence: which part plays at which frame.

use luc_core::quality::Quality;
use luc_core::render::Renderer;
use rayon::prelude::*;

/// Frames a second.
pub const FPS: u64 = 60;

/// One part of the show.
pub struct Part {
    /// The name `--scene` takes, lower case.
    pub name: &'static str,
    /// Length in frames.
    pub frames: u64,
}

/// The parts in playing order.
pub const PARTS: [Part; 2] =
    [Part { name: "mirror", frames: 32 * FPS }, Part { name: "gold", frames: 32 * FPS }];

/// Length of the whole show in frames; frame n is frame n mod this.
pub const FRAMES: u64 = 64 * FPS;

/// First frame of the part with index `part`.
pub fn start(part: usize) -> u64 {
    PARTS[..part].iter().map(|p| p.frames).sum()
}

/// Renders frame `n` of the show as 0RGB rows, top to bottom, into `pixels` (`width * height`).
pub fn frame(
    _renderer: &mut Renderer,
    n: u64,
    (width, height): (u32, u32),
    _quality: &Quality,
    pixels: &mut [u32],
) {
    let n = n % FRAMES;
    pixels.par_chunks_mut(width as usize).enumerate().for_each(|(y, row)| {
        for (x, p) in row.iter_mut().enumerate() {
            let c =
                glam::Vec3::new(x as f32 / width as f32, y as f32 / height as f32, n as f32 / FRAMES as f32);
            let c = c * 255.0;
            *p = (c.x as u32) << 16 | (c.y as u32) << 8 | c.z as u32;
        }
    });
}
