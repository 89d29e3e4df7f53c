//! `lab values`: whether frames have their one value in this build, on any number of threads.
//!
//! The table `tests/golden/values.txt` has a line per frame: part and local frame, preset, size, FNV-1a of the
//! pixels. `tests/matrix.sh` runs this in builds for other processors and with other flags; the test
//! suite itself compares the same table.

use luc::show;
use luc_core::math::fingerprint::Fingerprint;
use luc_core::quality::Quality;
use luc_core::render::Renderer;

/// Numbers of threads that each frame is rendered on.
const THREADS: [usize; 4] = [1, 2, 3, 8];

/// Number of the show's frame, quality, size and value of a line.
fn parse(line: &str) -> Option<(u64, Quality, (u32, u32), u64)> {
    let fields: Vec<&str> = line.split(' ').collect();
    let [frame, quality, size, value] = fields[..] else { return None };
    let (part, local) = frame.rsplit_once('-')?;
    let index = show::PARTS.iter().position(|p| p.name == part)?;
    let (width, height) = size.split_once('x')?;
    Some((
        show::start(index) + local.parse::<u64>().ok()?,
        Quality::named(quality)?,
        (width.parse().ok()?, height.parse().ok()?),
        u64::from_str_radix(value, 16).ok()?,
    ))
}

/// Runs the command with the arguments after `values`: a table, or the kept one.
pub fn run(args: &[String]) -> Result<(), String> {
    let kept = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/values.txt");
    let path = args.first().map_or(kept, String::as_str);
    let table = std::fs::read_to_string(path).map_err(|e| format!("{path}: {e}"))?;
    let mut wrong = 0;
    for line in table.lines() {
        let (n, quality, size, value) = parse(line).ok_or(format!("no frame of the show: {line}"))?;
        for threads in THREADS {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let pool = pool.map_err(|e| e.to_string())?;
            let mut pixels = vec![0; (size.0 * size.1) as usize];
            pool.install(|| show::frame(&mut Renderer::default(), n, size, &quality, &mut pixels));
            let found = Fingerprint::of_pixels(&pixels);
            if found != value {
                println!("{line}: {found:016x} on {threads} threads");
                wrong += 1;
            }
        }
    }
    if wrong > 0 {
        return Err(format!("{wrong} pictures differ from {path}"));
    }
    println!("{} frames have their value on {THREADS:?} threads", table.lines().count());
    Ok(())
}
