//! Facets: a crystal cathedral grows bay by bay from the ground, before a low sun in its rose window.
//!
//! All of it follows from six small rules for one side of one bay and the rose; instances mirror,
//! place and grow them. The camera waits at the portal, flies down the nave and looks up.

use super::paint::{angle, bumps, degrees, graded, key, polished, seconds, surface, times, v};
use super::score;
use super::still::{Lamp, Still};
use luc_core::math::hash::{hash2, unit};
use luc_core::math::scalar::sin_cos;
use luc_core::math::{Mat3, Vec3, normalize, number};
use luc_core::mesh::{Assembly, Instance, Mesh, lathe};
use luc_core::scene::*;
use luc_core::synth::track::{Strikes, pulse, strikes};
use std::sync::{Arc, OnceLock};

/// Strikes of the kick, with which the sun in the rose beats.
const KICK: [Strikes; 12] = strikes(&score::SCORE, &score::FACETS, score::KICK);

/// Distance of the piers from the middle of the nave, height of their capitals, and length of a
/// bay, units.
pub const SIDE: f32 = 4.2;
const SPRING: f32 = 6.6;
pub const BAY: f32 = 4.5;

/// Radius of the circles of which the pointed arch is made, and the angle at which they meet.
const ARCH: f32 = (SIDE * SIDE + SPRING * SPRING) / (2.0 * SIDE);
const APEX: f32 = 1.133;

/// Middle of the rose window.
const ROSE: Vec3 = v(0.0, SPRING, -35.5);

/// Where the camera is and what it looks along, over seconds.
const Z: [Key; 3] = [key(0.0, 12.0, Ease::Smooth), key(9.0, 8.5, Ease::Smooth), key(23.5, -20.0, Ease::Step)];
const Y: [Key; 2] = [key(9.0, 1.15, Ease::Smooth), key(23.0, 3.0, Ease::Step)];
const TILT: [Key; 3] =
    [key(9.0, 0.19, Ease::Smooth), key(18.0, 0.24, Ease::Smooth), key(24.0, 0.47, Ease::Step)];
const ROLL: [Key; 2] = [key(12.0, 2.5, Ease::Smooth), key(24.0, -3.0, Ease::Step)];

pub type Triangles = Vec<[Vec3; 3]>;

/// See [`RULES`].
type Rule = (fn(&mut Triangles, &mut Dice), usize, f32, f32);

/// Numbers drawn one after the other.
pub struct Dice(pub u32);

impl Dice {
    #[inline(never)]
    pub fn roll(&mut self, lo: f32, hi: f32) -> f32 {
        self.0 += 1;
        lo + (hi - lo) * unit(hash2(self.0, 64))
    }
}

/// A crystal that leans: a body of six sides and a pointed tip.
pub fn crystal(out: &mut Triangles, foot: Vec3, axis: Vec3, [radius, tip]: [f32; 2], turn: f32) {
    let neck = foot + axis;
    lathe(out, &[(foot, radius), (neck, radius * 0.8), (neck + normalize(axis) * tip, 0.0)], 6, turn);
}

/// A point of the arch at a share of the way up, from the pier's axis, moved outwards.
fn arch(share: f32, out: f32) -> Vec3 {
    let (sin, cos) = sin_cos(share * APEX);
    Vec3::new((ARCH + out) * cos - ARCH, SPRING + (ARCH + out) * sin, 0.0)
}

/// The pier's shaft and capital.
pub fn shaft(out: &mut Triangles, _: &mut Dice) {
    let ring = |height, radius| (Vec3::Y * height, radius);
    lathe(out, &[ring(0.0, 0.62), ring(SPRING, 0.44)], 6, 0.03);
    lathe(out, &[ring(6.1, 0.0), ring(6.1, 0.5), ring(6.85, 0.72), ring(6.85, 0.0)], 6, 0.01);
}

/// The crystals that lean at its foot.
pub fn foot(out: &mut Triangles, dice: &mut Dice) {
    for k in 0..7 {
        let (sin, cos) = sin_cos(number(k) * 0.9 + dice.roll(-0.3, 0.3));
        let away = Vec3::new(cos, 0.0, sin);
        let height = dice.roll(0.9, 2.2) * dice.roll(0.9, 2.2);
        let axis = (Vec3::Y + away * dice.roll(0.02, 0.3)) * height;
        let sizes = [dice.roll(0.16, 0.34), dice.roll(0.3, 0.8)];
        crystal(out, away * dice.roll(0.6, 1.1), axis, sizes, dice.roll(0.0, 1.0));
    }
}

/// Splinters on the floor, high in the aisle and low in the nave. They have dice of their own, so that their number
/// changes nothing else.
fn splinters(out: &mut Triangles, _: &mut Dice) {
    let dice = &mut Dice(0);
    for _ in 0..370 {
        let x = dice.roll(-2.9, 3.2);
        // Few are large, and those stand in the aisles.
        let size = dice.roll(0.2, 1.0);
        let height = size * size * size * size * if x > -1.0 { 1.3 } else { 0.3 };
        let axis = (Vec3::new(dice.roll(-0.5, 0.5), 1.0, dice.roll(-0.5, 0.5))) * height;
        let sizes = [height * dice.roll(0.12, 0.3), height * 0.4];
        crystal(out, Vec3::new(x, 0.0, dice.roll(-0.5, 0.5) * BAY), axis, sizes, dice.roll(0.0, 1.0));
    }
}

/// Radius and slant of half of the arch over the nave and halves of the two diagonal ribs.
pub const RIBS: [(f32, f32); 3] = [(0.3, 0.0), (0.16, 0.5), (0.16, -0.5)];

/// The first of the seven pieces of a rib.
pub fn rib(out: &mut Triangles, dice: &mut Dice, (radius, slant): (f32, f32), pieces: usize) {
    for k in 0..pieces {
        let at = |k: usize| {
            let share = number(k) / 7.0;
            arch(share, 0.0) + Vec3::Z * (slant * share * BAY)
        };
        lathe(out, &[(at(k), radius), (at(k + 1), radius * 0.97)], 6, dice.roll(-0.03, 0.03));
    }
}

/// The ribs, and half of the keystone.
fn ribs(out: &mut Triangles, dice: &mut Dice) {
    for shape in RIBS {
        rib(out, dice, shape, 7);
    }
    let top = arch(1.0, 0.0);
    lathe(out, &[(top - Vec3::Y * 1.4, 0.0), (top - Vec3::Y * 1.2, 0.3), (top, 0.5)], 6, 0.0);
}

/// A torn sheet over them.
fn vault(out: &mut Triangles, dice: &mut Dice) {
    let points: [[Vec3; 9]; 28] = std::array::from_fn(|j| {
        std::array::from_fn(|i| {
            let shaken = Vec3::new(dice.roll(-0.13, 0.13), dice.roll(-0.13, 0.13), dice.roll(-0.13, 0.13));
            arch(number(j) / 27.0, 0.45) + Vec3::Z * ((number(i) / 8.0 - 0.5) * BAY) + shaken
        })
    });
    for (j, i) in (0..27 * 8).map(|k| (k / 8, k % 8)) {
        let [a, b, c, d] = [points[j][i], points[j][i + 1], points[j + 1][i], points[j + 1][i + 1]];
        for triangle in [[a, b, c], [d, c, b]] {
            if dice.roll(0.0, 1.0) < 0.62 {
                out.push(triangle);
            }
        }
    }
}

/// Twelve spokes and a rim, about the origin.
fn rose(out: &mut Triangles, _: &mut Dice) {
    let around = |k: usize, radius: f32| {
        let (sin, cos) = sin_cos(number(k) * degrees(15.0));
        Vec3::new(sin, cos, 0.0) * radius
    };
    for k in 0..24 {
        lathe(out, &[(around(k, 4.1), 0.3), (around(k + 1, 4.1), 0.3)], 6, 0.0);
        if k % 2 == 0 {
            let ring = |at, radius| (around(k, at), radius);
            lathe(out, &[ring(1.1, 0.0), ring(1.1, 0.12), ring(4.3, 0.3), ring(4.9, 0.0)], 6, 0.0);
        }
    }
}

/// The rules, with the material, the delay of growth in seconds, and the height they grow from.
const RULES: [Rule; 6] = [
    (splinters, 0, 0.0, 0.0),
    (foot, 0, 0.3, 0.0),
    (shaft, 0, 0.6, 0.0),
    (ribs, 0, 1.4, SPRING),
    (vault, 1, 1.8, SPRING),
    (rose, 0, 0.0, 0.0),
];

/// Place of [`foot`] among them.
const FOOT: usize = 1;

/// The meshes, made once.
fn meshes() -> &'static [Arc<Mesh>] {
    static MESHES: OnceLock<Vec<Arc<Mesh>>> = OnceLock::new();
    MESHES.get_or_init(|| {
        // The cathedral looks as it does by this number.
        let mut dice = Dice(2310);
        let mesh = |rule: &Rule| {
            let mut triangles = Vec::new();
            (rule.0)(&mut triangles, &mut dice);
            Arc::new(Mesh::flat(triangles))
        };
        RULES.iter().map(mesh).collect()
    })
}

/// How far something has grown, `t` seconds after it began: up in a second, 15 % too far, and back.
fn growth(t: f32) -> f32 {
    let x = t.clamp(0.0, 1.0) - 1.0;
    1.0 + x * x * (2.25 + 3.25 * x)
}

/// All that has grown so far of this many bays, nearest first, with or without the rose.
pub fn cathedral(t: f32, bays: usize, rose: bool) -> Assembly {
    let meshes = meshes();
    let mut instances = Vec::new();
    if rose {
        instances.push(Instance::new(&meshes[5], Mat3::IDENTITY, ROSE, 0));
    }
    for k in 0..2 * bays {
        let bay = k / 2;
        let side = if k % 2 == 0 { 1.0 } else { -1.0 };
        let way = if (bay * 3 + k) % 4 < 2 { 1.0 } else { -1.0 };
        let began = number(bay) - 1.5;
        // No two clusters of crystals stand the same way.
        let (sin, cos) = sin_cos(number(k) * 1.7);
        let turned = Mat3::from_cols(Vec3::new(cos, 0.0, sin), Vec3::Y, Vec3::new(-sin, 0.0, cos));
        for (i, (mesh, (_, material, delay, from))) in meshes.iter().zip(RULES).take(5).enumerate() {
            let size = growth(t - began - delay);
            if size > 0.02 && (rose || i > 0) {
                let origin = v(side * SIDE, from * (1.0 - size), 4.0 - BAY * number(bay));
                let mirrored = Mat3::from_diagonal((Vec3::new(side, 1.0, way) * size).into());
                let grown = if i == FOOT { mirrored * turned } else { mirrored };
                instances.push(Instance::new(mesh, grown, origin, material));
            }
        }
    }
    Assembly::new(instances)
}

/// Light that comes through the torn vault, from when its bay has grown.
fn shaft_of_light(k: usize, t: f32) -> Beam {
    let from = v(4.0, 8.2 + 0.25 * number(k), -5.0 - BAY * number(k));
    let to = from + v(-0.42, -0.34, 0.84) * (from.y / 0.34);
    let shine = 0.08 * ((t - 4.0 - number(k)) * 0.5).clamp(0.0, 1.0);
    Beam { from, to, width: 0.42, colour: v(1.0, 0.58, 0.22) * shine, fade: 0.05 }
}

/// A stop of the sky.
const fn sky(y: f32, r: f32, g: f32, b: f32) -> Stop {
    Stop { y, colour: v(0.8 * r, 0.8 * g, 0.8 * b) }
}

/// A light around the sun, which stands behind the rose.
const fn glow(colour: Vec3, sharpness: f32) -> Glow {
    Glow { direction: ROSE, colour, sharpness }
}

static STILL: Still = Still {
    stops: &[
        sky(-1.0, 0.02, 0.03, 0.05),
        sky(-0.02, 0.1, 0.16, 0.28),
        sky(0.06, 0.13, 0.21, 0.4),
        sky(0.3, 0.05, 0.1, 0.24),
        sky(0.7, 0.02, 0.045, 0.12),
        sky(1.0, 0.02, 0.05, 0.14),
    ],
    glows: &[glow(v(20.0, 11.5, 4.2), 420.0), glow(v(1.7, 0.72, 0.19), 30.0)],
    planes: &[Plane { point: Vec3::ZERO, normal: Vec3::Y, reach: 90.0, material: 2 }],
    materials: &[
        surface(v(0.2, 0.28, 0.42), 0.3, 0.5),
        surface(v(0.1, 0.135, 0.2), 0.55, 0.1),
        Material { texture: bumps(0.9, 0.35, 0.04), ..polished(v(0.05, 0.065, 0.09), 0.14, 1.6) },
    ],
    lights: &[
        // The sun, from where it really shines.
        Lamp { position: v(240.0, 200.0, -1000.0), colour: times(v(1.0, 0.72, 0.38), 3.14e6), spot: None },
        // Goes with the camera.
        Lamp { position: v(-4.0, 6.0, 5.0), colour: times(v(0.3, 0.5, 1.0), 40.0), spot: None },
    ],
    shading: Shading::Ggx,
    ambient: [v(0.03, 0.045, 0.08), v(0.13, 0.22, 0.44)],
    fog: Some(Fog {
        density: 0.021,
        colour: v(0.06, 0.115, 0.26),
        lo: v(-40.0, -0.1, -60.0),
        hi: v(40.0, 30.0, 5.0),
    }),
    grade: graded(Grade {
        exposure: 1.12,
        bloom: 0.38,
        lift: v(0.0, 0.01, 0.03),
        gamma: v(0.92, 0.92, 1.0),
        gain: v(1.0, 0.94, 0.82),
        vignette: 0.18,
        grain: 0.007,
        ..Grade::DEFAULT
    }),
    ..Still::NOTHING
};

/// The scene at a local frame.
pub fn scene(frame: u64) -> Scene {
    let t = seconds(frame);
    let z = track(&Z, t);
    let position = Vec3::new(-1.5 * (z / 12.0).max(-0.6), track(&Y, t), z);
    let tilt = track(&TILT, t);
    let target = position + Vec3::new(0.1, tilt, -1.0);
    let mut s = STILL.scene();
    s.camera = Camera { position, target, roll: degrees(track(&ROLL, t)), fov: angle(54.0) };
    for glow in &mut s.background.glows {
        glow.direction = normalize(ROSE - position);
        glow.colour *= 1.0 + 0.4 * pulse(&KICK, frame, 7.0);
    }
    s.lights[1].position += position;
    s.meshes = cathedral(t, 9, true);
    if tilt > 0.27 {
        // The floor has left the picture.
        s.planes.clear();
    }
    s.beams = (0..5).map(|k| shaft_of_light(k, t)).collect();
    s
}
