//! Runs the packed file and its unpacked twin alike, and compares what they do; and looks for what would
//! make frames differ between machines.

use crate::Error;
use crate::report::symbols;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// What both are asked; none of these opens a window.
const QUESTIONS: [&[&str]; 6] = [
    &["--version"],
    &["--help"],
    &["--no-such-argument"],
    &["--frame", "0", "--size", "32x18", "-o", "-"],
    &["--frame", "4000", "--size", "64x36", "--quality", "ultra", "-o", "-"],
    &["--frame", "7400", "--size", "320x180", "-o", "-"],
];

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

/// Functions of the platform's libm that are rounded as it likes. Those with one right answer, such as
/// `fmodf`, do no harm.
const LIBM: [&str; 27] = [
    "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "cbrt", "cos", "cosh", "exp", "exp10",
    "exp2", "expm1", "fma", "hypot", "lgamma", "log", "log10", "log1p", "log2", "pow", "sin", "sincos",
    "sinh", "tan", "tanh",
];

/// Which of libm's functions the linked program calls or contains, if any: frames must not depend on them.
pub fn libm(linked: &[u8]) -> Result<Option<String>, Error> {
    let mut found = symbols::names(linked)?;
    found.retain(|name| {
        LIBM.contains(&name.as_str()) || name.strip_suffix('f').is_some_and(|n| LIBM.contains(&n))
    });
    found.sort();
    found.dedup();
    Ok((!found.is_empty())
        .then(|| format!("calls of the platform's libm, which differs: {}", found.join(", "))))
}

fn run(program: &Path, arguments: &[&str]) -> Result<Output, Error> {
    Command::new(program).args(arguments).stdin(Stdio::null()).output().map_err(Error::file(program))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// This test program itself calls one, and is found out.
    #[test]
    fn a_call_of_libm_is_found() {
        #[allow(clippy::disallowed_methods, reason = "it is what is looked for")]
        let sine = std::hint::black_box(0.5_f64).sin();
        assert!(sine > 0.0);
        let own = std::fs::read(std::env::current_exe().unwrap()).unwrap();
        let found = libm(&own).unwrap().unwrap_or_default();
        assert!(found.ends_with("sin") || found.contains("sin,"), "{found}");
    }
}
