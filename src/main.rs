//! The player's program: hands its arguments on and exits with the code that comes back.
mod player;

fn main() {
    let args: Vec<std::ffi::OsString> = std::env::args_os().skip(1).collect();
    let args: Vec<&std::ffi::OsStr> = args.iter().map(|a| a.as_os_str()).collect();
    std::process::exit(player::run(&args));
}
