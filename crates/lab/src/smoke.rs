//! What smoke costs: its motion, and what it adds to a frame.

use luc::show;
use luc_core::counters::{Counter, Counters};
use luc_core::math::Vec3;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::{Air, Edit, Rules, Scene, Smoke, Voxels};
use luc_core::sim::{Room, Simulation, Volume};
use std::time::Instant;

/// Frames of the part that are measured.
const FRAMES: std::ops::Range<u64> = 680..740;

/// Size of the pictures.
const SIZE: (u32, u32) = (1280, 720);

/// Cells of the grid by which steps are compared.
const CELLS: [usize; 3] = [64, 96, 64];

/// A fire under a plate.
fn fire(_: u32, figure: &mut Voxels) {
    figure.reset(Vec3::ZERO, 0.1, [32, 48, 32]);
    figure.edit(Edit::Overwrite(Voxels::SMOKE), [12, 1, 12], [20, 4, 20]);
    figure.edit(Edit::Overwrite(1), [10, 16, 10], [20, 18, 20]);
}

/// Milliseconds that a piece of work takes.
fn timed(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64() * 1e3
}

/// The median of some times, and the least.
fn middle(mut times: Vec<f64>) -> String {
    times.sort_by(f64::total_cmp);
    format!("{:6.2} ms (least {:.2})", times[times.len() / 2], times[0])
}

/// Measures and prints.
pub fn run(_: &[String]) -> Result<(), String> {
    let mut counters = Counters::default();
    static RULES: Rules = Rules {
        cell: 0.05,
        size: CELLS,
        air: Air { lift: 4.0, ..Air::DEFAULT }.motion(0.05),
        ..Rules::new(fire)
    };
    let whole = Smoke { rules: &RULES, steps: 0, behind: 0.0 };
    let mut simulation = Simulation::default();
    simulation.run(&Smoke { steps: 60, ..whole }, &mut counters);
    let steps = (61..121).map(|steps| timed(|| simulation.run(&Smoke { steps, ..whole }, &mut counters)));
    println!("a step of {CELLS:?} cells   {}", middle(steps.collect()));

    let part = show::PARTS.iter().find(|part| part.name == "smoke").ok_or("the show has no smoke")?;
    for (name, quality) in &Quality::PRESETS[2..4] {
        let (mut simulation, mut shown) = (Simulation::default(), Room::default());
        let (mut renderer, mut bare) = (Renderer::default(), Renderer::default());
        let mut pixels = vec![0; (SIZE.0 * SIZE.1) as usize];
        let (mut moving, mut showing, mut all, mut without) = (vec![], vec![], vec![], vec![]);
        for n in FRAMES.start - 1..FRAMES.end {
            let scene = (part.scene)(n);
            let smoke = scene.smoke.as_ref().ok_or("the part has no smoke")?;
            moving.push(timed(|| simulation.run(smoke, &mut counters)));
            showing.push(timed(|| _ = Volume::new(smoke, &simulation, &mut shown, &mut counters)));
            all.push(timed(|| renderer.frame(&scene, n, SIZE, quality, &mut pixels)));
            let clear = Scene { smoke: None, ..scene.clone() };
            without.push(timed(|| bare.frame(&clear, n, SIZE, quality, &mut pixels)));
        }
        // The first has come from the start.
        let rest = |times: Vec<f64>| middle(times[1..].to_vec());
        let steps = moving[1..].iter().copied().filter(|&time| time > 0.1).collect();
        println!("{name}, {}x{}, frames {FRAMES:?} of the part", SIZE.0, SIZE.1);
        println!("  a step, every other frame {}", middle(steps));
        println!("  made ready, every frame   {}", rest(showing));
        println!("  the whole frame           {}", rest(all));
        println!("  the same without smoke    {}", rest(without));
        let count = |counter: Counter| renderer.counters.get(counter);
        println!("  places marched through    {}", count(Counter::SmokeMarched));
        println!("  cells and bricks walked   {}", count(Counter::VoxelSteps));
    }
    Ok(())
}
