//! How much smaller than by general compressors programs become: the table in the README.
//!
//! All get the same bytes, the stripped program, and only what they code it to counts, without
//! launchers and headers. `xz` may use its filter for x86, our own methods use ours.

use super::grouped;
use crate::{Error, Method, elf, pack_elf};
use std::fmt::Write;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The other compressors: name, command and arguments.
const OTHERS: [(&str, &str, &[&str]); 5] = [
    ("gzip", "gzip", &["-9nc"]),
    ("zstd 22", "zstd", &["--ultra", "-22", "--no-check", "-qc"]),
    ("brotli 11", "brotli", &["--quality=11", "--lgwin=24", "-c"]),
    ("upkr 6", "upkr", &["-6"]),
    ("xz with its filter", "xz", &["--format=raw", "--x86", "--lzma2=preset=9e,lc=3,lp=0,pb=0", "-qc"]),
];

/// A program to be compared: its name, its file, and what is packed of it.
type Program = (String, Vec<u8>, Vec<u8>);

fn read(path: &Path) -> Result<Program, Error> {
    let file = std::fs::read(path).map_err(Error::file(path))?;
    let stripped = elf::Program::new(&file)?.stripped;
    Ok((path.file_name().unwrap_or_default().to_string_lossy().into_owned(), file, stripped))
}

/// Packs the programs by all means there are, and hands on the table in Markdown, a line as soon as it is known.
/// An error is that of the file beside it.
pub fn compare(files: &[PathBuf], mut tell: impl FnMut(&str)) -> Result<(), (PathBuf, Error)> {
    let read = |path: &PathBuf| read(path).map_err(|error| (path.clone(), error));
    let programs = files.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    let mut head = String::from("| program | bytes |");
    for (name, ..) in OTHERS {
        let _ = write!(head, " {name} |");
    }
    tell(&(head + " LZMA | context mixing | less than LZMA |"));
    tell(&format!("|---|{}", "---:|".repeat(OTHERS.len() + 4)));
    for ((name, file, stripped), path) in programs.iter().zip(files) {
        let mut line = format!("| {name} | {} |", grouped(stripped.len() as i64));
        for (_, command, arguments) in OTHERS {
            match through(command, arguments, stripped) {
                Some(length) => {
                    let _ = write!(line, " {} |", grouped(length as i64));
                }
                None => line.push_str(" – |"),
            }
        }
        let payload = |method| match pack_elf(file, method) {
            Ok(packed) => Ok(packed.payload),
            Err(error) => Err((path.clone(), error)),
        };
        let (lzma, cm) = (payload(Method::Lzma)?, payload(Method::Cm)?);
        let less = 100.0 * (1.0 - cm as f64 / lzma as f64);
        let _ = write!(line, " {} | {} | {less:.1} % |", grouped(lzma as i64), grouped(cm as i64));
        tell(&line);
    }
    Ok(())
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
