//! Blobs: mercury falls into an endless lattice of bronze, which on the drop is cut away around it.

use super::paint::{degrees, graded, key, metal, seconds, swing, times, v};
use super::score;
use super::still::{Panel, Still};
use luc_core::math::scalar::exp;
use luc_core::math::{Mat3, Vec3};
use luc_core::scene::*;
use luc_core::synth::track::{Strikes, pulse, strikes};

/// Strikes of kick and crash: light beats with the one, the view widens with the other.
const KICK: [Strikes; 10] = strikes(&score::SCORE, &score::BLOBS, score::KICK);
const CRASH: [Strikes; 10] = strikes(&score::SCORE, &score::BLOBS, score::CRASH);

/// Radius of the cut over seconds: it opens with the drop.
const CUT: [Key; 3] = [key(0.0, 2.4, Ease::Smooth), key(0.5, 5.6, Ease::Smooth), key(20.0, 6.1, Ease::Step)];

/// The camera's distance over seconds, and its roll in degrees.
const DISTANCE: [Key; 2] = [key(0.0, 12.0, Ease::Smooth), key(20.0, 9.5, Ease::Step)];
const ROLL: [Key; 2] = [key(0.0, -3.0, Ease::Smooth), key(20.0, 2.0, Ease::Step)];

/// Axes whose y points from the sun to the eye.
const TO_EYE: Mat3 = Mat3::from_cols(v(0.969, 0.0, 0.246), v(-0.246, -0.05, 0.968), v(0.012, -0.999, -0.049));

/// Side of the lattice's cell.
const CELL: f32 = 3.4;

/// A node of every cell.
const fn each(node: Node, join: Join, blend: f32) -> Node {
    Node { repeats: true, ..node.joined(join, blend) }
}

/// The lattice: bars, knots, bores, a hammered skin; open in front, and cut away around the mercury
/// by a ball and by a tunnel towards the sun.
static LATTICE: [Node; 7] = [
    each(Node::cross(0.4, 0.06), Join::Union, 0.0),
    each(Node::sphere(Vec3::ZERO, 0.78), Join::Union, 0.2),
    each(Node::cross(0.21, 0.21), Join::Subtraction, 0.08),
    Node::swell(0.018, 7.0),
    Node::plane(v(0.0, 0.0, 2.8), Vec3::Z).joined(Join::Intersection, 0.0),
    Node::sphere(v(0.35, 0.2, 2.0), 0.0).joined(Join::Subtraction, 0.0),
    Node {
        axes: Some(TO_EYE),
        ..Node::capsule(v(2.6, 1.5, -10.0), 12.0, 0.0).joined(Join::Subtraction, 0.0)
    },
];

/// The large lobes of the mercury: middle and radius.
const LOBES: [(Vec3, f32); 5] = [
    (v(0.25, -0.15, 0.4), 1.3),
    (v(-1.15, 0.42, 0.6), 0.74),
    (v(1.45, 0.35, 0.3), 0.66),
    (v(0.18, 1.25, 0.5), 0.5),
    (v(0.75, -1.05, 0.8), 0.6),
];

/// Where satellites fly to.
const AWAY: [Vec3; 4] = [v(-2.6, 0.85, 0.4), v(2.5, 0.75, -0.1), v(-2.0, -1.1, 0.5), v(1.95, -1.1, 0.4)];

static STILL: Still = Still {
    stops: &[
        Stop { y: -1.0, colour: v(0.02, 0.008, 0.02) },
        Stop { y: -0.1, colour: v(0.035, 0.01, 0.016) },
        Stop { y: 0.05, colour: v(0.15, 0.04, 0.014) },
        Stop { y: 0.3, colour: v(0.07, 0.018, 0.014) },
        Stop { y: 1.0, colour: v(0.02, 0.008, 0.02) },
    ],
    glows: &[Glow { direction: v(0.3, 0.07, -1.0), colour: v(1.6, 0.55, 0.09), sharpness: 26.0 }],
    discs: &[Disc {
        centre: v(7.6, 2.6, -30.0),
        radius: 6.4,
        low: times(v(1.0, 0.46, 0.09), 4.5),
        high: times(v(1.0, 0.46, 0.09), 4.5),
    }],
    materials: &[
        Material {
            colour: v(0.1, 0.045, 0.025),
            diffuse: 0.4,
            specular: Vec3::ONE,
            f0: v(0.074, 0.041, 0.029),
            roughness: 0.42,
            ..Material::DEFAULT
        },
        metal(v(0.92, 0.89, 0.86), 0.03),
    ],
    panels: &[
        Panel {
            centre: v(5.5, 2.5, -6.5),
            target: Vec3::ZERO,
            size: [3.5, 3.5],
            radiance: times(v(1.0, 0.5, 0.14), 38.98),
        },
        Panel {
            centre: v(-6.0, 6.0, 7.0),
            target: v(0.0, 0.0, 0.5),
            size: [6.2, 3.8],
            radiance: times(v(1.0, 0.7, 0.34), 31.07),
        },
        Panel {
            centre: v(5.5, -2.5, 6.5),
            target: v(0.5, 0.0, 0.5),
            size: [0.7, 6.0],
            radiance: times(v(0.22, 0.5, 1.0), 25.01),
        },
    ],
    shading: Shading::CookTorrance,
    ambient: [v(0.1, 0.03, 0.025), v(0.3, 0.09, 0.04)],
    fog: Some(Fog {
        density: 0.024,
        colour: v(0.36, 0.085, 0.016),
        lo: v(-40.0, -30.0, -60.0),
        hi: v(40.0, 30.0, -1.6),
    }),
    grade: graded(Grade {
        bloom: 0.6,
        lift: v(0.01, 0.003, 0.012),
        gamma: v(0.9, 0.88, 0.88),
        gain: v(1.0, 0.98, 0.95),
        vignette: 0.2,
        grain: 0.007,
        ..Grade::DEFAULT
    }),
    ..Still::NOTHING
};

/// The mercury: lobes that sway, a string of drops that falls into them a beat apart, and satellites
/// that tear off and fly away.
fn mercury(t: f32) -> Field {
    let mut nodes = Vec::new();
    let mut drop = |at: Vec3, radius: f32| {
        nodes.push(Node { material: 1, ..Node::sphere(at, radius).joined(Join::Union, 0.55) });
    };
    for (k, (at, radius)) in LOBES.into_iter().enumerate() {
        let phase = 0.37 * k as f32;
        let sway = Vec3::new(
            0.16 * swing(t, 3.7, phase),
            0.14 * swing(t, 2.9, phase + 0.2),
            0.1 * swing(t, 5.3, phase),
        );
        drop(at + sway, radius * (1.0 + 0.06 * swing(t, 2.0, phase)));
    }
    for k in 0..3 {
        // One arrives on each beat.
        let way = (t / 1.5 + k as f32 / 3.0).fract();
        drop(Vec3::new(0.27 - 0.05 * way, 4.2 - 2.9 * way * way, 0.45), 0.14 + 0.2 * way);
    }
    for (k, away) in AWAY.into_iter().enumerate() {
        let way = (t / 4.0 + 0.27 * k as f32).fract();
        let share = 1.0 - (1.0 - way) * (1.0 - way);
        let at = away * (0.3 + 0.75 * share) + Vec3::new(0.1, 0.9 * way * (0.7 - way), 0.4);
        drop(at, 0.32 * (1.0 - way * way));
    }
    Field::new(nodes)
}

/// The scene at a local frame.
pub fn scene(frame: u64) -> Scene {
    let t = seconds(frame);
    let mut scene = STILL.scene();
    let cut = track(&CUT, t);
    let mut lattice = LATTICE.to_vec();
    lattice[5].rounding = cut;
    lattice[6].rounding = cut * 0.52;
    scene.fields = vec![
        Field {
            nodes: lattice,
            cell: Vec3::splat(CELL),
            copies: Vec3::INFINITY,
            lo: v(-14.0, -8.0, -22.0),
            hi: v(16.0, 9.0, 2.85),
            shadowless: true,
        },
        mercury(t),
    ];
    scene.occlusion = 1.6;
    let target = Vec3::new(0.75 + 0.15 * swing(t, 13.0, 0.0), 0.45, 0.0);
    // Round the mercury and over it, so that the lattice slides behind it.
    let from = Vec3::new(-0.3 - 0.27 * swing(t, 16.0, 0.0), 0.02 + 0.16 * swing(t, 10.0, 0.0), 0.93);
    scene.camera = Camera {
        position: target + from * track(&DISTANCE, t),
        target,
        roll: degrees(track(&ROLL, t)),
        fov: degrees(46.0 + 2.0 * pulse(&CRASH, frame, 4.0)),
    };
    scene.grade.exposure = 1.0 + 1.5 * exp(-t * 6.0) + 0.12 * pulse(&KICK, frame, 6.0);
    scene
}
