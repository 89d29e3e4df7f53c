//! What the tests share: a scratch directory, a small program to pack, runs with a time limit.
#![allow(dead_code, reason = "each suite uses a part of it")]

use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// A directory for files of the test `name`, empty.
pub fn scratch(name: &str) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&directory);
    std::fs::create_dir_all(&directory).unwrap();
    directory
}

/// A program that says how it was started: arguments, one variable, its input; and returns 7.
const PROGRAM: &str = r#"
#include <stdio.h>
#include <stdlib.h>
int main(int count, char **arguments) {
    for (int i = 1; i < count; i++) printf("[%s]", arguments[i]);
    const char *variable = getenv("LUC_TEST");
    printf("{%s}", variable ? variable : "");
    for (int c; (c = getchar()) != EOF;) putchar(c);
    return 7;
}
"#;

/// The small program as an ELF file, compiled once.
pub fn program() -> &'static [u8] {
    static ELF: OnceLock<Vec<u8>> = OnceLock::new();
    ELF.get_or_init(|| {
        let directory = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let name = format!("program-{}", std::process::id());
        let (source, elf) = (directory.join(format!("{name}.c")), directory.join(&name));
        std::fs::write(&source, PROGRAM).unwrap();
        let compiled = Command::new("cc").arg("-Os").arg(&source).arg("-o").arg(&elf).status().unwrap();
        assert!(compiled.success());
        let bytes = std::fs::read(&elf).unwrap();
        let _ = (std::fs::remove_file(source), std::fs::remove_file(elf));
        bytes
    })
}

/// How a program ended.
#[derive(Debug, PartialEq)]
pub struct Run {
    pub status: ExitStatus,
    pub output: Vec<u8>,
    pub errors: String,
}

/// Longer than anything here may take.
const LIMIT: Duration = Duration::from_secs(10);

/// Runs a command without input. A program that doesn't end fails the test.
pub fn run(command: &mut Command) -> std::io::Result<Run> {
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = spawn(command)?;
    let start = Instant::now();
    while child.try_wait()?.is_none() {
        if start.elapsed() > LIMIT {
            child.kill().unwrap();
            panic!("{command:?} still runs after {LIMIT:?}");
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    let output = child.wait_with_output()?;
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    Ok(Run { status: output.status, output: output.stdout, errors })
}

/// Starts a program that has just been written. While another thread starts a process, that one
/// may for a moment hold the file open for writing, and the system then refuses to run it.
fn spawn(command: &mut Command) -> std::io::Result<std::process::Child> {
    loop {
        match command.spawn() {
            Err(error) if error.kind() == std::io::ErrorKind::ExecutableFileBusy => {
                std::thread::sleep(Duration::from_millis(1));
            }
            other => return other,
        }
    }
}

/// Whether a program can be found; says so if not, for tests that are skipped then.
pub fn installed(program: &str) -> bool {
    let found = Command::new(program).arg("--version").stdout(Stdio::null()).status().is_ok();
    if !found {
        println!("skipped: {program} is not installed");
    }
    found
}

/// A small generator of numbers that look random: xorshift64*.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % limit
    }
}
