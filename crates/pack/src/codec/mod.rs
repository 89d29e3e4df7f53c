//! What packer and launcher share: the coders' decoding halves and everything they rest on.
//!
//! These files are compiled into the packer's library, and, without the standard library, into both parts of the
//! launcher in front of a packed program, that for AVX2 too. Whatever the packer assumes about the decoder therefore
//! is the decoder. Because of the launcher nothing here may panic, allocate, or call into a maths library: indices
//! are masked, checked with `get`, or within their table by a reason that stands with them, and floating point is
//! plain IEEE addition, multiplication and division, which give the same bits everywhere.

pub mod checksum;
pub mod filter;
pub mod format;
pub mod interval;
pub mod lanes;
pub mod logistic;
pub mod mixers;
pub mod slots;
pub mod small;
pub mod x86;

pub mod cm;
pub mod lzma;
pub mod model;
