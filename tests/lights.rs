//! Small lights in great number: culling changes no byte, and light ends where it should.

use luc_core::counters::Counter;
use luc_core::math::Vec3;
use luc_core::math::hash::{hash2, unit};
use luc_core::plan::{Plan, warnings};
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::{Camera, Material, Plane, PointLight, Scene, Shading, Sphere};

const SIZE: (u32, u32) = (320, 180);

/// Balls on a floor, one of them a mirror, among `count` lights.
fn scene(count: u32, shading: Shading) -> Scene {
    let number = |i: u32, k: u32| unit(hash2(i, k));
    let ball =
        |x: f32, material| Sphere { centre: Vec3::new(x, 1.0, 0.0), radius: 1.0, material, blend: 0.0 };
    let points = (0..count).map(|i| PointLight {
        position: Vec3::new(number(i, 0) * 16.0 - 8.0, 0.1 + 2.0 * number(i, 1), number(i, 2) * 16.0 - 12.0),
        radius: 0.3 + 2.0 * number(i, 3),
        colour: Vec3::new(number(i, 4), number(i, 5), number(i, 6)),
    });
    let dull = Material {
        colour: Vec3::splat(0.5),
        specular: Vec3::splat(0.3),
        exponent: 20.0,
        f0: Vec3::splat(0.1),
        roughness: 0.4,
        ..Material::default()
    };
    let mirror = Material { diffuse: 0.0, f0: Vec3::splat(0.9), reflection: 1.0, ..Material::default() };
    Scene {
        camera: Camera { position: Vec3::new(0.0, 3.0, 9.0), target: Vec3::ZERO, roll: 0.1, fov: 1.0 },
        spheres: vec![ball(-2.5, 0), ball(0.0, 1), ball(2.5, 0)],
        planes: vec![Plane { point: Vec3::ZERO, normal: Vec3::Y, reach: f32::INFINITY, material: 0 }],
        materials: vec![dull, mirror],
        points: points.collect(),
        shading,
        ..Scene::default()
    }
}

fn render(scene: &Scene, quality: &Quality) -> (Vec<u32>, u64) {
    let mut renderer = Renderer::default();
    let mut pixels = vec![0; (SIZE.0 * SIZE.1) as usize];
    renderer.frame(scene, 0, SIZE, quality, &mut pixels);
    (pixels, renderer.counters.get(Counter::PointLights))
}

#[test]
fn culled_lights_change_no_byte() {
    for (preset, shading) in [("draft", Shading::Phong), ("high", Shading::CookTorrance)] {
        let quality = Quality::named(preset).unwrap();
        for count in [1, 7, 64, 512] {
            let scene = scene(count, shading);
            let (all, evaluations) = render(&scene, &Quality { cull: false, ..quality });
            for light_tile in [1, 4, 16, 64, 4000] {
                let (culled, fewer) = render(&scene, &Quality { light_tile, ..quality });
                assert!(culled == all, "{count} lights at {preset}, tiles of {light_tile} px");
                assert!(fewer * 3 < evaluations, "{count} lights: {fewer} evaluations of {evaluations}");
            }
        }
    }
}

#[test]
fn a_light_ends_at_its_radius() {
    let quality = Quality::named("high").unwrap();
    let lit = |radius| {
        let light = PointLight { position: Vec3::new(0.0, 2.0, 4.0), radius, colour: Vec3::splat(1e4) };
        let scene = Scene {
            spheres: vec![],
            points: vec![light],
            grade: luc_core::scene::Grade { grain: 0.0, ..Default::default() },
            ..scene(0, Shading::Phong)
        };
        render(&scene, &quality).0.iter().filter(|&&p| p != 0).count()
    };
    assert_eq!(lit(1.999), 0, "light on a floor two units away");
    assert!(lit(2.5) > 1000);
}

#[test]
fn the_plan_names_small_lights() {
    let quality = Quality::named("high").unwrap();
    let plan = Plan::of(&scene(9, Shading::Phong), &quality);
    assert!(plan.names(Counter::PointLights));
    let plan = Plan::of(&scene(0, Shading::Phong), &quality);
    assert!(!plan.names(Counter::PointLights));
    assert_eq!(
        warnings(&scene(513, Shading::Phong), &quality),
        ["small lights after the 512th do not shine"]
    );
}

#[test]
fn the_count_of_lights_is_drawn_tile_by_tile() {
    let quality = Quality::named("high").unwrap();
    let scene = Scene { light_count: 1.0, ..scene(64, Shading::Phong) };
    let pixels = render(&scene, &quality).0;
    let light = |p: u32| (p >> 16 & 255) + (p >> 8 & 255) + (p & 255);
    // Tiles without light are black; those of 16 px that some light reaches are not.
    let lit = pixels.iter().filter(|&&p| light(p) > 100).count();
    assert!(lit > pixels.len() / 10 && lit < pixels.len() * 9 / 10, "{lit} pixels in tiles with lights");
    let empty = Scene { points: vec![], ..scene };
    assert!(render(&empty, &quality).0.iter().all(|&p| light(p) < 8), "no light, no count");
}
