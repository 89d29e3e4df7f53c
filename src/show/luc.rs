//! Lúč: a cold beam crosses the black and sets three letters on fire, one after another.

use super::paint::{degrees, key, metal, polished, seconds, swing, v};
use glam::{Mat3, Vec3};
use luc_core::math::scalar::sin_cos;
use luc_core::scene::*;

/// Share of the way to the full fire, over seconds since the beam came: 0.8 s, and 10 % too far.
const SPREAD: [Key; 3] =
    [key(0.0, 0.0, Ease::Smooth), key(0.8, 1.1, Ease::Smooth), key(1.6, 1.0, Ease::Linear)];

/// Colours of the fire over the distance from where the beam came in.
const FIRE: &[Stop] = &[
    Stop { y: 0.0, colour: v(1.0, 0.86, 0.62) },
    Stop { y: 0.13, colour: v(1.0, 0.58, 0.2) },
    Stop { y: 0.38, colour: v(0.5, 0.14, 0.02) },
    Stop { y: 0.72, colour: v(0.1, 0.015, 0.002) },
    Stop { y: 1.0, colour: Vec3::ZERO },
];

/// A stroke of a letter: middle, half sides, and its turn about z in degrees.
fn stroke(x: f32, y: f32, half: [f32; 3], turn: f32, material: usize) -> Node {
    let (sin, cos) = sin_cos(degrees(turn));
    let axes = (turn != 0.0).then(|| Mat3::from_cols(v(cos, sin, 0.0), v(-sin, cos, 0.0), Vec3::Z));
    let node = Node::cuboid(v(x, y, 0.0), Vec3::from(half), 0.12);
    Node { axes, material, ..node.joined(Join::Union, 0.03) }
}

/// The scene at a local frame.
pub fn scene(frame: u64) -> Scene {
    let t = seconds(frame);
    let upright = |x, y, half, letter| stroke(x, y, [0.26, half, 0.34], 0.0, letter);
    let level = |x, y, half, letter| stroke(x, y, [half, 0.26, 0.34], 0.0, letter);
    let accent = |x, y, turn, letter| stroke(x, y, [0.16, 0.42, 0.26], turn, letter);

    // Where the beam meets the strokes, as distances from where it comes out of the dark.
    let (from, towards) = (v(-14.0, 3.26, 1.83), v(5.2, 1.25, -0.35));
    let way = (towards - from).normalize();
    let at = |x: f32| from + way * ((x - from.x) / way.x);
    let flicker = 1.0 + 0.02 * swing(t, 0.13, 0.0) + 0.01 * swing(t, 0.047, 0.3);
    // How far the light has come: it waits in each letter for its two bars.
    let lit = [0.9, 4.0, 8.0].map(|start| track(&SPREAD, t - start));
    // Out of the black.
    let night = (t / 0.8).min(1.0);
    let head = -14.0 + 10.55 * (t / 0.9).min(1.0);

    let core = |a: f32, b: f32, width, strength, colour: Vec3| Beam {
        from: at(a),
        to: at(b),
        width,
        colour: colour * (strength * flicker),
        fade: 0.0,
    };
    let spot = |x: f32, strength: f32, k: usize| core(x, x, 0.1, strength * lit[k], v(1.0, 0.8, 0.52));
    let mut beams = vec![
        core(-14.0, head, 0.035, 5.0, v(0.62, 0.84, 1.0)),
        core(-14.0, head, 0.26, 0.1, v(0.3, 0.55, 1.0)),
    ];
    for (a, b, width, strength, colour, k) in [
        (-2.94, -1.04, 0.03, 2.6, v(1.0, 0.84, 0.58), 1),
        (-0.52, 0.52, 0.028, 1.6, v(1.0, 0.74, 0.4), 1),
        (1.04, 2.04, 0.026, 1.3, v(1.0, 0.66, 0.3), 2),
    ] {
        beams.push(core(a, b, width, strength * lit[k].min(1.0), colour));
    }
    beams.extend([spot(-3.46, 2.2, 0), spot(-1.04, 1.2, 1), spot(2.04, 0.9, 2)]);

    let letter = |x: f32, radius: f32, strength: f32, k: usize| Material {
        fire: Some(Fire {
            centre: at(x),
            radius: (radius * lit[k]).max(1e-3),
            strength: strength * flicker,
            stops: FIRE,
        }),
        specular: Vec3::ONE,
        ..metal(v(0.1, 0.14, 0.2), 0.34)
    };
    let ember = |x: f32, strength: f32, colour: Vec3, k: usize| Light {
        position: at(x) + v(-0.15, 0.0, 0.45),
        colour: colour * (strength * lit[k] * flicker),
        kind: LightKind::Point,
    };
    let ease = t / 12.0 * (t / 12.0) * (3.0 - t / 6.0);
    let target = v(-0.15, 1.34, 0.0);
    let position = v(-2.6, 1.15, 12.6)
        + (target - v(-2.6, 1.15, 12.6)).normalize() * (0.8 * ease)
        + Vec3::X * (0.6 * ease);
    Scene {
        camera: Camera { position, target, roll: degrees(-1.2), fov: degrees(44.0) },
        background: Background {
            stops: vec![
                Stop { y: -1.0, colour: v(0.001, 0.002, 0.004) * night },
                Stop { y: 0.0, colour: v(0.007, 0.019, 0.05) * night },
                Stop { y: 0.12, colour: v(0.003, 0.008, 0.022) * night },
                Stop { y: 1.0, colour: v(0.001, 0.001, 0.003) * night },
            ],
            ..Background::default()
        },
        planes: vec![Plane { point: Vec3::ZERO, normal: Vec3::Y, reach: 60.0, material: 3 }],
        fields: vec![
            Field::new(vec![upright(-3.2, 1.2, 1.2, 0), level(-2.5, 0.26, 0.96, 0)]),
            Field::new(vec![
                upright(-0.78, 1.3, 1.1, 1),
                upright(0.78, 1.3, 1.1, 1),
                level(0.0, 0.26, 1.04, 1),
                accent(0.12, 2.98, -32.0, 1),
            ]),
            Field::new(vec![
                upright(2.3, 1.2, 1.2, 2),
                level(3.0, 0.26, 0.96, 2),
                level(3.0, 2.14, 0.96, 2),
                accent(2.78, 3.0, 40.0, 2),
                accent(3.24, 3.0, -40.0, 2),
            ]),
        ],
        materials: vec![
            letter(-3.46, 3.4, 2.6, 0),
            letter(-1.04, 2.5, 2.0, 1),
            letter(2.04, 1.35, 1.7, 2),
            // Wet: it shows nothing but what it mirrors.
            Material {
                diffuse: 0.0,
                texture: Texture { scale: 1.3, bump: 0.012, ..Texture::NONE },
                ..polished(Vec3::ZERO, 0.12, 1.5)
            },
        ],
        lights: vec![
            ember(-3.5, 0.76, v(1.0, 0.8, 0.5), 0),
            ember(-1.1, 0.41, v(1.0, 0.62, 0.28), 1),
            ember(1.95, 0.25, v(1.0, 0.55, 0.2), 2),
        ],
        emitters: vec![
            Emitter::facing(
                v(7.0, 7.5, -8.0),
                v(1.5, 1.2, 0.0),
                2.0,
                5.0,
                v(0.3, 0.52, 1.0) * (28.65 * night),
            ),
            Emitter::facing(
                v(-9.0, 7.0, -6.0),
                v(-1.0, 1.0, 0.0),
                2.0,
                6.0,
                v(0.25, 0.5, 1.0) * (9.28 * night),
            ),
            Emitter::facing(
                v(-4.0, 5.0, 10.0),
                v(0.0, 1.0, 0.0),
                5.0,
                3.0,
                v(0.35, 0.55, 1.0) * (0.85 * night),
            ),
        ],
        beams,
        shading: Shading::CookTorrance,
        ambient: [v(0.001, 0.002, 0.005) * night, v(0.003, 0.008, 0.02) * night],
        fog: Some(Fog {
            density: 0.012,
            colour: v(0.012, 0.03, 0.075) * night,
            lo: v(-40.0, -0.1, -60.0),
            hi: v(40.0, 14.0, 3.0),
        }),
        grade: Grade {
            bloom: 0.55 * night,
            lift: v(0.004, 0.008, 0.02),
            gamma: v(1.0, 1.0, 1.04),
            vignette: 0.2,
            grain: 0.007,
            ..Grade::default()
        },
        ..Scene::default()
    }
}
