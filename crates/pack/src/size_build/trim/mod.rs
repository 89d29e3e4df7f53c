//! The trimmed copies of dependencies.
//!
//! Made of the sources that cargo has downloaded, at build time. Every edit checks that it finds
//! what it was written for, so that a new version of a crate stops the build with a sentence
//! instead of going wrong.

pub mod crossbeam_deque;
pub mod minifb;
pub mod rayon_core;
pub mod x11_dl;

use super::edit::Source;
use crate::Error;

/// wide: every operation in line, as the single instruction that it is, and its constants as constants.
///
/// Compiling for size, the compiler would else call a function for a comparison of eight lanes, and write
/// the sign bits of a negation lane by lane in a loop.
pub fn wide(source: &mut Source) -> Result<(), Error> {
    source.replace_everywhere("#[inline]", "#[inline(always)]", "put its operations in line")?;
    for constant in ["Self::splat(-0.0)", "Self::splat(2147483648.0)", "u32x8::splat(1 << 31)"] {
        let made = format!("const {{ {constant} }}");
        source.replace_everywhere(constant, &made, "make its constants constant")?;
    }
    let mask = "f32::from_bits(i32::MAX as u32)";
    let made = format!("const {{ f32x8::splat({mask}) }}");
    source.replace_everywhere(&format!("f32x8::from({mask})"), &made, "make its constants constant")
}
