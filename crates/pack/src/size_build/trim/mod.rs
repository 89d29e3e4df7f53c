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

/// wide: every operation in line, as the single instruction that it is.
///
/// Compiling for size, the compiler would else call a function for a comparison of eight lanes.
pub fn wide(source: &mut Source) -> Result<(), Error> {
    source.replace_everywhere("#[inline]", "#[inline(always)]", "put its operations in line")
}
