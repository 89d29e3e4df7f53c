//! Writing a whole file or nothing, and saying why it could not be written.
//!
//! An ordinary file is written under another name in the same directory and then renamed, so that
//! neither a full disk nor an error leaves half a picture, and an older picture stays until the new one
//! is complete. Devices and pipes cannot be replaced and are written directly.

use super::system::{self, File};
use super::text::{Text, join, number, quoted};
use std::ffi::OsStr;

/// A file's name as the system takes it, with a zero at its end.
type Name = Text;

/// A place that can be written, as far as can be known before writing.
pub enum Target {
    /// Standard output.
    Standard,
    /// A device or pipe, already open.
    Device(Name, File),
    /// An ordinary file, there or not.
    Ordinary(Name),
}

impl Target {
    /// Finds out what `name` is, and refuses it now if it cannot be written: rendering may take minutes.
    pub fn find(name: &OsStr) -> Result<Target, Text> {
        if name == "-" {
            return Ok(Target::Standard);
        }
        let name = join(&[name.as_encoded_bytes(), b"\0"]);
        match system::open(&name) {
            // A link stays a link: what it points to is replaced.
            Ok(file) if system::is_ordinary(&file) => {
                Ok(Target::Ordinary(system::resolve(&name).unwrap_or(name)))
            }
            Ok(file) => Ok(Target::Device(name, file)),
            Err(NOT_FOUND) => {
                let trial = aside(&name);
                system::create(&trial).map_err(|e| cannot(&name, e))?;
                system::remove(&trial);
                Ok(Target::Ordinary(name))
            }
            Err(e) => Err(cannot(&name, e)),
        }
    }

    /// Writes all of `bytes`, or leaves things as they were.
    pub fn write(self, bytes: &[u8]) -> Result<(), Text> {
        match self {
            Target::Standard => print(bytes),
            Target::Device(name, file) => system::write(&file, bytes).map_err(|e| cannot(&name, e)),
            Target::Ordinary(name) => {
                let beside = aside(&name);
                system::create(&beside)
                    .and_then(|file| {
                        let written =
                            system::write(&file, bytes).and_then(|()| system::rename(&beside, &name));
                        if written.is_err() {
                            system::remove(&beside);
                        }
                        written
                    })
                    .map_err(|e| cannot(&name, e))
            }
        }
    }
}

/// Writes to standard output and makes sure that it got there.
pub fn print(bytes: &[u8]) -> Result<(), Text> {
    system::write_standard(1, bytes).map_err(|e| join(&[b"cannot write standard output: ", &reason(e)]))
}

/// The name to write under until the file is complete. It is put together without taking the path
/// apart, which would cost more than all else here.
fn aside(name: &Name) -> Name {
    join(&[&name[..name.len() - 1], b".luc-", &number(std::process::id().into()), b"\0"])
}

fn cannot(name: &Name, code: i32) -> Text {
    let name = quoted(&name[..name.len() - 1]);
    join(&[b"cannot write ", &name, b": ", &reason(code), b"; choose another place"])
}

/// Numbers of errors, each 128 up, and the reason in words, then a zero; the standard library's own words
/// would bring its formatting along, and its kinds of errors a large table. They are those of Linux; other
/// systems share all but the last, or, if they aren't Unix, get the number.
const REASONS: &[u8] = b"\x82\x94no such directory\0\x81\x8dpermission denied\0\x95it is a directory\0\
    \x9cno space left\0\xa0the reader has closed the pipe\0\x9ethe file system is read-only\0\
    \xa4\x96the name is too long or not allowed\0";

/// What the system calls a file that isn't there.
const NOT_FOUND: i32 = 2;

fn reason(code: i32) -> Text {
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
    use std::io::{Error, ErrorKind};

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
            assert_eq!(String::from_utf8(reason(code)).unwrap(), expected, "error {code}");
        }
    }
}
