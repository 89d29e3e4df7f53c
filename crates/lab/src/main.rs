//! The lab: what a frame did, and how far adaptive sampling is from tracing every pixel.
//!
//! `cargo lab stats [FRAME] [QUALITY] [WxH]` prints the counters of one frame, its time, and the
//! peak signal-to-noise ratio of its display values against the same quality with every pixel
//! traced. `cargo lab lights` compares culled with naive small lights. `cargo lab smoke`
//! tells what smoke costs.

mod lights;
mod smoke;
mod stats;
mod swarm;

use std::process::exit;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let result = match args.first().map(String::as_str) {
        Some("stats") => stats::run(&args[1..]),
        Some("lights") => lights::run(),
        Some("smoke") => smoke::run(),
        _ => {
            Err("usage: cargo lab stats [FRAME] [QUALITY] [WxH], or cargo lab lights, or cargo lab smoke"
                .into())
        }
    };
    if let Err(message) = result {
        eprintln!("lab: {message}");
        exit(2);
    }
}
