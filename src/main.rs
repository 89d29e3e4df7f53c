//! The player's program: hands its arguments on and exits with the code that comes back.
#![cfg_attr(luc_size, no_main)]

mod entry;
mod player;

#[cfg(not(luc_size))]
fn main() {
    let args: Vec<_> = std::env::args_os().skip(1).collect();
    let args: Vec<_> = args.iter().map(|a| a.as_os_str()).collect();
    std::process::exit(player::run(&args))
}
