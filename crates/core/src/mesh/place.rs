//! Instances: meshes placed in a scene, and where rays meet them.

use super::{Mesh, gather};
use crate::bvh::{Bounds, Tree};
use crate::features;
use crate::math::lanes::{Bound, F, V3, splat};
use crate::math::{Mat3, Vec3, number, whole};
use crate::trace::{Aim, Crossing, Rays8, Span};
use std::sync::Arc;

/// A mesh at a place: `world = world_from_mesh * p + origin`.
///
/// The map may scale, also unevenly, shear and mirror, up to a condition of about 64; beyond that
/// what rounding does in the mesh's space may be seen in the world.
#[derive(Clone, Debug)]
pub struct Instance {
    mesh: Arc<Mesh>,
    origin: Vec3,
    world_from_mesh: Mat3,
    mesh_from_world: Mat3,
    /// Index into the scene's materials.
    pub material: usize,
    /// Index of its first facet among those of the assembly.
    first: usize,
    /// Half the surface of its mesh's box over the number of triangles, about, world.
    pub(super) grain: f32,
}

/// All instances of a scene, and a tree over them.
///
/// Their triangles, the facets, are numbered in the order of the instances.
#[derive(Clone, Debug, Default)]
pub struct Assembly {
    pub(super) instances: Vec<Instance>,
    pub(super) tree: Tree,
}

/// What a surface needs to know of facets that rays meet.
pub struct Facets {
    /// Points of the facets, world.
    pub point: V3,
    /// Unit normals on the side from which corners run anticlockwise.
    pub outward: V3,
    /// Unit normals for shading.
    pub normal: V3,
    /// Greatest coordinates that the points were computed from, world.
    pub reach: F,
    /// Weights of the second and third corners.
    pub uv: [F; 2],
}

/// A matrix times vectors, column by column.
#[inline(never)]
fn times(m: &Mat3, v: V3) -> V3 {
    V3::splat(m.x_axis) * v.x + V3::splat(m.y_axis) * v.y + V3::splat(m.z_axis) * v.z
}

impl Instance {
    /// The mesh placed by an affine map that can be inverted.
    #[cfg_attr(luc_size, optimize(size))]
    pub fn new(mesh: &Arc<Mesh>, world_from_mesh: Mat3, origin: Vec3, material: usize) -> Self {
        let mesh_from_world = world_from_mesh.inverse();
        let m = &world_from_mesh;
        let scale = m.x_axis.length_squared().max(m.y_axis.length_squared()).max(m.z_axis.length_squared());
        let grain = scale * mesh.tree.bounds.area() / number(mesh.triangles.len());
        Self { mesh: mesh.clone(), origin, world_from_mesh, mesh_from_world, material, first: 0, grain }
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// A point of the mesh in the world.
    pub fn to_world(&self, p: Vec3) -> Vec3 {
        self.world_from_mesh * p + self.origin
    }

    /// Rays in the mesh's space; distances along them are the same.
    #[inline(never)]
    pub(super) fn local(&self, rays: &Rays8) -> Rays8 {
        let m = &self.mesh_from_world;
        Rays8 { origin: times(m, rays.origin - V3::splat(self.origin)), direction: times(m, rays.direction) }
    }

    /// The box around it in the world.
    fn bounds(&self) -> Bounds {
        let Bounds { lo, hi } = self.mesh.tree.bounds;
        let (middle, half) = ((lo + hi) * 0.5, (hi - lo) * 0.5);
        let m = &self.world_from_mesh;
        let middle = self.to_world(middle);
        let half = m.x_axis.abs() * half.x + m.y_axis.abs() * half.y + m.z_axis.abs() * half.z;
        // Room for rounding in the mesh's space, see the condition above.
        let half = half + (half + middle.abs()).max_element() * 1e-5;
        Bounds { lo: middle - half, hi: middle + half }
    }

    /// Id of its first facet, and of the first one after it, where the assembly's start at `base`.
    pub(crate) fn ids(&self, base: f32) -> [f32; 2] {
        [self.first, self.first + self.mesh.triangles.len()].map(|facet| base + 4.0 * number(facet))
    }

    /// Where rays cross a facet.
    pub fn span(&self, facet: usize, rays: &Rays8) -> Span {
        let corners = self.mesh.triangles[facet].map(V3::splat);
        let crossing = Aim::new(&self.local(rays)).cross(&corners).unwrap_or(Crossing::NONE);
        Span::single(crossing.t, crossing.hit)
    }

    /// The facets that rays meet, by their indices in the mesh; lanes with another index hold
    /// nonsense. The point is a mean of corners, so it lies on the facet whatever the distance.
    #[inline(never)]
    #[cfg_attr(luc_size, optimize(size))]
    pub fn facets(&self, rays: &Rays8, index: F) -> Facets {
        let last = self.mesh.triangles.len() - 1;
        let index = index.to_array().map(|i| whole(i).min(last) as u32);
        let corners = gather(&self.mesh.triangles, &index);
        let crossing = Aim::new(&self.local(rays)).cross(&corners).unwrap_or(Crossing::NONE);
        let weights = crossing.weights.map(|w| w / crossing.sum);
        let mean = |[a, b, c]: [V3; 3]| a * weights[0] + b * weights[1] + c * weights[2];
        let [a, b, c] = corners;
        let p = mean(corners);
        let m = &self.mesh_from_world;
        let columns = [m.x_axis, m.y_axis, m.z_axis].map(V3::splat);
        // Normals go by the inverse transposed.
        let turn = |n: V3| V3::new(columns[0].dot(n), columns[1].dot(n), columns[2].dot(n)).normalize();
        let outward = turn((b - a).cross_exact(c - a));
        let mut normal = outward;
        if self.mesh.is_smooth() {
            let n = turn(mean(gather(&self.mesh.normals, &index)));
            normal = V3::select(n.dot(outward).simd_gt(F::ZERO), n, outward);
        }
        let w = &self.world_from_mesh;
        let stretch = (w.x_axis.abs() + w.y_axis.abs() + w.z_axis.abs()).max_element();
        Facets {
            point: times(w, p) + V3::splat(self.origin),
            outward,
            normal,
            // Rounding of the crossing is that of the corners, which may lie far to both sides.
            reach: a.max_abs().at_least(b.max_abs()).at_least(c.max_abs()) * splat(4.0 * stretch)
                + splat(4.0 * self.origin.abs().max_element()),
            uv: [weights[1], weights[2]],
        }
    }
}

impl Assembly {
    /// Puts instances together.
    #[inline(never)]
    pub fn new(mut instances: Vec<Instance>) -> Self {
        let mut first = 0;
        for instance in &mut instances {
            instance.first = first;
            first += instance.mesh.triangles.len();
        }
        let boxes: Vec<Bounds> = instances.iter().map(Instance::bounds).collect();
        Self { tree: Tree::build(&boxes, 1), instances }
    }

    /// The instances, in order.
    pub fn instances(&self) -> &[Instance] {
        &self.instances
    }

    /// Whether there is nothing to hit.
    pub fn is_empty(&self) -> bool {
        !features::MESHES || self.tree.is_empty()
    }

    /// The instance that a facet belongs to, and the facet's index in its mesh.
    pub fn facet(&self, facet: usize) -> (&Instance, usize) {
        let after = self.instances.partition_point(|i| i.first <= facet);
        let instance = &self.instances[after - 1];
        (instance, facet - instance.first)
    }
}
