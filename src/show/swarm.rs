//! Swarm: by night fireflies stream over hills and through what is left of the cathedral; for a bar
//! the picture shows how many of them light each of its tiles.
//!
//! They run along a curve with time, each on a small orbit of its own, and shine with the plucks, which
//! run down the stream as waves. What is seen of them are beams without length.

use super::facets::{self, BAY, Dice, SIDE, Triangles};
use super::paint::{angle, degrees, graded, key, seconds, surface, swing, times, v};
use super::score;
use super::still::{Lamp, Panel, Still};
use luc_core::math::scalar::{cos, sin};
use luc_core::math::{Mat3, Vec3, number, whole};
use luc_core::mesh::{Assembly, Instance, Mesh};
use luc_core::scene::*;
use luc_core::synth::track::{Strikes, pulse, strikes};
use std::sync::{Arc, OnceLock};

/// Strikes of the plucks, which run down the stream, and of the kick, with which all glows.
const PLUCK: [Strikes; 10] = strikes(&score::SCORE, &score::SWARM, score::PLUCK);
const KICK: [Strikes; 10] = strikes(&score::SCORE, &score::SWARM, score::KICK);

/// Corners of the stream, for [`curve`].
const PATH: [Vec3; 12] = [
    v(-44.0, 12.0, -70.0),
    v(-34.0, 10.0, -62.0),
    v(-17.0, 5.0, -42.0),
    v(0.0, 3.6, -40.0),
    v(10.5, 2.8, -35.0),
    v(9.6, 0.7, -25.0),
    v(7.2, 0.8, -14.5),
    v(3.6, 1.9, -6.5),
    v(0.2, 1.7, 0.0),
    v(-3.2, 1.5, 5.0),
    v(-7.5, 2.2, 10.5),
    v(-14.0, 5.0, 17.0),
];

/// Corners of the camera's flight.
const FLIGHT: [Vec3; 6] = [
    v(8.0, 2.6, -20.0),
    v(7.3, 2.6, -15.0),
    v(5.9, 2.9, -6.0),
    v(2.2, 3.3, 5.0),
    v(-3.5, 3.6, 15.0),
    v(-12.0, 4.0, 24.0),
];

/// Share of the stream that a firefly goes in a second.
const SPEED: f32 = 0.029;

/// What is seen of the three kinds of fireflies, and the light that they give.
const SHINE: [Vec3; 3] = [v(1.0, 0.36, 0.05), v(1.0, 0.46, 0.08), v(0.72, 0.66, 0.1)];
const LIGHT: [Vec3; 3] = [v(1.0, 0.62, 0.2), v(1.0, 0.8, 0.34), v(0.75, 0.9, 0.35)];

/// The count of lights over seconds: in the bar that has neither drums nor bass.
const COUNT: [Key; 4] = [
    key(15.75, 0.0, Ease::Smooth),
    key(16.0, 0.55, Ease::Step),
    key(18.0, 0.55, Ease::Smooth),
    key(18.25, 0.0, Ease::Step),
];

/// Corners of its flight that the camera has passed, over seconds.
const BACK: [Key; 2] = [key(-2.0, 0.0, Ease::Smooth), key(16.0, 2.99, Ease::Step)];

/// Point of a Catmull-Rom curve `x` corners behind its second one; it doesn't reach the first and the last.
#[inline(never)]
fn curve(corners: &[Vec3], x: f32) -> Vec3 {
    let k = whole(x);
    let f = x - k as f32;
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| corners[k + i]);
    b + (c - a + (a * 2.0 - b * 5.0 + c * 4.0 - d + (b * 3.0 - a - c * 3.0 + d) * f) * f) * (0.5 * f)
}

/// Height of the hills.
#[inline(never)]
fn height(x: f32, z: f32) -> f32 {
    let rise = (-z - 26.0).max(0.0) * 0.055 * (1.0 + 0.6 * sin(0.11 * x + 1.4));
    let left = (-x - 6.0).max(0.0);
    let waves = 0.9 * sin(0.16 * x + 0.6) * cos(0.13 * z + 0.3) + 0.55 * sin(0.31 * x + 0.22 * z);
    rise + waves + 0.25 * sin(0.7 * x - 0.5 * z) + 0.035 * left * left.sqrt().sqrt()
}

/// Cells of the hills' net each way.
const CELLS: usize = 80;

/// The hills as a net of triangles with smooth normals, finer towards the viewer.
fn hills() -> Mesh {
    let (mut triangles, mut normals) = (Vec::new(), Vec::new());
    for i in 0..CELLS * CELLS * 2 {
        // Corners of the cell's upper or lower half, as steps across and along.
        let corners = [[(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 1), (0, 1)]][i % 2];
        let at = |(across, along)| {
            let step = |n: usize| number(n) / CELLS as f32;
            let (u, w) = (step(i / 2 % CELLS + across), step(i / 2 / CELLS + along));
            let z = 16.0 - 96.0 * w * (0.3 + 0.7 * w);
            (z, (u - 0.5) * (40.0 - 1.2 * z) - 4.0)
        };
        triangles.push(corners.map(|corner| {
            let (z, x) = at(corner);
            Vec3::new(x, height(x, z), z)
        }));
        normals.push(corners.map(|corner| {
            let (z, x) = at(corner);
            let slope = |dx, dz| height(x - dx, z - dz) - height(x + dx, z + dz);
            Vec3::new(slope(0.05, 0.0), 0.1, slope(0.0, 0.05))
        }));
    }
    Mesh::smooth(triangles, normals)
}

/// Crystals that stick out of the hills.
fn shards(out: &mut Triangles, dice: &mut Dice) {
    for _ in 0..60 {
        let (x, z) = (dice.roll(-14.0, 16.0), dice.roll(-25.0, 9.0));
        let size = 0.3 + 1.1 * dice.roll(0.0, 1.0) * dice.roll(0.0, 1.0);
        let axis = Vec3::new(dice.roll(-0.6, 0.6), 1.5, dice.roll(-0.6, 0.6)) * size;
        facets::crystal(
            out,
            Vec3::new(x, height(x, z) - 0.1, z),
            axis,
            [0.16 * size, 0.7 * size],
            dice.roll(0.0, 1.0),
        );
    }
}

/// What is left of one side of a bay of the cathedral.
fn pier(out: &mut Triangles, dice: &mut Dice) {
    facets::shaft(out, dice);
    facets::foot(out, dice);
    let stands = dice.roll(0.0, 1.0) < 0.5;
    for shape in facets::RIBS {
        let left = if stands { 7.0 } else { dice.roll(1.0, 6.0) };
        facets::rib(out, dice, shape, whole(left));
    }
}

/// Piers of the ruin.
const PIERS: usize = 12;

/// The meshes, made once: hills, shards, piers.
fn meshes() -> &'static [Arc<Mesh>] {
    static MESHES: OnceLock<Vec<Arc<Mesh>>> = OnceLock::new();
    MESHES.get_or_init(|| {
        let mut dice = Dice(0);
        let mut made = vec![Arc::new(hills())];
        for k in 0..PIERS + 1 {
            let mut triangles = Vec::new();
            if k == 0 {
                shards(&mut triangles, &mut dice)
            } else {
                pier(&mut triangles, &mut dice)
            }
            made.push(Arc::new(Mesh::flat(triangles)));
        }
        made
    })
}

/// Across and along the ruin's nave.
const RUIN: Mat3 = Mat3::from_cols(v(0.97, 0.0, 0.242), Vec3::Y, v(-0.242, 0.0, 0.97));

/// Hills and ruin.
fn land() -> Assembly {
    let meshes = meshes();
    let place = |(k, mesh): (usize, &Arc<Mesh>)| {
        let Some(k) = k.checked_sub(2) else {
            return Instance::new(mesh, Mat3::IDENTITY, Vec3::ZERO, k);
        };
        let side = if k % 2 == 0 { 1.0 } else { -1.0 };
        let at = v(5.6, -0.9, -9.1) + RUIN.x_axis * (side * SIDE) - RUIN.z_axis * (BAY * (k / 2) as f32);
        Instance::new(mesh, Mat3 { x_axis: RUIN.x_axis * side, ..RUIN }, at, 2)
    };
    Assembly::new(meshes.iter().enumerate().map(place).collect())
}

/// Adds a round glow.
#[inline(never)]
fn glow(scene: &mut Scene, at: Vec3, width: f32, colour: Vec3) {
    scene.beams.push(Beam { from: at, to: at, width, colour, fade: 0.0 });
}

static STILL: Still = Still {
    stops: &[
        Stop { y: -1.0, colour: v(0.01, 0.006, 0.03) },
        Stop { y: -0.02, colour: v(0.12, 0.045, 0.17) },
        Stop { y: 0.05, colour: v(0.13, 0.048, 0.2) },
        Stop { y: 0.2, colour: v(0.045, 0.022, 0.12) },
        Stop { y: 0.55, colour: v(0.014, 0.01, 0.055) },
        Stop { y: 1.0, colour: v(0.006, 0.005, 0.03) },
    ],
    glows: &[Glow { direction: v(-0.55, 0.06, -1.0), colour: v(0.28, 0.1, 0.26), sharpness: 10.0 }],
    materials: &[
        surface(v(0.034, 0.028, 0.06), 0.55, 0.0),
        surface(v(0.12, 0.1, 0.17), 0.42, 0.35),
        surface(v(0.12, 0.1, 0.17), 0.42, 0.35),
    ],
    lights: &[Lamp { position: v(-50.0, 40.0, 90.0), colour: times(v(0.55, 0.2, 0.6), 7000.0), spot: None }],
    panels: &[Panel {
        centre: v(-30.0, 30.0, -50.0),
        target: v(0.0, 0.0, -10.0),
        size: [16.0, 16.0],
        radiance: times(v(0.36, 0.3, 1.0), 32.33),
    }],
    shading: Shading::Ggx,
    ambient: [v(0.03, 0.012, 0.05), v(0.04, 0.02, 0.09)],
    fog: Some(Fog {
        density: 0.03,
        colour: v(0.12, 0.045, 0.19),
        lo: v(-200.0, -4.0, -200.0),
        hi: v(200.0, 1.4, 4.0),
    }),
    grade: graded(Grade {
        bloom_threshold: 0.9,
        bloom: 0.5,
        lift: v(0.008, 0.004, 0.024),
        gamma: v(0.88, 0.86, 0.9),
        gain: v(1.0, 0.99, 1.0),
        vignette: 0.2,
        grain: 0.007,
        ..Grade::DEFAULT
    }),
    ..Still::NOTHING
};

/// The scene at a local frame.
pub fn scene(frame: u64) -> Scene {
    let t = seconds(frame);
    let mut s = STILL.scene();
    let back = track(&BACK, t);
    let position = curve(&FLIGHT, back);
    let way = back / 3.0;
    let target = v(10.4, 3.2, -32.0).lerp(v(1.2, 3.0, -10.0), way);
    s.camera = Camera { position, target, roll: angle(-1.5), fov: degrees(60.0 - 12.0 * way) };
    s.grade.bloom += 0.4 * pulse(&KICK, frame, 5.0);
    s.meshes = land();
    s.soft = true;
    s.light_count = track(&COUNT, t);
    // The corners are about equally far from each other, so the way runs evenly in them.
    let corners = (PATH.len() - 3) as f32;
    for i in 0..512 {
        // Each draws numbers of its own.
        let mut dice = Dice(32 * i);
        let x = ((i as f32 + dice.roll(0.0, 1.0)) / 512.0 + t * SPEED).fract() * corners;
        let scatter = 1.15 - 0.9 * x / corners;
        let aside = [(); 3].map(|()| {
            let gauss = dice.roll(-0.5, 0.5) + dice.roll(-0.5, 0.5) + dice.roll(-0.5, 0.5);
            gauss * scatter + 0.2 * swing(t, dice.roll(0.7, 1.4), dice.roll(0.0, 1.0))
        });
        let mut position = curve(&PATH, x) + Vec3::from(aside);
        position.y = position.y.max(height(position.x, position.z) + 0.4);
        let kind = i as usize % 3;
        // The plucks reach the fireflies one after the other.
        let wave = 0.7 + 0.7 * pulse(&PLUCK, frame.saturating_sub((6.0 * x) as i32 as u64), 6.0);
        s.points.push(PointLight { position, radius: 2.7, colour: LIGHT[kind] * (0.8 * wave) });
        // Dim at both ends of the stream, and close to the eye.
        let far = position.distance(s.camera.position);
        let seen = (4.0 * x).min(4.0 * (corners - x)).min(0.25 * far).min(1.0);
        let shine = (1.9 + 10.0 / far).min(3.0) * wave * seen;
        // Far ones stay nearly as wide as a pixel, so that they don't twinkle as they move.
        glow(&mut s, position, dice.roll(0.02, 0.05).max(0.0006 * far), SHINE[kind] * shine);
    }
    let mut dice = Dice(0);
    for _ in 0..120 {
        let away = Vec3::new(dice.roll(-150.0, 150.0), dice.roll(5.0, 115.0), -120.0);
        let colour = v(0.5, 0.5, 0.9) * dice.roll(0.1, 1.7);
        glow(&mut s, position + away, 0.09, colour);
    }
    s
}
