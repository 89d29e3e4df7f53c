//! `luc-pack`: packs any x86-64 Linux program.

use lexopt::prelude::*;
use luc_pack::report::{self, Report};
use luc_pack::{Error, Method, Options, pack_elf_as, percent, write_executable};
use std::path::PathBuf;
use std::process::ExitCode;

const HELP: &str = "\
luc-pack FILE -o OUT [--method cm|lzma|raw] [--avx2] [--report DIR]
luc-pack --compare FILE...

Packs the x86-64 Linux program FILE into the executable OUT.

  -o, --output OUT   where to write
      --method NAME  cm: context mixing, smallest (default); lzma: starts faster;
                     raw: no compression
      --avx2         the program needs a processor with AVX2: OUT says so on others, and
                     unpacks faster
      --report DIR   print what each crate, module and function costs packed, and write
                     DIR/report.html, with a map of all bytes; best for a program with symbols
      --compare      print what gzip, zstd, brotli, upkr, xz, LZMA and context mixing make of the
                     files; upkr takes a minute for each
  -h, --help         this text
";

struct Arguments {
    input: PathBuf,
    output: PathBuf,
    method: Method,
    needs_avx2: bool,
    report: Option<PathBuf>,
}

enum Task {
    Pack(Arguments),
    Compare(Vec<PathBuf>),
}

fn main() -> ExitCode {
    // A reader that has seen enough, such as `head`, ends this as it ends other tools.
    // SAFETY: no other thread runs yet, and no handler is replaced.
    unsafe { libc::signal(libc::SIGPIPE, libc::SIG_DFL) };
    let task = match task() {
        Ok(Some(task)) => task,
        Ok(None) => {
            print!("{HELP}");
            return ExitCode::SUCCESS;
        }
        Err(error) => return fail(&format!("{error} (--help tells more)")),
    };
    let result = match &task {
        Task::Pack(arguments) => pack(arguments).map_err(|error| (arguments.input.clone(), error)),
        Task::Compare(files) => report::compare::compare(files, |line| println!("{line}")),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err((_, error @ Error::File(..))) => fail(&error.to_string()),
        Err((input, error)) => fail(&format!("{}: {error}", input.display())),
    }
}

fn fail(sentence: &str) -> ExitCode {
    eprintln!("luc-pack: {sentence}");
    ExitCode::from(2)
}

fn task() -> Result<Option<Task>, lexopt::Error> {
    let (mut files, mut output, mut method, mut report) = (Vec::new(), None, Method::Cm, None);
    let (mut compares, mut needs_avx2) = (false, false);
    let mut parser = lexopt::Parser::from_env();
    while let Some(argument) = parser.next()? {
        match argument {
            Value(file) if files.is_empty() || compares => files.push(PathBuf::from(file)),
            Long("compare") => compares = true,
            Long("avx2") => needs_avx2 = true,
            Short('o') | Long("output") => output = Some(parser.value()?.into()),
            Long("method") => {
                let name = parser.value()?.string()?;
                method = Method::named(&name).ok_or(format!("no method '{name}': cm, lzma or raw"))?;
            }
            Long("report") => report = Some(parser.value()?.into()),
            Short('h') | Long("help") => return Ok(None),
            other => return Err(other.unexpected()),
        }
    }
    if files.is_empty() {
        return Err("which file is to be packed?".into());
    }
    if compares {
        return Ok(Some(Task::Compare(files)));
    }
    let input = files.swap_remove(0);
    let output = output.ok_or("where to? -o OUT is missing")?;
    if report.is_some() && method != Method::Cm {
        return Err("--report tells what context mixing costs: leave out --method".into());
    }
    Ok(Some(Task::Pack(Arguments { input, output, method, needs_avx2, report })))
}

fn pack(arguments: &Arguments) -> Result<(), Error> {
    let file = std::fs::read(&arguments.input).map_err(Error::file(&arguments.input))?;
    let name = arguments.output.file_name().unwrap_or_default().to_string_lossy();
    let Arguments { method, needs_avx2, .. } = *arguments;
    let options = Options { method, name: &name, needs_avx2, progress: percent };
    let packed = pack_elf_as(&file, &options)?;
    write_executable(&arguments.output, &packed.file)?;
    if let Some(directory) = &arguments.report {
        print!("{}", report::write(directory, &file, &packed)?);
        print!("{}", Report::new(file.len(), &packed));
    }
    let (before, after) = (file.len(), packed.file.len());
    println!("{before} bytes, {} stripped, {after} packed", packed.stripped.len());
    Ok(())
}
