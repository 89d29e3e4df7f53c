//! What a frame costs over its size: every part at `high` from 320x180 to 3840x2160, and the
//! exponents of growth.

use super::knob::base;
use super::table::short;
use crate::figures::{power_law, processor_ms, quantile};
use crate::progress::Progress;
use crate::subject::Subject;
use luc_core::counters::Counter;
use luc_core::render::Renderer;
use rayon::ThreadPool;
use std::fs::{read_to_string, write};
use std::io::ErrorKind;
use std::path::Path;

/// Sizes from smallest to largest.
const SIZES: [(u32, u32); 7] =
    [(320, 180), (640, 360), (960, 540), (1280, 720), (1920, 1080), (2560, 1440), (3840, 2160)];

/// Sizes of `--quick`.
const QUICK: usize = 3;

const FILE: &str = "resolution.csv";

/// One part at one size.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Name of the part.
    pub part: String,
    /// Width and height, px.
    pub size: (u32, u32),
    /// Median processor time, ms.
    pub ms: f64,
    /// Rays of all kinds.
    pub rays: f64,
    /// Pixels traced.
    pub traced: f64,
}

impl Point {
    /// Pixels of the picture.
    pub fn pixels(&self) -> f64 {
        f64::from(self.size.0) * f64::from(self.size.1)
    }

    fn write(&self) -> String {
        let (w, h) = self.size;
        format!("{},{w},{h},{},{},{}\n", self.part, short(self.ms), self.rays, self.traced)
    }

    fn read(line: &str) -> Option<Point> {
        let fields: Vec<&str> = line.split(',').collect();
        let [part, w, h, ms, rays, traced] = fields[..] else { return None };
        Some(Point {
            part: part.into(),
            size: (w.parse().ok()?, h.parse().ok()?),
            ms: ms.parse().ok()?,
            rays: rays.parse().ok()?,
            traced: traced.parse().ok()?,
        })
    }
}

/// The points in a study's folder.
pub fn read(out: &Path) -> Result<Vec<Point>, String> {
    let path = out.join(FILE);
    let text = match read_to_string(&path) {
        Ok(text) => text,
        Err(e) if e.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        Err(e) => return Err(format!("{}: {e}", path.display())),
    };
    Ok(text.lines().skip(2).filter_map(Point::read).collect())
}

/// Measures what the folder's table lacks.
pub fn measure(
    pool: &ThreadPool,
    subjects: &[Subject],
    out: &Path,
    conditions: &str,
    quick: bool,
    fresh: bool,
) -> Result<(), String> {
    let path = out.join(FILE);
    let fault = |e| format!("{}: {e}", path.display());
    let old = read_to_string(&path).unwrap_or_default();
    let mut points = Vec::new();
    if !fresh && old.lines().next() == Some(conditions) {
        points = read(out)?;
    }
    let sizes = if quick { &SIZES[..QUICK] } else { &SIZES };
    let passes = if quick { 1 } else { 3 };
    let megapixels = |size: &(u32, u32)| f64::from(size.0) * f64::from(size.1) / 1e6;
    let lacks = |points: &[Point], s: &Subject, size: &(u32, u32)| {
        !points.iter().any(|p| p.part == s.name && p.size == *size)
    };
    let todo = subjects.iter().flat_map(|s| sizes.iter().filter(|size| lacks(&points, s, size)));
    let mut progress = Progress::new(todo.map(megapixels).sum::<f64>().max(1e-9));
    for subject in subjects {
        let n = subject.frames / 2;
        let scene = subject.bare(n);
        for size in sizes {
            if !lacks(&points, subject, size) {
                continue;
            }
            progress.step(0.0, &format!("{} at {}x{}", subject.name, size.0, size.1));
            let mut renderer = Renderer::default();
            let mut pixels = vec![0; size.0 as usize * size.1 as usize];
            let mut times = Vec::new();
            // The first pass only warms up.
            for pass in 0..=passes {
                let begin = processor_ms();
                pool.install(|| renderer.frame(&scene, n, *size, &base(), &mut pixels));
                if pass > 0 {
                    times.push(processor_ms() - begin);
                }
            }
            use Counter::*;
            let kinds = [PrimaryRays, ReflectedRays, RefractedRays, ScatterRays, ShadowRays];
            points.push(Point {
                part: subject.name.into(),
                size: *size,
                ms: quantile(&times, 0.5),
                rays: kinds.iter().map(|&c| renderer.counters.get(c)).sum::<u64>() as f64,
                traced: renderer.counters.get(Traced) as f64,
            });
            let rows: String = points.iter().map(Point::write).collect();
            write(&path, format!("{conditions}\npart,width,height,ms,rays,traced\n{rows}")).map_err(fault)?;
            progress.step(megapixels(size), subject.name);
        }
    }
    progress.end("growth measured");
    Ok(())
}

/// Exponent of growth of a part's `value` with its pixels, and the factor before it.
pub fn exponent(points: &[Point], part: &str, value: fn(&Point) -> f64) -> (f64, f64) {
    let of = points.iter().filter(|p| p.part == part && value(p) > 0.0);
    power_law(&of.map(|p| (p.pixels(), value(p))).collect::<Vec<_>>())
}
