//! The knobs of the study: what each trades, and the settings at which it is measured, all else as
//! in the preset `high`.

use super::knob::{BASE, Change, FULL_LIGHT, Knob, On, Setting, Truth, base};
use luc_core::quality::{Quality, Rung};
use luc_core::scene::Shading;
use luc_core::study::Study;

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
            (
                "edges",
                "Edge samples",
                "Additional samples of each quadrant of a pixel that lies towards an edge.",
            ),
            &[0, 1, 2, 4],
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
    use super::super::knob::MANY;
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
