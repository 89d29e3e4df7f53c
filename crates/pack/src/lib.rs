//! luc-pack: makes a small executable of an x86-64 Linux program, and the 64 kB file of Lúč.
//!
//! A packed file is a launcher of a few kilobytes, most of it compressed itself ([`codec::small`]),
//! and the compressed program. The launcher decodes the program into memory and starts it there with the arguments and the
//! environment that it was given itself.
//!
//! - `elf` takes from the program what the system doesn't need.
//! - [`codec::filter`] turns relative operands into absolute addresses, which pack better.
//! - [`encode`] compresses: context mixing ([`codec::model`], [`codec::cm`]), or LZMA
//!   ([`codec::lzma`]), each decoded by the same source in the launcher.
//! - [`pack_elf`] puts it together.
//! - [`size_build`] is what `cargo pack` does before: builds the intro for size; [`release`] what it can do after.

pub mod check;
pub mod codec;
mod elf;
pub mod encode;
mod error;
pub mod machinery;
pub mod release;
pub mod report;
mod sections;
pub mod size_build;

use codec::format::{ELF_HEADERS, Header, NEEDS_AVX2};
use codec::{checksum::checksum, filter};
pub use error::Error;

/// How to compress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Context mixing: smallest from about 20 kB on, decodes some 300 kB a second.
    Cm,
    /// LZMA: a smaller launcher, and hardly any time.
    Lzma,
    /// No compression: for tests, and to see what the launcher costs.
    Raw,
}

impl Method {
    /// The methods by the names that the command lines take.
    pub const ALL: [(&str, Method); 3] = [("cm", Method::Cm), ("lzma", Method::Lzma), ("raw", Method::Raw)];

    /// The method of that name.
    pub fn named(name: &str) -> Option<Method> {
        Method::ALL.iter().find(|(known, _)| *known == name).map(|(_, method)| *method)
    }

    /// The machine code of the launcher's main part. Where the program needs AVX2, the launcher may use it too.
    fn launcher(self, needs_avx2: bool) -> &'static [u8] {
        match self {
            Method::Cm if needs_avx2 => include_bytes!(concat!(env!("OUT_DIR"), "/launcher-cm-avx2")),
            Method::Cm => include_bytes!(concat!(env!("OUT_DIR"), "/launcher-cm")),
            Method::Lzma => include_bytes!(concat!(env!("OUT_DIR"), "/launcher-lzma")),
            Method::Raw => include_bytes!(concat!(env!("OUT_DIR"), "/launcher-raw")),
        }
    }
}

/// The machine code of the launcher's first part.
const OPENER: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/opener"));

/// What to make.
#[derive(Clone, Copy, Debug)]
pub struct Options<'a> {
    /// How to compress.
    pub method: Method,
    /// What the launcher calls the program in messages; at most 7 bytes count.
    pub name: &'a str,
    /// Whether to start on processors with AVX2 only, and to say so on others.
    pub needs_avx2: bool,
    /// Told how far it is.
    pub progress: encode::Progress,
}

/// For [`Options::progress`]: no one wants to know.
pub fn silent(_: usize, _: usize) {}

/// For [`Options::progress`]: a line on standard error, if that is a terminal and the program so
/// long that it takes a while.
pub fn percent(done: usize, all: usize) {
    use std::io::{IsTerminal, stderr};
    const WORTH_TELLING: usize = 50_000;
    if all >= WORTH_TELLING && stderr().is_terminal() {
        eprint!("\rpacking: {:3} %\x1b[K\r", done * 100 / all);
    }
}

/// A packed program.
#[derive(Debug)]
pub struct Packed {
    /// The executable file.
    pub file: Vec<u8>,
    /// The program as the launcher will start it.
    pub stripped: Vec<u8>,
    /// Length of the compressed program, bytes; the launcher and its header are the rest.
    pub payload: usize,
    /// What each byte of the stripped program costs, bits; only context mixing tells.
    pub bits: Vec<f32>,
}

/// Packs a program; `file` is its ELF file.
pub fn pack_elf(file: &[u8], method: Method) -> Result<Packed, Error> {
    pack_elf_as(file, &Options { method, name: "program", needs_avx2: false, progress: silent })
}

/// Packs a program with all choices.
pub fn pack_elf_as(file: &[u8], options: &Options) -> Result<Packed, Error> {
    let launcher = options.method.launcher(options.needs_avx2);
    if OPENER.is_empty() {
        return Err(Error::NoLauncher);
    }
    let elf::Program { stripped, code } = elf::Program::new(file)?;
    let base = code.base as u32;
    let mut filtered = stripped.clone();
    if options.method != Method::Raw {
        let start = base.wrapping_add(code.range.start as u32);
        filter::filter(&mut filtered[code.range.clone()], start, filter::Direction::Pack);
    }
    let header = Header {
        checksum: checksum(&stripped),
        length: stripped.len() as u32,
        flags: if options.needs_avx2 { NEEDS_AVX2 } else { 0 },
        code_start: code.range.start as u32,
        code_end: code.range.end as u32,
        base,
    };
    let mut main = launcher.to_vec();
    main.extend(header.words().iter().flat_map(|word| word.to_le_bytes()));
    let mut encoder = encode::Encoder::new();
    encode::small(&mut encoder, &main);
    let before = encoder.length();
    let mut bits = Vec::new();
    let coded = match options.method {
        Method::Cm => {
            bits = encode::cm(&mut encoder, &main, &filtered, options.progress);
            encoder.finish()
        }
        method => {
            let mut coded = encoder.finish_in_full();
            coded.extend(if method == Method::Lzma { encode::lzma(&filtered) } else { filtered });
            coded
        }
    };
    let headers = elf::Headers {
        name: options.name,
        main_length: main.len() as u32,
        main_checksum: checksum(&main),
        file: ELF_HEADERS + OPENER.len() + coded.len(),
    };
    let file = [&headers.bytes(), OPENER, &coded].concat();
    Ok(Packed { file, stripped, payload: coded.len() - before, bits })
}

/// Writes an executable file, all of it or nothing: under another name beside it, then renamed.
pub fn write_executable(path: &std::path::Path, bytes: &[u8]) -> Result<(), Error> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}", std::process::id()));
    let temporary = path.with_file_name(name);
    let write = || {
        std::fs::write(&temporary, bytes)?;
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            std::fs::set_permissions(&temporary, std::fs::Permissions::from_mode(0o755))?;
        }
        std::fs::rename(&temporary, path)
    };
    write().map_err(|error| {
        let _ = std::fs::remove_file(&temporary);
        Error::File(path.to_owned(), error)
    })
}
