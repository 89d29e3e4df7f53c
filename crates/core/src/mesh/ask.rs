//! Whether facets may lie between rays: in a cell of the picture, or between it and a lamp.

use super::Assembly;
use crate::bvh::{LEAF, Stack};
use crate::counters::Counters;
use crate::math::lanes::{F, V3, splat};
use crate::trace::Rays8;
use glam::Vec3;

/// The pyramid that four rays from one point span.
struct Pyramid {
    apex: Vec3,
    /// Directions of the corners in a circle, twice.
    corners: V3,
    /// Normals of the sides, inwards.
    sides: V3,
    /// 1 / distance up to which facets count, along each corner.
    inverse: F,
}

impl Pyramid {
    fn new(rays: &Rays8, inverse: F) -> Self {
        let d = rays.direction;
        let turned = |by: usize| V3::from_fn(|lane| d.lane(lane + by));
        let n = d.cross_exact(turned(1));
        let inwards = n.dot(turned(2)).simd_ge(F::ZERO);
        Self { apex: rays.origin.lane(0), corners: d, sides: V3::select(inwards, n, -n), inverse }
    }

    /// Whether a triangle may reach into the pyramid, before the distances at its corners.
    ///
    /// It doesn't if it lies outside one of the sides, or the pyramid outside one of the planes
    /// through the apex and an edge, or its plane is not before the distance at any corner. Where
    /// rounding may tell either way, it does.
    fn meets(&self, triangle: [Vec3; 3]) -> bool {
        let p = triangle.map(|p| p - self.apex);
        let reach = p.iter().fold(0.0_f32, |m, p| m.max(p.abs().max_element()));
        let small = 4e-6;
        let sides = self.sides.length() * splat(small * reach);
        let outside = p.map(|p| V3::splat(p).dot(self.sides).simd_lt(-sides));
        if (outside[0] & outside[1] & outside[2]).any() {
            return false;
        }
        let corners = self.corners.length() * splat(small);
        for i in 0..3 {
            let n = p[i].cross(p[(i + 1) % 3]);
            let third = n.dot(p[(i + 2) % 3]);
            let n = if third < 0.0 { -n } else { n };
            let size = n.length();
            let clear = third.abs() > small * size * reach;
            if clear && V3::splat(n).dot(self.corners).simd_lt(-(corners * splat(size))).all() {
                return false;
            }
        }
        let n = (p[1] - p[0]).cross(p[2] - p[0]);
        let height = n.dot(p[0]);
        // 1 / distance of its plane along the corners.
        let inverse = V3::splat(n).dot(self.corners) / splat(height);
        let near = height.abs() <= small * n.length() * reach;
        near || !inverse.simd_le(self.inverse * splat(1.000_02)).all()
    }
}

impl Assembly {
    /// Whether a facet may lie in the pyramid that four directions from `apex`, in a circle, span,
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
        let rays = Rays8 { origin: V3::splat(apex), direction: V3::from_fn(|lane| corners[lane & 3]) };
        let inverse = F::new(std::array::from_fn(|lane| 1.0 / ends[lane & 3]));
        let farthest = ends.iter().fold(0.0_f32, |m, &t| if t > m { t } else { m });
        let mut found = false;
        self.tree.walk(&rays, farthest, &mut Stack::new(), counters, &mut |item, stack, counters| {
            let instance = &self.instances[self.tree.leaves[item as usize][0] as usize];
            let mesh = instance.mesh();
            let local = instance.local(&rays);
            let pyramid = Pyramid::new(&local, inverse);
            mesh.tree.walk(
                &local,
                if found { -1.0 } else { farthest },
                stack,
                counters,
                &mut |item, _, _| {
                    let items = mesh.tree.leaves[item as usize].iter().take(LEAF);
                    found |= items
                        .filter_map(|&i| mesh.triangles.get(i as usize))
                        .any(|&triangle| pyramid.meets(triangle));
                    if found { -1.0 } else { farthest }
                },
            );
            if found { -1.0 } else { farthest }
        });
        found
    }
}
