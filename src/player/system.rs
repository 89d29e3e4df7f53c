//! Files as the system has them: what `file` needs and no more. Errors are the system's numbers.
//!
//! On Unix by the C library's functions: the standard library's own way there, with paths that it copies
//! and errors that it can put into words, would cost the packed file a kilobyte.
//!
//! Why the unsafe code is sound: names end with a zero, which every function asserts; buffers are given with
//! their own lengths; a file is closed once, by its owner.

#[cfg(unix)]
pub use unix::*;

#[cfg(unix)]
mod unix {
    use crate::player::text::Text;
    use std::ffi::{CStr, c_char, c_int};
    use std::os::fd::{AsRawFd, FromRawFd, OwnedFd};
    use std::ptr::null_mut;

    /// An open file.
    pub type File = OwnedFd;

    /// Opens what is there for writing.
    pub fn open(name: &[u8]) -> Result<File, i32> {
        open_as(name, 0)
    }

    /// Only a new file: nothing that exists may be overwritten by an unfinished one.
    pub fn create(name: &[u8]) -> Result<File, i32> {
        open_as(name, libc::O_CREAT | libc::O_EXCL)
    }

    fn open_as(name: &[u8], how: c_int) -> Result<File, i32> {
        const MODE: libc::mode_t = 0o666;
        // SAFETY: see the head of this file; the number is a file's that nobody else has yet.
        unsafe {
            let file = libc::open(c(name), libc::O_WRONLY | libc::O_CLOEXEC | how, libc::c_uint::from(MODE));
            done(file).map(|()| File::from_raw_fd(file))
        }
    }

    /// Whether it is neither a device nor a pipe nor a socket.
    pub fn is_ordinary(file: &File) -> bool {
        // SAFETY: numbers, for all of which zero is a valid value.
        let mut about: libc::stat = unsafe { std::mem::zeroed() };
        // SAFETY: the file is open, and there is room for the answer.
        unsafe { libc::fstat(file.as_raw_fd(), &mut about) };
        about.st_mode & libc::S_IFMT == libc::S_IFREG
    }

    /// The name without links in it.
    pub fn resolve(name: &[u8]) -> Option<Text> {
        // SAFETY: see the head of this file; the C library gives a string of its own, which is left to it.
        unsafe {
            let found = libc::realpath(c(name), null_mut());
            (!found.is_null()).then(|| CStr::from_ptr(found).to_bytes_with_nul().to_vec())
        }
    }

    /// Gives a file another name, and replaces what had that name.
    pub fn rename(from: &[u8], to: &[u8]) -> Result<(), i32> {
        // SAFETY: see the head of this file.
        done(unsafe { libc::rename(c(from), c(to)) })
    }

    /// Removes a file, if it is there.
    pub fn remove(name: &[u8]) {
        // SAFETY: see the head of this file.
        unsafe { libc::unlink(c(name)) };
    }

    /// Writes all of `bytes`.
    pub fn write(file: &File, bytes: &[u8]) -> Result<(), i32> {
        write_standard(file.as_raw_fd(), bytes)
    }

    /// Writes to the standard stream of this number, 1 output or 2 errors.
    pub fn write_standard(stream: c_int, mut bytes: &[u8]) -> Result<(), i32> {
        while !bytes.is_empty() {
            // SAFETY: the pointer and the length are those of one slice.
            let written = unsafe { libc::write(stream, bytes.as_ptr().cast(), bytes.len()) };
            if written > 0 {
                bytes = &bytes[written as usize..];
            } else if last_error() != libc::EINTR {
                return Err(last_error());
            }
        }
        Ok(())
    }

    /// The name for C.
    fn c(name: &[u8]) -> *const c_char {
        debug_assert!(name.ends_with(b"\0"));
        name.as_ptr().cast()
    }

    /// What C's functions mean by a result below zero.
    fn done(result: c_int) -> Result<(), i32> {
        if result < 0 { Err(last_error()) } else { Ok(()) }
    }

    fn last_error() -> i32 {
        std::io::Error::last_os_error().raw_os_error().unwrap_or(0)
    }
}

#[cfg(not(unix))]
pub use other::*;

#[cfg(not(unix))]
mod other {
    use crate::player::text::Text;
    use std::ffi::OsStr;
    use std::fs::OpenOptions;
    use std::io::{Error, Write};
    use std::path::Path;

    pub use std::fs::File;

    pub fn open(name: &[u8]) -> Result<File, i32> {
        OpenOptions::new().write(true).open(path(name)).map_err(code)
    }

    pub fn create(name: &[u8]) -> Result<File, i32> {
        OpenOptions::new().write(true).create_new(true).open(path(name)).map_err(code)
    }

    pub fn is_ordinary(file: &File) -> bool {
        file.metadata().is_ok_and(|about| about.is_file())
    }

    pub fn resolve(name: &[u8]) -> Option<Text> {
        let found = path(name).canonicalize().ok()?;
        Some([found.as_os_str().as_encoded_bytes(), b"\0"].concat())
    }

    pub fn rename(from: &[u8], to: &[u8]) -> Result<(), i32> {
        std::fs::rename(path(from), path(to)).map_err(code)
    }

    pub fn remove(name: &[u8]) {
        let _ = std::fs::remove_file(path(name));
    }

    pub fn write(mut file: &File, bytes: &[u8]) -> Result<(), i32> {
        file.write_all(bytes).map_err(code)
    }

    pub fn write_standard(stream: i32, bytes: &[u8]) -> Result<(), i32> {
        let written = match stream {
            1 => std::io::stdout().write_all(bytes).and_then(|()| std::io::stdout().flush()),
            _ => std::io::stderr().write_all(bytes),
        };
        written.map_err(code)
    }

    fn path(name: &[u8]) -> &Path {
        // SAFETY: it is the name from the command line, or one made of it and ASCII, and the zero.
        Path::new(unsafe { OsStr::from_encoded_bytes_unchecked(&name[..name.len() - 1]) })
    }

    fn code(e: Error) -> i32 {
        e.raw_os_error().unwrap_or(0)
    }
}
