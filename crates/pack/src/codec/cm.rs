//! Decodes what was packed by the method `cm`: the bits are the arithmetic decoder's, what they
//! mean is the model's.

use super::model::Model;

/// Fills `memory` from `known` on with what `coder` decodes; it is told how likely a bit is a one, in
/// 16 bits, and tells which it is. `model` is new, that is all zero. What is in memory before
/// is machine code too (the launcher's), from which the model learns what such code looks like.
pub fn decode(model: &mut Model, memory: &mut [u8], known: usize, mut coder: impl FnMut(u32) -> u32) {
    model.start();
    for (position, place) in memory.iter_mut().enumerate() {
        let mut lesson = u32::from(*place);
        *place = model.byte(|one| {
            if position >= known {
                return coder(one);
            }
            lesson <<= 1;
            lesson >> 8 & 1
        });
    }
}
