//! Ray and triangle by edge functions that are watertight across shared edges and corners.
//!
//! Corners are taken relative to the ray's origin, turned so that the direction's largest
//! coordinate is z, and sheared so that the ray is the z axis: x - (dx/dz) z, y - (dy/dz) z. Each
//! corner is rounded once, the same way for all triangles that share it. The edge functions
//! u = cx by - cy bx and alike come from exact products, so their signs are exact, and on the
//! rounded corners no ray slips through a mesh. Zero counts as inside for both signs; only a
//! vanishing sum misses. Woop, Benthin and Wald, JCGT 2(1), 2013.
//!
//! All of it acts lane by lane: eight rays against one triangle, or one ray against eight.

use super::{Rays8, Span};
use crate::math::lanes::{Bound, F, LANES, ONE, V3, ZERO, difference_of_products, splat};
use crate::scene::Triangle;

/// Eight rays, turned and sheared.
pub struct Aim {
    origin: V3,
    by_z: F,
    by_y: F,
    shear_x: F,
    shear_y: F,
    along: F,
}

/// Where rays cross triangles.
#[derive(Clone, Copy)]
pub struct Crossing {
    /// Distance along the ray.
    pub t: F,
    /// Mask of the rays that cross; in other lanes the rest is nonsense.
    pub hit: F,
    /// Weights of the corners, which sum to `sum`.
    pub weights: [F; 3],
    /// Twice the sheared triangle's area.
    pub sum: F,
}

impl Crossing {
    /// Nowhere.
    pub const NONE: Crossing = Crossing { t: ZERO, hit: ZERO, weights: [ONE, ZERO, ZERO], sum: ONE };
}

impl Aim {
    /// What the triangles that `rays` are tested against share.
    #[inline(never)]
    pub fn new(rays: &Rays8) -> Self {
        let (x, y, z) = (rays.direction.x.abs(), rays.direction.y.abs(), rays.direction.z.abs());
        let mut aim = Aim {
            origin: rays.origin,
            by_z: z.simd_ge(x) & z.simd_ge(y),
            by_y: y.simd_ge(x),
            shear_x: F::ZERO,
            shear_y: F::ZERO,
            along: F::ZERO,
        };
        let d = aim.turn(rays.direction);
        (aim.shear_x, aim.shear_y, aim.along) = (d.x / d.z, d.y / d.z, d.z);
        aim
    }

    /// What the ray of a lane needs, in all lanes.
    #[inline(never)]
    pub fn alone(&self, lane: usize) -> Self {
        let one = |v: F| splat(v.as_array()[lane % LANES]);
        Aim {
            origin: V3::new(one(self.origin.x), one(self.origin.y), one(self.origin.z)),
            by_z: one(self.by_z),
            by_y: one(self.by_y),
            shear_x: one(self.shear_x),
            shear_y: one(self.shear_y),
            along: one(self.along),
        }
    }

    #[inline(always)]
    fn turn(&self, v: V3) -> V3 {
        let pick = |z: F, y: F, x: F| self.by_z.select(z, self.by_y.select(y, x));
        V3::new(pick(v.x, v.z, v.y), pick(v.y, v.x, v.z), pick(v.z, v.y, v.x))
    }

    /// Where the rays cross triangles with these corners; nothing if it is plain that none does.
    #[inline(never)]
    pub fn cross(&self, corners: &[V3; 3]) -> Option<Crossing> {
        let zero = F::ZERO;
        let [a, b, c] = corners;
        let seen = |p: &V3| {
            let p = self.turn(*p - self.origin);
            V3::new(p.x - self.shear_x * p.z, p.y - self.shear_y * p.z, p.z)
        };
        let (a, b, c) = (seen(a), seen(b), seen(c));
        // Rounding keeps the order of two products, so what is apart is apart exactly.
        let about = |p: V3, q: V3| q.x * p.y - q.y * p.x;
        let (u, v, w) = (about(b, c), about(c, a), about(a, b));
        let outside = u.at_most(v).at_most(w).simd_lt(zero) & u.at_least(v).at_least(w).simd_gt(zero);
        if outside.all() {
            return None;
        }
        let edge = |p: V3, q: V3| difference_of_products(q.x, p.y, q.y, p.x);
        let (u, v, w) = (edge(b, c), edge(c, a), edge(a, b));
        let inside = (u.simd_ge(zero) & v.simd_ge(zero) & w.simd_ge(zero))
            | (u.simd_le(zero) & v.simd_le(zero) & w.simd_le(zero));
        let sum = u + v + w;
        let t = (u * a.z + v * b.z + w * c.z) / (sum * self.along);
        Some(Crossing { t, hit: inside & sum.simd_ne(zero), weights: [u, v, w], sum })
    }
}

/// Where `rays` cross the triangle, from either side; meshes have no leaks. Score at most 4, as
/// [`kernels`](crate::kernels) defines it. Woop, Benthin and Wald, JCGT 2(1), 2013.
pub fn triangle(rays: &Rays8, s: &Triangle) -> Span {
    let crossing = Aim::new(rays).cross(&s.corners.map(V3::splat)).unwrap_or(Crossing::NONE);
    Span::single(crossing.t, crossing.hit)
}
