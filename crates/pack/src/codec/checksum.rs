//! The checksum of what was decoded: FNV-1a in 32 bits, which is one multiplication a byte.
//!
//! Every step is reversible, so a single changed byte always changes the sum, and anything else
//! goes unnoticed one time in four thousand million.
//!
//! Source: Glenn Fowler, Landon Curt Noll and Kiem-Phong Vo.

/// The checksum of `bytes`.
pub fn checksum(bytes: &[u8]) -> u32 {
    let mut sum = 0x811c_9dc5;
    for &byte in bytes {
        sum = (sum ^ u32::from(byte)).wrapping_mul(0x0100_0193);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::checksum;

    #[test]
    fn agrees_with_the_published_values() {
        assert_eq!(checksum(b""), 0x811c_9dc5);
        assert_eq!(checksum(b"foobar"), 0xbf9c_f968);
    }
}
