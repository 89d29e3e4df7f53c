//! Trees are sound, whatever the boxes.

use super::*;
use crate::trace::check::{Random, two_to};

/// A tree over boxes, found sound.
#[track_caller]
fn tree(boxes: &[Bounds], leaf: usize) -> Tree {
    let tree = Tree::build(boxes, leaf);
    if let Err(what) = tree.validate(boxes) {
        panic!("{what}: {} boxes, leaves of {leaf}: {:?}", boxes.len(), &boxes[..boxes.len().min(50)]);
    }
    tree
}

fn point(p: Vec3) -> Bounds {
    Bounds { lo: p, hi: p }
}

#[test]
fn random_boxes_make_a_sound_tree() {
    let mut random = Random::new(300);
    for case in 0..400 {
        let count = random.bits() as usize % if case % 20 == 0 { 5_000 } else { 100 };
        let boxes: Vec<Bounds> = (0..count)
            .map(|_| {
                let (a, b) = (random.vector(-4, 6), random.vector(-8, 4));
                Bounds::around(&[a, a + b, a - b])
            })
            .collect();
        let tree = tree(&boxes, 1 + case % LEAF);
        let all = boxes.iter().fold(Bounds::NOTHING, |all, &b| all.union(b));
        assert_eq!(tree.bounds, all);
        assert_eq!(tree.is_empty(), boxes.is_empty());
    }
}

#[test]
fn equal_and_odd_boxes_make_a_sound_tree() {
    for count in [0, 1, 2, 4, 5, 8, 9, 33, 1_000, 20_000] {
        let same = vec![point(Vec3::new(1.0, 2.0, 3.0)); count];
        let built = tree(&same, 4);
        // Halving leaves nodes well filled.
        assert!(built.nodes.len() <= count.div_ceil(8), "{} nodes for {count}", built.nodes.len());
        // Same middles, growing boxes; and middles that double, on which planes cut off one at a time.
        let growing = |i: usize| Bounds { lo: Vec3::splat(-(i as f32)), hi: Vec3::splat(i as f32) };
        tree(&(0..count).map(growing).collect::<Vec<_>>(), 4);
        let apart: Vec<_> = (0..count.min(200)).map(|i| point(Vec3::X * two_to(i as i32 - 100))).collect();
        tree(&apart, 1);
    }
    let mut random = Random::new(301);
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    let boxes: Vec<Bounds> = (0..500)
        .map(|i| {
            let mut corners = [random.vector(-2, 2), random.vector(-2, 2), random.vector(-2, 2)];
            if i % 5 == 0 {
                corners[i / 5 % 3][i % 3] = odd[i % 7 % 3];
            }
            Bounds::around(&corners)
        })
        .collect();
    let built = tree(&boxes, 4);
    assert!(built.bounds.is_finite());
    assert_eq!(boxes.iter().filter(|b| b.is_finite()).count(), 400);
}

#[test]
fn a_broken_tree_is_found_out() {
    let boxes: Vec<Bounds> = (0..100).map(|i| point(Vec3::new(i as f32, (i * 7 % 13) as f32, 0.0))).collect();
    let sound = Tree::build(&boxes, 4);
    let mut moved = boxes.clone();
    moved[17].hi.z = 1.0;
    assert!(sound.validate(&moved).is_err(), "an item has left its box");
    let mut lost = sound.clone();
    lost.leaves[1] = lost.leaves[0];
    assert!(lost.validate(&boxes).is_err(), "an item is lost and another there twice");
    let mut small = sound.clone();
    small.nodes[0].bounds[1] -= F::ONE;
    assert!(small.validate(&boxes).is_err(), "a box is too small");
    let mut idle = sound.clone();
    idle.nodes.push(idle.nodes[0].clone());
    assert!(idle.validate(&boxes).is_err(), "a node is never reached");
}
