//! Rays against shapes, eight rays at a time.
//!
//! A ray's result never depends on which packet it rides in: every operation acts lane by lane.
//! Robust forms and their sources stand with each kernel.

mod field;
mod hit;
mod occlusion;
mod pattern;
mod penumbra;
mod plane;
mod ramp;
mod round;
mod slabs;
mod sphere;
mod surface;
mod texture;
mod triangle;
mod voxels;
mod walk;

#[cfg(test)]
pub(crate) mod check;
#[cfg(test)]
mod tests;

pub use field::{ambient_share, distance, field, folded, form, repeated, smooth_min};
pub use hit::{Hits, NONE, nearest};
pub use occlusion::{BLOCKED, FAINT, Suspects, occlusion};
pub use penumbra::penumbra;
pub use plane::plane;
pub use ramp::ramp;
pub use round::{cone, cylinder};
pub use slabs::{Across, Slabs};
pub use sphere::sphere;
pub use surface::{Surface, surface};
pub use texture::relief_within;
pub use triangle::{Aim, Crossing, triangle};
pub use voxels::voxels;
pub(crate) use voxels::{MOST_STEPS, ROOM};
pub use walk::Walk;

use crate::counters::{Counter, Counters};
use crate::features;
use crate::math::lanes::{F, V3, splat};
use crate::mesh::Instance;
use crate::quality::Quality;
use crate::scene::{Cone, Cylinder, Field, Plane, Scene, Sphere, Triangle, Voxels};

/// Eight rays. Directions need not be unit vectors; distances along a ray are in lengths of its
/// direction. Squares of origins and directions must not leave the range of f32; rays that break
/// this may hit anything or nothing, but never at NaN.
#[derive(Clone, Copy, Default)]
pub struct Rays8 {
    /// Origins, world.
    pub origin: V3,
    /// Directions, world.
    pub direction: V3,
}

/// Where eight rays enter and leave a body, as distances along the rays.
///
/// A miss has both at -1. An open shape (triangle, plane) has both equal.
#[derive(Clone, Copy)]
pub struct Span {
    /// First crossing, -infinity if the body has no beginning there.
    pub enter: F,
    /// Last crossing, or infinity.
    pub exit: F,
    /// Part of the shape crossed first: 0 side, 1 near cap, 2 far cap.
    pub enter_part: F,
    /// Part crossed last.
    pub exit_part: F,
}

impl Span {
    /// No crossing in any lane.
    pub const MISS: Span = {
        let (t, part) = (F::splat(-1.0), F::splat(0.0));
        Span { enter: t, exit: t, enter_part: part, exit_part: part }
    };

    /// A crossing of an open shape at `t`, or a miss where `hit` is not set.
    #[inline(always)]
    pub fn single(t: F, hit: F) -> Self {
        let t = hit.select(t, splat(-1.0));
        Self { enter: t, exit: t, enter_part: F::ZERO, exit_part: F::ZERO }
    }

    /// The nearest crossing in front of the ray's origin: distance (0 or less for none) and part.
    #[inline(always)]
    pub fn first(&self) -> (F, F) {
        let outside = self.enter.simd_gt(F::ZERO);
        (outside.select(self.enter, self.exit), outside.select(self.enter_part, self.exit_part))
    }
}

impl Rays8 {
    /// The ray of the lowest lane of a mask, in all lanes.
    #[inline(never)]
    pub fn alone(&self, lanes: u32) -> Rays8 {
        let one = |v: V3| V3::splat(v.lane(lanes.trailing_zeros() as usize));
        Rays8 { origin: one(self.origin), direction: one(self.direction) }
    }

    /// Whether some ray's line comes near the ball: a cheap test before an expensive one, which
    /// errs to true by rounding.
    #[inline(always)]
    pub fn near_ball(&self, centre: crate::math::Vec3, radius: f32) -> bool {
        let f = self.origin - V3::splat(centre);
        let d = self.direction;
        let nearest = f - d * (f.dot(d) / d.dot(d));
        let reach = splat(radius * radius * 1.0001) + f.dot(f) * splat(1e-7);
        !nearest.dot(nearest).simd_gt(reach).all()
    }
}

/// One shape of any kind.
#[derive(Clone, Copy)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Shape<'a> {
    Sphere(&'a Sphere),
    Plane(&'a Plane),
    Cylinder(&'a Cylinder),
    Cone(&'a Cone),
    Triangle(&'a Triangle),
    Voxels(&'a Voxels),
    Field(&'a Field),
    Facet(&'a Instance, usize),
}

impl Scene {
    /// The shape at `index` in the common index space; from `shape_count()` on the meshes' facets.
    pub fn shape(&self, index: usize) -> Shape<'_> {
        let mut i = index;
        if let Some(s) = self.spheres.get(i) {
            return Shape::Sphere(s);
        }
        i -= self.spheres.len();
        if let Some(s) = self.planes.get(i) {
            return Shape::Plane(s);
        }
        i -= self.planes.len();
        if let Some(s) = self.cylinders.get(i) {
            return Shape::Cylinder(s);
        }
        i -= self.cylinders.len();
        if let Some(s) = self.cones.get(i) {
            return Shape::Cone(s);
        }
        i -= self.cones.len();
        if features::TRIANGLES {
            if let Some(s) = self.triangles.get(i) {
                return Shape::Triangle(s);
            }
            i -= self.triangles.len();
        }
        if features::VOXELS {
            if let Some(s) = self.voxels.get(i) {
                return Shape::Voxels(s);
            }
            i -= self.voxels.len();
        }
        if !features::MESHES || i < self.fields.len() {
            return Shape::Field(&self.fields[i]);
        }
        let (instance, facet) = self.meshes.facet(i - self.fields.len());
        Shape::Facet(instance, facet)
    }

    /// Whether the shape at `index` is a facet of a mesh that an image is laid over.
    pub fn is_painted(&self, index: usize) -> bool {
        features::IMAGES
            && matches!(self.shape(index), Shape::Facet(instance, _) if instance.mesh().skin().is_some())
    }
}

impl Shape<'_> {
    /// The counter of tests against this kind of shape.
    pub fn counter(&self) -> Counter {
        match self {
            Shape::Sphere(_) => Counter::SphereTests,
            Shape::Plane(_) => Counter::PlaneTests,
            Shape::Cylinder(s) if s.length == f32::INFINITY => Counter::EndlessTests,
            Shape::Cylinder(_) => Counter::CylinderTests,
            Shape::Cone(_) => Counter::ConeTests,
            Shape::Triangle(_) => Counter::TriangleTests,
            Shape::Voxels(_) => Counter::VoxelTests,
            Shape::Field(_) => Counter::FieldTests,
            Shape::Facet(..) => Counter::FacetTests,
        }
    }

    /// Index of the shape's material; of a field's first one.
    pub fn material(&self) -> usize {
        match self {
            Shape::Sphere(s) => s.material,
            Shape::Plane(s) => s.material,
            Shape::Cylinder(s) => s.material,
            Shape::Cone(s) => s.material,
            Shape::Triangle(s) => s.material,
            Shape::Voxels(s) => s.material,
            Shape::Field(s) => s.nodes.first().map_or(0, |node| node.material),
            Shape::Facet(s, _) => s.material,
        }
    }

    /// Whether what of it lies between samples of one surface is flat.
    pub fn is_flat(&self) -> bool {
        matches!(self, Shape::Plane(_) | Shape::Triangle(_) | Shape::Facet(..) | Shape::Voxels(_))
    }

    /// Whether its bounds are too loose to say that it shows, or its shadow falls, where they meet.
    pub fn is_loose(&self) -> bool {
        matches!(self, Shape::Voxels(_) | Shape::Field(_))
    }

    /// Where `rays` cross the shape. What lies past `limit` along a ray may be missing.
    #[inline(never)]
    pub fn span(&self, rays: &Rays8, limit: F, quality: &Quality, counters: &mut Counters) -> Span {
        match self {
            Shape::Sphere(s) => sphere(rays, s),
            Shape::Plane(s) => plane(rays, s),
            Shape::Cylinder(s) => cylinder(rays, s),
            Shape::Cone(s) => cone(rays, s),
            Shape::Triangle(s) if features::TRIANGLES => triangle(rays, s),
            Shape::Triangle(_) => Span::MISS,
            Shape::Voxels(s) if features::VOXELS => voxels(rays, s, limit, counters),
            Shape::Voxels(_) => Span::MISS,
            Shape::Field(s) if features::FIELDS => field(rays, s, limit, quality, counters),
            Shape::Field(_) => Span::MISS,
            Shape::Facet(s, facet) => s.span(*facet, rays),
        }
    }
}
