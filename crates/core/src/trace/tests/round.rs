//! Cylinder and cone against f64: side, caps, open ends, tips.
//!
//! The oracle's cylinder is the chord about the point nearest to the axis. Its cone is the set
//! where g(t) = |across| - k height is not positive: g is convex along a ray and positive on the
//! other nappe, so its two zeros are found by bisection either side of its least value. A cone
//! grows by a skin when its apex moves back by skin sqrt(1 + k²) / k. The way from the origin to
//! the shape counts twice in the skin, as the kernel also rounds the point where rays start anew.

use crate::math::Vec3;
use crate::scene::{Cone, Cylinder};
use crate::trace::check::{Inside, Line, Tally, U, packet, sweep};
use crate::trace::{Rays8, cone, cylinder};
use glam::DVec3;

/// 2^k.
fn double(k: i32) -> f64 {
    f64::from_bits(((1023 + k) as u64) << 52)
}

const INF: f64 = f64::INFINITY;

/// Streams that each law draws from.
pub(super) const STREAMS: u32 = 6;

/// A ray along and across an axis.
struct Axial {
    f: (f64, DVec3),
    d: (f64, DVec3),
}

impl Axial {
    fn new(ray: &Line, reference: DVec3, axis: DVec3) -> Self {
        let split = |v: DVec3| (v.dot(axis), v - axis * v.dot(axis));
        Axial { f: split(ray.o - reference), d: split(ray.d) }
    }

    /// Where the ray is between two heights.
    fn slab(&self, lo: f64, hi: f64) -> (f64, f64) {
        let ((f, _), (d, _)) = (self.f, self.d);
        if d == 0.0 || lo > hi {
            return if (lo..=hi).contains(&f) { (-INF, INF) } else { (INF, -INF) };
        }
        let (a, b) = ((lo - f) / d, (hi - f) / d);
        (a.min(b), a.max(b))
    }

    fn cylinder(&self, r: f64) -> (f64, f64) {
        let ((_, f), (_, d)) = (self.f, self.d);
        let speed = d.length();
        if speed < 1e-13 * self.length() {
            return if f.length() <= r { (-INF, INF) } else { (INF, -INF) };
        }
        let nearest = -f.dot(d) / (speed * speed);
        let off = (f + d * nearest).length();
        let half = ((r - off) * (r + off)).sqrt() / speed;
        if r > 0.0 && half >= 0.0 { (nearest - half, nearest + half) } else { (INF, -INF) }
    }

    fn cone(&self, k: f64) -> (f64, f64) {
        let ((h, f), (dh, d)) = (self.f, self.d);
        let g = |t: f64| (f + d * t).length() - k * (h + dh * t);
        let (speed, fall) = (d.length(), k * dh);
        let start = if speed > 0.0 { -f.dot(d) / (speed * speed) } else { 0.0 };
        let unit = ((f + d * start).length() + (h + dh * start).abs()) / self.length() + 1e-12;
        let least = if fall.abs() < speed {
            let off = (f + d * start).length();
            start + fall * off / (speed * ((speed - fall) * (speed + fall)).sqrt())
        } else {
            // No least value: g falls for ever this way. Look far.
            let far = (0..200).map(|i| start + fall.signum() * unit * double(i));
            far.into_iter().find(|&t| g(t) < 0.0).unwrap_or(start)
        };
        if g(least) > 0.0 {
            return (INF, -INF);
        }
        let side = |sign: f64| {
            let far = (0..140).map(|i| least + sign * unit * double(i - 20));
            let Some(mut outer) = far.into_iter().find(|&t| g(t) > 0.0) else { return sign * INF };
            let mut inner = least;
            for _ in 0..120 {
                let middle = 0.5 * (inner + outer);
                if middle == inner || middle == outer {
                    break;
                }
                if g(middle) > 0.0 { outer = middle } else { inner = middle }
            }
            inner
        };
        (side(-1.0), side(1.0))
    }

    fn length(&self) -> f64 {
        (self.d.0 * self.d.0 + self.d.1.length_squared()).sqrt()
    }

    /// The body: side and slab together.
    fn cut(&self, side: (f64, f64), slab: (f64, f64)) -> Option<Inside> {
        let forward = self.d.0 > 0.0;
        let (first, last) = if forward { (1, 2) } else { (2, 1) };
        let (enter, first) = if side.0 >= slab.0 { (side.0, 0) } else { (slab.0, first) };
        let (exit, last) = if side.1 <= slab.1 { (side.1, 0) } else { (slab.1, last) };
        (enter <= exit).then_some(Inside { t: [enter, exit], part: [first, last] })
    }
}

fn cylinder_truth(s: &Cylinder, ray: &Line, [skin, ends, _]: [f64; 3]) -> Option<Inside> {
    let a = Axial::new(ray, s.base.as_dvec3(), s.axis.as_dvec3().normalize());
    let length = f64::from(s.length);
    let lo = if length < INF { -ends } else { -INF };
    a.cut(a.cylinder(f64::from(s.radius) + skin), a.slab(lo, length + ends))
}

fn cone_truth(s: &Cone, ray: &Line, [skin, ends, slope]: [f64; 3]) -> Option<Inside> {
    let k = f64::from(s.slope);
    let axis = s.axis.as_dvec3().normalize();
    let [lo, hi] = s.range.map(f64::from);
    let plain = Axial::new(ray, s.apex.as_dvec3(), axis);
    let lo = if lo > 0.0 { lo - ends } else { -INF };
    // The slope is rounded too.
    let reach = (plain.f.0 * plain.f.0 + plain.f.1.length_squared()).sqrt() + 1e-30;
    let wider = k * (1.0 + (slope / reach).clamp(-8.0 * U, 8.0 * U));
    let grown = Axial::new(ray, s.apex.as_dvec3() - axis * (skin * (1.0 + k * k).sqrt() / k), axis);
    plain.cut(grown.cone(wider), plain.slab(lo, hi + ends))
}

/// What the oracle's own rounding needs at least, at a point of the surface itself.
fn own(reference: Vec3) -> f64 {
    1e-6 * reference.as_dvec3().length() + 1e-30
}

fn finite(x: f32) -> f64 {
    if x < f32::INFINITY { f64::from(x) } else { 0.0 }
}

pub(super) fn judge_cylinder(tally: &mut Tally, s: &Cylinder, rays: &Rays8) {
    let size = f64::from(s.radius) + finite(s.length) + own(s.base);
    let reach = |ray: &Line| 2.0 * (ray.o - s.base.as_dvec3()).length() + size;
    tally.body(rays, &cylinder(rays, s), |ray, skin| cylinder_truth(s, ray, skin), reach, [false; 2], s);
}

pub(super) fn judge_cone(tally: &mut Tally, s: &Cone, rays: &Rays8) {
    let size = finite(s.range[1]).max(f64::from(s.range[0])) + own(s.apex);
    let reach = |ray: &Line| 2.0 * (ray.o - s.apex.as_dvec3()).length() + size;
    let open = [s.range[0] > 0.0 && !s.caps[0], !s.caps[1]];
    tally.body(rays, &cone(rays, s), |ray, skin| cone_truth(s, ray, skin), reach, open, s);
}

pub(super) fn bar(base: Vec3, axis: Vec3, radius: f32, length: f32) -> Cylinder {
    Cylinder { base, axis, radius, length, material: 0 }
}

pub(super) fn frustum(apex: Vec3, axis: Vec3, slope: f32, range: [f32; 2], caps: [bool; 2]) -> Cone {
    Cone { apex, axis, slope, range, caps, material: 0 }
}

#[test]
fn named_cylinders() {
    let v = Vec3::new;
    let (tall, short) = (bar(Vec3::ZERO, Vec3::Y, 1.0, f32::INFINITY), bar(Vec3::ZERO, Vec3::Y, 1.0, 2.0));
    let cases = [
        // Nearly along the axis: the naive leading coefficient is 0.
        (tall, v(0.5, -1e4, 0.0), v(1e-4, 1.0, 3e-5)),
        (tall, v(0.0, 0.0, 0.0), v(1e-6, 1.0, 0.0)),
        (short, v(0.3, -1e4, 0.2), v(1e-6, 1.0, 0.0)),
        (short, v(1.0, -5.0, 0.0), Vec3::Y),
        (short, v(1.0_f32.next_up(), -5.0, 0.0), Vec3::Y),
        (short, v(0.5, -5.0, 0.0), Vec3::Y),
        (short, v(0.5, 1.0, 0.0), Vec3::Y),
        (short, v(2.0, -5.0, 0.0), Vec3::Y),
        // Far and thin.
        (tall, v(0.5, 0.0, -1e4), Vec3::Z),
        (bar(Vec3::ZERO, v(0.6, 0.8, 0.0), 1e-4, f32::INFINITY), v(0.0, 0.0, -1.0), Vec3::Z),
        // Tangent.
        (tall, v(1.0, 0.0, -3.0), Vec3::Z),
        (tall, v(1.0_f32.next_up(), 0.0, -3.0), Vec3::Z),
        // In a cap's plane, on the rim, on a cap, inside.
        (short, v(0.0, 0.0, -3.0), Vec3::Z),
        (short, v(0.0, 2.0, -3.0), Vec3::Z),
        (short, v(0.0, -0.0, -3.0), Vec3::Z),
        (short, v(0.0, 2.0_f32.next_up(), -3.0), Vec3::Z),
        (short, v(0.0, 3.0, 0.0), v(1.0, -1.0, 0.0)),
        (short, v(0.0, 2.0, 0.0), Vec3::Y),
        (short, v(0.0, 2.0, 0.0), -Vec3::Y),
        (short, v(0.2, 1.0, 0.1), v(-0.0, -1.0, 0.0)),
        (short, v(0.0, 1.0, 0.0), Vec3::X),
        // Along the side.
        (short, v(1.0, 3.0, 0.0), -Vec3::Y),
        (tall, v(1.0, 3.0, 0.0), -Vec3::Y),
    ];
    // Along the side: shrunk by a skin, what is left is at an end. And touching the side at an end.
    let axis = v(0.20928396, -0.9658429, 0.15279998);
    let flat = bar(v(3565.486, -18967.828, 14171.789), axis, 13.926331, 0.46465);
    let axis = v(-0.79116005, 0.52380025, 0.31575176);
    let thin = bar(v(0.0011370152, -0.00079557777, 0.0009887462), axis, 0.013257507, 2.1698549);
    let axis = v(-0.0035143457, -0.83607215, 0.54860824);
    let coin = bar(v(0.040982712, 0.0071745855, 0.045582507), axis, 0.0078031067, 0.0067182947);
    let found = [
        (coin, v(0.03604156, 0.6500545, -0.45906663), v(0.0035017936, 0.7865916, -0.61746377)),
        (flat, v(3552.4556, -18970.068, 14176.164), v(-0.01991356, 0.09190083, -0.014539057)),
        (thin, v(-1.6732647, 1.1226677, 0.67694706), v(-0.79079795, 0.5133425, 0.33334374)),
    ];
    let mut tally = Tally::new("cylinder, named");
    for (s, o, d) in cases.into_iter().chain(found) {
        judge_cylinder(&mut tally, &s, &packet(|| (o, d)));
    }
    tally.finish(4.0);
}

#[test]
fn a_ray_in_a_caps_plane_hits_the_closed_bar() {
    let s = bar(Vec3::ZERO, Vec3::Y, 1.0, 2.0);
    for y in [0.0, -0.0, 2.0] {
        let span = cylinder(&packet(|| (Vec3::new(0.0, y, -3.0), Vec3::Z)), &s);
        assert_eq!((span.enter.to_array()[0], span.exit.to_array()[0]), (2.0, 4.0));
    }
}

#[test]
fn random_cylinders() {
    for kind in 0..2 {
        let mut tally = Tally::new(["finite cylinder", "infinite cylinder"][kind as usize]);
        sweep(STREAMS, 10 + kind, 8_000, |random| {
            let r = random.size(-14, 14);
            let length = r * random.size(-7, 9);
            let axis = random.direction();
            let base = random.vector(-3, 12) * r;
            let s = bar(base, axis, r, if kind == 1 { f32::INFINITY } else { length });
            let rays = packet(|| {
                let any = random.direction();
                let n = (any - axis * any.dot(axis)).normalize_or(axis.any_orthogonal_vector());
                let lift = 1.0 + if random.one_in(2) { random.signed(-20, 1) } else { 0.0 };
                let height = match random.bits() % 4 {
                    0 => 0.0,
                    1 => length,
                    _ => length * random.range(-0.1, 1.1),
                };
                let inwards = if random.one_in(3) { random.range(0.0, 1.0) } else { 1.0 };
                random.ray(s.base + axis * height + n * (r * lift * inwards), n, axis, r)
            });
            judge_cylinder(&mut tally, &s, &rays);
        });
        assert!(tally.hits > 100_000, "{} hits", tally.hits);
        tally.finish(4.0);
    }
}

#[test]
fn named_cones() {
    let v = Vec3::new;
    let inf = f32::INFINITY;
    let right = frustum(Vec3::ZERO, Vec3::Y, 1.0, [0.0, inf], [true; 2]);
    let hat = frustum(Vec3::ZERO, Vec3::Y, 1.0, [0.0, 2.0], [false, true]);
    let horn = frustum(Vec3::ZERO, Vec3::Y, 0.5, [1.0, 3.0], [false; 2]);
    let needle = frustum(Vec3::ZERO, Vec3::Y, 0.01, [0.0, inf], [true; 2]);
    let cases = [
        // Parallel to a generator: outside, inside, along it, and past it in its tangent plane.
        (right, v(0.0, 2.0, 0.0), v(1.0, -1.0, 0.0)),
        (right, v(-3.0, 1.0, 0.0), v(1.0, -1.0, 0.0)),
        (right, v(-3.0, 5.0, 0.0), v(1.0, 1.0, 0.0)),
        (hat, v(0.0, 0.0, 1.0), v(1.0, 1.0, 0.0)),
        (hat, v(-1.0, -1.0, 1.0), v(1.0, 1.0, 0.0)),
        (hat, v(0.0, 0.0, 0.25), v(-1.0, -1.0, 0.0)),
        (hat, v(3.0, 3.0, 0.0), v(-1.0, -1.0, 0.0)),
        (right, v(1.0, 1.0, 0.0), v(1.0, 1.0, 0.0)),
        // Thin and far, near the apex.
        (needle, v(0.01, 3.0, -100.0), Vec3::Z),
        (needle, v(0.0, 1e-4, -100.0), Vec3::Z),
        (right, v(0.0, 1e-6, -3.0), Vec3::Z),
        (right, v(1e-6, -1.0, 0.0), Vec3::Y),
        (hat, v(0.0, -1.0, 0.0), Vec3::Y),
        (hat, v(0.0, 1.0, 0.0), -Vec3::Y),
        (hat, v(0.0, -3.0, 1e-7), Vec3::Y),
        // The other nappe.
        (right, v(0.0, -2.0, -5.0), Vec3::Z),
        (right, v(0.0, -2.0, -5.0), v(0.0, -0.5, 1.0)),
        (right, v(-5.0, -2.0, 0.0), v(1.0, 0.2, 0.0)),
        // Caps and open ends.
        (hat, v(0.5, 5.0, 0.0), -Vec3::Y),
        (hat, v(0.5, 1.0, 0.0), Vec3::Y),
        (horn, v(0.0, -5.0, 0.0), Vec3::Y),
        (horn, v(0.3, 0.0, 0.0), v(0.3, 1.0, 0.0)),
        (horn, v(0.0, 5.0, 0.0), v(0.6, -1.5, 0.0)),
        (horn, v(-5.0, 2.0, 0.0), Vec3::X),
        (horn, v(0.0, 2.0, 0.0), v(1.0, 2.0, 0.0)),
        (hat, v(0.0, 2.0, -5.0), Vec3::Z),
        (right, v(0.0, 0.0, -5.0), v(-0.0, -0.0, 1.0)),
    ];
    let mut tally = Tally::new("cone, named");
    for (s, o, d) in cases {
        judge_cone(&mut tally, &s, &packet(|| (o, d)));
    }
    // Behind the eye, along the side and so near to the tip that it is the point where the ray starts anew.
    let closed = |tip, axis, slope, height| frustum(tip, axis, slope, [0.0, height], [true; 2]);
    let (tip, axis) = (v(0.04178075, 0.016215187, -0.017201947), v(0.4068821, 0.8525499, 0.32803312));
    let wide = closed(tip, axis, 0.53960305, 0.2010007);
    let (tip, axis) = (v(0.16525917, 0.1712711, -0.27430025), v(-0.30176482, -0.46102563, 0.8345019));
    let narrow = closed(tip, axis, 0.056435302, 0.05745146);
    let (tip, axis) = (v(0.017124727, 0.0011533848, 0.04188322), v(-0.34166944, 0.9151274, -0.21401855));
    let needle = closed(tip, axis, 0.011243525, 0.01203541);
    let found = [
        (wide, v(5.910433, 9.069986, -1.579223), v(0.53831387, 0.83047533, -0.14327952)),
        (narrow, v(16.881786, 21.10251, -43.041744), v(0.33125666, 0.41477588, -0.8474846)),
        (needle, v(0.09109461, -0.1902167, 0.08686154), v(0.35216928, -0.9111095, 0.21414098)),
    ];
    for (s, o, d) in found {
        judge_cone(&mut tally, &s, &packet(|| (o, d)));
    }
    tally.finish(4.0);
}

#[test]
fn random_cones() {
    for kind in 0..4 {
        let names = ["infinite cone", "pointed cone", "frustum, closed", "frustum, open"];
        let mut tally = Tally::new(names[kind as usize]);
        sweep(STREAMS, 30 + kind, 4_000, |random| {
            let h = random.size(-14, 14);
            let axis = random.direction();
            let k = random.size(-7, 4);
            let from = if kind < 2 { 0.0 } else { h * random.range(0.0, 0.99) };
            let caps = match kind {
                3 => [[false, false], [false, true], [true, false]][random.bits() as usize % 3],
                _ => [true; 2],
            };
            let range = [from, if kind == 0 { f32::INFINITY } else { h }];
            let s = frustum(random.vector(-3, 10) * h, axis, k, range, caps);
            let rays = packet(|| {
                let any = random.direction();
                let out = (any - axis * any.dot(axis)).normalize_or(axis.any_orthogonal_vector());
                let height = match random.bits() % 5 {
                    0 => from,
                    1 => h,
                    2 => h * random.signed(-20, 0),
                    _ => from + (h - from) * random.range(-0.1, 1.1),
                };
                let lift = 1.0 + if random.one_in(2) { random.signed(-20, 1) } else { 0.0 };
                let inwards = if random.one_in(3) { random.range(0.0, 1.0) } else { 1.0 };
                let target = s.apex + axis * height + out * (height * k * lift * inwards);
                let along = if random.one_in(2) { axis } else { crate::math::normalize(axis + out * k) };
                random.ray(target, crate::math::normalize(out - axis * k), along, h * k.min(1.0))
            });
            judge_cone(&mut tally, &s, &rays);
        });
        assert!(tally.hits > 50_000, "{} hits", tally.hits);
        tally.finish(4.0);
    }
}
