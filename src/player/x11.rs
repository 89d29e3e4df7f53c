//! What minifb leaves out on X11: the screen's size, full screen under a window manager, and a quiet end
//! when the window is taken away.
//!
//! libX11 is loaded when needed, as minifb does, so that `--frame` works where it is not installed.
//! Elsewhere than on Linux these functions know nothing and do nothing.

use super::text::{Text, join};
pub use system::Screen;

/// The answer to a missing display.
pub fn no_display() -> Text {
    join(&[b"no display: set DISPLAY, or write a frame with --frame N"])
}

#[cfg(not(target_os = "linux"))]
mod system {
    use std::ffi::c_void;

    /// The screen, of which nothing is known.
    pub struct Screen {
        /// Width and height, if they can be found.
        pub size: Option<(usize, usize)>,
    }

    impl Screen {
        /// Always there; opening the window will tell.
        pub fn find() -> Result<Self, super::Text> {
            Ok(Screen { size: None })
        }

        /// Asks for the whole screen.
        pub fn cover(&self, _window: *mut c_void) {}
    }
}

#[cfg(target_os = "linux")]
mod system {
    use super::super::library::Library;
    use super::{Text, join, no_display};
    use std::ffi::{c_char, c_int, c_long, c_ulong, c_void};
    use std::ptr::null;

    unsafe extern "C" {
        // The standard library's own exit would bring its buffered standard output along.
        safe fn exit(code: c_int) -> !;
    }

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

    /// A request failed. A window that is gone was closed by force, which ends the program like any
    /// other way of closing; without this Xlib prints a report and ends with code 1.
    extern "C" fn on_error(_: Display, event: *const ErrorEvent) -> c_int {
        const BAD_WINDOW: u8 = 3;
        const BAD_DRAWABLE: u8 = 9;
        // SAFETY: Xlib passes a valid event.
        let code = unsafe { (*event).code };
        if code == BAD_WINDOW || code == BAD_DRAWABLE {
            exit(0);
        }
        super::super::complain(b"the display refused the window; write a frame with --frame N");
        exit(super::super::REFUSED);
    }

    /// The connection is gone: the window was killed, or its display has ended.
    extern "C" fn on_lost(_: Display) -> c_int {
        exit(0);
    }

    /// The screen and a connection of our own to it. The connection stays open: a display whose last
    /// connection closes starts anew and refuses the next one for a moment.
    pub struct Screen {
        /// Width and height, if they can be found.
        pub size: Option<(usize, usize)>,
        library: Library,
        display: Display,
        root: Id,
    }

    impl Screen {
        /// Finds the screen and makes the end of the window or the display a quiet one.
        pub fn find() -> Result<Self, Text> {
            // minifb uses it too.
            let Some(library) = Library::open(c"libX11.so.6") else {
                return Err(join(&[b"no display: install libX11, or write a frame with --frame N"]));
            };
            Screen::connect(library).ok_or_else(no_display)
        }

        fn connect(library: Library) -> Option<Screen> {
            type Open = extern "C" fn(*const c_char) -> Display;
            type Root = extern "C" fn(Display) -> Id;
            type SetError = extern "C" fn(extern "C" fn(Display, *const ErrorEvent) -> c_int) -> *mut c_void;
            type SetLost = extern "C" fn(extern "C" fn(Display) -> c_int) -> *mut c_void;
            type Sides = extern "C" fn(Display, c_int) -> c_int;
            const FIRST_SCREEN: c_int = 0;
            // SAFETY: the types are those in Xlib.h.
            unsafe {
                let display = library.function::<Open>(c"XOpenDisplay")?(null());
                if display.is_null() {
                    return None;
                }
                library.function::<SetError>(c"XSetErrorHandler")?(on_error);
                library.function::<SetLost>(c"XSetIOErrorHandler")?(on_lost);
                let root = library.function::<Root>(c"XDefaultRootWindow")?(display);
                let width = library.function::<Sides>(c"XDisplayWidth")?(display, FIRST_SCREEN);
                let height = library.function::<Sides>(c"XDisplayHeight")?(display, FIRST_SCREEN);
                // At least 1 in the protocol.
                Some(Screen { size: Some((width as usize, height as usize)), library, display, root })
            }
        }

        /// Asks the window manager, if there is one, to give the window the whole of its monitor.
        pub fn cover(&self, window: *mut c_void) {
            // A window manager that cannot be asked leaves a window that covers the screen anyway.
            let _ = self.ask(window as Id);
        }

        fn ask(&self, window: Id) -> Option<()> {
            type Intern = extern "C" fn(Display, *const c_char, c_int) -> Id;
            type Send = extern "C" fn(Display, Id, c_int, c_long, *mut ClientMessage) -> c_int;
            type Flush = extern "C" fn(Display) -> c_int;
            const CLIENT_MESSAGE: c_int = 33;
            const TO_WINDOW_MANAGER: c_long = 1 << 20 | 1 << 19;
            const ADD: c_long = 1;
            const FROM_APPLICATION: c_long = 1;
            // SAFETY: the types are those in Xlib.h; the message is as long as an XEvent.
            unsafe {
                let intern: Intern = self.library.function(c"XInternAtom")?;
                let full = intern(self.display, c"_NET_WM_STATE_FULLSCREEN".as_ptr(), 0);
                let mut message = ClientMessage {
                    kind: CLIENT_MESSAGE,
                    serial: 0,
                    sent: 1,
                    display: self.display,
                    window,
                    message: intern(self.display, c"_NET_WM_STATE".as_ptr(), 0),
                    format: 32,
                    data: [ADD, full as c_long, 0, FROM_APPLICATION, 0],
                    rest: [0; 12],
                };
                self.library.function::<Send>(c"XSendEvent")?(
                    self.display,
                    self.root,
                    0,
                    TO_WINDOW_MANAGER,
                    &mut message,
                );
                self.library.function::<Flush>(c"XFlush")?(self.display);
            }
            Some(())
        }
    }
}
