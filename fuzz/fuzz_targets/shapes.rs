//! A ray of any bits against each shape of any bits: no panic, no hit at NaN, order of the crossings, and a
//! hit on a sane ball lies on it.
#![no_main]

use glam::Vec3;
use libfuzzer_sys::fuzz_target;
use luc_core::kernels::{self, Crossing, Ray, wide};

/// The floats that the bytes hold, zeros after them.
fn floats(data: &[u8]) -> [f32; 20] {
    let mut all = [0.0; 20];
    for (to, from) in all.iter_mut().zip(data.chunks_exact(4)) {
        *to = f32::from_le_bytes([from[0], from[1], from[2], from[3]]);
    }
    all
}

fn sound(name: &str, crossing: Option<Crossing>) {
    if let Some(c) = crossing {
        let t = c.first();
        assert!(!c.enter.is_nan() && !c.exit.is_nan() && t > 0.0 && t < f32::INFINITY, "{name}: {c:?}");
        assert!(c.enter <= c.exit || c.exit == -1.0, "{name}: {c:?}");
    }
}

fuzz_target!(|data: &[u8]| {
    let x = floats(data);
    let v = |at: usize| Vec3::new(x[at], x[at + 1], x[at + 2]);
    let ray = Ray { origin: v(0), direction: v(3) };
    let axis = v(9).normalize_or(Vec3::Y);
    let ball = kernels::sphere(&ray, v(6), x[12]);
    sound("sphere", ball);
    sound("cylinder", kernels::cylinder(&ray, v(6), axis, x[12]));
    sound("capped cylinder", kernels::capped_cylinder(&ray, v(6), axis, x[12], x[13]));
    sound("cone", kernels::cone(&ray, v(6), axis, x[12]));
    sound("capped cone", kernels::capped_cone(&ray, v(6), axis, x[12], [x[13], x[14]]));
    sound("sphere in f64", wide::sphere(&ray, v(6), x[12]));
    sound("cylinder in f64", wide::cylinder(&ray, v(6), axis, x[12]));
    sound("capped cylinder in f64", wide::capped_cylinder(&ray, v(6), axis, x[12], x[13]));
    sound("cone in f64", wide::cone(&ray, v(6), axis, x[12]));
    sound("capped cone in f64", wide::capped_cone(&ray, v(6), axis, x[12], [x[13], x[14]]));
    assert!(wide::triangle(&ray, [v(6), v(9), v(12)]).is_none_or(|h| h.t > 0.0 && h.t < f32::INFINITY));
    assert!(wide::slab(&ray, v(6), v(9)).is_none_or(|t| !t[0].is_nan() && !t[1].is_nan()));
    assert!(kernels::plane(&ray, v(6), axis).is_none_or(|t| t > 0.0 && t < f32::INFINITY));
    assert!(kernels::triangle(&ray, [v(6), v(9), v(12)]).is_none_or(|h| h.t > 0.0 && h.t < f32::INFINITY));
    assert!(kernels::slab(&ray, v(6), v(9)).is_none_or(|t| !t[0].is_nan() && !t[1].is_nan()));

    // Within the range that squares allow, a hit is near the ball.
    let sane = |x: f32| x == 0.0 || (1e-6..1e6).contains(&x.abs());
    if let (Some(found), true) = (ball, x[..9].iter().all(|&x| sane(x)) && (1e-4..1e6).contains(&x[12])) {
        let exact = |v: Vec3| v.to_array().map(f64::from);
        let (o, d, c) = (exact(ray.origin), exact(ray.direction), exact(v(6)));
        let t = f64::from(found.first());
        let length = |v: [f64; 3]| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        let off = length([0, 1, 2].map(|i| o[i] + d[i] * t - c[i]));
        let reach = length([0, 1, 2].map(|i| o[i] - c[i])) + f64::from(x[12]) + t.abs() * length(d);
        assert!((off - f64::from(x[12])).abs() <= 64.0 / 16_777_216.0 * reach, "{ray:?} {found:?}");
    }
});
