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

/// What an opcode is, or what follows it: bit 3 says that a ModRM byte does, the rest what constant.
mod form {
    pub const NOTHING: u8 = 0;
    /// One byte.
    pub const BYTE: u8 = 1;
    /// Four bytes, two under the prefix 66.
    pub const FULL: u8 = 2;
    /// Four bytes, eight under REX.W.
    pub const WIDE: u8 = 3;
    /// A prefix.
    pub const PREFIX: u8 = 4;
    /// The first byte of a VEX prefix.
    pub const VEX: u8 = 5;
    /// The way to another opcode map.
    pub const ESCAPE: u8 = 6;
    pub const MODRM: u8 = 8;
}

/// The forms of the one-byte map (low nibble) and of the map behind 0F (high nibble). Opcodes that
/// no compiler emits are told as suits their neighbours.
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
    use form::*;
    match opcode {
        0x0f => ESCAPE,
        0x26 | 0x2e | 0x36 | 0x3e | 0x40..=0x4f | 0x64..=0x67 | 0xf0 | 0xf2 | 0xf3 => PREFIX,
        0xc4 | 0xc5 => VEX,
        0x00..=0x3f => match opcode & 7 {
            0..=3 => MODRM,
            4 => BYTE,
            5 => FULL,
            _ => NOTHING,
        },
        0x6a | 0x70..=0x7f | 0xa8 | 0xb0..=0xb7 | 0xcd | 0xe0..=0xe7 | 0xeb => BYTE,
        0x68 | 0xa9 | 0xe8 | 0xe9 => FULL,
        0xb8..=0xbf => WIDE,
        0x6b | 0x80 | 0x82 | 0x83 | 0xc0 | 0xc1 | 0xc6 | 0xf6 => MODRM | BYTE,
        0x69 | 0x81 | 0xc7 | 0xf7 => MODRM | FULL,
        0x50..=0x62 | 0x6c..=0x6f | 0x90..=0x9f | 0xa4..=0xa7 | 0xaa..=0xaf => NOTHING,
        0xc2 | 0xc3 | 0xc9 | 0xcc | 0xec..=0xef | 0xf4 | 0xf5 | 0xf8..=0xfd => NOTHING,
        _ => MODRM,
    }
}

const fn behind_0f_form(opcode: u8) -> u8 {
    use form::*;
    match opcode {
        0x38 | 0x3a => ESCAPE,
        0x05 | 0x0b | 0x31 | 0x77 | 0xa2 | 0xc8..=0xcf => NOTHING,
        0x80..=0x8f => FULL,
        0x70..=0x73 | 0xa4 | 0xac | 0xba | 0xc2 | 0xc4..=0xc6 => MODRM | BYTE,
        _ => MODRM,
    }
}

/// Places of facts in [`Walker::facts`].
pub mod fact {
    // The instruction so far; those that aren't known yet are 0, but for the last two.
    /// Prefix bytes.
    pub const PREFIX: usize = 0;
    /// The opcode with its map in bits 8 and up.
    pub const OPCODE: usize = 1;
    /// ModRM, and SIB above it.
    pub const MODRM: usize = 2;
    /// The register field of ModRM.
    pub const REGISTER: usize = 3;
    /// ModRM without it.
    pub const OPERAND: usize = 4;
    /// The third register, which a VEX prefix names, above it 1.
    pub const SOURCE: usize = 5;
    /// The last displacement.
    pub const DISPLACEMENT: usize = 6;
    /// The last constant.
    pub const IMMEDIATE: usize = 7;
    /// Facts of an instruction; those of the three instructions before follow.
    pub const RECORD: usize = 8;
    /// The last sixteen bytes, the last one first.
    pub const BYTES: usize = 4 * RECORD;
    /// What the next byte is, and how much of that is to come.
    pub const STATE: usize = BYTES + 16;
    /// The bytes so far of the displacement or constant.
    pub const FIELD: usize = STATE + 1;
    /// The last displacement of four bytes that was added to a register.
    pub const OFFSET: usize = STATE + 2;
    /// What came with such a fact the last time, by pairs of facts.
    pub const RECALLED: usize = STATE + 3;
    /// Facts that others fill in.
    pub const OTHERS: usize = RECALLED + 3;
}

/// Pairs of a fact and another that came with it in the same instruction: ModRM with the opcode,
/// the opcode after the one before, the displacement with ModRM.
static RECALLED: [(u8, u8); 3] = {
    use fact::*;
    [(OPCODE as u8, MODRM as u8), ((OPCODE + RECORD) as u8, OPCODE as u8), (MODRM as u8, DISPLACEMENT as u8)]
};

/// The state of the walk. All zero is the start of an instruction.
#[derive(Clone)]
#[repr(C)]
pub struct Walker {
    /// What the next byte is.
    pub part: Part,
    /// Bytes still to come of the displacement, immediate or VEX prefix.
    pub left: u8,
    /// Opcode map: 0 is the one-byte map, 1 behind 0F, 2 behind 0F 38, 3 behind 0F 3A.
    pub map: u8,
    /// Length of the displacement that is still to come.
    displacement: u8,
    /// Length of the immediate that this instruction ends with.
    pub immediate: u8,
    /// What is known of this instruction and the last ones, see [`fact`].
    pub facts: [u32; 64],
    recalled: [[u32; 1024]; 3],
}

impl Walker {
    /// The state before the first byte.
    pub const START: Walker = Walker {
        part: Part::Opcode,
        left: 0,
        map: 0,
        displacement: 0,
        immediate: 0,
        facts: [0; 64],
        recalled: [[0; 1024]; 3],
    };

    /// What the next byte is, and what is still to come.
    pub fn state(&self) -> u32 {
        u32::from_le_bytes([self.part as u8, self.left, self.map, self.displacement])
    }

    /// Fills in the facts from instructions further back.
    pub fn recall(&mut self) {
        for (i, ((key, _), memory)) in RECALLED.iter().zip(&self.recalled).enumerate() {
            self.facts[fact::RECALLED + i] = memory[self.facts[usize::from(*key) & 63] as usize & 1023];
        }
    }

    /// Whether the next four bytes are relative to the end of their instruction: the distance of
    /// a near call or jump, or an address relative to RIP. How far that end lies behind the four
    /// bytes is [`Walker::immediate`] in the latter case.
    pub fn at_relative(&self) -> bool {
        self.left == 4
            && match self.part {
                Part::Displacement => self.facts[fact::OPERAND] == 5,
                Part::Immediate => matches!(self.facts[fact::OPCODE], 0xe8 | 0xe9 | 0x180..=0x18f),
                _ => false,
            }
    }

    /// Takes the next byte.
    pub fn step(&mut self, byte: u8) {
        let value = u32::from(byte);
        let facts = &mut self.facts;
        shift(facts, fact::BYTES, fact::STATE, 1);
        facts[fact::BYTES] = value;
        self.left = self.left.saturating_sub(1);
        match self.part {
            Part::Opcode => {
                let mut form = FORMS[usize::from(byte)];
                match self.map {
                    0 => {}
                    1 => form >>= 4,
                    2 => form = form::MODRM,
                    _ => form = form::MODRM | form::BYTE,
                }
                let prefix = facts[fact::PREFIX];
                facts[fact::OPCODE] = value | u32::from(self.map) << 8;
                self.immediate = match form & 7 {
                    form::PREFIX => {
                        facts[fact::PREFIX] = prefix << 8 | value;
                        return;
                    }
                    form::VEX => {
                        self.map = 1;
                        self.part = Part::Vex;
                        self.left = 0xc6 - byte;
                        return;
                    }
                    form::ESCAPE => {
                        self.map += 1 + (self.map & byte >> 1);
                        return;
                    }
                    form::WIDE if prefix & 0xf8 == 0x48 => 8,
                    form::FULL | form::WIDE if prefix & 0xff == 0x66 => 2,
                    form::FULL | form::WIDE => 4,
                    length => length,
                };
                if form & form::MODRM != 0 {
                    self.part = Part::ModRm;
                    return;
                }
            }
            Part::Vex => {
                facts[fact::PREFIX] = facts[fact::PREFIX] << 8 | value;
                facts[fact::SOURCE] = value >> 3 & 15 | 16;
                if self.left != 0 {
                    self.map = byte & 3; // The first of two VEX bytes names the map.
                } else {
                    self.part = Part::Opcode;
                }
                return;
            }
            Part::ModRm => {
                facts[fact::MODRM] = value;
                facts[fact::REGISTER] = value & 0x38;
                facts[fact::OPERAND] = value & 0xc7;
                // Only two of the eight instructions of group 3 end with a constant.
                if facts[fact::OPCODE] & !1 == 0xf6 && byte & 0x30 != 0 {
                    self.immediate = 0;
                }
                self.displacement = match byte & 0xc7 {
                    5 | 0x80..=0xbf => 4,
                    0x40..=0x7f => 1,
                    _ => 0,
                };
                if byte < 0xc0 && byte & 7 == 4 {
                    self.part = Part::Sib;
                    return;
                }
            }
            Part::Sib => {
                if facts[fact::OPERAND] == 4 && byte & 7 == 5 {
                    self.displacement = 4;
                }
                facts[fact::MODRM] |= value << 8;
            }
            Part::Displacement | Part::Immediate => {
                facts[fact::FIELD] = facts[fact::FIELD] << 8 | value;
                if self.left != 0 {
                    return;
                }
                let field = facts[fact::FIELD];
                if self.part == Part::Displacement {
                    facts[fact::DISPLACEMENT] = field;
                    if facts[fact::OPERAND] >= 0x80 {
                        facts[fact::OFFSET] = field;
                    }
                } else {
                    facts[fact::IMMEDIATE] = field;
                }
            }
        }
        // All up to the displacement is known, or up to the constant, or all.
        facts[fact::FIELD] = 0;
        if self.displacement != 0 {
            self.part = Part::Displacement;
            self.left = self.displacement;
            self.displacement = 0;
        } else if self.immediate != 0 {
            self.part = Part::Immediate;
            self.left = self.immediate;
            self.immediate = 0;
        } else {
            for ((key, value), memory) in RECALLED.iter().zip(&mut self.recalled) {
                memory[facts[usize::from(*key) & 63] as usize & 1023] = facts[usize::from(*value) & 63];
            }
            shift(facts, 0, fact::BYTES, fact::RECORD);
            facts[..fact::DISPLACEMENT].fill(0);
            self.part = Part::Opcode;
            self.map = 0;
        }
    }
}

/// Moves the facts from `start` on by so many places, up to `end`.
#[inline(never)]
fn shift(facts: &mut [u32; 64], start: usize, end: usize, by: usize) {
    for place in (start + by..end).rev() {
        facts[place & 63] = facts[(place - by) & 63];
    }
}

/// Factors of [`mix`] for both words, what is added to their sum, and the factor of that.
pub const MIX: [u32; 4] = [0x2c1b_3c6d, 0x9e37_79b1, 0x0123_4567, 0x85eb_ca6b];

/// Mixes two words into one, every bit of which depends on every bit of both.
#[inline(never)]
pub fn mix(a: u32, b: u32) -> u32 {
    let h = a.wrapping_mul(MIX[0]).wrapping_add(b.wrapping_mul(MIX[1])).wrapping_add(MIX[2]);
    (h ^ h >> 15).wrapping_mul(MIX[3]) ^ h >> 13
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
        walker.part == Part::Opcode && walker.facts[fact::PREFIX] == 0 && walker.map == 0
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
