//! Ray and triangle by edge functions that are watertight across shared edges and corners.
//!
//! Corners are taken relative to the ray's origin, turned so that the direction's largest
//! coordinate is z, and sheared so that the ray is the z axis: x - (dx/dz) z, y - (dy/dz) z. Each
//! corner is rounded once, the same way for all triangles that share it. The edge functions
//! u = cx by - cy bx and alike come from exact products, so their signs are exact, and on the
//! rounded corners no ray slips through a mesh. Zero counts as inside for both signs; only a
//! vanishing sum misses. Woop, Benthin and Wald, JCGT 2(1), 2013.

use super::{Rays8, Span};
use crate::math::lanes::{F, V3, difference_of_products};
use crate::scene::Triangle;

/// Where `rays` cross the triangle.
pub fn triangle(rays: &Rays8, s: &Triangle) -> Span {
    let zero = F::ZERO;
    let (x, y, z) = (rays.direction.x.abs(), rays.direction.y.abs(), rays.direction.z.abs());
    let by_z = z.simd_ge(x) & z.simd_ge(y);
    let by_y = y.simd_ge(x);
    let turn = |v: V3| {
        let pick = |z: F, y: F, x: F| by_z.select(z, by_y.select(y, x));
        V3::new(pick(v.x, v.z, v.y), pick(v.y, v.x, v.z), pick(v.z, v.y, v.x))
    };
    let d = turn(rays.direction);
    let (shear_x, shear_y) = (d.x / d.z, d.y / d.z);
    let [a, b, c] = s.corners.map(|p| {
        let p = turn(V3::splat(p) - rays.origin);
        V3::new(p.x - shear_x * p.z, p.y - shear_y * p.z, p.z)
    });
    let edge = |p: V3, q: V3| difference_of_products(q.x, p.y, q.y, p.x);
    let (u, v, w) = (edge(b, c), edge(c, a), edge(a, b));
    let inside = (u.simd_ge(zero) & v.simd_ge(zero) & w.simd_ge(zero))
        | (u.simd_le(zero) & v.simd_le(zero) & w.simd_le(zero));
    let sum = u + v + w;
    let t = (u * a.z + v * b.z + w * c.z) / (sum * d.z);
    Span::single(t, inside & sum.simd_ne(zero))
}
