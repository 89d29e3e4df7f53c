//! Ray against cylinder and cone: where the ray is inside the side, cut by the slab of the ends.
//!
//! Rays start anew at f, their point nearest to the shape's reference point: what rounding does
//! from there on is small beside the shape, however far the eye is. Both sides are quadratics
//! A t² + 2 B t + C in the plane across the axis a, built from cross products with a instead of
//! differences of squares, and with factored discriminants: cylinder
//! D = (r|d×a| - |δ|)(r|d×a| + |δ|) with δ = f·(d×a); cone of slope k
//! D = (k|f∥ d⟂ - d∥ f⟂| - |δ|)(k|f∥ d⟂ - d∥ f⟂| + |δ|). The cone's roots are q/A and C/q, so that
//! none divides by a vanishing A alone. Intersecting intervals leaves no gap at the rims. Own
//! expansion; the q-form is Kahan's.

use super::{Rays8, Span};
use crate::math::lanes::{Bound, F, V3, copysign, splat};
use crate::scene::{Cone, Cylinder};

/// What A / |d × a|² may be by rounding alone.
const PARALLEL: f32 = 2.4e-7;

/// What both shapes know of a ray: its parts along the axis and across it.
struct Axial {
    /// Distance along the ray from its origin to where it starts anew.
    start: F,
    /// New origin relative to the reference point, along the axis, lengths.
    origin: F,
    /// Direction along the axis.
    direction: F,
    /// Direction × axis: across, turned by 90°.
    n: V3,
    /// (New origin - reference) × axis.
    m: V3,
    /// |n × m|, from the triple product.
    cross: F,
}

impl Axial {
    #[inline(never)]
    fn new(rays: &Rays8, reference: crate::math::Vec3, axis: crate::math::Vec3) -> Self {
        let a = V3::splat(axis);
        let d = rays.direction;
        let f = rays.origin - V3::splat(reference);
        let start = -f.dot(d) / d.dot(d);
        let f = f + d * start;
        let n = d.cross_exact(a);
        // Along an end, or on a flat cone's side, f32 wouldn't know whether the ray rises or falls.
        let direction = d.dot_exact(a);
        Self { start, origin: f.dot(a), direction, n, m: f.cross_exact(a), cross: f.dot(n).abs() }
    }
}

/// Roots q/A and C/q of A t² + 2 B t + C for the discriminant `disc`, unordered.
///
/// The second is never the larger, which is seen to: with A, B and C all lost to rounding, at a
/// tangent, it could be anything.
#[inline(always)]
fn roots(a: F, b: F, c: F, disc: F) -> (F, F) {
    let q = -(b + copysign(disc.at_least(F::ZERO).sqrt(), b));
    let x = q / a;
    let most = x.abs();
    (x, most.at_most((-most).at_least(q.simd_eq(F::ZERO).select(F::ZERO, c / q))))
}

/// The interval where a ray is inside the side, cut by the slab `lo..hi` along the axis.
///
/// An end without a cap is passed through: the far crossing counts then, if it is not open too.
fn clip(ray: &Axial, side: (F, F), hit: F, range: [f32; 2], caps: [bool; 2]) -> Span {
    let (zero, inf) = (F::ZERO, splat(f32::INFINITY));
    let (lo, hi) = (splat(range[0]), splat(range[1]));
    if !hit.any() {
        return Span::MISS;
    }
    let forward = ray.direction.simd_gt(zero);
    let (t_lo, t_hi) = ((lo - ray.origin) / ray.direction, (hi - ray.origin) / ray.direction);
    let across = ray.direction.simd_eq(zero);
    let between = ray.origin.simd_ge(lo) & ray.origin.simd_le(hi);
    let empty = inf;
    let slab_enter = across.select(between.select(-inf, empty), forward.select(t_lo, t_hi));
    let slab_exit = across.select(between.select(inf, -empty), forward.select(t_hi, t_lo));

    let by_side = side.0.simd_ge(slab_enter);
    let out_side = side.1.simd_le(slab_exit);
    let enter = by_side.select(side.0, slab_enter);
    let exit = out_side.select(side.1, slab_exit);
    let (near, far) = (splat(1.0), splat(2.0));
    let enter_part = by_side.select(zero, forward.select(near, far));
    let exit_part = out_side.select(zero, forward.select(far, near));

    let open = |part: F| {
        let mut gap = zero;
        for (cap, index) in caps.into_iter().zip([near, far]) {
            if !cap {
                gap |= part.simd_eq(index);
            }
        }
        gap
    };
    let hit = hit & enter.simd_le(exit);
    let miss = splat(-1.0);
    let (enter, exit) = (enter + ray.start, exit + ray.start);
    let exit = (hit & !open(exit_part)).select(exit, miss);
    let pass = open(enter_part) | !hit;
    Span { enter: pass.select(exit, enter), exit, enter_part: pass.select(exit_part, enter_part), exit_part }
}

/// Whether no ray comes near a body with ends at `range` along the axis, nowhere wider than `rim`.
#[inline(never)]
fn is_far(
    rays: &Rays8,
    reference: crate::math::Vec3,
    axis: crate::math::Vec3,
    range: [f32; 2],
    rim: f32,
) -> bool {
    let half = (range[1] - range[0]) * 0.5;
    let middle = reference + axis * (range[0] + half);
    // As much as rounding moves the middle.
    let room = (reference.length() + range[1]) * 4e-7;
    half < f32::INFINITY && !rays.near_ball(middle, (half * half + rim * rim).sqrt() + room)
}

/// Where `rays` cross the cylinder, closed by its ends. Score at most 4, as [`kernels`](crate::kernels) defines it, with the
/// way to the base counted twice. Own expansion; the q-form is Kahan's.
pub fn cylinder(rays: &Rays8, s: &Cylinder) -> Span {
    if is_far(rays, s.base, s.axis, [0.0, s.length], s.radius) {
        return Span::MISS;
    }
    let ray = Axial::new(rays, s.base, s.axis);
    let r = splat(s.radius);
    let (n, m) = (ray.n.length(), ray.m.length());
    let disc = (r * n - ray.cross) * (r * n + ray.cross);
    // As rays start near the shape, nothing is lost in -B ± √D, and the roots keep their order.
    let (a, b, half) = (n * n, ray.n.dot(ray.m), disc.at_least(F::ZERO).sqrt());
    let parallel = a.simd_eq(F::ZERO);
    let inf = splat(f32::INFINITY);
    let side = (parallel.select(-inf, (-b - half) / a), parallel.select(inf, (half - b) / a));
    let hit = parallel.select(m.simd_le(r), disc.simd_ge(F::ZERO));
    let range = if s.length < f32::INFINITY { [0.0, s.length] } else { [-s.length, s.length] };
    clip(&ray, side, hit, range, [true; 2])
}

/// Where `rays` cross the cone, of a slope over 0. Score at most 4, as [`kernels`](crate::kernels) defines it, with the way
/// to the apex counted twice. Own expansion; the q-form is Kahan's.
pub fn cone(rays: &Rays8, s: &Cone) -> Span {
    if is_far(rays, s.apex, s.axis, s.range, s.range[1] * s.slope) {
        return Span::MISS;
    }
    let ray = Axial::new(rays, s.apex, s.axis);
    let k = splat(s.slope);
    let (zero, inf) = (F::ZERO, splat(f32::INFINITY));
    let (n, m) = (ray.n.length(), ray.m.length());
    let (kd, kf) = (k * ray.direction, k * ray.origin);
    let a = (n - kd.abs()) * (n + kd.abs());
    // Within rounding of the side's slope a ray is parallel to it: the sign of what is left would be chance.
    let a = a.abs().simd_gt(n * n * splat(PARALLEL)) & a;
    let b = ray.n.dot(ray.m) - kd * kf;
    let c = (m - kf.abs()) * (m + kf.abs());
    let root = k * (ray.n * ray.origin - ray.m * ray.direction).length();
    // Parallel to the side, D is B²; and if B is 0 too, the ray runs beside the side for ever.
    let parallel = a.simd_eq(zero);
    let disc = parallel.select(b * b, (root - ray.cross) * (root + ray.cross));
    let beside = parallel & b.simd_eq(zero) & c.simd_gt(zero);
    let (x, y) = roots(a, b, c, disc);

    // Flat across the axis (A > 0): between the roots, if these lie on this nappe. Steep: one
    // root on each nappe, and the inside goes on for ever. A = 0: the other root is at infinity.
    let flat = a.simd_gt(zero);
    let (lo, hi) = (x.at_most(y), x.at_least(y));
    let up = ray.direction.simd_gt(zero);
    let own = parallel.select(y, up.select(hi, lo));
    let middle = (lo + hi) * splat(0.5);
    let height = ray.origin + flat.select(middle, own) * ray.direction;
    let enter = flat.select(lo, up.select(own, -inf));
    let exit = flat.select(hi, up.select(inf, own));
    let hit = a.simd_lt(zero) | (disc.simd_ge(zero) & height.simd_ge(zero) & !beside);
    // A tip needs no end: the side is on this nappe already, and a slab would cut it off by rounding.
    let from = if s.range[0] > 0.0 { s.range[0] } else { f32::NEG_INFINITY };
    clip(&ray, (enter, exit), hit, [from, s.range[1]], s.caps)
}
