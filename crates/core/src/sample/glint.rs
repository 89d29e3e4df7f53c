//! Shining rectangles that a curved mirror may show between the samples of a cell.
//!
//! Each sample's mirrored ray meets a rectangle's plane somewhere. If none meets the rectangle but
//! the box around their places does, it may shine in between, however thin it is there.

use super::refine::Known;
use crate::render::Stage;
use glam::Vec2;

impl Known<'_> {
    /// Whether the shape with index `own`, on which all samples lie, may mirror a rectangle that
    /// none of them shows.
    #[inline(never)]
    pub fn may_hide_glint(&self, stage: &Stage, own: usize) -> bool {
        let shape = stage.scene.shape(own);
        if shape.is_flat() || stage.scene.materials[shape.material()].reflection <= 0.0 {
            return false;
        }
        stage.scene.emitters.iter().any(|emitter| {
            let (mut lo, mut hi, mut seen) = (Vec2::INFINITY, Vec2::NEG_INFINITY, false);
            for s in self.samples {
                let (p, n) = (s.point(), s.normal());
                let d = p - stage.view.origin;
                let d = d - n * (2.0 * n.dot(d));
                let facing = emitter.normal().dot(d);
                let off = emitter.centre - p;
                let t = off.dot(emitter.normal()) / facing;
                // Rays that go away from the plane leave it to the others.
                if facing >= 0.0 || t <= 0.0 {
                    continue;
                }
                let q = d * t - off;
                let at = Vec2::new(q.dot(emitter.u), q.dot(emitter.v)) / Vec2::from(emitter.half);
                (lo, hi) = (lo.min(at), hi.max(at));
                seen |= at.abs().max_element() < 1.0;
            }
            // Curved, it bulges a little out of the box.
            let room = (hi - lo) * 0.25;
            !seen && lo.x <= hi.x && (lo - room).max_element() < 1.0 && (hi + room).min_element() > -1.0
        })
    }
}
