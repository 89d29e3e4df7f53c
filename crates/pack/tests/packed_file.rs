//! A packed program does what the program does.

mod common;

use common::{installed, program, run, scratch};
use luc_pack::{Method, Options, pack_elf, pack_elf_as, write_executable};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

fn pack(name: &str, method: Method) -> (PathBuf, PathBuf) {
    let directory = scratch(name);
    let packed = pack_elf(program(), method).unwrap();
    let (one, other) = (directory.join("packed"), directory.join("plain"));
    write_executable(&one, &packed.file).unwrap();
    write_executable(&other, &packed.stripped).unwrap();
    (one, other)
}

#[test]
fn arguments_environment_and_exit_code_arrive() {
    for (name, method) in Method::ALL {
        let (packed, plain) = pack(&format!("arrive-{name}"), method);
        let ask = |file: &Path| {
            run(Command::new(file).args(["one", "", "two words"]).env("LUC_TEST", "value")).unwrap()
        };
        let result = ask(&packed);
        assert_eq!(result, ask(&plain), "{name}");
        assert_eq!(result.status.code(), Some(7));
        assert_eq!(result.output, b"[one][][two words]{value}");
        assert!(result.errors.is_empty());
    }
}

#[test]
fn standard_input_is_the_programs() {
    let (packed, _) = pack("input", Method::Cm);
    let file = packed.with_file_name("text");
    std::fs::write(&file, "read me").unwrap();
    let input = std::fs::File::open(&file).unwrap();
    let output = Command::new(&packed).env_remove("LUC_TEST").stdin(Stdio::from(input)).output().unwrap();
    assert_eq!(output.stdout, b"{}read me");
}

#[test]
fn packing_is_reproducible_and_pays() {
    let (one, two) = (pack_elf(program(), Method::Cm).unwrap(), pack_elf(program(), Method::Cm).unwrap());
    assert_eq!(one.file, two.file);
    let lzma = pack_elf(program(), Method::Lzma).unwrap();
    assert!(one.payload < lzma.payload && lzma.payload < one.stripped.len());
}

#[test]
fn a_system_program_still_runs() {
    let program = std::fs::read("/bin/ls").unwrap();
    let directory = scratch("system_program");
    let packed = directory.join("ls");
    write_executable(&packed, &pack_elf(&program, Method::Lzma).unwrap().file).unwrap();
    let ask = |program: &Path| run(Command::new(program).args(["-a", "/"])).unwrap();
    let (one, other) = (ask(&packed), ask(Path::new("/bin/ls")));
    assert_eq!((one.status, one.output), (other.status, other.output));
}

#[test]
fn without_memory_files_a_private_file_serves() {
    let (packed, plain) = pack("no_memory_files", Method::Raw);
    let runtime = packed.with_file_name("runtime");
    std::fs::create_dir(&runtime).unwrap();
    for directory in [runtime.as_path(), Path::new("/no/such/directory"), Path::new("")] {
        for forbidden in [MAKING, STARTING] {
            let mut command = Command::new(&packed);
            command.arg("one").env("XDG_RUNTIME_DIR", directory);
            // SAFETY: the closure only makes system calls.
            unsafe { command.pre_exec(move || forbid(forbidden)) };
            let result = run(&mut command).unwrap();
            assert_eq!(result, run(Command::new(&plain).arg("one")).unwrap(), "{directory:?}, {forbidden:?}");
            assert_eq!(std::fs::read_dir(&runtime).unwrap().count(), 0, "the file is left behind");
        }
    }
}

/// A system call with this first argument, or with any.
type Forbidden = (libc::c_long, Option<u32>);

/// Files in memory can't be made.
const MAKING: Forbidden = (libc::SYS_memfd_create, None);
/// They can't be started, as with `vm.memfd_noexec`; the launcher's has the first free number.
const STARTING: Forbidden = (libc::SYS_execveat, Some(3));

/// Makes a system call fail in this process and all that it becomes.
fn forbid((number, argument): Forbidden) -> std::io::Result<()> {
    const LOAD: u16 = 0x20;
    // Where the system tells the call's number and its first argument.
    const NUMBER: u32 = 0;
    const ARGUMENT: u32 = 16;
    const JUMP_IF_EQUAL: u16 = 0x15;
    const RETURN: u16 = 0x06;
    const REFUSE: u32 = 0x0005_0000 | libc::EACCES as u32;
    const ALLOW: u32 = 0x7fff_0000;
    let step = |code, jt, jf, k| libc::sock_filter { code, jt, jf, k };
    let mut filter = [
        step(LOAD, 0, 0, NUMBER),
        step(JUMP_IF_EQUAL, 0, 3, number as u32),
        step(LOAD, 0, 0, ARGUMENT),
        step(JUMP_IF_EQUAL, 0, if argument.is_some() { 1 } else { 0 }, argument.unwrap_or(0)),
        step(RETURN, 0, 0, REFUSE),
        step(RETURN, 0, 0, ALLOW),
    ];
    let program = libc::sock_fprog { len: filter.len() as u16, filter: filter.as_mut_ptr() };
    // SAFETY: the filter lives until the system has copied it.
    let set = unsafe {
        libc::prctl(libc::PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0
            && libc::prctl(libc::PR_SET_SECCOMP, libc::SECCOMP_MODE_FILTER, &raw const program) == 0
    };
    if set { Ok(()) } else { Err(std::io::Error::last_os_error()) }
}

#[test]
fn a_processor_without_avx2_is_told() {
    if !installed("qemu-x86_64") {
        return;
    }
    let directory = scratch("avx2");
    for (name, method) in Method::ALL {
        let packed = directory.join(name);
        let options = Options { method, name: "luc", needs_avx2: true, progress: luc_pack::silent };
        write_executable(&packed, &pack_elf_as(program(), &options).unwrap().file).unwrap();
        let result = run(Command::new("qemu-x86_64").args(["-cpu", "Nehalem"]).arg(&packed)).unwrap();
        assert_eq!(result.status.code(), Some(2), "{name}");
        assert_eq!(result.errors, "luc: needs a processor with AVX2, and this one has none\n", "{name}");
        if std::arch::is_x86_feature_detected!("avx2") {
            assert_eq!(run(&mut Command::new(&packed)).unwrap().status.code(), Some(7), "{name}");
        }
    }
}
