//! Lúč: a cold beam crosses the black and sets three letters on fire, one after another.

use super::paint::{angle, graded, key, metal, polished, seconds, swing, times, v};
use super::score;
use super::still::{Lamp, Panel, Still};
use super::text::{Line, write};
use luc_core::math::{Mat3, Vec3};
use luc_core::scene::*;
use luc_core::synth::track::{Strikes, frame_of, pulse, strikes};

/// Share of the way to the full fire, over seconds since the beam came: a spark on the beat, 0.7 s, and
/// 10 % too far.
const SPREAD: [Key; 4] = [
    key(-1.0, 0.0, Ease::Step),
    key(0.0, 0.16, Ease::Smooth),
    key(0.7, 1.1, Ease::Smooth),
    key(1.5, 1.0, Ease::Step),
];

/// How far the beam has come before the first letter, x over seconds: faster and faster.
const HEAD: [Key; 2] = [key(0.0, -4.75, Ease::Ramp), key(CATCH[0], -3.46, Ease::Step)];

/// Light of the night over seconds.
const NIGHT: [Key; 2] = [key(0.0, 0.2, Ease::Smooth), key(1.0, 1.0, Ease::Step)];

/// Share of the camera's way over seconds.
const DOLLY: [Key; 2] = [key(0.0, 0.0, Ease::Smooth), key(12.0, 1.0, Ease::Step)];

/// Strikes of the bell, which has a note for each letter.
const BELL: [Strikes; 6] = strikes(&score::SCORE, &score::LUC, score::BELL);

/// Seconds at which the letters catch fire: with the first three notes of the motif, in the third bar.
const CATCH: [f32; 3] =
    [seconds(frame_of(&BELL, 2, 0)), seconds(frame_of(&BELL, 2, 1)), seconds(frame_of(&BELL, 2, 2))];

/// Colours of the fire over the distance from where the beam came in.
const FIRE: &[Stop] = &[
    Stop { y: 0.0, colour: v(1.0, 0.86, 0.62) },
    Stop { y: 0.13, colour: v(1.0, 0.58, 0.2) },
    Stop { y: 0.38, colour: v(0.5, 0.14, 0.02) },
    Stop { y: 0.72, colour: v(0.1, 0.015, 0.002) },
    Stop { y: 1.0, colour: Vec3::ZERO },
];

/// Letters of the line that have appeared, over seconds.
const SHOWN: [Key; 2] = [key(8.0, 0.0, Ease::Linear), key(9.6, 28.0, Ease::Step)];

/// The line of text before the letters.
pub const LINE: Line<'static> = Line {
    words: b"64 KB . EVERY RAY ON THE CPU",
    origin: v(-2.85, 0.08, 4.7),
    right: 0.036,
    up: v(0.0, 0.043, 0.0),
    width: 0.012,
    colour: times(v(0.55, 0.78, 1.0), 0.85),
};

/// Where the beam passes at an x.
pub const fn at(x: f32) -> Vec3 {
    let share = (x + 14.0) / 19.2;
    Vec3::new(x, 3.26 - 2.01 * share, 1.83 - 2.18 * share)
}

/// A stroke of letter k: middle and half sides.
const fn stroke(k: usize, x: f32, y: f32, half: Vec3) -> Node {
    Node { material: k, ..Node::cuboid(Vec3::new(x, y, 0.0), half, 0.12).joined(Join::Union, 0.03) }
}

const fn upright(k: usize, x: f32, y: f32, half: f32) -> Node {
    stroke(k, x, y, Vec3::new(0.26, half, 0.34))
}

const fn level(k: usize, x: f32, y: f32, half: f32) -> Node {
    stroke(k, x, y, Vec3::new(half, 0.26, 0.34))
}

/// An accent, by the sine and cosine of its turn about z.
const fn accent(k: usize, x: f32, y: f32, sin: f32, cos: f32) -> Node {
    let axes = Mat3::from_cols(Vec3::new(cos, sin, 0.0), Vec3::new(-sin, cos, 0.0), Vec3::Z);
    Node { axes: Some(axes), ..stroke(k, x, y, v(0.16, 0.42, 0.26)) }
}

static LETTERS: [&[Node]; 3] = [
    &[upright(0, -3.2, 1.2, 1.2), level(0, -2.5, 0.26, 0.96)],
    &[
        upright(1, -0.78, 1.3, 1.1),
        upright(1, 0.78, 1.3, 1.1),
        level(1, 0.0, 0.26, 1.04),
        accent(1, 0.12, 2.98, -0.53, 0.848),
    ],
    &[
        upright(2, 2.3, 1.2, 1.2),
        level(2, 3.0, 0.26, 0.96),
        level(2, 3.0, 2.14, 0.96),
        accent(2, 2.78, 3.0, 0.643, 0.766),
        accent(2, 3.24, 3.0, -0.643, 0.766),
    ],
];

/// A letter that burns from where the beam meets it.
const fn letter(x: f32, radius: f32, strength: f32) -> Material {
    Material {
        fire: Some(Fire { centre: at(x), radius, strength, stops: FIRE }),
        specular: Vec3::ONE,
        ..metal(v(0.1, 0.14, 0.2), 0.34)
    }
}

/// A stretch of the beam, lit with the letter k.
const fn shaft(from: f32, to: f32, width: f32, colour: Vec3) -> Beam {
    Beam { from: at(from), to: at(to), width, colour, fade: 0.0 }
}

/// Beams and glows, each with the letter that it is lit with.
static BEAMS: [(usize, Beam); 8] = [
    (3, shaft(-14.0, -3.46, 0.035, times(v(0.62, 0.84, 1.0), 5.0))),
    (3, shaft(-14.0, -3.46, 0.26, times(v(0.3, 0.55, 1.0), 0.1))),
    (1, shaft(-2.94, -1.04, 0.03, times(v(1.0, 0.84, 0.58), 2.6))),
    (1, shaft(-0.52, 0.52, 0.028, times(v(1.0, 0.74, 0.4), 1.6))),
    (2, shaft(1.04, 2.04, 0.026, times(v(1.0, 0.66, 0.3), 1.3))),
    (0, shaft(-3.46, -3.46, 0.1, times(v(1.0, 0.8, 0.52), 2.2))),
    (1, shaft(-1.04, -1.04, 0.1, times(v(1.0, 0.8, 0.52), 1.2))),
    (2, shaft(2.04, 2.04, 0.1, times(v(1.0, 0.8, 0.52), 0.9))),
];

static STILL: Still = Still {
    stops: &[
        Stop { y: -1.0, colour: v(0.001, 0.002, 0.004) },
        Stop { y: 0.0, colour: v(0.007, 0.019, 0.05) },
        Stop { y: 0.12, colour: v(0.003, 0.008, 0.022) },
        Stop { y: 1.0, colour: v(0.001, 0.001, 0.003) },
    ],
    planes: &[Plane { point: Vec3::ZERO, normal: Vec3::Y, reach: 60.0, material: 3 }],
    materials: &[
        letter(-3.46, 3.4, 2.6),
        letter(-1.04, 2.5, 2.0),
        letter(2.04, 1.35, 1.7),
        // Wet: it shows nothing but what it mirrors.
        Material {
            diffuse: 0.0,
            texture: Texture { scale: 1.3, bump: 0.012, ..Texture::NONE },
            ..polished(Vec3::ZERO, 0.12, 1.5)
        },
    ],
    lights: &[
        Lamp { position: v(-3.65, 2.16, 1.14), colour: times(v(1.0, 0.8, 0.5), 0.76), spot: None },
        Lamp { position: v(-1.25, 1.91, 0.86), colour: times(v(1.0, 0.62, 0.28), 0.41), spot: None },
        Lamp { position: v(1.8, 1.59, 0.52), colour: times(v(1.0, 0.55, 0.2), 0.25), spot: None },
    ],
    panels: &[
        Panel {
            centre: v(7.0, 7.5, -8.0),
            target: v(1.5, 1.2, 0.0),
            size: [2.0, 5.0],
            radiance: times(v(0.3, 0.52, 1.0), 28.65),
        },
        Panel {
            centre: v(-9.0, 7.0, -6.0),
            target: v(-1.0, 1.0, 0.0),
            size: [2.0, 6.0],
            radiance: times(v(0.25, 0.5, 1.0), 9.28),
        },
        Panel {
            centre: v(-4.0, 5.0, 10.0),
            target: v(0.0, 1.0, 0.0),
            size: [5.0, 3.0],
            radiance: times(v(0.35, 0.55, 1.0), 0.85),
        },
    ],
    shading: Shading::CookTorrance,
    ambient: [v(0.001, 0.002, 0.005), v(0.003, 0.008, 0.02)],
    fog: Some(Fog {
        density: 0.012,
        colour: v(0.012, 0.03, 0.075),
        lo: v(-40.0, -0.1, -60.0),
        hi: v(40.0, 14.0, 3.0),
    }),
    grade: graded(Grade {
        bloom: 0.55,
        lift: v(0.004, 0.008, 0.02),
        gamma: v(1.0, 1.0, 1.04),
        vignette: 0.2,
        grain: 0.007,
        ..Grade::DEFAULT
    }),
    ..Still::NOTHING
};

/// The scene at a local frame.
pub fn scene(frame: u64) -> Scene {
    let t = seconds(frame);
    let flicker =
        1.0 + 0.02 * swing(t, 0.13, 0.0) + 0.01 * swing(t, 0.047, 0.3) + 0.25 * pulse(&BELL, frame, 5.0);
    let night = track(&NIGHT, t);
    let mut scene = STILL.scene();

    for stop in &mut scene.background.stops {
        stop.colour *= night;
    }
    for emitter in &mut scene.emitters {
        emitter.radiance *= night;
    }
    if let Some(fog) = &mut scene.fog {
        fog.colour *= night;
    }
    // How far the fire has come in each letter, and the beam before it.
    let mut lit = [flicker; 4];
    for k in 0..3 {
        let spread = track(&SPREAD, t - CATCH[k]);
        lit[k] = spread * flicker;
        scene.lights[k].colour *= lit[k];
        if let Some(fire) = &mut scene.materials[k].fire {
            fire.radius = (fire.radius * spread).max(1e-3);
            fire.strength *= flicker;
        }
        scene.fields.push(Field::new(LETTERS[k].to_vec()));
    }
    let head = at(track(&HEAD, t));
    for (k, beam) in &BEAMS {
        let mut beam = Beam { colour: beam.colour * lit[*k], ..*beam };
        if *k == 3 {
            beam.to = head;
        }
        scene.beams.push(beam);
    }
    let way = track(&DOLLY, t);
    scene.camera = Camera {
        position: Vec3::new(-2.6 + 0.74 * way, 1.15, 12.6 - 0.8 * way),
        target: v(-0.15, 1.34, 0.0),
        roll: angle(-1.2),
        fov: angle(44.0),
    };
    write(&mut scene.beams, &LINE, scene.camera.position, track(&SHOWN, t));
    scene
}
