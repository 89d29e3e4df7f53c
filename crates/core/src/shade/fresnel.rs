//! How a surface splits light: Schlick's reflectance, the mirrored and the refracted direction.
//!
//! Refraction from the sine instead of the cosine: s² = |n × d|², cos_t² = (1 - ηs)(1 + ηs), which
//! keeps its digits near the critical angle; total internal reflection (ηs >= 1) is a case of its
//! own with reflectance 1. Schlick 1994; inside the denser body with the outer angle.

use crate::features;
use crate::math::lanes::{Bound, F, V3, splat};
use crate::scene::{Channel, Shading};
use crate::trace::Surface;

/// Schlick's approximation f0 + (f90 - f0) w, w = (1 - c)^5, c clamped to 0..1; `f90` is 1 for a smooth surface.
/// As f0 (1 - w) + f90 w it is rounded less often.
///
/// The fifth power would hold five times what rounding takes from m = 1 - c. What is lost is (1 - m) - c
/// exactly (Dekker 1971), and m^4 (m + 5 lost) makes it good.
#[inline(always)]
pub fn schlick(f0: V3, f90: F, cos: F) -> V3 {
    let cos = cos.at_least(F::ZERO).at_most(F::ONE);
    let m = F::ONE - cos;
    let lost = (F::ONE - m) - cos;
    let m2 = m * m;
    let w = m2 * m2 * (m + lost * splat(5.0));
    let whole = f90 * w;
    f0 * (F::ONE - w) + V3::new(whole, whole, whole)
}

/// Light that goes on behind a surface.
pub struct Refracted {
    /// Unit direction; meaningless under total internal reflection.
    pub direction: V3,
    /// Cosine of its angle to the normal.
    pub cos: F,
    /// Mask of total internal reflection.
    pub total: F,
}

/// Refracts rays of unit direction `d` at surfaces with unit normals `n` towards them; `cos` is -d·n, `eta`
/// the refractive index on their side over that behind.
///
/// Error of the direction at most 8 u (1 + eta²)(1 + 1 / cosine), u = 2⁻²⁴.
#[inline(always)]
pub fn refract(n: V3, d: V3, cos: F, eta: F) -> Refracted {
    let across = d + n * cos;
    let sine = eta * n.cross(d).length();
    let k = (F::ONE - sine) * (F::ONE + sine);
    let total = sine.simd_ge(F::ONE);
    let cos = k.at_least(F::ZERO).sqrt();
    Refracted { direction: (across * eta - n * cos).normalize(), cos, total }
}

/// Where light goes from a surface.
pub struct Split {
    /// Share that is mirrored, before the material's `reflection`.
    pub reflectance: V3,
    /// Unit direction of the mirrored ray, never into the surface.
    pub mirrored: V3,
    /// Unit direction of the refracted ray; meaningless under total internal reflection.
    pub refracted: V3,
    /// Mask of total internal reflection.
    pub total: F,
}

/// Reflectance at grazing of the mean over the microfacets: under GGX rough surfaces, whose facets
/// shadow each other there, keep below that of smooth ones (Lagarde 2011).
#[inline(always)]
fn grazing(shading: Shading, s: &Surface) -> F {
    if !(features::GGX && shading == Shading::Ggx) {
        return splat(1.0);
    }
    let f0 = s.colour(Channel::F0);
    (F::ONE - s.value(Channel::Roughness)).at_least(f0.x).at_least(f0.y).at_least(f0.z)
}

/// Splits rays with unit directions `d` at the surfaces `s`.
#[inline(never)]
pub fn split(shading: Shading, s: &Surface, d: V3) -> Split {
    let n = s.normal;
    let cos = -d.dot(n);
    let eta = s.value(Channel::Ior);
    let eta = s.inside.select(eta, F::ONE / eta);
    let Refracted { direction: refracted, cos: cos_out, total } = refract(n, d, cos, eta);

    // Seen from inside, Schlick takes the angle on the thin side, which reaches 90° first.
    let transparent = s.value(Channel::Transparency).simd_gt(F::ZERO);
    let total = total & transparent;
    let schlick_cos = (s.inside & transparent).select(cos_out, cos);
    let one = V3::splat(crate::math::Vec3::ONE);
    let reflectance =
        V3::select(total, one, schlick(s.colour(Channel::F0), grazing(shading, s), schlick_cos));

    // A blended normal may mirror into the body: lift such rays just over the true surface, but
    // never over where the true surface would mirror them, which flat mirrors show at grazing.
    let mirrored = d + n * (cos + cos);
    let height = mirrored.dot(s.facing);
    let least = (-d.dot(s.facing)).at_least(splat(1e-6)).at_most(splat(0.01));
    let lift = (least - height).at_least(F::ZERO);
    Split { reflectance, mirrored: (mirrored + s.facing * lift).normalize(), refracted, total }
}

#[cfg(test)]
mod tests;
