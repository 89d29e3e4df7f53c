//! A knob of the study: its settings, what each changes in quality or scene, and the truth it is held against.

use luc_core::math::lanes::F;
use luc_core::quality::Quality;
use luc_core::scene::{Motion, Rules, Scene, Shading};
use std::sync::Mutex;

/// The preset from which each knob is turned.
pub const BASE: &str = "high";

/// What a setting changes in the scene.
#[derive(Clone, Copy, PartialEq)]
pub enum Change {
    /// Nothing.
    None,
    /// Another reflection model, and how often diffuse light bounces.
    Shading(Shading, u32),
    /// No bloom.
    NoBloom,
    /// Smoke on a grid of so many times as many cells along each side, with so many sweeps of the pressure.
    Smoke(f32, u32),
}

/// Which picture is the truth for a knob.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Truth {
    /// The part as it is.
    Show,
    /// The part under microfacets with two bounces of diffuse light.
    Light,
    /// The part at the quality of [`BASE`], its smoke on a grid twice as fine with [`MANY`] sweeps.
    Smoke,
}

impl Truth {
    /// All truths, in the order of their numbers.
    pub const ALL: [Truth; 3] = [Truth::Show, Truth::Light, Truth::Smoke];
}

/// What a knob is measured on.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum On {
    /// All parts of the show.
    Show,
    /// Parts with fields.
    Fields,
    /// Parts whose lamps cast soft shadows.
    SoftLamps,
    /// Parts with smoke.
    Smoke,
    /// The scene of small lights.
    Fireflies,
}

impl On {
    /// Whether it means a scene of the show.
    pub fn means(self, scene: &Scene) -> bool {
        match self {
            On::Show => true,
            On::Fields => !scene.fields.is_empty(),
            On::SoftLamps => scene.soft && !scene.emitters.is_empty(),
            On::Smoke => scene.smoke.is_some(),
            On::Fireflies => false,
        }
    }

    /// Which parts those are, for people.
    pub fn words(self) -> &'static str {
        match self {
            On::Show | On::Fireflies => "",
            On::Fields => "Measured on the parts that have fields.",
            On::SoftLamps => "Measured on the part with soft shadows.",
            On::Smoke => "Measured on the part with smoke.",
        }
    }
}

/// One position of a knob.
pub struct Setting {
    /// As it stands in tables and plots.
    pub label: String,
    /// How well to draw.
    pub quality: Quality,
    /// What to draw.
    pub change: Change,
    /// Side of the drawn picture over that of the shown one, at most 1.
    pub scale: f32,
}

/// A knob.
pub struct Knob {
    /// Name in files.
    pub name: &'static str,
    /// Name for people.
    pub title: &'static str,
    /// What it trades.
    pub words: &'static str,
    /// Its positions, from fast to exact where that is known.
    pub settings: Vec<Setting>,
    /// Label of its position in the preset [`BASE`].
    pub base: String,
    /// What it is compared to.
    pub truth: Truth,
    /// Where it is measured.
    pub on: On,
    /// Whether it acts on sampling: then flicker is measured, and the error of sampling alone.
    pub samples: bool,
}

/// The base quality.
pub fn base() -> Quality {
    Quality::named(BASE).unwrap_or(Quality::PRESETS[Quality::DEFAULT].1)
}

/// A scene under another reflection model. Materials made for microfacets get the exponent of about
/// the same highlight, 2/m² - 2 (Lafortune and Willems 1994), and materials for Phong keep theirs.
fn shaded(mut scene: Scene, shading: Shading, bounces: u32) -> Scene {
    for material in &mut scene.materials {
        if scene.shading != Shading::Phong {
            let m = material.roughness.max(0.02);
            material.exponent = (2.0 / (m * m) - 2.0).max(1.0);
        }
    }
    Scene { shading, bounces, rough: true, ..scene }
}

/// Sweeps of the pressure in the truth of smoke.
pub const MANY: u32 = 32;

/// Rules on a finer or coarser grid over the same box, made once, since a simulation goes on only where it
/// finds the same rules.
fn gridded(rules: &'static Rules, finer: f32, sweeps: u32) -> &'static Rules {
    static MADE: Mutex<Vec<(f32, u32, &'static Rules)>> = Mutex::new(Vec::new());
    let mut made = MADE.lock().unwrap_or_else(|e| e.into_inner());
    if let Some(&(.., rules)) = made.iter().find(|m| (m.0, m.1) == (finer, sweeps)) {
        return rules;
    }
    let cells = |n: usize, multiple: usize| ((n as f32 * finer).ceil() as usize).next_multiple_of(multiple);
    let [x, y, z] = rules.size;
    // Accelerations are in cells.
    let times = |values: [f32; 8]| (F::new(values) * F::splat(finer)).to_array();
    let air = Motion {
        by_density: times(rules.air.by_density),
        by_heat: times(rules.air.by_heat),
        sweeps,
        ..rules.air
    };
    let size = [cells(x, 8), cells(y, 1), cells(z, 1)];
    let rules = Box::leak(Box::new(Rules { cell: rules.cell / finer, size, air, ..*rules }));
    made.push((finer, sweeps, rules));
    rules
}

/// The light that the truth of shading has.
pub const FULL_LIGHT: Change = Change::Shading(Shading::Ggx, 2);

impl Change {
    /// The scene as changed.
    pub fn of(self, mut scene: Scene) -> Scene {
        match self {
            Change::None => {}
            Change::Shading(shading, bounces) => scene = shaded(scene, shading, bounces),
            Change::NoBloom => scene.grade.bloom = 0.0,
            Change::Smoke(finer, sweeps) => {
                if let Some(smoke) = &mut scene.smoke {
                    smoke.rules = gridded(smoke.rules, finer, sweeps);
                }
            }
        }
        scene
    }
}
