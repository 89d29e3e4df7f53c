//! The frames whose pixels are kept as files, and where.

use super::picture::Picture;
use luc::show;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use std::path::PathBuf;

/// Size of the kept pictures.
pub const SIZE: (u32, u32) = (320, 180);

/// Part and local frame of the kept pictures.
pub const FRAMES: [(&str, u64); 32] = [
    ("blobs", 0),     // the drop: the lattice closed
    ("blobs", 400),   // satellites fly
    ("blobs", 1199),  // last frame
    ("luc", 36),      // the beam comes out of the dark
    ("luc", 285),     // the second letter catches fire
    ("luc", 719),     // last frame: all lit
    ("mirror", 0),    // first frame: all at rest
    ("mirror", 495),  // the ball at its highest
    ("mirror", 600),  // the cone sinks alone
    ("mirror", 765),  // the camera farthest left
    ("mirror", 1275), // the camera farthest right
    ("mirror", 1919), // last frame
    ("gold", 0),      // first frame
    ("gold", 375),    // the large sphere at its highest
    ("gold", 525),    // the large sphere at its lowest
    ("gold", 855),    // the camera at its lowest
    ("gold", 1695),   // the overlay half way across
    ("gold", 1919),   // last frame: all under the overlay
    ("facets", 0),    // first frame: the rose and the first crystals
    ("facets", 300),  // bays grow
    ("facets", 640),  // all has grown, in shafts of light
    ("facets", 1439), // last frame: the vault
    ("end", 0),       // first frame: no words yet
    ("end", 320),     // all words
    ("end", 479),     // last frame, which Lúč's first follows
    ("smoke", 0),     // the house before the fire
    ("cost", 0),      // first frame: nearly all traced
    ("cost", 719),    // last frame: half and half
    ("smoke", 421),   // between two steps: the first smoke
    ("swarm", 0),     // first frame: in the nave
    ("swarm", 560),   // before the ruin
    ("swarm", 1020),  // the tiles with their lights
];

/// Part, local frame, preset, size.
pub type Frame = (&'static str, u64, &'static str, (u32, u32));

/// Frames whose fingerprints are kept.
pub const FINGERPRINTS: [Frame; 36] = [
    ("blobs", 12, "draft", (333, 187)),
    ("blobs", 700, "medium", (320, 180)),
    ("blobs", 950, "ultra", (320, 180)),
    ("luc", 100, "draft", (333, 187)),
    ("luc", 400, "medium", (320, 180)),
    ("luc", 600, "ultra", (320, 180)),
    ("mirror", 37, "draft", (320, 180)),
    ("mirror", 301, "low", (333, 187)),
    ("mirror", 704, "medium", (320, 180)),
    ("mirror", 1111, "high", (640, 360)),
    ("mirror", 1500, "ultra", (333, 187)),
    ("mirror", 1918, "reference", (96, 54)),
    ("gold", 1, "draft", (320, 180)),
    ("gold", 444, "low", (333, 187)),
    ("gold", 777, "medium", (320, 180)),
    ("gold", 1234, "high", (640, 360)),
    ("gold", 1699, "ultra", (333, 187)),
    ("gold", 1800, "reference", (96, 54)),
    ("end", 240, "draft", (333, 187)),
    ("end", 400, "ultra", (320, 180)),
    ("facets", 150, "draft", (333, 187)),
    ("facets", 480, "medium", (320, 180)),
    ("facets", 900, "ultra", (320, 180)),
    ("facets", 1200, "reference", (96, 54)),
    ("cost", 100, "draft", (333, 187)),
    ("cost", 300, "medium", (320, 180)),
    ("cost", 480, "ultra", (320, 180)),
    ("cost", 600, "reference", (96, 54)),
    ("smoke", 300, "ultra", (320, 180)),
    ("smoke", 420, "reference", (96, 54)),
    ("smoke", 700, "medium", (320, 180)),
    ("smoke", 1439, "draft", (333, 187)),
    ("swarm", 150, "draft", (333, 187)),
    ("swarm", 480, "medium", (320, 180)),
    ("swarm", 900, "ultra", (320, 180)),
    ("swarm", 1199, "reference", (96, 54)),
];

/// Part and local frame of those whose value is kept for all builds, in `values.txt`.
pub const VALUES: [(&str, u64); 20] = [
    ("blobs", 200),
    ("blobs", 600),
    ("blobs", 1000),
    ("luc", 120),
    ("luc", 360),
    ("luc", 600),
    ("mirror", 240),
    ("mirror", 960),
    ("mirror", 1680),
    ("gold", 240),
    ("gold", 720),
    ("gold", 1680),
    ("facets", 180),
    ("facets", 720),
    ("facets", 1260),
    ("end", 240),
    ("cost", 400),
    ("smoke", 180),
    ("swarm", 300),
    ("swarm", 960),
];

/// Size of those.
pub const VALUE_SIZE: (u32, u32) = (480, 270);

/// Where the pictures and `fingerprints.txt` are kept.
pub fn directory() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden"))
}

/// Name of a frame: part and local frame.
pub fn name(part: &str, frame: u64) -> String {
    format!("{part}-{frame:04}")
}

/// Where the picture of a frame is kept.
pub fn path(part: &str, frame: u64) -> PathBuf {
    directory().join(name(part, frame) + ".png")
}

/// One line of `fingerprints.txt` or `values.txt`.
pub fn line((part, frame, preset, (width, height)): Frame, print: u64) -> String {
    format!("{} {preset} {width}x{height} {print:016x}\n", name(part, frame))
}

/// Frame of the whole show that shows a part's local frame.
pub fn global(part: &str, frame: u64) -> u64 {
    let index = show::PARTS.iter().position(|p| p.name == part).expect("a part of the show");
    show::start(index) + frame
}

/// Renders a part's local frame in this process.
pub fn render(part: &str, frame: u64, preset: &str, (width, height): (u32, u32)) -> Picture {
    let mut pixels = vec![0; (width * height) as usize];
    let quality = Quality::named(preset).expect("a preset's name");
    show::frame(&mut Renderer::default(), global(part, frame), (width, height), &quality, &mut pixels);
    Picture { width, height, pixels }
}

/// The command that writes a frame as a picture, for the message of a test that fails.
pub fn replay(part: &str, frame: u64, preset: &str, (width, height): (u32, u32)) -> String {
    let default = Quality::PRESETS[Quality::DEFAULT].0;
    let quality = if preset == default { String::new() } else { format!(" --quality {preset}") };
    format!("cargo run --release -- --scene {part} --frame {frame} --size {width}x{height}{quality} -o x.png")
}
