//! Only what a frame calls for is computed: the plan against the counters, over the whole show.

use luc::show;
use luc_core::counters::Counter;
use luc_core::features;
use luc_core::plan::{Plan, warnings};
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::{Material, Scene, Sphere};

const SIZE: (u32, u32) = (320, 180);

/// Renders a scene and compares every counter with the plan. `steps` is how far the renderer's smoke has
/// come before.
fn check(renderer: &mut Renderer, steps: u32, name: &str, scene: &Scene, quality: &Quality) {
    let mut pixels = vec![0; (SIZE.0 * SIZE.1) as usize];
    renderer.frame(scene, 0, SIZE, quality, &mut pixels);
    let plan = Plan::of(scene, quality);
    for (counter, words) in Counter::ALL {
        // How many pixels a filled cell spares follows from the picture, not from the scene.
        if counter == Counter::Filled {
            continue;
        }
        let count = renderer.counters.get(counter);
        // So does whether any cell needs the exact surface, where that is an option, and whether there
        // is smoke yet.
        if [Counter::KnownSurfaces, Counter::SmokeMarched].contains(&counter) && plan.names(counter) {
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
}

#[test]
fn every_part_does_what_its_plan_names_and_nothing_else() {
    let mut start = 0;
    // One for all, so that smoke comes from frame to frame, not from the start to each.
    let (mut renderer, mut steps) = (Renderer::default(), 0);
    for part in show::PARTS {
        for local in (0..part.frames).step_by(173).chain([part.frames - 1]) {
            let scene = (part.scene)(local);
            for (name, quality) in Quality::PRESETS {
                // The slow end of the ladder only now and then.
                if quality.samples == 0 || local == 0 {
                    check(
                        &mut renderer,
                        steps,
                        &format!("{} {local} (frame {}) {name}", part.name, start + local),
                        &scene,
                        &quality,
                    );
                    steps = scene.smoke.map_or(steps, |smoke| smoke.steps);
                }
            }
        }
        start += part.frames;
    }
}

#[test]
fn a_scene_of_one_ball_calls_for_little() {
    let scene = Scene {
        spheres: vec![Sphere { centre: glam::Vec3::ZERO, radius: 1.0, material: 0, blend: 0.0 }],
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
fn what_a_preset_cannot_show_is_a_named_warning() {
    let part = show::PARTS.iter().find(|part| part.name == "mirror").expect("a part of the show");
    let mirror = (part.scene)(0);
    assert!(warnings(&mirror, &Quality::named("high").unwrap()).is_empty());
    let shallow = Quality { depth: 1, ..Quality::named("draft").unwrap() };
    assert_eq!(warnings(&mirror, &shallow), ["glass needs a depth of two or more"]);
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
    for (part, called) in [("smoke = [", cfg!(feature = "smoke")), ("swarm = [", cfg!(feature = "swarm"))] {
        if called {
            names.extend(list(part, "["));
        }
    }
    names.sort();
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
