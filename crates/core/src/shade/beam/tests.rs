//! The closed form against the integral over the haze, summed in f64.

use super::*;
use crate::math::Vec3;
use crate::math::lanes::INFINITY;
use crate::trace::check::{Random, packet, splat as alone};
use glam::DVec3;

/// Sum of exp(-(r/w)²) / (w sqrt(pi)) over steps along the ray, r the distance from the segment.
fn integral(b: &Beam, o: Vec3, d: Vec3, end: f64) -> f64 {
    let (axis, length) = b.along();
    let (o, d, a, from) = (o.as_dvec3(), d.as_dvec3(), axis.as_dvec3(), b.from.as_dvec3());
    let w = f64::from(b.width);
    let ds = w / 50.0;
    let light = |t: f64| {
        let p: DVec3 = o + d * t - from;
        let s = p.dot(a).clamp(0.0, f64::from(length));
        #[allow(clippy::disallowed_methods, reason = "an oracle")]
        (-(p - a * s).length_squared() / (w * w) - f64::from(b.fade) * s).exp()
    };
    let steps = (end / ds) as usize;
    (0..steps).map(|i| light((i as f64 + 0.5) * ds)).sum::<f64>() * ds / (w * std::f64::consts::PI.sqrt())
}

fn some(random: &mut Random) -> Beam {
    let from = Vec3::new(random.range(-3.0, -1.0), random.range(-1.0, 1.0), random.range(-1.0, 1.0));
    let to = Vec3::new(random.range(1.0, 3.0), random.range(-1.0, 1.0), random.range(-1.0, 1.0));
    Beam { from, to, width: random.range(0.05, 0.3), colour: Vec3::ONE, fade: 0.0 }
}

#[test]
fn equals_the_integral_where_it_runs_free() {
    let mut random = Random::new(700);
    for case in 0..300 {
        let mut b = some(&mut random);
        b.fade = if case & 1 == 0 { 0.0 } else { 0.3 };
        let (axis, length) = b.along();
        let aim = b.from + axis * random.range(0.3, 0.7) * length;
        let side = crate::math::normalize(crate::math::cross(axis, random.direction()));
        let d = crate::math::normalize(side + axis * random.range(-1.0, 1.0));
        let off = crate::math::cross(axis, side) * random.range(0.0, 2.0) * b.width;
        let o = aim + off - d * 6.0;
        let got = beam(&b, &packet(|| (o, d)), F::ZERO, INFINITY).x.as_array()[5];
        let want = integral(&b, o, d, 12.0);
        // The window takes exp(-9) off; fading changes across the beam's width.
        assert!((f64::from(got) - want).abs() < 2e-4 + 0.02 * want, "{b:?} {o:?} {d:?}: {got} not {want}");
    }
}

#[test]
fn ends_softly_where_the_ray_does() {
    let b = Beam { from: Vec3::NEG_X * 9.0, to: Vec3::X * 9.0, width: 0.2, colour: Vec3::ONE, fade: 0.0 };
    let (o, d) = (Vec3::Z * -4.0, Vec3::Z);
    let mut last = 0.0;
    for i in 0..60 {
        let end = 3.6 + 0.8 * i as f32 / 59.0;
        let got = beam(&b, &packet(|| (o, d)), F::ZERO, splat(end)).x.as_array()[0];
        let want = integral(&b, o, d, f64::from(end));
        assert!((f64::from(got) - want).abs() < 0.03, "end {end}: {got} not {want}");
        assert!(got >= last, "end {end}: falls");
        last = got;
    }
    assert!(last > 0.99);
}

#[test]
fn finite_for_every_ray_and_nothing_beyond_its_reach() {
    let mut random = Random::new(701);
    for case in 0..2_000 {
        let mut b = some(&mut random);
        if case & 1 == 0 {
            b.to = b.from;
        }
        let (axis, _) = b.along();
        let rays = packet(|| {
            let d = if random.one_in(4) { axis } else { random.direction() };
            (random.vector(-3, 3), if d == Vec3::ZERO { Vec3::X } else { d })
        });
        let end = splat(random.range(0.0, 9.0));
        let light = beam(&b, &rays, splat(0.01), end);
        for lane in 0..8 {
            let v = light.lane(lane);
            assert!((0.0..=101.0).contains(&v.x), "{b:?} {:?} {:?}: {v}", rays.origin, rays.direction);
            let same = beam(&b, &alone(&rays, lane), splat(0.01), end).lane(0);
            assert_eq!(v, same, "a lane depends on its packet: {b:?} {rays:?}", rays = rays.origin);
        }
        // Past everything: farther from all of the beam than its reach.
        let far = packet(|| (b.from + Vec3::Y * 50.0 + Vec3::Z * random.range(-5.0, 5.0), Vec3::X));
        assert_eq!(beam(&b, &far, F::ZERO, INFINITY), V3::ZERO, "{b:?}");
    }
}

#[test]
fn a_small_glow_does_not_twinkle_as_it_moves() {
    let mut random = Random::new(702);
    // A glow of less than the width of a pixel at its distance.
    let (distance, pixel) = (40.0, 0.02);
    let spread = splat(pixel / distance);
    for _ in 0..200 {
        let at = Vec3::new(random.range(0.0, pixel), random.range(0.0, pixel), distance);
        let glow = Beam { from: at, to: at, width: 0.8 * pixel, colour: Vec3::ONE, fade: 0.0 };
        let sum: f32 = (-6..=6)
            .flat_map(|y| (-6..=6).map(move |x| Vec3::new(x as f32 * pixel, y as f32 * pixel, distance)))
            .map(|to| {
                beam(&glow, &packet(|| (Vec3::ZERO, crate::math::normalize(to))), spread, INFINITY)
                    .x
                    .as_array()[0]
            })
            .sum();
        // The integral of exp(-q) - exp(-9) up to q = 9 over the pixels, times width / w.
        let w2 = 0.8 * 0.8 + 0.25_f32;
        let want = 0.8 * w2.sqrt() * std::f32::consts::PI * (1.0 - 10.0 * REST);
        assert!((sum / want - 1.0).abs() < 0.02, "{at}: {sum} not {want}");
    }
}
