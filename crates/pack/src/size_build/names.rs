//! Names of crates that are the same in any folder, and with them the bytes of the file.
//!
//! Cargo tells the compiler a number for each crate (`-C metadata`), which goes into the names of all symbols. For
//! the standard library's crates it is made from the folder they lie in, and for other crates from the numbers of
//! those they depend on. The order in which functions are optimised and laid out follows the names, so that the
//! intro was some twenty bytes longer or shorter elsewhere.
//!
//! So the compiler that cargo calls is this program, which replaces the number by what tells a crate from others in
//! one build: package, version, features and kind. (Two crates with the same number would be the compiler's error.)

use crate::Error;
use luc_core::math::fingerprint::Fingerprint;
use std::ffi::OsString;
use std::process::Command;

/// If this variable of the environment is the first argument, this program has been called as that compiler.
pub const VARIABLE: &str = "LUC_PACK_COMPILES";

/// How cargo gives the number, as an argument behind `-C`.
const METADATA: &str = "metadata=";

/// Compiles as cargo asks: the compiler is the first argument; its exit code.
pub fn compile(arguments: &[OsString]) -> Result<i32, Error> {
    let [compiler, arguments @ ..] = arguments else { return Ok(1) };
    let told = |name: &str| std::env::var(name).unwrap_or_default();
    let package = told("CARGO_PKG_NAME") + " " + &told("CARGO_PKG_VERSION");
    let status = Command::new(compiler).args(renamed(arguments, &package)).status();
    Ok(status.map_err(Error::file(compiler))?.code().unwrap_or(1))
}

/// The arguments with another number, if they have one.
fn renamed(arguments: &[OsString], package: &str) -> Vec<OsString> {
    let mut identity = package.to_owned();
    for pair in arguments.windows(2) {
        if let (Some(option @ ("--crate-name" | "--crate-type" | "--cfg")), Some(value)) =
            (pair[0].to_str(), pair[1].to_str())
        {
            identity.push_str(&format!("\n{option} {value}"));
        }
    }
    let number = format!("{METADATA}{:016x}", Fingerprint::of(identity.bytes()));
    let is_number = |argument: &OsString| argument.to_str().is_some_and(|text| text.starts_with(METADATA));
    let replaced =
        |argument: &OsString| if is_number(argument) { number.clone().into() } else { argument.clone() };
    arguments.iter().map(replaced).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(package: &str, line: &str) -> String {
        let arguments: Vec<OsString> = line.split(' ').map(OsString::from).collect();
        let renamed = renamed(&arguments, package);
        // Nothing but the number is another.
        assert_eq!(renamed.len(), arguments.len());
        let changed = (0..renamed.len()).filter(|&i| renamed[i] != arguments[i]).collect::<Vec<_>>();
        let [at] = changed[..] else { panic!("{renamed:?}") };
        assert_eq!(arguments[at - 1], "-C");
        renamed[at].to_str().unwrap().to_owned()
    }

    #[test]
    fn crates_have_one_number_in_all_folders() {
        let one = number("core 0.0.0", "--crate-name core --cfg feature=\"a\" /one/lib.rs -C metadata=1234");
        let other =
            number("core 0.0.0", "--crate-name core --cfg feature=\"a\" /two/lib.rs -C metadata=5678");
        assert_eq!(one, other);
    }

    #[test]
    fn crates_of_one_build_have_different_numbers() {
        let mut numbers = vec![
            number("libc 0.2.1", "--crate-name libc --crate-type lib -C metadata=1"),
            number("libc 0.2.2", "--crate-name libc --crate-type lib -C metadata=1"),
            number("libc 0.2.1", "--crate-name libc --crate-type lib --cfg feature=\"std\" -C metadata=1"),
            number("libc 0.2.1", "--crate-name libc --crate-type bin -C metadata=1"),
            number("libc 0.2.1", "--crate-name build_script_build --crate-type bin -C metadata=1"),
        ];
        numbers.sort();
        numbers.dedup();
        assert_eq!(numbers.len(), 5);
    }

    #[test]
    fn questions_to_the_compiler_stay_as_they_are() {
        let arguments = ["-vV".into(), "--print=metadata=".into()];
        assert_eq!(renamed(&arguments, ""), arguments);
    }
}
