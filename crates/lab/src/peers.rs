//! `lab peers`: our tree, fields and blur beside those of other crates, in a program of its own.
//!
//! Its dependencies are other people's work, which nothing else here has to compile, so it stands
//! outside the workspace and is built when it is asked for.

use std::path::Path;
use std::process::Command;

/// Runs the command with the arguments after `peers`.
pub fn run(args: &[String]) -> Result<(), String> {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("../peers/Cargo.toml");
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(["run", "--release", "--locked", "-q", "--manifest-path"]).arg(manifest);
    let done = command.arg("--").args(args).status().map_err(|e| format!("cargo can't be started: {e}"))?;
    if done.success() { Ok(()) } else { Err("the comparison ended with an error".into()) }
}
