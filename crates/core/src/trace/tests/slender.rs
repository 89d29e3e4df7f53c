//! Cylinder and cone against f64 where a few roundings decide: through tips, along ends and sides, and bodies
//! thinner than the grain of their place. The oracle is that of [`super::round`].

use super::round::{STREAMS, bar, frustum, judge_cone, judge_cylinder};
use crate::math::Vec3;
use crate::trace::check::{Random, Tally, packet, sweep};
use crate::trace::cone;

/// Far from the world's origin the middle of a thin body is rounded by more than the body is wide.
#[test]
fn thin_bodies_far_from_the_origin_are_hit() {
    let (mut bars, mut hats) = (Tally::new("thin bar, far"), Tally::new("thin cone, far"));
    sweep(1, 70, 10_000, |random| {
        let x = random.size(8, 20);
        let far = Vec3::new(x, random.range(-1.0, 1.0), random.range(-1.0, 1.0));
        // About as long as the grain of x.
        let height = (x.next_up() - x) * random.size(-3, 4);
        let (axis, size, k) = (random.direction(), height * random.size(-8, 0), random.size(-6, 0));
        let origin = far + random.direction() * (height * random.size(0, 8));
        let end = if random.one_in(2) { 0.01 } else { 0.99 };
        let direction = (axis * (height * end) - (origin - far)).normalize_or(axis);
        // Alone: a body is far if it is for all rays.
        let rays = packet(|| (origin, direction));
        judge_cylinder(&mut bars, &bar(far, axis, size, height), &rays);
        judge_cone(&mut hats, &frustum(far, axis, k, [0.0, height], [true; 2]), &rays);
    });
    assert!(bars.hits.min(hats.hits) > 50_000, "{} {} hits", bars.hits, hats.hits);
    bars.finish(4.0);
    hats.finish(4.0);
}

/// A line through the tip of a closed cone must not slip between side and end.
#[test]
fn rays_through_the_tip_hit() {
    let mut random = Random::new(20);
    for _ in 0..20_000 {
        let axis = random.direction();
        let apex = random.vector(-4, 8);
        let s = frustum(apex, axis, random.size(-3, 3), [0.0, 1.0], [random.one_in(2), true]);
        let rays = packet(|| {
            let side = axis.any_orthogonal_vector() * s.slope * random.range(-0.9, 0.9);
            let d = crate::math::normalize(axis + side) * if random.one_in(2) { 1.0 } else { -1.0 };
            (apex - d * random.size(-2, 4), d)
        });
        let (t, part) = cone(&rays, &s).first();
        let wrong = t.simd_le(crate::math::lanes::ZERO);
        assert!(!wrong.any(), "{s:?} {:?} {:?} {t:?} {part:?}", rays.origin, rays.direction);
    }
}

/// Within a few roundings of the plane of an end: does the ray rise through it, or fall?
#[test]
fn rays_along_an_end() {
    let mut bars = Tally::new("along a bar's end");
    let mut hats = Tally::new("along a cone's end");
    sweep(STREAMS, 50, 2_000, |random| {
        let (h, axis, k) = (random.size(-8, 8), random.direction(), random.size(-4, 4));
        let base = random.vector(-3, 6) * h;
        let bar = bar(base, axis, h * k, h);
        let hat = frustum(base, axis, k, [0.0, h], [true; 2]);
        let rays = packet(|| {
            let any = random.direction();
            let d = (any - axis * any.dot(axis)).normalize_or(axis.any_orthogonal_vector());
            let side = crate::math::cross(d, axis) * (h * k * random.range(-0.9, 0.9));
            let end = base + axis * if random.one_in(4) { 0.0 } else { h };
            (end + side - d * (h * k * random.signed(-6, 6)), d + axis * random.signed(-28, -22))
        });
        judge_cylinder(&mut bars, &bar, &rays);
        judge_cone(&mut hats, &hat, &rays);
    });
    assert!(bars.hits.min(hats.hits) > 10_000, "{} {} hits", bars.hits, hats.hits);
    bars.finish(4.0);
    hats.finish(4.0);
}

/// Within a few roundings of a line of the side, through the tip: on which side of it is the ray?
#[test]
fn rays_along_the_side_through_the_tip() {
    let mut tally = Tally::new("along a cone's side");
    sweep(STREAMS, 60, 2_000, |random| {
        let (h, axis, k) = (random.size(-8, 8), random.direction(), random.size(-6, 4));
        let end = if random.one_in(2) { f32::INFINITY } else { h };
        let s = frustum(random.vector(-3, 6) * h, axis, k, [0.0, end], [true; 2]);
        let rays = packet(|| {
            let any = random.direction();
            let out = (any - axis * any.dot(axis)).normalize_or(axis.any_orthogonal_vector());
            let d = crate::math::normalize(axis + out * k) + random.direction() * random.signed(-28, -22);
            let d = if random.one_in(2) { d } else { -d };
            (s.apex + d * (h * random.signed(-6, 6)), d)
        });
        judge_cone(&mut tally, &s, &rays);
    });
    assert!(tally.hits > 10_000, "{} hits", tally.hits);
    tally.finish(4.0);
}
