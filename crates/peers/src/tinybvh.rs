//! tinybvh's tree of eight children for processors, by the crate that compiles its C++.
//!
//! The crate asks for nearest hits only, so shadow rays look for the nearest one before the lamp. Its
//! `Ray::new` writes beyond the ray (version 0.1.0-beta.3, on x86-64), so rays are made of their fields.

use crate::peers::each;
use crate::rays::Rays;
use crate::triangles::Tracer;
use glam::Vec3A;
use tinybvh_rs::{Intersection, Intersector, Ray, bvh, bvh8_cpu, mbvh};

/// Triangles that a leaf of this tree may hold.
const LEAF: u32 = 4;

/// Rays are hit by all that a mask of 16 bits allows.
const MASK: u32 = 0xffff;

struct Tree(bvh8_cpu::BVH);

/// A ray on the lines of the cache that C++ wants it on.
#[repr(align(64))]
struct Aligned(Ray);

pub fn build(triangles: &[[Vec3A; 3]]) -> Box<dyn Tracer> {
    let corners: Vec<[f32; 4]> = triangles.iter().flatten().map(|p| p.extend(0.0).to_array()).collect();
    let mut binary = bvh::BVH::new(corners.as_slice().into()).expect("three corners for each triangle");
    binary.split_leaves(LEAF);
    let wide = mbvh::BVH::new(&binary);
    Box::new(Tree(bvh8_cpu::BVH::new(&wide).expect("leaves as small as it wants them")))
}

impl Tracer for Tree {
    fn trace(&self, rays: &Rays, out: &mut [f32]) {
        let nearest = |i: usize| {
            let (origin, dir) = (rays.origins[i], rays.directions[i]);
            let end = rays.ends[i].min(tinybvh_rs::INFINITE);
            let mut ray = Aligned(Ray {
                origin: origin.to_array(),
                padding_0: MASK,
                dir: dir.to_array(),
                r_d: dir.recip().to_array(),
                hit: Intersection { t: end, ..Intersection::new() },
                ..Ray::default()
            });
            self.0.intersect(&mut ray.0);
            let t = ray.0.hit.t;
            if t < end { t } else { f32::INFINITY }
        };
        each(rays, out, nearest, |i| nearest(i).is_finite());
    }
}
