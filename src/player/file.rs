//! Writing a whole file or nothing, and saying why it could not be written.
//!
//! An ordinary file is written under another name in the same directory and then renamed, so that
//! neither a full disk nor an error leaves half a picture, and an older picture stays until the new one
//! is complete. Devices and pipes cannot be replaced and are written directly.

use super::text::{Text, ascii, join, number, quoted};
use std::ffi::OsStr;
use std::fs::{File, OpenOptions, remove_file, rename};
use std::io::{Error, Write};
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
            Err(e) if e.raw_os_error() == Some(NOT_FOUND) => {
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

/// Numbers of errors, each 128 up, and the reason in words, then a zero; the standard library's own words
/// would bring its formatting along, and its kinds of errors a large table. They are those of Linux; other
/// systems share all but the last, or, if they aren't Unix, get the number.
const REASONS: &[u8] = b"\x82\x94no such directory\0\x81\x8dpermission denied\0\x95it is a directory\0\
    \x9cno space left\0\xa0the reader has closed the pipe\0\x9ethe file system is read-only\0\
    \xa4\x96the name is too long or not allowed\0";

/// What the system calls a file that isn't there.
const NOT_FOUND: i32 = 2;

fn reason(e: &Error) -> Text {
    let code = e.raw_os_error().unwrap_or(0);
    let mut words = Text::new();
    let mut found = false;
    for &byte in REASONS {
        match byte {
            0 if found => return words,
            0..128 if found => words.push(byte),
            _ => found |= cfg!(unix) && i32::from(byte) == code + 128,
        }
    }
    join(&[b"the system refused with error ", &number(code as u64)])
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use std::io::ErrorKind;

    #[test]
    fn the_reasons_are_those_of_the_standard_library() {
        for code in 0..200 {
            let e = Error::from_raw_os_error(code);
            let expected = match e.kind() {
                ErrorKind::NotFound | ErrorKind::NotADirectory => "no such directory".into(),
                ErrorKind::PermissionDenied => "permission denied".into(),
                ErrorKind::IsADirectory => "it is a directory".into(),
                ErrorKind::StorageFull => "no space left".into(),
                ErrorKind::BrokenPipe => "the reader has closed the pipe".into(),
                ErrorKind::ReadOnlyFilesystem => "the file system is read-only".into(),
                ErrorKind::InvalidFilename => "the name is too long or not allowed".into(),
                ErrorKind::InvalidInput => "the name is too long or not allowed".into(),
                _ => format!("the system refused with error {code}"),
            };
            assert_eq!(String::from_utf8(reason(&e)).unwrap(), expected, "error {code}");
        }
    }
}
