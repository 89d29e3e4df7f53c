//! Patterns of textures: a value from -1 to 1 at points in space, cells of side 1, and its gradient.
//!
//! Brick and scratches are drawn on the plane that the surface faces most: across x, y or z.

use crate::math::hash::{mix_x8, unit_x8};
use crate::math::lanes::{Bound, F, V3, splat, splat_u};
use crate::math::noise::cell;

/// A value and its gradient.
pub type Height = (F, V3);

/// x² (3 - 2x) and its slope, x kept in 0..1.
fn ease(x: F) -> (F, F) {
    let x = x.at_least(F::ZERO).at_most(F::ONE);
    (x * x * (splat(3.0) - (x + x)), splat(6.0) * x * (F::ONE - x))
}

/// Rounded stones with creases between them: 1 - 2 d² with d the distance to the nearest of the
/// points that are strewn one to a cell (Worley 1996).
#[inline(never)]
pub fn cells(p: V3) -> Height {
    let ([x, y, z], f) = cell(p);
    let (mut nearest, mut away) = (F::ONE, V3::ZERO);
    for i in 0..27_u32 {
        let (a, b, c) = (i % 3, i / 3 % 3, i / 9);
        // One less than these: the neighbours on both sides.
        let hash = mix_x8(
            mix_x8(x + splat_u(a.wrapping_sub(1)), y + splat_u(b.wrapping_sub(1))),
            z + splat_u(c.wrapping_sub(1)),
        );
        let offset = |shift: u32, step: u32| unit_x8(hash << shift) + splat(step as f32 - 1.0);
        let v = f - V3::new(offset(0, a), offset(10, b), offset(20, c));
        let d = v.dot(v);
        let closer = d.simd_lt(nearest);
        nearest = closer.select(d, nearest);
        away = V3::select(closer, v, away);
    }
    (F::ONE - (nearest + nearest), away * splat(-4.0))
}

/// Level layers, a wave of parabolas along y.
pub fn stripes(p: V3) -> Height {
    let x = p.y - p.y.floor() - splat(0.5);
    let steep = F::ONE - (x + x).abs();
    let slope = splat(8.0) * (F::ONE - splat(4.0) * x.abs());
    (splat(8.0) * x * steep, V3::new(F::ZERO, slope, F::ZERO))
}

/// Unit vectors along and up the plane that a surface with normal `n` faces most.
fn plane(n: V3) -> (V3, V3) {
    let (x, y, z) = (n.x.abs(), n.y.abs(), n.z.abs());
    let one = |mask: F| mask & F::ONE;
    let level = y.simd_ge(x) & y.simd_ge(z);
    let side = !level & x.simd_gt(z);
    // A floor spans x and z, a wall across x spans z and y, one across z spans x and y.
    (V3::new(one(!side), F::ZERO, one(side)), V3::new(F::ZERO, one(!level), one(level)))
}

/// Half the width of a joint between bricks, and how far its edge rounds off, cells.
const JOINT: f32 = 0.08;

/// Bricks 1 wide and ½ high in staggered rows, each of its own height, with joints at -1.
#[inline(never)]
pub fn brick(p: V3, n: V3) -> Height {
    let (along, up) = plane(n);
    let row = p.dot(up) * splat(2.0);
    let odd = row.floor() * splat(0.5);
    let column = p.dot(along) + (odd - odd.floor());
    let ([x, y, _], f) = cell(V3::new(column, row, F::ZERO));
    let high = splat(1.3) + splat(0.7) * unit_x8(mix_x8(mix_x8(x, y), splat_u(1)));
    // Signed distances from the middle of the brick to its nearest edges.
    let (a, b) = (f.x - splat(0.5), (f.y - splat(0.5)) * splat(0.5));
    let (da, db) = (splat(0.5) - a.abs(), splat(0.25) - b.abs());
    let (shape, slope) = ease(da.at_most(db) * splat(1.0 / JOINT));
    let slope = slope * high * splat(1.0 / JOINT);
    let inward = |x: F| x.simd_gt(F::ZERO).select(-slope, slope);
    let gradient = V3::select(da.simd_lt(db), along * inward(a), up * inward(b));
    (shape * high - F::ONE, gradient)
}

/// Half the width of a scratch, cells, and its length.
const SCRATCH: (f32, f32) = (0.06, 5.0);

/// Thin grooves in two directions, some cells long.
#[inline(never)]
pub fn scratches(p: V3, n: V3) -> Height {
    let (along, up) = plane(n);
    let (u, v) = (p.dot(along), p.dot(up));
    let (mut value, mut gradient) = (F::ZERO, V3::ZERO);
    let (width, length) = (splat(SCRATCH.0), splat(SCRATCH.1));
    // Sine and cosine of the directions.
    for (layer, (sin, cos)) in
        [(0.469_471_56, 0.882_947_6), (-0.863_209_4, 0.504_846_1)].into_iter().enumerate()
    {
        let (sin, cos) = (splat(sin), splat(cos));
        let (x, y) = (along * cos + up * sin, up * cos - along * sin);
        let ([a, b, _], f) = cell(V3::new((u * cos + v * sin) / length, v * cos - u * sin, F::ZERO));
        let hash = mix_x8(mix_x8(a, b), splat_u(layer as u32));
        let tilt = unit_x8(hash << 12u32) - splat(0.5);
        let off = f.y
            - splat(0.5)
            - (unit_x8(hash) - splat(0.5)) * splat(0.4)
            - tilt * (f.x - splat(0.5)) * splat(0.5);
        let q = F::ONE - off * off / (width * width);
        let inside = q.simd_gt(F::ZERO);
        let fade = splat(4.0) * f.x * (F::ONE - f.x);
        let deep = q * q * fade;
        let across = splat(4.0) * q * off / (width * width) * fade;
        let down = (across * tilt * splat(-0.5) - q * q * (splat(4.0) - splat(8.0) * f.x)) / length;
        let deeper = inside & deep.simd_gt(-value);
        value = deeper.select(-deep, value);
        gradient = V3::select(deeper, y * across + x * down, gradient);
    }
    (value, gradient)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::trace::check::Random;

    type Pattern = fn(V3, V3) -> Height;
    const ALL: [(&str, Pattern); 4] = [
        ("cells", |p, _| cells(p)),
        ("stripes", |p, _| stripes(p)),
        ("brick", brick),
        ("scratches", scratches),
    ];

    fn at(pattern: Pattern, p: Vec3, n: Vec3) -> (f32, Vec3) {
        let (value, gradient) = pattern(V3::splat(p), V3::splat(n));
        (value.as_array()[2], gradient.lane(2))
    }

    /// The gradient is the mean of the differences to both sides, but for their own difference: that
    /// is what curvature does, and at a crease the gradient is one of the two.
    #[test]
    fn gradients_are_those_of_the_values_and_values_within_one() {
        let mut random = Random::new(660);
        for (name, pattern) in ALL {
            let (mut compared, mut low, mut high, mut sum) = (0, 1.0_f32, -1.0_f32, 0.0);
            for _ in 0..20_000 {
                let p = Vec3::from_array([0; 3].map(|_| random.range(-40.0, 40.0)));
                let n = random.direction();
                let (value, gradient) = at(pattern, p, n);
                (low, high, sum) = (low.min(value), high.max(value), sum + value);
                let difference = |h: f32| {
                    let along = |k: usize| (at(pattern, p + Vec3::AXES[k] * h, n).0 - value) / h;
                    Vec3::from_array(std::array::from_fn(along))
                };
                // Two creases may lie on either side of a ramp that is narrower than the wider differences.
                let sides = [1024.0, 8192.0].map(|k: f32| (difference(1.0 / k), difference(-1.0 / k)));
                let bend = |(after, before): (Vec3, Vec3)| (after - before).abs().max_element();
                compared += (bend(sides[0]) < 0.1) as u32;
                let fits = sides.map(|(after, before)| {
                    let off = (gradient - (after + before) * 0.5).abs().max_element();
                    off < 0.05 + bend((after, before))
                });
                assert!(fits[0] || fits[1], "{name} at {p:?} n {n:?}: {gradient}, differences {sides:?}");
            }
            println!("{name}: {low} to {high}, mean {}, {compared} compared", sum / 20_000.0);
            assert!(compared > 10_000, "{name}: {compared}");
            assert!((-1.0..=1.0).contains(&low) && (-1.0..=1.0).contains(&high), "{name}: {low} to {high}");
            assert!(high - low > 0.9, "{name} varies: {low} to {high}");
        }
    }

    #[test]
    fn bricks_have_joints_all_around_and_staggered_rows() {
        let wall = |x: f32, y: f32| at(brick, Vec3::new(x, y, 0.3), Vec3::Z).0;
        // Rows are ½ high; the first has its joints at whole x, the next at halves.
        for k in -4..4 {
            let x = k as f32;
            assert_eq!((wall(x, 0.25), wall(x + 0.5, 0.75)), (-1.0, -1.0), "upright joints at {x}");
            assert!(wall(x + 0.5, 0.25) > 0.2 && wall(x, 0.75) > 0.2, "middles of bricks at {x}");
            assert_eq!(wall(0.3 + x * 0.37, x * 0.5), -1.0, "level joints");
        }
        // On other sides the same wall, turned.
        let side = at(brick, Vec3::new(9.0, 0.25, 3.5), Vec3::X).0;
        assert_eq!(side, at(brick, Vec3::new(3.5, 0.25, 1.0), Vec3::NEG_Z).0);
        assert_eq!(side, at(brick, Vec3::new(3.5, -7.0, 0.25), Vec3::Y).0);
    }

    #[test]
    fn scratches_are_thin_and_everything_is_finite_far_away() {
        let mut random = Random::new(661);
        let mut scratched = 0;
        for _ in 0..20_000 {
            let p = Vec3::new(random.range(-90.0, 90.0), 0.0, random.range(-90.0, 90.0));
            scratched += (at(scratches, p, Vec3::Y).0 < 0.0) as u32;
        }
        // Two layers of lines 0.12 wide.
        assert!((3000..6000).contains(&scratched), "{scratched} of 20,000");
        for (name, pattern) in ALL {
            for size in [1e6, -1e9, 3e20] {
                let (value, gradient) = at(pattern, Vec3::new(size, -size, 0.4 * size), Vec3::X);
                assert!(value.is_finite() && gradient.is_finite(), "{name} at {size}");
            }
        }
    }
}
