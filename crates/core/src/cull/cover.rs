//! Whether a shape may lie in front of what is known at the corners of a cell.
//!
//! The surface between the corners is taken for the front of a convex body: over the cell, its
//! inverse depth is nowhere less than the interpolation of the corners'. Depths are measured along
//! the view axis, where the inverse depth of a plane is linear on the screen, so a plane behind
//! all corners is behind the whole cell. For a ball, the least depth over the cone around the
//! cell; for other shapes their least depth anywhere.

use super::dop::nearest_in_cone;
use crate::features;
use crate::math::{Vec3, cross};
use crate::render::Stage;
use crate::trace::Shape;
use glam::Vec2;

/// Whether shape `index` may cover part of the cell around `centre` with half sides `half` (on
/// the plane one unit ahead), whose corners, in reading order, are at `depths`.
#[inline(never)]
#[cfg_attr(luc_size, optimize(size))]
pub fn may_cover(stage: &Stage, index: usize, centre: Vec2, half: Vec2, depths: &[f32; 4]) -> bool {
    let deepest = depths.iter().fold(0.0_f32, |m, &d| m.max(d));
    match stage.scene.shape(index) {
        Shape::Sphere(s) => ball_may_cover(stage.view.local(s.centre), s.radius, centre, half, deepest),
        Shape::Triangle(s) if features::TRIANGLES => {
            let [a, b, c] = s.corners.map(|p| stage.view.local(p));
            let n = cross(b - a, c - a);
            let height = n.dot(a);
            let signs =
                [Vec2::new(-1.0, 1.0), Vec2::new(1.0, 1.0), Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0)];
            signs.into_iter().zip(depths).any(|(sign, &depth)| {
                let d: Vec3 = (centre + sign * half).extend(1.0).into();
                n.dot(d) / height * depth > 1.000_01
            })
        }
        _ => true,
    }
}

/// Whether a ball (middle in view coordinates) may lie before the depth `deepest` in a cell.
#[inline(never)]
#[cfg_attr(luc_size, optimize(size))]
pub fn ball_may_cover(c: Vec3, radius: f32, centre: Vec2, half: Vec2, deepest: f32) -> bool {
    let reach = half.length();
    let front = nearest_in_cone(c, radius, crate::math::normalize(Vec3::from(centre.extend(1.0))), reach);
    let widest = centre.length() + reach;
    front / (1.0 + widest * widest).sqrt() < deepest * 1.000_01
}
