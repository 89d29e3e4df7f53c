//! Gold: three gold spheres that flow into one another, between two leaning glass cylinders, on a
//! navy square of two triangles that floats in azure. The last 4 s show how it was sampled.

use super::paint::{angle, glass, graded, key, metal, orbit, polished, seconds, short, swing, times, v};
use super::score;
use super::still::{Lamp, Panel, Still};
use luc_core::math::scalar::sin_cos;
use luc_core::math::{Mat3, Vec3};
use luc_core::mesh::{Assembly, Instance, Mesh};
use luc_core::scene::*;
use luc_core::synth::track::{Strikes, pulse, strikes};
use std::sync::Arc;

/// Strikes of kick and snare: the low sun beats with the one, the light spills over with the other.
const KICK: [Strikes; 16] = strikes(&score::SCORE, &score::GOLD, score::KICK);
const SNARE: [Strikes; 16] = strikes(&score::SCORE, &score::GOLD, score::SNARE);

/// Bearing of the camera, degrees over seconds.
const BEARING: [Key; 2] = [key(0.0, 49.0, Ease::Smooth), key(32.0, -21.0, Ease::Step)];

/// Share of the picture that shows how it was sampled: a wipe of one beat, 4 s before the end.
const OVERLAY: [Key; 2] = [key(28.0, 0.0, Ease::Linear), key(28.5, 1.0, Ease::Step)];

/// A bar that turns about its middle, around a level axis across it.
fn bar(a: Vec3, b: Vec3, turn: f32, material: usize) -> Cylinder {
    let middle = (a + b) * 0.5;
    let (sin, cos) = sin_cos(turn * std::f32::consts::TAU);
    // A small cone around the upright, so that the bars lean and never leave the picture.
    let turned = Mat3::from_cols(Vec3::new(cos, 0.0, -sin), Vec3::Y, Vec3::new(sin, 0.0, cos));
    let half = turned * (b - a) * 0.5;
    Cylinder::between(middle - half, middle + half, 0.27, material)
}

/// A ball of gold.
const fn gold(x: f32, y: f32, z: f32, radius: f32) -> Sphere {
    Sphere { centre: v(x, y, z), radius: short(radius), material: 0, blend: 0.8 }
}

static STILL: Still = Still {
    stops: &[
        Stop { y: -1.0, colour: v(0.03, 0.07, 0.18) },
        Stop { y: -0.36, colour: v(0.055, 0.15, 0.4) },
        Stop { y: -0.06, colour: v(0.26, 0.48, 0.84) },
        Stop { y: 0.05, colour: v(0.56, 0.74, 0.92) },
        Stop { y: 0.22, colour: v(0.26, 0.42, 0.7) },
        Stop { y: 0.6, colour: v(0.04, 0.06, 0.12) },
        Stop { y: 1.0, colour: v(0.015, 0.02, 0.05) },
    ],
    glows: &[Glow { direction: v(0.3, 0.35, 1.0), colour: v(1.7, 1.05, 0.42), sharpness: 3.2 }],
    spheres: &[gold(-0.55, 0.92, 0.05, 0.9), gold(0.58, 0.74, 0.28, 0.72), gold(0.2, 1.48, -0.05, 0.62)],
    materials: &[
        Material { specular: Vec3::ONE, ..metal(v(1.0, 0.6, 0.19), 0.11) },
        glass(v(0.86, 0.96, 1.0), v(0.55, 0.75, 0.95), 1.45),
        polished(v(0.012, 0.026, 0.065), 0.1, 1.35),
        polished(v(0.022, 0.044, 0.1), 0.1, 1.35),
    ],
    lights: &[Lamp { position: v(3.0, 7.0, 6.0), colour: times(v(1.0, 0.86, 0.62), 40.0), spot: None }],
    panels: &[
        Panel {
            centre: v(-4.0, 6.0, 3.0),
            target: v(0.0, 0.8, 0.0),
            size: [1.6, 1.6],
            radiance: times(v(1.0, 0.93, 0.82), 52.22),
        },
        Panel {
            centre: v(5.0, 3.0, -4.0),
            target: v(0.0, 1.0, 0.0),
            size: [1.2, 5.0],
            radiance: times(v(0.75, 0.88, 1.0), 22.28),
        },
    ],
    shading: Shading::CookTorrance,
    ambient: [v(0.05, 0.09, 0.2), v(0.2, 0.3, 0.5)],
    grade: graded(Grade {
        bloom: 0.3,
        lift: v(0.0, 0.006, 0.03),
        gamma: v(0.9, 0.89, 0.95),
        gain: v(1.0, 0.985, 0.955),
        vignette: 0.14,
        grain: 0.007,
        ..Grade::DEFAULT
    }),
    ..Still::NOTHING
};

/// The scene at a local frame.
pub fn scene(frame: u64) -> Scene {
    let t = seconds(frame);
    let turn = track(&BEARING, t) / 360.0;
    let target = v(0.35, 1.18, 0.0);
    let position = target + orbit(turn, 9.97, 1.52 + 0.5 * swing(t, 19.0, 0.0));
    let [a, b, c, d] = [0.0, 1.0, 2.0, 3.0].map(|k| orbit((24.0 + 90.0 * k) / 360.0, 3.3, 0.0));

    let mut s = STILL.scene();
    s.camera = Camera { position, target, roll: angle(-2.0), fov: angle(41.0) };
    for (ball, (period, phase)) in s.spheres.iter_mut().zip([(5.0, 0.0), (7.0, 0.3), (8.3, 0.6)]) {
        ball.centre.y += 0.6 * (0.25 * swing(t, period, phase));
    }
    s.cylinders = vec![
        bar(v(-2.15, 0.3, 0.1), v(-1.75, 2.95, -0.65), t / 9.0, 1),
        bar(v(1.95, 0.3, 0.85), v(2.7, 2.75, -0.35), -t / 11.0, 1),
    ];
    let half = |corners, material| {
        Instance::new(&Arc::new(Mesh::flat(vec![corners])), Mat3::IDENTITY, Vec3::ZERO, material)
    };
    s.meshes = Assembly::new(vec![half([a, b, c], 2), half([a, c, d], 3)]);
    s.background.glows[0].colour *= 1.0 + 0.3 * pulse(&KICK, frame, 6.0);
    s.grade.bloom += 0.3 * pulse(&SNARE, frame, 8.0);
    s.overlay = track(&OVERLAY, t);
    s
}
