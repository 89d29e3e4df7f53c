//! Small lights in great number: culling changes no byte, and light ends where it should. Shining
//! rectangles: their shadows are as soft as the quality draws them.

mod support;

use luc_core::counters::Counter;
use luc_core::math::Vec3;
use luc_core::math::hash::{hash2, unit};
use luc_core::plan::{Plan, warnings};
use luc_core::quality::Quality;
use luc_core::scene::{Camera, Emitter, Material, Plane, PointLight, Scene, Shading, Sphere};
use support::picture::draw;

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
    let (pixels, renderer) = draw(scene, SIZE, quality);
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

/// A ball under a shining rectangle, from above, so that most of the picture is the floor.
fn under_a_rectangle() -> Scene {
    Scene {
        camera: Camera { position: Vec3::new(0.0, 9.0, 12.0), target: Vec3::ZERO, roll: 0.0, fov: 1.2 },
        spheres: vec![Sphere { centre: Vec3::new(0.0, 3.0, 0.0), radius: 0.8, material: 0, blend: 0.0 }],
        emitters: vec![Emitter::facing(Vec3::Y * 9.0, Vec3::ZERO, 3.0, 3.0, Vec3::splat(8.0))],
        soft: true,
        ..scene(0, Shading::Phong)
    }
}

/// Green of the rows that show the shadow but not the ball.
fn floor(scene: &Scene, quality: &Quality) -> Vec<f64> {
    render(scene, quality).0[80 * SIZE.0 as usize..].iter().map(|p| f64::from(p >> 8 & 255)).collect()
}

#[test]
fn many_shadow_rays_to_a_rectangle_soften_its_shadow() {
    let scene = under_a_rectangle();
    let base = Quality::named("high").unwrap().every_pixel();
    let bare = floor(&Scene { spheres: vec![], ..scene.clone() }, &base);
    let share = |samples, range: std::ops::Range<f64>| {
        let picture = floor(&scene, &Quality { shadow_samples: samples, ..base });
        picture.iter().zip(&bare).filter(|&(v, lit)| *lit > 20.0 && range.contains(&(v / lit))).count()
    };
    let umbra = [1, 64].map(|samples| share(samples, 0.0..0.1));
    let penumbra = [1, 64].map(|samples| share(samples, 0.2..0.9));
    assert!(umbra[0] > 200 && umbra[1] < umbra[0] / 2, "umbra, hard and soft: {umbra:?}");
    assert!(penumbra[1] > 500 && penumbra[1] > 4 * penumbra[0], "penumbra, hard and soft: {penumbra:?}");
}

#[test]
fn soft_shadows_are_for_scenes_and_presets_that_have_them() {
    let soft = under_a_rectangle();
    let hard = Scene { soft: false, ..soft.clone() };
    for (name, quality) in Quality::PRESETS {
        let differs = render(&soft, &quality).0 != render(&hard, &quality).0;
        let rays = quality.shadow_samples;
        assert_eq!(differs, rays > 1, "{name} with {rays} rays");
        let plan = Plan::of(&soft, &quality);
        assert_eq!(plan.names(Counter::SoftShadowRays), rays > 1, "{name}");
        assert!(!Plan::of(&hard, &quality).names(Counter::SoftShadowRays), "{name}");
    }
}

#[test]
fn a_soft_shadow_comes_near_to_that_of_very_many_rays() {
    let scene = under_a_rectangle();
    let base = Quality::named("high").unwrap().every_pixel();
    let error = |samples| {
        let truth = floor(&scene, &Quality { shadow_samples: 1024, ..base });
        let picture = floor(&scene, &Quality { shadow_samples: samples, ..base });
        let squares: f64 = picture.iter().zip(&truth).map(|(a, b)| (a - b) * (a - b)).sum();
        (squares / truth.len() as f64).sqrt()
    };
    let errors = [1, 4, 16, 64].map(error);
    assert!(errors.is_sorted_by(|a, b| *b < 0.6 * a), "rms error with 1, 4, 16, 64 rays: {errors:.2?}");
}
