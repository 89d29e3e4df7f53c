//! What packer and launcher share: the coders' decoding halves and everything they rest on.
//!
//! These files are compiled twice: into the packer's library, and, without the standard library,
//! into the launcher in front of a packed program. Whatever the packer assumes about the decoder
//! therefore is the decoder. Because of the launcher nothing here may panic, allocate, or call
//! into a maths library: indices are masked or checked with `get`, and floating point is plain
//! IEEE addition, multiplication and division, which give the same bits everywhere.

pub mod checksum;
pub mod filter;
pub mod format;
#[cfg(not(luc_method = "raw"))]
pub mod x86;

#[cfg(not(any(luc_method = "raw", luc_method = "lzma")))]
pub mod cm;
#[cfg(not(any(luc_method = "raw", luc_method = "lzma")))]
pub mod logistic;
#[cfg(not(any(luc_method = "raw", luc_method = "cm")))]
pub mod lzma;
#[cfg(not(any(luc_method = "raw", luc_method = "lzma")))]
pub mod model;
