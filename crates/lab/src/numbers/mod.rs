//! `lab numbers`: the error and the cost of each formula beside its textbook form.
//!
//! Draws hard cases, scores the textbook's form in f32 and in f64 and the engine's form against the
//! truth, times all three on packets, and writes `docs/numbers.md` and `docs/numbers.svg`.

mod cases;
mod naive;
mod plot;
mod real;
mod report;
mod truth;

use cases::{Kernel, Measure, U};
use luc_core::math::lanes::{F, splat};
use luc_core::math::lanes_f64::{D, splat_d};
use luc_core::math::random::Random;
use real::Arguments;
use std::hint::black_box;
use std::time::Instant;

/// Cases of each formula, unless told.
const CASES: u32 = 1_000_000;
/// Streams of random numbers that they are drawn from: what one of them misses may be in the next.
const STREAMS: usize = 8;
/// Arguments that a timing runs over, how often, and the passes of which the fastest counts.
const TIMED: u32 = 1024;
const ROUNDS: u32 = 8;
const PASSES: u32 = 12;

/// How one form of a formula did.
#[derive(Default)]
pub struct Column {
    /// Largest error, in the row's measure; infinite if a result that is a number came as none.
    pub worst: f64,
    /// What 99 of 100 errors are within.
    pub usual: f64,
    /// Hits that it has not, and hits that it has though there are none.
    pub lost: u32,
    pub invented: u32,
    /// Nanoseconds per ray or number, in packets.
    pub time: f64,
}

/// How a formula did.
pub struct Row {
    pub name: &'static str,
    /// `score`, `ulp` or `u`.
    pub measure: &'static str,
    pub cases: u32,
    /// Textbook in f32, the engine's, textbook in f64.
    pub columns: [Column; 3],
}

fn ulp(x: f64) -> f64 {
    let x = (x.abs() as f32).clamp(f32::MIN_POSITIVE, 1e38);
    f64::from(x.next_up()) - f64::from(x)
}

/// What an error of 1 is, at this result; infinite where the result hangs on rounding.
fn unit(kernel: &Kernel, x: &Arguments<f32>, exact: f64) -> f64 {
    match kernel.measure {
        Measure::Ulp => ulp(exact),
        Measure::Unit(unit) => (U * unit(x, exact)).max(0.5 * ulp(exact)),
        Measure::Score(reach) => {
            let length = x[3..6].iter().map(|&d| f64::from(d) * f64::from(d)).sum::<f64>().sqrt();
            let skin = U * (reach(x) + exact.abs() * length);
            let moved = |skin: f64| ((kernel.truth)(x, skin) - exact).abs();
            let near = moved(skin).max(moved(-skin)).max(0.25 * moved(4.0 * skin).max(moved(-4.0 * skin)));
            if near.is_nan() || moved(4.0 * skin).is_nan() || moved(-4.0 * skin).is_nan() {
                f64::INFINITY
            } else {
                near.max(0.5 * ulp(exact))
            }
        }
    }
}

/// Whether a hit or a miss is certain for a shape moved by four skins either way.
fn certain(kernel: &Kernel, x: &Arguments<f32>, hit: bool, nearest: f64) -> bool {
    let Measure::Score(reach) = kernel.measure else { return true };
    let length = x[3..6].iter().map(|&d| f64::from(d) * f64::from(d)).sum::<f64>().sqrt();
    let skin = 4.0 * U * (reach(x) + if nearest.is_finite() { nearest.abs() * length } else { 0.0 });
    let inner = (kernel.truth)(x, -skin);
    let outer = (kernel.truth)(x, skin);
    if hit { !inner.is_nan() && !outer.is_nan() } else { inner.is_nan() && outer.is_nan() }
}

fn measure(kernel: &'static Kernel, cases: u32) -> Row {
    let mut errors = [const { Vec::new() }; 3];
    let mut columns: [Column; 3] = Default::default();
    let mut streams: [Random; STREAMS] = std::array::from_fn(|i| Random::new(4000 + 100 * i as u32));
    for case in 0..cases {
        let x = (kernel.draw)(&mut streams[case as usize % STREAMS]);
        let exact = (kernel.truth)(&x, 0.0);
        if exact.is_infinite() {
            continue;
        }
        let got = [(kernel.naive)(&x), (kernel.ours)(&x), (kernel.wide)(&x.map(f64::from)) as f32];
        for ((got, column), errors) in got.into_iter().zip(&mut columns).zip(&mut errors) {
            match (exact.is_nan(), got.is_nan()) {
                (true, true) => {}
                (true, false) => column.invented += u32::from(certain(kernel, &x, false, got.into())),
                (false, true) => column.lost += u32::from(certain(kernel, &x, true, exact)),
                (false, false) => {
                    let error = (f64::from(got) - exact).abs();
                    let unit = if error == 0.0 { 1.0 } else { unit(kernel, &x, exact) };
                    errors.push(if error.is_infinite() { error } else { error / unit });
                }
            }
        }
    }
    for (column, errors) in columns.iter_mut().zip(&mut errors) {
        errors.sort_by(f64::total_cmp);
        column.worst = errors.last().copied().unwrap_or(0.0);
        column.usual = errors.get(errors.len() * 99 / 100).copied().unwrap_or(0.0);
    }
    let [naive, ours, wide] = time(kernel);
    (columns[0].time, columns[1].time, columns[2].time) = (naive, ours, wide);
    let measure = match kernel.measure {
        Measure::Score(_) => "score",
        Measure::Ulp => "ulp",
        Measure::Unit(_) => "u",
    };
    Row { name: kernel.name, measure, cases, columns }
}

/// Fastest pass of a form over its packets, in nanoseconds per lane.
fn fastest<A, R>(packets: &[A], lanes: u32, form: fn(&A) -> R) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..PASSES {
        let begin = Instant::now();
        for _ in 0..ROUNDS {
            for packet in packets {
                black_box(form(black_box(packet)));
            }
        }
        best = best.min(begin.elapsed().as_secs_f64());
    }
    best * 1e9 / f64::from(ROUNDS * lanes) / packets.len() as f64
}

/// Nanoseconds per ray or number. All lanes hold the same one, so that none is spared by another.
fn time(kernel: &Kernel) -> [f64; 3] {
    let mut random = Random::new(4001);
    let drawn: Vec<Arguments<f32>> = (0..TIMED).map(|_| (kernel.draw)(&mut random)).collect();
    let narrow: Vec<Arguments<F>> = drawn.iter().map(|x| x.map(splat)).collect();
    let wide: Vec<Arguments<D>> = drawn.iter().map(|x| x.map(|x| splat_d(x.into()))).collect();
    [
        fastest(&narrow, 8, kernel.naive_packet),
        fastest(&narrow, 8, kernel.ours_packet),
        fastest(&wide, 4, kernel.wide_packet),
    ]
}

/// Names of the files of [`write_study`].
pub const TABLE: &str = "numbers.csv";
pub const PLOT: &str = "numbers.svg";

/// Measures all formulas on so many cases, for a page of another study: a table and the plot in its folder.
pub fn write_study(cases: u32, folder: &std::path::Path) -> Result<(), String> {
    let rows: Vec<Row> = cases::all().map(|kernel| measure(kernel, cases)).collect();
    for (name, text) in [(TABLE, report::csv(&rows)), (PLOT, plot::picture(&rows))] {
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))?;
    }
    Ok(())
}

/// Runs the command with the arguments after `numbers`: how many cases, and where to write.
pub fn run(args: &[String]) -> Result<(), String> {
    let cases = args.first().map_or(Ok(CASES), |n| n.parse()).map_err(|_| "CASES must be a whole number")?;
    let folder = args.get(1).map_or(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs"), String::as_str);
    let rows: Vec<Row> = cases::all()
        .map(|kernel| {
            let row = measure(kernel, cases);
            println!("{}", report::line(&row));
            row
        })
        .collect();
    for (name, text) in [("numbers.md", report::page(&rows)), ("numbers.svg", plot::picture(&rows))] {
        let path = format!("{folder}/{name}");
        std::fs::write(&path, text).map_err(|e| format!("{path}: {e}"))?;
    }
    Ok(())
}
