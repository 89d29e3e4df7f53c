//! Which function or variable each byte of a program belongs to.
//!
//! The linked program still has the table of symbols that the packed one lost, and both have the
//! same bytes at the same offsets, so a symbol is a range of the file. What no symbol covers, such
//! as constants without names, goes by the name of its section.
//!
//! Source: System V ABI, chapter 4 (sections and symbols).

use crate::Error;
use crate::elf::{u16_at, u32_at, u64_at};
use crate::sections::{SHF_ALLOC, SHT_NOBITS, Section, sections, text_at};
use std::ops::Range;

const SHT_SYMTAB: u32 = 2;
const STT_OBJECT: u8 = 1;
const STT_FUNC: u8 = 2;

/// A named range of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Symbol {
    /// Where its bytes lie in the file.
    pub range: Range<usize>,
    /// Its path, such as `luc_core::trace::nearest`; a section's in brackets, such as `[.rodata]`.
    pub name: String,
}

/// Names for all bytes of `file`, in order and without gaps, up to the offset `end`.
pub fn symbols(file: &[u8], end: usize) -> Result<Vec<Symbol>, Error> {
    let sections = sections(file)?;
    let mut named = functions(file, &sections)?;
    named.sort_by_key(|symbol| (symbol.range.start, symbol.range.end));
    let mut whole: Vec<Symbol> = sections
        .iter()
        .filter(|s| s.flags & SHF_ALLOC != 0 && s.kind != SHT_NOBITS)
        .map(|s| Symbol { range: s.offset..s.offset + s.length, name: format!("[{}]", s.name) })
        .collect();
    whole.sort_by_key(|symbol| symbol.range.start);
    Ok(over(over(vec![Symbol { range: 0..end, name: "[headers]".to_owned() }], whole), named))
}

/// The ranges of `above` in front of those of `below`; both in order, neither with empty names.
fn over(below: Vec<Symbol>, above: Vec<Symbol>) -> Vec<Symbol> {
    let end = below.last().map_or(0, |symbol| symbol.range.end);
    let mut all = Vec::new();
    let mut at = 0;
    let fill = |all: &mut Vec<Symbol>, range: Range<usize>| {
        for symbol in &below {
            let part = symbol.range.start.max(range.start)..symbol.range.end.min(range.end);
            if !part.is_empty() {
                all.push(Symbol { range: part, name: symbol.name.clone() });
            }
        }
    };
    for symbol in above {
        let range = symbol.range.start.max(at)..symbol.range.end.min(end);
        if !range.is_empty() {
            fill(&mut all, at..range.start);
            at = range.end;
            all.push(Symbol { range, name: symbol.name });
        }
    }
    fill(&mut all, at..end);
    all
}

/// The functions and variables of the table of symbols, if there is one.
fn functions(file: &[u8], sections: &[Section]) -> Result<Vec<Symbol>, Error> {
    let Some(table) = sections.iter().find(|section| section.kind == SHT_SYMTAB) else {
        return Ok(Vec::new());
    };
    let strings = sections.get(table.link).map_or(file.len(), |strings| strings.offset);
    let mut found = Vec::new();
    for entry in file[table.offset..table.offset + table.length].chunks_exact(24) {
        let section = sections.get(usize::from(u16_at(entry, 6)?));
        let (address, length) = (u64_at(entry, 8)?, u64_at(entry, 16)? as usize);
        if let Some(section) = section
            && matches!(entry[4] & 15, STT_OBJECT | STT_FUNC)
            && section.kind != SHT_NOBITS
            && section.flags & SHF_ALLOC != 0
        {
            let start = address.wrapping_sub(section.address) as usize;
            let inside = start.checked_add(length).is_some_and(|end| end <= section.length);
            if inside && length > 0 {
                let start = section.offset + start;
                let name = text_at(file, strings.saturating_add(u32_at(entry, 0)? as usize));
                found.push(Symbol { range: start..start + length, name: readable(&name) });
            }
        }
    }
    Ok(found)
}

/// Every name in the table of symbols, also of what other files define, without versions.
pub fn names(file: &[u8]) -> Result<Vec<String>, Error> {
    let sections = sections(file)?;
    let Some(table) = sections.iter().find(|section| section.kind == SHT_SYMTAB) else {
        return Ok(Vec::new());
    };
    let strings = sections.get(table.link).map_or(file.len(), |strings| strings.offset);
    let entries = file[table.offset..table.offset + table.length].chunks_exact(24);
    let name = |entry: &[u8]| {
        let name = text_at(file, strings.saturating_add(u32_at(entry, 0)? as usize));
        Ok(name.split('@').next().unwrap_or_default().to_owned())
    };
    entries.map(name).collect()
}

/// A symbol as written in the source, without the hashes of crates.
fn readable(symbol: &str) -> String {
    format!("{:#}", rustc_demangle::demangle(symbol))
}

/// The path of a function or of the type that it is implemented for: `a::b::c` from names such as
/// `<a::b::C as d::E>::f` or `<&mut a::b::C>::f`.
fn path(name: &str) -> &str {
    let name = name.trim_start_matches(['<', '&', '(', '*']);
    let name = name.strip_prefix("mut ").or(name.strip_prefix("const ")).unwrap_or(name);
    name.split([' ', '<', '>', ',', ';']).next().unwrap_or(name)
}

/// The crate that a symbol belongs to: its path's first part. C functions are their own.
pub fn crate_of(name: &str) -> &str {
    let path = path(name);
    if !name.starts_with('[') && !path.contains("::") {
        "(C functions)"
    } else {
        path.split("::").next().unwrap_or(path)
    }
}

/// The module that a symbol belongs to: its crate, and the part behind it, if that is a module.
pub fn module_of(name: &str) -> String {
    let mut parts = path(name).split("::");
    let (first, second) = (parts.next().unwrap_or_default(), parts.next());
    match second {
        _ if name.starts_with('[') => name.to_owned(),
        None => "(C functions)".to_owned(),
        // The show's parts are modules of a module.
        Some(second @ ("show" | "player")) => {
            let third = parts.next().filter(|third| is_module(third)).unwrap_or_default();
            if third.is_empty() {
                format!("{first}::{second}")
            } else {
                format!("{first}::{second}::{third}")
            }
        }
        Some(second) if is_module(second) && parts.next().is_some() => format!("{first}::{second}"),
        Some(_) => first.to_owned(),
    }
}

/// The part of the show that a symbol belongs to, if it is in the module of one.
pub fn part_of(name: &str) -> Option<&'static str> {
    let module = path(name).strip_prefix("luc::show::")?.split("::").next()?;
    luc::show::PARTS.iter().map(|part| part.name).find(|&part| part == module)
}

fn is_module(part: &str) -> bool {
    part.starts_with(|c: char| c.is_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn symbol(range: Range<usize>, name: &str) -> Symbol {
        Symbol { range, name: name.to_owned() }
    }

    #[test]
    fn what_lies_above_hides_what_lies_below() {
        let below = vec![symbol(0..10, "a"), symbol(10..20, "b")];
        let above = vec![symbol(2..4, "c"), symbol(3..5, "d"), symbol(8..12, "e"), symbol(19..30, "f")];
        let expected =
            [(0..2, "a"), (2..4, "c"), (4..5, "d"), (5..8, "a"), (8..12, "e"), (12..19, "b"), (19..20, "f")];
        assert_eq!(over(below, above), expected.map(|(range, name)| symbol(range, name)));
    }

    #[test]
    fn this_very_test_is_found() {
        let file = std::fs::read(std::env::current_exe().unwrap()).unwrap();
        let symbols = symbols(&file, file.len()).unwrap();
        assert!(symbols.windows(2).all(|pair| pair[0].range.end == pair[1].range.start));
        assert_eq!((symbols[0].range.start, symbols.last().unwrap().range.end), (0, file.len()));
        assert!(symbols.iter().any(|s| s.name.ends_with("this_very_test_is_found")));
    }

    #[test]
    fn crates_and_modules_of_names() {
        for (name, of, module) in [
            ("luc_core::trace::occlusion::occlusion", "luc_core", "luc_core::trace"),
            ("<luc_core::sample::refine::Corners>::smooth", "luc_core", "luc_core::sample"),
            (
                "<rayon_core::registry::WorkerThread as core::convert::From<u8>>::from",
                "rayon_core",
                "rayon_core::registry",
            ),
            ("<&mut minifb::os::Window>::update", "minifb", "minifb::os"),
            ("<alloc::vec::Vec<luc::show::T>>::push", "alloc", "alloc::vec"),
            ("luc::show::gold::scene", "luc", "luc::show::gold"),
            ("luc::show::scene", "luc", "luc::show::scene"),
            ("luc::run", "luc", "luc"),
            ("image_center", "(C functions)", "(C functions)"),
            ("[.rodata]", "[.rodata]", "[.rodata]"),
        ] {
            assert_eq!((crate_of(name), module_of(name).as_str()), (of, module), "{name}");
        }
    }
}
