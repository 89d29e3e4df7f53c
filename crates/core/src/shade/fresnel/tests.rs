//! Refraction against f64: reversible, total exactly where the sine says, continuous there.

use super::*;
use crate::math::Vec3;
use crate::math::check::Worst;
use crate::math::lanes::{ZERO, splat};
use crate::scene::Material;
use crate::trace::check::{self, Random, U};
use glam::DVec3;

/// A glass surface with this unit normal towards the rays and this geometric normal.
fn glass(normal: V3, facing: V3, inside: bool, ior: f32, f0: f32) -> Surface {
    let material = Material { transparency: 1.0, ior, f0: Vec3::splat(f0), ..Material::default() };
    let inside = if inside { crate::math::lanes::TRUE } else { ZERO };
    check::surface(material, normal, facing, inside)
}

/// Unit directions that fall on the side of `n`, grazing in part.
fn falling(random: &mut Random, n: Vec3) -> Vec3 {
    let any = random.direction();
    let across = (any - n * any.dot(n)).normalize_or(n.any_orthogonal_vector());
    let d = if random.one_in(2) { any } else { across + n * random.signed(-24, 0) };
    crate::math::normalize(if d.dot(n) > 0.0 { -d } else { d })
}

#[test]
fn refraction_is_reversible_and_total_where_the_sine_says() {
    let mut random = Random::new(300);
    let (mut worst, mut length_off, mut totals) = (0.0_f64, 0.0_f64, 0);
    for _ in 0..40_000 {
        let n = random.direction();
        let ior = random.range(1.0, 2.5);
        let inside = random.one_in(2);
        let rays = [0; 8].map(|_| falling(&mut random, n));
        let d = V3::from_fn(|i| rays[i]);
        let s = glass(V3::splat(n), V3::splat(n), inside, ior, 0.04);
        let found = split(Shading::Phong, &s, d);
        // Back from the other side.
        let back =
            split(Shading::Phong, &glass(V3::splat(-n), V3::splat(-n), !inside, ior, 0.04), -found.refracted);
        for (i, ray) in rays.into_iter().enumerate() {
            let replay = || format!("normal {n:?} direction {ray:?} ior {ior:?} inside {inside}");
            let eta = if inside { f64::from(ior) } else { 1.0 / f64::from(ior) };
            let (n, ray) = (n.as_dvec3(), ray.as_dvec3());
            let sine = eta * n.cross(ray).length();
            let total = found.total.to_bits().to_array()[i] != 0;
            if (sine - 1.0).abs() > 6.0 * U {
                assert_eq!(total, sine > 1.0, "sine {sine} {}", replay());
            }
            let light = found.reflectance.lane(i);
            assert!(light.min_element() >= 0.0 && light.max_element() <= 1.0, "{light} {}", replay());
            let mirrored = found.mirrored.lane(i).as_dvec3();
            assert!(mirrored.dot(n) >= -2.0 * U, "{mirrored} {}", replay());
            length_off = length_off.max((mirrored.length() - 1.0).abs());
            totals += u32::from(total);
            if total {
                assert_eq!(light, Vec3::ONE);
                continue;
            }
            let refracted = found.refracted.lane(i).as_dvec3();
            assert!(refracted.dot(n) <= 2.0 * U, "{refracted} {}", replay());
            length_off = length_off.max((refracted.length() - 1.0).abs());
            // Snell's law, scaled by how fast the angle runs at the critical angle.
            let cos_out = (1.0 - sine * sine).max(0.0).sqrt();
            let across = (ray - n * ray.dot(n)) * eta;
            let exact: DVec3 = across - n * cos_out;
            let condition = U * (1.0 + eta * eta) * (1.0 + 1.0 / cos_out.max(1e-3));
            worst = worst.max((refracted - exact).length() / condition);
            if back.total.to_bits().to_array()[i] == 0 {
                let returned = -back.refracted.lane(i).as_dvec3();
                let cos_in = -ray.dot(n);
                let condition = U * (1.0 + 1.0 / (eta * eta)) * (1.0 + (1.0 / cos_in).min(1e3));
                let off = (returned - ray).length();
                // The critical angle hides what is less than √u off it.
                if cos_in > 1e-3 && cos_out > 1e-3 {
                    assert!(off <= 8.0 * condition, "comes back {off} off, {condition}: {}", replay());
                }
            }
        }
    }
    println!(
        "refraction: 320000 rays, {totals} total, worst score {worst:.2}, length off by {:.2} u",
        length_off / U
    );
    assert!(worst < 8.0 && length_off < 6.0 * U && totals > 10_000);
}

#[test]
fn reflectance_is_continuous_at_the_critical_angle() {
    for ior in [1.1_f32, 1.333, 1.5, 2.4] {
        let critical = 1.0 / f64::from(ior);
        for (step, limit) in [(1e-4, 0.2), (1e-5, 0.07), (1e-6, 0.03)] {
            let sine = critical - step;
            let d = DVec3::new(sine, -(1.0 - sine * sine).sqrt(), 0.0).as_vec3();
            let s = glass(V3::splat(Vec3::Y), V3::splat(Vec3::Y), true, ior, 0.04);
            let found = split(Shading::Phong, &s, V3::splat(d));
            let light = found.reflectance.lane(0).x;
            assert_eq!(found.total.to_bits().to_array()[0], 0);
            assert!(
                (1.0 - f64::from(light)) < limit,
                "ior {ior}: {light} at {step} under the critical angle"
            );
        }
    }
}

#[test]
fn schlick_runs_from_f0_to_one_and_falls_by_no_more_than_rounding() {
    let f0 = V3::splat(Vec3::new(0.0, 0.04, 0.9));
    assert_eq!(schlick(f0, splat(1.0), splat(1.0)), f0);
    assert_eq!(schlick(f0, splat(1.0), splat(0.0)), V3::splat(Vec3::ONE));
    assert_eq!(schlick(f0, splat(1.0), splat(-0.5)), V3::splat(Vec3::ONE));
    let mut last = f0.lane(0);
    for i in (0..=100_000).rev() {
        let now = schlick(f0, splat(1.0), splat(i as f32 / 100_000.0)).lane(0);
        // An ulp: f0 falls while the rest rises, each rounded on its own.
        let rises = now.cmpge(last * (1.0 - f32::EPSILON)).all();
        assert!(rises && now.cmpge(f0.lane(0)).all() && now.max_element() <= 1.0, "{i}: {last} {now}");
        last = last.max(now);
    }
}

#[test]
fn schlick_is_within_4_ulp() {
    let mut random = Random::new(302);
    let mut worst = Worst::new("Schlick");
    for _ in 0..400_000 {
        let share = |random: &mut Random| match random.bits() % 3 {
            0 => random.range(0.0, 1.0),
            1 => random.size(-40, 0),
            _ => 1.0 - random.size(-24, 0),
        };
        let (f0, cos) = (share(&mut random), share(&mut random));
        let m = 1.0 - f64::from(cos);
        let w = (m * m) * (m * m) * m;
        let exact = f64::from(f0) * (1.0 - w) + w;
        worst.add(cos, schlick(V3::splat(Vec3::splat(f0)), splat(1.0), splat(cos)).x.as_array()[0], exact);
    }
    assert!(worst.ulp() <= 4.0);
}

#[test]
fn blended_normals_never_mirror_into_the_body_and_true_ones_mirror_truly() {
    let mut random = Random::new(301);
    for _ in 0..40_000 {
        let facing = random.direction();
        let normal = crate::math::normalize(facing + random.direction() * random.size(-8, 0));
        let rays = [0; 8].map(|_| falling(&mut random, facing));
        let d = V3::from_fn(|i| rays[i]);
        let found = split(Shading::Phong, &glass(V3::splat(normal), V3::splat(facing), false, 1.5, 0.04), d);
        let flat = split(Shading::Phong, &glass(V3::splat(facing), V3::splat(facing), false, 1.5, 0.04), d);
        for (i, ray) in rays.into_iter().enumerate() {
            let n = facing.as_dvec3().normalize();
            let up = found.mirrored.lane(i).as_dvec3().dot(n);
            assert!(up > 0.0, "{up:e} {facing:?} {normal:?} {ray:?}");
            let ray = ray.as_dvec3();
            // At grazing a mirrored ray is lifted by up to 1e-6.
            let off = (flat.mirrored.lane(i).as_dvec3() - (ray - n * 2.0 * ray.dot(n))).length();
            assert!(off < 12.0 * U + 1e-6, "{off:e} {facing:?} {ray:?}");
        }
    }
}
