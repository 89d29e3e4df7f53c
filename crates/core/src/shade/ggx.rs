//! Microfacets by Trowbridge and Reitz ("GGX", Walter et al. 2007): π D V F with α = roughness².
//!
//! D = α² / (π s²), s = |n×h|² + (α n·h)²: the sine comes from the cross product, as 1 - (n·h)²
//! would lose 4u/α² of its digits. Smith's masking and shadowing, height-correlated (Heitz, JCGT
//! 2014), over 4 n·l n·v: V = ½ / (n·l s_v + n·v s_l), s_x = √(α² + (1-α²) x²). F: Schlick.

use super::fresnel::schlick;
use crate::math::lanes::{Bound, F, V3, splat};
use crate::math::lanes_f64::in_f64;
use crate::math::lanes_fn::sin_cos;
use crate::math::sampling::basis;
use crate::scene::Channel;
use crate::trace::Surface;
use std::f32::consts::TAU;

/// π D of microfacets whose normals have this cosine, and squared sine, to the surface's. Error at most 1 ulp for the
/// given f32; what is lost before is in the sine. Walter et al. 2007.
#[inline(always)]
pub fn distribution(sine2: F, cos: F, alpha: F) -> F {
    in_f64([sine2, cos, alpha], |[sine2, cos, alpha]| {
        let along = alpha * cos;
        let q = alpha / (sine2 + along * along);
        q * q
    })
}

/// √(α² sin² + cos²): 2 cos / (cos + this) of the facets are seen under a cosine. As α² + (1 - α²) cos² it
/// holds no difference of cosines.
#[inline(always)]
fn smith(cos: F, alpha: F) -> F {
    let square = alpha * alpha;
    (square + (F::ONE - square) * (cos * cos)).sqrt()
}

/// Share of the facets that is seen under this cosine, 0..=1: Smith's G1. Error at most 4 ulp.
#[inline(always)]
pub fn masking(cos: F, alpha: F) -> F {
    let whole = cos + smith(cos, alpha);
    whole.simd_gt(F::ZERO) & ((cos + cos) / whole)
}

/// V for these cosines, 0..=1; 0 where both are 0. Error at most 4 ulp. Heitz, JCGT 3(2), 2014. The same both
/// ways, bit for bit.
#[inline(always)]
pub fn visibility(n_l: F, n_v: F, alpha: F) -> F {
    let whole = n_l * smith(n_v, alpha) + n_v * smith(n_l, alpha);
    // Cosines under 1e-30 would overflow; the light they bring is nothing.
    whole.simd_gt(F::ZERO) & (splat(0.5) / whole.at_least(splat(1e-30)))
}

/// π times the share of light from unit direction `l` that goes to `v`, per cosine; the same both
/// ways, bit for bit.
#[inline(never)]
pub fn ggx(s: &Surface, l: V3, v: V3) -> V3 {
    let n = s.normal;
    let alpha = s.value(Channel::Roughness);
    let alpha = (alpha * alpha).at_least(splat(1e-3));
    // For unit vectors v·h = l·h = |l + v| / 2.
    let sum = l + v;
    let length = sum.length();
    let h = sum * (F::ONE / length);
    let across = n.cross(h);
    let d = distribution(across.dot(across), n.dot(h), alpha);
    let shown = visibility(n.dot(l).at_least(F::ZERO), n.dot(v).at_least(F::ZERO), alpha);
    let fresnel = schlick(s.colour(Channel::F0), splat(1.0), length * splat(0.5));
    // Straight against the light there is no h.
    (fresnel * s.colour(Channel::Specular) * (d * shown)) & length.simd_gt(F::ZERO)
}

/// A direction in which a facet that `v` sees mirrors, drawn by a random point, and the factor on
/// the light from there; 0 where it lies under the surface.
///
/// Facets are drawn by their visible area: caps of the sphere (Dupuy and Benyoub 2023, after Heitz
/// 2018). What is left of the integrand is F G2 / G1.
#[inline(never)]
pub fn sample(s: &Surface, v: V3, (x, y): (F, F)) -> (V3, V3) {
    let n = s.normal;
    let alpha = s.value(Channel::Roughness);
    let alpha = (alpha * alpha).at_least(splat(1e-3));
    let (a, b) = basis(n);
    // Normals are bent: the eye may look at the back of one.
    let n_v = v.dot(n).at_least(splat(1e-3));
    // The eye as seen by the facets stretched to a half sphere.
    let eye = V3::new(v.dot(a) * alpha, v.dot(b) * alpha, n_v).normalize();
    let z = (F::ONE - y) * (F::ONE + eye.z) - eye.z;
    let r = ((F::ONE - z) * (F::ONE + z)).at_least(F::ZERO).sqrt();
    let (sin, cos) = sin_cos(x * splat(TAU));
    let facet = V3::new(r * cos, r * sin, z) + eye;
    let h = (a * (facet.x * alpha) + b * (facet.y * alpha) + n * facet.z.at_least(F::ZERO)).normalize();
    let v_h = v.dot(h);
    let l = (h * (v_h + v_h) - v).normalize();
    let n_l = n.dot(l);
    // G2 / G1 = (n·v + s_v) n·l / (n·l s_v + n·v s_l) = 2 V n·l (n·v + s_v).
    let through = visibility(n_l.at_least(F::ZERO), n_v, alpha) * n_l * (n_v + smith(n_v, alpha));
    let weight = schlick(s.colour(Channel::F0), splat(1.0), v_h) * (through + through);
    (l, weight & n_l.simd_gt(F::ZERO))
}

#[cfg(test)]
mod tests;
