//! The formulas as textbooks have them, for comparison only: what they lose is seen beside the engine's.
//!
//! Each takes its arguments in the order that `cases` gives, and returns one number: for shapes the
//! nearest crossing in front of the ray, NaN for none.

use super::real::{Arguments, Real, cross, dot, sub, vector};

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

/// Cosine, alpha.
pub fn ggx<R: Real>(x: &Arguments<R>) -> R {
    let a2 = x[1] * x[1];
    let d = x[0] * x[0] * (a2 - R::of(1.0)) + R::of(1.0);
    a2 / (R::of(core::f64::consts::PI) * d * d)
}

/// Normal, half vector, alpha.
pub fn ggx_vectors<R: Real>(x: &Arguments<R>) -> R {
    let mut y = *x;
    (y[0], y[1]) = (dot(vector(x, 0), vector(x, 3)), x[6]);
    ggx(&y)
}

fn lambda<R: Real>(cos: R, alpha: R) -> R {
    let tan2 = (R::of(1.0) - cos * cos) / (cos * cos);
    ((R::of(1.0) + alpha * alpha * tan2).sqrt() - R::of(1.0)) * R::of(0.5)
}

/// Cosine, alpha.
pub fn smith_g1<R: Real>(x: &Arguments<R>) -> R {
    R::of(1.0) / (R::of(1.0) + lambda(x[0], x[1]))
}

/// Two cosines, alpha.
pub fn smith_g2<R: Real>(x: &Arguments<R>) -> R {
    R::of(1.0) / (R::of(1.0) + lambda(x[0], x[2]) + lambda(x[1], x[2]))
}

/// Cosine, rms slope.
pub fn beckmann<R: Real>(x: &Arguments<R>) -> R {
    let (c2, m2) = (x[0] * x[0], x[1] * x[1]);
    (-((R::of(1.0) - c2) / (c2 * m2))).exp() / (R::of(core::f64::consts::PI) * m2 * c2 * c2)
}

/// f0, cosine.
pub fn schlick<R: Real>(x: &Arguments<R>) -> R {
    let m = R::of(1.0) - x[1];
    x[0] + (R::of(1.0) - x[0]) * (m * m * m * m * m)
}

/// Cosine, n_i, n_t.
pub fn fresnel<R: Real>(x: &Arguments<R>) -> R {
    let one = R::of(1.0);
    let eta = x[1] / x[2];
    let k = one - eta * eta * (one - x[0] * x[0]);
    let cos_t = k.sqrt();
    let s = (x[1] * x[0] - x[2] * cos_t) / (x[1] * x[0] + x[2] * cos_t);
    let p = (x[2] * x[0] - x[1] * cos_t) / (x[2] * x[0] + x[1] * cos_t);
    k.pick((s * s + p * p) * R::of(0.5), one)
}

/// Direction, normal, eta: the way that the refracted ray goes into the surface.
pub fn refract<R: Real>(x: &Arguments<R>) -> R {
    let (d, n) = (vector(x, 0), vector(x, 3));
    let cos = dot(d, n);
    let k = R::of(1.0) - x[6] * x[6] * (R::of(1.0) - cos * cos);
    let root = k.sqrt();
    let t = [0, 1, 2].map(|i| x[6] * d[i] - (x[6] * cos + root) * n[i]);
    dot(t, n)
}

/// Cosine, g.
pub fn phase<R: Real>(x: &Arguments<R>) -> R {
    let g2 = x[1] * x[1];
    let d = R::of(1.0) + g2 - (x[1] + x[1]) * x[0];
    (R::of(1.0) - g2) / (R::of(4.0 * core::f64::consts::PI) * d * d.sqrt())
}

/// u, g: the cosine.
pub fn turn<R: Real>(x: &Arguments<R>) -> R {
    let g = x[1];
    let s = (R::of(1.0) - g * g) / (R::of(1.0) - g + (g + g) * x[0]);
    (R::of(1.0) + g * g - s * s) / (g + g)
}

/// Optical depth of a step, of which there are 1024: the share of light that is lost.
pub fn extinction<R: Real>(x: &Arguments<R>) -> R {
    let mut through = R::of(1.0);
    for _ in 0..1024 {
        through = through * (-x[0]).exp();
    }
    R::of(1.0) - through
}

/// a, b, k.
pub fn smooth_min<R: Real>(x: &Arguments<R>) -> R {
    let [a, b, k] = vector(x, 0);
    let h = (R::of(0.5) + R::of(0.5) * (b - a) / k).max(R::of(0.0)).min(R::of(1.0));
    b * (R::of(1.0) - h) + a * h - k * h * (R::of(1.0) - h)
}

/// x, side.
pub fn repeat<R: Real>(x: &Arguments<R>) -> R {
    x[0] - x[1] * (x[0] / x[1] + R::of(0.5)).floor()
}

/// Normal: how far Frisvad's basis is from orthonormal.
pub fn basis<R: Real>(x: &Arguments<R>) -> R {
    let n = vector(x, 0);
    let one = R::of(1.0);
    let a = one / (one + n[2]);
    let b = -n[0] * n[1] * a;
    let (u, v) = ([one - n[0] * n[0] * a, b, -n[0]], [b, one - n[1] * n[1] * a, -n[1]]);
    unlike(u, v, n)
}

/// The greatest fault of three vectors that should be orthonormal.
pub fn unlike<R: Real>(u: [R; 3], v: [R; 3], n: [R; 3]) -> R {
    let faults = [dot(u, v), dot(u, n), dot(v, n), dot(u, u) - R::of(1.0), dot(v, v) - R::of(1.0)];
    faults.into_iter().fold(R::of(0.0), |worst, x| worst.max(x.abs()))
}

/// Point, half sides: distance from a box.
pub fn sdf_box<R: Real>(x: &Arguments<R>) -> R {
    let q = [0, 1, 2].map(|i| x[i].abs() - x[3 + i]);
    let out = q.map(|q| q.max(R::of(0.0)));
    dot(out, out).sqrt() + q[0].max(q[1]).max(q[2]).min(R::of(0.0))
}

/// Point, radius, thickness: distance from a ring about y.
pub fn sdf_torus<R: Real>(x: &Arguments<R>) -> R {
    let out = (x[0] * x[0] + x[2] * x[2]).sqrt() - x[3];
    (out * out + x[1] * x[1]).sqrt() - x[4]
}

/// Number.
pub fn exp<R: Real>(x: &Arguments<R>) -> R {
    x[0].exp()
}
