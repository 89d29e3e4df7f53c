//! The header between the opener and the rest of a packed file.
//!
//! Nine little-endian words and a name; then come the main part of the launcher, coded small, the
//! payload, and, as the file's last word, the CRC-32 of everything before it, the opener included.
//! That is compared before anything in the header but the two lengths is believed;
//! [`Header::output_crc`] is compared after decoding.

/// A header's words by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Header {
    /// CRC-32 of the program.
    pub output_crc: u32,
    /// Length of the program, bytes.
    pub output: u32,
    /// Length of the launcher's main part, bytes.
    pub main: u32,
    /// Length of that as coded, bytes.
    pub main_coded: u32,
    /// Length of the payload, bytes.
    pub payload: u32,
    /// [`NEEDS_AVX2`] or 0.
    pub flags: u32,
    /// Where the program's machine code begins, as an offset in its file.
    pub code_start: u32,
    /// Where the program's machine code ends.
    pub code_end: u32,
    /// Virtual address of file offset 0, so that relative operands turn into the same addresses
    /// that absolute operands hold.
    pub base: u32,
    /// What the program calls itself in messages, filled up with zeros.
    pub name: [u8; NAME],
}

/// Room for the program's name, bytes.
pub const NAME: usize = 12;

/// Where the packed file is loaded; the build script links the opener to lie behind the headers
/// there.
pub const LOADED_AT: usize = 0x40_0000;

/// Where the opener puts the launcher's main part; the build script links it for that place.
pub const MAIN_AT: usize = 0x1000_0000;

/// Length of the ELF header and the one program header in front of the opener, filled up to
/// the alignment of its constants.
pub const ELF_HEADERS: usize = (64 + 56usize).next_multiple_of(16);

/// The flag of [`Header::flags`] for a program that only runs on a CPU with AVX2.
pub const NEEDS_AVX2: u32 = 1;

/// Length of the header, bytes.
pub const HEADER: usize = size_of::<Header>();

/// Length of the checksum at the file's end, bytes.
pub const CHECKSUM: usize = 4;

impl Header {
    /// The header as it stands in the file.
    pub fn bytes(&self) -> [u8; HEADER] {
        let words = [
            self.output_crc,
            self.output,
            self.main,
            self.main_coded,
            self.payload,
            self.flags,
            self.code_start,
            self.code_end,
            self.base,
        ];
        let mut bytes = [0; HEADER];
        for (to, word) in bytes.as_chunks_mut::<4>().0.iter_mut().zip(words) {
            *to = word.to_le_bytes();
        }
        bytes[HEADER - NAME..].copy_from_slice(&self.name);
        bytes
    }
}
