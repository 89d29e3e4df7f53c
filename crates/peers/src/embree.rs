//! Intel's Embree as one more tracer, if a library of version 3 or 4 is here: found and loaded at run time.
//!
//! Asked ray by ray and in packets of eight with AVX2, which is what ours has, and in such packets with what
//! it chooses for this processor itself. Names and constants are those of its API reference ("Embree API":
//! rtcNewDevice, rtcSetNewGeometryBuffer, rtcIntersect1, rtcIntersect8, rtcOccluded1, rtcOccluded8). The two
//! versions differ in how rays are asked: 3 takes a context before the ray, 4 optional arguments after it.
//!
//! Unsafe code is in this file only: calls into the library, each with what makes it sound.

mod layout;

use crate::rays::{Kind, Rays};
use crate::triangles::{Group, Peer, Tracer};
use glam::Vec3A;
use layout::{Arguments, Context, INVALID, Packet, VALID, arguments, context};
use libloading::{Library, Symbol};
use std::ffi::{CString, c_char, c_void};
use std::rc::Rc;

/// Where it is looked for if `LUC_EMBREE` names no file.
const NAMES: [&str; 3] = ["libembree4.so.4", "libembree4.so", "libembree3.so.3"];

/// What is said if it isn't here.
pub const MISSING: &str = "Embree is skipped, as it is not here: LUC_EMBREE may name its library, which \
     Debian has in libembree4-4 or libembree3-3 and PyPI within the wheel embreex.";

/// Handles are pointers to what only the library knows.
type Handle = *mut c_void;

const VERSION: u32 = 0;
const TRIANGLES: u32 = 0;
const INDICES: u32 = 0;
const VERTICES: u32 = 1;
const THREE_INTEGERS: u32 = 0x5003;
const THREE_FLOATS: u32 = 0x9003;

type One<Between, After> = unsafe extern "C" fn(Handle, Between, After);
type Eight<Between, After> = unsafe extern "C" fn(*const i32, Handle, Between, After);
type Function<F> = Symbol<'static, F>;

/// The functions that ask. A ray to intersect begins with what an occlusion takes, so both have one type.
enum Ask {
    Three {
        intersect1: Function<One<*mut Context, *mut Packet<1>>>,
        occluded1: Function<One<*mut Context, *mut Packet<1>>>,
        intersect8: Function<Eight<*mut Context, *mut Packet<8>>>,
        occluded8: Function<Eight<*mut Context, *mut Packet<8>>>,
    },
    Four {
        intersect1: Function<One<*mut Packet<1>, *mut Arguments>>,
        occluded1: Function<One<*mut Packet<1>, *mut Arguments>>,
        intersect8: Function<Eight<*mut Packet<8>, *mut Arguments>>,
        occluded8: Function<Eight<*mut Packet<8>, *mut Arguments>>,
    },
}

/// The library's functions. It is never unloaded, so that they stay where they are.
struct Embree {
    version: isize,
    new_device: Function<unsafe extern "C" fn(*const c_char) -> Handle>,
    release_device: Function<unsafe extern "C" fn(Handle)>,
    new_scene: Function<unsafe extern "C" fn(Handle) -> Handle>,
    commit_scene: Function<unsafe extern "C" fn(Handle)>,
    release_scene: Function<unsafe extern "C" fn(Handle)>,
    new_geometry: Function<unsafe extern "C" fn(Handle, u32) -> Handle>,
    buffer: Function<unsafe extern "C" fn(Handle, u32, u32, u32, usize, usize) -> *mut c_void>,
    commit_geometry: Function<unsafe extern "C" fn(Handle)>,
    attach_geometry: Function<unsafe extern "C" fn(Handle, Handle) -> u32>,
    release_geometry: Function<unsafe extern "C" fn(Handle)>,
    ask: Ask,
}

/// A function of the library.
///
/// # Safety
///
/// `F` is the type that the library gives the function of this name.
unsafe fn function<F>(library: &'static Library, name: &str) -> Result<Function<F>, String> {
    // SAFETY: by the condition above.
    unsafe { library.get(name.as_bytes()) }.map_err(|_| format!("the library of Embree has no {name}"))
}

impl Embree {
    /// The functions, of whichever version it is.
    fn new(library: &'static Library) -> Result<Self, String> {
        // SAFETY: the types are those of Embree's reference, and where its versions differ the library's own is
        // asked first; that it is Embree is what its name says, or the user. A device's configuration may be
        // null; the device is asked only if there is one, and let go once.
        unsafe {
            let new_device: Function<unsafe extern "C" fn(*const c_char) -> Handle> =
                function(library, "rtcNewDevice")?;
            let release_device: Function<unsafe extern "C" fn(Handle)> =
                function(library, "rtcReleaseDevice")?;
            let property: Function<unsafe extern "C" fn(Handle, u32) -> isize> =
                function(library, "rtcGetDeviceProperty")?;
            let device = new_device(std::ptr::null());
            if device.is_null() {
                return Err("Embree makes no device on this processor".into());
            }
            let version = property(device, VERSION);
            release_device(device);
            let ask = match version / 10_000 {
                3 => Ask::Three {
                    intersect1: function(library, "rtcIntersect1")?,
                    occluded1: function(library, "rtcOccluded1")?,
                    intersect8: function(library, "rtcIntersect8")?,
                    occluded8: function(library, "rtcOccluded8")?,
                },
                4 => Ask::Four {
                    intersect1: function(library, "rtcIntersect1")?,
                    occluded1: function(library, "rtcOccluded1")?,
                    intersect8: function(library, "rtcIntersect8")?,
                    occluded8: function(library, "rtcOccluded8")?,
                },
                _ => return Err(format!("Embree has version {version} here, where 3 or 4 is known")),
            };
            Ok(Self {
                version,
                new_device,
                release_device,
                new_scene: function(library, "rtcNewScene")?,
                commit_scene: function(library, "rtcCommitScene")?,
                release_scene: function(library, "rtcReleaseScene")?,
                new_geometry: function(library, "rtcNewGeometry")?,
                buffer: function(library, "rtcSetNewGeometryBuffer")?,
                commit_geometry: function(library, "rtcCommitGeometry")?,
                attach_geometry: function(library, "rtcAttachGeometry")?,
                release_geometry: function(library, "rtcReleaseGeometry")?,
                ask,
            })
        }
    }

    /// A device of one thread, with an instruction set or as it chooses.
    fn device(&'static self, set: Option<&str>) -> Result<Device, String> {
        let set = set.map(|set| format!(",isa={set}")).unwrap_or_default();
        let config = CString::new(format!("threads=1,set_affinity=0{set}")).map_err(|e| e.to_string())?;
        // SAFETY: the configuration is text that ends with 0 and outlives the call.
        let handle = unsafe { (self.new_device)(config.as_ptr()) };
        if handle.is_null() { Err("Embree makes no device".into()) } else { Ok(Device(self, handle)) }
    }
}

/// A device, let go with its last owner.
struct Device(&'static Embree, Handle);

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: it came from this library and is let go once; scenes hold it alive themselves.
        unsafe { (self.0.release_device)(self.1) }
    }
}

/// A scene of triangles, asked ray by ray or by eights.
struct Tree {
    device: Rc<Device>,
    scene: Handle,
    eights: bool,
}

impl Tree {
    fn new(device: &Rc<Device>, triangles: &[[Vec3A; 3]], eights: bool) -> Self {
        let Device(embree, handle) = **device;
        let count = triangles.len();
        // SAFETY: all handles come from this library; the buffers are the library's own, of the lengths that
        // are asked for here, aligned for words, and are filled before anything reads them. A null buffer, for
        // want of memory, stays unfilled. The scene keeps the geometry alive.
        let scene = unsafe {
            let scene = (embree.new_scene)(handle);
            let geometry = (embree.new_geometry)(handle, TRIANGLES);
            let corners = (embree.buffer)(geometry, VERTICES, 0, THREE_FLOATS, 12, 3 * count);
            let indices = (embree.buffer)(geometry, INDICES, 0, THREE_INTEGERS, 12, count);
            if !corners.is_null() && !indices.is_null() {
                let (corners, indices) = (corners.cast::<[f32; 3]>(), indices.cast::<[u32; 3]>());
                for (i, corner) in triangles.iter().flatten().enumerate() {
                    corners.add(i).write(corner.to_array());
                }
                for i in 0..count {
                    indices.add(i).write([0, 1, 2].map(|k| 3 * i as u32 + k));
                }
            }
            (embree.commit_geometry)(geometry);
            (embree.attach_geometry)(scene, geometry);
            (embree.release_geometry)(geometry);
            (embree.commit_scene)(scene);
            scene
        };
        Self { device: device.clone(), scene, eights }
    }

    /// Asks one ray: for its nearest hit, or for any.
    fn ask1(&self, packet: &mut Packet<1>, any: bool) {
        // SAFETY: the scene is one of this library and committed; the packet is laid out and aligned as its
        // version wants it, with at least the room that it writes to; context and arguments are complete and
        // outlive the call, and null arguments stand for the default.
        unsafe {
            match &self.device.0.ask {
                Ask::Three { intersect1, occluded1, .. } => {
                    let ask = if any { occluded1 } else { intersect1 };
                    ask(self.scene, &mut context(false), packet);
                }
                Ask::Four { intersect1, occluded1, .. } => {
                    let ask = if any { occluded1 } else { intersect1 };
                    ask(self.scene, packet, std::ptr::null_mut());
                }
            }
        }
    }

    /// Asks eight rays, with a hint whether they run together.
    fn ask8(&self, packet: &mut Packet<8>, any: bool, together: bool) {
        let valid = VALID.0.as_ptr();
        // SAFETY: as above; the mask has eight lanes and the alignment of a packet.
        unsafe {
            match &self.device.0.ask {
                Ask::Three { intersect8, occluded8, .. } => {
                    let ask = if any { occluded8 } else { intersect8 };
                    ask(valid, self.scene, &mut context(together), packet);
                }
                Ask::Four { intersect8, occluded8, .. } => {
                    let ask = if any { occluded8 } else { intersect8 };
                    ask(valid, self.scene, packet, &mut arguments(together));
                }
            }
        }
    }
}

impl Drop for Tree {
    fn drop(&mut self) {
        // SAFETY: it came from this library, and this is its only owner.
        unsafe { (self.device.0.release_scene)(self.scene) }
    }
}

/// A distance as a tracer tells it: an occluded ray's end is -infinity afterwards, and one that hit nothing has
/// no geometry.
fn distance(far: f32, geometry: u32, any: bool) -> f32 {
    match any {
        true if far < 0.0 => -1.0,
        false if geometry != INVALID => far,
        _ => f32::INFINITY,
    }
}

impl Tracer for Tree {
    fn trace(&self, rays: &Rays, out: &mut [f32]) {
        let any = rays.kind == Kind::Shadow;
        if self.eights {
            let together = rays.kind != Kind::Diffuse;
            for first in (0..rays.len()).step_by(8) {
                let mut packet = Packet::<8>::new(rays, first);
                self.ask8(&mut packet, any, together);
                for (lane, out) in out[first..first + 8].iter_mut().enumerate() {
                    *out = distance(packet.0.far[lane], packet.0.geometry[lane], any);
                }
            }
        } else {
            for (i, out) in out.iter_mut().enumerate().take(rays.len()) {
                let mut packet = Packet::<1>::new(rays, i);
                self.ask1(&mut packet, any);
                *out = distance(packet.0.far[0], packet.0.geometry[0], any);
            }
        }
    }
}

/// Loads the library from the file that `LUC_EMBREE` names, else from where the system finds one of the names.
fn library() -> Result<Option<Library>, String> {
    // SAFETY: what runs on loading is Embree's own, or what the user names as that.
    let load = |name: &std::ffi::OsStr| unsafe { Library::new(name) };
    match std::env::var_os("LUC_EMBREE") {
        Some(path) => {
            let failed =
                |_| format!("LUC_EMBREE names {}, which can't be loaded as a library", path.display());
            load(&path).map(Some).map_err(failed)
        }
        None => Ok(NAMES.iter().find_map(|name| load(name.as_ref()).ok())),
    }
}

/// Embree as tracers, if it is here.
pub fn peers() -> Result<Vec<Peer>, String> {
    let Some(library) = library()? else { return Ok(Vec::new()) };
    // Never unloaded, as its functions and devices are asked to the end.
    let embree: &'static Embree = Box::leak(Box::new(Embree::new(Box::leak(Box::new(library)))?));
    let version = embree.version;
    let name = format!("Embree {}.{}.{}", version / 10_000, version / 100 % 100, version % 100);
    let same = if cfg!(target_arch = "x86_64") { Some("avx2") } else { None };
    let (narrow, free) = (Rc::new(embree.device(same)?), Rc::new(embree.device(None)?));
    let peer = |how: &str, device: &Rc<Device>, eights| {
        let device = device.clone();
        Peer {
            name: format!("{name}, {how}"),
            group: if eights { Group::EmbreeEights } else { Group::EmbreeSingle },
            build: Box::new(move |triangles| Box::new(Tree::new(&device, triangles, eights))),
        }
    };
    Ok(vec![
        peer("AVX2, single", &narrow, false),
        peer("AVX2, eights", &narrow, true),
        peer("its choice, eights", &free, true),
    ])
}
