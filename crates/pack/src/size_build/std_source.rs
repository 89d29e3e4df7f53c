//! A trimmed view of the standard library's source.
//!
//! Links to everything, and three edited files. Threads need not look themselves up, when they end,
//! in the table of those that have a stack for reporting overflows: without messages nothing is
//! ever put there, but the table (a B-tree, 5 kB of code) would be linked. A file that is
//! opened in a senseless way is refused without words: an error with words can be printed, which
//! brings the tables of printable characters along.
//!
//! And a panic is taken for what can't happen, as an index out of range is in C: the compiler leaves out the
//! tests (900 bytes packed) that the ordinary build has, whose panics abort the program. Frames are pure
//! functions of their number, and the same ones are rendered by both builds in the tests.
//!
//! Cargo takes the source from where the environment variable [`VARIABLE`] points, which its own
//! tests use too. A compiler whose source looks different is used untrimmed; the intro is the
//! same then, only larger.

use super::edit::write_if_new;
use crate::Error;
use std::path::{Path, PathBuf};

/// The environment variable for cargo.
pub const VARIABLE: &str = "__CARGO_TESTS_ONLY_SRC_ROOT";

/// An edited file, inside the directory `library`, and its new text; none if it isn't as expected.
type Edit = (&'static str, fn(&str) -> Option<String>);

const EDITS: [Edit; 3] = [
    ("std/src/sys/pal/unix/stack_overflow.rs", |text| {
        let unused = "\n        delete_current_info();\n";
        (text.matches(unused).count() == 1).then(|| text.replacen(unused, "\n", 1))
    }),
    ("std/src/sys/fs/unix.rs", |text| {
        // Up to the end of the text in the error's second place.
        let start = "io::Error::new(\n                        io::ErrorKind::InvalidInput,\n                        \"";
        let mut parts = text.split(start);
        let mut edited = parts.next()?.to_owned();
        for part in parts {
            let (_, after) = part.split_once("access\",\n                    )")?;
            edited.push_str("io::Error::from(io::ErrorKind::InvalidInput)");
            edited.push_str(after);
        }
        (edited.len() < text.len()).then_some(edited)
    }),
    ("core/src/panicking.rs", |text| {
        let aborts = "if cfg!(panic = \"immediate-abort\") {\n        super::intrinsics::abort()\n";
        let never = "if cfg!(panic = \"immediate-abort\") {\n        unsafe { super::hint::unreachable_unchecked() }\n";
        text.contains(aborts).then(|| text.replace(aborts, never))
    }),
];

/// Makes the view in `output`, for the library's source in `library`; none if that is unknown. If it has
/// changed, what `compiled` holds is removed, since cargo believes that a standard library never does.
pub fn prepare(library: &Path, output: &Path, compiled: &Path) -> Result<Option<PathBuf>, Error> {
    let mut edited = Vec::new();
    for (name, edit) in EDITS {
        let file = library.join(name);
        let text = std::fs::read_to_string(&file).map_err(Error::file(&file))?;
        let Some(text) = edit(&text) else { return Ok(None) };
        edited.push((name, text));
    }
    let view = output.join("library");
    for (name, text) in edited {
        let (mut from, mut to) = (library.to_owned(), view.clone());
        for part in Path::new(name) {
            link_all(&from, &to)?;
            from.push(part);
            to.push(part);
            if to.is_symlink() {
                std::fs::remove_file(&to).map_err(Error::file(&to))?;
            }
        }
        if write_if_new(&to, text.as_bytes())? && compiled.exists() {
            std::fs::remove_dir_all(compiled).map_err(Error::file(compiled))?;
        }
    }
    Ok(Some(view))
}

/// Makes the directory `to`, with links to all that is in `from` and isn't there in its own right.
fn link_all(from: &Path, to: &Path) -> Result<(), Error> {
    std::fs::create_dir_all(to).map_err(Error::file(to))?;
    for entry in std::fs::read_dir(from).map_err(Error::file(from))? {
        let entry = entry.map_err(Error::file(from))?;
        let place = to.join(entry.file_name());
        if place.is_symlink() || !place.exists() {
            link(&entry.path(), &place)?;
        }
    }
    Ok(())
}

/// Makes `link` a symbolic link to `target`, unless it is one already.
pub fn link(target: &Path, link: &Path) -> Result<(), Error> {
    if std::fs::read_link(link).is_ok_and(|old| old == target) {
        return Ok(());
    }
    let _ = std::fs::remove_file(link);
    symlink(target, link).map_err(Error::file(link))
}

#[cfg(unix)]
fn symlink(target: &Path, link: &Path) -> std::io::Result<()> {
    std::os::unix::fs::symlink(target, link)
}

#[cfg(not(unix))]
fn symlink(_: &Path, _: &Path) -> std::io::Result<()> {
    Err(std::io::ErrorKind::Unsupported.into())
}
