//! Cost: the same moment of the cathedral drawn twice, parted by a line of light: left every pixel is
//! traced, right the frame is sampled adaptively and shows it, as a drawing.
//!
//! Under it stands what each side cost in rays, and how far the right one is off, in dB, of this very frame.

use super::facets::cathedral;
use super::paint::{angle, bumps, graded, key, polished, seconds, surface, times, v};
use super::score;
use super::still::{Lamp, Still};
use super::text::{Line, write};
use glam::Vec2;
use luc_core::math::scalar::log2;
use luc_core::math::{Vec3, whole};
use luc_core::scene::*;
use luc_core::synth::track::{Strikes, pulse, strikes};

/// Strikes of the kick, at which the line flares up.
const KICK: [Strikes; 6] = strikes(&score::SCORE, &score::COST, score::KICK);

/// Where the line is over seconds: four bars from right to left, and a third of the way back.
const X: [Key; 3] = [key(0.0, 0.9, Ease::Smooth), key(8.0, -0.4, Ease::Smooth), key(12.0, 0.04, Ease::Step)];

/// How far it leans, half widths per half height.
const SLANT: f32 = 0.056;

/// What the figures count, left and right, with the place for the error.
pub const CAPTIONS: [&[u8]; 2] = [b"RAYS TRACED", b"RAYS SAMPLED  0,0 dB"];

static STILL: Still = Still {
    stops: &[
        Stop { y: -1.0, colour: v(0.02, 0.015, 0.04) },
        Stop { y: -0.02, colour: v(0.1, 0.06, 0.16) },
        Stop { y: 0.06, colour: v(0.17, 0.07, 0.17) },
        Stop { y: 0.3, colour: v(0.07, 0.045, 0.16) },
        Stop { y: 0.7, colour: v(0.022, 0.018, 0.075) },
        Stop { y: 1.0, colour: v(0.012, 0.01, 0.05) },
    ],
    glows: &[
        Glow { direction: v(-0.14, 0.16, -1.0), colour: v(16.0, 7.5, 2.6), sharpness: 300.0 },
        Glow { direction: v(-0.14, 0.16, -1.0), colour: v(2.4, 1.0, 0.42), sharpness: 22.0 },
    ],
    planes: &[Plane { point: Vec3::ZERO, normal: Vec3::Y, reach: 90.0, material: 2 }],
    materials: &[
        surface(v(0.3, 0.27, 0.4), 0.3, 0.5),
        surface(v(0.13, 0.11, 0.19), 0.55, 0.1),
        Material { texture: bumps(0.9, 0.35, 0.04), ..polished(v(0.06, 0.05, 0.085), 0.14, 1.6) },
    ],
    lights: &[
        Lamp { position: v(-140.0, 160.0, -1000.0), colour: times(v(1.0, 0.62, 0.34), 2.9e6), spot: None },
        Lamp { position: v(2.0, 12.0, 14.0), colour: times(v(0.45, 0.38, 1.0), 50.0), spot: None },
    ],
    shading: Shading::Ggx,
    ambient: [v(0.04, 0.025, 0.06), v(0.16, 0.09, 0.22)],
    fog: Some(Fog {
        density: 0.018,
        colour: v(0.105, 0.045, 0.135),
        lo: v(-40.0, -0.1, -60.0),
        hi: v(40.0, 30.0, 5.0),
    }),
    grade: graded(Grade {
        bloom: 0.4,
        lift: v(0.014, 0.006, 0.03),
        gamma: v(0.87, 0.86, 0.9),
        gain: v(1.0, 0.985, 0.97),
        vignette: 0.16,
        grain: 0.007,
        ..Grade::DEFAULT
    }),
    ..Still::NOTHING
};

/// Right of the line; where that is follows.
const RIGHT: Place = Place { normal: Vec2::new(1.0, -SLANT), from: 0.0, over: 1e-4 };

/// The drawing: gold in place of rose, few colours, lines of light, the cells; and a dark band below.
static DRAWING: [Effect; 5] = [
    Effect { place: RIGHT, ..Effect::new(Kind::Tint { colour: v(1.9, 0.8, 0.2), strength: 0.5 }) },
    Effect { place: RIGHT, ..Effect::new(Kind::Edges { strength: 5.0, colour: v(0.3, 0.42, 0.62) }) },
    Effect { place: RIGHT, amount: 0.3, ..Effect::new(Kind::Levels(v(7.0, 7.0, 7.0))) },
    Effect { place: RIGHT, ..Effect::new(Kind::Cells { shade: 0.6, colour: v(0.07, 0.06, 0.18) }) },
    Effect {
        place: Place { normal: Vec2::NEG_Y, from: 0.32, over: 0.28 },
        ..Effect::new(Kind::Tint { colour: Vec3::ZERO, strength: 0.9 })
    },
];

/// Writes a number, digit by digit from the right; every fourth place stays as it is.
fn digits(words: &mut [u8], mut n: u64) {
    for (i, word) in words.iter_mut().rev().enumerate() {
        if i % 4 != 3 && (n > 0 || i == 0) {
            *word = b'0' + (n % 10) as u8;
            n /= 10;
        }
    }
}

/// The figures under the picture, and the line.
fn titles(figures: &Figures, beams: &mut Vec<Beam>) -> (Camera, Grade) {
    let height = figures.height;
    let split = &figures.split;
    // Half of the height, or what it would be in a less high picture of this width.
    let unit = height.min(0.5625);
    // Here the picture is two units wide.
    let z = unit / -0.5625;
    let at = |y: f32| Vec3::new(split.x + split.slant * y, height * y, z);
    for (width, colour) in [(0.0036, v(3.3, 2.4, 1.35)), (0.03, v(0.3, 0.16, 0.08))] {
        let colour = colour * split.light;
        beams.push(Beam { from: at(1.2), to: at(-1.2), width, colour, fade: 0.0 });
    }

    let ([mut left, mut right], mut sampled) = ([[b' '; 15]; 2], [b' '; 20]);
    digits(&mut left, figures.rays[0]);
    digits(&mut right, figures.rays[1]);
    // -10 log10 of the error, in tenths before and after the point; nothing is better than 99.9.
    let tenths = whole((-30.103 * log2(figures.error.max(1e-12))).clamp(0.0, 999.0)) as u64;
    sampled.copy_from_slice(CAPTIONS[1]);
    digits(&mut sampled[13..15], tenths / 10);
    digits(&mut sampled[16..17], tenths % 10);
    for (words, x, y, step, colour) in [
        (left.trim_ascii_start(), -0.9, 0.25, 0.034, v(2.4, 2.2, 2.5)),
        (CAPTIONS[0], -0.9, 0.1, 0.02, v(1.0, 0.9, 1.5)),
        (right.trim_ascii_start(), 0.07, 0.25, 0.034, v(5.0, 2.6, 0.85)),
        (&sampled, 0.07, 0.1, 0.02, v(2.1, 1.15, 0.5)),
    ] {
        let line = Line {
            words,
            origin: Vec3::new(x, unit * y - height, z),
            right: unit * step * 0.85,
            up: Vec3::new(0.0, unit * step, 0.0),
            width: unit * step * 0.24,
            colour,
        };
        write(beams, &line, Vec3::ZERO, 99.0);
    }
    // The plane one unit ahead is two units wide, if the picture isn't wider than 16:9.
    let camera = Camera { position: Vec3::ZERO, target: Vec3::NEG_Z, fov: angle(90.0), ..Camera::default() };
    (camera, Grade { bloom_threshold: 0.9, bloom: 0.5, ..Grade::DEFAULT })
}

/// The scene at a local frame.
pub fn scene(frame: u64) -> Scene {
    let t = seconds(frame);
    let x = track(&X, t);
    let mut s = STILL.scene();
    let position = Vec3::new(1.9, 2.4, 7.2 + t / 24.0);
    s.camera = Camera { position, target: v(-1.1, 4.5, -12.0), roll: angle(-2.0), fov: angle(52.0) };
    s.meshes = cathedral(20.0, 8, false);
    s.lights[1].kind = LightKind::Fill;
    s.effects = DRAWING.to_vec();
    for effect in &mut s.effects[..4] {
        effect.place.from = x;
    }
    let light = 1.0 + pulse(&KICK, frame, 6.0);
    s.split = Some(Split { x, slant: SLANT, light, titles });
    s
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_in_groups_of_three() {
        for (n, expected) in
            [(0, "0"), (7, "7"), (1000, "1 000"), (12_345_678, "12 345 678"), (100_000_000, "100 000 000")]
        {
            let mut words = [b' '; 15];
            digits(&mut words, n);
            assert_eq!(String::from_utf8_lossy(words.trim_ascii_start()), expected);
        }
    }

    /// At any shape of the picture, with as many rays as at 8K.
    #[test]
    fn no_letter_is_cut_off_or_touches_the_other_side() {
        for (w, h) in [(16.0, 9.0), (16.0, 10.0), (4.0, 3.0), (21.0, 9.0), (1.0, 1.0), (32.0, 9.0)] {
            let split = Split { x: 0.0, slant: SLANT, light: 1.0, titles };
            let height = h / w;
            for error in [0.0, 1e-5, 1.0] {
                let mut beams = vec![];
                titles(&Figures { split, height, rays: [88_888_888; 2], error }, &mut beams);
                for beam in &beams[2..] {
                    for p in [beam.from, beam.to] {
                        let reach = Beam::END * beam.width;
                        let inside = p.x.abs() + reach < 0.97 && p.y.abs() + reach < 0.99 * height;
                        assert!(inside && (p.x.abs() > reach), "{w}:{h}: {p} of a letter");
                    }
                }
            }
        }
    }
}
