//! Everything around the show that a person meets: command line, window, clock, picture files.
//!
//! `run` is the program: it takes the arguments without the program's name and returns the exit code,
//! so that an entry point other than Rust's own can call it. Whatever goes wrong becomes one line on
//! standard error and code 2. Text is put together from pieces instead of being formatted, because the
//! formatting machinery alone would cost the packed file several kilobytes.

#[cfg(all(feature = "sound", target_os = "linux"))]
mod alsa;
mod args;
mod clock;
mod file;
mod fit;
#[cfg(target_os = "linux")]
mod library;
mod live;
mod loader;
mod pace;
mod snapshot;
#[cfg(all(feature = "sound", target_os = "linux"))]
mod sound;
mod stage;
mod system;
mod text;
mod time;
#[cfg(feature = "sound")]
mod wav;
mod window;
mod x11;

use args::{Options, Request};
use file::Target;
use std::ffi::OsStr;
use text::Text;

/// Exit code of everything that could not be done as asked.
const REFUSED: i32 = 2;

/// Does what the arguments ask and returns the exit code.
pub fn run(args: &[&OsStr]) -> i32 {
    let done = match args::parse(args) {
        Ok(Request::Help) => file::print(&args::help()),
        Ok(Request::Version) => file::print(concat!("luc ", env!("CARGO_PKG_VERSION"), "\n").as_bytes()),
        Ok(Request::Run(options)) => pool(&options).and_then(|()| perform(&options)),
        Err(sentence) => Err(sentence),
    };
    match done {
        Ok(()) => 0,
        Err(sentence) => {
            complain(&sentence);
            REFUSED
        }
    }
}

/// Plays, or writes a picture or the sound.
fn perform(options: &Options) -> Result<(), Text> {
    if options.frame.is_none() && options.wav.is_none() {
        return window::play(options);
    }
    let name = snapshot::name(options);
    let target = Target::find(options.wav.or(options.output).unwrap_or(text::ascii(&name)))?;
    #[cfg(feature = "sound")]
    if options.wav.is_some() {
        return target.write(&wav::bytes(options));
    }
    target.write(&snapshot::bytes(options)?)
}

/// One line on standard error, in one write so that lines of several programs do not mix.
fn complain(sentence: &[u8]) {
    let line = text::join(&[b"luc: ", sentence, b"\n"]);
    // There is nobody left to tell when standard error is closed.
    let _ = system::write_standard(2, &line);
}

/// Starts the threads that render. Left to itself, rayon would start them on first use and panic when
/// the system refuses.
fn pool(options: &Options) -> Result<(), Text> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build_global()
        .map_err(|_| text::join(&[b"the system refused to start so many threads; try --threads 1"]))
}
