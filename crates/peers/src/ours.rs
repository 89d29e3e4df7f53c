//! Our own tree, as the engine asks it: in packets of eight.

use crate::rays::{Kind, Rays};
use crate::triangles::Tracer;
use luc_core::counters::Counters;
use luc_core::math::lanes::{F, TRUE, V3, splat};
use luc_core::math::{Mat3, Vec3};
use luc_core::mesh::{Assembly, Blockers, Instance, Mesh};
use luc_core::scene::{Material, Scene};
use luc_core::trace::{Hits, NONE, Rays8};
use std::sync::Arc;

struct Ours(Scene);

fn own(p: glam::Vec3A) -> Vec3 {
    Vec3::from_array(p.to_array())
}

pub fn build(triangles: &[[glam::Vec3A; 3]]) -> Box<dyn Tracer> {
    let mesh = Arc::new(Mesh::flat(triangles.iter().map(|t| t.map(own)).collect()));
    let meshes = Assembly::new(vec![Instance::new(&mesh, Mat3::IDENTITY, Vec3::ZERO, 0)]);
    Box::new(Ours(Scene { meshes, materials: vec![Material::DEFAULT], ..Scene::default() }))
}

impl Tracer for Ours {
    fn trace(&self, rays: &Rays, out: &mut [f32]) {
        let mut counters = Counters::default();
        let any = rays.kind == Kind::Shadow;
        for i in (0..rays.len()).step_by(8) {
            let eight = |list: &[glam::Vec3A]| V3::from_fn(|lane| own(list[i + lane]));
            let packet = Rays8 { origin: eight(&rays.origins), direction: eight(&rays.directions) };
            let end = F::new(std::array::from_fn(|lane| rays.ends[i + lane]));
            // The others don't know what hid the rays before either.
            let blockers = Blockers::new([NONE; 4]);
            let mut best = Hits { t: end, id: splat(NONE) };
            self.0.meshes.search(&self.0, &packet, TRUE, any.then_some(&blockers), &mut best, &mut counters);
            let missed = best.t.simd_eq(end);
            let t = missed.select(splat(f32::INFINITY), best.t);
            out[i..i + 8].copy_from_slice(t.as_array());
        }
    }
}
