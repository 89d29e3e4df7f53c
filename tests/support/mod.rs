//! What the suites share: the program under test and its output, pictures, reference frames.
#![allow(dead_code, reason = "each suite uses a part of it")]

pub mod crossing;
pub mod golden;
pub mod picture;
pub mod sound;
#[cfg(target_os = "linux")]
pub mod x11;

use luc::show;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The program under test: `LUC_BIN`, or the one cargo built.
pub fn luc() -> PathBuf {
    let path = std::env::var_os("LUC_BIN").map_or(PathBuf::from(env!("CARGO_BIN_EXE_luc")), PathBuf::from);
    path.canonicalize().unwrap_or_else(|e| panic!("LUC_BIN: {}: {e}", path.display()))
}

/// Runs the program in `dir` with a display that does not exist, so that a window would be noticed.
pub fn run(dir: &Path, args: &[&str]) -> Output {
    command(dir).args(args).output().expect("the program starts")
}

/// The program in `dir`, not started yet.
pub fn command(dir: &Path) -> Command {
    let mut command = Command::new(luc());
    command.current_dir(dir).env("DISPLAY", ":9999");
    command
}

/// Names in `dir`, sorted.
pub fn names(dir: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(dir).unwrap();
    let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Frame `n` of the show, rendered in this process.
pub fn frame(n: u64, size: (u32, u32), quality: &str) -> Vec<u32> {
    let (part, local) = show::at(n);
    frame_of(part, local, size, quality)
}

/// A frame of the part with this index, rendered in this process.
pub fn frame_of(part: usize, local: u64, size: (u32, u32), quality: &str) -> Vec<u32> {
    let (_, quality) = Quality::PRESETS.iter().find(|(name, _)| *name == quality).expect("a preset's name");
    let mut pixels = vec![0; (size.0 * size.1) as usize];
    show::frame(&mut Renderer::default(), show::start(part) + local, size, quality, &mut pixels);
    pixels
}

/// Fails with what to install unless all of `tools` are found.
pub fn require(tools: &[&str]) {
    let path = std::env::var_os("PATH").unwrap_or_default();
    for tool in tools {
        assert!(
            std::env::split_paths(&path).any(|dir| dir.join(tool).is_file()),
            "this test needs {tool}: sudo apt-get install xvfb xdotool x11-apps qemu-user"
        );
    }
}
