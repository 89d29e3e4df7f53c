//! Rays against signed distance fields: eight rays march together (Hart 1996).
//!
//! A ray goes on by the field's value over its Lipschitz constant, which can't pass the surface,
//! until that is under an epsilon that grows with the distance; a secant then takes it closer. If the
//! value fell less than it might have, the next step is longer, by the mean slope m 2 / (1 - m) times:
//! what lies between has no surface as long as the free balls about both places meet and the second is not
//! beyond it, else the ray goes back for the plain step (Bán and Valasek 2023, after Keinert 2014). Rays start
//! and end at what holds the body: the field's box, and the balls around its bodies, grown by what smooth joins
//! and swells add.
//! A body whose grown ball a ray misses is left out for that ray, so a ray's result still depends on its
//! own lane only. Normals and materials see all bodies.

use super::{Rays8, Span};
use crate::counters::{Counter, Counters};
use crate::math::Vec3;
use crate::math::lanes::{Bound, F, INFINITY, TRUE, V3, splat};
use crate::quality::Quality;
use crate::scene::{Field, Form, Join, Node};

/// Per node: the mask of lanes that it matters to, or its share of each lane's surface.
pub type Nodes = [F; Field::MOST];

/// How far beyond a body joins and swells reach, in their [`Field::growth`]: it is within a quarter of one
/// where two join, and less than one where more do.
pub const REACH: f32 = 1.25;

/// The cell of `side` that `x` lies in, at most `most` from the middle one, and where in it.
///
/// An error of the cell's number, by rounding at a border, leaves the offset u |x| beyond the cell.
#[inline(always)]
pub fn repeated(x: F, side: f32, most: f32) -> (F, F) {
    let at = (x * splat(1.0 / side) + splat(0.5)).floor();
    let at = at.at_least(splat(-most)).at_most(splat(most));
    (at, x - at * splat(side))
}

/// Folds an axis into the cell about 0, every other cell mirrored; a side of 0 leaves it as it is.
#[inline(always)]
pub fn folded(x: F, side: f32, most: f32) -> F {
    if side <= 0.0 {
        return x;
    }
    let (at, offset) = repeated(x, side, most);
    let odd = at - (at * splat(0.5)).floor() * splat(2.0);
    offset * (F::ONE - (odd + odd))
}

/// Folds space into the cell about the origin.
#[inline(never)]
fn cell(field: &Field, p: V3) -> V3 {
    let (cell, copies) = (field.cell, field.copies);
    V3::new(folded(p.x, cell.x, copies.x), folded(p.y, cell.y, copies.y), folded(p.z, cell.z, copies.z))
}

/// The quadratic smooth minimum min - (k - |a - b|)² / 4k (Quilez), and the weight of the larger
/// number's gradient in it, up to ½; the plain minimum, bit for bit, where |a - b| >= k or k is 0. Error
/// at most 2 u (|a| + |b| + k).
#[inline(always)]
pub fn smooth_min(a: F, b: F, k: f32) -> (F, F) {
    let mut least = a.at_most(b);
    let mut h = F::ZERO;
    if k > 0.0 {
        h = (splat(k) - (a - b).abs()).at_least(F::ZERO);
        least -= h * h * splat(0.25 / k);
        h *= splat(0.5 / k);
    }
    (least, h)
}

/// Distance from a node's form, in its own place. Error at most 4 u (|p - centre| + size). Quilez, "Distance functions".
#[inline(always)]
pub fn form(node: &Node, p: V3) -> F {
    let mut p = p - V3::splat(node.centre);
    if let Some(axes) = node.axes {
        let [x, y, z] = axes.to_cols_array_2d().map(|c| p.dot(V3::splat(c)));
        p = V3::new(x, y, z);
    }
    let half = match node.form {
        Form::Plane(normal) => return p.dot(V3::splat(normal)) - splat(node.rounding),
        Form::Box(half) if half == Vec3::ZERO => return p.length() - splat(node.rounding),
        Form::Box(half) => half,
        Form::Cross(half) => {
            // The bar along the longest coordinate is the nearest: it is seen in the other two.
            let (x, y, z) = (p.x.abs(), p.y.abs(), p.z.abs());
            let (low, high) = (x.at_most(y), x.at_least(y));
            p = V3::new(low.at_most(z), high.at_most(low.at_least(z)), F::ZERO);
            Vec3::new(half, half, 1e9)
        }
        Form::Round([half, height, distance]) => {
            let out = (p.x * p.x + p.z * p.z).sqrt() - splat(distance);
            p = V3::new(out, p.y, F::ZERO);
            // Endless across, so that only the rectangle counts.
            Vec3::new(half, height, 1e9)
        }
        Form::Swell { amplitude, frequency } => {
            let wave = |x: F| {
                let x = x * splat(frequency / std::f32::consts::TAU);
                let x = (x - (x + splat(0.5)).floor()) * splat(2.0);
                splat(4.0) * x * (F::ONE - x.abs())
            };
            return splat(amplitude) * wave(p.x) * wave(p.y) * wave(p.z);
        }
    };
    let half = V3::splat(half);
    let q = V3::new(p.x.abs() - half.x, p.y.abs() - half.y, p.z.abs() - half.z);
    let zero = F::ZERO;
    let outside = V3::new(q.x.at_least(zero), q.y.at_least(zero), q.z.at_least(zero));
    let inside = q.x.at_least(q.y).at_least(q.z).at_most(zero);
    outside.length() + inside - splat(node.rounding)
}

/// The field's value at points, of the nodes that are `near` only. With `shares`, also how much of
/// each node is in it; they sum to 1.
#[inline(never)]
pub fn distance(field: &Field, p: V3, near: &Nodes, mut shares: Option<&mut Nodes>) -> F {
    let inner = if field.cell == Vec3::ZERO { p } else { cell(field, p) };
    let mut sum = INFINITY;
    for (i, (node, &near)) in field.nodes.iter().zip(near).enumerate() {
        if !near.any() {
            continue;
        }
        let d = form(node, if node.repeats { inner } else { p });
        // Cutting is joining from the other side.
        let (a, b) = match node.join {
            Join::Union => (sum, near.select(d, INFINITY)),
            Join::Intersection => (-sum, -d),
            Join::Subtraction => (-sum, d),
            Join::Sum => {
                sum += d;
                continue;
            }
        };
        let (least, h) = smooth_min(a, b, node.blend);
        sum = if node.join == Join::Union { least } else { -least };
        if let Some(shares) = &mut shares {
            let h = if node.mix { h } else { F::ZERO };
            let share = b.simd_lt(a).select(F::ONE - h, h);
            for before in &mut shares[..i] {
                *before *= F::ONE - share;
            }
            shares[i] = share;
        }
    }
    sum
}

/// Where `rays` meet the field before `limit`: from outside both ends of the span are where they
/// enter; from inside its end is where they leave.
#[inline(never)]
pub fn field(rays: &Rays8, field: &Field, limit: F, quality: &Quality, counters: &mut Counters) -> Span {
    let (o, d) = (rays.origin, rays.direction);
    let square = d.dot(d);
    let speed = square.sqrt();
    let epsilon = splat(quality.epsilon);
    let (enter, exit) = rays.in_box(field.lo, field.hi, limit);
    if !enter.simd_lt(exit).any() {
        return Span::MISS;
    }
    let mut near = [TRUE; Field::MOST];
    let (mut from, mut to) = (INFINITY, F::ZERO);
    let beyond = REACH * field.growth();
    for (node, near) in field.nodes.iter().zip(&mut near) {
        if let Some(half) = node.core() {
            let f = o - V3::splat(node.centre);
            let middle = f.dot(d) / square;
            let off = f - d * middle;
            let away = f.length();
            let reach =
                splat(half.length() + node.rounding + beyond) + epsilon * splat(4.0) * (F::ONE + away);
            let left = reach * reach - off.dot(off);
            let half = left.at_least(F::ZERO).sqrt() / speed;
            *near = left.simd_gt(F::ZERO) & half.simd_gt(middle);
            from = near.select(from.at_most(-middle - half), from);
            to = near.select(to.at_least(half - middle), to);
        } else if node.join == Join::Union {
            (from, to) = (F::ZERO, INFINITY);
        }
    }
    let start = enter.at_least(from);
    let end = exit.at_most(to);
    let mut active = start.simd_lt(end);
    let mut found = F::ZERO;
    let mut t = active.select(start, F::ZERO);
    // The last place that is free, how far about, and the part of a longer step that the plain one is.
    let (mut last_t, mut last, mut plain) = (t, INFINITY, F::ONE);
    let mut sign = F::ONE;
    let pace = splat(1.0 / field.lipschitz().max(1.0));
    for step in 0..quality.steps {
        if !active.any() {
            break;
        }
        counters.add(Counter::FieldSteps, active.to_bitmask().count_ones() as usize);
        let mut value = distance(field, o + d * t, &near, None);
        if step == 0 {
            // Only what begins within the body is inside; where the box cuts it, it is closed.
            sign = (t.simd_le(F::ZERO) & value.simd_lt(F::ZERO)).select(splat(-1.0), F::ONE);
        }
        value *= sign * pace;
        let gone = (t - last_t) * speed;
        let back = plain.simd_lt(F::ONE) & gone.simd_gt(last + value);
        let arrived = active & !back & value.simd_lt(epsilon * (F::ONE + t * speed));
        // The last step's slope carries it the rest of the way, if it has one.
        let here = (value - last) / gone;
        // Without a slope to speak of it is no number, which the maximum takes for 0 on every processor.
        let rest = (-value / here).at_least(F::ZERO).at_most((value + value).at_least(F::ZERO)) / speed;
        t = arrived.select(t + rest, t);
        found |= arrived;
        active &= !arrived;
        (last_t, last) = (back.select(last_t, t), back.select(last, value));
        // The newest slope weighs 0.4, which takes the fewest steps; none is longer than eight plain ones.
        plain += (splat(0.5) - here * splat(0.5) - plain) * splat(0.4);
        plain = back.select(F::ONE, plain.at_most(F::ONE).at_least(splat(0.125)));
        let mut step = last / plain;
        if let Some(pace) = quality.study.pace() {
            step *= splat(pace);
        }
        active &= (last_t + last / speed).simd_lt(end);
        t = active.select((last_t + step / speed).at_most(end), t);
    }
    // Out of steps: near enough is there.
    let hit = found | (active & last.simd_lt(splat(16.0) * epsilon * (F::ONE + last_t * speed)));
    let inside = hit & sign.simd_lt(F::ZERO);
    let miss = splat(-1.0);
    Span {
        enter: inside.select(miss, hit.select(t, miss)),
        exit: hit.select(t, miss),
        enter_part: F::ZERO,
        exit_part: F::ZERO,
    }
}

/// A point of a field: put back onto the surface, with the unit normal that points out of the body.
pub struct Point {
    /// World.
    pub point: V3,
    /// Unit vector.
    pub outward: V3,
    /// How much each node has of the surface there.
    pub shares: Nodes,
}

/// The surface near `p`. `width` is that of the rays' footprints there, world units: finer detail is
/// left out of the normal.
///
/// The gradient by central differences over about the distance at which rounding and curvature weigh
/// the same. Four corners of a tetrahedron (Quilez) would do with two values less, but their error is of
/// first order: with edges rounded by 0.1, a degree.
#[inline(never)]
#[cfg_attr(luc_size, optimize(size))]
pub fn locate(field: &Field, p: V3, width: F, toward: V3) -> Point {
    let all = [TRUE; Field::MOST];
    let mut shares = [F::ZERO; Field::MOST];
    let value = distance(field, p, &all, Some(&mut shares));
    let h = (splat(2e-3) + p.max_abs() * splat(4e-4)).at_least(width * splat(0.5)).at_most(splat(0.05));
    let mut sum = V3::ZERO;
    for axis in Vec3::AXES {
        let step = V3::splat(axis);
        let side = |h: F| distance(field, p + step * h, &all, None);
        sum += step * (side(h) - side(-h));
    }
    // On a ridge or at a middle there is no gradient: there it points at the ray's origin.
    let none = sum.dot(sum).simd_gt(splat(1e-30));
    let outward = V3::select(none, sum, -toward).normalize();
    let off = value.at_least(splat(-0.05)).at_most(splat(0.05));
    Point { point: p - outward * off, outward, shares }
}

/// Samples along the normal by which ambient occlusion is estimated.
const TAPS: [f32; 3] = [0.2, 0.55, 1.0];

/// Share of the light from all around that fields leave to surfaces with unit normal `n` at `p`: how
/// much nearer than `reach` their bodies come along the normal.
#[inline(never)]
#[cfg_attr(luc_size, optimize(size))]
pub fn ambient_share(fields: &[Field], reach: f32, p: V3, n: V3, active: F, counters: &mut Counters) -> F {
    let all = [TRUE; Field::MOST];
    let mut open = F::ONE;
    for field in fields {
        let mut hidden = F::ZERO;
        let (lo, hi) = (V3::splat(field.lo - reach), V3::splat(field.hi + reach));
        let within = |x: F, lo: F, hi: F| x.simd_gt(lo) & x.simd_lt(hi);
        let near = active & within(p.x, lo.x, hi.x) & within(p.y, lo.y, hi.y) & within(p.z, lo.z, hi.z);
        if !near.any() {
            continue;
        }
        counters.add(Counter::FieldOcclusion, 8);
        for tap in TAPS {
            let far = splat(reach * tap);
            let value = distance(field, p + n * far, &all, None);
            hidden +=
                (far - value).at_least(F::ZERO).at_most(far) * splat(1.0 / (reach * tap * TAPS.len() as f32));
        }
        open *= F::ONE - (near & hidden);
    }
    open
}

#[cfg(test)]
mod tests;
