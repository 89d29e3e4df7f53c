//! What `cargo pack` prints: where the bytes of the file go.

pub mod compare;
pub mod costs;
pub mod history;
pub mod page;
pub mod symbols;

use crate::{Error, Packed};
use costs::Costs;
use std::fmt;
use std::path::Path;

/// What the packed file may have, bytes.
pub const LIMIT: usize = 65_536;

/// What an empty window with threads may have, bytes: see `cargo pack --floor`.
pub const FLOOR_LIMIT: usize = 20_480;

/// The sizes of one build, bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Report {
    /// The program as the linker wrote it, with symbols.
    pub linked: usize,
    /// What the system needs of it.
    pub stripped: usize,
    /// That, compressed.
    pub payload: usize,
    /// Launcher, headers and all else.
    pub launcher: usize,
    /// The file.
    pub total: usize,
    /// What the file may have.
    pub limit: usize,
}

impl Report {
    /// The sizes of a packed program.
    pub fn new(linked: usize, packed: &Packed) -> Report {
        let total = packed.file.len();
        let (stripped, payload) = (packed.stripped.len(), packed.payload);
        Report { linked, stripped, payload, launcher: total - payload, total, limit: LIMIT }
    }

    /// The same with another limit.
    pub fn under(self, limit: usize) -> Report {
        Report { limit, ..self }
    }

    /// What is wrong with the size, if anything.
    pub fn complaint(&self) -> Option<String> {
        let over = self.total.checked_sub(self.limit).filter(|&over| over > 0);
        over.map(|over| format!("{over} bytes over the limit of {}", self.limit))
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let left = self.limit as i64 - self.total as i64;
        writeln!(f, "linked         {:>8}", grouped(self.linked as i64))?;
        writeln!(f, "stripped       {:>8}", grouped(self.stripped as i64))?;
        writeln!(f, "packed payload {:>8}", grouped(self.payload as i64))?;
        writeln!(f, "launcher       {:>8}", grouped(self.launcher as i64))?;
        writeln!(f, "total          {:>8}", grouped(self.total as i64))?;
        writeln!(f, "left of {} {:>8}", grouped(self.limit as i64), grouped(left))
    }
}

/// What each byte of a program packed by context mixing costs, which `linked` has the symbols of. Writes
/// `report.html`, which also tells what changed since the last one, and `report.tsv`, from which the
/// next one will know, into `directory`.
pub fn write(directory: &Path, linked: &[u8], packed: &Packed) -> Result<Costs, Error> {
    let symbols = symbols::symbols(linked, packed.stripped.len())?;
    let costs = Costs::new(&symbols, &packed.bits);
    let (list, html) = (directory.join("report.tsv"), directory.join("report.html"));
    let last = std::fs::read_to_string(&list).unwrap_or_default();
    let text = page::page(&Report::new(linked.len(), packed), &costs, &symbols, &packed.bits, &last);
    std::fs::create_dir_all(directory).map_err(Error::file(directory))?;
    std::fs::write(&html, text).map_err(Error::file(&html))?;
    std::fs::write(&list, page::list(&costs)).map_err(Error::file(&list))?;
    Ok(costs)
}

/// A number with commas between its thousands.
fn grouped(number: i64) -> String {
    let digits = number.abs().to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    if number < 0 { format!("-{text}") } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adds_up() {
        let packed =
            Packed { file: vec![0; 23_371], stripped: vec![0; 44_952], payload: 17_370, bits: Vec::new() };
        let text = Report::new(81_128, &packed).to_string();
        let expected = "linked           81,128\nstripped         44,952\npacked payload   17,370\n\
                        launcher          6,001\ntotal            23,371\nleft of 65,536   42,165\n";
        assert_eq!(text, expected);
        assert_eq!(grouped(-1_234_567), "-1,234,567");
    }

    #[test]
    fn over_the_limit_is_told() {
        let packed = Packed { file: vec![0; 20_480], stripped: Vec::new(), payload: 9, bits: Vec::new() };
        let report = Report::new(0, &packed);
        assert_eq!(report.under(20_480).complaint(), None);
        let complaint = report.under(20_478).complaint();
        assert_eq!(complaint.as_deref(), Some("2 bytes over the limit of 20478"));
    }
}
