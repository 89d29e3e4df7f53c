//! Points and directions, well distributed: the R2 sequence, turned by hashed bits where they are to be
//! random, and a sequence for the few samples of a pixel or a lamp.

use super::hash::{hash2_x8, unit_x8};
use super::lanes::{F, U, V3, copysign, splat, splat_u};
use super::lanes_fn::sin_cos;
use glam::Vec2;

/// The inverse powers of the plastic number, times 2³²: steps of the R2 sequence (Roberts 2018).
const STEP: [u32; 2] = [0xc13f_a9a9, 0x91e1_0da5];

/// Point `i` of the sequence that goes from the middle of the unit square by equal steps, round its borders.
fn walk(i: u32, step: Vec2) -> Vec2 {
    let at = 0.5 + i as f32 * step;
    at - at.floor()
}

/// Point `i` of the R2 sequence that begins in the middle of the unit square.
pub fn r2(i: u32) -> Vec2 {
    walk(i, Vec2::new(0.754_877_7, 0.569_840_3))
}

/// Point `i` of a few that stand for a unit square, from its middle on, 256 at most. Of all steps in
/// 256ths these tell the share of the square behind a straight edge best, for 2, 3, 4, 8, 16 and 64 points: at 4
/// the error is 0.095 (root mean square over all edges that come near), with R2, whose first points lie to one
/// side, 0.140.
pub fn spread(i: u32) -> Vec2 {
    walk(i, Vec2::new(209.0, 79.0) / 256.0)
}

/// Point `i` in the unit square, without its upper borders, of each lane's own sequence: R2 moved
/// by a random vector (Cranley and Patterson 1976). Whole numbers, so that it never loses digits.
#[inline(always)]
pub fn point(seed: U, i: u32) -> (F, F) {
    let turned =
        |axis: u32| unit_x8(hash2_x8(seed, splat_u(axis)) + splat_u(STEP[axis as usize].wrapping_mul(i)));
    (turned(0), turned(1))
}

/// Two unit vectors that are upright on each other and on the unit vector `n`, without a branch or
/// a direction where digits are lost: Duff et al., JCGT 6(1), 2017.
#[inline(always)]
pub fn basis(n: V3) -> (V3, V3) {
    let sign = copysign(F::ONE, n.z);
    let a = -F::ONE / (sign + n.z);
    let b = n.x * n.y * a;
    (V3::new(F::ONE + sign * n.x * n.x * a, sign * b, -(sign * n.x)), V3::new(b, sign + n.y * n.y * a, -n.y))
}

/// A unit direction around `n` whose density is cosine / pi: never in the surface, as u < 1.
#[inline(never)]
pub fn cosine(n: V3, (u, v): (F, F)) -> V3 {
    let (sin, cos) = sin_cos(v * splat(std::f32::consts::TAU));
    let (x, y) = basis(n);
    let r = u.sqrt();
    x * (r * cos) + y * (r * sin) + n * (F::ONE - u).sqrt()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::disallowed_methods, reason = "an oracle in f64 that never reaches a pixel")]

    use super::*;
    use crate::math::Vec3;
    use crate::trace::check::Random;

    #[test]
    fn bases_are_orthonormal_also_next_to_the_poles() {
        let mut random = Random::new(650);
        for _ in 0..100_000 {
            let tilt = Vec3::new(random.signed(-40, 0), random.signed(-40, 0), 1.0);
            let n = if random.one_in(2) { random.direction() } else { crate::math::normalize(tilt) };
            let n = if random.one_in(2) { -n } else { n };
            let (x, y) = basis(V3::splat(n));
            let (x, y) = (x.lane(0), y.lane(0));
            let off = [x.dot(y), x.dot(n), y.dot(n), x.length() - 1.0, y.length() - 1.0];
            assert!(off.iter().all(|e| e.abs() <= 4e-7), "{off:?} at {n:?}");
            assert!((crate::math::cross(x, y) - n).length() < 1e-6, "right-handed at {n:?}");
        }
    }

    /// Mean of cos is 2/3, of cos² 1/2, of the part across 0; the sequence does better than chance,
    /// whose standard deviation would be 0.24/√n.
    #[test]
    fn directions_have_the_moments_of_the_cosine() {
        let n = Vec3::new(0.48, -0.64, 0.6);
        let (mut sum, mut across, mut square) = (0.0_f64, Vec3::ZERO, 0.0_f64);
        let count = 4096;
        for i in 0..count {
            let d = cosine(V3::splat(n), point(splat_u(77), i)).lane(3);
            let c = d.dot(n);
            assert!(c >= 2.3e-4 && (d.length() - 1.0).abs() < 1e-6, "{d} {c}");
            sum += f64::from(c);
            square += f64::from(c * c);
            across += d - n * c;
        }
        let count = f64::from(count);
        assert!((sum / count - 2.0 / 3.0).abs() < 1e-3, "{}", sum / count);
        assert!((square / count - 0.5).abs() < 1e-3, "{}", square / count);
        assert!(across.length() / (count as f32) < 4e-3, "{across}");
    }

    /// Share of the square of side 1 around (0, 0) where `n.p < d`, for a unit vector `n` in the first octant:
    /// a trapezoid's density from middle to ends, integrated.
    fn share(n: [f64; 2], d: f64) -> f64 {
        let [a, b] = [n[0].abs().max(n[1].abs()), n[0].abs().min(n[1].abs())];
        let (inner, outer) = ((a - b) / 2.0, (a + b) / 2.0);
        let x = d.abs();
        let half =
            if x <= inner { x / a } else { 0.5 - (outer - x).max(0.0).powi(2) / (2.0 * a * b).max(1e-300) };
        0.5 + half.copysign(d)
    }

    /// Root mean square of the error of the covered share, over straight edges in all directions.
    fn error(points: &[Vec2]) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        for angle in 0..64 {
            let (sin, cos) = ((angle as f64 + 0.5) * std::f64::consts::TAU / 64.0).sin_cos();
            for step in -48..48 {
                let d = (step as f64 + 0.5) / 64.0;
                let before = |p: &&Vec2| (f64::from(p.x) - 0.5) * cos + (f64::from(p.y) - 0.5) * sin < d;
                let found = points.iter().filter(before).count() as f64 / points.len() as f64;
                sum += (found - share([cos, sin], d)).powi(2);
                count += 1.0;
            }
        }
        (sum / count).sqrt()
    }

    #[test]
    fn few_points_tell_how_much_of_a_pixel_an_edge_covers() {
        for (points, worst) in [(2, 0.195), (3, 0.158), (4, 0.097), (8, 0.065), (16, 0.035), (64, 0.0125)] {
            let own = error(&(0..points).map(spread).collect::<Vec<_>>());
            let r2 = error(&(0..points).map(r2).collect::<Vec<_>>());
            println!("{points} points: {own:.4}, R2 {r2:.4}");
            assert!(own <= worst && own < 0.95 * r2, "{points} points: {own}, R2 {r2}");
        }
        // All are places of their own.
        let mut seen: Vec<_> = (0..256).map(|i| (spread(i) * 256.0).to_array().map(|x| x as u32)).collect();
        seen.sort();
        seen.dedup();
        assert_eq!(seen.len(), 256);
    }

    /// Any run of 64 points leaves no hole of a quarter of the side, whatever the seed and start.
    #[test]
    fn runs_of_points_are_spread_evenly() {
        let mut random = Random::new(651);
        for _ in 0..200 {
            let (seed, start) = (random.bits(), random.bits());
            let mut seen = [false; 16];
            for i in 0..64 {
                let (u, v) = point(splat_u(seed), start.wrapping_add(i));
                let (u, v) = (u.as_array()[5], v.as_array()[5]);
                assert!((0.0..1.0).contains(&u) && (0.0..1.0).contains(&v));
                seen[(u * 4.0) as usize * 4 + (v * 4.0) as usize] = true;
            }
            assert!(seen.iter().all(|&s| s), "seed {seed} from {start}");
        }
    }
}
