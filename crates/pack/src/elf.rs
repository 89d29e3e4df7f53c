//! What the packer must know of an ELF file, and all that it takes out of one.
//!
//! The system starts a program by its program headers; section headers, symbols and notes only
//! serve tools. [`Program::stripped`] ends the file behind the last byte that a program header
//! names, and drops the headers of notes. (The idea is Brian Raiter's `sstrip`.)
//!
//! Source: System V ABI, chapters 4 and 5, and its AMD64 supplement.

use crate::Error;
use crate::codec::format::*;
use std::ops::Range;

const PT_LOAD: u32 = 1;
const PT_DYNAMIC: u32 = 2;
const PT_INTERP: u32 = 3;
const PT_NOTE: u32 = 4;
const PT_GNU_PROPERTY: u32 = 0x6474_e553;
const PF_X: u32 = 1;
const SHF_EXECINSTR: u64 = 4;
const SHT_NOBITS: u32 = 8;

/// Where machine code lies in a file, and at which address.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Code {
    /// The part of the file.
    pub range: Range<usize>,
    /// The virtual address of file offset 0.
    pub base: u64,
}

/// An x86-64 program, ready to be packed.
#[derive(Debug)]
pub struct Program {
    /// The file without what the system doesn't need.
    pub stripped: Vec<u8>,
    /// Its machine code.
    pub code: Code,
}

/// One entry of the table of program headers.
struct Segment {
    kind: u32,
    flags: u32,
    offset: u64,
    address: u64,
    length: u64,
}

impl Program {
    /// Checks that `file` is a program for Linux on x86-64 and strips it.
    pub fn new(file: &[u8]) -> Result<Program, Error> {
        if file.is_empty() {
            return Err(Error::Empty);
        }
        if file.len() > LONGEST {
            return Err(Error::TooLong(file.len()));
        }
        if !file.starts_with(b"\x7fELF") || file.len() < 64 {
            return Err(Error::NotElf);
        }
        if file[4] != 2 || file[5] != 1 || u16_at(file, 18)? != 62 {
            return Err(Error::NotX86_64);
        }
        let segments = segments(file)?;
        let runs = match u16_at(file, 16)? {
            2 => true, // At a fixed address.
            3 => segments.iter().any(|s| s.kind == PT_INTERP) || is_static_pie(file, &segments), // Anywhere.
            _ => false,
        };
        if !runs {
            return Err(Error::NotProgram);
        }
        let code = code(file, &segments)?;
        Ok(Program { stripped: strip(file, &segments)?, code })
    }
}

/// Whether the dynamic section calls a file without interpreter a program.
fn is_static_pie(file: &[u8], segments: &[Segment]) -> bool {
    const DT_FLAGS_1: u64 = 0x6fff_fffb;
    const DF_1_PIE: u64 = 0x0800_0000;
    let Some(dynamic) = segments.iter().find(|s| s.kind == PT_DYNAMIC) else { return false };
    let range = dynamic.offset as usize..dynamic.offset.saturating_add(dynamic.length) as usize;
    file.get(range).unwrap_or(&[]).chunks_exact(16).any(|entry| {
        matches!((u64_at(entry, 0), u64_at(entry, 8)), (Ok(DT_FLAGS_1), Ok(flags)) if flags & DF_1_PIE != 0)
    })
}

fn segments(file: &[u8]) -> Result<Vec<Segment>, Error> {
    if u16_at(file, 54)? != 56 {
        return Err(Error::Malformed);
    }
    let table = usize::try_from(u64_at(file, 32)?).map_err(|_| Error::Malformed)?;
    let mut segments = Vec::new();
    for i in 0..usize::from(u16_at(file, 56)?) {
        let at = table.checked_add(i * 56).ok_or(Error::Malformed)?;
        let segment = Segment {
            kind: u32_at(file, at)?,
            flags: u32_at(file, at + 4)?,
            offset: u64_at(file, at + 8)?,
            address: u64_at(file, at + 16)?,
            length: u64_at(file, at + 32)?,
        };
        if segment.offset.checked_add(segment.length).is_none_or(|end| end > file.len() as u64) {
            return Err(Error::Malformed);
        }
        segments.push(segment);
    }
    Ok(segments)
}

/// The machine code: all executable sections, from the first to the last, or without section
/// headers the first executable segment.
fn code(file: &[u8], segments: &[Segment]) -> Result<Code, Error> {
    let Some(segment) = segments.iter().find(|s| s.kind == PT_LOAD && s.flags & PF_X != 0) else {
        return Err(Error::NotProgram);
    };
    let whole = segment.offset..segment.offset + segment.length;
    let base = segment.address.wrapping_sub(segment.offset);
    let mut range = whole.end..whole.start;
    let table = u64_at(file, 40)? as usize;
    let count = if table == 0 || u16_at(file, 58)? != 64 { 0 } else { usize::from(u16_at(file, 60)?) };
    for i in 0..count {
        let Some(header) = file.get(table.saturating_add(i * 64)..).filter(|rest| rest.len() >= 64) else {
            break;
        };
        let (start, length) = (u64_at(header, 24)?, u64_at(header, 32)?);
        let executable = u64_at(header, 8)? & SHF_EXECINSTR != 0 && u32_at(header, 4)? != SHT_NOBITS;
        if executable && start >= whole.start && start.saturating_add(length) <= whole.end {
            range = range.start.min(start)..range.end.max(start + length);
        }
    }
    let range = if range.is_empty() { whole } else { range };
    Ok(Code { range: range.start as usize..range.end as usize, base })
}

/// Drops section headers, notes, and all behind the last segment.
fn strip(file: &[u8], segments: &[Segment]) -> Result<Vec<u8>, Error> {
    let table = u64_at(file, 32)? as usize;
    let is_note = |s: &Segment| matches!(s.kind, PT_NOTE | PT_GNU_PROPERTY);
    let kept: Vec<usize> = (0..segments.len()).filter(|&i| !is_note(&segments[i])).collect();
    let end = kept.iter().map(|&i| (segments[i].offset + segments[i].length) as usize);
    let end = end.max().unwrap_or(0).max(table + segments.len() * 56);
    let mut stripped = file.get(..end).ok_or(Error::Malformed)?.to_vec();
    stripped[table..table + segments.len() * 56].fill(0);
    for (to, &from) in kept.iter().enumerate() {
        let from = table + from * 56;
        stripped[table + to * 56..][..56].copy_from_slice(&file[from..from + 56]);
    }
    stripped[40..48].fill(0); // No table of sections,
    stripped[58..64].fill(0); // no entries in it.
    stripped[56..58].copy_from_slice(&(kept.len() as u16).to_le_bytes());
    Ok(stripped)
}

pub fn u16_at(bytes: &[u8], at: usize) -> Result<u16, Error> {
    array_at(bytes, at).map(u16::from_le_bytes)
}

pub fn u32_at(bytes: &[u8], at: usize) -> Result<u32, Error> {
    array_at(bytes, at).map(u32::from_le_bytes)
}

pub fn u64_at(bytes: &[u8], at: usize) -> Result<u64, Error> {
    array_at(bytes, at).map(u64::from_le_bytes)
}

fn array_at<const N: usize>(bytes: &[u8], at: usize) -> Result<[u8; N], Error> {
    bytes.get(at..).and_then(|rest| rest.first_chunk()).copied().ok_or(Error::Malformed)
}

/// What the headers of a packed file tell.
#[derive(Default)]
pub struct Headers<'a> {
    /// What the program calls itself in messages.
    pub name: &'a str,
    /// Length and checksum of the launcher's main part with its header.
    pub main_length: u32,
    pub main_checksum: u32,
    /// Length of the file.
    pub file: usize,
}

impl Headers<'_> {
    /// The ELF header and the one program header of a packed file: a program at a fixed address,
    /// loaded as a whole, readable and executable.
    ///
    /// The system reads neither the first header's last fields, which tell of sections, nor a few
    /// others; so the second header begins in the former, and the launcher has its own words in the latter.
    pub fn bytes(&self) -> Vec<u8> {
        const PF_R: u32 = 4;
        let mut bytes = Vec::new();
        bytes.extend(b"\x7fELF\x02\x01\x01\0");
        let mut name = [0; NAME];
        for (to, from) in name[..NAME - 1].iter_mut().zip(self.name.bytes()) {
            *to = from;
        }
        bytes.extend(name);
        for half in [2u16, 62] {
            bytes.extend(half.to_le_bytes()); // A program at a fixed address, x86-64.
        }
        bytes.extend(1u32.to_le_bytes());
        let entry = LOADED_AT + ELF_HEADERS;
        for word in [entry, 56, 0] {
            bytes.extend((word as u64).to_le_bytes()); // Program headers at 56, no section headers.
        }
        bytes.extend(0u32.to_le_bytes());
        for half in [64u16, 56] {
            bytes.extend(half.to_le_bytes());
        }
        // The program header's kind, 1, is also the number of program headers.
        for word in [PT_LOAD, PF_R | PF_X] {
            bytes.extend(word.to_le_bytes());
        }
        for word in [0, LOADED_AT] {
            bytes.extend((word as u64).to_le_bytes());
        }
        for word in [self.main_length, self.main_checksum] {
            bytes.extend(word.to_le_bytes());
        }
        for word in [self.file, self.file, 0x1000] {
            bytes.extend((word as u64).to_le_bytes());
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_this_very_test() {
        let file = std::fs::read(std::env::current_exe().unwrap()).unwrap();
        let segments = segments(&file).unwrap();
        let code = code(&file, &segments).unwrap();
        let whole = segments.iter().find(|s| s.flags & PF_X != 0).unwrap();
        assert!(code.range.start as u64 >= whole.offset && code.range.len() as u64 <= whole.length);
        let stripped = strip(&file, &segments).unwrap();
        assert!(stripped.len() < file.len());
        let again = super::segments(&stripped).unwrap();
        assert!(again.len() < segments.len() && again.iter().all(|s| s.kind != PT_NOTE));
    }

    #[test]
    fn a_header_of_its_own_is_a_program() {
        let headers = Headers { name: "long name", file: 113, ..Headers::default() };
        let mut file = headers.bytes();
        assert_eq!(file.len(), ELF_HEADERS);
        assert_eq!(file[NAME_AT..][..NAME], *b"long na\0");
        assert_eq!(u64_at(&file, FILE_LENGTH_AT).unwrap(), 113);
        file.push(0xc3);
        let program = Program::new(&file).unwrap();
        assert_eq!(program.code, Code { range: 0..113, base: LOADED_AT as u64 });
    }

    /// As fuzzing found: the last entry of the table of segments cut off by the end of the file.
    #[test]
    fn a_table_cut_short_is_an_error() {
        let file = std::fs::read(std::env::current_exe().unwrap()).unwrap();
        let table = u64_at(&file, 32).unwrap() as usize;
        let end = table + usize::from(u16_at(&file, 56).unwrap()) * 56;
        for length in end - 56..end {
            assert!(Program::new(&file[..length]).is_err(), "{length} of {end}");
        }
        let segments = segments(&file).unwrap();
        assert!(strip(&file[..end - 2], &segments).is_err());
    }
}
