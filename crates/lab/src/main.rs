//! The lab: what a frame did, and how far adaptive sampling is from tracing every pixel.
//!
//! `cargo lab stats [FRAME] [QUALITY] [WxH]` prints the counters of one frame, its time, and the
//! peak signal-to-noise ratio of its display values against the same quality with every pixel
//! traced. `cargo lab lights` compares culled with naive small lights. `cargo lab values` holds frames
//! against the table of their values, `cargo lab numbers [CASES]` formulas against the truth.

mod lights;
mod numbers;
mod stats;
mod swarm;
mod values;

use std::process::exit;

const USAGE: &str = "usage: cargo lab stats [FRAME] [QUALITY] [WxH], cargo lab lights, cargo lab values [TABLE], \
    or cargo lab numbers [CASES]";

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let result = match args.first().map(String::as_str) {
        Some("stats") => stats::run(&args[1..]),
        Some("lights") => lights::run(),
        Some("numbers") => numbers::run(&args[1..]),
        Some("values") => values::run(&args[1..]),
        _ => Err(USAGE.into()),
    };
    if let Err(message) = result {
        eprintln!("lab: {message}");
        exit(2);
    }
}
