//! Our engine beside other crates: on the same input, one thread, in turns, after the results were compared.
//!
//! Three comparisons, each of which prints a table in Markdown: the tree over triangles, the march through a
//! distance field, and the blur of bloom.
#![allow(clippy::disallowed_methods, reason = "input and figures, never pixels of the show")]

mod blur;
mod embree;
mod fields;
mod frames;
mod ours;
mod peers;
mod rays;
#[cfg(feature = "tinybvh")]
mod tinybvh;
mod triangles;
mod turns;

// Of the lab and the engine, as they stand there.
#[path = "../../lab/src/figures.rs"]
#[allow(dead_code, reason = "of which only the clock and the median are needed")]
mod figures;
#[path = "../../lab/src/mesh/knot.rs"]
mod knot;
#[path = "../../core/src/post/picture.rs"]
#[allow(dead_code, reason = "of which only the blur is asked for")]
mod picture;
// Which that calls so.
use luc_core::{math, parallel};

fn run(quick: bool) -> Result<(), String> {
    triangles::run(quick)?;
    println!();
    fields::run(quick)?;
    println!();
    blur::run(quick);
    Ok(())
}

fn main() {
    // A reader that has seen enough, such as `head`, ends this as it ends other tools.
    // SAFETY: no other thread runs yet, and no handler is replaced.
    unsafe { libc::signal(libc::SIGPIPE, libc::SIG_DFL) };
    let args: Vec<String> = std::env::args().skip(1).collect();
    let quick = args.iter().any(|a| a == "--quick");
    // Trees are built on one thread too.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let result = match pool {
        _ if args.iter().any(|a| a != "--quick") => Err("peers takes --quick only".into()),
        Ok(pool) => pool.install(|| run(quick)),
        Err(e) => Err(e.to_string()),
    };
    if let Err(message) = result {
        eprintln!("peers: {message}");
        std::process::exit(2);
    }
}
