//! The sequence: which part plays at which frame, and what a frame shows.
//!
//! Time is counted in frames, 60 a second, and beats, 120 a minute: integers. A part's scene is a
//! pure function of its local frame, so any frame can be rendered on its own and nothing drifts.

mod blobs;
#[cfg(feature = "cost")]
mod cost;
mod end;
mod facets;
mod gold;
mod luc;
mod mirror;
mod paint;
pub mod score;
#[cfg(feature = "smoke")]
mod smoke;
mod still;
#[cfg(feature = "swarm")]
mod swarm;
mod text;

use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::Scene;
use luc_core::synth::score::Section;
#[cfg(feature = "sound")]
use luc_core::synth::stream::Tune;

/// Frames a second.
pub const FPS: u64 = 60;

/// Frames of a bar of four beats, at 120 beats a minute.
pub const BAR: u64 = 2 * FPS;

/// One part of the show.
pub struct Part {
    /// The name `--scene` takes, lower case.
    pub name: &'static str,
    /// Length in frames.
    pub frames: u64,
    /// The scene at a local frame, `0 <= frame < frames`.
    pub scene: fn(u64) -> Scene,
    /// What is heard.
    #[cfg(feature = "sound")]
    pub section: &'static Section,
}

/// A part that is as long as its section of the tune.
const fn part(name: &'static str, section: &'static Section, scene: fn(u64) -> Scene) -> Part {
    Part {
        name,
        frames: section.harmony.len() as u64 * BAR,
        scene,
        #[cfg(feature = "sound")]
        section,
    }
}

/// The parts in playing order.
pub const PARTS: &[Part] = &[
    part("luc", &score::LUC, luc::scene),
    part("mirror", &score::MIRROR, mirror::scene),
    part("gold", &score::GOLD, gold::scene),
    part("facets", &score::FACETS, facets::scene),
    part("blobs", &score::BLOBS, blobs::scene),
    #[cfg(feature = "smoke")]
    part("smoke", &score::SMOKE, smoke::scene),
    #[cfg(feature = "swarm")]
    part("swarm", &score::SWARM, swarm::scene),
    #[cfg(feature = "cost")]
    part("cost", &score::COST, cost::scene),
    part("end", &score::END, end::scene),
];

/// Parts that are here by a feature of their own, with their names.
pub const OPTIONAL: &[&str] = &["smoke", "swarm", "cost"];

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

/// Samples of a frame.
#[cfg(feature = "sound")]
pub const SAMPLES: u64 = luc_core::synth::RATE as u64 / FPS;

/// What is heard while some of the parts play in a loop; frame n begins at sample n times [`SAMPLES`].
#[cfg(feature = "sound")]
pub fn tune(parts: core::ops::Range<usize>) -> Tune {
    Tune { score: &score::SCORE, sections: &SECTIONS[parts] }
}

#[cfg(feature = "sound")]
static SECTIONS: [&Section; PARTS.len()] = {
    let mut sections = [PARTS[0].section; PARTS.len()];
    let mut part = 0;
    while part < PARTS.len() {
        sections[part] = PARTS[part].section;
        part += 1;
    }
    sections
};

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
