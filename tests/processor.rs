//! On a processor without AVX2 the player says so instead of failing at some instruction.

#![cfg(all(target_arch = "x86_64", target_os = "linux"))]

use std::process::Command;

#[test]
fn a_processor_without_avx2_is_told() {
    let luc = env!("CARGO_BIN_EXE_luc");
    let output = Command::new("qemu-x86_64").args(["-cpu", "Nehalem", luc, "--version"]).output();
    let Ok(output) = output else {
        println!("skipped: qemu-x86_64 is not installed");
        return;
    };
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(String::from_utf8_lossy(&output.stderr), "luc needs a CPU with AVX2, and this one has none\n");
    assert!(output.stdout.is_empty());
}
