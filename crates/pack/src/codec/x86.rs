//! Follows x86-64 machine code byte by byte: which part of which instruction comes next.
//!
//! A context-mixing coder predicts machine code far better when it knows whether the next byte is
//! an opcode, a register byte or the third byte of an address, and what came before it in this
//! and the last instructions. The walker knows just enough of the encoding for that: prefixes,
//! the opcode maps, ModRM, SIB, and the length of displacement and immediate. It is never wrong
//! in a way that matters: coder and decoder walk alike, and a rare instruction that is followed
//! wrongly only costs bits until the walk falls into step again, some instructions later.
//!
//! Source: Intel 64 and IA-32 Architectures Software Developer's Manual, volume 2, chapter 2 and
//! appendix A (opcode maps).

/// What the next byte is.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Part {
    /// A prefix or an opcode byte.
    Opcode,
    /// The rest of a VEX prefix.
    Vex,
    /// The byte that names registers and the form of the memory operand.
    ModRm,
    /// Scale, index and base of a memory operand.
    Sib,
    /// An address or an offset from a register.
    Displacement,
    /// A constant, or the distance of a jump.
    Immediate,
}

/// What follows an opcode: bit 3 says that a ModRM byte does, the rest what constant.
mod follows {
    pub const NOTHING: u8 = 0;
    /// One byte.
    pub const BYTE: u8 = 1;
    /// Four bytes, two under the prefix 66.
    pub const FULL: u8 = 2;
    /// Two bytes.
    pub const TWO: u8 = 3;
    /// Four bytes, eight under REX.W.
    pub const WIDE: u8 = 4;
    /// A byte if ModRM's register field is 0 or 1 (the `test` form of group 3).
    pub const TEST_BYTE: u8 = 5;
    /// The same in full size.
    pub const TEST_FULL: u8 = 6;
    pub const MODRM: u8 = 8;
}

/// The forms of the one-byte map (low nibble) and of the map behind 0F (high nibble).
static FORMS: [u8; 256] = {
    let mut forms = [0; 256];
    let mut opcode = 0;
    while opcode < 256 {
        forms[opcode] = one_byte_form(opcode as u8) | behind_0f_form(opcode as u8) << 4;
        opcode += 1;
    }
    forms
};

const fn one_byte_form(opcode: u8) -> u8 {
    use follows::*;
    match opcode {
        0x00..=0x3f => match opcode & 7 {
            0..=3 => MODRM,
            4 => BYTE,
            5 => FULL,
            _ => NOTHING,
        },
        0x6a | 0x70..=0x7f | 0xa8 | 0xb0..=0xb7 | 0xcd | 0xe0..=0xe7 | 0xeb => BYTE,
        0x68 | 0xa9 | 0xe8 | 0xe9 => FULL,
        0xc2 => TWO,
        0xb8..=0xbf => WIDE,
        0x6b | 0x80 | 0x82 | 0x83 | 0xc0 | 0xc1 | 0xc6 => MODRM | BYTE,
        0x69 | 0x81 | 0xc7 => MODRM | FULL,
        0xf6 => MODRM | TEST_BYTE,
        0xf7 => MODRM | TEST_FULL,
        0x50..=0x62 | 0x6c..=0x6f | 0x90..=0x9f | 0xa4..=0xa7 | 0xaa..=0xaf => NOTHING,
        0xc3 | 0xc9 | 0xcc | 0xec..=0xef | 0xf4 | 0xf5 | 0xf8..=0xfd => NOTHING,
        _ => MODRM,
    }
}

const fn behind_0f_form(opcode: u8) -> u8 {
    use follows::*;
    match opcode {
        0x05 | 0x0b | 0x31 | 0x77 | 0xa2 | 0xc8..=0xcf => NOTHING,
        0x80..=0x8f => FULL,
        0x70..=0x73 | 0xa4 | 0xac | 0xba | 0xc2 | 0xc4..=0xc6 => MODRM | BYTE,
        _ => MODRM,
    }
}

/// The state of the walk. All zero is the start of an instruction.
#[derive(Clone)]
pub struct Walker {
    /// What the next byte is.
    pub part: Part,
    /// Bytes still to come of the displacement, immediate or VEX prefix.
    pub left: u8,
    /// Opcode map: 0 is the one-byte map, 1 behind 0F, 2 behind 0F 38, 3 behind 0F 3A.
    pub map: u8,
    /// Length of the immediate that this instruction ends with.
    pub immediate: u8,
    /// The last prefix bytes of this instruction.
    pub prefix: u32,
    /// The opcode with its map in bits 8 and up; 0 before it is known.
    pub opcode: u32,
    /// ModRM, and SIB above it; 0 before they are known.
    pub modrm: u32,
    /// The bytes so far of the displacement or immediate.
    pub field: u32,
    /// The displacement of this instruction, once it is complete.
    pub displacement: u32,
    /// What came in the last instructions, newest first.
    pub past: Past,
}

/// What the walker remembers of instructions that are complete; each newest first.
#[derive(Clone)]
pub struct Past {
    /// Opcodes.
    pub opcodes: [u32; 4],
    /// ModRM and SIB.
    pub modrms: [u32; 3],
    /// Prefixes.
    pub prefixes: [u32; 2],
    /// The last displacement.
    pub displacement: u32,
    /// The last displacement of four bytes that was added to a register.
    pub offset: u32,
    /// The last immediate.
    pub immediate: u32,
}

impl Walker {
    /// Whether the next four bytes are relative to the end of their instruction: the distance of
    /// a near call or jump, or an address relative to RIP. How far that end lies behind the four
    /// bytes is [`Walker::immediate`] in the latter case.
    pub fn at_relative(&self) -> bool {
        self.left == 4
            && match self.part {
                Part::Displacement => self.modrm & 0xc7 == 5,
                Part::Immediate => matches!(self.opcode, 0xe8 | 0xe9 | 0x180..=0x18f),
                _ => false,
            }
    }

    /// Takes the next byte.
    pub fn step(&mut self, byte: u8) {
        let value = u32::from(byte);
        match self.part {
            Part::Opcode => self.opcode_byte(byte),
            Part::Vex => {
                self.prefix = self.prefix << 8 | value;
                self.left -= 1;
                if self.left == 1 {
                    self.map = byte & 3; // The first of two VEX bytes names the map.
                }
                if self.left == 0 {
                    self.part = Part::Opcode;
                }
            }
            Part::ModRm => {
                self.modrm = value;
                // Only two of the eight instructions of group 3 end with a constant.
                if self.immediate & TEST != 0 {
                    self.immediate = if value & 0x30 == 0 { self.immediate & 7 } else { 0 };
                }
                let (mode, base) = (byte >> 6, byte & 7);
                self.left = match mode {
                    1 => 1,
                    2 => 4,
                    0 if base == 5 => 4,
                    _ => 0,
                };
                if mode != 3 && base == 4 {
                    self.part = Part::Sib;
                } else {
                    self.operands();
                }
            }
            Part::Sib => {
                if self.modrm & 0xc0 == 0 && byte & 7 == 5 {
                    self.left = 4;
                }
                self.modrm |= value << 8;
                self.operands();
            }
            Part::Displacement | Part::Immediate => {
                self.field = self.field << 8 | value;
                self.left -= 1;
                if self.left == 0 {
                    if self.part == Part::Displacement {
                        self.displacement = self.field;
                        self.past.displacement = self.field;
                        if self.modrm & 0xc0 == 0x80 {
                            self.past.offset = self.field;
                        }
                        self.constant()
                    } else {
                        self.past.immediate = self.field;
                        self.finish()
                    }
                }
            }
        }
    }

    fn opcode_byte(&mut self, byte: u8) {
        match (self.map, byte) {
            (0, 0x40..=0x4f | 0x66 | 0xf2 | 0xf3 | 0xf0 | 0x64 | 0x65 | 0x2e) => {
                self.prefix = self.prefix << 8 | u32::from(byte);
                return;
            }
            (0, 0x0f) => {
                self.map = 1;
                return;
            }
            (0, 0xc4 | 0xc5) => {
                self.map = 1;
                self.part = Part::Vex;
                self.left = 0xc6 - byte;
                return;
            }
            (1, 0x38 | 0x3a) => {
                self.map = (byte & 2) / 2 + 2;
                return;
            }
            _ => {}
        }
        self.opcode = u32::from(byte) | u32::from(self.map) << 8;
        let forms = FORMS[usize::from(byte)];
        let form = match self.map {
            0 => forms & 15,
            1 => forms >> 4,
            2 => follows::MODRM,
            _ => follows::MODRM | follows::BYTE,
        };
        let last = self.prefix & 0xff;
        let full = if last == 0x66 || self.prefix & 0xff00 == 0x6600 { 2 } else { 4 };
        self.immediate = match form & 7 {
            follows::BYTE => 1,
            follows::FULL => full,
            follows::TWO => 2,
            follows::WIDE if last & 0xf8 == 0x48 => 8,
            follows::WIDE => full,
            follows::TEST_BYTE => TEST | 1,
            follows::TEST_FULL => TEST | full,
            _ => 0,
        };
        if form & follows::MODRM != 0 { self.part = Part::ModRm } else { self.constant() }
    }

    /// ModRM and SIB are known: the displacement comes, if there is one.
    fn operands(&mut self) {
        self.field = 0;
        if self.left > 0 { self.part = Part::Displacement } else { self.constant() }
    }

    /// All but the constant is known.
    #[inline(never)]
    fn constant(&mut self) {
        self.field = 0;
        self.left = self.immediate;
        if self.left > 0 { self.part = Part::Immediate } else { self.finish() }
    }

    /// The instruction is complete.
    #[inline(never)]
    pub fn finish(&mut self) {
        let Past { opcodes: [a, b, c, _], modrms: [d, e, _], prefixes: [f, _], .. } = self.past;
        let past = Past {
            opcodes: [self.opcode, a, b, c],
            modrms: [self.modrm, d, e],
            prefixes: [self.prefix, f],
            ..self.past
        };
        *self = Walker { past, ..Walker::START };
    }

    /// The state before the first byte.
    pub const START: Walker = Walker {
        part: Part::Opcode,
        left: 0,
        map: 0,
        immediate: 0,
        prefix: 0,
        opcode: 0,
        modrm: 0,
        field: 0,
        displacement: 0,
        past: Past {
            opcodes: [0; 4],
            modrms: [0; 3],
            prefixes: [0; 2],
            displacement: 0,
            offset: 0,
            immediate: 0,
        },
    };
}

/// Marks [`Walker::immediate`] as hanging on the ModRM byte.
const TEST: u8 = 0x80;

/// Mixes two words into one, every bit of which depends on every bit of both.
#[inline(never)]
pub fn mix(a: u32, b: u32) -> u32 {
    let h = a.wrapping_mul(0x2c1b_3c6d).wrapping_add(b.wrapping_mul(0x9e37_79b1)).wrapping_add(0x0123_4567);
    (h ^ h >> 15).wrapping_mul(0x85eb_ca6b) ^ h >> 13
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Walks instructions, each of which must end exactly at its last byte.
    #[track_caller]
    fn ends_together(instructions: &[&[u8]]) {
        let mut walker = Walker::START;
        for instruction in instructions {
            for (i, &byte) in instruction.iter().enumerate() {
                assert!(i == 0 || !at_start(&walker), "{instruction:02x?} ended before byte {i}");
                walker.step(byte);
            }
            assert!(at_start(&walker), "{instruction:02x?} did not end");
        }
    }

    fn at_start(walker: &Walker) -> bool {
        walker.part == Part::Opcode && walker.prefix == 0 && walker.map == 0
    }

    #[test]
    fn knows_the_lengths_of_instructions() {
        ends_together(&[
            &[0x55],                                     // push rbp
            &[0x48, 0x89, 0xe5],                         // mov rbp, rsp
            &[0x48, 0x83, 0xec, 0x10],                   // sub rsp, 16
            &[0x48, 0xb8, 1, 2, 3, 4, 5, 6, 7, 8],       // mov rax, imm64
            &[0xb8, 1, 2, 3, 4],                         // mov eax, imm32
            &[0x66, 0xb8, 1, 2],                         // mov ax, imm16
            &[0xe8, 1, 2, 3, 4],                         // call
            &[0x0f, 0x84, 1, 2, 3, 4],                   // je near
            &[0x74, 5],                                  // je short
            &[0x48, 0x8b, 0x05, 1, 2, 3, 4],             // mov rax, [rip + d]
            &[0x8b, 0x44, 0x24, 0x08],                   // mov eax, [rsp + 8]
            &[0x8b, 0x04, 0x25, 1, 2, 3, 4],             // mov eax, [d]
            &[0xf6, 0x45, 0x08, 0x01],                   // test byte [rbp + 8], 1
            &[0xf6, 0xd8],                               // neg al
            &[0xf7, 0xc0, 1, 2, 3, 4],                   // test eax, imm32
            &[0xf7, 0xf1],                               // div ecx
            &[0xf3, 0x0f, 0x58, 0xc1],                   // addss
            &[0x66, 0x0f, 0x3a, 0x0a, 0xc0, 0x01],       // roundss
            &[0x66, 0x0f, 0x38, 0x00, 0xc1],             // pshufb
            &[0xc5, 0xfc, 0x58, 0xc1],                   // vaddps
            &[0xc5, 0xfc, 0xc6, 0xc1, 0x1b],             // vshufps
            &[0xc4, 0xe2, 0x7d, 0x18, 0x05, 1, 2, 3, 4], // vbroadcastss [rip + d]
            &[0xc4, 0xe3, 0x7d, 0x08, 0xc0, 0x09],       // vroundps
            &[0x81, 0x3d, 1, 2, 3, 4, 5, 6, 7, 8],       // cmp dword [rip + d], imm32
            &[0xc2, 8, 0],                               // ret 8
            &[0xc3],
        ]);
    }

    #[test]
    fn finds_relative_operands() {
        let mut walker = Walker::START;
        assert!(!walker.at_relative());
        walker.step(0xe8);
        assert!(walker.at_relative());
        for byte in [1, 2, 3, 4, 0x81] {
            walker.step(byte);
            assert!(!walker.at_relative());
        }
        walker.step(0x3d);
        assert!(walker.at_relative() && walker.immediate == 4);
    }
}
