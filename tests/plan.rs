//! Only what a frame calls for is computed: the plan against the counters, over the whole show.

use luc::show;
use luc_core::counters::Counter;
use luc_core::features;
use luc_core::plan::{Plan, warnings};
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::{Material, Scene, Sphere};

const SIZE: (u32, u32) = (320, 180);

/// Renders a scene and compares every counter with the plan.
fn check(name: &str, scene: &Scene, quality: &Quality) {
    let mut renderer = Renderer::default();
    let mut pixels = vec![0; (SIZE.0 * SIZE.1) as usize];
    renderer.frame(scene, 0, SIZE, quality, &mut pixels);
    let plan = Plan::of(scene, quality);
    for (counter, words) in Counter::ALL {
        // How many pixels a filled cell spares follows from the picture, not from the scene.
        if counter == Counter::Filled {
            continue;
        }
        let count = renderer.counters.get(counter);
        // So does whether any cell needs the exact surface, where that is an option.
        if counter == Counter::KnownSurfaces && plan.names(counter) {
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
    for part in show::PARTS {
        for local in (0..part.frames).step_by(173).chain([part.frames - 1]) {
            let scene = (part.scene)(local);
            for (name, quality) in Quality::PRESETS {
                // The slow end of the ladder only now and then.
                if quality.samples == 0 || local == 0 {
                    check(
                        &format!("{} {local} (frame {}) {name}", part.name, start + local),
                        &scene,
                        &quality,
                    );
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

/// The features that the manifest gives the size build, from its line for luc-core.
fn named_in_the_manifest() -> Vec<String> {
    let manifest = include_str!("../Cargo.toml");
    let line = manifest
        .lines()
        .find(|line| line.starts_with("luc-core = { workspace"))
        .expect("a line for luc-core");
    let (_, list) = line.split_once("features = [").expect("its features");
    let names = list.trim_end_matches("] }").split(", ").filter(|name| !name.is_empty());
    names.map(|name| name.trim_matches('"').to_owned()).collect()
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
    assert_eq!(
        named_in_the_manifest(),
        called.collect::<Vec<_>>(),
        "features of luc-core in the dependencies of Cargo.toml (left) and what the plans call for (right)"
    );
}
