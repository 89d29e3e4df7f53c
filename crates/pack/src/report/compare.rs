//! How much smaller than by general compressors programs become: the table in the README.
//!
//! All get the same bytes, the stripped program, and only what they code it to counts, without
//! launchers and headers. `xz` may use its filter for x86, our own methods use ours.

use super::grouped;
use crate::{Error, Method, elf, pack_elf};
use std::fmt::Write;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// The other compressors: name, command and arguments.
const OTHERS: [(&str, &str, &[&str]); 3] = [
    ("gzip", "gzip", &["-9nc"]),
    ("zstd 22", "zstd", &["--ultra", "-22", "--no-check", "-qc"]),
    ("xz with its filter", "xz", &["--format=raw", "--x86", "--lzma2=preset=9e,lc=3,lp=0,pb=0", "-qc"]),
];

/// Packs the programs by all means there are; the table in Markdown.
pub fn compare(files: &[PathBuf]) -> Result<String, Error> {
    let mut table = String::from("| program | bytes |");
    for (name, ..) in OTHERS {
        let _ = write!(table, " {name} |");
    }
    table.push_str(" LZMA | context mixing | less than LZMA |\n|---|");
    table.push_str(&"---:|".repeat(OTHERS.len() + 4));
    for path in files {
        let file = std::fs::read(path).map_err(Error::file(path))?;
        let stripped = elf::Program::new(&file)?.stripped;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let _ = write!(table, "\n| {name} | {} |", grouped(stripped.len() as i64));
        for (_, command, arguments) in OTHERS {
            match through(command, arguments, &stripped) {
                Some(length) => {
                    let _ = write!(table, " {} |", grouped(length as i64));
                }
                None => table.push_str(" – |"),
            }
        }
        let (lzma, cm) = (pack_elf(&file, Method::Lzma)?.payload, pack_elf(&file, Method::Cm)?.payload);
        let less = 100.0 * (1.0 - cm as f64 / lzma as f64);
        let _ = write!(table, " {} | {} | {less:.1} % |", grouped(lzma as i64), grouped(cm as i64));
    }
    Ok(table)
}

/// The length of what a command makes of `bytes`; none if it isn't installed or fails.
fn through(command: &str, arguments: &[&str], bytes: &[u8]) -> Option<usize> {
    let mut child = Command::new(command)
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .ok()?;
    let mut input = child.stdin.take()?;
    // Beside the reading, so that neither waits for the other.
    let output = std::thread::scope(|scope| {
        scope.spawn(move || input.write_all(bytes));
        child.wait_with_output()
    });
    output.ok().filter(|output| output.status.success()).map(|output| output.stdout.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_succeeds_counts() {
        assert_eq!(through("cat", &[], &[0; 100_000]), Some(100_000));
        assert_eq!(through("false", &[], b"input"), None);
        assert_eq!(through("no-such-command", &[], b"input"), None);
    }
}
