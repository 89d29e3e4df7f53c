//! Our march through a distance field beside crate fidget, which compiles the same field to machine code.
//!
//! The field is of twelve balls of the show, blended by the quadratic smooth minimum. Both give its values at
//! the same points, and whole pictures of it ([`crate::frames`]); these are compared before they are timed.

use crate::frames::{self, Difference};
use crate::rays::unit;
use crate::turns::medians;
use fidget::context::Tree;
use fidget::jit::JitShape;
use fidget::shape::EzShape;
use luc::show;
use luc_core::math::Vec3;
use luc_core::math::lanes::{TRUE, V3, load};
use luc_core::quality::Quality;
use luc_core::scene::{Field, Material, Node, Scene};
use luc_core::trace;

/// Passes of timing.
const PASSES: usize = 15;
/// Points of which values are compared and timed, and how many are evaluated at once.
const POINTS: usize = 1 << 14;
const SLICE: usize = 512;
/// Rounds over those points in one timing, so that it is long enough.
const ROUNDS: usize = 20;
/// From the show's units to the picture's volume, -1 to 1 along each axis, and what moves up to its middle.
const SCALE: f32 = 0.28;
const MIDDLE: Vec3 = Vec3::new(0.0, 1.2, 0.4);

/// The mercury of the show's part Blobs as it begins, in the volume's units: middles and radii of twelve balls, of
/// which some fall and some fly away, and the radius of their smooth joins.
struct Mercury {
    balls: Vec<(Vec3, f32)>,
    blend: f32,
}

impl Mercury {
    fn new() -> Result<Self, String> {
        let part = show::PARTS.iter().find(|part| part.name == "blobs");
        let field = part.and_then(|part| (part.scene)(0).fields.pop()).ok_or("there is no mercury")?;
        let ball = |node: &Node| ((node.centre - MIDDLE) * SCALE, node.rounding * SCALE);
        let blend = field.nodes.last().map_or(0.0, |node| node.blend * SCALE);
        Ok(Self { balls: field.nodes.iter().map(ball).collect(), blend })
    }

    fn ours(&self) -> Field {
        let node = |&(c, r): &(Vec3, f32)| Node { blend: self.blend, ..Node::sphere(c, r) };
        Field::new(self.balls.iter().map(node).collect())
    }

    /// The same by fidget's own operations, joined in the same order.
    fn theirs(&self) -> JitShape {
        let (x, y, z) = Tree::axes();
        let ball = |&(c, r): &(Vec3, f32)| {
            let square = (x.clone() - c.x).square() + (y.clone() - c.y).square() + (z.clone() - c.z).square();
            square.sqrt() - r
        };
        let join = |a: Tree, b: Tree| {
            let h = (Tree::from(self.blend) - (a.clone() - b.clone()).abs()).max(0.0);
            a.min(b) - h.square() * (0.25 / self.blend)
        };
        let tree = self.balls.iter().map(ball).reduce(join);
        JitShape::from(tree.unwrap_or_else(|| Tree::from(1.0)))
    }
}

/// Coordinates of points.
type Points = [Vec<f32>; 3];

fn our_values(field: &Field, [x, y, z]: &Points, out: &mut [f32]) {
    let all = [TRUE; Field::MOST];
    for (i, out) in out.chunks_exact_mut(8).enumerate() {
        let p = V3::new(load(&x[8 * i..]), load(&y[8 * i..]), load(&z[8 * i..]));
        out.copy_from_slice(trace::distance(field, p, &all, None).as_array());
    }
}

/// What gives values by fidget, compiled once.
fn their_values(shape: &JitShape) -> impl FnMut(&Points, &mut [f32]) {
    let (tape, mut evaluator) = (shape.ez_float_slice_tape(), JitShape::new_float_slice_eval());
    move |[x, y, z]: &Points, out: &mut [f32]| {
        for (i, out) in out.chunks_mut(SLICE).enumerate() {
            let part = i * SLICE..i * SLICE + out.len();
            let values = evaluator.eval(&tape, &x[part.clone()], &y[part.clone()], &z[part]);
            out.copy_from_slice(values.expect("slices of one length"));
        }
    }
}

/// Prints a row.
fn row(name: &str, [ours, theirs]: [f64; 2], unit: &str, differs: &str) {
    let ratio = ours / theirs;
    println!("| {name} | {ours:.1} {unit} | {theirs:.1} {unit} | {ratio:.2} | {differs} |");
}

/// Prints what values differ by, and their times.
fn values(field: &Field, shape: &JitShape) -> Result<(), String> {
    let at = |k: u32| (0..POINTS as u32).map(|i| unit(3 * i + k) * 2.0 - 1.0).collect::<Vec<f32>>();
    let points = [at(0), at(1), at(2)];
    let mut theirs = their_values(shape);
    let [mut a, mut b] = [vec![0.0; POINTS], vec![0.0; POINTS]];
    our_values(field, &points, &mut a);
    theirs(&points, &mut b);
    let differ = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    if a.iter().chain(&b).any(|v| !v.is_finite()) || differ > 1e-5 {
        return Err(format!("fidget's values differ by up to {differ:.1e}"));
    }
    let mut works: Vec<Box<dyn FnMut()>> = vec![
        Box::new(|| (0..ROUNDS).for_each(|_| our_values(field, &points, &mut a))),
        Box::new(|| (0..ROUNDS).for_each(|_| theirs(&points, &mut b))),
    ];
    let times = medians(PASSES, &mut works);
    let times = [0, 1].map(|i| times[i] * 1e6 / (POINTS * ROUNDS) as f64);
    let differs = if differ == 0.0 { "nothing".into() } else { format!("values by up to {differ:.0e}") };
    row("a value", times, "ns", &differs);
    Ok(())
}

/// Prints what pictures differ in, and their times.
fn pictures(field: &Field, shape: &JitShape, side: usize) -> Result<(), String> {
    let quality = Quality::named("high").ok_or("there is no quality high")?;
    let materials = vec![Material::DEFAULT];
    let scene = Scene { fields: vec![field.clone()], materials, ..Scene::default() };
    let march = || frames::ours(&scene, &quality, side);
    let voxels = || frames::voxels(shape, side);
    let rays = || frames::rays(shape, field, &quality, side);

    let (pixels, ours) = (side * side, march());
    let names = ["picture, by its renderer", "picture, by our steps with its values"];
    let mut differs = Vec::new();
    for (name, theirs) in names.iter().zip([voxels(), rays()]) {
        let Difference { outline, depth, angle } = ours.compare(&theirs);
        if outline + depth > pixels / 200 {
            return Err(format!("fidget, {name}: {} of {pixels} px differ", outline + depth));
        }
        differs.push(format!("outline in {outline} px, depth in {depth}, normals by {angle:.1}°"));
    }

    let mut works: Vec<Box<dyn FnMut()>> =
        vec![Box::new(|| drop(march())), Box::new(|| drop(voxels())), Box::new(|| drop(rays()))];
    let times = medians(PASSES, &mut works);
    for ((name, theirs), differs) in names.iter().zip(&times[1..]).zip(&differs) {
        row(name, [times[0], *theirs], "ms", differs);
    }
    Ok(())
}

/// Prints the table.
pub fn run(quick: bool) -> Result<(), String> {
    let side = if quick { 128 } else { 512 };
    let mercury = Mercury::new()?;
    let (field, shape) = (mercury.ours(), mercury.theirs());
    println!("| {} balls, {side}x{side} px | Lúč | fidget | ratio | what differs |", mercury.balls.len());
    println!("|---|---:|---:|---:|---|");
    values(&field, &shape)?;
    pictures(&field, &shape, side)
}
