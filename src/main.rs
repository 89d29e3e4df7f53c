//! The player's program: hands its arguments on and exits with the code that comes back.
#![cfg_attr(luc_size, no_main)]

mod entry;
mod player;

#[cfg(not(luc_size))]
fn main() {
    std::process::exit(run())
}

/// The program, which both entries call (see [`entry`]); returns the exit code.
#[inline(never)]
fn run() -> i32 {
    let args: Vec<std::ffi::OsString> = std::env::args_os().skip(1).collect();
    let args: Vec<&std::ffi::OsStr> = args.iter().map(|a| a.as_os_str()).collect();
    player::run(&args)
}
