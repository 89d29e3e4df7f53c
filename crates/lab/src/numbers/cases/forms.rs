//! Joins and repetition, walks, bases and drawn directions.

use super::*;

pub const KERNELS: &[Kernel] = &[
    kernel!(
        "smooth union",
        smooth_min,
        Measure::Unit(join_unit),
        join_draw,
        |x, _| join_truth(x[0], x[1], x[2]),
        |x| kernels::smooth_union(x[0], x[1], x[2]),
        |x| trace::smooth_min(x[0], x[1], scalar(x[2])).0
    ),
    kernel!(
        "smooth intersection",
        smooth_intersection,
        Measure::Unit(join_unit),
        join_draw,
        |x, _| -join_truth(-x[0], -x[1], x[2]),
        |x| kernels::smooth_intersection(x[0], x[1], x[2]),
        |x| -trace::smooth_min(-x[0], -x[1], scalar(x[2])).0
    ),
    kernel!(
        "smooth subtraction",
        smooth_subtraction,
        Measure::Unit(join_unit),
        join_draw,
        |x, _| -join_truth(-x[0], x[1], x[2]),
        |x| kernels::smooth_subtraction(x[0], x[1], x[2]),
        |x| -trace::smooth_min(-x[0], x[1], scalar(x[2])).0
    ),
    kernel!(
        "repetition",
        repeat,
        Measure::Unit(|x, _| f64::from(x[0].abs() + x[1])),
        |random| list([&cell_draw(random)]),
        |x, _| {
            let (x, side) = (f64::from(x[0]), f64::from(x[1]));
            x - side * (x / side + 0.5).floor()
        },
        |x| kernels::repeat(x[0], x[1], f32::INFINITY),
        |x| trace::repeated(x[0], scalar(x[1]), f32::INFINITY).1
    ),
    kernel!(
        "repetition, bounded",
        repeat_bounded,
        Measure::Unit(|x, _| f64::from(x[0].abs() + x[1])),
        |random| list([&cell_draw(random), &[(random.bits() % 64) as f32]]),
        |x, _| {
            let [x, side, most] = vector(x, 0).map(f64::from);
            x - side * (x / side + 0.5).floor().clamp(-most, most)
        },
        |x| kernels::repeat(x[0], x[1], x[2]),
        |x| trace::repeated(x[0], scalar(x[1]), scalar(x[2])).1
    ),
    kernel!(
        "walk through 128 cells",
        walk,
        Measure::Ulp,
        |random| {
            let place = if random.one_in(4) { 0.0 } else { random.range(0.0, 0.999) };
            list([&[place, 0.5, 0.5, random.size(-10, 10), random.signed(-40, -32), 0.0]])
        },
        |x, _| (127.0 - f64::from(x[0])) / f64::from(x[3]),
        |x| kernels::walk(&ray(x), [128, 1, 1]).last().map_or(f32::NAN, |visit| visit.enter),
        |x| {
            let steps = trace::Walk::new(packet(x, 0), packet(x, 3));
            let (mut cell, mut enter) = ([F::ZERO; 3], F::ZERO);
            for _ in 0..127 {
                let (leave, across) = steps.leave(&cell);
                (enter, cell) =
                    (leave, std::array::from_fn(|axis| steps.next(cell[axis], axis, across[axis])));
            }
            enter
        }
    ),
    kernel!(
        "basis of a normal",
        basis,
        // Three products, each of two rounded numbers.
        Measure::Unit(|_, _| 3.0),
        |random| {
            let tilt = Vec3::new(random.signed(-40, 0), random.signed(-40, 0), -1.0);
            let n = if random.one_in(2) { random.direction() } else { tilt.normalize() };
            list([&n.to_array()])
        },
        |_, _| 0.0,
        |x| {
            let (u, v) = kernels::basis(v3(x, 0).into());
            let wide = |v: Vec3| v.as_dvec3().to_array();
            naive::unlike(wide(u.into()), wide(v.into()), wide(v3(x, 0))) as f32
        },
        |x| {
            let (u, v) = sampling::basis(packet(x, 0));
            u.x + v.x
        }
    ),
    kernel!(
        "drawn about a normal",
        cosine,
        // Three products, each of two rounded numbers.
        Measure::Unit(|_, _| 3.0),
        |random| {
            let n = random.direction();
            let u = if random.one_in(2) { random.range(0.0, 1.0) } else { 1.0 - random.size(-24, 0) };
            list([&n.to_array(), &[u, random.range(0.0, 1.0)]])
        },
        |x, _| (1.0 - f64::from(x[3])).sqrt(),
        |x| v3(x, 0).as_dvec3().dot(kernels::cosine_weighted(v3(x, 0).into(), x[3], x[4]).as_dvec3()) as f32,
        |x| sampling::cosine(packet(x, 0), (x[3], x[4])).z
    ),
];

/// A place on an axis, and the side of its cells.
fn cell_draw(random: &mut Random) -> [f32; 2] {
    loop {
        let (x, side) = (random.signed(-4, 17), random.size(-4, 4));
        let cell = f64::from(x) / f64::from(side) + 0.5;
        // Next to a border either cell is right.
        if (cell - cell.round()).abs() > 4.0 * U * cell.abs() {
            return [x, side];
        }
    }
}

/// Two distances and a radius: often within the blend, now and then without one.
fn join_draw(random: &mut Random) -> Arguments<f32> {
    let (a, k) = (random.signed(-10, 10), random.size(-10, 4));
    let b = if random.one_in(2) { a + k * random.range(-1.5, 1.5) } else { random.signed(-10, 10) };
    // Of like sign and unlike, for all three joins.
    list([&[a, if random.one_in(2) { -b } else { b }, if random.one_in(16) { 0.0 } else { k }]])
}

fn join_unit(x: &Arguments<f32>, _: f64) -> f64 {
    x[0].abs().max(x[1].abs()).max(x[2]).into()
}

fn join_truth(a: f32, b: f32, k: f32) -> f64 {
    let [a, b, k] = [a, b, k].map(f64::from);
    let h = (k - (a - b).abs()).max(0.0);
    a.min(b) - if h > 0.0 { h * h / (4.0 * k) } else { 0.0 }
}
