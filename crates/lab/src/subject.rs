//! What the lab draws: the parts of the show, and one of them with fewer small lights.

use crate::swarm;
use luc::show;
use luc_core::quality::Quality;
use luc_core::render::Renderer;
use luc_core::scene::Scene;

/// A scene over time.
#[derive(Clone, Copy)]
pub struct Subject {
    /// Name in tables.
    pub name: &'static str,
    /// Length in frames.
    pub frames: u64,
    /// The scene at a frame.
    pub scene: fn(u64) -> Scene,
}

impl Subject {
    /// The parts of the show, in its order.
    pub fn show() -> Vec<Subject> {
        let subject = |p: &show::Part| Subject { name: p.name, frames: p.frames, scene: p.scene };
        show::PARTS.iter().map(subject).collect()
    }

    /// Half of Swarm's small lights; it stands still.
    pub fn fireflies() -> Subject {
        Subject { name: "fireflies", frames: 1, scene: |_| swarm::scene(256) }
    }

    /// The scene at frame `n` as it is measured: without what shows the sampling, and
    /// without grain, which is the same in all pictures.
    pub fn bare(&self, n: u64) -> Scene {
        let mut scene = (self.scene)(n);
        scene.overlay = 0.0;
        scene.light_count = 0.0;
        scene.split = None;
        scene.effects.clear();
        scene.grade.grain = 0.0;
        scene
    }

    /// Brings a renderer to where it is before frame `n` of a playing show: smoke has a step to go.
    pub fn lead(&self, renderer: &mut Renderer, n: u64) {
        let scene = (self.scene)(n.saturating_sub(2));
        if scene.smoke.is_some() {
            let counters = renderer.counters;
            renderer.frame(&scene, n, (8, 8), &Quality::PRESETS[0].1, &mut [0; 64]);
            renderer.counters = counters;
        }
    }

    /// `count` frames spread evenly over it.
    pub fn spread(&self, count: u64) -> impl Iterator<Item = u64> + use<> {
        let (count, frames) = (count.min(self.frames), self.frames);
        (0..count).map(move |k| frames * (2 * k + 1) / (2 * count))
    }
}
