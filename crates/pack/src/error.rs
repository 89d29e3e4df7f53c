//! Everything that can go wrong, each as one sentence.

use std::fmt;
use std::path::PathBuf;

/// Why nothing was packed or built.
#[derive(Debug)]
pub enum Error {
    /// The file has no bytes.
    Empty,
    /// The file has that many bytes.
    TooLong(usize),
    /// The file isn't in ELF format.
    NotElf,
    /// The file is for another processor, or for 32 bits.
    NotX86_64,
    /// The file is a library, an object file or the like.
    NotProgram,
    /// The file's tables contradict each other.
    Malformed,
    /// This system can't compile launchers.
    NoLauncher,
    /// A file couldn't be read or written.
    File(PathBuf, std::io::Error),
    /// No compiler comes with the source of its standard library.
    NoToolchain,
    /// A command couldn't be run, failed, or said something unexpected.
    Command(String),
    /// A dependency's source isn't what the trimming expects.
    Edit {
        /// Name and version of the crate.
        package: String,
        /// What the edit does.
        edit: &'static str,
    },
}

impl Error {
    /// Wraps an error of the file at `path`; for `map_err`.
    pub fn file(path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Error {
        let path = path.into();
        move |error| Error::File(path, error)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Error::Empty => write!(f, "the file is empty"),
            Error::TooLong(length) => {
                write!(
                    f,
                    "{length} bytes are too much to pack, the limit is {}",
                    crate::codec::format::LONGEST
                )
            }
            Error::NotElf => write!(f, "not an ELF file"),
            Error::NotX86_64 => write!(f, "not a 64-bit x86-64 ELF file"),
            Error::NotProgram => write!(f, "not a program but a library or an object file"),
            Error::Malformed => write!(f, "a damaged ELF file: its headers point outside of it"),
            Error::NoLauncher => write!(f, "packing works on x86-64 Linux only"),
            Error::File(path, error) => write!(f, "{}: {error}", path.display()),
            Error::NoToolchain => write!(
                f,
                "the size build needs the standard library's source of the same compiler: \
                 rustup component add rust-src, or on Debian apt-get install rustc-web cargo-web rust-web-src"
            ),
            Error::Command(what) => write!(f, "{what}"),
            Error::Edit { package, edit } => write!(
                f,
                "{package} is not as the size build knows it, so it cannot {edit}; see crates/pack/src/size_build"
            ),
        }
    }
}

impl std::error::Error for Error {}
