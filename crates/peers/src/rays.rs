//! The rays that all tracers are given.

use glam::Vec3A;

/// What rays are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// From the eye.
    Primary,
    /// From a surface, anywhere.
    Diffuse,
    /// From a surface to a lamp: whether anything is between.
    Shadow,
}

/// Rays, a multiple of eight.
pub struct Rays {
    pub kind: Kind,
    pub origins: Vec<Vec3A>,
    pub directions: Vec<Vec3A>,
    /// Distance from which on hits don't count.
    pub ends: Vec<f32>,
}

impl Rays {
    fn new(kind: Kind) -> Self {
        Self { kind, origins: Vec::new(), directions: Vec::new(), ends: Vec::new() }
    }

    pub fn len(&self) -> usize {
        self.origins.len() / 8 * 8
    }

    fn push(&mut self, origin: Vec3A, direction: Vec3A, end: f32) {
        self.origins.push(origin);
        self.directions.push(direction);
        self.ends.push(end);
    }
}

const EYE: Vec3A = Vec3A::new(1.5, 2.0, 9.0);
const LAMP: Vec3A = Vec3A::new(5.0, 6.0, 7.0);

/// Rays of a square picture, in tiles of 4x2.
pub fn primary(side: usize) -> Rays {
    let forward = (-EYE).normalize();
    let right = forward.cross(Vec3A::Y).normalize();
    let up = right.cross(forward);
    let mut rays = Rays::new(Kind::Primary);
    for (ty, tx) in (0..side / 2).flat_map(|y| (0..side / 4).map(move |x| (y, x))) {
        for k in 0..8 {
            let at = |i: usize| (i as f32 + 0.5) / side as f32 * 2.0 - 1.0;
            let (x, y) = (at(tx * 4 + k % 4) * 0.42, -at(ty * 2 + k / 4) * 0.42);
            rays.push(EYE, (forward + right * x + up * y).normalize(), f32::INFINITY);
        }
    }
    rays
}

/// A number from 0 to 1 (Wellons' lowbias32).
pub fn unit(seed: u32) -> f32 {
    let mut x = seed.wrapping_mul(0x9e37_79b9) ^ 0x5bd1_e995;
    x = (x ^ x >> 16).wrapping_mul(0x7feb_352d);
    x = (x ^ x >> 15).wrapping_mul(0x846c_a68b);
    ((x ^ x >> 16) >> 8) as f32 / 16_777_216.0
}

/// Points a little off the surface on the side of the eye.
fn points(primary: &Rays, hits: &[f32]) -> impl Iterator<Item = (usize, Vec3A)> {
    let hit = |i: usize| (i, primary.origins[i] + primary.directions[i] * (hits[i] * 0.999));
    (0..hits.len()).filter(|&i| hits[i].is_finite()).map(hit)
}

/// From each hit one ray in a direction of the half sphere towards the eye.
pub fn diffuse(primary: &Rays, hits: &[f32]) -> Rays {
    let mut rays = Rays::new(Kind::Diffuse);
    for (i, p) in points(primary, hits) {
        let z = 2.0 * unit(2 * i as u32) - 1.0;
        let (sin, cos) = (unit(2 * i as u32 + 1) * std::f32::consts::TAU).sin_cos();
        let r = (1.0 - z * z).sqrt();
        let direction = Vec3A::new(r * cos, r * sin, z);
        let towards = -primary.directions[i];
        let direction = if direction.dot(towards) < 0.0 { -direction } else { direction };
        rays.push(p, direction, f32::INFINITY);
    }
    rays
}

/// From each hit to the lamp.
pub fn shadow(primary: &Rays, hits: &[f32]) -> Rays {
    let mut rays = Rays::new(Kind::Shadow);
    for (_, p) in points(primary, hits) {
        let to = LAMP - p;
        rays.push(p, to.normalize(), to.length());
    }
    rays
}
