//! Finds a compiler that comes with the source of its own standard library.
//!
//! The size build compiles the standard library with the program, and its source must be that of
//! exactly the compiler in use. Two places can have it: the active rustup toolchain with the
//! component `rust-src`, and Debian's packages.

use crate::Error;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A compiler and its cargo.
#[derive(Debug)]
pub struct Toolchain {
    /// The compiler.
    pub rustc: PathBuf,
    /// The cargo beside it.
    pub cargo: PathBuf,
    /// The standard library's source.
    pub library: PathBuf,
}

/// The oldest release that knows all that the size build asks for: 1.OLDEST.
const OLDEST: u32 = 95;

impl Toolchain {
    /// The first that serves; `root` is where rustup is asked which toolchain is active.
    pub fn find(root: &Path) -> Result<Toolchain, Error> {
        let candidates = [PathBuf::from("rustc"), PathBuf::from("/usr/bin/rustc")];
        candidates.iter().find_map(|rustc| Toolchain::with_source(rustc, root)).ok_or(Error::NoToolchain)
    }

    /// The toolchain that `rustc` belongs to, if it is new enough and its source is there.
    fn with_source(rustc: &Path, root: &Path) -> Option<Toolchain> {
        let ask = |arguments: &[&str]| {
            let output = Command::new(rustc)
                .args(arguments)
                .env_remove("LD_LIBRARY_PATH")
                .current_dir(root)
                .output()
                .ok()?;
            String::from_utf8(output.stdout).ok().filter(|_| output.status.success())
        };
        let sysroot = PathBuf::from(ask(&["--print", "sysroot"])?.trim());
        let version = ask(&["-vV"])?;
        let release = version.lines().find_map(|line| line.strip_prefix("release: "))?;
        let source = sysroot.join("lib/rustlib/src/rust");
        let complete = source.join("library/std/Cargo.toml").is_file();
        // Rustup's source has no version of its own, and needs none.
        let version = std::fs::read_to_string(source.join("src/version"));
        let matches = version.map_or(true, |version| release.starts_with(version.trim()));
        let (rustc, cargo) = (sysroot.join("bin/rustc"), sysroot.join("bin/cargo"));
        let usable = complete && matches && minor(release)? >= OLDEST && rustc.is_file() && cargo.is_file();
        usable.then_some(Toolchain { rustc, cargo, library: source.join("library") })
    }

    /// A cargo command of this toolchain, with the environment of any other taken out.
    pub fn cargo(&self) -> Command {
        let mut command = Command::new(&self.cargo);
        command.env("RUSTC", &self.rustc);
        for variable in FOREIGN {
            command.env_remove(variable);
        }
        command
    }
}

/// What rustup, or the cargo that runs this tool, leaves in the environment, and what would
/// change the build without being seen.
const FOREIGN: [&str; 8] = [
    "LD_LIBRARY_PATH",
    "RUSTUP_TOOLCHAIN",
    "RUSTFLAGS",
    "CARGO",
    "CARGO_BUILD_RUSTFLAGS",
    "CARGO_BUILD_TARGET",
    "CARGO_TARGET_DIR",
    "RUSTC_WORKSPACE_WRAPPER",
];

/// The second number of a release, such as 95 of 1.95.0.
fn minor(release: &str) -> Option<u32> {
    release.strip_prefix("1.")?.split('.').next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    #[test]
    fn reads_releases() {
        assert_eq!(super::minor("1.95.0"), Some(95));
        assert_eq!(super::minor("1.97.0-nightly"), Some(97));
        assert_eq!(super::minor("2.0"), None);
    }
}
