//! Fog against the f64 length inside the box; rays in faces and along edges.

use super::*;
use crate::math::Vec3;
use crate::math::lanes::{ZERO, splat};
use crate::trace::check::{Random, packet};

const BOX: Fog = Fog {
    density: 0.3,
    colour: Vec3::new(0.2, 0.4, 0.8),
    lo: Vec3::new(-1.0, 0.0, -2.0),
    hi: Vec3::new(3.0, 1.5, 2.0),
};

/// Length inside the box up to `t`, in f64.
fn length(o: Vec3, d: Vec3, t: f64) -> f64 {
    let (mut enter, mut exit) = (0.0_f64, t);
    for k in 0..3 {
        let (o, d) = (f64::from(o[k]), f64::from(d[k]));
        let (lo, hi) = (f64::from(BOX.lo[k]), f64::from(BOX.hi[k]));
        if d == 0.0 {
            if o < lo || o > hi {
                return 0.0;
            }
            continue;
        }
        let (a, b) = ((lo - o) / d, (hi - o) / d);
        (enter, exit) = (enter.max(a.min(b)), exit.min(a.max(b)));
    }
    (exit - enter).max(0.0)
}

#[test]
#[allow(clippy::disallowed_methods, reason = "an oracle in f64")]
fn transmittance_matches_the_length_inside() {
    let mut random = Random::new(400);
    let mut worst = 0.0_f64;
    for _ in 0..40_000 {
        let rays = packet(|| {
            let target = Vec3::new(random.range(-1.5, 3.5), random.range(-0.5, 2.0), random.range(-2.5, 2.5));
            let d = random.direction();
            (target - d * random.signed(-6, 6), d)
        });
        let t = random.size(-4, 8);
        let t = if random.one_in(4) { f32::INFINITY } else { t };
        let (through, light) = fog(&BOX, &rays, splat(t));
        for lane in 0..8 {
            let (o, d) = (rays.origin.lane(lane), rays.direction.lane(lane));
            let (got, light) = (f64::from(through.to_array()[lane]), light.lane(lane));
            let depth = length(o, d, t.into());
            let exact = (-depth * f64::from(BOX.density)).exp();
            let off = (got - exact).abs();
            worst = worst.max(off);
            assert!(off < 2e-6 * (1.0 + f64::from(o.length())), "{got} for {exact}: {o:?} {d:?} {t:?}");
            assert!((light - BOX.colour * (1.0 - got as f32)).abs().max_element() < 1e-6);
            if depth == 0.0 && length(o, d, 1e30) == 0.0 {
                assert!(got == 1.0 || off < 2e-6, "outside");
            }
        }
    }
    println!("fog: 320000 rays, worst {worst:e} off");
}

#[test]
fn rays_in_a_face_or_along_an_edge_are_no_numbers_astray() {
    let (lo, hi) = (BOX.lo, BOX.hi);
    for k in 0..3 {
        for face in [lo[k], hi[k]] {
            for (dk, zero) in [(1, 0.0), (1, -0.0), (2, 0.0), (2, -0.0)] {
                for sign in [1.0, -1.0] {
                    for other in [0.25, 0.0, 1.0] {
                        // Across face k runs nothing; the third coordinate may be on a face too.
                        let mut o = lo + (hi - lo) * other;
                        let mut d = Vec3::splat(zero);
                        o[k] = face;
                        d[(k + dk) % 3] = sign;
                        o[(k + dk) % 3] = -10.0 * sign;
                        for t in [1.0, 11.0, 100.0, f32::INFINITY] {
                            let (through, light) = fog(&BOX, &packet(|| (o, d)), splat(t));
                            let through = through.to_array()[0];
                            assert!((0.0..=1.0).contains(&through), "{through} {o:?} {d:?} {t:?}");
                            assert!(light.lane(0).is_finite());
                            if t == 1.0 {
                                assert_eq!(through, 1.0, "before the box");
                            }
                            if t > 20.0 {
                                assert!(through < 1.0, "the face belongs to the box: {o:?} {d:?}");
                            }
                        }
                    }
                }
            }
        }
    }
    let aside = packet(|| (Vec3::new(0.0, 5.0, -9.0), Vec3::Z));
    assert_eq!(fog(&BOX, &aside, splat(f32::INFINITY)).0, splat(1.0));
    assert_eq!(fog(&BOX, &aside, splat(f32::INFINITY)).1, V3::ZERO + V3::ZERO * ZERO);
}
