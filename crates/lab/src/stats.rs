//! `lab stats`: one frame's counters, time and error.

use crate::metric::psnr;
use luc::show;
use luc_core::counters::{Counter, Counters};
use luc_core::plan;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use std::time::Instant;

/// Passes over a frame whose median time is reported.
const PASSES: usize = 9;

fn render(n: u64, size: (u32, u32), quality: &Quality) -> (Vec<u32>, Counters, f64) {
    let mut renderer = Renderer::default();
    let mut pixels = vec![0; (size.0 * size.1) as usize];
    let mut times: Vec<f64> = (0..PASSES)
        .map(|_| {
            let begin = Instant::now();
            show::frame(&mut renderer, n, size, quality, &mut pixels);
            begin.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    times.sort_by(f64::total_cmp);
    (pixels, renderer.counters, times[PASSES / 2])
}

/// Runs the command with the arguments after `stats`.
pub fn run(args: &[String]) -> Result<(), String> {
    let arg = |i: usize, default: &str| args.get(i).cloned().unwrap_or(default.into());
    let n: u64 = arg(0, "0").parse().map_err(|_| "FRAME must be a whole number")?;
    let quality = crate::args::preset(&arg(1, "high"))?;
    let size = crate::args::size(&arg(2, "1280x720"))?;

    let (adaptive, counters, time) = render(n, size, &quality);
    let (full, full_counters, full_time) = render(n, size, &quality.every_pixel());
    println!("{:>24} {:>12} {:>12}", "", "adaptive", "every pixel");
    for warning in plan::warnings(&show::scene(n), &quality) {
        println!("warning: {warning}");
    }
    for (counter, name) in Counter::ALL {
        println!("{name:>24} {:>12} {:>12}", counters.get(counter), full_counters.get(counter));
    }
    println!("{:>24} {time:>12.2} {full_time:>12.2}", "ms");
    println!("{:>24} {:>12.2}", "dB", psnr(&adaptive, &full));
    Ok(())
}
