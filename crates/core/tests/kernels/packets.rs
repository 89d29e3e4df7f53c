//! A door is the packet's own lane: the same bits, whatever rides in the other lanes.

use super::draw::*;
use glam::Vec3;
use luc_core::kernels::{self, Ray};
use luc_core::math::lanes::{F, V3};
use luc_core::scene::{Cone, Cylinder, Plane, Sphere};
use luc_core::shade::{self, dielectric, phase};
use luc_core::trace::{self, Rays8, Span};
use proptest::prelude::*;

fn lane(span: &Span, i: usize) -> (u32, u32) {
    let (t, _) = span.first();
    let t = t.as_array()[i];
    // A door tells of what lies in front only.
    let ahead = t > 0.0 && t < f32::INFINITY;
    if ahead { (t.to_bits(), span.exit.as_array()[i].to_bits()) } else { (0, 0) }
}

proptest! {
    #![proptest_config(config(5_000))]

    #[test]
    fn doors_give_the_bits_of_packets(
        origins in prop::array::uniform8(vector(-4, 8)),
        ways in prop::array::uniform8(direction()),
        at in vector(-4, 4),
        axis in direction(),
        size in size(-6, 6),
        numbers in prop::array::uniform8(share()),
        others in prop::array::uniform8(share()),
    ) {
        let rays = Rays8 { origin: V3::from_fn(|i| origins[i].into()), direction: V3::from_fn(|i| ways[i].into()) };
        let bar = Cylinder { base: at.into(), axis: axis.into(), radius: size, length: 2.0 * size, material: 0 };
        let cone = Cone { apex: at.into(), axis: axis.into(), slope: size, range: [0.0, 1.0], caps: [true; 2], material: 0 };
        let spans = [
            trace::sphere(&rays, &Sphere { centre: at.into(), radius: size, material: 0, blend: 0.0 }),
            trace::plane(&rays, &Plane { point: at.into(), normal: axis.into(), reach: f32::INFINITY, material: 0 }),
            trace::cylinder(&rays, &bar),
            trace::cone(&rays, &cone),
        ];
        let (x, y) = (F::new(numbers), F::new(others));
        let ior = F::splat(1.5);
        let shares = [
            dielectric::reflectance(x, F::ONE, ior),
            shade::masking(x, y),
            phase::phase(0.7, x),
            shade::schlick(V3::splat(Vec3::splat(0.04)), F::ONE, x).x,
            trace::smooth_min(x, y, 0.25).0,
        ];
        for i in 0..8 {
            let ray = Ray { origin: origins[i], direction: ways[i] };
            let doors = [
                kernels::sphere(&ray, at, size),
                None,
                kernels::capped_cylinder(&ray, at, axis, size, 2.0 * size),
                kernels::capped_cone(&ray, at, axis, size, [0.0, 1.0]),
            ];
            for (k, (span, door)) in spans.iter().zip(doors).enumerate() {
                let door = door.map_or((0, 0), |c| (c.first().to_bits(), c.exit.to_bits()));
                let door = if k == 1 {
                    kernels::plane(&ray, at, axis).map_or((0, 0), |t| (t.to_bits(), t.to_bits()))
                } else {
                    door
                };
                prop_assert_eq!(lane(span, i), door, "shape {} lane {}: {:?}", k, i, ray);
            }
            let doors = [
                kernels::fresnel(numbers[i], 1.0, 1.5),
                kernels::smith_g1(numbers[i], others[i]),
                kernels::henyey_greenstein(numbers[i], 0.7),
                kernels::schlick(0.04, numbers[i]),
                kernels::smooth_union(numbers[i], others[i], 0.25),
            ];
            for (share, door) in shares.iter().zip(doors) {
                prop_assert_eq!(share.as_array()[i].to_bits(), door.to_bits());
            }
        }
    }
}
