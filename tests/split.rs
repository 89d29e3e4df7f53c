//! The split frame: each side is what it says, its rays are counted and its error is measured.
mod support;

use luc::show;
use luc_core::counters::Counter;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::{Beam, Camera, Figures, Grade, Scene, Split};
use std::cell::Cell;
use support::picture::psnr;

const SIZE: (u32, u32) = (333, 187);

thread_local! {
    /// What the last split frame of this thread was told to write.
    static TOLD: Cell<Option<Figures>> = const { Cell::new(None) };
}

/// Titles that write nothing, but keep the figures.
fn keep(figures: &Figures, _: &mut Vec<Beam>) -> (Camera, Grade) {
    TOLD.set(Some(*figures));
    (Camera::default(), Grade::DEFAULT)
}

/// The cathedral with the line at `x`, or without line, and without what blurs; at a frame whose errors by
/// interpolation are well over the rounding to bytes.
fn scene(x: Option<f32>) -> Scene {
    let part = show::PARTS.iter().find(|part| part.name == "cost").expect("a part of the show");
    let mut scene = (part.scene)(600);
    scene.effects.clear();
    scene.grade.bloom = 0.0;
    scene.split = x.map(|x| Split { x, slant: 0.1, light: 1.0, titles: keep });
    scene
}

/// Pixels, figures, and rays by the counters without those that measured.
fn draw(x: Option<f32>, quality: &Quality) -> (Vec<u32>, Option<Figures>, u64) {
    let (mut renderer, mut pixels) = (Renderer::default(), vec![0; (SIZE.0 * SIZE.1) as usize]);
    TOLD.set(None);
    renderer.frame(&scene(x), 7, SIZE, quality, &mut pixels);
    let rays = Counter::ALL.iter().filter(|(counter, _)| counter.is_ray());
    let rays = rays.map(|&(counter, _)| renderer.counters.get(counter)).sum();
    (pixels, TOLD.take(), rays)
}

/// Where the line of [`scene`] is in a row, px.
fn line(x: f32, y: usize) -> f32 {
    let up = 1.0 - (y as f32 + 0.5) * 2.0 / SIZE.1 as f32;
    (x + 0.1 * up + 1.0) * 0.5 * SIZE.0 as f32
}

#[test]
fn left_every_pixel_is_traced_and_right_the_frame_is_as_without_line() {
    for (name, quality) in &Quality::PRESETS[..5] {
        let (full, ..) = draw(None, &quality.every_pixel());
        // All of it right of the line.
        let (adaptive, ..) = draw(Some(-2.0), quality);
        for x in [-0.6, 0.04, 0.9] {
            let (both, ..) = draw(Some(x), quality);
            let width = SIZE.0 as usize;
            for (i, pixel) in both.into_iter().enumerate() {
                let from_line = (i % width) as f32 - line(x, i / width);
                let place = (i % width, i / width);
                if from_line < -2.0 {
                    assert_eq!(pixel, full[i], "{name}, line at {x}: {place:?} of the left side");
                }
                // Cells on the line are split.
                if from_line > 34.0 {
                    assert_eq!(pixel, adaptive[i], "{name}, line at {x}: {place:?} of the right side");
                }
            }
        }
    }
}

#[test]
fn the_figures_are_the_rays_of_each_side() {
    for (name, quality) in &Quality::PRESETS[..5] {
        let (_, none, full) = draw(None, &quality.every_pixel());
        assert!(none.is_none());
        let (_, told, rays) = draw(Some(2.0), quality);
        let left = told.unwrap();
        assert_eq!((left.rays, rays, left.error), ([full, 0], full, 0.0), "{name}: all left");
        let (_, told, rays) = draw(Some(-2.0), quality);
        let right = told.unwrap();
        // The counters hold the rays that measured too.
        assert!(right.rays[0] == 0 && right.rays[1] < rays && right.rays[1] < full, "{name}: {right:?}");
        let (_, told, rays) = draw(Some(0.1), quality);
        let both = told.unwrap();
        assert!(both.rays[0] + both.rays[1] <= rays, "{name}: {both:?}");
        assert!(both.rays[0] * 3 > full && both.rays[0] * 3 < 2 * full, "{name}: about half: {both:?}");
    }
}

#[test]
fn tracing_every_pixel_on_both_sides_has_no_error() {
    let quality = Quality::named("high").unwrap().every_pixel();
    let figures = draw(Some(0.0), &quality).1.unwrap();
    assert_eq!(figures.error, 0.0);
}

/// Told without vignette and rounding to bytes, and before edges get more samples.
#[test]
fn the_error_is_that_of_the_adaptive_frame() {
    for name in ["draft", "medium", "high"] {
        let quality = Quality { edge_samples: 0, ..Quality::named(name).unwrap() };
        let (full, ..) = draw(None, &quality.every_pixel());
        let (adaptive, told, _) = draw(Some(-2.0), &quality);
        #[allow(clippy::disallowed_methods, reason = "a figure to read, not a pixel")]
        let (told, true_db) = (-10.0 * told.unwrap().error.log10(), psnr(&full, &adaptive) as f32);
        assert!((told - true_db).abs() < 0.6, "{name}: {told} dB told, {true_db} dB");
    }
}
