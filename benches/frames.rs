//! What a frame costs: every pixel traced against adaptive sampling.
//!
//! `cargo bench` first lets criterion measure each case, then prints a table in Markdown from passes
//! of its own: both ways of sampling, one after the other, and the median of each, so that a machine
//! that slows down slows both. `cargo bench -- --test` runs everything once. Any other filter, as in
//! `cargo bench -- gold`, measures only what it names and prints no table.
//!
//! *Simple* is a scene of three balls, two cones and a plane, with mirrors three deep and one hard
//! shadow: a scene that other ray tracers can be asked to draw.

#[path = "../tests/support/picture.rs"]
#[allow(dead_code, reason = "the tests use the rest")]
mod picture;

use criterion::{BenchmarkId, Criterion};
use luc::show;
use luc_core::counters::{Counter, Counters};
use luc_core::math::Vec3;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::*;
use picture::psnr;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::hint::black_box;
use std::time::{Duration, Instant};

const SIZES: [(u32, u32); 2] = [(800, 600), (1920, 1080)];
const THREADS: [usize; 2] = [1, 2];

/// Sizes over which the growth of the work is measured.
const GROWTH: [(u32, u32); 4] = [(640, 360), (1280, 720), (1920, 1080), (3840, 2160)];

/// Passes over each case of the table.
const PASSES: usize = 7;

/// A frame to draw.
struct Case {
    name: &'static str,
    scene: Scene,
    quality: Quality,
}

/// Three balls, two cones, a plane; one lamp.
fn simple() -> Scene {
    let body = |colour, reflection| Material {
        colour,
        specular: Vec3::splat(0.5),
        exponent: 40.0,
        f0: Vec3::splat(reflection),
        reflection: 1.0,
        ..Material::default()
    };
    let ball =
        |x, y, z, radius, material| Sphere { centre: Vec3::new(x, y, z), radius, material, blend: 0.0 };
    Scene {
        camera: Camera {
            position: Vec3::new(0.0, 2.2, 7.5),
            target: Vec3::new(0.0, 0.8, 0.0),
            roll: 0.0,
            fov: 0.9,
        },
        background: Background {
            stops: vec![
                Stop { y: 0.0, colour: Vec3::new(0.5, 0.6, 0.7) },
                Stop { y: 1.0, colour: Vec3::new(0.1, 0.2, 0.4) },
            ],
            ..Background::default()
        },
        spheres: vec![
            ball(-1.6, 1.0, 0.0, 1.0, 0),
            ball(0.5, 0.7, 1.2, 0.7, 1),
            ball(1.9, 1.1, -0.8, 1.1, 2),
        ],
        planes: vec![Plane { point: Vec3::ZERO, normal: Vec3::Y, reach: f32::INFINITY, material: 3 }],
        cones: vec![
            Cone::between(
                (Vec3::new(-0.3, 2.4, -2.0), 0.0),
                (Vec3::new(-0.3, 0.0, -2.0), 0.9),
                [false, false],
                1,
            ),
            Cone::between(
                (Vec3::new(-3.4, 1.6, 0.8), 0.0),
                (Vec3::new(-3.4, 0.0, 0.8), 0.6),
                [false, false],
                2,
            ),
        ],
        materials: vec![
            body(Vec3::new(0.7, 0.2, 0.15), 0.3),
            body(Vec3::new(0.2, 0.6, 0.25), 0.15),
            body(Vec3::new(0.2, 0.3, 0.7), 0.3),
            body(Vec3::new(0.4, 0.4, 0.4), 0.1),
        ],
        lights: vec![Light {
            position: Vec3::new(4.0, 8.0, 6.0),
            colour: Vec3::splat(110.0),
            kind: LightKind::Point,
        }],
        ambient: [Vec3::splat(0.05), Vec3::splat(0.1)],
        ..Scene::default()
    }
}

fn cases() -> Vec<Case> {
    let quality = Quality::named("high").expect("a preset");
    let part = |name: &'static str, frame| {
        let index = show::PARTS.iter().position(|p| p.name == name).expect("a part");
        Case { name, scene: Scene { overlay: 0.0, ..(show::PARTS[index].scene)(frame) }, quality }
    };
    vec![
        part("mirror", 600),
        part("gold", 600),
        Case { name: "simple", scene: simple(), quality: Quality { depth: 3, ..quality } },
    ]
}

/// The two ways of sampling: name, and the quality that asks for it.
fn ways(case: &Case) -> [(&'static str, Quality); 2] {
    [("every pixel", case.quality.every_pixel()), ("adaptive", case.quality)]
}

fn pool(threads: usize) -> ThreadPool {
    ThreadPoolBuilder::new().num_threads(threads).build().expect("threads")
}

/// A picture and what it took.
struct Frame {
    renderer: Renderer,
    pixels: Vec<u32>,
    size: (u32, u32),
}

impl Frame {
    fn new(size: (u32, u32)) -> Self {
        Self { renderer: Renderer::default(), pixels: vec![0; (size.0 * size.1) as usize], size }
    }

    fn draw(&mut self, scene: &Scene, quality: &Quality) {
        self.renderer.frame(black_box(scene), 0, self.size, black_box(quality), &mut self.pixels);
    }
}

fn measure(criterion: &mut Criterion) {
    for case in cases() {
        for size in SIZES {
            let mut group = criterion.benchmark_group(format!("{} {}x{}", case.name, size.0, size.1));
            for threads in THREADS {
                let pool = pool(threads);
                for (way, quality) in ways(&case) {
                    let mut frame = Frame::new(size);
                    group.bench_function(BenchmarkId::new(way, threads), |b| {
                        pool.install(|| b.iter(|| frame.draw(&case.scene, &quality)));
                    });
                }
            }
            group.finish();
        }
    }
}

fn rays(counters: &Counters) -> u64 {
    use Counter::{PrimaryRays, ReflectedRays, RefractedRays, ShadowRays};
    [PrimaryRays, ReflectedRays, RefractedRays, ShadowRays].into_iter().map(|c| counters.get(c)).sum()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Milliseconds, rays and picture of both ways of sampling, in interleaved passes.
fn compare(case: &Case, size: (u32, u32), threads: usize, passes: usize) -> [(f64, Frame); 2] {
    let pool = pool(threads);
    let mut frames = [Frame::new(size), Frame::new(size)];
    let mut times = [Vec::new(), Vec::new()];
    // The first pass only warms up.
    for pass in 0..=passes {
        for ((frame, times), (_, quality)) in frames.iter_mut().zip(&mut times).zip(ways(case)) {
            let begin = Instant::now();
            pool.install(|| frame.draw(&case.scene, &quality));
            if pass > 0 {
                times.push(begin.elapsed().as_secs_f64() * 1e3);
            }
        }
    }
    let [full, adaptive] = frames;
    let [full_times, adaptive_times] = times;
    [(median(full_times), full), (median(adaptive_times), adaptive)]
}

/// Slope of the straight line through points (ln x, ln y): the exponent of growth.
#[allow(clippy::disallowed_methods, reason = "a figure to read, not a pixel")]
fn exponent(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let n = logs.len() as f64;
    let (mx, my) = logs.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let over: f64 = logs.iter().map(|(x, y)| (x - mx) * (y - my)).sum();
    over / logs.iter().map(|(x, _)| (x - mx) * (x - mx)).sum::<f64>()
}

fn table(passes: usize) {
    println!(
        "\n| scene | size | threads | every pixel, ms | adaptive, ms | ratio | rays, every pixel | rays, adaptive | pixels traced | dB |"
    );
    println!("|---|---|---:|---:|---:|---:|---:|---:|---:|---:|");
    for case in cases() {
        for size in SIZES {
            for threads in THREADS {
                let [(full_ms, full), (ms, adaptive)] = compare(&case, size, threads, passes);
                let counters = &adaptive.renderer.counters;
                println!(
                    "| {} | {}x{} | {threads} | {full_ms:.1} | {ms:.1} | {:.1} | {:.2} M | {:.2} M | {:.1} % | {:.1} |",
                    case.name,
                    size.0,
                    size.1,
                    full_ms / ms,
                    rays(&full.renderer.counters) as f64 / 1e6,
                    rays(counters) as f64 / 1e6,
                    100.0 * counters.get(Counter::Traced) as f64 / full.pixels.len() as f64,
                    psnr(&full.pixels, &adaptive.pixels),
                );
            }
        }
    }

    let [small, .., large] = GROWTH;
    println!(
        "\nGrowth from {}x{} to {}x{}: exponents over the number of pixels\n",
        small.0, small.1, large.0, large.1
    );
    println!("| scene | pixels traced | primary rays | all rays |");
    println!("|---|---:|---:|---:|");
    for case in cases() {
        let mut counts = [vec![], vec![], vec![]];
        for size in GROWTH {
            let mut frame = Frame::new(size);
            frame.draw(&case.scene, &case.quality);
            let counters = &frame.renderer.counters;
            let values = [counters.get(Counter::Traced), counters.get(Counter::PrimaryRays), rays(counters)];
            for (list, value) in counts.iter_mut().zip(values) {
                list.push((frame.pixels.len() as f64, value as f64));
            }
        }
        let [traced, primary, all] = counts.map(|points| exponent(&points));
        println!("| {} | {traced:.2} | {primary:.2} | {all:.2} |", case.name);
    }
}

fn main() {
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_millis(1500))
        .configure_from_args();
    measure(&mut criterion);
    criterion.final_summary();
    let args: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    match args.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => table(PASSES),
        ["--test"] => table(1),
        _ => {}
    }
}
