//! x11-dl: only the functions that are called, found by one loop over one string of names.
//!
//! The published crate has 767 functions of libX11 alone, each looked up by its own code, with its
//! own error message.

use super::super::edit::Source;
use crate::Error;
use std::collections::BTreeSet;

/// The names that start with X and are called as functions of a library in minifb's source.
pub fn called_functions(minifb: &Source) -> Result<BTreeSet<String>, Error> {
    let edit = "find what it calls of X11";
    let text = minifb.text("src/os/posix/x11.rs").ok_or_else(|| minifb.unknown(edit))?;
    let name = |rest: &str| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().map(str::to_owned);
    let names: BTreeSet<String> =
        text.split("lib.").skip(1).filter_map(name).filter(|n| n.starts_with('X')).collect();
    if names.contains("XOpenDisplay") && names.contains("XPutImage") {
        Ok(names)
    } else {
        Err(minifb.unknown(edit))
    }
}

/// Cuts the crate down to the functions `called`.
pub fn trim(source: &mut Source, called: &BTreeSet<String>) -> Result<(), Error> {
    let edit = "cut the function tables down";
    let mut missing = called.clone();
    for file in ["src/xlib.rs", "src/xcursor.rs"] {
        let keep = |line: &str| {
            let Some(rest) = line.strip_prefix("  pub fn X") else { return true };
            let Some((name, _)) = rest.split_once(" (") else { return true };
            let name = format!("X{name}");
            missing.remove(&name);
            called.contains(&name)
        };
        source.keep_lines(file, keep, edit)?;
    }
    if !missing.is_empty() {
        return Err(source.unknown(edit));
    }

    let edit = "replace the loader";
    let file = "src/link.rs";
    source.replace(file, "use std::ffi::{CStr, CString};", "//\n// x11_link!\n//", X11_IMPORTS, edit)?;
    source.replace(
        file,
        "    #[allow(clippy::manual_non_exhaustive)]",
        "//\n// DynamicLibrary\n//",
        X11_TABLE,
        edit,
    )?;
    source.replace(
        file,
        "pub struct DynamicLibrary {",
        "impl Drop for DynamicLibrary {",
        X11_LOADER,
        edit,
    )?;
    source.replace(file, "impl Drop for DynamicLibrary {", "unsafe impl Send for DynamicLibrary {}", "", edit)
}

const X11_IMPORTS: &str = "use std::os::raw::{c_char, c_void};\n\n";

const X11_TABLE: &str = r#"    #[repr(C)]
    pub struct $struct_name {
      $(pub $fn_name: unsafe extern "C" fn ($($param_type),*) -> $ret_type,)*
      $(pub $vfn_name: unsafe extern "C" fn ($($vparam_type),+, ...) -> $vret_type,)*
      $(pub $var_name: *mut $var_type,)*
      _private: (),
    }

    unsafe impl Send for $struct_name {}
    unsafe impl Sync for $struct_name {}

    impl $struct_name {
      pub fn open () -> Result<$struct_name, $crate::error::OpenError> {
        const LIBRARIES: &str = concat!($($lib_name, "\0",)* "\0");
        const NAMES: &str = concat!(
          $(stringify!($fn_name), "\0",)*
          $(stringify!($vfn_name), "\0",)*
          $(stringify!($var_name), "\0",)*
          "\0"
        );
        let mut table = ::std::mem::MaybeUninit::<$struct_name>::uninit();
        unsafe {
          if $crate::link::load(LIBRARIES.as_ptr().cast(), NAMES.as_ptr().cast(), table.as_mut_ptr().cast()) {
            Ok(table.assume_init())
          } else {
            Err($crate::error::OpenError::new($crate::error::OpenErrorKind::Library, String::new()))
          }
        }
      }
    }
  };
}

"#;

const X11_LOADER: &str = r#"/// Opens the first library that is there, and fills `table` with the addresses of `names`. Both
/// lists are strings one behind the other, ended by an empty one.
#[inline(never)]
pub unsafe fn load(mut libraries: *const c_char, mut names: *const c_char, mut table: *mut *mut c_void) -> bool {
    let mut library: *mut c_void = std::ptr::null_mut();
    while library.is_null() {
        if *libraries == 0 {
            return false;
        }
        library = libc::dlopen(libraries, libc::RTLD_LAZY);
        libraries = libraries.add(libc::strlen(libraries) + 1);
    }
    while *names != 0 {
        *table = libc::dlsym(library, names);
        if (*table).is_null() {
            return false;
        }
        table = table.add(1);
        names = names.add(libc::strlen(names) + 1);
    }
    true
}

pub struct DynamicLibrary;

"#;
