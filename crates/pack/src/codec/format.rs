//! Where things lie: in a packed file, and in memory when it runs.
//!
//! The file is loaded as one segment: headers, opener, and one arithmetic code, of which the opener decodes the first part, the launcher's main part with a
//! [`Header`] behind it, and that the rest, which is the program. (The methods `lzma` and `raw` have their
//! own data behind that code.)

/// What the main part must know of the program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(C)]
pub struct Header {
    /// Checksum of the program.
    pub checksum: u32,
    /// Length of the program, bytes.
    pub length: u32,
    /// [`NEEDS_AVX2`] or 0.
    pub flags: u32,
    /// Where the program's machine code begins, as an offset in its file.
    pub code_start: u32,
    /// Where the program's machine code ends.
    pub code_end: u32,
    /// Virtual address of file offset 0, so that relative operands turn into the same addresses
    /// that absolute operands hold.
    pub base: u32,
}

/// The flag of [`Header::flags`] for a program that only runs on a CPU with AVX2.
pub const NEEDS_AVX2: u32 = 1;

impl Header {
    /// The header's words, in order.
    pub fn words(&self) -> [u32; 6] {
        [self.checksum, self.length, self.flags, self.code_start, self.code_end, self.base]
    }
}

/// Where the packed file is loaded.
pub const LOADED_AT: usize = 0x40_0000;

/// Length of the ELF header and the one program header, which overlap by 8 bytes: the opener, which
/// begins behind them, is linked for that place.
pub const ELF_HEADERS: usize = 64 + 56 - 8;

/// In these headers, where nothing is that the system reads: the program's name for messages,
/// filled up with zeros;
pub const NAME_AT: usize = 8;
/// the length of the main part with its header, and the checksum of both;
pub const MAIN_LENGTH_AT: usize = 56 + 24;
pub const MAIN_CHECKSUM_AT: usize = MAIN_LENGTH_AT + 4;
/// and, which the system does read, the file's length.
pub const FILE_LENGTH_AT: usize = 56 + 32;

/// Longest name.
pub const NAME: usize = 8;

/// Where the opener puts the main part, which is linked for that place. The program is decoded behind it.
pub const MAIN_AT: usize = 0x80_0000;

/// The longest program that is packed, bytes. Anything near it starts too slowly to be of use.
pub const LONGEST: usize = 2 << 20;

/// Memory for the small coder.
pub const CELLS_AT: usize = 0x100_0000;

/// Memory for the filter's walker.
pub const WALKER_AT: usize = 0x180_0000;

/// Memory for the model of the method `cm`.
pub const MODEL_AT: usize = 0x200_0000;

/// Memory from [`MAIN_AT`] on for all of that.
pub const MEMORY: usize = MODEL_AT + size_of::<super::model::Model>() - MAIN_AT;
