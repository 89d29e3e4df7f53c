//! Bounds of the bodies that a field is joined of: small drops apart from the rest must be found.
//!
//! A body's bound is grown by a quarter of the join's radius, which is how far two of them swell. A
//! surface that is swollen more lies before all of its bodies, which is where a sample finds it.

use super::cover::ball_may_cover;
use super::dop::{Dop, View};
use crate::math::Vec3;
use crate::scene::Scene;
use glam::Vec2;

/// A finite body of a field as the eye sees it.
#[derive(Clone, Copy, Debug)]
pub struct FieldNode {
    /// Index of the field among the shapes.
    pub shape: usize,
    /// Index of the node in the field.
    pub index: f32,
    dop: Dop,
    /// Middle in view coordinates, and radius, of a ball.
    ball: Option<(Vec3, f32)>,
}

/// The bodies of a scene's fields, in place of what `out` held.
#[cfg_attr(luc_size, optimize(size))]
pub fn field_nodes(scene: &Scene, view: &View, out: &mut Vec<FieldNode>) {
    out.clear();
    let first = scene.shape_count() - scene.fields.len();
    for (i, field) in scene.fields.iter().enumerate() {
        for (k, node) in field.nodes.iter().enumerate() {
            let Some(half) = node.core() else { continue };
            let grown = node.rounding + 0.25 * node.blend;
            let ball = (half == Vec3::ZERO).then_some((view.local(node.centre), grown));
            let dop = match ball {
                Some((c, r)) => Dop::ball(c, r),
                None => Dop::cuboid(view, node.centre, node.axes.unwrap_or_default(), half + grown),
            };
            out.push(FieldNode { shape: first + i, index: k as f32, dop, ball });
        }
    }
}

impl FieldNode {
    /// Whether the body may cover part of the cell around `centre` with half sides `half` (on the
    /// plane one unit ahead), whose corners are at `depths`.
    pub fn may_cover(&self, centre: Vec2, half: Vec2, depths: &[f32; 4]) -> bool {
        let deepest = depths.iter().fold(0.0_f32, |m, &d| m.max(d));
        !self.dop.unbounded
            && self.dop.near < deepest
            && self.dop.meets_rectangle(centre, half)
            && self.ball.is_none_or(|(c, r)| ball_may_cover(c, r, centre, half, deepest))
    }
}
