//! A trimmed view of the standard library's source.
//!
//! Links to everything, and one edited file: threads need not look themselves up, when they end,
//! in the table of those that have a stack for reporting overflows. Without messages nothing is
//! ever put there, but the table (a B-tree, 5 kB of code) would be linked.
//!
//! Cargo takes the source from where the environment variable [`VARIABLE`] points, which its own
//! tests use too. A compiler whose source looks different is used untrimmed; the intro is the
//! same then, only larger.

use super::edit::write_if_new;
use crate::Error;
use std::path::{Path, PathBuf};

/// The environment variable for cargo.
pub const VARIABLE: &str = "__CARGO_TESTS_ONLY_SRC_ROOT";

/// The file to edit, inside the directory `library`.
const FILE: &str = "std/src/sys/pal/unix/stack_overflow.rs";
const UNUSED: &str = "\n        delete_current_info();\n";

/// Makes the view in `output`, for the library's source in `library`; none if that is unknown.
pub fn prepare(library: &Path, output: &Path) -> Result<Option<PathBuf>, Error> {
    let file = library.join(FILE);
    let text = std::fs::read_to_string(&file).map_err(Error::file(&file))?;
    if text.matches(UNUSED).count() != 1 {
        return Ok(None);
    }
    let view = output.join("library");
    let (mut from, mut to) = (library.to_owned(), view.clone());
    for part in Path::new(FILE) {
        link_all_but(&from, &to, Path::new(part))?;
        from.push(part);
        to.push(part);
    }
    write_if_new(&to, text.replacen(UNUSED, "\n", 1).as_bytes())?;
    Ok(Some(view))
}

/// Makes the directory `to`, with links to all that is in `from` but `own`.
pub fn link_all_but(from: &Path, to: &Path, own: &Path) -> Result<(), Error> {
    std::fs::create_dir_all(to).map_err(Error::file(to))?;
    for entry in std::fs::read_dir(from).map_err(Error::file(from))? {
        let entry = entry.map_err(Error::file(from))?;
        if entry.file_name() != own {
            link(&entry.path(), &to.join(entry.file_name()))?;
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
