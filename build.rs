//! What the size build (`cargo pack`, which sets `cfg(luc_size)`) needs from the linker.
//!
//! The ordinary build is linked as usual.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if std::env::var_os("CARGO_CFG_LUC_SIZE").is_none() {
        return;
    }
    for argument in [
        // The entry is the program's own, at a fixed address: see src/entry.rs.
        "-nostartfiles",
        "-no-pie",
        // Nothing in the file that the system doesn't need, and one segment for code and constants.
        "-Wl,--build-id=none,--no-eh-frame-hdr,--hash-style=gnu",
        "-Wl,-z,norelro,-z,noseparate-code",
        // Constants of one width beside each other pack 130 bytes better.
        "-Wl,--sort-section=alignment",
    ] {
        println!("cargo::rustc-link-arg-bin=luc={argument}");
        // examples/floor.rs, by `cargo pack --floor`.
        println!("cargo::rustc-link-arg-examples={argument}");
    }
}
