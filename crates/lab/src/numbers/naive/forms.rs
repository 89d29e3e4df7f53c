//! Distance fields, joins, repetition, bases and walks, as they are printed.

use crate::numbers::real::{Arguments, Real, V, dot, vector};

/// a, b, k.
pub fn smooth_min<R: Real>(x: &Arguments<R>) -> R {
    let [a, b, k] = vector(x, 0);
    let h = (R::of(0.5) + R::of(0.5) * (b - a) / k).max(R::of(0.0)).min(R::of(1.0));
    b * (R::of(1.0) - h) + a * h - k * h * (R::of(1.0) - h)
}

/// What is in both: a, b, k.
pub fn smooth_intersection<R: Real>(x: &Arguments<R>) -> R {
    let mut y = *x;
    (y[0], y[1]) = (-x[0], -x[1]);
    -smooth_min(&y)
}

/// What of the first is outside of the second: a, b, k.
pub fn smooth_subtraction<R: Real>(x: &Arguments<R>) -> R {
    let mut y = *x;
    y[0] = -x[0];
    -smooth_min(&y)
}

/// x, side.
pub fn repeat<R: Real>(x: &Arguments<R>) -> R {
    x[0] - x[1] * (x[0] / x[1] + R::of(0.5)).floor()
}

/// x, side, cells to either side at most.
pub fn repeat_bounded<R: Real>(x: &Arguments<R>) -> R {
    x[0] - x[1] * (x[0] / x[1] + R::of(0.5)).floor().max(-x[2]).min(x[2])
}

/// Place in the first of a row of 128 cells, direction along x: where the last is entered, by adding a cell's width
/// to the nearest of three distances at each step (Amanatides and Woo).
pub fn walk<R: Real>(x: &Arguments<R>) -> R {
    let pace = [3, 4, 5].map(|i| R::of(1.0) / x[i].abs());
    let mut t = [0, 1, 2].map(|i| (R::of(1.0) - x[i]) * pace[i]);
    let mut enter = t[0];
    for _ in 0..127 {
        enter = t[0].min(t[1]).min(t[2]);
        t = [0, 1, 2].map(|i| (enter - t[i]).pick(t[i] + pace[i], t[i]));
    }
    enter
}

/// Two vectors upright on a unit vector and on each other (Frisvad 2012).
pub fn with_frisvad<R: Real>(n: V<R>) -> (V<R>, V<R>) {
    let one = R::of(1.0);
    let a = one / (one + n[2]);
    let b = -n[0] * n[1] * a;
    ([one - n[0] * n[0] * a, b, -n[0]], [b, one - n[1] * n[1] * a, -n[1]])
}

/// Normal: how far Frisvad's basis is from orthonormal.
pub fn basis<R: Real>(x: &Arguments<R>) -> R {
    let n = vector(x, 0);
    let (u, v) = with_frisvad(n);
    unlike(u, v, n)
}

/// The greatest fault of three vectors that should be orthonormal.
pub fn unlike<R: Real>(u: [R; 3], v: [R; 3], n: [R; 3]) -> R {
    let faults = [dot(u, v), dot(u, n), dot(v, n), dot(u, u) - R::of(1.0), dot(v, v) - R::of(1.0)];
    faults.into_iter().fold(R::of(0.0), |worst, x| worst.max(x.abs()))
}

/// Point, radius: distance from a ball.
pub fn sdf_sphere<R: Real>(x: &Arguments<R>) -> R {
    dot(vector(x, 0), vector(x, 0)).sqrt() - x[3]
}

/// Point, half sides, rounding of the edges.
pub fn sdf_round_box<R: Real>(x: &Arguments<R>) -> R {
    let mut y = *x;
    (3..6).for_each(|i| y[i] = x[i] - x[6]);
    sdf_box(&y) - x[6]
}

/// Point, half length along y, radius.
pub fn sdf_capsule<R: Real>(x: &Arguments<R>) -> R {
    let y = x[1] - x[1].max(-x[3]).min(x[3]);
    (x[0] * x[0] + y * y + x[2] * x[2]).sqrt() - x[4]
}

/// Point, half length along y, radius: a cylinder with flat ends.
pub fn sdf_cylinder<R: Real>(x: &Arguments<R>) -> R {
    let (out, up) = ((x[0] * x[0] + x[2] * x[2]).sqrt() - x[4], x[1].abs() - x[3]);
    let zero = R::of(0.0);
    let (o, u) = (out.max(zero), up.max(zero));
    (o * o + u * u).sqrt() + out.max(up).min(zero)
}

/// Point, a point of the plane, normal.
pub fn sdf_plane<R: Real>(x: &Arguments<R>) -> R {
    dot(vector(x, 0), vector(x, 6)) - dot(vector(x, 3), vector(x, 6))
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
