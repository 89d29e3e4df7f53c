//! Runs the packed file and its unpacked twin alike, and compares what they do.

use crate::Error;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// What both are asked; none of these opens a window.
const QUESTIONS: [&[&str]; 4] =
    [&["--version"], &["--help"], &["--frame", "0", "--size", "32x18", "-o", "-"], &["--no-such-argument"]];

/// The first difference between the two programs, if there is one.
pub fn compare(packed: &Path, safe: &Path) -> Result<Option<String>, Error> {
    for arguments in QUESTIONS {
        let (one, other) = (run(packed, arguments)?, run(safe, arguments)?);
        let question = arguments.join(" ");
        if one.status.code().is_none() {
            return Ok(Some(format!("the packed file ended by {} for {question}", one.status)));
        }
        if one != other {
            return Ok(Some(format!("the packed file does something else than luc-safe for {question}")));
        }
    }
    Ok(None)
}

fn run(program: &Path, arguments: &[&str]) -> Result<Output, Error> {
    Command::new(program).args(arguments).stdin(Stdio::null()).output().map_err(Error::file(program))
}
