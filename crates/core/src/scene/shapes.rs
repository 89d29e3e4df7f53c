//! The analytic shapes. Axes are normalised by the constructors.

use crate::math::Vec3;

/// A ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Middle, world.
    pub centre: Vec3,
    /// Radius, world units, over 0.
    pub radius: f32,
    /// Index into the scene's materials.
    pub material: usize,
    /// Width over which its normals flow into those of other spheres with a blend, world units;
    /// 0 for none.
    pub blend: f32,
}

/// A plane, infinite or a wide disc; both sides are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Any point of the plane, or the middle of the disc, world.
    pub point: Vec3,
    /// Unit normal.
    pub normal: Vec3,
    /// Radius of the disc, world units, or infinity. Ending a floor where the haze has swallowed
    /// it spares the horizon's endless detail.
    pub reach: f32,
    /// Index into the scene's materials.
    pub material: usize,
}

/// A round bar from `base` along `axis`, `length` long; infinite both ways if `length` is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Middle of the first cap, or any point of the axis of an infinite one, world.
    pub base: Vec3,
    /// Unit vector from the first cap to the second.
    pub axis: Vec3,
    /// Radius, world units, over 0.
    pub radius: f32,
    /// Distance between the caps, world units, or infinity.
    pub length: f32,
    /// Index into the scene's materials.
    pub material: usize,
}

/// A cone or frustum about an axis; a single nappe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// The point where the side would meet the axis, world.
    pub apex: Vec3,
    /// Unit vector from the apex into the cone.
    pub axis: Vec3,
    /// Tangent of the angle between axis and side, over 0.
    pub slope: f32,
    /// Where the body begins and ends along the axis, world units from the apex; `0 <= from`,
    /// the end may be infinity.
    pub range: [f32; 2],
    /// Whether the near and the far end are closed by a disc.
    pub caps: [bool; 2],
    /// Index into the scene's materials.
    pub material: usize,
}

/// A triangle; both sides are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Corners, world; anticlockwise from the front.
    pub corners: [Vec3; 3],
    /// Index into the scene's materials.
    pub material: usize,
}

impl Cylinder {
    /// A closed bar between the middles of its caps.
    pub fn between(a: Vec3, b: Vec3, radius: f32, material: usize) -> Self {
        let length = (b - a).length();
        Self { base: a, axis: (b - a) / length, radius, length, material }
    }
}

impl Cone {
    /// A frustum from a disc at `a` to a larger one at `b`; a radius of 0 at `a` is a pointed tip.
    pub fn between(a: (Vec3, f32), b: (Vec3, f32), caps: [bool; 2], material: usize) -> Self {
        let length = (b.0 - a.0).length();
        let axis = (b.0 - a.0) / length;
        let slope = (b.1 - a.1) / length;
        let from = a.1 / slope;
        Self { apex: a.0 - axis * from, axis, slope, range: [from, from + length], caps, material }
    }
}
