//! A pinhole camera: position, target, roll and horizontal field of view.
//!
//! A picture wider than 16:9 shows more at the sides instead of less above and below: fov is then that of the
//! 16:9 picture in its middle.

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
    /// Horizontal field of view of a picture not wider than 16:9, radians, over 0 and under pi.
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
        let right = crate::math::normalize(right);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::Random;
    use crate::quality::Quality;
    use crate::render::{Stage, Tables};
    use crate::scene::Scene;

    #[test]
    fn right_up_and_forward_are_orthonormal_wherever_it_looks() {
        let mut random = Random::new(1100);
        for case in 0..50_000 {
            let position = random.vector(-4, 8);
            let target = match case % 5 {
                0 => position,
                1 => position + Vec3::Y * random.signed(-3, 6),
                _ => position + random.direction() * random.size(-4, 8),
            };
            let camera = Camera { position, target, roll: random.signed(-8, 2), fov: 0.8 };
            let [right, up, forward] = [0, 1, 2].map(|i| camera.world_from_camera().col(i));
            let ahead = (target - position).normalize_or(Vec3::NEG_Z);
            let off = [
                right.length() - 1.0,
                up.length() - 1.0,
                right.dot(up),
                right.dot(forward),
                up.dot(forward),
                (cross(right, up) + forward).length(),
                (forward - ahead).length(),
            ];
            assert!(off.iter().all(|x| x.abs() < 1e-6), "{camera:?}: {off:?}");
        }
    }

    #[test]
    fn a_roll_turns_the_camera_anticlockwise() {
        let level = Camera::default();
        let quarter = Camera { roll: core::f32::consts::FRAC_PI_2, ..level };
        let [a, b] = [level, quarter].map(|camera| camera.world_from_camera());
        assert!((b.x_axis - a.y_axis).length() < 1e-6, "its right side is where up was");
        assert!((b.y_axis + a.x_axis).length() < 1e-6, "its upper side is on the left");
    }

    #[test]
    fn a_picture_wider_than_16_to_9_is_as_high_as_one_of_that_shape() {
        let scene = Scene::default();
        let top = |size| {
            let tables = &mut Tables::default();
            let stage = Stage::new(&scene, &Quality::PRESETS[Quality::DEFAULT].1, size, tables);
            stage.direction(size[0] as f32 * 0.5, 0.0)
        };
        for size in [[840, 360], [2560, 360], [641, 360]] {
            assert!((top(size) - top([640, 360])).length() < 1e-6, "{size:?}");
        }
    }

    #[test]
    fn the_picture_is_as_wide_as_the_field_of_view_and_has_the_target_in_its_middle() {
        for fov in [0.02, 0.5, 0.8, 1.5, 2.5, 3.1] {
            for (width, height) in [(1, 1), (640, 360), (37, 91)] {
                let camera =
                    Camera { position: Vec3::new(1.0, 2.0, 3.0), fov, roll: 0.3, ..Camera::default() };
                let scene = Scene { camera, ..Scene::default() };
                let tables = &mut Tables::default();
                let stage =
                    Stage::new(&scene, &Quality::PRESETS[Quality::DEFAULT].1, [width, height], tables);
                let middle = height as f32 * 0.5;
                let [left, right] = [0.0, width as f32].map(|x| stage.direction(x, middle).as_dvec3());
                #[allow(clippy::disallowed_methods, reason = "an oracle in f64 that never reaches a pixel")]
                let angle = left.cross(right).length().atan2(left.dot(right));
                assert!((angle - f64::from(fov)).abs() < 2e-6, "{angle} for {fov} at {width}x{height}");
                let ahead = crate::math::normalize(camera.target - camera.position);
                assert!((stage.direction(width as f32 * 0.5, middle) - ahead).length() < 1e-6);
            }
        }
    }
}
