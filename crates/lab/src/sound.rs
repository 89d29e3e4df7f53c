//! The soundtrack in numbers: what a second costs, loudness and peaks, octaves of each part, loudness of each
//! bar. With WAV files of the whole tune the same of each, to compare with.

use luc::show::score::{SCORE, SECTIONS};
use luc_core::synth::stream::{Stream, Tune};
use luc_core::synth::{BAR, RATE, meter};
use std::time::Instant;

/// Hz between which levels are told.
const EDGES: [f32; 10] = [20.0, 60.0, 120.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0, 16_000.0];

/// `cargo lab sound [FILE.wav]...`
pub fn run(args: &[String]) -> Result<(), String> {
    let tune = Tune { score: &SCORE, sections: &SECTIONS };
    let mut samples = vec![[0.0; 2]; tune.samples() as usize];
    let start = Instant::now();
    let mut stream = Stream::new(tune, 0);
    println!("ready after {:.2} s", start.elapsed().as_secs_f64());
    let mut times = Vec::new();
    for block in samples.chunks_mut(RATE as usize) {
        let start = Instant::now();
        stream.render(block);
        times.push(1e3 * start.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    let seconds = times.len();
    println!("a second of sound: median {:.1} ms, most {:.1} ms", times[seconds / 2], times[seconds - 1]);
    table("the tune", &samples);
    for name in args {
        table(name, &read(name)?);
    }
    Ok(())
}

/// The samples of a WAV file of 16 bits and two channels.
fn read(name: &str) -> Result<Vec<[f32; 2]>, String> {
    let bytes = std::fs::read(name).map_err(|e| format!("{name}: {e}"))?;
    let half = |a: u8, b: u8| f32::from(i16::from_le_bytes([a, b])) / 32_767.0;
    let samples: Vec<_> =
        bytes.chunks_exact(4).skip(11).map(|f| [half(f[0], f[1]), half(f[2], f[3])]).collect();
    let bars: usize = SECTIONS.iter().map(|section| section.harmony.len()).sum();
    let whole = samples.len() == bars * BAR as usize;
    whole.then_some(samples).ok_or(format!("{name}: not {bars} bars"))
}

fn table(name: &str, samples: &[[f32; 2]]) {
    let peak = |value: f32| meter::decibels(f64::from(value * value));
    let highest = samples.as_flattened().iter().fold(0.0f32, |a, b| a.max(b.abs()));
    println!(
        "\n{name}: {:.2} LUFS, peak {:.2} dB, true peak {:.2} dB",
        meter::loudness(samples),
        peak(highest),
        peak(meter::true_peak(samples))
    );
    println!("part | LUFS | 20 60 120 250 500 1k 2k 4k 8k Hz: dB below the part's sum | -LUFS of its bars");
    let mut rest = samples;
    for (i, section) in SECTIONS.iter().enumerate() {
        let (part, after) = rest.split_at(section.harmony.len() * BAR as usize);
        let bands = meter::bands(part, &EDGES);
        let total: f64 = bands.iter().sum();
        print!("{i} | {:5.1} |", meter::loudness(part));
        for band in bands {
            print!(" {:3.0}", -meter::decibels(band / total));
        }
        print!(" |");
        for bar in part.chunks_exact(BAR as usize) {
            print!(" {:.1}", -meter::loudness(bar));
        }
        println!();
        rest = after;
    }
}
