//! Programs of the system still work when packed: they tell the same version.
//!
//! Thirty programs are packed and run. With `LUC_ALL_PROGRAMS=1` in the environment it is everything below
//! 300 kB in `/usr/bin`, which takes an hour.

mod common;

use common::{run, scratch};
use luc_pack::{Error, Method, Options, pack_elf_as, silent, write_executable};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Where the programs are.
const PLACE: &str = "/usr/bin";

/// Small programs that most systems have and that do nothing but tell their version when asked.
const SAMPLE: [&str; 30] = [
    "arch", "basename", "cat", "chmod", "comm", "cut", "dirname", "env", "expand", "factor", "fold", "gzip",
    "head", "id", "join", "link", "mkdir", "nl", "nproc", "paste", "printenv", "readlink", "seq", "tac",
    "tee", "tr", "tsort", "uname", "uniq", "wc",
];

/// The longest that is packed, bytes.
const LONGEST: u64 = 300_000;

fn programs() -> Vec<PathBuf> {
    if std::env::var_os("LUC_ALL_PROGRAMS").is_none() {
        return SAMPLE.iter().map(|name| Path::new(PLACE).join(name)).collect();
    }
    let entries = std::fs::read_dir(PLACE).into_iter().flatten().flatten();
    let mut all: Vec<_> = entries.map(|entry| entry.path()).collect();
    all.sort();
    all
}

#[test]
fn packed_programs_tell_the_same_version() {
    let directory = scratch("installed");
    let programs = programs();
    let both = std::env::var_os("LUC_ALL_PROGRAMS").is_some();
    let avx2 = std::arch::is_x86_feature_detected!("avx2");
    std::thread::scope(|scope| {
        for part in programs.chunks(programs.len().div_ceil(2).max(1)) {
            scope.spawn(|| {
                for (i, program) in part.iter().enumerate() {
                    // By turns with each launcher, whose models work in different ways.
                    let turn = avx2 && i % 2 == 1;
                    same_version(program, &directory, turn);
                    if both && avx2 {
                        same_version(program, &directory, !turn);
                    }
                }
            });
        }
    });
}

fn same_version(program: &Path, directory: &Path, needs_avx2: bool) {
    let Ok(file) = std::fs::read(program) else { return };
    if file.len() as u64 > LONGEST {
        return;
    }
    let options = Options { method: Method::Cm, name: "program", needs_avx2, progress: silent };
    let packed = match pack_elf_as(&file, &options) {
        Ok(packed) => packed,
        Err(Error::NotElf | Error::NotX86_64 | Error::NotProgram | Error::Empty) => return,
        Err(error) => panic!("{}: {error}", program.display()),
    };
    let name = program.file_name().unwrap();
    let place = directory.join(name);
    write_executable(&place, &packed.file).unwrap();
    let ask = |file: &Path| run(Command::new(file).arg0(name).arg("--version")).unwrap();
    assert_eq!(ask(&place), ask(program), "{}, with AVX2: {needs_avx2}", program.display());
    std::fs::remove_file(place).unwrap();
}
