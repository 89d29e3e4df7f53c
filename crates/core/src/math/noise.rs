//! Value noise: hashed values at the points of the integer lattice, joined smoothly, and its gradient.

use super::hash::mix_x8;
use super::lanes::{F, U, V3, splat, splat_u};

/// Adding this to an integer |i| < 2²² leaves it in the low bits.
const ROUND: f32 = 12_582_912.0; // 1.5·2²³

/// The cell that holds each point, as whole numbers, and where in it the points lie.
#[inline(always)]
pub fn cell(p: V3) -> ([U; 3], V3) {
    let cell = V3::new(p.x.floor(), p.y.floor(), p.z.floor());
    let bits = |x: F| (x + splat(ROUND)).to_bits();
    ([bits(cell.x), bits(cell.y), bits(cell.z)], p - cell)
}

/// Noise from −1 to 1 with cells of side 1, continuous with its first derivatives, and its gradient,
/// whose coordinates stay within ±3: the noise has a Lipschitz constant below 5.2.
///
/// Defined for coordinates within ±2²²; larger ones repeat arbitrarily, but stay finite.
#[inline(never)]
pub fn value_noise(p: V3) -> (F, V3) {
    let ([x, y, z], f) = cell(p);
    let ease = |x: F| x * x * (splat(3.0) - (x + x));
    let slope = |x: F| splat(6.0) * x * (F::ONE - x);
    let (u, v, w) = (ease(f.x), ease(f.y), ease(f.z));
    let one = splat_u(1);
    let value = |x: U, y: U, z: U| {
        let h = mix_x8(mix_x8(x, y), z);
        // 23 bits as a mantissa: 2 to 4, then -1 to 1.
        F::from_bits((h >> 9u32) | splat_u(0x4000_0000)) - splat(3.0)
    };
    // Value and its change along x; then also along y; then along z.
    let row = |y: U, z: U| {
        let (a, b) = (value(x, y, z), value(x + one, y, z));
        (a + (b - a) * u, b - a)
    };
    let sheet = |z: U| {
        let ((a, ax), (b, bx)) = (row(y, z), row(y + one, z));
        (a + (b - a) * v, ax + (bx - ax) * v, b - a)
    };
    let ((a, ax, ay), (b, bx, by)) = (sheet(z), sheet(z + one));
    let (dx, dy, dz) = (ax + (bx - ax) * w, ay + (by - ay) * w, b - a);
    (a + (b - a) * w, V3::new(dx * slope(f.x), dy * slope(f.y), dz * slope(f.z)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::trace::check::Random;

    fn at(x: f32, y: f32, z: f32) -> f32 {
        value_noise(V3::splat(Vec3::new(x, y, z))).0.as_array()[3]
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

    /// The central difference over 2h = 1/64 is off by h² max|f'''| / 6 < 0.003 inside a cell, and where
    /// it crosses into the next, where f'' jumps by up to 24, by h 24 / 4 < 0.05.
    #[test]
    fn the_gradient_is_that_of_the_noise() {
        const H: f32 = 1.0 / 128.0;
        let mut random = Random::new(630);
        for i in 0..20_000 {
            let p = Vec3::from_array(std::array::from_fn(|_| random.range(-60.0, 60.0)));
            let (_, gradient) = value_noise(V3::splat(p));
            let gradient = gradient.lane(i % 8);
            let near = Vec3::from_array(std::array::from_fn(|k| {
                let step = Vec3::AXES[k] * H;
                let value = |p: Vec3| at(p.x, p.y, p.z);
                (value(p + step) - value(p - step)) / (2.0 * H)
            }));
            let inside = (p - p.round()).abs().min_element() > 2.0 * H;
            let limit = if inside { 0.004 } else { 0.05 };
            assert!((gradient - near).abs().max_element() < limit, "{gradient} {near} at {p:?}, case {i}");
            assert!(gradient.abs().max_element() <= 3.0 && gradient.length() < 5.2, "{gradient} at {p:?}");
        }
    }

    #[test]
    fn finite_far_outside_its_domain() {
        for x in [1e7, -1e9, 3e38] {
            let (value, gradient) = value_noise(V3::splat(Vec3::new(x, 0.5, -x)));
            assert!(value.as_array()[0].is_finite() && gradient.lane(0).is_finite(), "at {x}");
        }
    }
}
