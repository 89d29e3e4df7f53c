//! Masks, agreement with glam bit for bit, exact differences of products, and the bits themselves.

use super::*;
use crate::math::check::{Fingerprint, bits_spread};

/// Coordinates of both signs with exponents −16..=15.
fn coordinate(i: u32, kind: u32) -> f32 {
    let bits = bits_spread(i, kind);
    f32::from_bits((bits & 0x807f_ffff) | ((111 + (bits >> 23 & 31)) << 23))
}

fn vectors(i: u32, kind: u32) -> V3 {
    V3::from_fn(|lane| {
        Vec3::from_array(core::array::from_fn(|k| coordinate(i * 8 + lane as u32, kind + k as u32)))
    })
}

#[test]
fn masks_convert_to_bits_and_back() {
    for bits in 0..=255u8 {
        let mask = from_bits(bits);
        assert_eq!((bitmask(mask), any(mask), all(mask)), (bits, bits != 0, bits == 255));
        assert_eq!(bitmask(!mask), !bits);
        for lane in 0..LANES {
            let set = bits >> lane & 1 != 0;
            assert_eq!(mask.to_bits().as_array()[lane], if set { u32::MAX } else { 0 });
            assert_eq!(select(mask, ONE, ZERO).as_array()[lane], f32::from(u8::from(set)));
            assert_eq!(
                select_u(mask, LANE_INDEX, U::splat(9)).as_array()[lane],
                if set { lane as u32 } else { 9 }
            );
        }
    }
    assert_eq!((bitmask(TRUE), bitmask(FALSE)), (255, 0));
}

#[test]
fn minimum_and_maximum_return_the_second_argument_for_nan() {
    let (a, nan) = (splat(1.0), splat(f32::NAN));
    let (low, high) = (a.at_most(splat(2.0)), a.at_least(splat(2.0)));
    assert_eq!((nan.at_most(a), nan.at_least(a), low, high), (a, a, a, splat(2.0)));
    assert!(a.at_most(nan).as_array()[0].is_nan() && a.at_least(nan).as_array()[0].is_nan());
}

#[test]
fn vectors_agree_with_glam_bit_for_bit() {
    for i in 0..5_000 {
        let (a, b, s) = (vectors(i, 0), vectors(i, 3), vectors(i, 6).x);
        for lane in 0..LANES {
            let (ga, gb, gs) = (a.lane(lane), b.lane(lane), s.as_array()[lane]);
            assert_eq!((a + b).lane(lane), ga + gb);
            assert_eq!((a - b).lane(lane), ga - gb);
            assert_eq!((a * b).lane(lane), ga * gb);
            assert_eq!((a * s).lane(lane), ga * gs);
            assert_eq!((-a).lane(lane), -ga);
            assert_eq!(a.cross(b).lane(lane), crate::math::cross(ga, gb));
            assert_eq!(a.normalize().lane(lane), ga * ga.length_recip());
            assert_eq!(a.dot(b).as_array()[lane], ga.dot(gb));
            assert_eq!(a.length().as_array()[lane], ga.length());
        }
    }
}

#[test]
fn difference_of_products_does_not_cancel() {
    let d = difference_of_products(splat(33962.035), splat(-30438.8), splat(41563.4), splat(-24871.969));
    assert_eq!(d, splat(-75.1656));
    const SCALE: f64 = (1u64 << 40) as f64;
    for i in 0..20_000 {
        let [a, b, c] = core::array::from_fn(|k| coordinate(i, k as u32));
        // The last factor makes the products nearly equal.
        let d = (f64::from(a) * f64::from(b) / f64::from(c)) as f32;
        if !(2e-5..3e4).contains(&d.abs()) {
            continue;
        }
        // In fixed point the products and their difference are exact.
        let fixed = |v: f32| (f64::from(v) * SCALE) as i128;
        let exact = (fixed(a) * fixed(b) - fixed(c) * fixed(d)) as f64 / (SCALE * SCALE);
        let got = difference_of_products(splat(a), splat(b), splat(c), splat(d)).as_array()[0];
        assert!(crate::math::check::ulp_error(got, exact) <= 0.5001, "{a} {b} {c} {d}");
    }
}

#[test]
fn lanes_do_not_touch_each_other() {
    let mut a = V3::ZERO;
    a.set_lane(5, Vec3::new(1.0, 2.0, 3.0));
    assert_eq!((a.lane(5), a.lane(4), a.lane(6)), (Vec3::new(1.0, 2.0, 3.0), Vec3::ZERO, Vec3::ZERO));
    let b = V3::select(from_bits(0b10_0000), a, V3::splat(Vec3::ONE));
    assert_eq!((b.lane(5), b.lane(0)), (a.lane(5), Vec3::ONE));
    assert_eq!((b & from_bits(1)).lane(5), Vec3::ZERO);
}

#[test]
fn bits_are_the_same_in_every_build() {
    let mut hash = Fingerprint::new();
    for i in 0..4_000 {
        let (a, b) = (vectors(i, 0), vectors(i, 3));
        for v in [a.cross_exact(b), a.cross(b), a.normalize() + b] {
            [v.x, v.y, v.z].iter().for_each(|c| c.as_array().iter().for_each(|&c| hash.add(c)));
        }
    }
    assert_eq!(hash.value(), 0x2b2931c2efa3837b, "{:#x}", hash.value());
}

#[test]
fn pick_takes_the_lanes_asked_for() {
    let v = F::new([1.0, -0.0, f32::INFINITY, 3.5, f32::MIN_POSITIVE, 6.0, 7.0, 8.0]);
    for i in 0..16u32 {
        let index = U::new(core::array::from_fn(|lane| i * (lane as u32 + 1)));
        let picked = pick(v, index);
        for lane in 0..LANES {
            let wanted = v.as_array()[index.as_array()[lane] as usize % LANES];
            assert_eq!(picked.as_array()[lane].to_bits(), wanted.to_bits(), "lane {lane} of {index:?}");
        }
    }
}
