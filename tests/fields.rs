//! Fields as whole pictures: they mirror, break and shade other shapes and are mirrored, broken and shaded by them,
//! and cast soft shadows by themselves where a scene asks for it.
mod support;

use luc_core::counters::{Counter, Counters};
use luc_core::math::Vec3;
use luc_core::plan::Plan;
use luc_core::quality::Quality;
use luc_core::scene::{
    Camera, Emitter, Field, Join, Light, LightKind, Material, Node, Plane, Scene, Shading, Sphere,
};
use support::picture::{draw, psnr};

const SIZE: (u32, u32) = (320, 180);

fn render(scene: &Scene, quality: &Quality) -> (Vec<u32>, Counters) {
    let (pixels, renderer) = draw(scene, SIZE, quality);
    (pixels, renderer.counters)
}

/// Two bodies as fields over a floor, in the light of a lamp with this radius.
fn fields(penumbra: f32) -> Scene {
    let field = Field::new(vec![
        Node::torus(Vec3::new(-2.0, 2.0, 0.0), 1.2, 0.3),
        Node::sphere(Vec3::new(2.0, 1.4, 0.5), 1.0),
        Node::cuboid(Vec3::new(2.0, 2.6, 0.5), Vec3::splat(0.5), 0.1).joined(Join::Union, 0.4),
    ]);
    let lamp =
        Light { position: Vec3::new(3.0, 9.0, 4.0), colour: Vec3::splat(80.0), kind: LightKind::Point };
    Scene {
        camera: Camera { position: Vec3::new(0.0, 6.0, 10.0), target: Vec3::Y, roll: 0.0, fov: 1.0 },
        fields: vec![field],
        planes: vec![Plane { point: Vec3::ZERO, normal: Vec3::Y, reach: f32::INFINITY, material: 0 }],
        materials: vec![Material { colour: Vec3::splat(0.5), ..Material::default() }],
        lights: vec![lamp],
        ambient: [Vec3::splat(0.02), Vec3::splat(0.1)],
        penumbra,
        ..Scene::default()
    }
}

#[test]
fn fields_soften_their_own_shadows_where_a_scene_asks_for_it() {
    let (hard, soft) = (fields(0.0), fields(0.6));
    for (name, quality) in Quality::PRESETS {
        let plan = |scene| Plan::of(scene, &quality).names(Counter::FieldShadows);
        assert!(plan(&soft) && !plan(&hard), "{name}");
        let [with, without] = [&soft, &hard].map(|scene| {
            let (pixels, counters) = render(scene, &quality);
            assert_eq!(counters.get(Counter::FieldShadows) > 0, plan(scene), "{name}");
            assert_eq!(counters.get(Counter::SoftShadowRays), 0, "{name}");
            pixels
        });
        assert!(with != without, "{name}");
        // Nothing of it where a shining rectangle is drawn by several rays.
        let lamp = Emitter::facing(Vec3::new(3.0, 9.0, 4.0), Vec3::ZERO, 1.0, 1.0, Vec3::splat(90.0));
        let drawn =
            |penumbra| Scene { lights: vec![], emitters: vec![lamp], soft: true, penumbra, ..fields(0.0) };
        let [with, without] = [drawn(0.6), drawn(0.0)].map(|scene| render(&scene, &quality).0);
        assert_eq!(with != without, quality.shadow_samples == 1, "{name}");
    }
}

#[test]
fn a_fields_soft_shadow_is_within_40_db_of_every_pixel_traced() {
    for scene in [fields(0.3), fields(1.2)] {
        let quality = Quality::named("high").unwrap();
        let (adaptive, counters) = render(&scene, &quality);
        let (every, all) = render(&scene, &quality.every_pixel());
        let found = psnr(&every, &adaptive);
        let [rays, all] = [&counters, &all].map(|c| c.get(Counter::ShadowRays));
        assert!(found >= 40.0 && 2 * rays < all, "{found:.1} dB with {rays} of {all} shadow rays");
    }
}

/// Two balls on a floor that mirrors a little, between two lamps, each ball as a field or a sphere.
fn balls(materials: [Material; 2], as_field: [bool; 2]) -> Scene {
    let floor =
        Material { colour: Vec3::splat(0.3), f0: Vec3::splat(0.3), reflection: 1.0, ..Material::default() };
    let lamp = |x: f32, colour| Light { position: Vec3::new(x, 5.0, 6.0), colour, kind: LightKind::Point };
    let mut scene = Scene {
        camera: Camera { position: Vec3::new(0.6, 2.0, 7.0), target: Vec3::Y, roll: 0.0, fov: 0.7 },
        planes: vec![Plane { point: Vec3::ZERO, normal: Vec3::Y, reach: f32::INFINITY, material: 2 }],
        materials: vec![materials[0], materials[1], floor],
        lights: vec![lamp(-6.0, Vec3::new(40.0, 30.0, 20.0)), lamp(5.0, Vec3::new(10.0, 20.0, 40.0))],
        ambient: [Vec3::splat(0.05), Vec3::splat(0.2)],
        shading: Shading::CookTorrance,
        ..Scene::default()
    };
    // The first stands partly before the second, and in its light.
    let places = [(Vec3::new(0.7, 0.9, 1.4), 0.8), (Vec3::new(-0.4, 1.3, -0.6), 1.2)];
    for (i, (centre, radius)) in places.into_iter().enumerate() {
        if as_field[i] {
            scene.fields.push(Field::new(vec![Node { material: i, ..Node::sphere(centre, radius) }]));
        } else {
            scene.spheres.push(Sphere { centre, radius, material: i, blend: 0.0 });
        }
    }
    scene
}

#[test]
fn a_ball_as_a_field_mirrors_breaks_and_shades_others_and_they_it_as_a_sphere_does() {
    let matt = |colour| Material { colour, ..Material::default() };
    let mirror = Material { diffuse: 0.1, f0: Vec3::splat(0.8), reflection: 1.0, ..matt(Vec3::splat(0.5)) };
    let glass = Material {
        diffuse: 0.0,
        f0: Vec3::splat(0.04),
        reflection: 1.0,
        transparency: 1.0,
        ior: 1.4,
        tint: Vec3::new(0.9, 1.0, 0.95),
        shadow: Vec3::new(0.5, 0.9, 0.6),
        ..Material::default()
    };
    let (red, blue) = (matt(Vec3::new(0.9, 0.15, 0.1)), matt(Vec3::new(0.1, 0.2, 0.9)));
    let quality = Quality::named("ultra").unwrap().every_pixel();
    for (first, a) in [("red", red), ("mirror", mirror), ("glass", glass)] {
        for (second, b) in [("blue", blue), ("mirror", mirror), ("glass", glass)] {
            let (truth, _) = render(&balls([a, b], [false; 2]), &quality);
            for as_field in [[true, false], [false, true], [true; 2]] {
                let (found, counters) = render(&balls([a, b], as_field), &quality);
                let close = psnr(&truth, &found);
                assert!(counters.get(Counter::FieldSteps) > 0);
                assert!(close >= 40.0, "{first} before {second}, as fields {as_field:?}: {close:.1} dB");
            }
        }
    }
}
