//! Microfacets, reflectance, refraction, scattering and extinction, as they are printed.

use super::forms::with_frisvad;
use crate::numbers::real::{Arguments, Real, dot, vector};

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

/// Extinction, length: (1 - exp(-σ t)) / σ.
pub fn homogeneous<R: Real>(x: &Arguments<R>) -> R {
    (R::of(1.0) - (-(x[0] * x[1])).exp()) / x[0]
}

/// Normal, two numbers: cosine of the direction above that point of a disc (Malley), turned to the normal.
pub fn cosine<R: Real>(x: &Arguments<R>) -> R {
    let n = vector(x, 0);
    let (r, turn) = (x[3].sqrt(), x[4] * R::of(std::f64::consts::TAU));
    let (u, v) = (r * turn.cos(), r * turn.sin());
    let z = (R::of(1.0) - u * u - v * v).max(R::of(0.0)).sqrt();
    let (a, b) = with_frisvad(n);
    dot([0, 1, 2].map(|i| a[i] * u + b[i] * v + n[i] * z), n)
}
