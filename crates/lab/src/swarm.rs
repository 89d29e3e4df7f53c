//! The scene by which small lights are measured: a frame of Swarm, with some of its lights.

use luc::show;
use luc_core::scene::Scene;

/// A frame that shows much of the stream.
const FRAME: u64 = 900;

/// The scene with `count` small lights, spread over the stream, and without what is seen of them.
pub fn scene(count: usize) -> Scene {
    let part = show::PARTS.iter().find(|part| part.name == "swarm").expect("a part of the show");
    let mut scene = (part.scene)(FRAME);
    let all = std::mem::take(&mut scene.points);
    scene.points = (0..count).map(|i| all[i * all.len() / count]).collect();
    scene.beams.clear();
    scene
}
