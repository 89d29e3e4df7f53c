//! The sequence: which part plays at which frame, and what a frame shows.
//!
//! Time is counted in frames, 60 a second, and beats, 120 a minute: integers. A part's scene is a
//! pure function of its local frame, so any frame can be rendered on its own and nothing drifts.

mod blobs;
mod facets;
mod gold;
mod luc;
mod mirror;
mod paint;
#[cfg(feature = "smoke")]
mod smoke;
mod still;

use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::Scene;

/// Frames a second.
pub const FPS: u64 = 60;

/// Frames of a bar of four beats, at 120 beats a minute.
const BAR: u64 = 2 * FPS;

/// One part of the show.
pub struct Part {
    /// The name `--scene` takes, lower case.
    pub name: &'static str,
    /// Length in frames.
    pub frames: u64,
    /// The scene at a local frame, `0 <= frame < frames`.
    pub scene: fn(u64) -> Scene,
}

/// The parts in playing order.
pub const PARTS: &[Part] = &[
    Part { name: "luc", frames: 6 * BAR, scene: luc::scene },
    Part { name: "mirror", frames: 16 * BAR, scene: mirror::scene },
    Part { name: "gold", frames: 16 * BAR, scene: gold::scene },
    Part { name: "facets", frames: 12 * BAR, scene: facets::scene },
    Part { name: "blobs", frames: 10 * BAR, scene: blobs::scene },
    // Last, so that all frames before it are the same without it.
    #[cfg(feature = "smoke")]
    Part { name: "smoke", frames: 12 * BAR, scene: smoke::scene },
];

/// Length of the whole show in frames; frame n is frame n mod this.
pub const FRAMES: u64 = {
    let (mut sum, mut part) = (0, 0);
    while part < PARTS.len() {
        sum += PARTS[part].frames;
        part += 1;
    }
    sum
};

/// First frame of the part with index `part`.
pub fn start(part: usize) -> u64 {
    PARTS[..part].iter().map(|p| p.frames).sum()
}

/// The part that plays at frame `n` of the endless show, and the frame within it.
pub fn at(n: u64) -> (usize, u64) {
    let mut local = n % FRAMES;
    let mut part = 0;
    while local >= PARTS[part].frames {
        local -= PARTS[part].frames;
        part += 1;
    }
    (part, local)
}

/// The scene of frame `n`.
pub fn scene(n: u64) -> Scene {
    let (part, local) = at(n);
    (PARTS[part].scene)(local)
}

/// Renders frame `n` of the show as 0RGB rows, top to bottom, into `pixels` (`width * height`).
pub fn frame(renderer: &mut Renderer, n: u64, size: (u32, u32), quality: &Quality, pixels: &mut [u32]) {
    // Grain too follows the local frame, so that a part looks the same wherever it stands.
    let (part, local) = at(n);
    renderer.frame(&(PARTS[part].scene)(local), local, size, quality, pixels);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_fill_the_show() {
        assert_eq!(start(PARTS.len()), FRAMES);
        assert!(PARTS.iter().all(|p| p.frames > 0 && p.frames % BAR == 0), "parts are whole bars");
    }

    #[test]
    fn every_frame_lies_in_its_part() {
        for n in (0..2 * FRAMES).step_by(7).chain([u64::MAX, u64::MAX - 1]) {
            let (part, local) = at(n);
            assert!(local < PARTS[part].frames);
            assert_eq!(start(part) + local, n % FRAMES, "frame {n}");
        }
    }
}
