//! Against the textbook's form in f64 with the sines, and its laws.

use super::*;
use crate::math::check::Worst;
use crate::math::lanes::splat;
use crate::trace::check::Random;

fn one(v: F) -> f32 {
    v.as_array()[0]
}

/// A cosine, dense at grazing and at the critical angle.
fn cosine(random: &mut Random, n_i: f32, n_t: f32) -> f32 {
    let critical = (1.0 - n_t / n_i * (n_t / n_i)).max(0.0).sqrt();
    match random.bits() % 4 {
        0 => random.size(-40, 0),
        1 => (critical + random.signed(-20, -2)).clamp(0.0, 1.0),
        2 => 1.0 - random.size(-24, 0),
        _ => random.range(0.0, 1.0),
    }
}

#[test]
fn reflectance_and_cosine_are_within_an_ulp() {
    let mut random = Random::new(680);
    let (mut share, mut beyond, mut totals) = (Worst::new("reflectance"), Worst::new("cos_refracted"), 0);
    for _ in 0..300_000 {
        let n_i = if random.one_in(2) { 1.0 } else { random.range(1.0, 3.0) };
        let n_t = if random.one_in(8) { n_i + random.signed(-22, -4) } else { random.range(1.0, 3.0) };
        let cos = cosine(&mut random, n_i, n_t);
        let (a, b, c) = (f64::from(n_i), f64::from(n_t), f64::from(cos));
        // Sums of exact products, by their parts.
        let g2 = (b - a) * (b + a) + (a * c) * (a * c);
        // Where f64 cancels, tests/kernels.rs has an exact oracle.
        if g2.abs() < 1e-7 * (a * c) * (a * c) {
            continue;
        }
        assert_eq!(one(is_total(splat(cos), splat(n_i), splat(n_t))).to_bits() != 0, g2 < 0.0);
        let got = one(reflectance(splat(cos), splat(n_i), splat(n_t)));
        assert!((0.0..=1.0).contains(&got), "{got} at {cos:e} {n_i} {n_t}");
        if g2 < 0.0 {
            totals += 1;
            assert_eq!(got, 1.0);
            assert_eq!(one(cos_refracted(splat(cos), splat(n_i), splat(n_t))), 0.0);
            continue;
        }
        let cos_t = g2.sqrt() / b;
        let s = (a * c - b * cos_t) / (a * c + b * cos_t);
        let p = (b * c - a * cos_t) / (b * c + a * cos_t);
        // The oracle cancels between bodies that are nearly alike, ours does not.
        if (a - b).abs() > 1e-3 {
            share.add(cos, got, 0.5 * (s * s + p * p));
        }
        beyond.add(cos, one(cos_refracted(splat(cos), splat(n_i), splat(n_t))), cos_t);
    }
    assert!(share.ulp() <= 1.0 && beyond.ulp() <= 1.0 && totals > 10_000);
}

/// Light takes the same way back: the share mirrored is that of the refracted angle from the other side.
#[test]
fn the_same_from_both_sides() {
    let mut random = Random::new(681);
    for case in 0..50_000 {
        let (n_i, n_t) = (random.range(1.0, 3.0), random.range(1.0, 3.0));
        let cos = random.range(0.05, 1.0);
        if one(is_total(splat(cos), splat(n_i), splat(n_t))).to_bits() != 0 {
            continue;
        }
        let back = cos_refracted(splat(cos), splat(n_i), splat(n_t));
        let (there, home) = (
            one(reflectance(splat(cos), splat(n_i), splat(n_t))),
            one(reflectance(back, splat(n_t), splat(n_i))),
        );
        // The cosine behind is rounded, which moves that in front by as much more as light is bent.
        let (bend, back) = (n_t / n_i, one(back));
        let room = 16.0 / 16_777_216.0 * (1.0 + bend * bend * back * back / cos);
        assert!((there - home).abs() <= room, "case {case}: {there} {home} at {cos} {n_i} {n_t}");
    }
}

#[test]
fn it_never_falls_towards_grazing_within_a_denser_body_and_starts_at_f0() {
    for (n_i, n_t) in [(1.0_f32, 1.5), (1.5, 1.0), (1.0, 1.0), (1.0, 2.4)] {
        let f0 = (n_i - n_t) / (n_i + n_t);
        let f0 = f0 * f0;
        let straight = one(reflectance(F::ONE, splat(n_i), splat(n_t)));
        assert!((straight - f0).abs() <= 1e-8, "{straight} {f0}");
        let mut last = 0.0;
        for i in 0..=10_000 {
            let now = one(reflectance(splat(1.0 - i as f32 / 10_000.0), splat(n_i), splat(n_t)));
            assert!(now >= last * 0.999_999 || n_i < n_t, "{i}: {last} {now}");
            last = now;
        }
        assert_eq!(last, if n_i == n_t { 0.0 } else { 1.0 }, "along the surface");
    }
}

#[test]
fn odd_cosines_give_a_share() {
    for odd in [-1.0, -0.0, 0.0, 1e-45, 2.0, f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
        for (n_i, n_t) in [(1.0, 1.0), (1.0, 1.5), (1.5, 1.0)] {
            let got = one(reflectance(splat(odd), splat(n_i), splat(n_t)));
            assert!((0.0..=1.0).contains(&got), "{got} at {odd}");
        }
    }
}
