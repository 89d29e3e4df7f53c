//! What minifb leaves out on X11: the screen's size, full screen under a window manager, and a quiet end
//! when the window is taken away.
//!
//! libX11 is loaded when needed, as minifb does, so that `--frame` works where it is not installed.
//! Elsewhere than on Linux these functions know nothing and do nothing.

use super::text::{Text, join};
pub use system::{cover_screen, screen};

/// The answer to a missing display.
pub fn no_display() -> Text {
    join(&[b"no display: set DISPLAY, or write a frame with --frame N"])
}

#[cfg(not(target_os = "linux"))]
mod system {
    use std::ffi::c_void;

    /// The screen's size, if it can be found.
    pub fn screen() -> Result<Option<(usize, usize)>, super::Text> {
        Ok(None)
    }

    /// Asks for the whole screen.
    pub fn cover_screen(_window: *mut c_void) {}
}

#[cfg(target_os = "linux")]
mod system {
    use super::{Text, join, no_display};
    use std::ffi::{CStr, c_char, c_int, c_long, c_uint, c_ulong, c_void};
    use std::mem::transmute;
    use std::ptr::{null, null_mut};

    unsafe extern "C" {
        fn dlopen(name: *const c_char, flags: c_int) -> *mut c_void;
        fn dlsym(library: *mut c_void, name: *const c_char) -> *mut c_void;
    }
    const RTLD_LAZY: c_int = 1;

    type Display = *mut c_void;
    type Id = c_ulong;

    #[repr(C)]
    struct ErrorEvent {
        kind: c_int,
        display: Display,
        resource: Id,
        serial: c_ulong,
        code: u8,
    }

    #[repr(C)]
    struct ClientMessage {
        kind: c_int,
        serial: c_ulong,
        sent: c_int,
        display: Display,
        window: Id,
        message: Id,
        format: c_int,
        data: [c_long; 5],
        /// The library copies a whole XEvent, 24 words.
        rest: [c_long; 12],
    }

    /// libX11, loaded once; it stays loaded, because minifb uses it too.
    struct Library(*mut c_void);

    impl Library {
        fn load() -> Option<Self> {
            // SAFETY: the name is a C string; libX11 has no initialiser with requirements.
            let library = unsafe { dlopen(c"libX11.so.6".as_ptr(), RTLD_LAZY) };
            (!library.is_null()).then_some(Library(library))
        }

        fn find(&self, name: &CStr) -> Option<*mut c_void> {
            // SAFETY: the handle is open and the name is a C string.
            let found = unsafe { dlsym(self.0, name.as_ptr()) };
            (!found.is_null()).then_some(found)
        }

        /// A connection of our own and the root window.
        fn connect(&self) -> Option<(Display, Id)> {
            let open = self.find(c"XOpenDisplay")?;
            let root = self.find(c"XDefaultRootWindow")?;
            // SAFETY: these are the functions' types in Xlib.h; no name means the one in DISPLAY.
            unsafe {
                let open: extern "C" fn(*const c_char) -> Display = transmute(open);
                let root: extern "C" fn(Display) -> Id = transmute(root);
                let display = open(null());
                (!display.is_null()).then(|| (display, root(display)))
            }
        }

        fn disconnect(&self, display: Display) {
            if let Some(close) = self.find(c"XCloseDisplay") {
                // SAFETY: the type in Xlib.h; the display is open and not used again.
                unsafe { transmute::<*mut c_void, extern "C" fn(Display) -> c_int>(close)(display) };
            }
        }
    }

    /// A request failed. A window that is gone was closed by force, which ends the program like any
    /// other way of closing; without this Xlib prints a report and ends with code 1.
    extern "C" fn on_error(_: Display, event: *const ErrorEvent) -> c_int {
        const BAD_WINDOW: u8 = 3;
        const BAD_DRAWABLE: u8 = 9;
        // SAFETY: Xlib passes a valid event.
        let code = unsafe { (*event).code };
        if code == BAD_WINDOW || code == BAD_DRAWABLE {
            std::process::exit(0);
        }
        super::super::complain(b"the display refused the window; write a frame with --frame N");
        std::process::exit(super::super::REFUSED);
    }

    /// The connection is gone: the window was killed, or its display has ended.
    extern "C" fn on_lost(_: Display) -> c_int {
        std::process::exit(0);
    }

    /// The screen's size, if it can be found; fails if there is no display. Also makes the end of the
    /// window or the display a quiet one.
    pub fn screen() -> Result<Option<(usize, usize)>, Text> {
        let Some(x11) = Library::load() else {
            return Err(join(&[b"no display: install libX11, or write a frame with --frame N"]));
        };
        let (display, root) = x11.connect().ok_or_else(no_display)?;
        let mut size = None;
        if let (Some(geometry), Some(set_error), Some(set_lost)) =
            (x11.find(c"XGetGeometry"), x11.find(c"XSetErrorHandler"), x11.find(c"XSetIOErrorHandler"))
        {
            type Geometry = extern "C" fn(
                Display,
                Id,
                *mut Id,
                *mut c_int,
                *mut c_int,
                *mut c_uint,
                *mut c_uint,
                *mut c_uint,
                *mut c_uint,
            ) -> c_int;
            type SetError = extern "C" fn(extern "C" fn(Display, *const ErrorEvent) -> c_int) -> *mut c_void;
            type SetLost = extern "C" fn(extern "C" fn(Display) -> c_int) -> *mut c_void;
            let (mut id, mut x, mut y) = (0, 0, 0);
            let (mut width, mut height, mut border, mut depth) = (0, 0, 0, 0);
            // SAFETY: these are the functions' types in Xlib.h, and all pointers are to live variables.
            unsafe {
                transmute::<*mut c_void, SetError>(set_error)(on_error);
                transmute::<*mut c_void, SetLost>(set_lost)(on_lost);
                let geometry: Geometry = transmute(geometry);
                let (w, h, b, d) = (&mut width, &mut height, &mut border, &mut depth);
                geometry(display, root, &mut id, &mut x, &mut y, w, h, b, d);
            }
            if width > 0 && height > 0 {
                size = Some((width as usize, height as usize));
            }
        }
        x11.disconnect(display);
        Ok(size)
    }

    /// Asks the window manager, if there is one, to give the window the whole of its monitor.
    pub fn cover_screen(window: *mut c_void) {
        const CLIENT_MESSAGE: c_int = 33;
        const TO_WINDOW_MANAGER: c_long = 1 << 20 | 1 << 19;
        const ADD: c_long = 1;
        const FROM_APPLICATION: c_long = 1;
        let Some(x11) = Library::load() else { return };
        let (Some(atom), Some(send)) = (x11.find(c"XInternAtom"), x11.find(c"XSendEvent")) else { return };
        let Some((display, root)) = x11.connect() else { return };
        type Send = extern "C" fn(Display, Id, c_int, c_long, *mut ClientMessage) -> c_int;
        // SAFETY: these are the functions' types in Xlib.h; the message is as long as an XEvent.
        unsafe {
            let atom: extern "C" fn(Display, *const c_char, c_int) -> Id = transmute(atom);
            let send: Send = transmute(send);
            let mut message = ClientMessage {
                kind: CLIENT_MESSAGE,
                serial: 0,
                sent: 1,
                display: null_mut(),
                window: window as Id,
                message: atom(display, c"_NET_WM_STATE".as_ptr(), 0),
                format: 32,
                data: [
                    ADD,
                    atom(display, c"_NET_WM_STATE_FULLSCREEN".as_ptr(), 0) as c_long,
                    0,
                    FROM_APPLICATION,
                    0,
                ],
                rest: [0; 12],
            };
            send(display, root, 0, TO_WINDOW_MANAGER, &mut message);
        }
        x11.disconnect(display);
    }
}
