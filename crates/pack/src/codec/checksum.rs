//! CRC-32 (the reflected polynomial 0xEDB88320 of ISO 3309, as in gzip and PNG), bit by bit.
//!
//! It finds every burst of up to 32 damaged bits for certain, and anything else but one time in
//! four thousand million. A table would be faster and larger; a whole intro takes a millisecond.

/// The checksum of `bytes`.
pub fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = !0u32;
    for &byte in bytes {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = crc >> 1 ^ (crc & 1).wrapping_neg() & 0xedb8_8320;
        }
    }
    !crc
}

#[cfg(test)]
mod tests {
    use super::crc32;

    #[test]
    fn agrees_with_the_published_check_value() {
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
        assert_eq!(crc32(b""), 0);
    }
}
