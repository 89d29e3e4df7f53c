//! What Embree's functions read and write, laid out as its API reference has it ("Embree API", RTCRay, RTCHit,
//! RTCRayHit, rtcInitIntersectContext of version 3, rtcInitIntersectArguments of version 4).

use crate::rays::Rays;
use glam::Vec3A;
use std::ffi::c_void;
use std::mem::offset_of;

/// The id of no geometry.
pub const INVALID: u32 = u32::MAX;

/// Room for ids of nested instances: one or two words in usual builds, more in others. They are a hit's last
/// fields, so that room that isn't used does no harm.
const NESTED: usize = 9;

/// RTCRayHit for `N` rays: each field is an array of `N`, which for one ray is the same layout.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Fields<const N: usize> {
    origin: [[f32; N]; 3],
    near: [f32; N],
    direction: [[f32; N]; 3],
    time: [f32; N],
    pub far: [f32; N],
    mask: [u32; N],
    id: [u32; N],
    flags: [u32; N],
    normal: [[f32; N]; 3],
    uv: [[f32; N]; 2],
    primitive: [u32; N],
    pub geometry: [u32; N],
    instances: [[u32; N]; NESTED],
}

// A ray is twelve words, a hit begins after it, and its geometry is the hit's seventh word.
const _: () = assert!(offset_of!(Fields<1>, far) == 32 && offset_of!(Fields<8>, far) == 8 * 32);
const _: () = assert!(offset_of!(Fields<1>, normal) == 48 && offset_of!(Fields<8>, normal) == 8 * 48);
const _: () = assert!(offset_of!(Fields<1>, geometry) == 72 && offset_of!(Fields<8>, geometry) == 8 * 72);

/// Aligned as the widest packet here has to be.
#[repr(C, align(32))]
pub struct Packet<const N: usize>(pub Fields<N>);

impl<const N: usize> Packet<N> {
    pub fn new(rays: &Rays, first: usize) -> Self {
        let axis = |list: &[Vec3A], k: usize| std::array::from_fn(|i| list[first + i][k]);
        Self(Fields {
            origin: [0, 1, 2].map(|k| axis(&rays.origins, k)),
            near: [0.0; N],
            direction: [0, 1, 2].map(|k| axis(&rays.directions, k)),
            time: [0.0; N],
            far: std::array::from_fn(|i| rays.ends[first + i]),
            mask: [u32::MAX; N],
            id: [0; N],
            flags: [0; N],
            normal: [[0.0; N]; 3],
            uv: [[0.0; N]; 2],
            primitive: [INVALID; N],
            geometry: [INVALID; N],
            instances: [[INVALID; N]; NESTED],
        })
    }
}

/// Version 3's RTCIntersectContext, with room as above.
#[repr(C)]
pub struct Context {
    flags: u32,
    filter: *const c_void,
    instances: [u32; NESTED],
}

/// Version 4's RTCIntersectArguments and RTCOccludedArguments, which are laid out alike.
#[repr(C)]
pub struct Arguments {
    flags: u32,
    features: u32,
    context: *const c_void,
    filter: *const c_void,
    intersect: *const c_void,
    width: f32,
}

/// The mask of lanes of a packet that are asked: all.
#[repr(C, align(32))]
pub struct Valid(pub [i32; 8]);
pub static VALID: Valid = Valid([-1; 8]);

/// Version 3's context by its defaults, but for the hint that rays run together.
pub fn context(together: bool) -> Context {
    Context { flags: together.into(), filter: std::ptr::null(), instances: [INVALID; NESTED] }
}

/// Version 4's arguments, likewise.
pub fn arguments(together: bool) -> Arguments {
    let [context, filter, intersect] = [std::ptr::null(); 3];
    Arguments { flags: u32::from(together) << 16, features: u32::MAX, context, filter, intersect, width: 0.0 }
}
