//! Rays against shapes in f64, rounded once: for one ray that needs more than f32 has.
//!
//! The same arguments and results as the doors of the same names, within 1 ulp where those score up to 4, and hits just
//! where there are any: an eye 1 mm over a planet, a wire 1000 km away. Where the exact result all but cancels, as for
//! rays that begin on the surface, it is that of a shape changed by 2⁻⁵⁰ of sizes and distance. Axes and normals
//! count by their directions, whatever rounding left of their lengths. Formulas as in `trace`: discriminants factored from cross products, roots q/A and
//! C/q (Haines, Günther and Akenine-Möller, Ray Tracing Gems ch. 7; Kahan; own expansion for the cone).

use super::shapes::{Crossing, Ray, TriangleHit};
use glam::{DVec3, Vec3};

/// Where a line is inside a body, and by which parts it comes and goes.
type Span = ([f64; 2], [u32; 2]);

const NEVER: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];
const ALWAYS: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// a - b, before rounding.
fn sub(a: Vec3, b: Vec3) -> DVec3 {
    a.as_dvec3() - b.as_dvec3()
}

/// A crossing in front of the ray, if there is one.
fn ahead((t, part): Span) -> Option<Crossing> {
    let crossing =
        Crossing { enter: t[0] as f32, exit: t[1] as f32, enter_part: part[0], exit_part: part[1] };
    let first = crossing.first();
    (t[0] <= t[1] && first > 0.0 && first < f32::INFINITY).then_some(crossing)
}

/// Roots q/A and C/q of A t² + 2 B t + C, D = B² - AC at least 0.
fn roots(a: f64, b: f64, c: f64, d: f64) -> [f64; 2] {
    let q = -(b + d.sqrt().copysign(b));
    [q / a, if q == 0.0 { 0.0 } else { c / q }]
}

/// Where A t² + 2 B t + C <= 0 for A > 0.
fn between(a: f64, b: f64, c: f64, d: f64) -> [f64; 2] {
    if d.is_nan() || d < 0.0 {
        return NEVER;
    }
    let [x, y] = roots(a, b, c, d);
    [x.min(y), x.max(y)]
}

/// See [`sphere`](super::sphere).
pub fn sphere(ray: &Ray, centre: Vec3, radius: f32) -> Option<Crossing> {
    let (f, d, r) = (sub(ray.origin, centre), ray.direction.as_dvec3(), f64::from(radius));
    let (speed, off) = (d.length(), d.cross(f).length());
    let disc = (r * speed - off) * (r * speed + off);
    ahead((between(d.dot(d), f.dot(d), f.dot(f) - r * r, disc), [0; 2]))
}

/// See [`plane`](super::plane).
pub fn plane(ray: &Ray, point: Vec3, normal: Vec3) -> Option<f32> {
    let n = normal.as_dvec3();
    let t = (n.dot(sub(point, ray.origin)) / n.dot(ray.direction.as_dvec3())) as f32;
    (t > 0.0 && t < f32::INFINITY).then_some(t)
}

/// A ray about an axis, in lengths of that: heights and slopes of heights, and what lies across.
struct Axial {
    /// Distance along the ray to where it starts anew.
    start: f64,
    /// Height of its origin, and of where it starts anew.
    level: f64,
    height: f64,
    rise: f64,
    /// Direction × axis, and origin × axis.
    n: DVec3,
    m: DVec3,
    /// |n × m|.
    off: f64,
    axis: f64,
}

impl Axial {
    /// `anew` starts the ray where it is nearest to the reference: a cone's roots hang on how near that is.
    fn new(ray: &Ray, reference: Vec3, axis: Vec3, anew: bool) -> Self {
        let (f, d, a) = (sub(ray.origin, reference), ray.direction.as_dvec3(), axis.as_dvec3());
        let start = if anew { -f.dot(d) / d.dot(d) } else { 0.0 };
        let level = f.dot(a);
        let f = f + d * start;
        let (n, m) = (d.cross(a), f.cross(a));
        // Both are upright on the axis.
        let off = f.dot(n).abs() * a.length();
        Self { start, level, height: f.dot(a), rise: d.dot(a), n, m, off, axis: a.length() }
    }

    /// The interval `side`, cut by two heights.
    fn cut(&self, side: [f64; 2], range: [f32; 2]) -> Span {
        let side = side.map(|t| t + self.start);
        let [lo, hi] = range.map(|h| f64::from(h) * self.axis - self.level);
        let slab = if self.rise == 0.0 {
            if lo <= 0.0 && hi >= 0.0 { ALWAYS } else { NEVER }
        } else if self.rise > 0.0 {
            [lo / self.rise, hi / self.rise]
        } else {
            [hi / self.rise, lo / self.rise]
        };
        let (first, last) = if self.rise > 0.0 { (1, 2) } else { (2, 1) };
        let (enter, first) = if side[0] >= slab[0] { (side[0], 0) } else { (slab[0], first) };
        let (exit, last) = if side[1] <= slab[1] { (side[1], 0) } else { (slab[1], last) };
        ([enter, exit], [first, last])
    }
}

/// See [`cylinder`](super::cylinder).
pub fn cylinder(ray: &Ray, point: Vec3, axis: Vec3, radius: f32) -> Option<Crossing> {
    bar(ray, point, axis, radius, [f32::NEG_INFINITY, f32::INFINITY])
}

/// See [`capped_cylinder`](super::capped_cylinder).
pub fn capped_cylinder(ray: &Ray, base: Vec3, axis: Vec3, radius: f32, length: f32) -> Option<Crossing> {
    bar(ray, base, axis, radius, [0.0, length])
}

fn bar(ray: &Ray, base: Vec3, axis: Vec3, radius: f32, range: [f32; 2]) -> Option<Crossing> {
    let ray = Axial::new(ray, base, axis, false);
    let (a, r) = (ray.n.dot(ray.n), f64::from(radius) * ray.axis);
    let c = ray.m.dot(ray.m) - r * r;
    let side = if a == 0.0 {
        if c <= 0.0 { ALWAYS } else { NEVER }
    } else {
        let reach = r * a.sqrt();
        between(a, ray.n.dot(ray.m), c, (reach - ray.off) * (reach + ray.off))
    };
    ahead(ray.cut(side, range))
}

/// See [`cone`](super::cone).
pub fn cone(ray: &Ray, apex: Vec3, axis: Vec3, slope: f32) -> Option<Crossing> {
    capped_cone(ray, apex, axis, slope, [f32::NEG_INFINITY, f32::INFINITY])
}

/// See [`capped_cone`](super::capped_cone).
pub fn capped_cone(ray: &Ray, apex: Vec3, axis: Vec3, slope: f32, range: [f32; 2]) -> Option<Crossing> {
    let ray = Axial::new(ray, apex, axis, true);
    let k = f64::from(slope);
    let (rise, height) = (k * ray.rise, k * ray.height);
    let a = ray.n.dot(ray.n) - rise * rise;
    let b = ray.n.dot(ray.m) - rise * height;
    let c = ray.m.dot(ray.m) - height * height;
    let reach = (ray.n * height - ray.m * rise).length();
    let disc = (reach - ray.off) * (reach + ray.off);
    let up = ray.rise > 0.0;
    let side = if a > 0.0 {
        // Flat across the axis: between the roots, if these lie on this nappe.
        let [lo, hi] = between(a, b, c, disc);
        if ray.height + 0.5 * (lo + hi) * ray.rise >= 0.0 { [lo, hi] } else { NEVER }
    } else {
        // Steep: a root on each nappe; along the side the other one is at infinity.
        let [x, y] = if a < 0.0 { roots(a, b, c, disc.max(0.0)) } else { [-c / (2.0 * b); 2] };
        let own = if up { x.max(y) } else { x.min(y) };
        let misses = own.is_nan() || (a == 0.0 && ray.height + own * ray.rise < 0.0);
        match (misses, up) {
            (true, _) if b == 0.0 && c <= 0.0 && ray.height >= 0.0 => ALWAYS,
            (true, _) => NEVER,
            (_, true) => [own, f64::INFINITY],
            _ => [f64::NEG_INFINITY, own],
        }
    };
    // A tip needs no end.
    let from = if range[0] > 0.0 { range[0] } else { f32::NEG_INFINITY };
    ahead(ray.cut(side, [from, range[1]]))
}

/// See [`triangle`](super::triangle); a ray along an edge hits, one in the plane misses.
pub fn triangle(ray: &Ray, corners: [Vec3; 3]) -> Option<TriangleHit> {
    let d = ray.direction.as_dvec3();
    let [p, q, r] = corners;
    let [a, b, c] = corners.map(|p| sub(p, ray.origin));
    // Volumes over the edges, of one sign within.
    let volume = |from: Vec3, to: Vec3, at: DVec3| d.dot(sub(to, from).cross(at));
    let weights = [volume(q, r, b), volume(r, p, c), volume(p, q, a)];
    let sum = weights[0] + weights[1] + weights[2];
    let inside = weights.iter().all(|&w| w >= 0.0) || weights.iter().all(|&w| w <= 0.0);
    let n = sub(q, p).cross(sub(r, p));
    let t = (n.dot(a) / n.dot(d)) as f32;
    let hit = inside && sum != 0.0 && t > 0.0 && t < f32::INFINITY;
    hit.then(|| TriangleHit { t, weights: weights.map(|w| (w / sum) as f32) })
}

/// See [`slab`](super::slab).
pub fn slab(ray: &Ray, lo: Vec3, hi: Vec3) -> Option<[f32; 2]> {
    let (d, lo, hi) = (ray.direction.as_dvec3(), sub(lo, ray.origin), sub(hi, ray.origin));
    let (mut enter, mut exit) = (0.0_f64, f64::INFINITY);
    for i in 0..3 {
        let [near, far] = match d[i] {
            x if x > 0.0 => [lo[i] / x, hi[i] / x],
            x if x < 0.0 => [hi[i] / x, lo[i] / x],
            _ if lo[i] <= 0.0 && hi[i] >= 0.0 => ALWAYS,
            _ => NEVER,
        };
        (enter, exit) = (enter.max(near), exit.min(far));
    }
    let hit = enter <= exit * (1.0 + 4.0 * f64::EPSILON) && exit >= 0.0 && (enter as f32) < f32::INFINITY;
    hit.then_some([enter as f32, exit as f32])
}
