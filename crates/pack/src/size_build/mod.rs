//! The size build: the intro as a small ordinary executable, ready to be packed.
//!
//! A Rust program carries a standard library that was compiled for speed and for good messages
//! when something fails: 175 kB packed, before the first line of its own. So this build compiles
//! the standard library too, for size and without messages, which needs its source
//! ([`toolchain`]) and, on a stable compiler, the permission `RUSTC_BOOTSTRAP`. Dependencies are
//! trimmed copies ([`trim`]) in a workspace of their own ([`workspace`]). What is linked is put in order ([`order`]). The
//! result is the same in any folder ([`names`]).

mod edit;
pub mod names;
pub mod order;
pub mod std_source;
pub mod toolchain;
pub mod trim;
pub mod workspace;

use crate::Error;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use toolchain::Toolchain;

/// Compiler flags, with the reason for each group.
const RUSTFLAGS: &[&str] = &[
    // The size build's own code: src/entry.rs.
    "--cfg=luc_size",
    // As .cargo/config.toml, whose flags these replace. Without SSE4.1, which AVX2 includes,
    // rounding would also bring all of 128-bit floating point along (13 kB packed).
    "-Ctarget-feature=+avx2",
    // No messages, no unwinding, no places in the source, no debug formatting.
    "-Zunstable-options",
    "-Cpanic=immediate-abort",
    "-Zlocation-detail=none",
    "-Zfmt-debug=none",
    "-Cforce-unwind-tables=no",
    // At a fixed address: no relocations. What the linker needs besides is in build.rs.
    "-Crelocation-model=static",
    // The basic register allocator never splits a live range: fewer moves and more equal code for the packer,
    // 2,400 bytes, for no more instructions executed.
    "-Cllvm-args=-regalloc=basic",
    // Address arithmetic as the plain instructions it was (720 bytes); loops with the induction variables they
    // were written with (360); instructions in their order (250); blocks laid out for size (200).
    "-Cllvm-args=-disable-x86-lea-opt",
    "-Cllvm-args=-disable-lsr",
    "-Cllvm-args=-enable-misched=0",
    "-Cllvm-args=-enable-ext-tsp-block-placement",
    "-Cllvm-args=-apply-ext-tsp-for-size",
    // Nothing done twice to do it sooner (430 bytes together), and no upper halves cleared: all code is AVX's (160).
    "-Cllvm-args=-x86-disable-avoid-SFB",
    "-Cllvm-args=-disable-early-taildup",
    "-Cllvm-args=-disable-machine-licm",
    "-Cllvm-args=-enable-pre=0",
    "-Cllvm-args=-enable-load-pre=0",
    "-Cllvm-args=-x86-use-vzeroupper=0",
    // Fewer shared subexpressions are fewer spills (150), and short jump tables cost more than comparisons (90).
    "-Cllvm-args=-disable-machine-cse",
    "-Cllvm-args=-min-jump-table-entries=8",
    // What isn't marked to be inlined is not, before the last step; comparisons stay as they were written (140).
    "-Zcross-crate-inline-threshold=0",
    "-Zmir-enable-passes=-JumpThreading",
    // Warnings are for the ordinary build, which sees the same code.
    "--cap-lints=allow",
];

/// Flags for the last step only, in which all crates are one; before it they would spoil what is inlined.
/// Found by trying some 250 of LLVM's choices, 866 bytes together.
const LAST_FLAGS: &[&str] = &[
    // The order of instructions that keeps fewest values alive (420); loads pass stores that they can't meet (150).
    "-Cllvm-args=-pre-RA-sched=list-hybrid",
    "-Cllvm-args=-combiner-global-alias-analysis",
    // Clearing by a call, products by one instruction, calls inlined more readily where that saves code.
    "-Cllvm-args=-max-store-memset=1",
    "-Cllvm-args=-mul-constant-optimization=0",
    "-Cllvm-args=-inline-call-penalty=50",
    // Less that is moved, copied or merged late.
    "-Cllvm-args=-disable-binop-extract-shuffle",
    "-Cllvm-args=-disable-postra-machine-sink",
    "-Cllvm-args=-disable-postra-machine-licm",
    "-Cllvm-args=-disable-tail-duplicate",
    "-Cllvm-args=-join-splitedges=1",
    "-Cllvm-args=-tail-merge-size=1",
    "-Cllvm-args=-undef-reg-clearance=0",
];

/// Tells cargo which program links; not among the flags, whose words get into the names of symbols.
const LINKER: &str = "CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_LINKER";

/// Flags for minifb's scaler, which is written in C.
const CFLAGS: &str = "-Os -fno-asynchronous-unwind-tables -fcf-protection=none -ffunction-sections -fno-pic \
                      -fno-tree-vectorize";

/// The root of the project: the nearest directory above `here` that has this crate in it.
pub fn project_root(here: &Path) -> Result<PathBuf, Error> {
    let root = here.ancestors().find(|directory| directory.join("crates/pack/Cargo.toml").is_file());
    root.map(Path::to_owned).ok_or(Error::Command("not inside the project".to_owned()))
}

/// What to build.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Program {
    /// The intro.
    Intro,
    /// An empty window: examples/floor.rs.
    Floor,
}

impl Program {
    /// What it is called in messages, and its file in `target/pack`.
    pub fn name(self) -> &'static str {
        match self {
            Program::Intro => "luc",
            Program::Floor => "floor",
        }
    }

    /// What cargo is asked for, and where below its profile's folder the program will lie.
    fn target(self) -> (&'static str, &'static str) {
        match self {
            Program::Intro => ("--bin=luc", "luc"),
            Program::Floor => ("--example=floor", "examples/floor"),
        }
    }
}

/// What was built.
pub struct Built {
    /// The linked executable.
    pub linked: PathBuf,
    /// What cargo told of the crates that it compiled, as JSON, an object a line.
    pub messages: String,
}

/// Builds a program.
pub fn build(program: Program, root: &Path, output: &Path) -> Result<Built, Error> {
    let toolchain = Toolchain::find(root)?;
    let workspace = workspace::prepare(root, output, &toolchain)?;
    let target_directory = output.join("build");
    let (target, place) = program.target();
    let mut command = toolchain.cargo();
    let this = std::env::current_exe().map_err(Error::file("this program"))?;
    command
        .current_dir(&workspace)
        .args(["rustc", "--locked", "--package=luc", target, "--profile=intro"])
        // It takes a minute: who looks on may see how far it is.
        .args((!std::io::stderr().is_terminal()).then_some("--quiet"))
        .arg("--message-format=json-render-diagnostics")
        .stderr(Stdio::inherit())
        .args(["--no-default-features", "--features=sound,smoke,swarm,cost", "--target", workspace::TARGET])
        .args(["-Zbuild-std=std,panic_abort", "-Zbuild-std-features=optimize_for_size"])
        .arg("--target-dir")
        .arg(&target_directory)
        .env("RUSTC_BOOTSTRAP", "1")
        .env("RUSTC_WRAPPER", &this)
        .env(names::VARIABLE, &toolchain.rustc)
        .env(LINKER, &this)
        .env(order::VARIABLE, "1")
        .env("CARGO_ENCODED_RUSTFLAGS", RUSTFLAGS.join("\x1f"))
        .env("CFLAGS_x86_64_unknown_linux_gnu", CFLAGS);
    if let Some(source) = std_source::prepare(&toolchain.library, &workspace.join("std"), &target_directory)?
    {
        command.env(std_source::VARIABLE, source);
    }
    command.arg("--").args(LAST_FLAGS);
    let told = command.output().map_err(Error::file(&toolchain.cargo))?;
    if !told.status.success() {
        return Err(Error::Command("the size build failed; cargo's messages are above".to_owned()));
    }
    let linked = target_directory.join(workspace::TARGET).join("intro").join(place);
    Ok(Built { linked, messages: String::from_utf8_lossy(&told.stdout).into_owned() })
}
