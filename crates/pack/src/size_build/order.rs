//! The order of functions and constants in the file: like beside like.
//!
//! The packer learns while it goes through the file, and what it saw last counts most. So functions follow
//! each other by what they have in common: always the one is next that shares most with the last few, which
//! count by their nearness. Against the compiler's order it saves 460 bytes; a random order costs 1,300.
//!
//! To have in common is to have the same sequences of a few bytes. One that is found in many functions says
//! less, and long functions share more by chance, so each sequence counts `1 / sqrt(functions that have it)`,
//! and the sum is divided by the root of the mean length, geometrically.
//!
//! The order is set when the program is linked. The linker that cargo calls is this program: it reads the
//! object files, writes a linker script with their sections in order, and calls the C compiler to link.

use crate::Error;
use crate::sections::{SHF_ALLOC, SHT_NOBITS, sections};
use std::collections::HashMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;

/// If this variable of the environment is set, this program has been called as a linker.
pub const VARIABLE: &str = "LUC_PACK_LINKS";

/// What only the intro is linked with: see the project's build.rs.
const INTRO: &str = "-nostartfiles";

/// Lengths of the sequences that are compared, bytes.
const SEQUENCES: [usize; 3] = [2, 3, 4];
/// What many functions have says nothing.
const COMMON: usize = 400;
/// How many of the last functions are looked at, and how much less the one before counts.
const REACH: usize = 8;
const FADING: f64 = 0.8;

const SHF_WRITE: u64 = 1;
const SHF_EXECINSTR: u64 = 4;
const SHF_MERGE: u64 = 16;

/// A section: a function, or a constant.
struct Piece {
    name: String,
    bytes: Vec<u8>,
}

/// Links as the C compiler does with these arguments, the intro with its functions and constants in order;
/// the compiler's exit code.
pub fn link(arguments: &[OsString]) -> Result<i32, Error> {
    let mut command = Command::new("cc");
    // Build scripts come here too: they have the same target.
    if !arguments.iter().any(|argument| argument == INTRO) {
        return run(command.args(arguments));
    }
    let mut code = Vec::new();
    let mut constants = Vec::new();
    for path in arguments.iter().map(Path::new).filter(|path| path.extension().is_some_and(|e| e == "o")) {
        let file = std::fs::read(path).map_err(Error::file(path))?;
        for section in sections(&file)? {
            let pieces = match section.flags & (SHF_ALLOC | SHF_WRITE | SHF_EXECINSTR | SHF_MERGE) {
                flags if flags == SHF_ALLOC | SHF_EXECINSTR => &mut code,
                SHF_ALLOC if section.name.starts_with(".rodata.") => &mut constants,
                _ => continue,
            };
            if section.kind != SHT_NOBITS && section.length > 0 {
                let bytes = file[section.offset..section.offset + section.length].to_vec();
                pieces.push(Piece { name: section.name, bytes });
            }
        }
    }
    let output = arguments.iter().skip_while(|argument| *argument != "-o").nth(1);
    let script = PathBuf::from(output.map_or("a.out".into(), OsString::clone)).with_extension("ld");
    let text = block(".text", &code) + &block(".rodata", &constants);
    std::fs::write(&script, text).map_err(Error::file(&script))?;
    // Unwinding is called by nothing that is kept, but would still make the program ask for its library.
    let kept = arguments.iter().filter(|argument| *argument != "-lgcc_s");
    run(command.args(kept).arg("-T").arg(&script))
}

fn run(command: &mut Command) -> Result<i32, Error> {
    let status = command.status().map_err(Error::file("cc"))?;
    Ok(status.code().unwrap_or(1))
}

/// The linker script that puts pieces in order, before what else there is in the section `before`.
fn block(before: &str, pieces: &[Piece]) -> String {
    if pieces.is_empty() {
        return String::new();
    }
    let lines: String = order(pieces).iter().map(|&i| format!("*({})\n", pieces[i].name)).collect();
    format!("SECTIONS {{ {before}.ordered : {{\n{lines}}} }} INSERT BEFORE {before};\n")
}

/// The pieces' indices in order.
fn order(pieces: &[Piece]) -> Vec<usize> {
    let alike = likeness(pieces);
    let mut left: Vec<usize> = (1..pieces.len()).collect();
    let mut ordered = vec![0];
    while !left.is_empty() {
        let fit = |&piece: &usize| {
            let last = ordered.iter().rev().take(REACH);
            last.fold((0.0, 1.0), |(sum, weight), &i| (sum + weight * alike[piece][i], weight * FADING)).0
        };
        let fits: Vec<f64> = left.iter().map(fit).collect();
        let best = (0..left.len()).fold(0, |best, i| if fits[i] > fits[best] { i } else { best });
        ordered.push(left.remove(best));
    }
    ordered
}

/// What each two pieces have in common.
#[allow(clippy::disallowed_methods, reason = "a square root is exact everywhere")]
fn likeness(pieces: &[Piece]) -> Vec<Vec<f64>> {
    let mut alike = vec![vec![0.0; pieces.len()]; pieces.len()];
    for length in SEQUENCES {
        let mut having: HashMap<&[u8], Vec<usize>> = HashMap::new();
        for (i, piece) in pieces.iter().enumerate() {
            for sequence in piece.bytes.windows(length) {
                let pieces = having.entry(sequence).or_default();
                if pieces.last() != Some(&i) {
                    pieces.push(i);
                }
            }
        }
        // In a fixed order, since the sums are rounded.
        let mut having: Vec<_> = having.into_iter().filter(|(_, p)| (2..COMMON).contains(&p.len())).collect();
        having.sort_unstable();
        for (_, pieces) in having {
            let weight = 1.0 / (pieces.len() as f64).sqrt();
            for &a in &pieces {
                for &b in &pieces {
                    alike[a][b] += weight;
                }
            }
        }
    }
    for (a, row) in alike.iter_mut().enumerate() {
        for (b, value) in row.iter_mut().enumerate() {
            let mean = (pieces[a].bytes.len() as f64 * pieces[b].bytes.len() as f64).sqrt().sqrt();
            *value /= mean + 1.0;
        }
    }
    alike
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pieces(texts: &[&str]) -> Vec<Piece> {
        texts.iter().map(|t| Piece { name: (*t).to_owned(), bytes: t.as_bytes().to_vec() }).collect()
    }

    #[test]
    fn like_follows_like() {
        let pieces =
            pieces(&["mov mov add", "12345678", "mov add sub", "23456789", "sub sub mul", "34567890"]);
        assert_eq!(order(&pieces), [0, 2, 4, 1, 3, 5]);
    }

    #[test]
    fn every_piece_stands_once_and_in_the_same_place_each_time() {
        let texts: Vec<String> = (0..60_u32).map(|i| format!("{:b}", i.wrapping_mul(0x9e37_79b9))).collect();
        let pieces = pieces(&texts.iter().map(String::as_str).collect::<Vec<_>>());
        let first = order(&pieces);
        assert_eq!(first, order(&pieces));
        let mut sorted = first;
        sorted.sort_unstable();
        assert!(sorted.into_iter().eq(0..60));
    }

    #[test]
    fn the_script_names_all_sections() {
        let script = block(".text", &pieces(&[".text.a", ".text.b"]));
        assert_eq!(
            script,
            "SECTIONS { .text.ordered : {\n*(.text.a)\n*(.text.b)\n} } INSERT BEFORE .text;\n"
        );
        assert_eq!(block(".rodata", &[]), "");
    }
}
