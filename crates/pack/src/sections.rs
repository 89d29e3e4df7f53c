//! The sections of a linked program or an object file.
//!
//! Source: System V ABI, chapter 4.

use crate::Error;
use crate::elf::{u16_at, u32_at, u64_at};

/// A section without bytes in the file.
pub const SHT_NOBITS: u32 = 8;
/// A section that is in memory when the program runs.
pub const SHF_ALLOC: u64 = 2;

/// A section's header.
pub struct Section {
    pub name: String,
    pub kind: u32,
    pub flags: u64,
    pub address: u64,
    pub offset: usize,
    pub length: usize,
    /// Index of the section that it refers to.
    pub link: usize,
}

/// All sections of `file`, whose bytes lie in it; none if it has no table of them.
pub fn sections(file: &[u8]) -> Result<Vec<Section>, Error> {
    let table = u64_at(file, 40)? as usize;
    let count = if table == 0 || u16_at(file, 58)? != 64 { 0 } else { usize::from(u16_at(file, 60)?) };
    let header = |i: usize| file.get(table.saturating_add(i * 64)..).unwrap_or(&[]);
    let names = match usize::from(u16_at(file, 62)?) {
        i if i < count => u64_at(header(i), 24)? as usize,
        _ => file.len(),
    };
    (0..count)
        .map(|i| {
            let header = header(i);
            let section = Section {
                name: text_at(file, names.saturating_add(u32_at(header, 0)? as usize)),
                kind: u32_at(header, 4)?,
                flags: u64_at(header, 8)?,
                address: u64_at(header, 16)?,
                offset: u64_at(header, 24)? as usize,
                length: u64_at(header, 32)? as usize,
                link: u32_at(header, 40)? as usize,
            };
            let inside = section.kind == SHT_NOBITS
                || section.offset.checked_add(section.length).is_some_and(|end| end <= file.len());
            if inside { Ok(section) } else { Err(Error::Malformed) }
        })
        .collect()
}

/// The text at an offset, up to its zero byte.
pub fn text_at(file: &[u8], at: usize) -> String {
    let bytes = file.get(at..).unwrap_or(&[]).split(|&byte| byte == 0).next().unwrap_or(&[]);
    String::from_utf8_lossy(bytes).into_owned()
}
