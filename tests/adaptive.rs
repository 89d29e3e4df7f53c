//! Adaptive sampling against tracing every pixel: close in every frame, and nothing small is lost.
//!
//! The overlay is held against the records it shows, and the presets against the reference. Set
//! `LUC_TELL=1` and run with `--nocapture` to see the figures, not only whether they hold.
mod support;

use luc::show;
use luc_core::counters::{Counter, Counters};
use luc_core::quality::Quality;
use luc_core::render::{Renderer, Stage, Tables};
use luc_core::sample::{Kind, Scratch, TILE, Tile, refine};
use luc_core::scene::Scene;
use luc_core::sim::{Room, Simulation, Volume};
use std::cell::RefCell;
use support::crossing::{self, Backdrop, Thing};
use support::golden;
use support::picture::{channels, distance, psnr};

/// Size of the pictures that are compared.
const SIZE: (u32, u32) = (640, 360);

thread_local! {
    /// One for all frames of a test, so that smoke comes from frame to frame, not from its start to each.
    static RENDERER: RefCell<Renderer> = RefCell::default();
    /// The same for what is sampled without one.
    static SMOKE: RefCell<Simulation> = RefCell::default();
}

fn render(scene: &Scene, n: u64, size: (u32, u32), quality: &Quality) -> (Vec<u32>, Counters) {
    RENDERER.with_borrow_mut(|renderer| {
        let mut pixels = vec![0; (size.0 * size.1) as usize];
        renderer.frame(scene, n, size, quality, &mut pixels);
        (pixels, renderer.counters)
    })
}

fn preset(name: &str) -> Quality {
    Quality::named(name).unwrap()
}

/// Prints a figure if asked to.
fn tell(what: std::fmt::Arguments) {
    if std::env::var_os("LUC_TELL").is_some() {
        println!("{what}");
    }
}

/// The scene of a part's local frame, without what shows how it was sampled.
fn plain(part: &show::Part, frame: u64) -> Scene {
    Scene { overlay: 0.0, split: None, effects: Vec::new(), ..(part.scene)(frame) }
}

#[test]
fn every_part_is_within_40_db_of_every_pixel_traced() {
    let quality = preset("high");
    let mut wrong = String::new();
    for part in show::PARTS {
        let count = if ["mirror", "gold"].contains(&part.name) { 20 } else { 10 };
        for i in 0..count {
            // Spread over the part, and in another phase of its motions each time.
            let frame = i * part.frames / count + 70 * i / count + 11;
            let scene = plain(part, frame);
            let (adaptive, _) = render(&scene, frame, SIZE, &quality);
            let (full, _) = render(&scene, frame, SIZE, &quality.every_pixel());
            let db = psnr(&full, &adaptive);
            tell(format_args!("{} {frame}: {db:.2} dB", part.name));
            if db < 40.0 {
                let worst = (0..full.len()).max_by_key(|&i| distance(full[i], adaptive[i])).unwrap();
                wrong += &format!(
                    "\n{} {frame}: {db:.2} dB, worst at ({}, {}); replay: {}",
                    part.name,
                    worst % SIZE.0 as usize,
                    worst / SIZE.0 as usize,
                    golden::replay(part.name, frame, "high", SIZE),
                );
            }
        }
    }
    assert!(wrong.is_empty(), "under 40 dB:{wrong}");
}

/// Difference of a channel from which on a pixel shows the thing.
const SEEN: i32 = 24;

/// Longest stretch of a line that may be missing, px.
const GAP: usize = 2;

/// Share of the thing's pixels that must be there.
const SHARE: f64 = 0.9;

/// How much of a thing the adaptive picture shows.
struct Found {
    /// Pixels that show it in the full picture.
    pixels: usize,
    /// Those of them that are right in the adaptive one.
    right: usize,
    /// Longest run of rows or columns, whichever the thing spans more of, without a right pixel.
    gap: usize,
}

fn find(empty: &[u32], full: &[u32], adaptive: &[u32]) -> Found {
    let width = SIZE.0 as usize;
    let shown: Vec<usize> =
        (0..full.len()).filter(|&i| full[i] != empty[i] && distance(full[i], empty[i]) > SEEN).collect();
    let right: Vec<usize> =
        shown.iter().copied().filter(|&i| distance(full[i], adaptive[i]) <= SEEN).collect();
    let lines = |pixels: &[usize], down: bool| {
        let mut lines: Vec<usize> = pixels.iter().map(|i| if down { i / width } else { i % width }).collect();
        lines.sort_unstable();
        lines.dedup();
        lines
    };
    let down = lines(&shown, true).len() >= lines(&shown, false).len();
    let covered = lines(&right, down);
    let mut gap = 0;
    let mut run = 0;
    for line in lines(&shown, down) {
        run = if covered.binary_search(&line).is_ok() { 0 } else { run + 1 };
        gap = gap.max(run);
    }
    Found { pixels: shown.len(), right: right.len(), gap }
}

/// Lets a thing cross in front of a backdrop and checks each frame.
fn cross(thing: Thing, backdrop: Backdrop) {
    let quality = preset("high");
    let mut renderer = Renderer::default();
    let mut picture = |scene: &Scene, quality: &Quality| {
        let mut pixels = vec![0; (SIZE.0 * SIZE.1) as usize];
        renderer.frame(scene, 0, SIZE, quality, &mut pixels);
        pixels
    };
    let empty = picture(&crossing::scene(thing, backdrop, 0, false), &quality.every_pixel());
    let (mut seen, mut least, mut widest) = (0, 1.0_f64, 0);
    let mut wrong = String::new();
    for frame in 0..crossing::FRAMES {
        let scene = crossing::scene(thing, backdrop, frame, true);
        let (full, adaptive) = (picture(&scene, &quality.every_pixel()), picture(&scene, &quality));
        let found = find(&empty, &full, &adaptive);
        if found.pixels == 0 {
            continue;
        }
        seen += 1;
        let share = found.right as f64 / found.pixels as f64;
        least = least.min(share);
        widest = widest.max(found.gap);
        if share < SHARE || found.gap > GAP {
            wrong +=
                &format!("\nframe {frame}: {} of {} pixels, gap {} px", found.right, found.pixels, found.gap);
        }
    }
    tell(format_args!(
        "{thing:?} over {backdrop:?}: seen in {seen} frames, least share {least:.3}, widest gap {widest}"
    ));
    let replay = format!("crossing::scene(Thing::{thing:?}, Backdrop::{backdrop:?}, FRAME, true)");
    assert!(wrong.is_empty(), "{thing:?} over {backdrop:?} is lost; replay: {replay}{wrong}");
    // The globe fills the middle of the picture only.
    let shadow = matches!(thing, Thing::Shadow | Thing::FacetShadow);
    let enough = if shadow && backdrop == Backdrop::Globe { 15 } else { 54 };
    assert!(seen >= enough, "{thing:?} over {backdrop:?} shows in {seen} frames only");
}

#[test]
fn a_bar_one_pixel_thick_is_never_lost() {
    cross(Thing::Bar, Backdrop::Floor);
    cross(Thing::Bar, Backdrop::Globe);
    cross(Thing::EndlessBar, Backdrop::Dark);
    cross(Thing::EndlessBar, Backdrop::Wall);
}

#[test]
fn a_ball_of_three_pixels_is_never_lost() {
    cross(Thing::Ball, Backdrop::Dark);
    cross(Thing::Ball, Backdrop::Floor);
    cross(Thing::Ball, Backdrop::Globe);
}

#[test]
fn a_glint_one_pixel_thick_is_never_lost() {
    cross(Thing::Glint, Backdrop::Globe);
}

#[test]
fn a_small_triangle_is_never_lost() {
    cross(Thing::Triangle, Backdrop::Wall);
}

#[test]
fn a_small_facet_of_a_mesh_is_never_lost() {
    cross(Thing::Facet, Backdrop::Dark);
    cross(Thing::Facet, Backdrop::Floor);
    cross(Thing::Facet, Backdrop::Wall);
    cross(Thing::Facet, Backdrop::Globe);
}

#[test]
fn the_shadow_of_a_small_mesh_is_never_lost() {
    cross(Thing::FacetShadow, Backdrop::Floor);
    cross(Thing::FacetShadow, Backdrop::Wall);
    cross(Thing::FacetShadow, Backdrop::Globe);
}

#[test]
fn the_shadow_of_a_ball_of_three_pixels_is_never_lost() {
    cross(Thing::Shadow, Backdrop::Floor);
    cross(Thing::Shadow, Backdrop::Wall);
    cross(Thing::Shadow, Backdrop::Globe);
}

/// How each pixel of a scene was got, and whether all light is finite, straight from the sampler.
fn records(scene: &Scene, size: (u32, u32), quality: &Quality) -> (Vec<Kind>, bool) {
    let mut simulation = SMOKE.take();
    let (mut counters, mut shown) = (Counters::default(), Room::default());
    let volume = scene.smoke.as_ref().map(|of| {
        simulation.run(of, &mut counters);
        Volume::new(of, &simulation, &mut shown, &mut counters)
    });
    let tables = &mut Tables::default();
    let mut stage = Stage::new(scene, quality, size.into(), tables);
    stage.volume = volume.as_ref();
    let (width, height) = (size.0 as usize, size.1 as usize);
    let mut kinds = vec![Kind::Traced; width * height];
    let (mut scratch, mut tile, mut finite) = (Scratch::default(), Tile::default(), true);
    for top in (0..height).step_by(TILE) {
        for left in (0..width).step_by(TILE) {
            refine(&stage, &mut scratch, (left, top), &mut tile);
            for y in top..height.min(top + TILE) {
                for x in left..width.min(left + TILE) {
                    kinds[y * width + x] = tile.record[(y - top) * TILE + x - left].kind();
                    finite &= tile.get(x - left, y - top).is_finite();
                }
            }
        }
    }
    SMOKE.set(simulation);
    (kinds, finite)
}

/// How a pixel was painted by the overlay, from its value without and with it.
fn paint(before: u32, after: u32) -> Option<Kind> {
    let like = |target: [f32; 3]| {
        [1.0, 0.7].into_iter().any(|rim| {
            let channel = |i: usize| {
                let mixed = (channels(before)[i] as f32 * 0.55 + target[i] * 0.45) * rim;
                (mixed - channels(after)[i] as f32).abs() <= 1.2
            };
            (0..3).all(channel)
        })
    };
    match (like([224.0, 52.0, 43.0]), like([45.0, 107.0, 255.0])) {
        (true, false) => Some(Kind::Filled),
        (false, true) => Some(Kind::Interpolated),
        _ => None,
    }
}

/// Size of the pictures under the overlay: whole cells, whose pixels outside the picture would be counted
/// too, and more lines than those of many meshes have that are traced pixel by pixel.
const OVERLAID: (u32, u32) = (384, 368);

#[test]
fn the_overlay_shows_how_each_pixel_was_got() {
    // Without additional samples of edges, which take pixels back out of filled cells.
    let quality = Quality { edge_samples: 0, ..preset("high") };
    for part in show::PARTS {
        for frame in [11, 700, 1400] {
            let mut scene = plain(part, frame);
            (scene.grade.grain, scene.grade.vignette) = (0.0, 0.0);
            let (before, counters) = render(&scene, frame, OVERLAID, &quality);
            scene.overlay = 1.0;
            let (after, same) = render(&scene, frame, OVERLAID, &quality);
            // Steps of smoke are taken once.
            let own = [Counter::OverlayPixels, Counter::SmokeCells];
            for (counter, words) in Counter::ALL.into_iter().filter(|c| !own.contains(&c.0)) {
                assert_eq!(counters.get(counter), same.get(counter), "the overlay costs no {words}");
            }
            let (kinds, _) = records(&scene, OVERLAID, &quality);

            let count = |kind: Kind| kinds.iter().filter(|&&k| k == kind).count() as u64;
            let name = part.name;
            assert_eq!(count(Kind::Filled), counters.get(Counter::Filled), "{name} {frame}");
            assert_eq!(count(Kind::Interpolated), counters.get(Counter::Interpolated), "{name} {frame}");
            assert_eq!(count(Kind::Traced), counters.get(Counter::Traced), "{name} {frame}");
            assert!(kinds.iter().any(|&k| k != Kind::Traced), "{name} {frame}: nothing was saved");
            for (i, &kind) in kinds.iter().enumerate() {
                let (x, y) = (i % OVERLAID.0 as usize, i / OVERLAID.0 as usize);
                let at = format!("{name} {frame} at ({x}, {y}): {:06x} to {:06x}", before[i], after[i]);
                match kind {
                    Kind::Traced | Kind::Smoothed => assert_eq!(before[i], after[i], "{at}, traced"),
                    kind => assert_eq!(paint(before[i], after[i]), Some(kind), "{at}"),
                }
            }
        }
    }
}

#[test]
fn small_pictures_of_many_meshes_without_smoothed_edges_are_traced_pixel_by_pixel() {
    let quality = preset("low");
    let part = show::PARTS.iter().find(|part| part.name == "facets").expect("a part of meshes");
    let scene = plain(part, 440);
    let counters = |lines: u32, quality: &Quality| render(&scene, 440, (lines * 16 / 9, lines), quality).1;
    assert_eq!(counters(360, &quality).get(Counter::Interpolated), 0, "360 lines");
    for (lines, quality) in [(361, quality), (360, preset("medium"))] {
        let counters = counters(lines, &quality);
        assert!(counters.get(Counter::Interpolated) > 0, "{lines} lines, tolerance {}", quality.tolerance);
    }
    let gold = show::PARTS.iter().find(|part| part.name == "gold").expect("a part of two meshes");
    assert!(render(&plain(gold, 440), 440, (640, 360), &quality).1.get(Counter::Interpolated) > 0, "gold");
    let (pixels, _) = render(&scene, 440, (640, 360), &quality);
    assert_eq!(pixels, render(&scene, 440, (640, 360), &quality.every_pixel()).0);
}

#[test]
fn the_overlay_wipes_from_the_left_and_spares_smoothed_edges() {
    let quality = preset("high");
    for part in show::PARTS {
        let mut scene = plain(part, 333);
        (scene.grade.grain, scene.grade.vignette) = (0.0, 0.0);
        let (before, counters) = render(&scene, 333, OVERLAID, &quality);
        let (kinds, _) = records(&scene, OVERLAID, &quality);
        for overlay in [0.5, 1.0] {
            scene.overlay = overlay;
            let (after, _) = render(&scene, 333, OVERLAID, &quality);
            let wipe = (overlay * OVERLAID.0 as f32) as usize;
            let mut painted = 0;
            for (i, &kind) in kinds.iter().enumerate() {
                let (x, y) = (i % OVERLAID.0 as usize, i / OVERLAID.0 as usize);
                let at = format!("{} at ({x}, {y})", part.name);
                if before[i] != after[i] {
                    painted += 1;
                    assert!(x < wipe, "{at}: painted right of the wipe");
                    assert_eq!(paint(before[i], after[i]), Some(kind), "{at}");
                } else if x < wipe && kind != Kind::Traced {
                    // Spared as an edge's, which runs through a cell of one pixel's side that has this one as a corner.
                    let cells = (y.max(1) - 1..=y).flat_map(|y| (x.max(1) - 1..=x).map(move |x| (x, y)));
                    let beside = |(x, y)| kinds[y * OVERLAID.0 as usize + x] == Kind::Traced;
                    assert!(cells.into_iter().any(beside), "{at}: not painted");
                }
            }
            let saved = counters.get(Counter::Filled) + counters.get(Counter::Interpolated);
            assert!(painted > 0 && painted <= saved, "{}: {painted} of {saved}", part.name);
            // A pixel that is spared has taken that many samples at least.
            if overlay == 1.0 {
                let smoothed = counters.get(Counter::EdgeSamples) / u64::from(quality.edge_samples);
                assert!(painted + smoothed >= saved, "{}: {painted} of {saved}", part.name);
            }
        }
    }
}

/// Size for what takes every preset.
const SMALL: (u32, u32) = (160, 90);

#[test]
fn every_preset_gives_finite_light() {
    for (name, quality) in Quality::PRESETS {
        for part in show::PARTS {
            for frame in [0, 480, part.frames - 1] {
                let (_, finite) = records(&plain(part, frame), SMALL, &quality);
                let replay = golden::replay(part.name, frame, name, SMALL);
                assert!(finite, "{} {frame} {name}: light that is not finite; replay: {replay}", part.name);
            }
        }
    }
}

#[test]
fn better_presets_are_no_worse() {
    for part in show::PARTS {
        for frame in [200, 900, 1700] {
            let scene = plain(part, frame);
            let (reference, _) = render(&scene, frame, SMALL, &preset("reference"));
            let ladder: Vec<(&str, f64)> = Quality::PRESETS[..5]
                .iter()
                .map(|(name, quality)| (*name, psnr(&reference, &render(&scene, frame, SMALL, quality).0)))
                .collect();
            tell(format_args!("{} {frame}: {ladder:.1?}", part.name));
            for (worse, better) in ladder.iter().zip(&ladder[1..]) {
                let what = format!("{} {frame}: {} {:.2} dB", part.name, worse.0, worse.1);
                let replay = golden::replay(part.name, frame, better.0, SMALL);
                let (name, db) = better;
                assert!(*db >= worse.1 - 1.0, "{what}, {name} only {db:.2}; replay: {replay}");
            }
        }
    }
}
