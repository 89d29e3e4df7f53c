//! Shared by the tests of tracing, shading and culling: random shapes' rays, f64 truth, scores.
//!
//! **Condition.** A kernel that is backward stable gives the exact answer for a surface that lies
//! up to a *skin* δ = u (|o - c| + r + |t d|) off the true one, u = 2^-24: what f32 rounding of the
//! ray relative to the shape may do. The oracle, in f64, answers for the shape grown by any skin.
//! - **Lost**: no crossing reported though the shape is crossed, ahead, and so it is shrunk by 4 δ.
//! - **False**: a crossing reported though the shape grown by 4 δ is missed.
//! - **Score** of a distance t: |t - ref| / max(unit, ulp(ref) / 2), where unit is how far ref moves
//!   when the shape grows or shrinks by δ, or a quarter of that for 4 δ, where more. Where the ray misses the
//!   shape by less than that, ref moves to the last crossing there is: over the skins it took, if over 1. A
//!   cone's slope and its tip are rounded apart, so the slope may move alone, or against the tip: a ray along
//!   the side through the tip is within or without by their difference. And the ray may move aside, alone or
//!   while the shape shrinks or its slope changes, or until it but touches the shape: near a tip, or where it
//!   grazes a side close to an end, that moves ref as no growth does. Any part of a skin may be all that there
//!   is of it.
//!
//! `{:?}` of an f32 reads back to the same bits, so a printed shape and ray replay a failure.

use super::{Rays8, Span, Surface};
use crate::math::Vec3;
use crate::math::lanes::{self, F, V3};
pub use crate::math::random::Random;
use crate::math::scalar::sin_cos;
use crate::scene::Material;
use glam::DVec3;

/// Half an ulp of 1.
pub const U: f64 = 1.0 / 16_777_216.0;

/// Calls `case` so many times with each of so many streams: what one of them misses may be in the next.
pub fn sweep(streams: u32, seed: u32, each: u32, mut case: impl FnMut(&mut Random)) {
    for stream in 0..streams {
        let mut random = Random::new(1000 * stream + seed);
        (0..each).for_each(|_| case(&mut random));
    }
}

/// A ray in f64.
#[derive(Clone, Copy)]
pub struct Line {
    /// Origin.
    pub o: DVec3,
    /// Direction.
    pub d: DVec3,
}

/// Where a line is inside a body: distances and parts crossed, as in [`Span`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inside {
    /// First and last crossing.
    pub t: [f64; 2],
    /// Parts of the surface.
    pub part: [u32; 2],
}

/// Counts of one kernel's cases, and the worst of them.
pub struct Tally {
    name: &'static str,
    /// Rays tested.
    pub cases: u32,
    /// Rays that truly hit.
    pub hits: u32,
    /// Largest score.
    pub worst: f64,
    worst_at: String,
    failures: Vec<String>,
}

impl Tally {
    /// No cases yet.
    pub fn new(name: &'static str) -> Self {
        Tally { name, cases: 0, hits: 0, worst: 0.0, worst_at: String::new(), failures: Vec::new() }
    }

    /// Counts a score.
    pub fn score(&mut self, score: f64, replay: impl FnOnce() -> String) {
        if score > self.worst || score.is_nan() {
            self.worst = if score.is_nan() { f64::INFINITY } else { score };
            self.worst_at = replay();
        }
    }

    /// Counts a failure.
    pub fn fail(&mut self, what: &str, replay: impl FnOnce() -> String) {
        self.failures.push(if self.failures.len() < 5 {
            format!("{what}: {}", replay())
        } else {
            String::new()
        });
    }

    /// Prints the counts; panics with the rays to replay if something failed or scored over `gate`.
    pub fn finish(self, gate: f64) {
        let Tally { name, cases, hits, worst, worst_at, failures } = self;
        println!("{name}: {cases} cases, {hits} hits, {} failures, worst score {worst:.3}", failures.len());
        let shown: Vec<_> = failures.iter().filter(|f| !f.is_empty()).map(String::as_str).collect();
        assert!(failures.is_empty(), "{name}: {} of {cases}:\n{}", failures.len(), shown.join("\n"));
        assert!(worst <= gate, "{name}: score {worst} at {worst_at}");
    }

    /// Judges lane results of a body against the truth; see the module. `truth` answers for a ray and
    /// three skins: of the side, of the ends, and of the side's slope; `reach` is |o - c| + r of each ray.
    ///
    /// A part is only judged if it is the same with side and ends moved by 4 skins either way. Nor
    /// is a ray that passes an open end judged, unless its parts are such.
    pub fn body(
        &mut self,
        rays: &Rays8,
        span: &Span,
        truth: impl Fn(&Line, [f64; 3]) -> Option<Inside>,
        reach: impl Fn(&Line) -> f64,
        open: [bool; 2],
        shape: &dyn std::fmt::Debug,
    ) {
        let t = [span.enter.to_array(), span.exit.to_array()];
        let part = [span.enter_part.to_array(), span.exit_part.to_array()];
        for i in 0..8 {
            let (o, d) = (rays.origin.lane(i), rays.direction.lane(i));
            let line = Line { o: o.as_dvec3(), d: d.as_dvec3() };
            let got = (t[0][i], t[1][i]);
            let replay = || format!("{shape:?} origin {o:?} direction {d:?} got {got:?}");
            self.cases += 1;
            let (reach, length) = (reach(&line), line.d.length());
            let closed = truth(&line, [0.0; 3]);
            if closed.is_some_and(|e| e.t[1] > 0.0) {
                self.hits += 1;
            }
            if got.0.is_nan() || got.1.is_nan() {
                self.fail("NaN", replay);
                continue;
            }
            let skin = U * (2.0 * reach);
            let parts = |k: usize, skin: f64| {
                let part = |side, ends| truth(&line, [side, ends, side]).map(|e| e.part[k]);
                [(4.0, 4.0), (4.0, -4.0), (-4.0, 4.0), (-4.0, -4.0)]
                    .into_iter()
                    .all(|(side, ends)| part(side * skin, ends * skin) == closed.map(|e| e.part[k]))
            };
            if open != [false; 2] && !(parts(0, skin) && parts(1, skin)) {
                continue;
            }
            let (right, up) = line.d.normalize().any_orthonormal_pair();
            let bent = |[skin, slope, x, y]: [f64; 4]| {
                let moved = Line { o: line.o + right * x + up * y, ..line };
                truth(&moved, [skin, skin, slope]).and_then(|e| through(e, open))
            };
            let truth = |skin: f64| bent([skin, skin, 0.0, 0.0]);
            let exact = closed.and_then(|e| through(e, open));
            // What is crossed far out only counts by the skin there.
            let nearest =
                |t: [f64; 2]| t.into_iter().filter(|t| t.is_finite()).fold(1e30, |m: f64, t| m.min(t.abs()));
            if got == (-1.0, -1.0) {
                let inner = truth(-4.0 * skin).and_then(|e| truth(-4.0 * (skin + U * nearest(e.t) * length)));
                // A sheet that is moved may come before the ray from behind it.
                let ahead = |inside: &Inside| inside.t[1] > 0.0;
                if let Some(inner) = inner.filter(|e| ahead(e) && exact.as_ref().is_some_and(ahead)) {
                    self.fail("lost", || format!("{} truth {exact:?} inner {inner:?}", replay()));
                }
                continue;
            }
            let far = U * nearest([got.0.into(), got.1.into()]) * length;
            if truth(4.0 * skin).or_else(|| truth(4.0 * (skin + far))).is_none() {
                self.fail("false", || format!("{} truth {exact:?}", replay()));
                continue;
            }
            if got.0 > got.1 && got.1 != -1.0 {
                self.fail("order", replay);
            }
            let Some(exact) = exact else { continue };
            for k in 0..2 {
                let (want, got) = (exact.t[k], f64::from(t[k][i]));
                if want.abs() * length > 1e6 * reach && want != -1.0 {
                    continue;
                }
                let skin = U * (reach + want.abs() * length);
                let moved = |ways: [f64; 4], skins: f64| {
                    let at = |share: f64| bent(ways.map(|way| skins * share * way * skin));
                    let (inside, share) = at(1.0).map_or_else(|| last(at), |e| (Some(e), 1.0));
                    inside.map_or(0.0, |e| (e.t[k] - want).abs()) / (skins.abs() * share).max(1.0)
                };
                let unit = |ways: [f64; 4]| {
                    [1.0, -1.0, 4.0, -4.0].map(|skins| moved(ways, skins)).into_iter().fold(0.0, f64::max)
                };
                let score = |unit: f64| (got - want).abs() / unit.max(half_ulp(want));
                let mut unit_here = unit([1.0, 1.0, 0.0, 0.0]);
                if score(unit_here) > 1.0 {
                    let against = (0..8).map(|i| [1.0 / f64::from(1 << i), -1.0, 0.0, 0.0]);
                    let ways = against.chain(std::iter::once([0.0, 1.0, 0.0, 0.0])).chain(aside());
                    unit_here = ways.map(unit).fold(unit_here, f64::max);
                }
                // Hundreds of ways, so only where the others leave more than the gate of kernels in f32.
                if score(unit_here) > 4.0 {
                    let touch = |[_, _, x, y]: [f64; 4]| {
                        let grown = |share: f64| bent([1.0 - 2.0 * share, 0.0, x, y].map(|way| way * skin));
                        let touching = if grown(1.0).is_none() { last(grown).0 } else { None };
                        touching.map_or(0.0, |e| (e.t[k] - want).abs())
                    };
                    let touching = aside().take(16).map(touch);
                    unit_here = ajar().map(unit).chain(touching).fold(unit_here, f64::max);
                }
                if unit_here == f64::INFINITY {
                    continue;
                }
                let score = score(unit_here);
                self.score(score, || format!("{} truth {exact:?}", replay()));
                if want != -1.0 && part[k][i] != exact.part[k] as f32 && parts(k, skin) {
                    self.fail("part", || format!("{} part {} truth {exact:?}", replay(), part[k][i]));
                }
            }
        }
    }
}

/// Ways to move the ray aside, in a star of 16, while the shape stays or changes by a part of that.
fn aside() -> impl Iterator<Item = [f64; 4]> {
    [0.0, 0.25, 1.0 / 16.0].into_iter().flat_map(|grown| {
        (0..16).map(move |i| {
            let (sin, cos) = sin_cos(i as f32 * core::f32::consts::FRAC_PI_8);
            [grown, grown, cos.into(), sin.into()]
        })
    })
}

/// Ways to move the ray aside, by all of a skin or less, while the slope changes and the shape stays, grows or
/// shrinks.
fn ajar() -> impl Iterator<Item = [f64; 4]> {
    let far = [1.0, 1.0 / 8.0, 1.0 / 64.0, 1.0 / 512.0];
    let aside = aside().take(16).flat_map(move |[_, _, x, y]| far.map(|far| (far * x, far * y)));
    aside.flat_map(|(x, y)| {
        [-1.0, 0.0, 1.0].into_iter().flat_map(move |slope| [-1.0, 0.0, 1.0].map(|grown| [grown, slope, x, y]))
    })
}

/// The last crossings as the shape shrinks, and the share of the way to that: `at` 0 it is crossed, at 1 it isn't.
fn last(at: impl Fn(f64) -> Option<Inside>) -> (Option<Inside>, f64) {
    let (mut there, mut gone, mut inside) = (0.0, 1.0, at(0.0));
    for _ in 0..40 {
        let share = 0.5 * (there + gone);
        match at(share) {
            Some(e) => (there, inside) = (share, Some(e)),
            None => gone = share,
        }
    }
    (inside, there)
}

/// What is left of the crossings where ends are open: an inner wall instead of the first crossing,
/// and no last one (-1).
fn through(inside: Inside, open: [bool; 2]) -> Option<Inside> {
    let gap = |part: u32| part > 0 && open[part as usize - 1];
    let Inside { t: [enter, exit], part: [first, last] } = inside;
    match (gap(first), gap(last)) {
        (true, true) => None,
        (true, false) => Some(Inside { t: [exit; 2], part: [last; 2] }),
        (false, true) => Some(Inside { t: [enter, -1.0], part: [first, last] }),
        _ => Some(inside),
    }
}

/// 2^k.
pub fn two_to(k: i32) -> f32 {
    f32::from_bits(((127 + k) as u32) << 23)
}

/// Half the spacing of f32 at `x`.
pub fn half_ulp(x: f64) -> f64 {
    let x = (x.abs() as f32).max(f32::MIN_POSITIVE);
    0.5 * f64::from(x.next_up() - x)
}

/// A surface in the origin with these unit normals.
pub fn surface(material: Material, normal: V3, facing: V3, inside: F) -> Surface {
    Surface {
        point: V3::ZERO,
        normal,
        facing,
        inside,
        uv: [F::ZERO; 2],
        clearance: F::ZERO,
        node: F::ZERO,
        part: F::ZERO,
        material: material.channels().map(lanes::splat),
    }
}

/// Unit vector of this cosine to y.
pub fn tilted(cos: f32, turn: f32) -> Vec3 {
    let sine = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
    let (s, c) = sin_cos(turn);
    Vec3::new(sine * c, cos, sine * s)
}

/// Eight rays, lane by lane.
pub fn packet(mut ray: impl FnMut() -> (Vec3, Vec3)) -> Rays8 {
    let rays: [(Vec3, Vec3); 8] = std::array::from_fn(|_| ray());
    Rays8 { origin: V3::from_fn(|i| rays[i].0), direction: V3::from_fn(|i| rays[i].1) }
}

/// The same ray in all lanes.
pub fn splat(rays: &Rays8, lane: usize) -> Rays8 {
    Rays8 { origin: V3::splat(rays.origin.lane(lane)), direction: V3::splat(rays.direction.lane(lane)) }
}

/// Rays with signed zeros, subnormals, huge numbers, infinities and NaN in every combination that
/// one changed coordinate of origin or direction and a change to all of them can make.
pub fn poisoned() -> Vec<(Vec3, Vec3)> {
    const ODD: [f32; 12] = [
        0.0,
        -0.0,
        1e-45,
        -1e-40,
        1e-25,
        1e19,
        -1e25,
        f32::MAX,
        f32::MIN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::NAN,
    ];
    let mut rays = Vec::new();
    let plain = [(Vec3::new(0.1, 0.2, -5.0), Vec3::Z), (Vec3::ZERO, Vec3::new(0.3, -0.4, 0.5))];
    for odd in ODD {
        for (o, d) in plain {
            for axis in 0..3 {
                let (mut o2, mut d2) = (o, d);
                (o2[axis], d2[axis]) = (odd, odd);
                rays.extend([(o2, d), (o, d2), (o2, d2)]);
            }
            rays.extend([(Vec3::splat(odd), d), (o, Vec3::splat(odd)), (o * odd, d * odd), (o, d * odd)]);
        }
    }
    while rays.len() % 8 != 0 {
        rays.push(plain[0]);
    }
    rays
}
