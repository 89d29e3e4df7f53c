//! Other crates, each asked as its documentation shows.

use crate::rays::{Kind, Rays};
use crate::triangles::Tracer;
use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use glam::Vec3A;
use nalgebra::{Point3, Vector3};
use obvhs::BvhBuildParams;
use obvhs::bvh2::{Bvh2, builder::build_bvh2_from_tris};
use obvhs::cwbvh::{CwBvh, builder::build_cwbvh_from_tris};
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;
use parry3d::math::Vector;
use parry3d::query::RayCast;
use parry3d::shape::TriMesh;
use std::time::Duration;

/// Fills `out` ray by ray.
pub fn each(rays: &Rays, out: &mut [f32], nearest: impl Fn(usize) -> f32, any: impl Fn(usize) -> bool) {
    for (i, out) in out.iter_mut().enumerate().take(rays.len()) {
        *out = match rays.kind {
            Kind::Shadow if any(i) => -1.0,
            Kind::Shadow => f32::INFINITY,
            _ => nearest(i),
        };
    }
}

fn triangles_of(triangles: &[[Vec3A; 3]]) -> Vec<Triangle> {
    triangles.iter().map(|&[v0, v1, v2]| Triangle { v0, v1, v2 }).collect()
}

fn ray(rays: &Rays, i: usize) -> Ray {
    Ray::new(rays.origins[i], rays.directions[i], 0.0, rays.ends[i].min(f32::MAX))
}

/// A tracer by one of the trees of obvhs, which are asked alike but share no trait.
macro_rules! of_obvhs {
    ($name:ident, $Tree:ident, $build:ident) => {
        pub fn $name(triangles: &[[Vec3A; 3]]) -> Box<dyn Tracer> {
            struct Of($Tree, Vec<Triangle>);

            impl Tracer for Of {
                fn trace(&self, rays: &Rays, out: &mut [f32]) {
                    let Of(tree, triangles) = self;
                    let nearest = |i| {
                        let mut hit = RayHit::none();
                        tree.ray_traverse(ray(rays, i), &mut hit, |ray, id| triangles[id].intersect(ray));
                        hit.t
                    };
                    let any =
                        |i| !tree.ray_traverse_miss(ray(rays, i), |ray, id| triangles[id].intersect(ray));
                    each(rays, out, nearest, any);
                }
            }

            let triangles = triangles_of(triangles);
            let tree = $build(&triangles, BvhBuildParams::fast_build(), &mut Duration::default());
            let ordered = tree.primitive_indices.iter().map(|&i| triangles[i as usize]).collect();
            Box::new(Of(tree, ordered))
        }
    };
}
of_obvhs!(obvhs_wide, CwBvh, build_cwbvh_from_tris);
of_obvhs!(obvhs_binary, Bvh2, build_bvh2_from_tris);

struct Parry(TriMesh);

pub fn parry(triangles: &[[Vec3A; 3]]) -> Box<dyn Tracer> {
    let corners = triangles.iter().flatten().map(|p| Vector::new(p.x, p.y, p.z)).collect();
    let indices = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Box::new(Parry(TriMesh::new(corners, indices).expect("a mesh with triangles")))
}

impl Tracer for Parry {
    fn trace(&self, rays: &Rays, out: &mut [f32]) {
        let vector = |p: Vec3A| Vector::new(p.x, p.y, p.z);
        let ray = |i: usize| parry3d::query::Ray::new(vector(rays.origins[i]), vector(rays.directions[i]));
        let nearest = |i: usize| {
            let end = rays.ends[i].min(f32::MAX);
            self.0.cast_local_ray(&ray(i), end, false).unwrap_or(f32::INFINITY)
        };
        let any = |i: usize| self.0.intersects_local_ray(&ray(i), rays.ends[i]);
        each(rays, out, nearest, any);
    }
}

/// A triangle that knows its box, as the crate wants.
struct Boxed {
    corners: [Point3<f32>; 3],
    bounds: Aabb<f32, 3>,
    node: usize,
}

impl Bounded<f32, 3> for Boxed {
    fn aabb(&self) -> Aabb<f32, 3> {
        self.bounds
    }
}

impl BHShape<f32, 3> for Boxed {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

struct Plain(bvh::bvh::Bvh<f32, 3>, Vec<Boxed>);

pub fn bvh(triangles: &[[Vec3A; 3]]) -> Box<dyn Tracer> {
    let boxed = |t: &[Vec3A; 3]| {
        let corners = t.map(|p| Point3::new(p.x, p.y, p.z));
        let bounds = corners.iter().fold(Aabb::empty(), |b: Aabb<f32, 3>, p| b.grow(p));
        Boxed { corners, bounds, node: 0 }
    };
    let mut shapes: Vec<Boxed> = triangles.iter().map(boxed).collect();
    Box::new(Plain(bvh::bvh::Bvh::build(&mut shapes), shapes))
}

impl Plain {
    fn ray(rays: &Rays, i: usize) -> bvh::ray::Ray<f32, 3> {
        let (o, d) = (rays.origins[i], rays.directions[i]);
        bvh::ray::Ray::new(Point3::new(o.x, o.y, o.z), Vector3::new(d.x, d.y, d.z))
    }

    /// Distance to a triangle from either side: the crate's own test passes over those seen from behind.
    fn distance(ray: &bvh::ray::Ray<f32, 3>, [a, b, c]: &[Point3<f32>; 3]) -> f32 {
        let front = ray.intersects_triangle(a, b, c).distance;
        if front.is_finite() { front } else { ray.intersects_triangle(a, c, b).distance }
    }
}

impl Tracer for Plain {
    fn trace(&self, rays: &Rays, out: &mut [f32]) {
        let Plain(bvh, shapes) = self;
        let nearest = |i: usize| {
            let ray = Plain::ray(rays, i);
            let mut best = f32::INFINITY;
            for shape in bvh.nearest_traverse_iterator(&ray, shapes) {
                // Shapes come by the distance of their boxes.
                if ray.intersection_slice_for_aabb(&shape.bounds).is_some_and(|(near, _)| near > best) {
                    break;
                }
                best = best.min(Plain::distance(&ray, &shape.corners));
            }
            best
        };
        let any = |i: usize| {
            let ray = Plain::ray(rays, i);
            bvh.traverse_iterator(&ray, shapes).any(|s| Plain::distance(&ray, &s.corners) < rays.ends[i])
        };
        each(rays, out, nearest, any);
    }
}
