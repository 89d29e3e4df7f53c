//! Only what a frame calls for is computed: the plan against the counters, over the whole show.

use luc::show;
use luc_core::counters::Counter;
use luc_core::features;
use luc_core::math::Vec3;
use luc_core::plan::{Plan, warnings};
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::{Effect, Kind, Light, LightKind, Material, Plane, Scene, Sphere};

const SIZE: (u32, u32) = (320, 180);

/// What a plan names as an option that follows from the picture, not from the scene: cells of one colour, cells
/// that need the exact surface, places where there is smoke already, and glass that may be in a lamp's way.
const PERHAPS: [Counter; 4] =
    [Counter::Filled, Counter::KnownSurfaces, Counter::SmokeMarched, Counter::ColouredShadows];

/// Renders a scene and compares every counter with the plan. `steps` is how far the renderer's smoke has
/// come before.
///
/// Returns which of [`PERHAPS`] were at work.
fn check(renderer: &mut Renderer, steps: u32, name: &str, scene: &Scene, quality: &Quality) -> [bool; 4] {
    let mut pixels = vec![0; (SIZE.0 * SIZE.1) as usize];
    renderer.frame(scene, 0, SIZE, quality, &mut pixels);
    let plan = Plan::of(scene, quality);
    for (counter, words) in Counter::ALL {
        let count = renderer.counters.get(counter);
        if PERHAPS.contains(&counter) && plan.names(counter) {
            continue;
        }
        // Small pictures of many meshes have no cells.
        if counter == Counter::Interpolated && plan.names(counter) && scene.meshes.instances().len() > 12 {
            continue;
        }
        // Steps that the renderer remembers aren't taken again.
        if counter == Counter::SmokeCells && scene.smoke.is_some_and(|smoke| smoke.steps == steps) {
            assert_eq!(count, 0, "{name}: {words}");
            continue;
        }
        assert_eq!(
            count > 0,
            plan.names(counter),
            "{name}: {words}: {count}; replay: --frame with that number"
        );
    }
    PERHAPS.map(|counter| renderer.counters.get(counter) > 0)
}

#[test]
fn every_part_does_what_its_plan_names_and_nothing_else() {
    let mut start = 0;
    // One for all, so that smoke comes from frame to frame, not from the start to each.
    let (mut renderer, mut steps) = (Renderer::default(), 0);
    let mut worked = [false; 4];
    for part in show::PARTS {
        for local in (0..part.frames).step_by(173).chain([part.frames - 1]) {
            let scene = (part.scene)(local);
            for (name, quality) in Quality::PRESETS {
                // The slow end of the ladder only now and then.
                if quality.samples == 0 || local == 0 {
                    let found = check(
                        &mut renderer,
                        steps,
                        &format!("{} {local} (frame {}) {name}", part.name, start + local),
                        &scene,
                        &quality,
                    );
                    worked.iter_mut().zip(found).for_each(|(worked, found)| *worked |= found);
                    steps = scene.smoke.map_or(steps, |smoke| smoke.steps);
                }
            }
        }
        start += part.frames;
    }
    assert_eq!(worked, [true; 4], "{PERHAPS:?} at work in some frame");
}

#[test]
fn a_scene_of_one_ball_calls_for_little() {
    let scene = Scene {
        spheres: vec![Sphere { centre: luc_core::math::Vec3::ZERO, radius: 1.0, material: 0, blend: 0.0 }],
        materials: vec![Material::default()],
        ..Scene::default()
    };
    let quality = Quality::named("high").unwrap();
    let calls = Plan::of(&scene, &quality);
    for call in [Counter::ShadowRays, Counter::ReflectedRays, Counter::PlaneTests, Counter::BloomPasses] {
        assert!(!calls.names(call), "{call:?}");
    }
    assert!(calls.names(Counter::SphereTests));
}

#[test]
fn each_effect_runs_as_often_as_it_is_called_for() {
    let colour = luc_core::math::Vec3::new(1.0, 0.5, 0.2);
    let kinds = [
        Kind::Contrast(1.5),
        Kind::Tint { colour, strength: 0.5 },
        Kind::Bloom { threshold: 0.5, intensity: 0.5 },
        Kind::WideBloom { threshold: 0.5, intensity: 0.5, octaves: 3 },
        Kind::Sharpness(1.0),
        Kind::Levels(luc_core::math::Vec3::splat(4.0)),
        Kind::Fringes(0.01),
        Kind::Edges { strength: 2.0, colour },
        Kind::Lighten(-0.5),
        Kind::Tube { base: 0.5, glow: 0.5, radius: 1.0 },
        Kind::Grain(0.1),
        Kind::Cells { shade: 0.5, colour },
    ];
    let quality = Quality::named("low").unwrap();
    let (mut renderer, mut pixels) = (Renderer::default(), vec![0; 96 * 54]);
    let mut draw = |effects: Vec<Effect>| {
        let scene = Scene { effects, ..Scene::default() };
        renderer.frame(&scene, 0, (96, 54), &quality, &mut pixels);
        (renderer.counters, Plan::of(&scene, &quality), pixels.clone())
    };
    let (bare, ..) = draw(Vec::new());
    for kind in kinds {
        for multipass in [1, 3] {
            let (counters, plan, _) = draw(vec![Effect { multipass, amount: 0.5, ..Effect::new(kind) }]);
            for (counter, words) in Counter::ALL {
                let passes = if counter == kind.counter() { multipass.into() } else { 0 };
                assert_eq!(counters.get(counter), bare.get(counter) + passes, "{kind:?}: {words}");
            }
            assert!(plan.names(kind.counter()), "{kind:?}");
        }
        let (counters, plan, _) = draw(vec![Effect { amount: 0.0, ..Effect::new(kind) }]);
        assert_eq!(counters, bare, "{kind:?} of no amount");
        assert!(!plan.names(kind.counter()), "{kind:?} of no amount");
    }
}

#[test]
fn an_effect_that_changes_nothing_gives_the_bytes_of_the_picture_without_it() {
    let part = show::PARTS.iter().find(|part| part.name == "facets").expect("a part of the show");
    let (quality, size) = (Quality::named("medium").unwrap(), (333, 187));
    let draw = |effects: Vec<Effect>| {
        let mut pixels = vec![0; (size.0 * size.1) as usize];
        Renderer::default().frame(&Scene { effects, ..(part.scene)(640) }, 640, size, &quality, &mut pixels);
        pixels
    };
    // The straight way from tiles to pixels, and the way by the chain.
    let identity = Effect { amount: 1.0, ..Effect::new(Kind::Lighten(0.0)) };
    assert!(draw(vec![identity]) == draw(Vec::new()));
}

#[test]
fn what_a_preset_cannot_show_is_a_named_warning() {
    let part = show::PARTS.iter().find(|part| part.name == "mirror").expect("a part of the show");
    let mirror = (part.scene)(0);
    assert!(warnings(&mirror, &Quality::named("high").unwrap()).is_empty());
    let shallow = Quality { depth: 1, ..Quality::named("draft").unwrap() };
    assert_eq!(warnings(&mirror, &shallow), ["glass needs a depth of two or more"]);
    // Smoke is there, and the quality doesn't march.
    let part = show::PARTS.iter().find(|part| part.name == "smoke").expect("a part of the show");
    let mut smoke = (part.scene)(700);
    let off = Quality { smoke: 0.0, ..Quality::named("high").unwrap() };
    assert_eq!(warnings(&smoke, &off), ["smoke needs steps longer than 0 to be seen"]);
    check(&mut Renderer::default(), 0, "smoke unseen", &smoke, &off);
    smoke.lights[0].position.x += 1.0;
    let words = "the lamps of the smoke are not where the first lights are";
    assert_eq!(warnings(&smoke, &Quality::named("high").unwrap()), [words]);
}

#[test]
fn every_preset_can_show_every_part() {
    for part in show::PARTS {
        for frame in (0..part.frames).step_by(60) {
            for (name, quality) in Quality::PRESETS {
                let scene = (part.scene)(frame);
                let none: [&str; 0] = [];
                assert_eq!(warnings(&scene, &quality), none, "{} {frame} at {name}", part.name);
            }
        }
    }
}

/// The features that the manifest gives this build, from the lines for luc-core and for parts that the
/// size build leaves out.
fn named_in_the_manifest() -> Vec<String> {
    let manifest = include_str!("../Cargo.toml");
    let list = |start: &str, before: &str| -> Vec<String> {
        let line = manifest.lines().find(|line| line.starts_with(start)).expect(start);
        let (_, list) = line.split_once(before).expect("its features");
        let names = list.split(']').next().unwrap_or_default().split(", ").filter(|name| !name.is_empty());
        names.map(|name| name.trim_matches('"').trim_start_matches("luc-core/").to_owned()).collect()
    };
    let mut names = list("luc-core = { workspace", "features = [");
    for (part, called) in [
        ("smoke = [", cfg!(feature = "smoke")),
        ("swarm = [", cfg!(feature = "swarm")),
        ("cost = [", cfg!(feature = "cost")),
    ] {
        if called {
            names.extend(list(part, "["));
        }
    }
    names.sort();
    names.dedup();
    names
}

#[test]
fn the_size_build_has_what_the_show_calls_for_and_nothing_else() {
    let mut called = vec![false; features::ALL.len()];
    for part in show::PARTS {
        for local in (0..part.frames).step_by(60).chain([part.frames - 1]) {
            for (_, quality) in Quality::PRESETS {
                let plan = Plan::of(&(part.scene)(local), &quality);
                for (called, (_, counter)) in called.iter_mut().zip(features::ALL) {
                    *called |= plan.names(counter);
                }
            }
        }
    }
    let called = features::ALL.iter().zip(called).filter_map(|((name, _), called)| called.then_some(*name));
    let mut called: Vec<_> = called.collect();
    called.sort();
    assert_eq!(
        named_in_the_manifest(),
        called,
        "features of luc-core in the dependencies of Cargo.toml (left) and what the plans call for (right)"
    );
}

#[test]
fn a_fill_light_shines_through_bodies_and_casts_no_ray() {
    let quality = Quality::named("high").unwrap();
    let plane = Plane { point: Vec3::ZERO, normal: Vec3::Y, reach: f32::INFINITY, material: 0 };
    let ball = Sphere { centre: Vec3::Y * 5.0, radius: 1.0, material: 0, blend: 0.0 };
    let light = |kind| Light { position: Vec3::Y * 8.0, colour: Vec3::splat(40.0), kind };
    let draw = |kind: LightKind, spheres: Vec<Sphere>| {
        let mut scene = Scene { planes: vec![plane], spheres, lights: vec![light(kind)], ..Scene::default() };
        scene.materials.push(Material { colour: Vec3::splat(0.5), ..Material::default() });
        // Straight down from under the ball.
        scene.camera.position = Vec3::new(0.0, 3.0, 0.1);
        scene.camera.target = Vec3::ZERO;
        let mut pixels = vec![0; (SIZE.0 * SIZE.1) as usize];
        let mut renderer = Renderer::default();
        renderer.frame(&scene, 0, SIZE, &quality, &mut pixels);
        let count = |counter| renderer.counters.get(counter);
        let counts = (count(Counter::ShadowRays) > 0, count(Counter::FillLights) > 0);
        let plan = Plan::of(&scene, &quality);
        (pixels, counts, (plan.names(Counter::ShadowRays), plan.names(Counter::FillLights)))
    };
    let (open, ..) = draw(LightKind::Point, vec![]);
    let (hidden, counts, named) = draw(LightKind::Point, vec![ball]);
    assert_eq!([counts, named], [(true, false); 2]);
    assert!(hidden != open, "the ball hides the lamp");
    let (filled, counts, named) = draw(LightKind::Fill, vec![ball]);
    assert_eq!([counts, named], [(false, true); 2]);
    assert!(filled == open);
}
