//! Edits of a dependency's source, each of which must find what it was written for.

use crate::Error;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A copy of a crate's source in memory.
pub struct Source {
    /// Name and version, for messages.
    package: String,
    files: BTreeMap<PathBuf, Vec<u8>>,
}

impl Source {
    /// Reads the crate in `directory`; `package` is its name and version.
    pub fn read(package: &str, directory: &Path) -> Result<Source, Error> {
        let mut source = Source { package: package.to_owned(), files: BTreeMap::new() };
        source.read_directory(directory, Path::new(""))?;
        Ok(source)
    }

    fn read_directory(&mut self, root: &Path, inside: &Path) -> Result<(), Error> {
        let directory = root.join(inside);
        for entry in std::fs::read_dir(&directory).map_err(Error::file(&directory))? {
            let entry = entry.map_err(Error::file(&directory))?;
            let (path, name) = (entry.path(), inside.join(entry.file_name()));
            if path.is_dir() {
                self.read_directory(root, &name)?;
            } else if !entry.file_name().to_string_lossy().starts_with('.') {
                let bytes = std::fs::read(&path).map_err(Error::file(path))?;
                self.files.insert(name, bytes);
            }
        }
        Ok(())
    }

    /// The text of a file; none if it isn't there.
    pub fn text(&self, file: &str) -> Option<&str> {
        std::str::from_utf8(self.files.get(Path::new(file))?).ok()
    }

    /// Replaces the text from the start of `from` up to the start of `to`, each of which must
    /// occur once. `edit` says what that is for, in words that follow "cannot".
    pub fn replace(
        &mut self,
        file: &str,
        from: &str,
        to: &str,
        new: &str,
        edit: &'static str,
    ) -> Result<(), Error> {
        let replaced = self.text(file).and_then(|text| {
            let (before, rest) = split_once(text, from)?;
            let (_, after) = split_once(rest, to)?;
            Some(format!("{before}{new}{to}{after}"))
        });
        let replaced = replaced.ok_or_else(|| self.unknown(edit))?;
        self.files.insert(PathBuf::from(file), replaced.into_bytes());
        Ok(())
    }

    /// Replaces every `from` in all files that have it; there must be some.
    pub fn replace_everywhere(&mut self, from: &str, new: &str, edit: &'static str) -> Result<(), Error> {
        let mut found = false;
        for bytes in self.files.values_mut() {
            let Ok(text) = std::str::from_utf8(bytes) else { continue };
            if text.contains(from) {
                found = true;
                *bytes = text.replace(from, new).into_bytes();
            }
        }
        if found { Ok(()) } else { Err(self.unknown(edit)) }
    }

    /// Replaces `old`, which must occur once.
    pub fn replace_text(
        &mut self,
        file: &str,
        old: &str,
        new: &str,
        edit: &'static str,
    ) -> Result<(), Error> {
        let replaced = self.text(file).and_then(|text| split_once(text, old));
        let replaced = replaced.map(|(before, after)| format!("{before}{new}{after}"));
        let replaced = replaced.ok_or_else(|| self.unknown(edit))?;
        self.files.insert(PathBuf::from(file), replaced.into_bytes());
        Ok(())
    }

    /// Replaces a file, which must be there.
    pub fn replace_file(&mut self, file: &str, new: &str, edit: &'static str) -> Result<(), Error> {
        self.text(file).ok_or_else(|| self.unknown(edit))?;
        self.files.insert(PathBuf::from(file), new.into());
        Ok(())
    }

    /// Keeps those lines of a file for which `keep` says so.
    pub fn keep_lines(
        &mut self,
        file: &str,
        keep: impl FnMut(&str) -> bool,
        edit: &'static str,
    ) -> Result<(), Error> {
        let text = self.text(file).ok_or_else(|| self.unknown(edit))?;
        let mut keep = keep;
        let kept: String = text.split_inclusive('\n').filter(|line| keep(line)).collect();
        self.files.insert(PathBuf::from(file), kept.into_bytes());
        Ok(())
    }

    /// The error that says that the source isn't as expected.
    pub fn unknown(&self, edit: &'static str) -> Error {
        Error::Edit { package: self.package.clone(), edit }
    }

    /// Replaces all of a file from the start of `from`, which must occur once.
    pub fn cut_from(&mut self, file: &str, from: &str, edit: &'static str) -> Result<(), Error> {
        let kept =
            self.text(file).and_then(|text| split_once(text, from)).map(|(before, _)| before.to_owned());
        let kept = kept.ok_or_else(|| self.unknown(edit))?;
        self.files.insert(PathBuf::from(file), kept.into_bytes());
        Ok(())
    }

    /// Writes the crate to `directory`. What is the same there stays untouched, so that cargo
    /// needn't compile it again.
    pub fn write(&self, directory: &Path) -> Result<(), Error> {
        for (name, bytes) in &self.files {
            write_if_new(&directory.join(name), bytes)?;
        }
        Ok(())
    }
}

/// The text before and after `part`, if it occurs once.
fn split_once<'a>(text: &'a str, part: &str) -> Option<(&'a str, &'a str)> {
    let (before, after) = text.split_once(part)?;
    (!after.contains(part)).then_some((before, after))
}

/// Writes a file unless it has these bytes already; whether it did.
pub fn write_if_new(path: &Path, bytes: &[u8]) -> Result<bool, Error> {
    if std::fs::read(path).is_ok_and(|old| old == bytes) {
        return Ok(false);
    }
    let directory = path.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(directory).map_err(Error::file(directory))?;
    std::fs::write(path, bytes).map_err(Error::file(path))?;
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> Source {
        let files = BTreeMap::from([(PathBuf::from("a.rs"), text.into())]);
        Source { package: "example 1.2.3".to_owned(), files }
    }

    #[test]
    fn replaces_what_occurs_once() {
        let mut source = source("one two three");
        source.replace("a.rs", "two", " three", "2", "count").unwrap();
        assert_eq!(source.text("a.rs"), Some("one 2 three"));
    }

    #[test]
    fn replaces_a_text_that_occurs_once() {
        let mut source = source("one two two three");
        source.replace_text("a.rs", "one ", "", "count").unwrap();
        assert_eq!(source.text("a.rs"), Some("two two three"));
        assert!(source.replace_text("a.rs", "two", "2", "count").is_err());
    }

    #[test]
    fn anything_else_names_crate_and_edit() {
        for (from, to) in [("five", "three"), ("o", "three"), ("two", "five"), ("three", "one")] {
            let error =
                source("one two three").replace("a.rs", from, to, "", "count").unwrap_err().to_string();
            assert!(error.starts_with("example 1.2.3 ") && error.contains("cannot count"), "{error}");
        }
        assert!(source("").replace("b.rs", "a", "b", "", "count").is_err());
    }
}
