//! Libraries that are opened when they are needed, so that the program starts without them.

use std::ffi::{CStr, c_char, c_int, c_void};

unsafe extern "C" {
    fn dlopen(name: *const c_char, flags: c_int) -> *mut c_void;
    fn dlsym(library: *mut c_void, name: *const c_char) -> *mut c_void;
}
const RTLD_LAZY: c_int = 1;

/// An open library. It stays open: what it hands out may be used as long as the program runs.
pub struct Library(*mut c_void);

impl Library {
    /// Opens a library by its file name, if it is installed.
    pub fn open(name: &CStr) -> Option<Self> {
        // SAFETY: the name is a C string; the libraries that are opened here have initializers without
        // requirements.
        let library = unsafe { dlopen(name.as_ptr(), RTLD_LAZY) };
        (!library.is_null()).then_some(Library(library))
    }

    /// A function of the library.
    ///
    /// # Safety
    /// `F` must be the type that the library's header gives it, as an `extern "C"` function.
    pub unsafe fn function<F: Copy>(&self, name: &CStr) -> Option<F> {
        const { assert!(size_of::<F>() == size_of::<*mut c_void>()) };
        // SAFETY: the library is open and the name is a C string.
        let found = unsafe { dlsym(self.0, name.as_ptr()) };
        // SAFETY: `F` is a function's type, so says the caller, and as large as a pointer.
        (!found.is_null()).then(|| unsafe { std::mem::transmute_copy(&found) })
    }
}
