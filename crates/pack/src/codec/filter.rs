//! Turns relative operands of machine code into absolute addresses, and back.
//!
//! Two calls of one function hold different distances but the same address, so addresses are
//! easier to predict. Every four-byte operand that [`Walker::at_relative`] finds gets the address
//! of its instruction's end added, and its bytes turned round: the high ones, nearly always the
//! same, then come first, and the low one is predicted knowing all others.
//!
//! Source: the call filter of Fabian Giesen's kkrunchy, and Igor Pavlov's BCJ.

use super::x86::{Part, Walker};

/// Which way to filter.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Relative to absolute, before packing.
    Pack,
    /// Absolute to relative, after unpacking.
    Unpack,
}

/// Filters `code` in place; `address` is the virtual address of its first byte, `walker` new.
pub fn filter_with(walker: &mut Walker, code: &mut [u8], address: u32, direction: Direction) {
    let mut at = 0;
    while at < code.len() {
        let ahead = code.get_mut(at..).and_then(|rest| rest.first_chunk_mut::<4>());
        if walker.at_relative()
            && let Some(operand) = ahead
        {
            at += 4;
            let tail = if walker.part == Part::Displacement { walker.immediate } else { 0 };
            let end = address.wrapping_add(at as u32).wrapping_add(u32::from(tail));
            let found = *operand;
            *operand = match direction {
                Direction::Pack => u32::from_le_bytes(found).wrapping_add(end).to_be_bytes(),
                Direction::Unpack => u32::from_be_bytes(found).wrapping_sub(end).to_le_bytes(),
            };
            // What the bytes are doesn't matter to the walk, only that there are four.
            for byte in found {
                walker.step(byte);
            }
        } else {
            walker.step(code.get(at).copied().unwrap_or(0));
            at += 1;
        }
    }
}

/// Filters `code` in place; `address` is the virtual address of its first byte.
pub fn filter(code: &mut [u8], address: u32, direction: Direction) {
    let mut walker = Walker::START;
    filter_with(&mut walker, code, address, direction);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn calls_of_one_function_become_equal() {
        let mut code = [0xe8, 0x10, 0, 0, 0, 0x90, 0xe8, 0x0a, 0, 0, 0, 0x90];
        let before = code;
        filter(&mut code, 0x0040_0000, Direction::Pack);
        assert_eq!(code[1..5], [0, 0x40, 0, 0x15]);
        assert_eq!(code[7..11], [0, 0x40, 0, 0x15]);
        filter(&mut code, 0x0040_0000, Direction::Unpack);
        assert_eq!(code, before);
    }

    proptest! {
        #[test]
        fn unpacking_undoes_packing(mut bytes: Vec<u8>, address: u32) {
            let before = bytes.clone();
            filter(&mut bytes, address, Direction::Pack);
            filter(&mut bytes, address, Direction::Unpack);
            prop_assert_eq!(bytes, before);
        }
    }
}
