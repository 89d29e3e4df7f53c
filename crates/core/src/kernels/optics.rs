//! How one ray splits at a surface.

use super::first;
use crate::math::lanes::{V3, splat};
use crate::shade::{self, dielectric};
use glam::Vec3;

/// Schlick's reflectance f0 + (1 - f0)(1 - cos)⁵, the cosine clamped to 0..=1. Error at most 6 u, and
/// 3.8 ulp in 40 million cases.
pub fn schlick(f0: f32, cos: f32) -> f32 {
    first(shade::schlick(V3::splat(Vec3::splat(f0)), splat(1.0), splat(cos)).x)
}

/// Share of unpolarised light that a clear body mirrors: see [`dielectric::reflectance`]. Error at most 1 ulp.
pub fn fresnel(cos: f32, n_i: f32, n_t: f32) -> f32 {
    first(dielectric::reflectance(splat(cos), splat(n_i), splat(n_t)))
}

/// Cosine of the refracted angle: see [`dielectric::cos_refracted`]. Error at most 1 ulp.
pub fn cos_refracted(cos: f32, n_i: f32, n_t: f32) -> f32 {
    first(dielectric::cos_refracted(splat(cos), splat(n_i), splat(n_t)))
}

/// Whether all light is mirrored: see [`dielectric::is_total`]. Exact.
pub fn is_total(cos: f32, n_i: f32, n_t: f32) -> bool {
    first(dielectric::is_total(splat(cos), splat(n_i), splat(n_t))).to_bits() != 0
}

/// Unit direction in which a ray of unit direction `d` goes on behind a surface with unit normal `n`, which
/// looks towards it; `None` under total internal reflection. `eta` is the refractive index on the ray's side over
/// that behind.
///
/// In f64 and rounded once: each coordinate within 1 ulp or u² (1 + 1 / cosine behind) of that for the exact
/// directions of `d` and `n`, whose lengths don't count, and total reflection just where it is. Packets,
/// [`shade::refract`], are f32: 4 u (1 + eta²)(1 + 1 / cosine behind).
pub fn refract(d: Vec3, n: Vec3, eta: f32) -> Option<Vec3> {
    let (d, n, eta) = (d.as_dvec3(), n.as_dvec3(), f64::from(eta));
    let (d2, n2) = (d.length_squared(), n.length_squared());
    let across = n.cross(d);
    let sine2 = eta * eta * across.length_squared() / (d2 * n2);
    if sine2.is_nan() || sine2 >= 1.0 {
        return None;
    }
    // Along the normal, and in the surface: n × (d × n) is the part of d across n, times n².
    let (into, along) = ((1.0 - sine2).sqrt() / n2.sqrt(), eta / (n2 * d2.sqrt()));
    Some((across.cross(n) * along - n * into).as_vec3())
}
