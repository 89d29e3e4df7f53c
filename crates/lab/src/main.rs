//! The lab: what a frame did, and how far adaptive sampling is from tracing every pixel.
//!
//! `cargo lab stats [FRAME] [QUALITY] [WxH]` prints the counters of one frame, its time, and the
//! peak signal-to-noise ratio of its display values against the same quality with every pixel
//! traced. `cargo lab lights` compares culled with naive small lights. `cargo lab values` holds frames
//! against the table of their values.

mod lights;
mod stats;
mod swarm;
mod values;

use std::process::exit;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let result = match args.first().map(String::as_str) {
        Some("stats") => stats::run(&args[1..]),
        Some("lights") => lights::run(),
        Some("values") => values::run(&args[1..]),
        _ => Err(
            "usage: cargo lab stats [FRAME] [QUALITY] [WxH], cargo lab lights, or cargo lab values [TABLE]"
                .into(),
        ),
    };
    if let Err(message) = result {
        eprintln!("lab: {message}");
        exit(2);
    }
}
