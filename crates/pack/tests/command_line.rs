//! Both commands answer bad input with one sentence and exit code 2, and leave no file behind.

mod common;

use common::{Run, program, run, scratch};
use std::path::Path;
use std::process::Command;

fn luc_pack(directory: &Path, arguments: &[&str]) -> Run {
    run(Command::new(env!("CARGO_BIN_EXE_luc-pack")).args(arguments).current_dir(directory)).unwrap()
}

#[track_caller]
fn one_sentence(result: &Run, part: &str) {
    assert_eq!(result.status.code(), Some(2), "{result:?}");
    assert_eq!(result.errors.lines().count(), 1, "{result:?}");
    assert!(result.errors.contains(part), "{result:?}");
    assert!(result.output.is_empty());
}

#[test]
fn files_that_are_no_programs() {
    let directory = scratch("no_programs");
    let mut elf32 = program().to_vec();
    elf32[4] = 1;
    let mut arm = program().to_vec();
    arm[18] = 183;
    let mut object = program().to_vec();
    object[16] = 1;
    let mut outside = program().to_vec();
    outside[64 + 32..64 + 40].fill(0xff);
    let cases: [(&str, &[u8], &str); 8] = [
        ("empty", b"", "empty"),
        (
            "text",
            b"#!/bin/sh\necho hello, this is a script and not a program of machine code\n",
            "not an ELF file",
        ),
        ("short", b"\x7fELF\x02\x01", "not an ELF file"),
        ("elf32", &elf32, "64-bit"),
        ("arm", &arm, "x86-64"),
        ("object", &object, "not a program"),
        ("outside", &outside, "damaged ELF"),
        ("long", &vec![0; 3 << 20], "too much"),
    ];
    for (name, bytes, part) in cases {
        std::fs::write(directory.join(name), bytes).unwrap();
        one_sentence(&luc_pack(&directory, &[name, "-o", "out"]), part);
    }
    assert!(!directory.join("out").exists());
}

#[test]
fn a_library_is_no_program() {
    let directory = scratch("library");
    std::fs::write(directory.join("a.c"), "int answer(void) { return 42; }").unwrap();
    let compiled =
        Command::new("cc").args(["-shared", "-fPIC", "a.c", "-o", "a.so"]).current_dir(&directory).status();
    assert!(compiled.unwrap().success());
    one_sentence(&luc_pack(&directory, &["a.so", "-o", "out"]), "library");
}

#[test]
fn bad_arguments() {
    let directory = scratch("bad_arguments");
    std::fs::write(directory.join("program"), program()).unwrap();
    let cases: [(&[&str], &str); 10] = [
        (&[], "which file"),
        (&["program", "-o", "out", "--report"], "--report"),
        (&["program", "-o", "out", "--report", "r", "--method", "lzma"], "--method"),
        (&["program"], "-o OUT"),
        (&["program", "more", "-o", "out"], "more"),
        (&["program", "-o"], "-o"),
        (&["program", "-o", "out", "--method", "zip"], "no method 'zip'"),
        (&["program", "-o", "out", "--fast"], "--fast"),
        (&["missing", "-o", "out"], "missing"),
        (&["program", "-o", "no/such/directory"], "no/such/directory"),
    ];
    for (arguments, part) in cases {
        one_sentence(&luc_pack(&directory, arguments), part);
    }
    assert_eq!(std::fs::read_dir(&directory).unwrap().count(), 1, "a file is left behind");
}

#[test]
fn a_report_tells_what_each_function_costs() {
    let directory = scratch("report");
    std::fs::write(directory.join("program"), program()).unwrap();
    let arguments = ["program", "-o", "out", "--report", "new/place"];
    for _ in 0..2 {
        let result = luc_pack(&directory, &arguments);
        assert!(result.status.success() && result.errors.is_empty(), "{result:?}");
        let table = String::from_utf8(result.output).unwrap();
        assert!(table.contains("  main\n") && table.contains("packed payload"), "{table}");
    }
    let page = std::fs::read_to_string(directory.join("new/place/report.html")).unwrap();
    assert!(page.contains("Since the last report") && page.contains("<td>main"));
    assert!(directory.join("out").exists() && directory.join("new/place/report.tsv").exists());
}

#[test]
fn a_comparison_is_a_table() {
    let directory = scratch("comparison");
    std::fs::write(directory.join("program"), program()).unwrap();
    let result = luc_pack(&directory, &["--compare", "program", "program"]);
    assert!(result.status.success() && result.errors.is_empty(), "{result:?}");
    let table = String::from_utf8(result.output).unwrap();
    let columns = |line: &str| line.matches('|').count();
    assert_eq!(table.lines().map(columns).collect::<Vec<_>>(), [11; 4], "{table}");
    one_sentence(&luc_pack(&directory, &["--compare"]), "which file");
    one_sentence(&luc_pack(&directory, &["--compare", "missing"]), "missing");
    std::fs::write(directory.join("text"), "no program").unwrap();
    one_sentence(&luc_pack(&directory, &["--compare", "program", "text"]), "text: not an ELF file");
}

#[test]
fn help_is_no_error() {
    for command in [env!("CARGO_BIN_EXE_luc-pack"), env!("CARGO_BIN_EXE_cargo-pack")] {
        let help = run(Command::new(command).arg("--help")).unwrap();
        assert!(help.status.success() && help.errors.is_empty());
        assert!(String::from_utf8(help.output).unwrap().contains("--method"));
    }
}

#[test]
fn a_reader_that_has_gone_ends_it_without_a_word() {
    for command in [env!("CARGO_BIN_EXE_luc-pack"), env!("CARGO_BIN_EXE_cargo-pack")] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let done = Command::new(command).arg("--help").stdout(writer).output().unwrap();
        assert_eq!(String::from_utf8_lossy(&done.stderr), "", "{command}");
    }
}

#[test]
fn cargo_pack_refuses_what_it_does_not_know() {
    let cases: [(&[&str], &str); 5] = [
        (&["--fast"], "--fast"),
        (&["extra"], "extra"),
        (&["--method=zip"], "zip"),
        (&["--floor", "--check"], "--floor goes"),
        (&["--history", "--floor"], "--floor goes"),
    ];
    for (arguments, part) in cases {
        one_sentence(&run(Command::new(env!("CARGO_BIN_EXE_cargo-pack")).args(arguments)).unwrap(), part);
    }
}

#[test]
fn cargo_pack_wants_a_compiler_with_source() {
    // Without any command in reach there is no rustup; only Debian's compiler has a fixed place.
    if Path::new("/usr/bin/rustc").exists() {
        println!("skipped: /usr/bin/rustc is installed");
        return;
    }
    let mut command = Command::new(env!("CARGO_BIN_EXE_cargo-pack"));
    one_sentence(&run(command.env("PATH", "/nowhere")).unwrap(), "rustup component add rust-src");
}
