//! A damaged packed file always ends: mostly in a sentence, at worst by a signal, never in a hang,
//! and never as another program.

mod common;

use common::{Numbers, Run, program, run, scratch};
use luc_pack::{Method, pack_elf, write_executable};
use std::path::Path;
use std::process::Command;

/// Damages per method. Most of the small file is the launcher itself, so that is well covered.
const DAMAGES: usize = 168;

fn result_of(path: &Path, bytes: &[u8]) -> std::io::Result<Run> {
    write_executable(path, bytes).unwrap();
    run(Command::new(path).arg("argument"))
}

#[test]
fn flipped_bits_and_truncations_end() {
    for (name, method) in Method::ALL {
        let path = scratch(&format!("damage-{name}")).join("damaged");
        let file = pack_elf(program(), method).unwrap().file;
        let good = result_of(&path, &file).unwrap();
        let mut numbers = Numbers(0x5eed + file.len() as u64);
        for i in 0..DAMAGES {
            let mut bytes = file.clone();
            let at = numbers.below(bytes.len());
            let what = if i % 4 == 0 {
                bytes.truncate(at);
                format!("{name}, truncated to {at} bytes")
            } else {
                let bit = numbers.below(8);
                bytes[at] ^= 1 << bit;
                format!("{name}, bit {bit} of byte {at} flipped")
            };
            // An error here is the system's refusal to start the file at all. A flip where the opener sets its
            // exit code can make that any number, even after the sentence.
            if let Ok(result) = result_of(&path, &bytes) {
                let is_whole = result == good;
                let is_told = result.output.is_empty() && result.errors == "program: damaged file\n";
                let has_failed = !result.status.success() && result.status != good.status;
                assert!(is_whole || is_told || has_failed, "{what}: {result:?}");
            }
        }
    }
}

#[test]
fn damage_behind_the_launcher_is_told() {
    for (name, method) in Method::ALL {
        let path = scratch(&format!("told-{name}")).join("damaged");
        let packed = pack_elf(program(), method).unwrap();
        let file = packed.file;
        let payload = file.len() - packed.payload;
        let mut numbers = Numbers(99);
        for i in 0..20 {
            let mut bytes = file.clone();
            let at = payload + numbers.below(packed.payload);
            if i % 2 == 0 {
                bytes[at] ^= 1 << numbers.below(8);
            } else {
                bytes.truncate(at);
            }
            let result = result_of(&path, &bytes).unwrap();
            assert_eq!(result.status.code(), Some(3), "{name}: {result:?}");
            assert_eq!(result.errors, "program: damaged file\n");
            assert!(result.output.is_empty());
        }
    }
}
