//! Views instead of light: each pixel shows what its ray met, in the units that are stated.
mod support;

use luc::show;
use luc_core::math::Vec3;
use luc_core::quality::Quality;
use luc_core::render::{FARTHEST, MOST_STEPS, Renderer, Stage, Tables, View};
use luc_core::scene::*;
use support::picture::channels;

const SIZE: (u32, u32) = (120, 68);

fn quality() -> Quality {
    Quality::named("high").expect("a preset's name")
}

/// A ball of radius 2 at the origin, seen from 10 away, over a floor 2 below.
fn ball() -> Scene {
    let colour = Vec3::new(0.5, 0.2, 0.05);
    Scene {
        camera: Camera { position: Vec3::Z * 10.0, target: Vec3::ZERO, roll: 0.0, fov: 0.8 },
        spheres: vec![Sphere { centre: Vec3::ZERO, radius: 2.0, material: 0, blend: 0.0 }],
        planes: vec![Plane { point: Vec3::Y * -2.0, normal: Vec3::Y, reach: 1e5, material: 1 }],
        materials: vec![
            Material { colour, ..Material::default() },
            Material { diffuse: 0.0, f0: Vec3::splat(0.25), ..Material::default() },
        ],
        ..Scene::default()
    }
}

fn draw(view: View, scene: &Scene, quality: &Quality) -> Vec<u32> {
    let mut pixels = vec![0; (SIZE.0 * SIZE.1) as usize];
    view.draw(scene, 0, SIZE, quality, &mut pixels);
    pixels
}

/// Where each pixel's ray meets the scene of [`ball`]: point, normal, material.
fn truth(stage: &Stage, i: usize) -> Option<(Vec3, Vec3, usize)> {
    let (x, y) = (i % SIZE.0 as usize, i / SIZE.0 as usize);
    let d = stage.direction(x as f32 + 0.5, y as f32 + 0.5);
    let o = Vec3::Z * 10.0;
    let (b, c) = (o.dot(d), o.length_squared() - 4.0);
    if b * b > c {
        let p = o + d * (-b - (b * b - c).sqrt());
        return Some((p, p / 2.0, 0));
    }
    (d.y < 0.0).then(|| (o + d * (2.0 / -d.y), Vec3::Y, 1))
}

/// Pixels whose ray passes this near to the ball's rim may be rounded to either side.
fn on_rim(stage: &Stage, i: usize) -> bool {
    let near = |j: usize| truth(stage, j).map(|t| t.2);
    let x = i % SIZE.0 as usize;
    x > 0 && near(i - 1) != near(i) || x + 1 < SIZE.0 as usize && near(i + 1) != near(i)
}

#[test]
fn normals_distances_and_albedos_are_those_of_the_surfaces() {
    let scene = ball();
    let quality = quality();
    let tables = &mut Tables::default();
    let stage = Stage::new(&scene, &quality, SIZE.into(), tables);
    let [normals, distances, albedos] =
        [View::Normal, View::Distance, View::Albedo].map(|view| draw(view, &scene, &quality));
    // The sRGB curve of 0.5, 0.2, 0.05 and 0.25, times 255.
    let colours = [[188, 124, 63], [137, 137, 137]];
    let mut seen = [0; 3];
    for i in 0..normals.len() {
        if on_rim(&stage, i) {
            continue;
        }
        let at = format!("at ({}, {})", i % SIZE.0 as usize, i / SIZE.0 as usize);
        let Some((p, n, material)) = truth(&stage, i) else {
            assert_eq!((normals[i], distances[i], albedos[i]), (0, 0xff_ffff, 0), "sky {at}");
            seen[2] += 1;
            continue;
        };
        seen[material] += 1;
        let expected = (n * 0.5 + 0.5).to_array().map(|c| (c * 255.0).round() as i32);
        let off = channels(normals[i]).into_iter().zip(expected).map(|(a, b)| (a - b).abs());
        assert!(off.max() <= Some(1), "{:06x} for {n} {at}", normals[i]);
        let distance = p.distance(Vec3::Z * 10.0) / FARTHEST;
        let grey = (distance.min(1.0) * 255.0).round() as i32;
        assert!((channels(distances[i])[0] - grey).abs() <= 1, "{:06x} for {grey} {at}", distances[i]);
        assert_eq!(channels(albedos[i]), colours[material], "{at}");
    }
    assert!(seen.iter().all(|&n| n > 500), "ball, floor, sky: {seen:?}");
}

#[test]
fn steps_are_the_tests_of_each_pixel() {
    let everything = Quality { cull: false, ..quality() };
    let pixels = draw(View::Steps, &ball(), &everything);
    // Two shapes are tested for each pixel.
    let grey = (2.0 / MOST_STEPS * 255.0).round() as i32;
    assert!(pixels.iter().all(|&p| channels(p) == [grey; 3]), "{:06x}", pixels[0]);
    let mut many = ball();
    many.spheres = (0..300).map(|_| many.spheres[0]).collect();
    let pixels = draw(View::Steps, &many, &everything);
    assert!(pixels.iter().all(|&p| p == 0xff_ffff), "more than {MOST_STEPS} are white");
}

#[test]
fn the_view_of_the_lights_is_blue_for_one_and_white_for_many() {
    let lamps = |count: usize| {
        let mut scene = ball();
        let light = PointLight { position: Vec3::Z * 2.5, radius: 1.5, colour: Vec3::ONE };
        scene.points = vec![light; count];
        (scene.grade.grain, scene.grade.vignette) = (0.0, 0.0);
        let mut expected = vec![0; (SIZE.0 * SIZE.1) as usize];
        let covered = Scene { light_count: 1.0, ..scene.clone() };
        Renderer::default().frame(&covered, 0, SIZE, &quality(), &mut expected);
        let pixels = draw(View::Lights, &scene, &quality());
        assert_eq!(pixels, expected, "{count} lights");
        pixels
    };
    let middle = (SIZE.1 / 2 * SIZE.0 + SIZE.0 / 2) as usize;
    let colours = [(0, 0), (1, 0x1b_2a7a), (4, 0x5a_3fc0), (12, 0xc0_5a9e), (32, 0xff_b347), (64, 0xff_f3d6)];
    for (count, colour) in colours.into_iter().chain([(300, 0xff_f3d6)]) {
        let pixels = lamps(count);
        let off = channels(pixels[middle]).into_iter().zip(channels(colour)).map(|(a, b)| (a - b).abs());
        assert!(off.max() <= Some(1), "{count} lights: {:06x} for {colour:06x}", pixels[middle]);
        assert_eq!(pixels[0], 0, "the sky has no surface that {count} lights could reach");
    }
}

#[test]
fn the_view_of_the_sampling_is_the_frame_without_effects_under_the_overlay() {
    for part in show::PARTS {
        let scene = (part.scene)(100);
        let mut expected = vec![0; (SIZE.0 * SIZE.1) as usize];
        let covered = Scene { overlay: 1.0, effects: Vec::new(), ..scene.clone() };
        Renderer::default().frame(&covered, 0, SIZE, &quality(), &mut expected);
        assert!(draw(View::Sampling, &scene, &quality()) == expected, "{}", part.name);
    }
}
