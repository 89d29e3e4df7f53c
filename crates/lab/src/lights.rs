//! `lab lights`: what culling small lights saves, for numbers of lights and sides of tiles.
//!
//! Every pixel is traced. Naive and culled frames take turns, so that both meet the same other load
//! of the machine.

use crate::swarm;
use luc_core::counters::Counter;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use std::time::Instant;

const SIZE: (u32, u32) = (640, 360);
const SIDES: [u32; 5] = [4, 8, 16, 32, 64];
const COUNTS: [usize; 10] = [1, 2, 4, 8, 16, 32, 64, 128, 256, 512];
/// Rounds whose median times are told.
const ROUNDS: usize = 5;

/// Runs the command and prints its table.
pub fn run(_args: &[String]) -> Result<(), String> {
    let quality = Quality::named("high").ok_or("no preset high")?.every_pixel();
    let naive = Quality { cull: false, ..quality };
    println!("every pixel of {}x{}; time and evaluations per pixel, against naive", SIZE.0, SIZE.1);
    println!(
        "{:>7} {:>10} {:>8} {}",
        "lights",
        "naive, ms",
        "per px",
        SIDES.map(|s| format!("{s:>7} px      ")).concat()
    );
    for count in COUNTS {
        let scene = swarm::scene(count);
        let qualities: Vec<Quality> =
            std::iter::once(naive).chain(SIDES.map(|light_tile| Quality { light_tile, ..quality })).collect();
        let mut renderer = Renderer::default();
        let mut times = vec![Vec::new(); qualities.len()];
        let mut evaluations = vec![0; qualities.len()];
        let mut pixels = vec![0; (SIZE.0 * SIZE.1) as usize];
        for _ in 0..ROUNDS {
            for (i, quality) in qualities.iter().enumerate() {
                let begin = Instant::now();
                renderer.frame(&scene, 0, SIZE, quality, &mut pixels);
                times[i].push(begin.elapsed().as_secs_f64() * 1e3);
                evaluations[i] = renderer.counters.get(Counter::PointLights);
            }
        }
        let median = |times: &mut Vec<f64>| {
            times.sort_by(f64::total_cmp);
            times[ROUNDS / 2]
        };
        let times: Vec<f64> = times.iter_mut().map(median).collect();
        let per_pixel = |n: u64| n as f64 / pixels.len() as f64;
        print!("{count:>7} {:>10.1} {:>8.2} ", times[0], per_pixel(evaluations[0]));
        for (time, &n) in times.iter().zip(&evaluations).skip(1) {
            print!("{:>5.2}x {:>6.2} ", time / times[0], per_pixel(n));
        }
        println!();
    }
    Ok(())
}
