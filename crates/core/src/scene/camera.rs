//! A pinhole camera: position, target, roll and horizontal field of view.

use crate::math::scalar::sin_cos;
use crate::math::{Mat3, Vec3, cross};

/// Where the eye is and what it looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Eye, world.
    pub position: Vec3,
    /// Point in the middle of the picture, world.
    pub target: Vec3,
    /// Rotation about the view axis, radians; positive turns the camera anticlockwise.
    pub roll: f32,
    /// Horizontal field of view, radians, over 0 and under pi.
    pub fov: f32,
}

impl Default for Camera {
    fn default() -> Self {
        Self { position: Vec3::new(0.0, 0.0, 5.0), target: Vec3::ZERO, roll: 0.0, fov: 0.8 }
    }
}

impl Camera {
    /// Columns right, up and forward of the view, unit vectors in the world.
    ///
    /// A target that equals the position looks along -z; a view straight up or down takes +z for
    /// its up vector.
    pub fn world_from_camera(&self) -> Mat3 {
        let forward = (self.target - self.position).normalize_or(Vec3::NEG_Z);
        let right = cross(forward, Vec3::Y);
        let right = if right.length_squared() > 1e-12 { right } else { cross(forward, Vec3::Z) };
        let right = right.normalize();
        let up = cross(right, forward);
        let (sin, cos) = sin_cos(self.roll);
        Mat3::from_cols(right * cos + up * sin, up * cos - right * sin, forward)
    }

    /// Tangent of half the horizontal field of view, kept inside what a picture can show.
    pub fn half_width(&self) -> f32 {
        let (sin, cos) = sin_cos(self.fov.clamp(1e-4, 3.1) * 0.5);
        sin / cos
    }
}
