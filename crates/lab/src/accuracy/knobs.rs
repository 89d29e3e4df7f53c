//! The knobs of the study: what each trades, and the settings at which it is measured, all else as
//! in the preset `high`.

use luc_core::math::lanes::F;
use luc_core::quality::{Quality, Rung};
use luc_core::scene::{Motion, Rules, Scene, Shading};
use luc_core::study::Study;
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

/// A knob that sets something of the quality to each of `values`.
fn turned<T: Copy>(
    (name, title, words): (&'static str, &'static str, &'static str),
    values: &[T],
    label: impl Fn(T) -> String,
    base_value: T,
    set: impl Fn(&mut Quality, T),
) -> Knob {
    let setting = |&value: &T| {
        let mut quality = base();
        set(&mut quality, value);
        Setting { label: label(value), quality, change: Change::None, scale: 1.0 }
    };
    Knob {
        name,
        title,
        words,
        settings: values.iter().map(setting).collect(),
        base: label(base_value),
        truth: Truth::Show,
        on: On::Show,
        samples: true,
    }
}

/// The six presets as positions of one knob.
fn presets() -> Knob {
    let setting = |&(name, quality): &(&str, Quality)| Setting {
        label: name.into(),
        quality,
        change: Change::None,
        scale: 1.0,
    };
    Knob {
        name: "preset",
        title: "Preset",
        words: "The six presets, each a position for all knobs together.",
        settings: Quality::PRESETS.iter().map(setting).collect(),
        base: BASE.into(),
        truth: Truth::Show,
        on: On::Show,
        samples: true,
    }
}

/// The knobs that decide how the picture is sampled.
fn sampling(b: &Quality) -> Vec<Knob> {
    let px = |v: u32| v.to_string();
    vec![
        turned(
            (
                "block",
                "Block size",
                "Side of the coarsest cell at 1080 lines, px; half of it up to 720 lines. 1 traces every pixel.",
            ),
            &[32, 16, 8, 1],
            px,
            b.block,
            |q, v| q.block = v,
        ),
        turned(
            (
                "tolerance",
                "Tolerance",
                "Largest error of an interpolated cell at its centre, as a share of display white.",
            ),
            &[0.16, 0.08, 0.04, 0.02, 0.01, 0.005, 0.0025],
            |v: f32| v.to_string(),
            b.tolerance,
            |q, v| q.tolerance = v,
        ),
        turned(
            (
                "centre",
                "Centre sample",
                "Whether a cell is checked, and bent, by a fifth sample in its centre; without it equal signatures at the corners suffice.",
            ),
            &[false, true],
            |v| if v { "on" } else { "off" }.into(),
            true,
            |q, v| q.study = Study { centre: v, ..Study::NONE },
        ),
        turned(
            (
                "smallest",
                "Smallest cell",
                "Side of the smallest cell, px: it is interpolated whatever its samples say. 1 refines to the pixel.",
            ),
            &[8, 4, 2, 1],
            px,
            b.smallest,
            |q, v| q.smallest = v,
        ),
        turned(
            (
                "rung",
                "What is interpolated",
                "Between samples: the colour; the light, with textures exact; or only mirrored and refracted light, with surface and direct light exact.",
            ),
            &[Rung::Colour, Rung::Light, Rung::Surface],
            |v| format!("{v:?}").to_lowercase(),
            b.rung,
            |q, v| q.rung = v,
        ),
        turned(
            ("edges", "Edge samples", "Additional samples of pixels that lie on an edge."),
            &[0, 1, 3, 7, 15],
            px,
            b.edge_samples,
            |q, v| q.edge_samples = v,
        ),
        turned(
            ("samples", "Samples of every pixel", "Additional samples of every pixel, edge or not."),
            &[0, 1, 3],
            px,
            b.samples,
            |q, v| q.samples = v,
        ),
        turned(
            ("average", "Patterns averaged", "Sample patterns of which a frame is the mean (--average)."),
            &[1, 2, 4, 8, 16],
            px,
            b.average,
            |q, v| q.average = v,
        ),
    ]
}

/// The knobs that decide how far rays go and how exactly they meet bodies.
fn tracing(b: &Quality) -> Vec<Knob> {
    let exact = |v: f32| v.to_string();
    vec![
        turned(
            (
                "depth",
                "Depth",
                "Longest chain of mirrors and refractions; after it the mean light stands for the rest.",
            ),
            &[0, 1, 2, 3, 5, 8],
            |v: u32| v.to_string(),
            b.depth,
            |q, v| q.depth = v,
        ),
        turned(
            (
                "cutoff",
                "Contribution cut-off",
                "Rays that can add no more than this share of display white are not followed.",
            ),
            &[0.3, 0.1, 0.05, 0.02, 0.005, 0.001],
            exact,
            b.cutoff,
            |q, v| q.cutoff = v,
        ),
        turned(
            (
                "epsilon",
                "Epsilon of fields",
                "How near to a field a marching ray must come to hit it, world units.",
            ),
            &[0.02, 0.005, 0.001, 0.0003, 0.0001],
            exact,
            b.epsilon,
            |q, v| q.epsilon = v,
        ),
        turned(
            (
                "steps",
                "Step bound of fields",
                "Most steps of a marching ray; one that is near a body by then has hit it.",
            ),
            &[12, 24, 48, 96, 128, 384],
            |v: u32| v.to_string(),
            b.steps,
            |q, v| q.steps = v,
        ),
        turned(
            (
                "pace",
                "Step factor of fields",
                "Share of the distance to the nearest body that a marching ray advances by; over 1 it may pass through thin ones.",
            ),
            &[1.6, 1.3, 1.0, 0.8, 0.5],
            exact,
            1.0,
            |q, v| q.study = Study { pace: v, ..Study::NONE },
        ),
        turned(
            (
                "cull",
                "Culling",
                "Whether shapes, lamps and occluders that a tile can't meet are left out. The picture is the same.",
            ),
            &[false, true],
            |v| if v { "on" } else { "off" }.into(),
            b.cull,
            |q, v| q.cull = v,
        ),
    ]
}

/// A knob that is measured only on some parts.
fn only(on: On, knob: Knob) -> Knob {
    Knob { on, ..knob }
}

/// The knobs of what only some parts have: soft shadows, the sight of smoke, and its motion.
fn special(b: &Quality) -> Vec<Knob> {
    let whole = |v: u32| v.to_string();
    let moving = |label: String, finer: f32, sweeps: u32| Setting {
        label,
        quality: base(),
        change: Change::Smoke(finer, sweeps),
        scale: 1.0,
    };
    let simulated = |name, title, words, settings: Vec<Setting>, base: &str| Knob {
        settings,
        base: base.into(),
        truth: Truth::Smoke,
        samples: false,
        ..only(On::Smoke, turned((name, title, words), &[], whole, 0, |_, _| {}))
    };
    vec![
        only(
            On::SoftLamps,
            turned(
                (
                    "shadow-samples",
                    "Shadow samples",
                    "Rays to a shining rectangle for its soft shadow; 1 casts a hard one.",
                ),
                &[1, 2, 4, 8, 16, 32],
                whole,
                b.shadow_samples,
                |q, v| q.shadow_samples = v,
            ),
        ),
        only(
            On::Smoke,
            turned(
                (
                    "smoke-step",
                    "Volume step",
                    "Length of the steps of rays through smoke, cells of its grid. Light has no step of its own: it goes through smoke with the steps of its motion.",
                ),
                &[4.0, 2.0, 1.5, 1.0, 0.5, 0.25],
                |v: f32| v.to_string(),
                b.smoke,
                |q, v| q.smoke = v,
            ),
        ),
        simulated(
            "smoke-grid",
            "Grid of smoke",
            "Cells along a side of the grid, as a share of the show's. Times are of the frame and half a step, since every other frame takes one. The truth has twice as many and twice the sweeps; turbulence drifts apart, so no picture comes very near to it.",
            [0.5, 0.75, 1.0, 1.33].map(|finer| moving(finer.to_string(), finer, SWEEPS)).into(),
            "1",
        ),
        simulated(
            "smoke-sweeps",
            "Sweeps of the pressure",
            "Jacobi sweeps by which a step takes divergence away, against the same truth.",
            [2, 4, 8, SWEEPS, 32].map(|sweeps| moving(sweeps.to_string(), 1.0, sweeps)).into(),
            &SWEEPS.to_string(),
        ),
    ]
}

/// Sweeps of the show's smoke.
const SWEEPS: u32 = 16;

/// A knob of light: all its settings show the scene under `change`.
fn of_light(knob: Knob, change: Change) -> Knob {
    let settings = knob.settings.into_iter().map(|s| Setting { change, ..s }).collect();
    Knob { settings, truth: Truth::Light, samples: false, ..knob }
}

/// The knobs of light and picture.
fn light(b: &Quality) -> Vec<Knob> {
    let whole = |v: u32| v.to_string();
    let model = |label: &str, shading, bounces, scatter, rough| Setting {
        label: label.into(),
        quality: Quality { scatter, rough, ..base() },
        change: Change::Shading(shading, bounces),
        scale: 1.0,
    };
    let octaves = |octaves: usize| Setting {
        label: octaves.to_string(),
        quality: Quality { study: Study { octaves, ..Study::NONE }, ..base() },
        change: Change::None,
        scale: 1.0,
    };
    let scaled =
        |scale: f32| Setting { label: scale.to_string(), quality: base(), change: Change::None, scale };
    let blank = |name, title, words| turned((name, title, words), &[], whole, 0, |_, _| {});
    vec![
        Knob {
            settings: vec![
                model("Phong", Shading::Phong, 0, 0, 0),
                model("Cook-Torrance", Shading::CookTorrance, 0, 0, 0),
                model("GGX", Shading::Ggx, 0, 0, 0),
                model("GGX, rough mirrors", Shading::Ggx, 0, 0, 4),
                model("GGX, two bounces", Shading::Ggx, 2, 4, 4),
            ],
            base: String::new(),
            truth: Truth::Light,
            samples: false,
            ..blank(
                "shading",
                "Shading model",
                "A ladder of reflection models, from Phong's to microfacets with drawn mirrors and bounces of diffuse light. The truth is its last rung at `reference`, whatever model the part uses.",
            )
        },
        of_light(
            turned(
                (
                    "scatter",
                    "Scatter samples",
                    "Rays of a bounce of diffuse light; 0 takes the ambient light. Measured under GGX with two bounces.",
                ),
                &[0, 1, 2, 4, 8],
                whole,
                b.scatter,
                |q, v| (q.scatter, q.rough) = (v, 4),
            ),
            FULL_LIGHT,
        ),
        of_light(
            turned(
                (
                    "rough",
                    "Rays of rough mirrors",
                    "Rays drawn for the mirror of a rough surface under GGX; 0 for one with a wide footprint.",
                ),
                &[0, 1, 2, 4, 8],
                whole,
                b.rough,
                |q, v| (q.rough, q.scatter) = (v, 4),
            ),
            FULL_LIGHT,
        ),
        Knob {
            settings: std::iter::once(Setting { label: "0".into(), change: Change::NoBloom, ..octaves(4) })
                .chain([2, 3, 4].map(octaves))
                .collect(),
            base: "4".into(),
            samples: false,
            ..blank("bloom", "Bloom levels", "Octaves of the glow around bright light.")
        },
        Knob {
            settings: [0.5, 0.67, 0.75, 1.0].map(scaled).into(),
            base: "1".into(),
            ..blank(
                "scale",
                "Resolution scale",
                "Side of the drawn picture over that of the shown one; it is scaled up bilinearly, as the player does.",
            )
        },
        Knob {
            on: On::Fireflies,
            samples: false,
            ..turned(
                (
                    "light-tile",
                    "Tile of light culling",
                    "Side of the tiles by which small lights are culled, px, in a scene of 256 fireflies. The picture is the same.",
                ),
                &[4, 8, 16, 32, 64],
                whole,
                b.light_tile,
                |q, v| q.light_tile = v,
            )
        },
    ]
}

/// All knobs, the presets first.
pub fn knobs() -> Vec<Knob> {
    let b = &base();
    let still = |knob| Knob { samples: false, ..knob };
    let of_fields = |knob: Knob| match knob.name {
        "epsilon" | "steps" | "pace" => only(On::Fields, knob),
        _ => knob,
    };
    let rays = tracing(b).into_iter().map(still).map(of_fields);
    std::iter::once(presets()).chain(sampling(b)).chain(rays).chain(light(b)).chain(special(b)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_base_is_a_position_of_every_knob_and_equals_the_preset_there() {
        for knob in knobs().iter().filter(|k| k.truth == Truth::Show) {
            let found: Vec<&Setting> = knob.settings.iter().filter(|s| s.label == knob.base).collect();
            assert_eq!(found.len(), 1, "{}: {:?}", knob.name, knob.base);
            assert_eq!(found[0].quality, base(), "{}", knob.name);
            assert!(found[0].change == Change::None && found[0].scale == 1.0, "{}", knob.name);
        }
    }

    #[test]
    fn a_finer_grid_fills_the_same_box_and_moves_alike() {
        let scene = |n| luc::show::PARTS.iter().find(|p| p.name == "smoke").map(|p| (p.scene)(n)).unwrap();
        let rules = |finer, sweeps| Change::Smoke(finer, sweeps).of(scene(300)).smoke.unwrap().rules;
        let own = scene(300).smoke.unwrap().rules;
        assert_eq!((own.air.sweeps, rules(1.0, SWEEPS).size), (SWEEPS, own.size));
        let fine = rules(2.0, MANY);
        assert_eq!(fine.size, own.size.map(|n| 2 * n));
        assert_eq!((fine.hi() - fine.lo, fine.air.sweeps), (own.hi() - own.lo, MANY));
        assert_eq!(fine.air.by_heat[1], 2.0 * own.air.by_heat[1]);
        assert!(std::ptr::eq(fine, rules(2.0, MANY)), "the same rules, so that the simulation goes on");
        let coarse = rules(0.75, SWEEPS);
        assert!(coarse.size[0] % 8 == 0 && (coarse.hi() - own.hi()).min_element() > -1e-4);
    }

    #[test]
    fn names_and_labels_fit_a_table() {
        for knob in knobs() {
            assert!(knob.name.bytes().all(|c| c.is_ascii_lowercase() || c == b'-'), "{}", knob.name);
            for setting in &knob.settings {
                assert!(!setting.label.contains('"'), "{}", setting.label);
            }
        }
    }
}
