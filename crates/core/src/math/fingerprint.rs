//! Fingerprints of pictures, sounds and tables, for those who hold them against kept ones: FNV-1a, 64 bits
//! (Fowler, Noll and Vo; draft-eastlake-fnv §2). The standard library's hash may change with its version.

/// A fingerprint of the bytes that were added so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fingerprint(u64);

impl Default for Fingerprint {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fingerprint {
    /// That of bytes.
    pub fn of(bytes: impl IntoIterator<Item = u8>) -> u64 {
        let mut fingerprint = Self::default();
        fingerprint.add(bytes);
        fingerprint.value()
    }

    /// That of 0RGB pixels: of their bytes red, green, blue.
    pub fn of_pixels(pixels: &[u32]) -> u64 {
        Self::of(pixels.iter().flat_map(|p| p.to_be_bytes().into_iter().skip(1)))
    }

    /// Adds bytes.
    pub fn add(&mut self, bytes: impl IntoIterator<Item = u8>) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    /// The number.
    pub fn value(self) -> u64 {
        self.0
    }
}
