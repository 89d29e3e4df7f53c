//! `lab memory`: how much memory a player holds at most while it plays each part.
//!
//! The program, the player or the packed file, plays on the display that there is; the system is asked for
//! the greatest resident size of it and of what it starts, since a packed file starts what it unpacks.

use std::fs::read_to_string;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

/// Between two looks.
const PACE: Duration = Duration::from_millis(200);

/// Greatest resident size of a process and its children so far, MiB.
fn peak(id: u32) -> f64 {
    let status = read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap_or_default();
    let own = line.split_whitespace().next().and_then(|kb| kb.parse::<f64>().ok()).unwrap_or(0.0) / 1024.0;
    let children = read_to_string(format!("/proc/{id}/task/{id}/children")).unwrap_or_default();
    children.split_whitespace().filter_map(|id| id.parse().ok()).map(peak).fold(own, f64::max)
}

/// Plays a part once and tells the peaks, MiB: of all, and of the program that plays last. The system counts anew
/// when a packed file becomes what it unpacked.
fn play(program: &Path, part: &str, size: &str) -> Result<(f64, f64), String> {
    let fault = |e: std::io::Error| format!("{}: {e}", program.display());
    let mut command = Command::new(program);
    command.args(["--scene", part, "--once", "--mute", "--quality", "high", "--size", size]);
    let mut child = command.stderr(Stdio::piped()).spawn().map_err(fault)?;
    let (mut most, mut last) = (0.0_f64, 0.0);
    loop {
        let now = peak(child.id());
        // A process that has ended holds nothing.
        if now > 0.0 {
            (most, last) = (most.max(now), now);
        }
        if child.try_wait().map_err(fault)?.is_some() {
            break;
        }
        sleep(PACE);
    }
    let done = child.wait_with_output().map_err(fault)?;
    match done.status.success() {
        true => Ok((most, last)),
        false => Err(String::from_utf8_lossy(&done.stderr).into_owned()),
    }
}

/// Runs the command with the arguments after `memory`: a program and a size.
pub fn run(args: &[String]) -> Result<(), String> {
    let program = args.first().ok_or("which program? such as target/pack/luc or target/release/luc")?;
    let size = args.get(1).map_or("1920x1080", String::as_str);
    crate::args::size(size)?;
    println!("| part | most MiB resident at {size} | of which playing |\n|---|---:|---:|");
    for part in luc::show::PARTS {
        match play(Path::new(program), part.name, size) {
            Ok((most, playing)) => println!("| {} | {most:.0} | {playing:.0} |", part.name),
            // The packed file has not all parts.
            Err(said) if said.contains("--scene wants one of") => {}
            Err(said) => return Err(said),
        }
    }
    Ok(())
}
