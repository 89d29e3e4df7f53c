//! Surfaces as whole pictures: what mirrors show and how far, and under GGX relief in mirrors, rough
//! mirrors, bounces of diffuse light.
mod support;

use luc_core::counters::Counter;
use luc_core::math::Vec3;
use luc_core::plan::Plan;
use luc_core::quality::Quality;
use luc_core::render::{Stage, Tables};
use luc_core::sample::{Kind, Scratch, Tile, refine};
use luc_core::scene::*;
use support::picture::{draw, psnr};

const SIZE: (u32, u32) = (320, 180);

fn preset(name: &str) -> Quality {
    Quality::named(name).expect("a preset's name")
}

/// Posts and balls on a wet floor with relief, before a low sun.
fn shore() -> Scene {
    let relief = |scale, bump| Texture { scale, bump, ..Texture::NONE };
    let rough = |colour, roughness, texture| Material {
        colour,
        roughness,
        texture,
        specular: Vec3::ONE,
        f0: Vec3::splat(0.05),
        ..Material::default()
    };
    let stop = |y, colour| Stop { y, colour };
    let direction = luc_core::math::normalize(Vec3::new(0.1, 0.12, -1.0));
    let mut scene = Scene {
        camera: Camera {
            position: Vec3::new(-1.0, 1.3, 7.0),
            target: Vec3::new(0.0, 0.9, 0.0),
            roll: 0.03,
            fov: 0.9,
        },
        background: Background {
            stops: vec![
                stop(-0.1, Vec3::new(0.02, 0.03, 0.06)),
                stop(0.1, Vec3::new(0.2, 0.25, 0.4)),
                stop(1.0, Vec3::new(0.02, 0.04, 0.12)),
            ],
            glows: vec![Glow { direction, colour: Vec3::new(6.0, 3.0, 1.0), sharpness: 300.0 }],
            discs: vec![],
        },
        planes: vec![Plane { point: Vec3::ZERO, normal: Vec3::Y, reach: 40.0, material: 0 }],
        materials: vec![
            Material { reflection: 1.0, ..rough(Vec3::new(0.05, 0.06, 0.08), 0.14, relief(0.9, 0.014)) },
            Material { f0: Vec3::new(0.3, 0.4, 0.6), ..rough(Vec3::ZERO, 0.3, relief(3.0, 0.02)) },
            rough(Vec3::new(0.3, 0.3, 0.35), 0.6, relief(2.0, 0.05)),
        ],
        lights: vec![Light {
            position: direction * 50.0,
            colour: Vec3::new(1.0, 0.7, 0.4) * 2.8 * 2500.0,
            kind: LightKind::Point,
        }],
        shading: Shading::Ggx,
        rough: true,
        ambient: [Vec3::new(0.02, 0.03, 0.05), Vec3::new(0.06, 0.08, 0.15)],
        ..Scene::default()
    };
    for k in 0..6 {
        let (x, z) = (-2.5 + 1.1 * k as f32, -0.7 * k as f32);
        scene.cylinders.push(Cylinder::between(Vec3::new(x, 0.0, z), Vec3::new(x, 2.0, z), 0.2, 1));
        let centre = Vec3::new(x + 0.5, 0.35, z + 1.0);
        scene.spheres.push(Sphere { centre, radius: 0.35, material: 2, blend: 0.0 });
    }
    scene
}

#[test]
fn relief_in_mirrors_is_within_40_db_of_every_pixel_traced() {
    let scene = shore();
    for size in [SIZE, (640, 360)] {
        for name in ["medium", "high", "ultra"] {
            // With one ray a mirror: drawn rays are noise, which is compared elsewhere.
            let quality = Quality { rough: 0, ..preset(name) };
            let (adaptive, renderer) = draw(&scene, size, &quality);
            let (full, _) = draw(&scene, size, &quality.every_pixel());
            let db = psnr(&full, &adaptive);
            let traced = renderer.counters.get(Counter::Traced);
            println!("{name} {size:?}: {db:.2} dB, {traced} pixels traced");
            assert!(db >= 40.0, "{name} {size:?}: {db:.2} dB");
        }
    }
}

#[test]
fn the_plan_names_what_these_surfaces_call_for() {
    let scene = Scene { bounces: 1, ..shore() };
    for (name, quality) in Quality::PRESETS {
        let (_, renderer) = draw(&scene, (96, 54), &quality);
        let plan = Plan::of(&scene, &quality);
        for counter in
            [Counter::Ggx, Counter::Bumps, Counter::TextureLookups, Counter::RoughRays, Counter::ScatterRays]
        {
            let count = renderer.counters.get(counter);
            assert_eq!(count > 0, plan.names(counter), "{name}: {counter:?} {count}");
        }
        assert_eq!(plan.names(Counter::ScatterRays), quality.scatter > 0, "{name}");
        assert!(!Plan::of(&shore(), &quality).names(Counter::ScatterRays), "{name}: no bounces asked for");
    }
}

/// The linear light in the middle of a picture of `scene`, and of all its traced pixels.
fn light(scene: &Scene, quality: &Quality) -> (Vec3, Vec<Vec3>) {
    let tables = &mut Tables::default();
    let stage = Stage::new(scene, quality, [64, 64], tables);
    let mut tile = Tile::default();
    refine(&stage, &mut Scratch::default(), (0, 0), &mut tile);
    let all = (0..64 * 64).map(|i| (i % 64, i / 64));
    let traced = all.filter(|&(x, y)| tile.record[y * 64 + x].kind() == Kind::Traced);
    (tile.get(32, 32), traced.map(|(x, y)| tile.get(x, y)).collect())
}

/// A ball of this material in a white surrounding that also the ambient light is like.
fn furnace(material: Material) -> Scene {
    Scene {
        camera: Camera { position: Vec3::Z * 3.0, target: Vec3::ZERO, roll: 0.0, fov: 0.5 },
        background: Background { stops: vec![Stop { y: 0.0, colour: Vec3::ONE }], ..Background::default() },
        spheres: vec![Sphere { centre: Vec3::ZERO, radius: 1.0, material: 0, blend: 0.0 }],
        materials: vec![material],
        ambient: [Vec3::ONE; 2],
        ..Scene::default()
    }
}

#[test]
fn a_white_surrounding_gives_a_surface_its_albedo() {
    let albedo = Vec3::new(1.0, 0.5, 0.18);
    for bounces in 0..=3 {
        let quality = Quality { scatter: 5, ..preset("high").every_pixel() };
        let scene = Scene { bounces, ..furnace(Material { colour: albedo, ..Material::default() }) };
        let (middle, all) = light(&scene, &quality);
        assert!((middle - albedo).abs().max_element() < 1e-5, "{middle} with {bounces} bounces");
        for c in all {
            let off = (c - albedo).abs().max_element().min((c - Vec3::ONE).abs().max_element());
            assert!(off < 1e-5, "neither ball nor sky: {c} with {bounces} bounces");
        }
    }
}

/// Inside a closed shining ball: emission + albedo (emission + albedo (...)), with the sum of the whole
/// series as ambient light at the end, is that sum, whatever the number of bounces.
#[test]
fn a_closed_furnace_is_in_balance_after_any_number_of_bounces() {
    let albedo = Vec3::new(0.8, 0.5, 0.2);
    let emission = Vec3::new(0.3, 0.2, 0.1);
    let balance = emission / (Vec3::ONE - albedo);
    let material = Material { colour: albedo, emission, ..Material::default() };
    for bounces in 0..=3 {
        let mut scene = Scene { bounces, ambient: [balance; 2], ..furnace(material) };
        scene.camera.position = Vec3::new(0.2, 0.1, 0.3);
        let quality = Quality { scatter: 3, ..preset("high").every_pixel() };
        let (_, all) = light(&scene, &quality);
        assert_eq!(all.len(), 64 * 64);
        for c in all {
            assert!((c - balance).abs().max_element() < 1e-5, "{c} for {balance}, {bounces} bounces");
        }
    }
}

#[test]
fn drawn_mirrors_give_no_more_light_than_comes_in() {
    for roughness in [0.1, 0.3, 0.8] {
        let f0 = Vec3::new(1.0, 0.5, 0.04);
        let metal = Material { diffuse: 0.0, f0, roughness, reflection: 1.0, ..Material::default() };
        let scene = Scene { shading: Shading::Ggx, rough: true, ..furnace(metal) };
        let quality = Quality { rough: 16, ..preset("high").every_pixel() };
        let (_, all) = light(&scene, &quality);
        assert!(all.iter().all(|c| c.max_element() <= 1.0001), "roughness {roughness}");
        // Facing the eye little is lost, by shadowing among facets: 1 - ln 2 is left at roughness 1.
        let middle = (0..64).map(|i| all[(28 + i / 8) * 64 + 28 + i % 8]).sum::<Vec3>() / 64.0;
        let kept = 1.0 - 0.7 * roughness * roughness;
        assert!((middle - f0).max_element() < 0.03 && middle.x > kept, "{middle} at {roughness}");
    }
}

/// Random numbers belong to positions: what a pixel's rays find doesn't depend on the list it is in.
#[test]
fn traced_pixels_are_the_same_whatever_else_is_traced() {
    let scene = Scene { bounces: 2, ..shore() };
    let ultra = preset("ultra");
    let tile = |quality: &Quality| {
        let tables = &mut Tables::default();
        let stage = Stage::new(&scene, quality, SIZE.into(), tables);
        let mut tile = Tile::default();
        refine(&stage, &mut Scratch::default(), (128, 64), &mut tile);
        tile
    };
    let (adaptive, full) = (tile(&ultra), tile(&Quality { cull: false, ..ultra.every_pixel() }));
    let mut traced = 0;
    for i in (0..64 * 64).filter(|&i| adaptive.record[i].kind() == Kind::Traced) {
        let (x, y) = (i % 64, i / 64);
        let (a, b) = (adaptive.get(x, y).to_array(), full.get(x, y).to_array());
        assert_eq!(a.map(f32::to_bits), b.map(f32::to_bits), "at ({x}, {y})");
        traced += 1;
    }
    assert!(traced > 1000, "{traced}");
}

#[test]
fn averaged_patterns_come_closer_to_the_reference() {
    let scene = Scene { bounces: 1, ..shore() };
    let quality = Quality { edge_samples: 0, scatter: 2, rough: 2, ..preset("high").every_pixel() };
    let of = |average: u32| draw(&scene, SIZE, &Quality { average, ..quality }).0;
    let reference = of(96);
    let ladder: Vec<f64> = [1, 4, 16].map(|k| psnr(&reference, &of(k))).into();
    println!("{ladder:.2?} dB with 1, 4, 16 patterns");
    assert!(ladder.windows(2).all(|w| w[1] > w[0] + 3.0), "{ladder:?}");
    assert_eq!(of(4), of(4));
}

/// Posts and balls of one textured stone, lit from the side, on a mirror.
fn stones(pattern: Pattern) -> Scene {
    let texture = Texture { pattern, scale: 2.5, grain: 0.3, bump: 0.02 };
    let mut scene = shore();
    for k in 1..3 {
        scene.materials[k].texture = texture;
    }
    scene.materials[0].texture = Texture::NONE;
    scene.lights[0].position = Vec3::new(-20.0, 25.0, 35.0);
    scene
}

#[test]
fn each_pattern_is_within_40_db_and_counted_only_where_it_is() {
    let patterns = [
        (Pattern::Noise, Counter::TextureLookups),
        (Pattern::Cells, Counter::Cells),
        (Pattern::Stripes, Counter::Stripes),
        (Pattern::Brick, Counter::Brick),
        (Pattern::Scratches, Counter::Scratches),
    ];
    let mut pictures: Vec<Vec<u32>> = Vec::new();
    for (pattern, own) in patterns {
        let scene = stones(pattern);
        let quality = preset("high");
        let (adaptive, renderer) = draw(&scene, (640, 360), &quality);
        let (full, _) = draw(&scene, (640, 360), &quality.every_pixel());
        let db = psnr(&full, &adaptive);
        println!("{pattern:?}: {db:.2} dB");
        assert!(db >= 40.0, "{pattern:?}: {db:.2} dB");
        let plan = Plan::of(&scene, &quality);
        for (_, counter) in patterns {
            let count = renderer.counters.get(counter);
            assert_eq!(count > 0, plan.names(counter), "{pattern:?}: {counter:?} {count}");
            assert_eq!(count > 0, counter == own || counter == Counter::TextureLookups, "{pattern:?}");
        }
        assert!(!pictures.contains(&full), "{pattern:?} looks like another");
        pictures.push(full);
    }
}

#[test]
fn drawn_rays_are_the_same_on_any_number_of_threads() {
    let scene = Scene { bounces: 2, ..shore() };
    let quality = Quality { average: 2, ..preset("ultra") };
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| draw(&scene, SIZE, &quality).0)
    };
    let one = on(1);
    for threads in [2, 5] {
        assert!(one == on(threads), "{threads} threads");
    }
}

/// Two mirrors that shine a little, face to face; the eye looks at one of them.
fn hall(f0: f32) -> Scene {
    let mirror = Material {
        diffuse: 0.0,
        f0: Vec3::splat(f0),
        reflection: 1.0,
        emission: Vec3::splat(0.25),
        ..Material::default()
    };
    let wall = |z: f32| Plane {
        point: Vec3::Z * z,
        normal: Vec3::Z * -z.signum(),
        reach: f32::INFINITY,
        material: 0,
    };
    Scene {
        camera: Camera { position: Vec3::ZERO, target: Vec3::new(0.1, 0.05, -1.0), roll: 0.0, fov: 0.3 },
        planes: vec![wall(-2.0), wall(2.0)],
        materials: vec![mirror],
        ..Scene::default()
    }
}

#[test]
fn chains_of_mirrors_end_at_their_depth_or_where_they_add_too_little() {
    let f0 = 0.5;
    let scene = hall(f0);
    let size = (64, 36);
    let pixels = u64::from(size.0 * size.1);
    let asked = |depth, cutoff| Quality { depth, cutoff, edge_samples: 0, ..preset("high").every_pixel() };
    let reflected = |quality: &Quality| draw(&scene, size, quality).1.counters.get(Counter::ReflectedRays);
    for depth in 0..12 {
        assert_eq!(reflected(&asked(depth, 0.0)), pixels * u64::from(depth), "to a depth of {depth}");
    }
    // Rays are followed while 0.5^k, at this angle, is over the cut-off.
    for (k, cutoff) in (1..8).map(|k| (k, 0.75 / (1 << k) as f32)) {
        assert_eq!(reflected(&asked(12, cutoff)), pixels * k, "over {cutoff}");
    }
    // What is cut off is at most the cut-off times what is seen there, the whole series.
    let (_, whole) = light(&scene, &asked(30, 0.0));
    for cutoff in [0.3, 0.1, 0.02, 0.001] {
        let (_, cut) = light(&scene, &asked(30, cutoff));
        for (c, w) in cut.iter().zip(&whole) {
            let lost = w.x - c.x;
            assert!(lost > 0.0 && lost <= cutoff * 0.25 / (1.0 - 1.05 * f0), "{lost} over {cutoff}");
        }
    }
}

#[test]
fn mirrors_show_shining_rectangles_which_the_eye_does_not_see() {
    let (radiance, f0) = (Vec3::new(8.0, 4.0, 2.0), Vec3::new(0.9, 0.6, 0.3));
    let centre = Vec3::new(0.0, 3.0, -3.0);
    let emitter = Emitter { centre, u: Vec3::X, v: Vec3::Z, half: [1.0, 0.5], radiance };
    assert!(emitter.normal().y < 0.0, "it shines down");
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y, reach: f32::INFINITY, material: 0 };
    let mirror = Material { diffuse: 0.0, f0, reflection: 1.0, ..Material::default() };
    // Straight above the middle of the mirrored rectangle, so that the angle is that of normal incidence.
    let position = Vec3::new(0.0, 1.0, -3.0);
    let seen = |target: Vec3| {
        let camera = Camera { position, target, roll: 0.0, fov: 1e-3 };
        let scene = Scene {
            camera,
            planes: vec![floor],
            materials: vec![mirror],
            emitters: vec![emitter],
            ..Scene::default()
        };
        light(&scene, &preset("high").every_pixel()).0
    };
    let mirrored = |x: f32, z: f32| seen(Vec3::new(centre.x + x, -centre.y, centre.z + z));
    let middle = mirrored(0.0, 0.0);
    assert!((middle - radiance * f0).abs().max_element() < 1e-4, "{middle}");
    for (x, z) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 0.5), (0.0, -0.5), (1.0, 0.5), (-1.0, -0.5)] {
        assert!(mirrored(0.99 * x, 0.99 * z).x > 7.0, "within its edge at {x} {z}");
        assert_eq!(mirrored(1.01 * x, 1.01 * z), Vec3::ZERO, "beyond its edge at {x} {z}");
    }
    assert_eq!(seen(centre), Vec3::ZERO, "looked at straight");
}

#[test]
fn discs_are_seen_only_where_nothing_else_is() {
    let shine = |x| Material { diffuse: 0.0, emission: Vec3::splat(x), ..Material::default() };
    let disc = Disc { centre: Vec3::new(0.0, 0.0, -3.0), radius: 2.0, low: Vec3::ONE, high: Vec3::ONE };
    let scene = |spheres| Scene {
        camera: Camera { position: Vec3::ZERO, target: Vec3::NEG_Z, roll: 0.0, fov: 0.1 },
        background: Background { discs: vec![disc], ..Background::default() },
        spheres,
        materials: vec![shine(0.5)],
        ..Scene::default()
    };
    let ball = |z: f32| vec![Sphere { centre: Vec3::Z * z, radius: 1.0, material: 0, blend: 0.0 }];
    let middle = |spheres| light(&scene(spheres), &preset("high")).0;
    assert_eq!(middle(vec![]), Vec3::ONE);
    assert_eq!(middle(ball(-9.0)), Vec3::splat(0.5), "a ball behind the disc");
    assert_eq!(middle(ball(-2.0)), Vec3::splat(0.5), "a ball before the disc");
    assert_eq!(middle(ball(9.0)), Vec3::ONE, "a ball behind the eye");
}
