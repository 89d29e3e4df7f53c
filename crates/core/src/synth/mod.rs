//! The synthesizer: a score in, stereo samples out, the same bits on every machine.
//!
//! How sound flows, in the order of the modules: a [`score`] of sections, rows and patterns is read
//! sixteenth by sixteenth into notes; an [`instrument`] is a row of 28 numbers; every copy of an
//! oscillator is a lane of a packet of [`voice`]s; their sums go through the [`effects`]; a
//! [`stream`] does all of it from any sample on, in blocks of any size. [`track`] tells pictures
//! when an instrument strikes, [`meter`] measures what came out.
//!
//! A sample is made of the operations that pixels are made of (see [`math`](crate::math)), in f32
//! and in a fixed order: nothing depends on how the stream is cut into blocks.

pub mod effects;
pub mod instrument;
pub mod meter;
pub mod score;
pub mod stream;
pub mod track;
pub mod voice;

/// Samples a second, of each of the two channels.
pub const RATE: u32 = 44_100;

/// Samples of a bar: four beats at 120 a minute.
pub const BAR: u32 = 2 * RATE;

/// Sixteenths of a bar.
pub const STEPS: u32 = 16;

/// The sample at which sixteenth `step` begins; sixteenths are 5512.5 samples.
pub const fn sample_of(step: u32) -> u32 {
    (step * (BAR / 8)) >> 1
}

/// A sample as 16 bits, rounded to the nearest.
///
/// Without dither: it would put noise where silence is written, and music as dense as what is
/// rounded here has no error that follows it audibly.
pub fn pcm(sample: f32) -> i16 {
    (sample * 32_767.0 + 0.5).floor() as i16
}
