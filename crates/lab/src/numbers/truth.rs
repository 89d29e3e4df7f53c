//! What is true, in f64: nearest crossings in front of a ray with shapes grown by a skin. Flat ones grow
//! away from the ray, which keeps what lies in front there.
//!
//! Distances are formed about the point of the ray that is nearest to the shape, so that f64 has digits to
//! spare where f32 has none.

use super::real::Arguments;
use glam::{DVec2, DVec3};

const INF: f64 = f64::INFINITY;
const MISS: (f64, f64) = (INF, -INF);

fn v(x: &Arguments<f32>, at: usize) -> DVec3 {
    DVec3::new(x[at].into(), x[at + 1].into(), x[at + 2].into())
}

/// The nearest end of an interval that lies in front; NaN for none.
fn first((enter, exit): (f64, f64)) -> f64 {
    let t = if enter > 0.0 { enter } else { exit };
    if enter <= exit && t > 0.0 && t < INF { t } else { f64::NAN }
}

fn chord(f: DVec3, d: DVec3, r: f64) -> (f64, f64) {
    let speed = d.length();
    let nearest = -f.dot(d) / (speed * speed);
    let off = (f + d * nearest).length();
    let half = ((r - off) * (r + off)).sqrt() / speed;
    if r > 0.0 && half >= 0.0 { (nearest - half, nearest + half) } else { MISS }
}

pub fn sphere(x: &Arguments<f32>, skin: f64) -> f64 {
    first(chord(v(x, 0) - v(x, 6), v(x, 3), f64::from(x[9]) + skin))
}

pub fn plane(x: &Arguments<f32>, skin: f64) -> f64 {
    let n = v(x, 9).normalize();
    let along = n.dot(v(x, 3));
    let t = n.dot(v(x, 6) - v(x, 0)) / along + skin / along.abs();
    if along == 0.0 { f64::NAN } else { first((t, t)) }
}

fn slab_of(f: f64, d: f64, lo: f64, hi: f64) -> (f64, f64) {
    if lo > hi {
        return MISS;
    }
    if d == 0.0 {
        return if (lo..=hi).contains(&f) { (-INF, INF) } else { MISS };
    }
    let (a, b) = ((lo - f) / d, (hi - f) / d);
    (a.min(b), a.max(b))
}

fn side(x: &Arguments<f32>, skin: f64) -> (f64, f64) {
    let a = v(x, 9).normalize();
    let across = |v: DVec3| v - a * v.dot(a);
    let (f, d) = (across(v(x, 0) - v(x, 6)), across(v(x, 3)));
    let r = f64::from(x[12]) + skin;
    if d.length() < 1e-13 * v(x, 3).length() {
        return if f.length() <= r { (-INF, INF) } else { MISS };
    }
    chord(f, d, r)
}

pub fn cylinder(x: &Arguments<f32>, skin: f64) -> f64 {
    first(side(x, skin))
}

pub fn capped_cylinder(x: &Arguments<f32>, skin: f64) -> f64 {
    let a = v(x, 9).normalize();
    let f = (v(x, 0) - v(x, 6)).dot(a);
    let slab = slab_of(f, v(x, 3).dot(a), -skin, f64::from(x[13]) + skin);
    let side = side(x, skin);
    first((side.0.max(slab.0), side.1.min(slab.1)))
}

/// Convex where |across| - slope height is not positive: its zeros by bisection either side of the least value.
fn nappe(x: &Arguments<f32>, skin: f64) -> (f64, f64) {
    let (a, k) = (v(x, 9).normalize(), f64::from(x[12]));
    let apex = v(x, 6) - a * (skin * (1.0 + k * k).sqrt() / k);
    let f = v(x, 0) - apex;
    // The slope is rounded too.
    let k = k * (1.0 + (skin / (f.length() + 1e-30)).clamp(-5e-7, 5e-7));
    let split = |v: DVec3| (v.dot(a), v - a * v.dot(a));
    let ((h, f), (dh, d)) = (split(f), split(v(x, 3)));
    let length = v(x, 3).length();
    let g = |t: f64| (f + d * t).length() - k * (h + dh * t);
    let (speed, fall) = (d.length(), k * dh);
    let start = if speed > 0.0 { -f.dot(d) / (speed * speed) } else { 0.0 };
    let off = (f + d * start).length();
    let unit = (off + (h + dh * start).abs()) / length + 1e-12;
    let steps = |from: f64, sign: f64| {
        std::iter::successors(Some(1e-6), |s| Some(s * 2.0)).take(160).map(move |s| from + sign * unit * s)
    };
    let least = if fall.abs() < speed {
        start + fall * off / (speed * ((speed - fall) * (speed + fall)).sqrt())
    } else {
        steps(start, fall.signum()).find(|&t| g(t) < 0.0).unwrap_or(start)
    };
    if g(least) > 0.0 {
        return MISS;
    }
    let zero = |sign: f64| {
        let Some(mut outer) = steps(least, sign).find(|&t| g(t) > 0.0) else { return sign * INF };
        let mut inner = least;
        for _ in 0..110 {
            let middle = 0.5 * (inner + outer);
            if middle == inner || middle == outer {
                break;
            }
            if g(middle) > 0.0 { outer = middle } else { inner = middle }
        }
        inner
    };
    (zero(-1.0), zero(1.0))
}

pub fn cone(x: &Arguments<f32>, skin: f64) -> f64 {
    first(nappe(x, skin))
}

pub fn capped_cone(x: &Arguments<f32>, skin: f64) -> f64 {
    let a = v(x, 9).normalize();
    let f = (v(x, 0) - v(x, 6)).dot(a);
    let slab = slab_of(f, v(x, 3).dot(a), f64::from(x[13]) - skin, f64::from(x[14]) + skin);
    let side = nappe(x, skin);
    first((side.0.max(slab.0), side.1.min(slab.1)))
}

pub fn triangle(x: &Arguments<f32>, skin: f64) -> f64 {
    let (o, d) = (v(x, 0), v(x, 3));
    let corners = [v(x, 6), v(x, 9), v(x, 12)];
    let [a, b, c] = corners;
    let n = (b - a).cross(c - a).normalize_or_zero();
    let along = n.dot(d);
    let t = n.dot(a - o) / along + skin / along.abs();
    // A ray that may be parallel meets whatever grows.
    if along.abs() <= 5e-7 * d.length() {
        return if skin > 0.0 { 1.0 } else { f64::NAN };
    }
    let (x, y) = d.normalize().any_orthonormal_pair();
    let flat = corners.map(|p| DVec2::new((p - o).dot(x), (p - o).dot(y)));
    let distance = |p: DVec2, q: DVec2| (q - p).perp_dot(-p) / (q - p).length().max(1e-300);
    let sides = [distance(flat[0], flat[1]), distance(flat[1], flat[2]), distance(flat[2], flat[0])];
    let inside = sides.iter().all(|&x| x >= -skin) || sides.iter().all(|&x| x <= skin);
    if inside { first((t, t)) } else { f64::NAN }
}

/// Where the box is entered, 0 from within; NaN for a miss.
pub fn slab(x: &Arguments<f32>, skin: f64) -> f64 {
    let (mut enter, mut exit) = (0.0_f64, INF);
    for i in 0..3 {
        let (lo, hi) = (f64::from(x[6 + i]) - skin, f64::from(x[9 + i]) + skin);
        let (a, b) = slab_of(x[i].into(), x[3 + i].into(), lo, hi);
        (enter, exit) = (enter.max(a), exit.min(b));
    }
    if enter <= exit { enter } else { f64::NAN }
}
