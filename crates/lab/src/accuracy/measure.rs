//! One frame under all settings: interleaved passes for the time, then counts and errors.

use super::knob::{Change, FULL_LIGHT, Knob, MANY, Setting, Truth, base};
use super::table::{Figure, Row};
use crate::figures::{mean, processor_ms, quantile};
use crate::metric::{Picture, flicker, flip, greatest, linear_rmse, psnr, psnr_of_rmse, ssim};
use crate::scale::enlarge;
use crate::subject::Subject;
use luc_core::counters::{Counter, Counters};
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use rayon::ThreadPool;
use std::time::Instant;

/// How much to measure.
#[derive(Clone, Copy)]
pub struct Effort {
    /// Size of the pictures.
    pub size: (u32, u32),
    /// Most passes of a setting.
    pub passes: usize,
    /// Processor time after which a setting gets no further pass, ms.
    pub enough: f64,
    /// Samples of a pixel of the truth besides the first.
    pub samples: u32,
    /// Those of the truth for reflection models, whose rays branch.
    pub light_samples: u32,
    /// Consecutive frames over which flicker is measured.
    pub flicker: u64,
}

/// A knob and one of its settings.
pub type Task<'a> = (&'a Knob, &'a Setting);

/// Draws frame `n` of a subject.
pub fn draw(renderer: &mut Renderer, subject: &Subject, n: u64, setting: &Setting, out: &mut Picture) {
    let scene = setting.change.of(subject.bare(n));
    if setting.scale == 1.0 {
        return renderer.frame(&scene, n, out.size, &setting.quality, &mut out.pixels);
    }
    let side = |length: u32| ((length as f32 * setting.scale) as u32).max(1);
    let mut small = Picture::new((side(out.size.0), side(out.size.1)));
    renderer.frame(&scene, n, small.size, &setting.quality, &mut small.pixels);
    enlarge(&small, out);
}

/// The setting that draws the truth.
///
/// All samples lie within their pixel: averaging patterns, which moves the whole picture by up to half a
/// pixel, would make the truth a blurred one.
pub fn truth_setting(truth: Truth, samples: u32) -> Setting {
    let [.., (_, reference)] = Quality::PRESETS;
    let (change, quality) = match truth {
        Truth::Show => (Change::None, Quality { samples, ..reference }),
        Truth::Light => (FULL_LIGHT, Quality { samples, ..reference }),
        // So that errors are those of the motion alone.
        Truth::Smoke => (Change::Smoke(2.0, MANY), base()),
    };
    Setting { label: String::new(), quality, change, scale: 1.0 }
}

/// Draws the truth of a frame.
pub fn truth(subject: &Subject, n: u64, effort: &Effort, truth: Truth) -> Picture {
    let mut picture = Picture::new(effort.size);
    let samples = if truth == Truth::Light { effort.light_samples } else { effort.samples };
    draw(&mut Renderer::default(), subject, n, &truth_setting(truth, samples), &mut picture);
    picture
}

/// Processor and wall clock times of one setting's passes, ms, and what the last one counted.
#[derive(Default)]
pub struct Timing {
    times: Vec<f64>,
    wall: Vec<f64>,
    counters: Counters,
}

/// Draws all settings in turn, again and again, in `pool`; the first pass of all only warms up.
pub fn time(
    pool: &ThreadPool,
    subject: &Subject,
    n: u64,
    tasks: &[Task],
    effort: &Effort,
    mut tell: impl FnMut(&str),
) -> Vec<Timing> {
    let mut timings: Vec<Timing> = tasks.iter().map(|_| Timing::default()).collect();
    let mut renderer = Renderer::default();
    let mut picture = Picture::new(effort.size);
    if let Some((_, first)) = tasks.first() {
        pool.install(|| draw(&mut renderer, subject, n, first, &mut picture));
    }
    for pass in 0..effort.passes {
        for ((knob, setting), timing) in tasks.iter().zip(&mut timings) {
            if pass > 0 && timing.times.iter().sum::<f64>() > effort.enough {
                continue;
            }
            tell(&format!("{} {n}: time, pass {}, {} {}", subject.name, pass + 1, knob.name, setting.label));
            let (wall, processor) = (Instant::now(), processor_ms());
            pool.install(|| draw(&mut renderer, subject, n, setting, &mut picture));
            timing.times.push(processor_ms() - processor);
            timing.wall.push(wall.elapsed().as_secs_f64() * 1e3);
            timing.counters = renderer.counters;
        }
    }
    timings
}

/// Draws the frames before `n` and it itself, one by one, so that smoke moves; a time is the mean of two
/// frames, one of which took a step.
pub fn time_moving(
    pool: &ThreadPool,
    subject: &Subject,
    n: u64,
    setting: &Setting,
    effort: &Effort,
) -> (Timing, Picture) {
    let mut timing = Timing::default();
    let mut renderer = Renderer::default();
    let mut picture = Picture::new(effort.size);
    let first = n.saturating_sub(2 * effort.passes as u64);
    draw(&mut renderer, subject, first, setting, &mut picture);
    let mut before = (Instant::now(), processor_ms());
    for k in first + 1..=n {
        pool.install(|| draw(&mut renderer, subject, k, setting, &mut picture));
        if (k - first).is_multiple_of(2) {
            let now = (Instant::now(), processor_ms());
            timing.wall.push((now.0 - before.0).as_secs_f64() * 500.0);
            timing.times.push((now.1 - before.1) * 0.5);
            before = now;
        }
    }
    timing.counters = renderer.counters;
    (timing, picture)
}

/// Fills in times and counts.
pub fn fill_counts(row: &mut Row, timing: &Timing, pixels: f64) {
    use Counter::*;
    let count = |counters: &[Counter]| counters.iter().map(|&c| timing.counters.get(c)).sum::<u64>() as f64;
    let rays = [PrimaryRays, ReflectedRays, RefractedRays, ScatterRays, ShadowRays];
    let steps = [
        SphereTests,
        PlaneTests,
        CylinderTests,
        EndlessTests,
        ConeTests,
        TriangleTests,
        VoxelSteps,
        SmokeMarched,
        FieldSteps,
        NodeVisits,
        FacetTests,
    ];
    let share = |counter| 100.0 * count(&[counter]) / count(&[Traced, Interpolated, Filled]);
    for (figure, value) in [
        (Figure::Ms, quantile(&timing.times, 0.5)),
        (Figure::MsLow, quantile(&timing.times, 0.25)),
        (Figure::MsHigh, quantile(&timing.times, 0.75)),
        (Figure::WallMs, quantile(&timing.wall, 0.5)),
        (Figure::Primary, count(&[PrimaryRays])),
        (Figure::Reflected, count(&[ReflectedRays])),
        (Figure::Refracted, count(&[RefractedRays])),
        (Figure::Rough, count(&[RoughRays])),
        (Figure::Scatter, count(&[ScatterRays])),
        (Figure::Shadow, count(&[ShadowRays])),
        (Figure::Rays, count(&rays)),
        (Figure::Steps, count(&steps)),
        (Figure::Traced, share(Traced)),
        (Figure::Interpolated, share(Interpolated)),
        (Figure::Filled, share(Filled)),
        (Figure::EdgeSamples, count(&[EdgeSamples]) / pixels),
    ] {
        row.set(figure, value);
    }
}

/// Fills in errors of `picture`.
pub fn fill_errors(row: &mut Row, truth: &Picture, picture: &Picture) {
    let rmse = linear_rmse(truth, picture);
    for (figure, value) in [
        (Figure::Rmse, rmse),
        (Figure::Psnr, psnr_of_rmse(rmse)),
        (Figure::Ssim, ssim(truth, picture)),
        (Figure::Flip, mean(&flip(truth, picture))),
        (Figure::Greatest, greatest(truth, picture)),
    ] {
        row.set(figure, value);
    }
}

/// PSNR of display values against the same setting with every pixel traced, dB.
pub fn error_of_sampling(
    renderer: &mut Renderer,
    subject: &Subject,
    n: u64,
    setting: &Setting,
    picture: &Picture,
) -> f64 {
    let quality = setting.quality.every_pixel();
    let mut full = Picture::new(picture.size);
    let full_setting = Setting { quality, label: String::new(), ..*setting };
    draw(renderer, subject, n, &full_setting, &mut full);
    psnr(&full.pixels, &picture.pixels)
}

/// The frames over which flicker is measured: they end with the part.
pub fn flicker_frames(subject: &Subject, n: u64, count: u64) -> std::ops::Range<u64> {
    let end = (n + count).min(subject.frames);
    end.saturating_sub(count)..end
}

/// Samples of a pixel of `reference` besides the first.
pub fn reference_samples() -> u32 {
    let [.., (_, reference)] = Quality::PRESETS;
    reference.samples
}

/// Truths of those frames: `reference`.
pub fn flicker_truths(
    subject: &Subject,
    n: u64,
    effort: &Effort,
    mut tell: impl FnMut(&str),
) -> Vec<Picture> {
    let setting = truth_setting(Truth::Show, reference_samples());
    let mut renderer = Renderer::default();
    let mut one = |n| {
        tell(&format!("{} {n}: truth for flicker", subject.name));
        let mut picture = Picture::new(effort.size);
        draw(&mut renderer, subject, n, &setting, &mut picture);
        picture
    };
    flicker_frames(subject, n, effort.flicker).map(&mut one).collect()
}

/// Flicker of a setting: the root of the mean square over all steps in time.
pub fn measure_flicker(
    renderer: &mut Renderer,
    subject: &Subject,
    n: u64,
    setting: &Setting,
    truths: &[Picture],
) -> f64 {
    let mut squares = Vec::new();
    let mut before: Option<Picture> = None;
    for (i, n) in flicker_frames(subject, n, truths.len() as u64).enumerate() {
        let mut picture = Picture::new(truths[i].size);
        draw(renderer, subject, n, setting, &mut picture);
        if let Some(before) = &before {
            squares.push(flicker([before, &picture], [&truths[i - 1], &truths[i]]).powi(2));
        }
        before = Some(picture);
    }
    mean(&squares).sqrt()
}
