//! Value noise: hashed values at the points of the integer lattice, joined smoothly.

use super::hash::mix_x8;
use super::lanes::{F, U, V3, splat, splat_u};

/// Adding this to an integer |i| < 2²² leaves it in the low bits.
const ROUND: f32 = 12_582_912.0; // 1.5·2²³

/// Noise from −1 to 1 with cells of side 1, continuous with its first derivatives.
///
/// Defined for coordinates within ±2²²; larger ones repeat arbitrarily, but stay finite.
pub fn value_noise(p: V3) -> F {
    let cell = V3::new(p.x.floor(), p.y.floor(), p.z.floor());
    let f = p - cell;
    let ease = |x: F| x * x * (splat(3.0) - (x + x));
    let (u, v, w) = (ease(f.x), ease(f.y), ease(f.z));
    let bits = |x: F| (x + splat(ROUND)).to_bits();
    let (x, y, z) = (bits(cell.x), bits(cell.y), bits(cell.z));
    let one = splat_u(1);
    let value = |x: U, y: U, z: U| {
        let h = mix_x8(mix_x8(x, y), z);
        // 23 bits as a mantissa: 2 to 4, then -1 to 1.
        F::from_bits((h >> 9u32) | splat_u(0x4000_0000)) - splat(3.0)
    };
    let row = |y: U, z: U| {
        let (a, b) = (value(x, y, z), value(x + one, y, z));
        a + (b - a) * u
    };
    let sheet = |z: U| {
        let (a, b) = (row(y, z), row(y + one, z));
        a + (b - a) * v
    };
    let (a, b) = (sheet(z), sheet(z + one));
    a + (b - a) * w
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn at(x: f32, y: f32, z: f32) -> f32 {
        value_noise(V3::splat(Vec3::new(x, y, z))).as_array()[3]
    }

    #[test]
    fn stays_within_one_and_varies() {
        let mut sum = 0.0;
        let mut square = 0.0;
        for i in 0..4000 {
            let v = at(i as f32 * 0.371 - 700.0, i as f32 * 0.173, 3.5 - i as f32 * 0.091);
            assert!((-1.0..=1.0).contains(&v), "{v} at step {i}");
            sum += v;
            square += v * v;
        }
        assert!((sum / 4000.0).abs() < 0.05, "mean {}", sum / 4000.0);
        assert!(square / 4000.0 > 0.05, "variance {}", square / 4000.0);
    }

    #[test]
    fn continuous_across_cells() {
        for i in -5..5 {
            let x = i as f32;
            let (a, b) = (at(x - 1e-4, 0.3, 7.7), at(x + 1e-4, 0.3, 7.7));
            assert!((a - b).abs() < 1e-3, "jump from {a} to {b} at x = {x}");
        }
    }
}
