//! Our tree over triangles beside those of other crates: the same mesh, the same rays, one thread, in turns.
//!
//! Before anything is timed the hits are compared. Primary rays look at a bumpy knot in tiles of 4x2, about
//! half of them hit; diffuse and shadow rays begin at those hits, off the surface. Times are the least of the
//! passes, in which all take turns: what disturbs the machine disturbs all alike.

#[path = "../../lab/src/mesh/knot.rs"]
mod knot;
mod ours;
mod peers;
mod rays;

use rays::{Kind, Rays};
use std::time::Instant;

/// A tracer that has built its tree.
pub trait Tracer {
    /// Distance of each ray's nearest hit, infinite for none; or, if any will do, -1 for a hit.
    fn trace(&self, rays: &Rays, out: &mut [f32]);
}

/// A tracer's name, and what builds it.
type Build = (&'static str, fn(&[[glam::Vec3A; 3]]) -> Box<dyn Tracer>);

const ALL: [Build; 5] = [
    ("luc", ours::build),
    ("obvhs cwbvh", peers::obvhs_wide),
    ("obvhs bvh2", peers::obvhs_binary),
    ("parry3d", peers::parry),
    ("bvh", peers::bvh),
];

/// Passes of which the fastest counts, and those of building.
const PASSES: usize = 7;
const BUILDS: usize = 3;

/// Least time of some work, ms.
fn least(best: &mut f64, work: impl FnOnce()) {
    let begin = Instant::now();
    work();
    *best = best.min(begin.elapsed().as_secs_f64() * 1e3);
}

/// Whether two tracers tell the same of nearly all rays: about edges they may differ.
fn compare(name: &str, kind: Kind, ours: &[f32], theirs: &[f32]) -> Result<f64, String> {
    let same = |(a, b): (&f32, &f32)| a == b || (a - b).abs() <= 2e-4 * a.abs().max(1.0);
    let differ = ours.iter().zip(theirs).filter(|&pair| !same(pair)).count();
    let share = differ as f64 / ours.len() as f64;
    match share < 1e-3 {
        true => Ok(share),
        false => Err(format!("{name} finds other hits for {differ} of {} {kind:?} rays", ours.len())),
    }
}

fn run(counts: &[usize], side: usize) -> Result<(), String> {
    println!("| triangles | tracer | build, ms | primary | diffuse | shadow | other hits |");
    println!("|---:|---|---:|---:|---:|---:|---:|");
    for &count in counts {
        let (triangles, _) = knot::knot(count);
        let triangles: Vec<[glam::Vec3A; 3]> =
            triangles.iter().map(|t| t.map(|p| glam::Vec3A::from_array(p.to_array()))).collect();
        let mut builds = [f64::INFINITY; ALL.len()];
        let mut tracers: Vec<Box<dyn Tracer>> = Vec::new();
        for pass in 0..BUILDS {
            for ((_, build), best) in ALL.iter().zip(&mut builds) {
                let mut made = None;
                least(best, || made = Some(build(&triangles)));
                tracers.extend(made.filter(|_| pass == 0));
            }
        }
        let primary = rays::primary(side);
        let mut hits = vec![0.0; primary.len()];
        tracers[0].trace(&primary, &mut hits);
        let lists = [rays::diffuse(&primary, &hits), rays::shadow(&primary, &hits)];
        let lists: Vec<Rays> = std::iter::once(primary).chain(lists).collect();
        let mut times = [[f64::INFINITY; 3]; ALL.len()];
        let mut differ = [0.0_f64; ALL.len()];
        for (k, list) in lists.iter().enumerate() {
            let mut truth = vec![0.0; list.len()];
            tracers[0].trace(list, &mut truth);
            let mut out = vec![0.0; list.len()];
            for (i, tracer) in tracers.iter().enumerate() {
                tracer.trace(list, &mut out);
                differ[i] = differ[i].max(compare(ALL[i].0, list.kind, &truth, &out)?);
            }
            for _ in 0..PASSES {
                for (tracer, times) in tracers.iter().zip(&mut times) {
                    least(&mut times[k], || tracer.trace(list, &mut out));
                }
            }
        }
        let speed = |i: usize, k: usize| lists[k].len() as f64 / times[i][k] / 1e3;
        for (i, (name, _)) in ALL.iter().enumerate() {
            let [a, b, c] = [0, 1, 2].map(|k| speed(i, k));
            println!(
                "| {} | {name} | {:.1} | {a:.2} | {b:.2} | {c:.2} | {:.1e} |",
                triangles.len(),
                builds[i],
                differ[i]
            );
        }
        let best = |k: usize| (1..ALL.len()).map(|i| speed(i, k)).fold(0.0, f64::max);
        let [a, b, c] = [0, 1, 2].map(|k| speed(0, k) / best(k));
        let build = builds[0] / builds[1..].iter().copied().fold(f64::INFINITY, f64::min);
        println!("| | **luc over the best** | {build:.2} | {a:.2} | {b:.2} | {c:.2} | |");
    }
    Ok(())
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let quick = args.iter().any(|a| a == "--quick");
    let (counts, side) = if quick { (&[10_000][..], 128) } else { (&[10_000, 100_000, 1_000_000][..], 512) };
    // Trees are built on one thread too.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let result = match pool {
        _ if args.iter().any(|a| a != "--quick") => Err("peers takes --quick only".into()),
        Ok(pool) => pool.install(|| run(counts, side)),
        Err(e) => Err(e.to_string()),
    };
    if let Err(message) = result {
        eprintln!("peers: {message}");
        std::process::exit(2);
    }
}
