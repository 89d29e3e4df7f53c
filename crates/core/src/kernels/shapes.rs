//! One ray against one shape.

use super::first;
use crate::math::lanes::{F, INFINITY, V3, splat};
use crate::scene::{Cone, Cylinder, Plane, Sphere, Triangle};
use crate::trace::{self, Aim, Rays8, Span};
use glam::Vec3;

/// A ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it begins, world.
    pub origin: Vec3,
    /// Where it goes; need not be a unit vector.
    pub direction: Vec3,
}

/// Where a ray enters and leaves a body, in lengths of its direction. Open shapes have both equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// First crossing of the line; below 0 behind the origin, -infinity if the body has no beginning.
    pub enter: f32,
    /// Last crossing, or infinity.
    pub exit: f32,
    /// Part of the shape where it enters: 0 side, 1 near cap, 2 far cap.
    pub enter_part: u32,
    /// Part where it leaves.
    pub exit_part: u32,
}

impl Crossing {
    /// The nearest crossing in front of the origin.
    pub fn first(&self) -> f32 {
        if self.enter > 0.0 { self.enter } else { self.exit }
    }
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Distance in lengths of the direction, over 0.
    pub t: f32,
    /// Shares of the three corners in the point hit; they sum to 1.
    pub weights: [f32; 3],
}

/// A ray in all lanes, with a direction about as long as 1.
pub(super) struct Packet {
    pub rays: Rays8,
    /// What distances along it are in lengths of the ray's own direction: a power of two.
    unit: f64,
}

impl Ray {
    /// The ray in all lanes, the longest coordinate of its direction made 1 to 2 by a power of two. That changes no
    /// bit of what f32 can hold, and products of short directions no longer vanish.
    pub(super) fn packet(&self) -> Packet {
        let longest = f64::from(self.direction.abs().max_element());
        let scales = longest > 0.0 && longest < f64::INFINITY;
        // As f64 no number of f32 is subnormal.
        let exponent = if scales { (longest.to_bits() >> 52) as i64 - 1023 } else { 0 };
        let unit = f64::from_bits(((1023 - exponent) as u64) << 52);
        let direction = self.direction.to_array().map(|d| (f64::from(d) * unit) as f32);
        let direction = V3::splat(Vec3::from_array(direction));
        Packet { rays: Rays8 { origin: V3::splat(self.origin), direction }, unit }
    }
}

impl Packet {
    /// A distance in lengths of the ray's own direction.
    pub(super) fn length(&self, t: f32) -> f32 {
        (f64::from(t) * self.unit) as f32
    }

    /// A crossing in front of the ray, if there is one.
    fn ahead(&self, span: &Span) -> Option<Crossing> {
        let crossing = Crossing {
            enter: self.length(first(span.enter)),
            exit: self.length(first(span.exit)),
            enter_part: first(span.enter_part) as u32,
            exit_part: first(span.exit_part) as u32,
        };
        let t = crossing.first();
        (t > 0.0 && t < f32::INFINITY).then_some(crossing)
    }
}

/// Sphere of a radius over 0. Score at most 4. Haines, Günther and Akenine-Möller, Ray Tracing Gems ch. 7.
pub fn sphere(ray: &Ray, centre: Vec3, radius: f32) -> Option<Crossing> {
    let packet = ray.packet();
    let sphere = Sphere { centre: centre.into(), radius, material: 0, blend: 0.0 };
    packet.ahead(&trace::sphere(&packet.rays, &sphere))
}

/// Plane through `point` with this unit normal, from either side; a ray in the plane misses it. Score at
/// most 4.
pub fn plane(ray: &Ray, point: Vec3, normal: Vec3) -> Option<f32> {
    let plane = Plane { point: point.into(), normal: normal.into(), reach: f32::INFINITY, material: 0 };
    let packet = ray.packet();
    packet.ahead(&trace::plane(&packet.rays, &plane)).map(|c| c.enter)
}

/// Cylinder without ends about the line through `point` along the unit vector `axis`. Score at most 4.
pub fn cylinder(ray: &Ray, point: Vec3, axis: Vec3, radius: f32) -> Option<Crossing> {
    capped_cylinder(ray, point, axis, radius, f32::INFINITY)
}

/// Closed bar from `base`, the middle of its first cap, along the unit vector `axis`. Score at most 4.
pub fn capped_cylinder(ray: &Ray, base: Vec3, axis: Vec3, radius: f32, length: f32) -> Option<Crossing> {
    let packet = ray.packet();
    let bar = Cylinder { base: base.into(), axis: axis.into(), radius, length, material: 0 };
    packet.ahead(&trace::cylinder(&packet.rays, &bar))
}

/// Single cone without end from `apex` along the unit vector `axis`; `slope` is the tangent of its half angle.
/// Score at most 4.
pub fn cone(ray: &Ray, apex: Vec3, axis: Vec3, slope: f32) -> Option<Crossing> {
    cut_cone(ray, apex, axis, slope, [0.0, f32::INFINITY], false)
}

/// Closed cone or frustum: the same between two heights over the apex. Score at most 4.
pub fn capped_cone(ray: &Ray, apex: Vec3, axis: Vec3, slope: f32, range: [f32; 2]) -> Option<Crossing> {
    cut_cone(ray, apex, axis, slope, range, true)
}

fn cut_cone(
    ray: &Ray,
    apex: Vec3,
    axis: Vec3,
    slope: f32,
    range: [f32; 2],
    capped: bool,
) -> Option<Crossing> {
    let packet = ray.packet();
    let (apex, axis, caps) = (apex.into(), axis.into(), [capped; 2]);
    packet.ahead(&trace::cone(&packet.rays, &Cone { apex, axis, slope, range, caps, material: 0 }))
}

/// Triangle, from either side; meshes of them have no leaks. Score at most 4. Woop, Benthin and Wald 2013.
pub fn triangle(ray: &Ray, corners: [Vec3; 3]) -> Option<TriangleHit> {
    let packet = ray.packet();
    let span = trace::triangle(&packet.rays, &Triangle { corners: corners.map(Into::into), material: 0 });
    let t = packet.ahead(&span)?.enter;
    let crossing = Aim::new(&packet.rays).cross(&corners.map(V3::splat))?;
    Some(TriangleHit { t, weights: crossing.weights.map(|w| first(w / crossing.sum)) })
}

/// Box between two corners: where the ray enters it, at least 0, and leaves it.
///
/// Closed: rays in a face and flat boxes are hit, empty ones (`lo > hi`) never. Each distance is within
/// 3 u of (corner - origin) / direction. To lose no ray that meets an edge, the far one is
/// taken for 1 + 2 γ₃ as much when the two are compared.
pub fn slab(ray: &Ray, lo: Vec3, hi: Vec3) -> Option<[f32; 2]> {
    let packet = ray.packet();
    let (enter, exit) = packet.rays.in_box(lo.into(), hi.into(), splat(f32::INFINITY));
    // Entered at infinity is never.
    let hit = enter.simd_le(exit * splat(1.000_000_4)) & exit.simd_ge(F::ZERO) & enter.simd_lt(INFINITY);
    (first(hit).to_bits() != 0).then(|| [enter, exit].map(|t| packet.length(first(t))))
}
