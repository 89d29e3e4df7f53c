//! Writing a whole file or nothing, and saying why it could not be written.
//!
//! An ordinary file is written under another name in the same directory and then renamed, so that
//! neither a full disk nor an error leaves half a picture, and an older picture stays until the new one
//! is complete. Devices and pipes cannot be replaced and are written directly.

use super::text::{Text, ascii, join, number, quoted};
use std::ffi::OsStr;
use std::fs::{File, OpenOptions, remove_file, rename};
use std::io::{Error, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// A place that can be written, as far as can be known before writing.
pub enum Target {
    /// Standard output.
    Standard,
    /// A device or pipe, already open.
    Device(PathBuf, File),
    /// An ordinary file, there or not.
    Ordinary(PathBuf),
}

impl Target {
    /// Finds out what `name` is, and refuses it now if it cannot be written: rendering may take minutes.
    pub fn find(name: &OsStr) -> Result<Target, Text> {
        if name == "-" {
            return Ok(Target::Standard);
        }
        let path = PathBuf::from(name);
        match OpenOptions::new().write(true).open(&path) {
            // A link stays a link: what it points to is replaced.
            Ok(file) if file.metadata().is_ok_and(|m| m.is_file()) => {
                Ok(Target::Ordinary(path.canonicalize().unwrap_or(path)))
            }
            Ok(file) => Ok(Target::Device(path, file)),
            Err(e) if e.kind() == ErrorKind::NotFound => {
                let trial = aside(&path);
                create(&trial).map_err(|e| cannot(&path, e))?;
                let _ = remove_file(trial);
                Ok(Target::Ordinary(path))
            }
            Err(e) => Err(cannot(&path, e)),
        }
    }

    /// Writes all of `bytes`, or leaves things as they were.
    pub fn write(self, bytes: &[u8]) -> Result<(), Text> {
        match self {
            Target::Standard => print(bytes),
            Target::Device(path, mut file) => file.write_all(bytes).map_err(|e| cannot(&path, e)),
            Target::Ordinary(path) => {
                let beside = aside(&path);
                create(&beside)
                    .and_then(|mut file| {
                        let written = file.write_all(bytes).and_then(|()| rename(&beside, &path));
                        if written.is_err() {
                            let _ = remove_file(&beside);
                        }
                        written
                    })
                    .map_err(|e| cannot(&path, e))
            }
        }
    }
}

/// Writes to standard output and makes sure that it got there.
pub fn print(bytes: &[u8]) -> Result<(), Text> {
    standard(1, bytes).map_err(|e| join(&[b"cannot write standard output: ", &reason(&e)]))
}

/// Writes to the standard stream of this number, 1 output or 2 errors. The standard library's own
/// way there, a buffer of lines behind a lock, would cost the packed file a kilobyte.
#[cfg(unix)]
pub fn standard(stream: i32, bytes: &[u8]) -> Result<(), Error> {
    use std::os::fd::FromRawFd;
    // SAFETY: the stream belongs to the whole program, and is never closed here.
    let file = std::mem::ManuallyDrop::new(unsafe { File::from_raw_fd(stream) });
    (&*file).write_all(bytes)
}

#[cfg(not(unix))]
pub fn standard(stream: i32, bytes: &[u8]) -> Result<(), Error> {
    match stream {
        1 => std::io::stdout().write_all(bytes).and_then(|()| std::io::stdout().flush()),
        _ => std::io::stderr().write_all(bytes),
    }
}

/// The name to write under until the file is complete. It is put together without taking the path
/// apart, which would cost more than all else here.
fn aside(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    let ending = join(&[b".luc-", &number(std::process::id().into())]);
    name.push(ascii(&ending));
    name.into()
}

/// Only a new file: nothing that exists may be overwritten by the unfinished one.
fn create(path: &Path) -> Result<File, Error> {
    OpenOptions::new().write(true).create_new(true).open(path)
}

fn cannot(path: &Path, e: Error) -> Text {
    let name = quoted(path.as_os_str().as_encoded_bytes());
    join(&[b"cannot write ", &name, b": ", &reason(&e), b"; choose another place"])
}

/// The common reasons in words; the standard library's own words would bring its formatting along.
fn reason(e: &Error) -> Text {
    let words: &[u8] = match e.kind() {
        ErrorKind::NotFound | ErrorKind::NotADirectory => b"no such directory",
        ErrorKind::PermissionDenied => b"permission denied",
        ErrorKind::IsADirectory => b"it is a directory",
        ErrorKind::StorageFull => b"no space left",
        ErrorKind::BrokenPipe => b"the reader has closed the pipe",
        ErrorKind::ReadOnlyFilesystem => b"the file system is read-only",
        ErrorKind::InvalidFilename => b"the name is too long or not allowed",
        _ => {
            return join(&[b"the system refused with error ", &number(e.raw_os_error().unwrap_or(0) as u64)]);
        }
    };
    words.to_vec()
}
