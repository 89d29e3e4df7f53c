//! Instructions of the hot kernels, counted by valgrind: the same on every run, whatever the load.
//!
//! `lab kernel NAME COUNT` does a kernel's work COUNT times in a process of its own. Two processes with
//! different counts are run under callgrind, and the difference is what the work takes.

use crate::subject::Subject;
use luc_core::counters::Counters;
use luc_core::math::lanes::{Bound, F, RAMP, V3, splat};
use luc_core::math::{lanes_fn, noise};
use luc_core::post::Display;
use luc_core::quality::Quality;
use luc_core::render::{Renderer, Stage, Tables};
use luc_core::scene::Grade;
use luc_core::trace::{Rays8, nearest};
use std::hint::black_box;
use std::process::Command;

/// A kernel: its name, what one unit of its work is, and the function that does so many.
type Kernel = (&'static str, &'static str, fn(u32));

/// All kernels but those of the parts.
const KERNELS: [Kernel; 6] = [
    ("exp", "8 values", |n| lanes(n, lanes_fn::exp)),
    ("pow", "8 values", |n| lanes(n, |x| lanes_fn::pow(x, splat(2.4)))),
    ("sin-cos", "8 values", |n| lanes(n, |x| lanes_fn::sin_cos(x).0)),
    ("log2", "8 values", |n| lanes(n, lanes_fn::log2)),
    ("noise", "8 points", |n| lanes(n, |x| noise::value_noise(V3::new(x, x + splat(0.3), x + splat(0.7))).0)),
    ("display", "8 colours", display),
];

/// Counts of work of the two processes.
const FEW: u32 = 1;
const MANY: u32 = 3;
/// Packets of lane kernels, and rows of rays, in one unit of counting.
const BATCH: u32 = 4000;
const SIZE: (u32, u32) = (96, 54);

fn lanes(n: u32, f: impl Fn(F) -> F) {
    let mut sum = F::ZERO;
    for i in 0..n * BATCH {
        sum += f(black_box(RAMP * splat(0.01) + splat(i as f32 * 1e-3)));
    }
    black_box(sum);
}

fn display(n: u32) {
    let display = Display::new(&Grade::DEFAULT);
    let mut sum = V3::ZERO;
    for i in 0..n * BATCH {
        let v = black_box(RAMP * splat(0.1) + splat(i as f32 * 1e-4));
        sum += display.map8(V3::new(v, v, v));
    }
    black_box(sum);
}

/// Nearest hits of the first rays of a part's middle frame.
fn first_rays(subject: &Subject, n: u32) {
    let scene = subject.bare(subject.frames / 2);
    let (_, quality) = Quality::PRESETS[Quality::DEFAULT];
    let tables = &mut Tables::default();
    let stage = Stage::new(&scene, &quality, SIZE.into(), tables);
    let origin = V3::splat(scene.camera.position);
    let mut sum = F::ZERO;
    for i in 0..n * SIZE.0 * SIZE.1 / 8 {
        let (x, y) = (i * 8 % SIZE.0, i * 8 / SIZE.0 % SIZE.1);
        let direction = stage.directions(splat(x as f32 + 0.5) + RAMP, splat(y as f32 + 0.5));
        let hit = nearest(&scene, &quality, &Rays8 { origin, direction }, u64::MAX, &mut Counters::default());
        sum += hit.t.at_most(splat(1e3));
    }
    black_box(sum);
}

/// The middle frame of a part at the default preset.
fn frames(subject: &Subject, n: u32) {
    let scene = subject.bare(subject.frames / 2);
    let mut pixels = vec![0; (SIZE.0 * SIZE.1) as usize];
    let mut renderer = Renderer::default();
    for _ in 0..n {
        renderer.frame(&scene, 0, SIZE, &Quality::PRESETS[Quality::DEFAULT].1, &mut pixels);
    }
    black_box(pixels);
}

/// Does a kernel's work: the command `kernel NAME COUNT`.
pub fn run(args: &[String]) -> Result<(), String> {
    let [name, count] = args else { return Err("a kernel's NAME and a COUNT".into()) };
    let count = crate::args::count(count)?;
    let part = |kind: &str| {
        let part = name.strip_prefix(kind)?;
        Subject::show().into_iter().find(|s| s.name == part)
    };
    if let Some((.., work)) = KERNELS.iter().find(|k| k.0 == name) {
        work(count);
    } else if let Some(subject) = part("rays-") {
        first_rays(&subject, count);
    } else if let Some(subject) = part("frame-") {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        pool.map_err(|e| e.to_string())?.install(|| frames(&subject, count));
    } else {
        return Err(format!("no kernel is called {name}"));
    }
    Ok(())
}

/// Instructions of `kernel NAME COUNT`.
fn instructions(name: &str, count: u32) -> Result<u64, String> {
    let own = std::env::current_exe().map_err(|e| e.to_string())?;
    let done = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(own)
        .args(["kernel", name, &count.to_string()])
        .output()
        .map_err(|e| format!("valgrind can't be started ({e}); install it to count instructions"))?;
    let said = String::from_utf8_lossy(&done.stderr);
    let collected = said.lines().find_map(|line| line.split_once("Collected :"));
    let count = collected.and_then(|(_, n)| n.split_whitespace().next()?.parse().ok());
    count.ok_or_else(|| format!("valgrind said: {}", said.lines().last().unwrap_or("nothing")))
}

/// Counts all kernels and prints a table.
pub fn count() -> Result<(), String> {
    println!("| kernel | unit | instructions |\n|---|---|---:|");
    let print = |name: &str, unit: &str, per: f64| -> Result<(), String> {
        let spent = instructions(name, MANY)?.saturating_sub(instructions(name, FEW)?);
        println!("| {name} | {unit} | {:.1} |", spent as f64 / f64::from(MANY - FEW) / per);
        Ok(())
    };
    for (name, unit, _) in KERNELS {
        print(name, unit, f64::from(BATCH))?;
    }
    let pixels = f64::from(SIZE.0 * SIZE.1);
    for subject in Subject::show() {
        print(&format!("rays-{}", subject.name), "ray", pixels)?;
        print(&format!("frame-{}", subject.name), "pixel", pixels)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kernel_runs_and_unknown_ones_are_named() {
        let run = |name: &str, count: &str| super::run(&[name.to_string(), count.to_string()]);
        for (name, ..) in KERNELS {
            run(name, "1").unwrap();
        }
        run("rays-mirror", "1").unwrap();
        run("frame-gold", "1").unwrap();
        assert!(run("rays-silver", "1").unwrap_err().contains("rays-silver"));
        assert!(run("exp", "0").is_err());
    }
}
