//! minifb: no messages but the player's own, and nothing that the player doesn't use.
//!
//! Its frames have the size of the window, so nothing is scaled; it reads keys by a callback, and no
//! text, mouse or menus; it ends with the process, so nothing is given back.

use super::super::edit::Source;
use crate::Error;
use std::collections::BTreeSet;
use std::path::Path;

/// Trims the crate; `keys` are the keys that the player names.
pub fn trim(source: &mut Source, keys: &BTreeSet<String>) -> Result<(), Error> {
    let edit = "shorten its messages";
    let x11 = "src/os/posix/x11.rs";
    for message in ["failed to load Xlib: {:?}", "illegal width: {}", "illegal height: {}"] {
        let old = format!("|e| Error::WindowCreate(format!(\"{message}\", e))");
        source.replace_text(x11, &old, "|_| Error::WindowCreate(String::new())", edit)?;
    }
    for message in [
        "XOpenDisplay failed",
        "No 32-bit format available",
        "Unable to open Window",
        "Unable to create pixel buffer",
        "Window name too long",
    ] {
        source.replace_text(x11, &format!("\"{message}\".to_owned()"), "String::new()", edit)?;
    }
    for message in ["Buffer size too large", "Update failed because input buffer is empty"] {
        source.replace_text("src/lib.rs", &format!("\"{message}\".to_string()"), "String::new()", edit)?;
    }
    let (start, end) =
        ("        let err = format!(\n        \"Update failed", "        Err(Error::UpdateFailed(err))");
    source.replace("src/lib.rs", start, end, "        let err = String::new();\n", edit)?;

    let edit = "leave out what the player doesn't use";
    // Text: the compose key, and the settings that it depends on.
    source.replace_text(
        x11,
        "            libc::setlocale(libc::LC_ALL, std::ptr::null()); //needed to make compose key work\n",
        "",
        edit,
    )?;
    source.replace(
        x11,
        "            let empty_string = b\"\\0\";\n",
        "            (d.lib.XSelectInput)(d.display, handle, KeyPressMask | KeyReleaseMask);",
        "",
        edit,
    )?;
    source.replace_text(
        x11,
        "                xim,\n                xic,\n",
        "                xim: std::ptr::null_mut(),\n                xic: std::ptr::null_mut(),\n",
        edit,
    )?;
    source.replace(
        x11,
        "            //skip any events that need to get eaten",
        "            // Don't process any more messages if",
        "",
        edit,
    )?;
    source.replace_text(
        x11,
        "                self.emit_code_point_chars_to_callback(&mut ev.key);\n",
        "",
        edit,
    )?;
    source.replace(
        x11,
        "    fn emit_code_point_chars_to_callback",
        "    unsafe fn process_button",
        "",
        edit,
    )?;
    // The mouse and its cursors, of which only the one that shows nothing is needed.
    source.replace(
        x11,
        "            let cursor_lib = xcursor::",
        "            let display = (lib.XOpenDisplay)",
        "",
        edit,
    )?;
    source.replace_text(x11, "                cursor_lib,\n", "", edit)?;
    source.replace_text(x11, "    cursor_lib: x11_dl::xcursor::Xcursor,\n", "", edit)?;
    source.replace_text(x11, "        display.init_cursors();\n", "", edit)?;
    source.replace(x11, "    fn init_cursors(&mut self)", "    fn init_atoms(&mut self)", "", edit)?;
    source.replace_text(x11, "            self.raw_get_mouse_pos();\n", "", edit)?;
    source.replace(x11, "    unsafe fn raw_get_mouse_pos", "    unsafe fn raw_process_events", "", edit)?;
    source.replace(
        x11,
        "            xlib::ButtonPress => {",
        "            xlib::ConfigureNotify => {",
        "",
        edit,
    )?;
    source.replace(x11, "    unsafe fn process_button", "    fn update_key_state", "", edit)?;
    // When keys were pressed and frames shown.
    for file in ["src/key_handler.rs", "src/rate.rs"] {
        let new = "prev_time: unsafe { std::mem::zeroed() },";
        source.replace_text(file, "prev_time: Instant::now(),", new, edit)?;
    }
    // How long keys have been down, and all keys but those in use.
    source.replace_text(x11, "        self.key_handler.update();\n", "", edit)?;
    source.replace_text(x11, "            let mut supported = 0;\n            (lib.XkbSetDetectableAutoRepeat)(display, 1, &mut supported);\n", "", edit)?;
    if !keys.iter().any(|key| key.starts_with("NumPad")) {
        source.replace_text(x11, "        display.check_extensions()?;\n", "", edit)?;
        source.replace(
            x11,
            "    fn check_extensions(&mut self)",
            "    fn init_atoms(&mut self)",
            "",
            edit,
        )?;
        source.replace(x11, "        // handle special keys...", "        // normal keys...", "", edit)?;
    }
    let used = |line: &str| match line.trim().split_once(" => Key::") {
        Some((_, key)) => keys.contains(key.trim_end_matches(',')),
        None => true,
    };
    source.keep_lines(x11, used, edit)?;
    // Scaling, a pace kept to the microsecond, menus, and what ends with the process anyway.
    source.replace(
        x11,
        "        match self.scale_mode {",
        "        (self.d.lib.XPutImage)(",
        MINIFB_BLIT,
        edit,
    )?;
    source.replace(
        "src/rate.rs",
        "        let now = Instant::now();\n        let elapsed",
        "    }\n\n    #[inline]\n    pub fn get_delta_time",
        MINIFB_PACE,
        edit,
    )?;
    source.replace_text(
        x11,
        "    menus: Vec<UnixMenu>,\n",
        "    menus: std::mem::ManuallyDrop<Vec<UnixMenu>>,\n",
        edit,
    )?;
    source.replace_text(
        x11,
        "                menus: Vec::new(),\n",
        "                menus: std::mem::ManuallyDrop::new(Vec::new()),\n",
        edit,
    )?;
    source.replace(
        x11,
        "impl Drop for DisplayInfo {",
        "#[derive(Clone, Copy, Eq, PartialEq)]\nenum ProcessEventResult",
        "",
        edit,
    )?;
    source.cut_from(x11, "impl Drop for Window {", edit)?;

    // What only sees to transparent windows, to windows of one size, and to their places and threads.
    for (start, end, new) in [
        ("            if (lib.XInitThreads)()", "            let display = (lib.XOpenDisplay)", ""),
        ("            let mut vinfo: xlib", "            let gc = (lib.XDefaultGC)", MINIFB_SCREEN),
        ("            let gc = (lib.XDefaultGC)", "            let screen_width", MINIFB_NO_GC),
        ("            let context = (lib.Xrm", "            Ok(DisplayInfo {", MINIFB_NO_CONTEXT),
        ("            if opts.transparency {", "            attributes.backing_store", ""),
        ("            if !opts.resize ||", "            if opts.borderless ||", ""),
        (
            "        unsafe {\n            (self.d.lib.XMoveWindow)",
            GET_POSITION,
            "        _ = (x, y);\n    }\n\n",
        ),
        ("        let (x, y);\n", GET_SIZE, "        (0, 0)\n    }\n\n"),
        ("                /* After XkbSet", "                self.process_key(ev, false", ""),
    ] {
        source.replace(x11, start, end, new, edit)?;
    }
    for line in [
        "            (d.lib.XSelectInput)(d.display, handle, KeyPressMask | KeyReleaseMask);\n",
        "            (d.lib.XClearWindow)(d.display, handle);\n",
        "                    (d.lib.XDestroyWindow)(d.display, handle);\n",
    ] {
        source.replace_text(x11, line, "", edit)?;
    }

    let edit = "pass its title on";
    source.replace(
        x11,
        "        let name = match CString::new(name) {",
        "        // FIXME: this DisplayInfo should be",
        MINIFB_TITLE,
        edit,
    )?;
    Ok(())
}

/// The keys that the player's sources name as minifb does.
pub fn named_keys(root: &Path) -> Result<BTreeSet<String>, Error> {
    let mut keys = BTreeSet::new();
    let mut directories = vec![root.join("src")];
    while let Some(directory) = directories.pop() {
        for entry in std::fs::read_dir(&directory).map_err(Error::file(&directory))? {
            let path = entry.map_err(Error::file(&directory))?.path();
            if path.is_dir() {
                directories.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = std::fs::read_to_string(&path).map_err(Error::file(&path))?;
                let name = |rest: &str| rest.split(|c: char| !c.is_alphanumeric()).next().map(str::to_owned);
                keys.extend(text.split("Key::").skip(1).filter_map(name));
            }
        }
    }
    Ok(keys)
}

const MINIFB_BLIT: &str = r#"        for row in 0..buf_height.min(self.height as usize) {
            std::ptr::copy_nonoverlapping(
                buffer.as_ptr().add(row * buf_stride),
                self.draw_buffer.as_mut_ptr().add(row * self.width as usize),
                buf_width.min(self.width as usize),
            );
        }

"#;

const MINIFB_SCREEN: &str = r#"            screen = (lib.XDefaultScreen)(display);
            visual = (lib.XDefaultVisual)(display, screen);
            depth = (lib.XDefaultDepth)(display, screen);
            let _ = transparency;

"#;

const MINIFB_NO_GC: &str = "            let gc = std::ptr::null_mut();\n\n";

const MINIFB_NO_CONTEXT: &str = "            let context = 0;\n\n";

const GET_POSITION: &str = "    #[inline]\n    pub fn get_position";

const GET_SIZE: &str = "    #[inline]\n    pub fn get_size";

const MINIFB_PACE: &str = r#"        if let Some(target_rate) = self.target_rate {
            unsafe { libc::usleep(target_rate.as_micros() as u32) };
        }
"#;

const MINIFB_TITLE: &str = r#"        let name = [name.as_bytes(), b"\0"].concat();
        let name = unsafe { CStr::from_bytes_with_nul_unchecked(&name) };

"#;
