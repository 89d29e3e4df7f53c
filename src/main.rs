//! The player.
#![cfg_attr(luc_size, no_main)]

mod entry;

#[cfg(not(luc_size))]
fn main() {
    std::process::exit(run())
}

/// The program, which both entries call (see [`entry`]); returns the exit code.
#[inline(never)]
fn run() -> i32 {
    let mut renderer = luc_core::render::Renderer::default();
    let mut pixels = vec![0; 1280 * 720];
    luc::show::frame(&mut renderer, 0, (1280, 720), &luc_core::quality::Quality::PRESETS[3].1, &mut pixels);
    0
}
