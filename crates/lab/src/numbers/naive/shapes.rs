//! Shapes and the quadratic, by the discriminants as they stand, and Möller and Trumbore's triangle.

use crate::numbers::real::{Arguments, Real, cross, dot, sub, vector};

fn square<R: Real>(x: R) -> R {
    x * x
}

/// The lesser of two distances that is over 0; NaN if neither.
fn nearest<R: Real>(t0: R, t1: R) -> R {
    let nan = R::of(f64::NAN);
    let least = R::of(1e-45).max(R::of(f64::MIN_POSITIVE));
    let behind = (t1 - least).pick(t1, nan);
    (t0 - least).pick(t0, behind)
}

/// Roots of a t² + 2 b t + c by the formula as it stands.
fn roots<R: Real>(a: R, b: R, c: R) -> (R, R) {
    let root = (b * b - a * c).sqrt();
    ((-b - root) / a, (root - b) / a)
}

/// Origin, direction, centre, radius.
pub fn sphere<R: Real>(x: &Arguments<R>) -> R {
    let (d, f) = (vector(x, 3), sub(vector(x, 0), vector(x, 6)));
    let (t0, t1) = roots(dot(d, d), dot(f, d), dot(f, f) - square(x[9]));
    nearest(t0, t1)
}

/// Origin, direction, point, normal.
pub fn plane<R: Real>(x: &Arguments<R>) -> R {
    let n = vector(x, 9);
    let t = (dot(n, vector(x, 6)) - dot(n, vector(x, 0))) / dot(n, vector(x, 3));
    nearest(t, t)
}

/// Origin, direction, point, axis, radius.
pub fn cylinder<R: Real>(x: &Arguments<R>) -> R {
    let (d, f, a) = (vector(x, 3), sub(vector(x, 0), vector(x, 6)), vector(x, 9));
    let (da, fa) = (dot(d, a), dot(f, a));
    let (t0, t1) = roots(dot(d, d) - da * da, dot(d, f) - da * fa, dot(f, f) - fa * fa - square(x[12]));
    nearest(t0, t1)
}

/// The same, and the length: the ends are two planes.
pub fn capped_cylinder<R: Real>(x: &Arguments<R>) -> R {
    let (d, f, a) = (vector(x, 3), sub(vector(x, 0), vector(x, 6)), vector(x, 9));
    let (da, fa) = (dot(d, a), dot(f, a));
    let (t0, t1) = roots(dot(d, d) - da * da, dot(d, f) - da * fa, dot(f, f) - fa * fa - square(x[12]));
    let (nan, zero) = (R::of(f64::NAN), R::of(0.0));
    let on_side = |t: R| {
        let h = fa + t * da;
        h.pick((x[13] - h).pick(t, nan), nan)
    };
    let on_cap = |h: R| {
        let t = (h - fa) / da;
        let away = [f[0] + d[0] * t - a[0] * h, f[1] + d[1] * t - a[1] * h, f[2] + d[2] * t - a[2] * h];
        (square(x[12]) - dot(away, away)).pick(t, nan)
    };
    let all = [on_side(t0), on_side(t1), on_cap(zero), on_cap(x[13])];
    let far = R::of(f64::INFINITY);
    let best = all.into_iter().fold(far, |best, t| nearest(t, t).min(best));
    (R::of(3e38) - best).pick(best, nan)
}

/// Origin, direction, apex, axis, slope.
pub fn cone<R: Real>(x: &Arguments<R>) -> R {
    let (d, f, a) = (vector(x, 3), sub(vector(x, 0), vector(x, 6)), vector(x, 9));
    let cos2 = R::of(1.0) / (R::of(1.0) + square(x[12]));
    let (da, fa) = (dot(d, a), dot(f, a));
    let (t0, t1) = roots(da * da - cos2 * dot(d, d), da * fa - cos2 * dot(d, f), fa * fa - cos2 * dot(f, f));
    let nan = R::of(f64::NAN);
    let own = |t: R| (fa + t * da).pick(t, nan);
    let (t0, t1) = (own(t0), own(t1));
    let (t0, t1) = (nearest(t0, t0), nearest(t1, t1));
    t0.min(t1).min(t0)
}

/// The same, and the heights of the ends.
pub fn capped_cone<R: Real>(x: &Arguments<R>) -> R {
    let (d, f, a) = (vector(x, 3), sub(vector(x, 0), vector(x, 6)), vector(x, 9));
    let cos2 = R::of(1.0) / (R::of(1.0) + square(x[12]));
    let (da, fa) = (dot(d, a), dot(f, a));
    let (t0, t1) = roots(da * da - cos2 * dot(d, d), da * fa - cos2 * dot(d, f), fa * fa - cos2 * dot(f, f));
    let nan = R::of(f64::NAN);
    let on_side = |t: R| {
        let h = fa + t * da;
        (h - x[13]).pick((x[14] - h).pick(t, nan), nan)
    };
    let on_cap = |h: R| {
        let t = (h - fa) / da;
        let away = [f[0] + d[0] * t - a[0] * h, f[1] + d[1] * t - a[1] * h, f[2] + d[2] * t - a[2] * h];
        (square(x[12] * h) - dot(away, away)).pick(t, nan)
    };
    let all = [on_side(t0), on_side(t1), on_cap(x[13]), on_cap(x[14])];
    let far = R::of(f64::INFINITY);
    let best = all.into_iter().fold(far, |best, t| nearest(t, t).min(best));
    (R::of(3e38) - best).pick(best, nan)
}

/// Origin, direction, three corners: Möller and Trumbore.
pub fn triangle<R: Real>(x: &Arguments<R>) -> R {
    let (o, d, a) = (vector(x, 0), vector(x, 3), vector(x, 6));
    let (e1, e2) = (sub(vector(x, 9), a), sub([x[12], x[13], x[14]], a));
    let p = cross(d, e2);
    let det = dot(e1, p);
    let s = sub(o, a);
    let u = dot(s, p) / det;
    let q = cross(s, e1);
    let v = dot(d, q) / det;
    let t = dot(e2, q) / det;
    let nan = R::of(f64::NAN);
    let inside = u.min(v).min(R::of(1.0) - u - v);
    let t = inside.pick(t, nan);
    let t = (det.abs() - R::of(1e-7)).pick(t, nan);
    nearest(t, t)
}

/// Origin, direction, least corner, greatest corner.
pub fn slab<R: Real>(x: &Arguments<R>) -> R {
    let (mut enter, mut exit) = (R::of(0.0), R::of(f64::INFINITY));
    for i in 0..3 {
        let inverse = R::of(1.0) / x[3 + i];
        let (a, b) = ((x[6 + i] - x[i]) * inverse, (x[9 + i] - x[i]) * inverse);
        enter = a.min(b).max(enter);
        exit = a.max(b).min(exit);
    }
    (exit - enter).pick(enter, R::of(f64::NAN))
}

/// a, b, c: the greater root.
pub fn quadratic<R: Real>(x: &Arguments<R>) -> R {
    let root = (x[1] * x[1] - R::of(4.0) * x[0] * x[2]).sqrt();
    let (t0, t1) = ((-x[1] - root) / (x[0] + x[0]), (root - x[1]) / (x[0] + x[0]));
    t0.max(t1)
}

/// a, b, c, d: ab - cd.
pub fn products<R: Real>(x: &Arguments<R>) -> R {
    x[0] * x[1] - x[2] * x[3]
}
