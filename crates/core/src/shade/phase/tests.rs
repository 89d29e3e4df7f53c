//! Against f64 in another form; the integral over the sphere; draws against the distribution.

use super::*;
use crate::math::check::Worst;
use crate::math::lanes::splat;
use crate::trace::check::Random;

/// The integral over the sphere by the midpoint rule in ln(1 - cos), where any peak is wide.
#[test]
fn the_sphere_gets_all_the_light() {
    for g in [0.0_f32, 1e-6, 0.1, 0.5, 0.9, 0.99, 0.999, 0.9999] {
        for g in [g, -g] {
            let steps = 40_000;
            let (lowest, highest) = (-36.0_f64, std::f64::consts::LN_2);
            let step = (highest - lowest) / f64::from(steps);
            let mut sum = 0.0;
            for i in 0..steps {
                #[allow(clippy::disallowed_methods, reason = "the oracle's own arithmetic")]
                let w = (lowest + step * (f64::from(i) + 0.5)).exp();
                // Where the peak lies an f32 cosine has no digits of 1 - cos, so the value there is weighed by its own.
                let cos = (1.0 - w) as f32;
                let own = 1.0 - f64::from(cos);
                let a = f64::from(g.abs());
                let peak = (1.0 - a) * (1.0 - a) + 2.0 * a * own;
                let true_peak = (1.0 - a) * (1.0 - a) + 2.0 * a * w;
                let cos = if g < 0.0 { -cos } else { cos };
                let value = f64::from(phase(g, splat(cos)).as_array()[0]);
                sum += value * (peak / true_peak) * (peak / true_peak).sqrt() * w * step;
            }
            sum *= std::f64::consts::TAU;
            assert!((sum - 1.0).abs() < 1e-5, "{sum} at {g}");
        }
    }
}

#[test]
fn values_and_draws_are_within_an_ulp() {
    let mut random = Random::new(660);
    let (mut value, mut far, mut near) = (Worst::new("phase"), Worst::new("1 - cos"), Worst::new("cos"));
    let mut off = 0.0_f64;
    for _ in 0..200_000 {
        let g = match random.bits() % 4 {
            0 => random.signed(-60, 0),
            1 => 1.0 - random.size(-13, 0),
            2 => random.size(-13, 0) - 1.0,
            _ => random.range(-1.0, 1.0),
        };
        let g = g.clamp(-STEEPEST, STEEPEST);
        let cos = match random.bits() % 3 {
            0 => random.range(-1.0, 1.0),
            1 => 1.0 - random.size(-24, 0),
            _ => random.size(-24, 0) - 1.0,
        };
        let (a, c) = (f64::from(g.abs()), f64::from(if g < 0.0 { -cos } else { cos }));
        let d = (1.0 - a) * (1.0 - a) + 2.0 * a * (1.0 - c);
        let exact = (1.0 - a) * (1.0 + a) / (4.0 * std::f64::consts::PI) / (d * d.sqrt());
        value.add(g, phase(g, splat(cos)).as_array()[0], exact);

        let u = if random.one_in(2) { random.range(0.0, 1.0) } else { random.size(-40, 0) };
        let drawn = turn(g, splat(u));
        // Both halves of the turn; for g < 0 they change places, and u with 1 - u.
        let h = if g < 0.0 { 1.0 - f64::from(u) } else { f64::from(u) };
        let k = 1.0 - a + 2.0 * a * h;
        let (w, rest) = (
            2.0 * (1.0 - a) * (1.0 - a) / (k * k) * (1.0 - h) * (1.0 + a * h),
            2.0 * (1.0 + a) * (1.0 + a) / (k * k) * h * (1.0 - a * (1.0 - h)),
        );
        let (w, rest) = if g < 0.0 { (rest, w) } else { (w, rest) };
        far.add(u, drawn.one_minus_cos.as_array()[0], w);
        off = off.max((f64::from(drawn.cos.as_array()[0]) - 0.5 * (rest - w)).abs());
        near.add(u, drawn.sin.as_array()[0], (w * rest).sqrt());
        assert!((w + rest - 2.0).abs() < 1e-9, "the two halves of a turn: {g:e} {u:e}");
    }
    println!("cos off by {:.2} u", off * 16_777_216.0);
    assert!(value.ulp() <= 1.0 && far.ulp() <= 1.0 && near.ulp() <= 1.0 && off <= 1e-7);
}

/// The share of draws up to a turn is that of `u`: the inverse of the cumulated phase function.
#[test]
fn draws_follow_the_phase_function() {
    for g in [-0.9_f32, -0.3, 0.0, 1e-5, 0.6, 0.95] {
        let count = 4_000;
        for i in 0..count {
            let u = (i as f32 + 0.5) / count as f32;
            let cos = f64::from(turn(g, splat(u)).cos.as_array()[0]);
            // P(cos' < cos) = (1 - g²) / 2g · (1 / √(1 + g² - 2 g cos) - 1 / (1 + g)); for small g to first order.
            let g = f64::from(g);
            let below = if g.abs() < 1e-4 {
                0.5 * (1.0 + cos) + 0.75 * g * (cos * cos - 1.0)
            } else {
                (1.0 - g * g) / (2.0 * g) * ((1.0 + g * g - 2.0 * g * cos).sqrt().recip() - 1.0 / (1.0 + g))
            };
            // What the cosine's own rounding is worth in the peak.
            let slope = std::f64::consts::TAU * f64::from(phase(g as f32, splat(cos as f32)).as_array()[0]);
            assert!((below - f64::from(u)).abs() < 1e-7 * (1.0 + slope), "{g} {u}: {below}");
        }
    }
}

#[test]
fn nothing_odd_is_nan() {
    let odd = [0.0, -0.0, 1.0, -1.0, 2.0, 1e-45, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
    for g in odd {
        for x in odd {
            assert!(phase(g, splat(x)).as_array()[0].is_finite(), "{g} {x}");
            let t = turn(g, splat(x));
            for v in [t.cos, t.one_minus_cos, t.sin] {
                assert!(v.as_array()[0].is_finite(), "{g} {x}");
            }
        }
    }
}
