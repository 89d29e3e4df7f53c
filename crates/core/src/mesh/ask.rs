//! Whether facets may lie between rays: in a cell of the picture, or between it and a lamp.

use super::Assembly;
use crate::counters::Counters;
use crate::math::lanes::{F, V3, greatest, splat, twice};
use crate::math::{Vec3, cross};
use crate::trace::Rays8;

/// The pyramid that four rays from one point span, up to some distance.
struct Pyramid {
    apex: Vec3,
    /// Directions of the corners.
    corners: V3,
    /// Their lengths, times what rounding may do.
    small: F,
    /// 1 / distance up to which facets count, along each corner.
    inverse: F,
}

/// What rounding may do to the sign of a triple product, relative to its factors.
const SMALL: f32 = 1e-6;

impl Pyramid {
    /// Whether a triangle may reach into the pyramid, before the distances at its corners.
    ///
    /// It doesn't if the pyramid lies outside one of the planes through the apex and an edge, or
    /// if its plane is not before the distance at any corner. Where rounding may tell either way,
    /// it does.
    #[inline(never)]
    fn meets(&self, triangle: &[Vec3; 3]) -> bool {
        let p = triangle.map(|p| p - self.apex);
        let away = p.map(Vec3::length);
        let along = |n: Vec3| V3::splat(n).dot(self.corners);
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let n = cross(p[i], p[j]);
            let third = n.dot(p[k]);
            let n = if third < 0.0 { -n } else { n };
            // Of the factors, not of the product: that is nearly all rounding for an edge towards the apex.
            let size = away[i] * away[j];
            let clear = third.abs() > SMALL * size * away[k];
            if clear && along(n).simd_lt(-(self.small * splat(size))).all() {
                return false;
            }
        }
        let [a, b] = [p[1] - p[0], p[2] - p[0]];
        let n = cross(a, b);
        let height = n.dot(p[0]);
        // 1 / distance of its plane along the corners.
        let inverse = along(n) / splat(height);
        let near = height.abs() <= SMALL * a.length() * b.length() * (away[0] + away[1] + away[2]);
        near || !inverse.simd_le(self.inverse * splat(1.000_02)).all()
    }
}

impl Assembly {
    /// Whether a facet may lie in the pyramid that four directions from `apex` span,
    /// before the distances `ends` (in lengths of the directions) at the corners. A plane through
    /// the ends is none that lies before them.
    #[inline(never)]
    pub fn may_lie_between(
        &self,
        apex: Vec3,
        corners: [Vec3; 4],
        ends: [f32; 4],
        counters: &mut Counters,
    ) -> bool {
        if self.is_empty() {
            return false;
        }
        let rays = Rays8 { origin: V3::splat(apex), direction: V3::from_fn(|lane| corners[lane & 3]) };
        let ends = twice(&ends);
        let inverse = F::ONE / ends;
        let mut limit = greatest(ends).as_array()[0];
        self.tree.walk(
            (&self.tree.slabs(&rays), 0xff),
            limit,
            counters,
            &mut |leaf: usize, _: usize, counters: &mut Counters| {
                let instance = &self.instances[self.tree.leaves[leaf][0] as usize];
                let mesh = instance.mesh();
                let local = instance.local(&rays);
                let corners = local.direction;
                let small = corners.length() * splat(SMALL);
                let pyramid = Pyramid { apex: local.origin.lane(0), corners, small, inverse };
                mesh.tree.walk(
                    (&mesh.tree.slabs(&local), 0xff),
                    limit,
                    counters,
                    &mut |leaf: usize, count: usize, _: &mut Counters| {
                        if mesh.tree.leaves[leaf][..count]
                            .iter()
                            .any(|&i| pyramid.meets(&mesh.triangles[i as usize]))
                        {
                            limit = -1.0;
                        }
                        limit
                    },
                );
                limit
            },
        );
        limit < 0.0
    }
}
