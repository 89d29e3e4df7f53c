//! The sound card, by ALSA's library, which PipeWire and PulseAudio serve too. All unsafe code of the
//! sound is here.
//!
//! Why it is sound: the types of the functions are those of `alsa/pcm.h` and `alsa/error.h`; the handle
//! comes from `snd_pcm_open`, is never closed, and is used by the one thread that has the [`Device`] (a
//! raw pointer keeps it there); buffers are given with their own lengths.

use super::library::Library;
use super::sound::perform;
use super::stage::Stage;
use luc_core::synth::RATE;
use std::ffi::{CStr, c_char, c_int, c_long, c_uint, c_ulong, c_void};
use std::ptr::{null, null_mut};

type Pcm = *mut c_void;

/// What the card may hold, microseconds: enough to ride out a busy machine. The picture knows of it.
const LATENCY: c_uint = 250_000;

/// A card that plays two channels of 16 bits, [`RATE`] samples a second.
pub struct Device {
    pcm: Pcm,
    write: unsafe extern "C" fn(Pcm, *const c_void, c_ulong) -> c_long,
    delay: unsafe extern "C" fn(Pcm, *mut c_long) -> c_int,
    recover: unsafe extern "C" fn(Pcm, c_int, c_int) -> c_int,
    drain: unsafe extern "C" fn(Pcm) -> c_int,
}

/// The library's own messages are not for standard error. It passes more arguments after these, which
/// the caller puts away on the systems of this module.
extern "C" fn quiet(_: *const c_char, _: c_int, _: *const c_char, _: c_int, _: *const c_char) {}

unsafe extern "C" {
    fn pthread_create(
        thread: *mut c_ulong,
        attributes: *const c_void,
        start: extern "C" fn(*mut c_void) -> *mut c_void,
        argument: *mut c_void,
    ) -> c_int;
}

/// Calls [`perform`] on a thread of its own; false if the system refuses. The standard library's
/// threads, with names, handles and destructors, would cost the packed file a kilobyte.
pub fn start_thread(stage: &'static Stage) -> bool {
    extern "C" fn start(stage: *mut c_void) -> *mut c_void {
        // SAFETY: it is the stage below, which is shared between threads and lives for ever.
        perform(unsafe { &*stage.cast::<Stage>() });
        null_mut()
    }
    const { assert_shared::<Stage>() };
    let (mut thread, stage) = (0, (&raw const *stage).cast_mut().cast());
    // SAFETY: `start` is of the type that the C library wants and takes what it is given.
    unsafe { pthread_create(&mut thread, null(), start, stage) == 0 }
}

const fn assert_shared<T: Sync>() {}

impl Device {
    /// Opens the card that is the user's default; or says why there is none.
    pub fn open() -> Result<Device, &'static [u8]> {
        let library =
            Library::open(c"libasound.so.2").ok_or(&b"no sound: libasound.so.2 is not installed"[..])?;
        Device::find(&library).ok_or(b"no sound: the sound card is absent or busy")
    }

    fn find(library: &Library) -> Option<Device> {
        type Quieten = extern "C" fn(*const c_char, c_int, *const c_char, c_int, *const c_char);
        type SetHandler = unsafe extern "C" fn(Quieten) -> c_int;
        type Open = unsafe extern "C" fn(*mut Pcm, *const c_char, c_int, c_int) -> c_int;
        type NonBlock = unsafe extern "C" fn(Pcm, c_int) -> c_int;
        type SetParams = unsafe extern "C" fn(Pcm, c_int, c_int, c_uint, c_uint, c_int, c_uint) -> c_int;
        const PLAYBACK: c_int = 0;
        const NON_BLOCKING: c_int = 1;
        const BLOCKING: c_int = 0;
        const S16_LE: c_int = 2;
        const INTERLEAVED: c_int = 3;
        const RESAMPLE: c_int = 1;
        const DEFAULT: &CStr = c"default";
        // SAFETY: see the head of this file.
        unsafe {
            library.function::<SetHandler>(c"snd_lib_error_set_handler")?(quiet);
            let mut pcm = null_mut();
            // A busy card would make an open that blocks wait for ever.
            let opened = library.function::<Open>(c"snd_pcm_open")?(
                &mut pcm,
                DEFAULT.as_ptr(),
                PLAYBACK,
                NON_BLOCKING,
            );
            let ready = opened == 0
                && library.function::<NonBlock>(c"snd_pcm_nonblock")?(pcm, BLOCKING) == 0
                && library.function::<SetParams>(c"snd_pcm_set_params")?(
                    pcm,
                    S16_LE,
                    INTERLEAVED,
                    2,
                    RATE,
                    RESAMPLE,
                    LATENCY,
                ) == 0;
            let write = library.function(c"snd_pcm_writei")?;
            let delay = library.function(c"snd_pcm_delay")?;
            let recover = library.function(c"snd_pcm_recover")?;
            let drain = library.function(c"snd_pcm_drain")?;
            ready.then_some(Device { pcm, write, delay, recover, drain })
        }
    }

    /// Hands all of `samples` to the card, and waits while it is full. False if the card is lost.
    pub fn write(&mut self, mut samples: &[[i16; 2]]) -> bool {
        const SILENTLY: c_int = 1;
        while !samples.is_empty() {
            // SAFETY: see the head of this file.
            let written =
                unsafe { (self.write)(self.pcm, samples.as_ptr().cast(), samples.len() as c_ulong) };
            if written >= 0 {
                samples = samples.get(written as usize..).unwrap_or_default();
            // SAFETY: likewise. An underrun or a suspended machine is put right, anything else is the end.
            } else if unsafe { (self.recover)(self.pcm, written as c_int, SILENTLY) } < 0 {
                return false;
            }
        }
        true
    }

    /// Waits until all that has been written is heard; even what was too little to begin with.
    pub fn finish(&mut self) {
        // SAFETY: see the head of this file.
        unsafe { (self.drain)(self.pcm) };
    }

    /// Samples that have been written and not yet heard.
    pub fn delay(&mut self) -> u64 {
        let mut delay = 0;
        // SAFETY: see the head of this file.
        let told = unsafe { (self.delay)(self.pcm, &mut delay) } == 0;
        if told { delay.max(0) as u64 } else { 0 }
    }
}
