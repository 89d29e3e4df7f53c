//! Compiles the launcher to flat images that the library includes: the opener, and the main part,
//! which calls functions of the opener, once for each method, and for `cm` once more with AVX2.
//!
//! The launcher is x86-64 Linux code and nothing but; on any other system the images are empty,
//! and packing says that it can't be done there.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=launcher");
    println!("cargo::rerun-if-changed=src/codec");
    let output = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let host = env::var("HOST").expect("cargo sets HOST");
    let at_home = host == "x86_64-unknown-linux-gnu" && env::var("TARGET").as_ref() == Ok(&host);
    let images = ["opener", "cm", "cm-avx2", "lzma", "raw"];
    for image in images {
        let file =
            output.join(if image == "opener" { image.to_owned() } else { format!("launcher-{image}") });
        if at_home {
            compile(image, &file, &output);
        } else {
            std::fs::write(&file, []).expect("the output directory is writable");
        }
    }
}

/// Choices of LLVM that the packed launcher gets smaller by, 220 bytes together.
const SMALLER: [&str; 7] = [
    "-pre-RA-sched=list-ilp",
    "-regalloc=basic",
    "-disable-machine-licm",
    "-enable-pre=0",
    "-enable-load-pre=0",
    "-enable-ext-tsp-block-placement",
    "-apply-ext-tsp-for-size",
];

/// Where the parts of the launcher lie when they run: as `src/codec/format.rs` has it.
const OPENER_AT: usize = 0x40_0000 + 64 + 56 - 8;
const MAIN_AT: usize = 0x80_0000;

fn compile(name: &str, image: &Path, output: &Path) {
    let is_opener = name == "opener";
    let (method, with_avx2) = match name.strip_suffix("-avx2") {
        Some(method) => (method, true),
        None => (name, false),
    };
    // The header behind the main part is words.
    let (part, base, multiple) = if is_opener { ("opener", OPENER_AT, 1) } else { ("main", MAIN_AT, 4) };
    let (linked, opener) = (output.join(format!("{name}.elf")), output.join("opener.elf"));
    let directory = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR"));
    let script = directory.join("launcher/launcher.ld");
    let mut command = Command::new(env::var_os("RUSTC").expect("cargo sets RUSTC"));
    command
        .arg(directory.join(format!("launcher/{part}.rs")))
        .args(["--edition=2024", "--crate-name=launcher", "--crate-type=bin"])
        .args(["--cfg", &format!("luc_part=\"{part}\""), "--cfg", &format!("luc_method=\"{method}\"")])
        .args([
            if is_opener { "-Copt-level=z" } else { "-Copt-level=s" },
            "-Cpanic=abort",
            "-Ccodegen-units=1",
            "-Clto=fat",
        ])
        .args(["-Crelocation-model=static", "-Cforce-unwind-tables=no", "-Cno-redzone=yes"])
        .args(with_avx2.then_some("-Ctarget-feature=+avx2"))
        .args(SMALLER.map(|choice| format!("-Cllvm-args={choice}")))
        // The system linker: the script is written for it.
        .args(["-Clinker=cc", "-Clinker-features=-lld"])
        .arg(format!("-Clink-arg=-Wl,--defsym=BASE={base},--defsym=MULTIPLE={multiple}"))
        .args(["-Clink-arg=-nostdlib", "-Clink-arg=-static", "-Clink-arg=-no-pie"])
        .args([
            "-Clink-arg=-Wl,--build-id=none,-z,noseparate-code,-z,max-page-size=4096",
            "-Clink-arg=-Wl,-T",
        ])
        .arg(format!("-Clink-arg=-Wl,{}", script.display()))
        .arg("-o")
        .arg(&linked);
    if !is_opener {
        command.arg(format!("-Clink-arg=-Wl,--just-symbols={}", opener.display()));
    }
    match command.status() {
        Ok(status) if status.success() => {}
        _ => panic!("the launcher ({name}) did not compile"),
    }
    let program = std::fs::read(linked).expect("the compiler wrote it");
    std::fs::write(image, flat(&program, base)).expect("the output directory is writable");
}

/// What the one segment of an ELF file loads.
///
/// (The linker could write flat files itself, but then GNU ld resolves calls through the table of
/// global offsets wrongly.)
fn flat(program: &[u8], base: usize) -> &[u8] {
    let word = |at: usize| u64::from_le_bytes(program[at..at + 8].try_into().expect("eight bytes")) as usize;
    let segments = word(56) & 0xffff;
    let loaded: Vec<usize> =
        (0..segments).map(|i| word(32) + i * 56).filter(|&at| word(at) as u32 == 1).collect();
    let [segment] = loaded[..] else { panic!("the launcher has {} segments", loaded.len()) };
    let (offset, address, length) = (word(segment + 8), word(segment + 16), word(segment + 32));
    // The linker may have put its own headers into the segment, in front of the image.
    let skip = base - address;
    &program[offset + skip..offset + length]
}
