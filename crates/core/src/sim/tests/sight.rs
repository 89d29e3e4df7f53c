//! Laws of how smoke is seen and lit: Beer-Lambert, its lobes, steps, early ends and empty space.

use super::*;
use crate::sim::light::OPAQUE;

/// What is seen of smoke, and the lamps where it says.
fn seen(s: &Smoke, look: impl FnOnce(&Volume, &Stage)) {
    let simulation = play(*s, s.steps);
    let mut shown = Room::default();
    let volume = Volume::new(s, &simulation, &mut shown, &mut Counters::default());
    let light = |position| Light { position, colour: Vec3::splat(5.0), kind: LightKind::Point };
    let mut scene = Scene { lights: s.rules.lamps.map(light).into(), ..Default::default() };
    // One more, within.
    scene.lights.push(light(Vec3::new(0.8, 3.5, 0.6)));
    look(&volume, &Stage::new(&scene, &Quality::PRESETS[3].1, [8, 8], &mut Tables::default()));
}

#[test]
fn even_smoke_dims_as_beer_lambert_and_light_by_its_depth() {
    let air = Air { density: 0.7, ..Air::DEFAULT }.motion(0.1);
    let s = made(Rules { extinction: 3.0, air, ..*smoke(full, Air::DEFAULT).rules });
    let s = Smoke { steps: 40, ..s };
    seen(&s, |volume, stage| {
        let mut counters = Counters::default();
        let rays = |direction: Vec3| Rays8 {
            origin: V3::splat(Vec3::new(0.8, 1.0, 0.6) - direction * 4.0),
            direction: V3::splat(direction),
        };
        for (direction, length) in [(Vec3::X, 1.6), (Vec3::Y, 2.0), (Vec3::NEG_Z, 1.2)] {
            let mut march = |end: f32| volume.march(stage, &rays(direction), splat(end), 0.25, &mut counters);
            let (through, light) = march(f32::INFINITY);
            // At its border the density runs out over a cell, the same in all.
            let exact = crate::math::scalar::exp(-2.1 * length);
            let through = through.as_array()[3];
            assert!((through / exact - 1.0).abs() < 0.03, "{through} for {exact}");
            assert!(light.x.as_array()[3] > 0.0);
            // Up to half way, half the depth.
            let half = march(4.0).0.as_array()[0];
            assert!((half * half / exact - 1.0).abs() < 0.03, "{half} for the root of {exact}");
        }
        // The lamp is behind: what comes to the front of the smoke has come through all of it.
        let from = V3::splat(Vec3::new(0.8, 1.0, 1.5));
        let share = volume.shadow(0, from, V3::splat(Vec3::new(0.0, 0.0, -7.5))).as_array()[0];
        let exact = crate::math::scalar::exp(-2.1 * 1.2);
        assert!((share / exact - 1.0).abs() < 0.1, "{share} for {exact}");
        // Before the smoke, on the lamp's side, and beside it there is no shadow.
        for from in [Vec3::new(0.8, 1.0, -1.0), Vec3::new(9.0, 1.0, 1.5)] {
            let way = V3::splat(Vec3::new(0.8, 1.0, -6.0) - from);
            assert_eq!(volume.shadow(0, V3::splat(from), way).as_array()[0], 1.0);
        }
    });
}

#[test]
fn thin_smoke_scatters_nearly_as_henyey_and_greenstein_say() {
    // The sun is far along z. What comes through thin smoke is even but for the angle.
    let sun = Light { position: Vec3::Z * 1e4, colour: Vec3::splat(1e8), kind: LightKind::Point };
    let scene = Scene { lights: vec![sun], ..Default::default() };
    let tables = &mut Tables::default();
    let stage = Stage::new(&scene, &Quality::PRESETS[3].1, [8, 8], tables);
    for g in [0.0, 0.2, 0.45, 0.6, -0.4] {
        let phase = [1.0, 1.55 * g - 0.55 * g * g * g, 0.0];
        let s = made(Rules { extinction: 1e-3, phase, ..*smoke(full, Air::DEFAULT).rules });
        let simulation = play(s, 20);
        let mut shown = Room::default();
        let s = Smoke { steps: 20, ..s };
        let volume = Volume::new(&s, &simulation, &mut shown, &mut Counters::default());
        let light = |cos: f32| {
            let direction = Vec3::new(0.0, (1.0 - cos * cos).sqrt(), cos);
            // Through the same length of it, from the middle on.
            let origin = V3::splat(Vec3::new(0.8, 1.0, 0.6) - direction * 2.0);
            let rays = Rays8 { origin, direction: V3::splat(direction) };
            let start = volume.march(&stage, &rays, splat(1.8), 0.05, &mut Counters::default()).1;
            let (_, all) = volume.march(&stage, &rays, splat(2.2), 0.05, &mut Counters::default());
            f64::from(all.x.as_array()[0] - start.x.as_array()[0])
        };
        let angles = (0..64).map(|i| (2.0 * i as f32 + 1.0) / 64.0 - 1.0);
        let pairs = angles.map(|cos| (light(cos), f64::from(crate::kernels::henyey_greenstein(cos, g))));
        let pairs: Vec<(f64, f64)> = pairs.collect();
        let sums = pairs.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0, sum.1 + p.1));
        let apart = pairs.iter().map(|p| (p.0 / sums.0 - p.1 / sums.1).abs()).sum::<f64>() / 2.0;
        assert!(apart < 0.06, "g = {g}: {:.1} % of the light goes elsewhere", 100.0 * apart);
    }
}

#[test]
fn steps_change_little_an_early_end_less_and_lanes_nothing_at_all() {
    let s = made(Rules { extinction: 9.0, ambient: Vec3::ONE, ..*smoke(burning, AIR).rules });
    let s = Smoke { steps: 30, ..s };
    seen(&s, |volume, stage| {
        let mut counters = Counters::default();
        // Half a step through the thickest smoke: what a ray that leaves between two steps, or grazes a puff, may miss.
        let step = 1.0 - crate::math::scalar::exp(-0.5 * 9.0 * AIR.density * 0.1);
        let (mut count, mut rough, mut squares) = (0, 0, 0.0);
        for case in 0..400 {
            let random = &mut Random::new(case);
            let rays = packet(|| {
                let target =
                    Vec3::new(1.6, 2.0, 1.2) * Vec3::from_array([0; 3].map(|_| random.range(0.0, 1.0)));
                let direction = random.direction();
                (target - direction * random.range(0.0, 5.0), direction)
            });
            let ends = F::new(std::array::from_fn(|_| random.range(0.5, 8.0)));
            let mut march =
                |rays: &Rays8, ends: F, pace: f32| volume.march(stage, rays, ends, pace, &mut counters);
            let (through, light) = march(&rays, ends, 1.0);
            let (fine, bright) = march(&rays, ends, 0.05);
            for lane in 0..8 {
                let (t, l) = (through.as_array()[lane], light.lane(lane));
                let (exact, most) = (fine.as_array()[lane], bright.lane(lane));
                assert!((0.0..=1.0).contains(&t) && l.min_element() >= 0.0 && l.is_finite(), "case {case}");
                let room = step * (1.0 + most.max_element());
                let off = ((t - exact).abs() / step).max((l - most).abs().max_element() / room);
                assert!(off < 1.0, "case {case}: {t} and {l} for {exact} and {most}");
                rough += u32::from(off > 0.1);
                squares += f64::from(t - exact) * f64::from(t - exact);
                let one = crate::trace::check::splat(&rays, lane);
                let (alone, own) = march(&one, splat(ends.as_array()[lane]), 1.0);
                assert_eq!(
                    (alone.as_array()[5].to_bits(), own.lane(5)),
                    (t.to_bits(), l),
                    "case {case}, lane {lane}"
                );
                count += u32::from(t < 0.5);
            }
        }
        assert!(count > 300, "{count} of 3200 rays cross thick smoke");
        let rms = (squares / 3200.0).sqrt();
        assert!(rms < 0.004 && rough < 16, "RMS {rms}, {rough} of 3200 off by more than a tenth of that");
    });
}

#[test]
fn a_ray_that_ends_early_leaves_out_no_more_than_its_share() {
    let air = Air { density: 0.9, ..AIR };
    let s = made(Rules { extinction: 80.0, ambient: Vec3::ONE, gain: 0.0, ..*smoke(burning, air).rules });
    let s = Smoke { steps: 30, ..s };
    seen(&s, |volume, stage| {
        let mut counters = Counters::default();
        let mut march = |rays: &Rays8, end: f32| volume.march(stage, rays, splat(end), 0.02, &mut counters);
        let mut ended = 0;
        for case in 0..30 {
            let random = &mut Random::new(4_000 + case);
            let target = Vec3::new(1.0, 0.5, 0.6) + random.direction() * 0.3;
            let direction = random.direction();
            let at = |t: f32| Rays8 {
                origin: V3::splat(target + direction * (t - 2.0)),
                direction: V3::splat(direction),
            };
            let (through, light) = march(&at(0.0), 4.0);
            let (through, light) = (through.as_array()[0], light.x.as_array()[0]);
            // In pieces too short to end early, what each adds seen through those before it.
            let (mut rest, mut sum) = (1.0, 0.0);
            for k in 0..80 {
                let (t, l) = march(&at(0.05 * k as f32), 0.05);
                assert!(t.as_array()[0] > OPAQUE, "case {case}: a piece of its own ends early");
                sum += rest * l.x.as_array()[0];
                rest *= t.as_array()[0];
            }
            // Its own light is 1 where smoke is thickest.
            let room = OPAQUE + 4e-3;
            assert!((sum - light).abs() < room, "case {case}: {light}, not {sum}");
            assert!((rest - through).abs() < room && through >= 0.0, "case {case}: {through}, not {rest}");
            ended += u32::from(through < OPAQUE);
        }
        assert!(ended > 8, "{ended} of 30 rays end early");
    });
}

#[test]
fn empty_bricks_are_empty() {
    let s = Smoke { steps: 25, ..smoke(burning, AIR) };
    let grid = Grid { size: SIZE };
    seen(&s, |volume, _| {
        let cells = volume.shown();
        let mut empty = 0;
        for z in 0..SIZE[2] + 1 {
            for y in 0..SIZE[1] + 1 {
                for x in 0..SIZE[0] + 1 {
                    let brick = [x, y, z].map(|i| i as i32 / 4);
                    let full = volume.full().get(brick) != 0;
                    empty += u32::from(!full);
                    for k in 0..8 {
                        let cell = grid.index([x + (k & 1), y + (k >> 1 & 1), z + (k >> 2)]);
                        assert!(full || cells[cell][DENSITY] == 0.0, "brick {brick:?}");
                    }
                }
            }
        }
        assert!(empty > 0 && empty < 17 * 21 * 13);
    });
}
