//! Signed distance fields at one point and along one ray.

use super::{Ray, first};
use crate::counters::Counters;
use crate::math::lanes::{TRUE, V3, splat};
use crate::quality::Quality;
use crate::scene::{Field, Node};
use crate::trace::{self, Rays8};
use glam::Vec3;

/// Distance of `p` from a form in its place: below 0 within it. Bodies by [`Node::sphere`], [`Node::cuboid`],
/// [`Node::capsule`], [`Node::cylinder`], [`Node::torus`], [`Node::plane`], [`Node::cross`] and
/// [`Node::swell`].
///
/// |p - centre| up to 1e18. Error at most 4 u (|p - centre| + size). Quilez, "Distance functions".
pub fn sdf(form: &Node, p: Vec3) -> f32 {
    first(trace::form(form, V3::splat(p)))
}

/// Value of a whole field at `p`.
pub fn field_distance(field: &Field, p: Vec3) -> f32 {
    first(trace::distance(field, V3::splat(p), &[TRUE; Field::MOST], None))
}

/// The smooth minimum of two distances: both bodies, joined over a radius `k`, 0 or at least 1e-18. Exactly the
/// lesser where they differ by `k` or more. Error at most 2 u (|a| + |b| + k).
pub fn smooth_union(a: f32, b: f32, k: f32) -> f32 {
    first(trace::smooth_min(splat(a), splat(b), k).0)
}

/// The smooth maximum: what lies in both bodies.
pub fn smooth_intersection(a: f32, b: f32, k: f32) -> f32 {
    -smooth_union(-a, -b, k)
}

/// What of `a` lies outside of `b`.
pub fn smooth_subtraction(a: f32, b: f32, k: f32) -> f32 {
    smooth_intersection(a, -b, k)
}

/// Plain repetition of an axis: `x` less the middle of its cell of `side`, over 0; at most `most` cells to
/// either side. Error at most 2 u |x|; at a border either cell may be meant.
pub fn repeat(x: f32, side: f32, most: f32) -> f32 {
    first(trace::repeated(splat(x), side, most).1)
}

/// Mirrored repetition, as fields have it: no step at borders, so no two points come farther apart.
pub fn fold(x: f32, side: f32, most: f32) -> f32 {
    first(trace::folded(splat(x), side, most))
}

/// Share of a lamp of this radius in the middle of which the ray ends, at its origin plus its direction, that a
/// field leaves to where it begins; 1 for all of it.
pub fn field_light(ray: &Ray, field: &Field, radius: f32, quality: &Quality) -> f32 {
    // The direction's length counts: it ends in the lamp.
    let rays = Rays8 { origin: V3::splat(ray.origin), direction: V3::splat(ray.direction) };
    first(trace::penumbra(&rays, field, radius, quality, TRUE, &mut Counters::default()))
}

/// Where a ray meets a field, by sphere tracing with the steps and the epsilon of `quality`.
pub fn march(ray: &Ray, field: &Field, quality: &Quality) -> Option<f32> {
    let packet = ray.packet();
    let span = trace::field(&packet.rays, field, splat(f32::INFINITY), quality, &mut Counters::default());
    let t = packet.length(first(span.first().0));
    (t > 0.0).then_some(t)
}
