//! The release: what one sends to a party, in one folder, and the tune beside it.
//!
//! The texts are templates; version and size come from what was packed. All is made in a folder of its own
//! that takes the name of the release when it is complete.

use crate::{Error, write_executable};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// For the scroller of a directory: at most 80 columns.
const NFO: &str = include_str!("luc.nfo");
/// What archives of files show: at most ten lines of 45 columns, ASCII.
const DIZ: &str = include_str!("file_id.diz");

/// The frame that stands for the show, in a part that every build has, and its size.
const POSTER: [&str; 6] = ["--scene", "luc", "--frame", "500", "--size", "1920x1080"];

/// Writes the release of the packed file and its twin below `directory`; the folder's path.
pub fn write(directory: &Path, packed: &[u8], safe: &[u8], version: &str) -> Result<PathBuf, Error> {
    let folder = directory.join(format!("luc-{version}"));
    let (unfinished, tune) = (directory.join("unfinished"), directory.join(format!("luc-{version}.wav")));
    for old in [&unfinished, &folder].into_iter().filter(|path| path.exists()) {
        std::fs::remove_dir_all(old).map_err(Error::file(old))?;
    }
    std::fs::create_dir_all(&unfinished).map_err(Error::file(&unfinished))?;
    let player = unfinished.join("luc");
    write_executable(&player, packed)?;
    write_executable(&unfinished.join("luc-safe"), safe)?;
    for (name, template) in [("luc.nfo", NFO), ("file_id.diz", DIZ)] {
        let path = unfinished.join(name);
        std::fs::write(&path, filled(template, packed.len(), version)).map_err(Error::file(&path))?;
    }
    run(&player, &[&POSTER[..], &["-o"]].concat(), &unfinished.join("luc.png"))?;
    run(&player, &["--wav"], &tune)?;
    std::fs::rename(&unfinished, &folder).map_err(Error::file(&folder))?;
    Ok(folder)
}

/// The template with its numbers.
fn filled(template: &str, bytes: usize, version: &str) -> String {
    template.replace("{bytes}", &bytes.to_string()).replace("{version}", version)
}

/// Has the program write a file.
fn run(program: &Path, arguments: &[&str], output: &Path) -> Result<(), Error> {
    let mut command = Command::new(program);
    command.args(arguments).arg(output).stdin(Stdio::null());
    let status = command.status().map_err(Error::file(program))?;
    if status.success() { Ok(()) } else { Err(Error::Command(format!("{} {status}", program.display()))) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_texts_fit_where_they_are_shown() {
        let nfo = filled(NFO, 65_536, "10.10.10");
        for (i, line) in nfo.lines().enumerate() {
            assert!(line.chars().count() <= 80, "luc.nfo, line {}: {line}", i + 1);
            assert!(!line.contains('{') && line == line.trim_end(), "luc.nfo, line {}: {line}", i + 1);
        }
        let diz = filled(DIZ, 65_536, "10.10.10");
        assert!(diz.is_ascii() && diz.lines().count() <= 10);
        assert!(diz.lines().all(|line| line.len() <= 45 && !line.contains('{')), "{diz}");
    }
}
