//! The scene by which small lights are measured: a river of fireflies over hills by night.

use luc_core::math::hash::{hash2, unit};
use luc_core::math::scalar::{cos, pow, sin};
use luc_core::math::{Mat3, Vec3};
use luc_core::mesh::{Assembly, Instance, Mesh};
use luc_core::scene::{Camera, Emitter, Material, PointLight, Scene, Shading};
use std::f32::consts::TAU;
use std::sync::Arc;

/// The river's bed: corners of a Catmull-Rom curve, the first and last of which it doesn't reach.
const PATH: [[f32; 3]; 11] = [
    [-44.0, 12.0, -70.0],
    [-34.0, 10.0, -62.0],
    [-17.0, 5.8, -40.0],
    [-2.0, 2.9, -33.0],
    [5.8, 4.4, -34.0],
    [6.6, 3.6, -24.0],
    [6.4, 2.6, -13.0],
    [4.0, 1.9, -5.0],
    [0.2, 1.8, 0.0],
    [-3.2, 2.3, 5.0],
    [-7.5, 3.6, 10.5],
];

/// Light of the three kinds of fireflies.
const LIGHT: [[f32; 3]; 3] = [[1.0, 0.62, 0.2], [1.0, 0.8, 0.34], [0.75, 0.9, 0.35]];

/// Cells of the hills' net each way.
const CELLS: usize = 160;

/// Point of the river at `x` corners from its source, `0 <= x < 8`.
fn river(x: f32) -> Vec3 {
    let k = x as usize;
    let f = x - k as f32;
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| Vec3::from(PATH[(k + i).min(PATH.len() - 1)]));
    b + (c - a + (a * 2.0 - b * 5.0 + c * 4.0 - d + (b * 3.0 - a - c * 3.0 + d) * f) * f) * (0.5 * f)
}

/// Height of the hills over a point of the ground.
fn height(x: f32, z: f32) -> f32 {
    let rise = (-z - 26.0).max(0.0) * 0.055 * (1.0 + 0.6 * sin(0.11 * x + 1.4));
    let waves = 0.9 * sin(0.16 * x + 0.6) * cos(0.13 * z + 0.3) + 0.55 * sin(0.31 * x + 0.22 * z);
    rise + waves + 0.25 * sin(0.7 * x - 0.5 * z) + 0.035 * pow((-x - 6.0).max(0.0), 1.35)
}

/// The hills as a net of triangles with smooth normals, finer towards the viewer.
fn hills() -> Arc<Mesh> {
    let point = |i: usize, k: usize| {
        let (u, w) = (i as f32 / CELLS as f32, k as f32 / CELLS as f32);
        let z = 16.0 - 96.0 * w * (0.3 + 0.7 * w);
        let x = (u - 0.5) * (40.0 - 1.2 * z) - 4.0;
        Vec3::new(x, height(x, z), z)
    };
    let normal = |p: Vec3| {
        let slope = |x, z| height(p.x + x, p.z + z) - height(p.x - x, p.z - z);
        Vec3::new(-slope(0.05, 0.0), 0.1, -slope(0.0, 0.05))
    };
    let mut triangles = Vec::new();
    for i in 0..CELLS * CELLS {
        let (i, k) = (i % CELLS, i / CELLS);
        let [a, b, c, d] = [(i, k), (i + 1, k), (i, k + 1), (i + 1, k + 1)].map(|(i, k)| point(i, k));
        triangles.extend([[a, b, d], [a, d, c]]);
    }
    let normals = triangles.iter().map(|t: &[Vec3; 3]| t.map(normal)).collect();
    Arc::new(Mesh::smooth(triangles, normals))
}

/// `count` fireflies, spread over the river.
fn fireflies(count: u32) -> Vec<PointLight> {
    let corners = (PATH.len() - 3) as f32;
    let firefly = |i: u32| {
        let random = |k: u32| unit(hash2(i, k));
        let x = (i as f32 + random(0)) / count as f32 * corners;
        let scatter = 1.15 - 0.9 * x / corners;
        let orbit = |k: u32| sin(random(k + 3) * TAU) * 0.2;
        let gauss = |k: u32| (random(k) + random(k + 3) + random(k + 6) - 1.5) * scatter;
        let aside = Vec3::new(gauss(10) + orbit(20), gauss(11) + orbit(21), gauss(12) + orbit(22));
        let mut position = river(x) + aside;
        position.y = position.y.max(height(position.x, position.z) + 0.25);
        let strength = if position.z < -20.0 { 0.5 } else { 0.3 };
        PointLight { position, radius: 2.4, colour: Vec3::from(LIGHT[i as usize % 3]) * strength }
    };
    (0..count).map(firefly).collect()
}

/// The scene with `count` small lights.
pub fn scene(count: u32) -> Scene {
    let blue = Vec3::new(0.36, 0.3, 1.0) * 32.33;
    Scene {
        camera: Camera {
            position: Vec3::new(-3.5, 3.6, 15.0),
            target: Vec3::new(1.2, 3.0, -10.0),
            roll: -0.026,
            fov: 0.838,
        },
        meshes: Assembly::new(vec![Instance::new(&hills(), Mat3::IDENTITY, Vec3::ZERO, 0)]),
        materials: vec![Material {
            colour: Vec3::new(0.034, 0.028, 0.06),
            f0: Vec3::splat(0.034),
            specular: Vec3::ONE,
            roughness: 0.55,
            ..Material::default()
        }],
        emitters: vec![Emitter::facing(
            Vec3::new(-30.0, 30.0, -50.0),
            Vec3::new(0.0, 0.0, -10.0),
            16.0,
            16.0,
            blue,
        )],
        points: fireflies(count),
        shading: Shading::CookTorrance,
        ..Scene::default()
    }
}
