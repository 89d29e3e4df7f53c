//! `cargo pack`: builds the intro for size and packs it into one file under 65,536 bytes.

use lexopt::prelude::*;
use luc_pack::report::{self, FLOOR_LIMIT, Report, history};
use luc_pack::size_build::{self, Program, names, order};
use luc_pack::{Error, Method, Options, check, machinery, pack_elf_as, percent, release, write_executable};
use std::path::Path;
use std::process::ExitCode;

const HELP: &str = "\
cargo pack [--check] [--report] [--history] [--release] [--method cm|lzma|raw]
cargo pack --floor

Builds the intro for size and packs it. Writes target/pack/luc, the packed file, and
target/pack/luc-safe, the same program unpacked, and prints what became of each byte.

      --check        run both files too, and compare what they do
      --report       print what each crate, module, part of the show and function costs
                     packed, and write target/pack/report.html, which also shows what changed
                     since the last
      --history      add this commit's sizes to docs/size-history.csv, and draw them
                     in docs/size-history.svg
      --release      write the folder that one sends to a party, target/pack/luc-VERSION: both
                     files, luc.nfo, file_id.diz and a picture; and the tune beside it
      --method NAME  cm: context mixing, smallest (default); lzma: starts faster;
                     raw: no compression
      --floor        build and pack an empty window instead, with threads but without the
                     engine: target/pack/floor, what any such program costs
  -h, --help         this text

Exit code 1: over 65,536 bytes (the floor: 20,480), or it has machinery of the engine that none of
its parts calls for, or lacks some that one does, or it calls the platform's libm, which differs
between machines, or the packed file does something else than the unpacked one.
Exit code 2: it can't be built.
";

struct Arguments {
    check: bool,
    report: bool,
    history: bool,
    release: bool,
    floor: bool,
    method: Method,
}

fn main() -> ExitCode {
    // A reader that has seen enough, such as `head`, ends this as it ends other tools.
    // SAFETY: no other thread runs yet, and no handler is replaced.
    unsafe { libc::signal(libc::SIGPIPE, libc::SIG_DFL) };
    if let Some(result) = tool() {
        return match result {
            Ok(code) => ExitCode::from(code as u8),
            Err(error) => fail(&error.to_string(), 2),
        };
    }
    let arguments = match arguments() {
        Ok(Some(arguments)) => arguments,
        Ok(None) => {
            print!("{HELP}");
            return ExitCode::SUCCESS;
        }
        Err(error) => return fail(&format!("{error} (--help tells more)"), 2),
    };
    match pack(&arguments) {
        Ok(None) => ExitCode::SUCCESS,
        Ok(Some(complaint)) => fail(&complaint, 1),
        Err(error) => fail(&error.to_string(), 2),
    }
}

/// If cargo has called this program as its compiler, or the compiler as its linker: that one's exit code.
fn tool() -> Option<Result<i32, Error>> {
    let arguments: Vec<_> = std::env::args_os().skip(1).collect();
    let compiler = std::env::var_os(names::VARIABLE);
    if compiler.is_some() && compiler.as_ref() == arguments.first() {
        return Some(names::compile(&arguments));
    }
    std::env::var_os(order::VARIABLE).map(|_| order::link(&arguments))
}

fn fail(sentence: &str, code: u8) -> ExitCode {
    eprintln!("cargo pack: {sentence}");
    ExitCode::from(code)
}

fn arguments() -> Result<Option<Arguments>, lexopt::Error> {
    let mut arguments = Arguments {
        check: false,
        report: false,
        history: false,
        release: false,
        floor: false,
        method: Method::Cm,
    };
    let mut only_floor = true;
    let mut parser = lexopt::Parser::from_env();
    while let Some(argument) = parser.next()? {
        only_floor &= matches!(argument, Long("floor"));
        match argument {
            Long("floor") => arguments.floor = true,
            Long("check") => arguments.check = true,
            Long("report") => arguments.report = true,
            Long("history") => arguments.history = true,
            Long("release") => arguments.release = true,
            Long("method") => {
                let name = parser.value()?.string()?;
                arguments.method =
                    Method::named(&name).ok_or(format!("no method '{name}': cm, lzma or raw"))?;
            }
            Short('h') | Long("help") => return Ok(None),
            other => return Err(other.unexpected()),
        }
    }
    if arguments.floor && !only_floor {
        return Err("--floor goes with nothing else".into());
    }
    Ok(Some(arguments))
}

/// Builds and packs the empty window; what is wrong with it, if anything.
fn floor(root: &Path, output: &Path) -> Result<Option<String>, Error> {
    let built = size_build::build(Program::Floor, root, output)?;
    let linked = std::fs::read(&built.linked).map_err(Error::file(&built.linked))?;
    let name = Program::Floor.name();
    let options = Options { method: Method::Cm, name, needs_avx2: true, progress: percent };
    let packed = pack_elf_as(&linked, &options)?;
    write_executable(&output.join(name), &packed.file)?;
    let report = Report::new(linked.len(), &packed).under(FLOOR_LIMIT);
    print!("{report}");
    Ok(report.complaint())
}

/// Builds, packs, reports; what is wrong with the result, if anything.
fn pack(arguments: &Arguments) -> Result<Option<String>, Error> {
    let here = std::env::current_dir().map_err(Error::file("."))?;
    let root = size_build::project_root(&here)?;
    let output = root.join("target/pack");
    if arguments.floor {
        return floor(&root, &output);
    }
    let built = size_build::build(Program::Intro, &root, &output)?;
    let of_luc = machinery::compiled(&built.messages, "luc");
    let (compiled, called) =
        (machinery::compiled(&built.messages, "luc-core"), machinery::called(machinery::parts(&of_luc)));
    let linked = std::fs::read(&built.linked).map_err(Error::file(&built.linked))?;
    let options = Options { method: arguments.method, name: "luc", needs_avx2: true, progress: percent };
    let packed = pack_elf_as(&linked, &options)?;
    let (file, safe) = (output.join("luc"), output.join("luc-safe"));
    write_executable(&safe, &packed.stripped)?;
    write_executable(&file, &packed.file)?;

    if let Some(complaint) = check::libm(&linked)? {
        return Ok(Some(complaint));
    }
    let report = Report::new(linked.len(), &packed);
    if arguments.report && !packed.bits.is_empty() {
        print!("{}", report::write(&output, &linked, &packed)?);
    }
    if arguments.history {
        history::record(&root, &report)?;
    }
    print!("{report}");
    println!("machinery       {}", compiled.join(", "));
    if let Some(complaint) = machinery::difference(&compiled, &called) {
        return Ok(Some(complaint));
    }
    if let Some(complaint) = report.complaint() {
        return Ok(Some(complaint));
    }
    let complaint = if arguments.check { check::compare(&file, &safe)? } else { None };
    if arguments.release && complaint.is_none() {
        let folder = release::write(&output, &packed.file, &packed.stripped, env!("CARGO_PKG_VERSION"))?;
        println!("release        {}", folder.display());
    }
    Ok(complaint)
}
