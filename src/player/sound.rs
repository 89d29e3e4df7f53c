//! Live sound: one thread that renders ahead of the card and tells the picture's clock what has been
//! heard.

use super::alsa::{Device, start_thread};
use super::complain;
use super::stage::Stage;
use super::text::join;
use super::time::{MILLISECOND, now, sleep};
use luc::show;
use luc_core::synth::stream::Stream;
use luc_core::synth::{RATE, pcm};

/// Samples written at once; 12 ms.
const BLOCK: usize = 512;
/// Samples over which the very first ones come in; 10 ms.
const FADE: u64 = RATE as u64 / 100;
/// Samples that may be ahead of what is heard: more than a card holds, so only devices that swallow all
/// at once, such as files, are held back by it.
const AHEAD: u64 = RATE as u64;

/// Starts the sound of what `stage` plays. Where there can be none, that is said once, and the show goes
/// on by the monotonic clock.
pub fn start(stage: &'static Stage) {
    stage.pace.set_silent(false);
    if !start_thread(stage) {
        stage.pace.set_silent(true);
    }
}

/// What the thread does.
pub fn perform(stage: &Stage) {
    if let Err(reason) = play(stage) {
        complain(&join(&[reason, b"; playing silent"]));
    }
    stage.pace.set_silent(true);
}

/// Plays until the show is over.
fn play(stage: &Stage) -> Result<(), &'static [u8]> {
    let mut device = Device::open()?;
    let (sections, first, count) = stage.stretch();
    let mut stream = Stream::new(show::tune(sections), (first * show::SAMPLES) as u32);
    while !stage.is_prepared() {
        sleep(MILLISECOND);
    }
    let total = count.map_or(u64::MAX, |frames| frames * show::SAMPLES);
    let begun = now();
    let mut written = 0;
    while written < total {
        // No card is a thousandth too fast; a file takes what it is given.
        let passed = (now() - begun) / 1000 * u64::from(RATE) / 999_000;
        let heard = (written - device.delay().min(written)).min(passed);
        stage.pace.hear(heard);
        if written - heard > AHEAD {
            sleep(5 * MILLISECOND);
            continue;
        }
        let mut block = [[0.0; 2]; BLOCK];
        let mut samples = [[0; 2]; BLOCK];
        let count = (total - written).min(BLOCK as u64) as usize;
        stream.render(&mut block[..count]);
        for (to, from) in samples.iter_mut().zip(block) {
            let gain = written.min(FADE) as f32 / FADE as f32;
            *to = from.map(|value| pcm(value * gain));
            written += 1;
        }
        written -= (BLOCK - count) as u64;
        if !device.write(&samples[..count]) {
            return Err(b"no sound any more: the sound card is gone");
        }
    }
    device.finish();
    Ok(())
}
