use super::*;
use crate::math::Vec3;
use crate::math::hash::unit;
use crate::sample::{self, Record, TILE};
use crate::scene::Place;
use glam::Vec2;

/// A size that is no multiple of anything, higher than one strip.
const SIZE: [usize; 2] = [83, 41];

/// Each effect once, strong enough to be seen.
const KINDS: [Kind; 12] = [
    Kind::Contrast(1.7),
    Kind::Tint { colour: Vec3::new(1.0, 0.6, 0.2), strength: 0.7 },
    Kind::Bloom { threshold: 0.6, intensity: 0.8 },
    Kind::WideBloom { threshold: 0.6, intensity: 0.8, octaves: 4 },
    Kind::Sharpness(1.5),
    Kind::Levels(Vec3::new(4.0, 3.0, 5.0)),
    Kind::Fringes(0.03),
    Kind::Edges { strength: 4.0, colour: Vec3::new(0.3, 0.5, 0.9) },
    Kind::Lighten(0.3),
    Kind::Tube { base: 0.5, glow: 0.6, radius: 0.9 },
    Kind::Grain(0.1),
    Kind::Cells { shade: 0.6, colour: Vec3::new(0.07, 0.06, 0.18) },
];

/// A chain with a picture of values.
fn with(value: impl Fn(usize, usize) -> Vec3 + Sync) -> Chain {
    let mut chain = Chain::default();
    chain.fill(SIZE, &|x: usize, y: usize| V3::from_fn(|lane| value(x + lane, y)));
    chain
}

/// Noise with bright dots.
fn noisy(x: usize, y: usize) -> Vec3 {
    let value = |k: u32| unit(hash2((3 * x) as u32 + k, y as u32));
    Vec3::new(value(0), value(1), value(2)) * if (x + y).is_multiple_of(7) { 1.0 } else { 0.5 }
}

/// How the pixels were got: on the left filled in cells of 8 px over traced ones, on the right interpolated
/// in cells of 2 px over such of 16.
fn record(x: usize, y: usize) -> Record {
    match (x < TILE, y < TILE / 4) {
        (true, true) => Record::new(sample::Kind::Filled, 8),
        (true, false) => Record::new(sample::Kind::Traced, 8),
        (false, true) => Record::new(sample::Kind::Interpolated, 2),
        (false, false) => Record::new(sample::Kind::Interpolated, 16),
    }
}

fn run(chain: &mut Chain, effects: &[Effect]) {
    let tile = |left: usize| {
        let mut tile = Tile::default();
        for (i, found) in tile.record.iter_mut().enumerate() {
            *found = record(left + i % TILE, i / TILE);
        }
        tile
    };
    chain.run(effects, &[tile(0), tile(TILE)], 5, &mut Counters::default());
}

fn pixel(chain: &Chain, x: usize, y: usize) -> Vec3 {
    let picture = &chain.picture;
    Vec3::from(std::array::from_fn(|k| picture.light[picture.at(x, y) + k * picture.stride()]))
}

/// All pixels as bits.
fn bits(chain: &Chain) -> Vec<[u32; 3]> {
    let places = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
    places.map(|(x, y)| pixel(chain, x, y).to_array().map(f32::to_bits)).collect()
}

/// The result of effects on the noise.
fn of(effects: &[Effect]) -> Vec<[u32; 3]> {
    let mut chain = with(noisy);
    run(&mut chain, effects);
    bits(&chain)
}

#[test]
fn no_amount_and_no_pass_are_the_identity_bit_for_bit() {
    let before = bits(&with(noisy));
    for kind in KINDS {
        for off in [
            Effect { amount: 0.0, ..Effect::new(kind) },
            Effect { amount: -0.0, ..Effect::new(kind) },
            Effect { multipass: 0, ..Effect::new(kind) },
        ] {
            assert!(of(&[off]) == before, "{off:?}");
        }
        assert!(of(&[Effect::new(kind)]) != before, "{kind:?} does something");
    }
}

#[test]
fn three_passes_are_three_times_one_pass() {
    for kind in KINDS {
        let one = Effect { amount: 0.75, ..Effect::new(kind) };
        assert!(of(&[Effect { multipass: 3, ..one }]) == of(&[one, one, one]), "{kind:?}");
    }
}

#[test]
fn the_order_of_effects_is_the_order_in_the_list() {
    let [a, b] = [Effect::new(KINDS[0]), Effect::new(KINDS[5])];
    assert!(of(&[a, b]) != of(&[b, a]));
}

#[test]
fn the_amount_mixes_the_effect_with_what_it_was_applied_to() {
    for kind in KINDS {
        let (before, all) = (bits(&with(noisy)), of(&[Effect::new(kind)]));
        let some = of(&[Effect { amount: 0.25, ..Effect::new(kind) }]);
        for ((before, all), some) in before.iter().zip(all).zip(some) {
            for k in 0..3 {
                let [b, a, s] = [before[k], all[k], some[k]].map(f32::from_bits);
                assert!((b + (a - b) * 0.25 - s).abs() < 1e-6, "{kind:?}: {b} and {a} give {s}");
            }
        }
    }
}

#[test]
fn threads_make_no_difference() {
    let all = KINDS.map(Effect::new);
    let in_threads = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| of(&all))
    };
    assert!(in_threads(1) == in_threads(3));
}

#[test]
fn outside_of_its_place_an_effect_changes_nothing() {
    let right = Place { normal: Vec2::X, from: 0.0, over: 0.02 };
    for kind in KINDS {
        let mut chain = with(noisy);
        run(&mut chain, &[Effect { place: right, ..Effect::new(kind) }]);
        for (y, x) in (0..SIZE[1]).flat_map(|y| (0..SIZE[0] / 2).map(move |x| (y, x))) {
            assert_eq!(pixel(&chain, x, y), noisy(x, y), "{kind:?} at ({x}, {y})");
        }
    }
}

/// Contrast, tint and all that looks at neighbours leave an even picture even.
#[test]
fn a_constant_picture_stays_constant() {
    for kind in &KINDS[..9] {
        let mut chain = with(|_, _| Vec3::new(0.7, 0.65, 0.2));
        run(&mut chain, &[Effect::new(*kind)]);
        let first = pixel(&chain, 0, 0);
        for (y, x) in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (y, x))) {
            let off = (pixel(&chain, x, y) - first).abs().max_element();
            // The sums of a blur are rounded in other places.
            assert!(off <= 4.0 * f32::EPSILON, "{kind:?}: off by {off} at ({x}, {y})");
        }
        // Those that look for differences find none.
        if matches!(kind, Kind::Sharpness(_) | Kind::Fringes(_) | Kind::Edges { .. }) {
            assert!((first - Vec3::new(0.7, 0.65, 0.2)).abs().max_element() < 1e-6, "{kind:?}: {first}");
        }
    }
}

#[test]
fn bloom_adds_at_most_its_intensity() {
    for octaves in 1..=4 {
        let kind = if octaves == 1 {
            Kind::Bloom { threshold: 0.2, intensity: 0.5 }
        } else {
            Kind::WideBloom { threshold: 0.2, intensity: 0.5, octaves }
        };
        // A spot in the middle, the rest black: what is added is at most half of the spot, all in all.
        let spot = |x: usize, y: usize| {
            if (40..44).contains(&x) && (18..22).contains(&y) { Vec3::new(1.0, 0.9, 0.7) } else { Vec3::ZERO }
        };
        let mut chain = with(spot);
        run(&mut chain, &[Effect::new(kind)]);
        let (mut sum, mut light) = (0.0, 0.0);
        for (y, x) in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (y, x))) {
            let add = pixel(&chain, x, y) - spot(x, y);
            assert!(add.min_element() >= -1e-6 && add.max_element() <= 0.5, "{octaves} octaves add {add}");
            sum += f64::from(add.element_sum());
            light += f64::from(spot(x, y).element_sum());
        }
        assert!(sum > 0.05 * light && sum <= 0.5001 * light, "{octaves} octaves: {sum} of {light}");
    }
}

/// What an effect may look at around a pixel, px.
fn reach(kind: &Kind) -> usize {
    match kind {
        Kind::Sharpness(_) | Kind::Edges { .. } => 1,
        Kind::Fringes(_) => 4,
        Kind::Bloom { .. } | Kind::WideBloom { .. } => usize::MAX,
        _ => 0,
    }
}

#[test]
fn nan_and_infinities_do_not_spread() {
    let at = (20, 17);
    for kind in KINDS {
        for (bad, counts_as) in [(f32::NAN, 0.0), (f32::NEG_INFINITY, 0.0), (f32::INFINITY, 12.0)] {
            let value = |v: f32| move |x, y| if (x, y) == at { Vec3::splat(v) } else { noisy(x, y) };
            let (mut chain, mut clean) = (with(value(bad)), with(value(counts_as)));
            run(&mut chain, &[Effect::new(kind)]);
            run(&mut clean, &[Effect::new(kind)]);
            assert!(bits(&chain) == bits(&clean), "{kind:?}: {bad} counts as {counts_as}");
            let without = of(&[Effect::new(kind)]);
            for (i, (&with, without)) in bits(&chain).iter().zip(without).enumerate() {
                let far = (i % SIZE[0]).abs_diff(at.0).max((i / SIZE[0]).abs_diff(at.1));
                let finite = with.iter().all(|&v| f32::from_bits(v).is_finite());
                assert!(finite, "{kind:?}: {bad} gives {with:?} {far} px away");
                assert!(far <= reach(&kind) || with == without, "{kind:?}: {bad} is seen {far} px away");
            }
        }
    }
}

#[test]
fn effects_do_what_their_formulas_say() {
    let f64s = |x: usize, y: usize| noisy(x.min(SIZE[0] - 1), y.min(SIZE[1] - 1)).as_dvec3();
    let weights = glam::DVec3::new(0.2126, 0.7152, 0.0722);
    let near = |x: usize, y: usize, dx: usize, dy: usize| f64s((x + dx).max(1) - 1, (y + dy).max(1) - 1);
    for kind in KINDS {
        let mut chain = with(noisy);
        run(&mut chain, &[Effect::new(kind)]);
        for (y, x) in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (y, x))) {
            let v = f64s(x, y);
            let expected = match kind {
                Kind::Contrast(gain) => (v - 0.5) * f64::from(gain) + 0.5,
                Kind::Tint { colour, strength } => {
                    v.lerp(colour.as_dvec3() * v.dot(weights), strength.into())
                }
                Kind::Sharpness(gain) => {
                    let mean =
                        (near(x, y, 0, 1) + near(x, y, 2, 1) + near(x, y, 1, 0) + near(x, y, 1, 2)) / 4.0;
                    v + (v - mean) * f64::from(gain)
                }
                Kind::Edges { strength, colour } => {
                    let (mut across, mut down) = (0.0, 0.0);
                    for (i, j) in (0..9).map(|k| (k % 3, k / 3)) {
                        let l = near(x, y, i, j).dot(weights);
                        let weight = [1.0, 2.0, 1.0];
                        across += l * weight[j] * (i as f64 - 1.0);
                        down += l * weight[i] * (j as f64 - 1.0);
                    }
                    let step = (across * across + down * down).sqrt() / 4.0 * f64::from(strength);
                    v + colour.as_dvec3() * step.min(1.0)
                }
                Kind::Lighten(share) => v.lerp(glam::DVec3::ONE, share.into()),
                Kind::Fringes(shift) => {
                    // Where a colour is read, from the middle of the picture on, and what lies there.
                    let read = |share: f64, colour: usize| {
                        let place = |p: usize, size: usize| {
                            let half = size as f64 / 2.0;
                            ((p as f64 + 0.5 - half) * share + half - 0.5).clamp(0.0, size as f64 - 1.0)
                        };
                        let (u, v) = (place(x, SIZE[0]), place(y, SIZE[1]));
                        let (i, j) = (u as usize, v as usize);
                        let row =
                            |j| f64s(i, j)[colour] * (1.0 - u.fract()) + f64s(i + 1, j)[colour] * u.fract();
                        row(j) * (1.0 - v.fract()) + row(j + 1) * v.fract()
                    };
                    let shift = f64::from(shift);
                    glam::DVec3::new(read(1.0 - shift, 0), v.y, read(1.0 + shift, 2))
                }
                Kind::Tube { base, glow, radius } => {
                    let [px, py] =
                        [(x, SIZE[0]), (y, SIZE[1])].map(|(p, n)| (2 * p + 1) as f64 / n as f64 - 1.0);
                    let radius = f64::from(radius);
                    let far = (px * px + py * py) / (2.0 * radius * radius);
                    v * (f64::from(base) + f64::from(glow) * (1.0 - far).max(0.0))
                }
                Kind::Cells { shade, colour } => {
                    let side = record(x, y).size();
                    let border = record(x, y).kind() != sample::Kind::Traced
                        && side >= 4
                        && (x.is_multiple_of(side) || y.is_multiple_of(side));
                    if border { v * f64::from(shade) + colour.as_dvec3() } else { v }
                }
                Kind::Levels(n) => {
                    let level = |v: f64, n: f64| (v * n).floor().min(n - 1.0) / (n - 1.0);
                    let n = n.as_dvec3();
                    glam::DVec3::new(level(v.x, n.x), level(v.y, n.y), level(v.z, n.z))
                }
                _ => continue,
            };
            let off = (pixel(&chain, x, y).as_dvec3() - expected).abs().max_element();
            // Places are rounded at tens of pixels.
            let room = if matches!(kind, Kind::Fringes(_)) { 2e-5 } else { 4e-6 };
            assert!(off < room, "{kind:?} at ({x}, {y}): {off} off");
        }
    }
}

#[test]
fn grain_is_even_noise_around_nothing_and_new_in_each_frame() {
    let half = 0.1;
    let of_frame = |n: u64| {
        let mut chain = with(|_, _| Vec3::splat(0.5));
        chain.run(&[Effect::new(Kind::Grain(half))], &[], n, &mut Counters::default());
        let places = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (x, y)));
        places.map(|(x, y)| f64::from(pixel(&chain, x, y).x - 0.5)).collect::<Vec<_>>()
    };
    let (first, second) = (of_frame(0), of_frame(1));
    let count = first.len() as f64;
    assert!(first.iter().all(|v| v.abs() <= f64::from(half) + 1e-6));
    let mean = first.iter().sum::<f64>() / count;
    let spread = first.iter().map(|v| v * v).sum::<f64>() / count;
    // An even spread has a third of the square; four standard deviations of 3,403 draws.
    assert!(mean.abs() < 0.004 && (spread / 0.01 - 1.0 / 3.0).abs() < 0.021, "{mean} {spread}");
    let alike = first.iter().zip(&second).map(|(a, b)| a * b).sum::<f64>() / count;
    assert!(alike.abs() < 0.00023, "frames have noise of their own: {alike}");
}
