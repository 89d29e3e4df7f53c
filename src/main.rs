//! The player's program: hands its arguments on and exits with the code that comes back.
mod player;

/// Nothing may be built here but the check: the compiler is free to use AVX2 anywhere else.
fn main() {
    if player::cpu::suffices() {
        start()
    }
    std::process::exit(player::cpu::refuse())
}

#[inline(never)]
fn start() -> ! {
    let args: Vec<std::ffi::OsString> = std::env::args_os().skip(1).collect();
    let args: Vec<&std::ffi::OsStr> = args.iter().map(|a| a.as_os_str()).collect();
    std::process::exit(player::run(&args))
}
