//! The trimmed copies of dependencies.
//!
//! Made of the sources that cargo has downloaded, at build time. Every edit checks that it finds
//! what it was written for, so that a new version of a crate stops the build with a sentence
//! instead of going wrong.

use super::edit::Source;
use crate::Error;
use std::collections::BTreeSet;
use std::path::Path;

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

/// x11-dl: only the functions that are called, found by one loop over one string of names.
///
/// The published crate has 767 functions of libX11 alone, each looked up by its own code, with its
/// own error message.
pub fn x11_dl(source: &mut Source, called: &BTreeSet<String>) -> Result<(), Error> {
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

/// wide: every operation in line, as the single instruction that it is.
///
/// Compiling for size, the compiler would else call a function for a comparison of eight lanes.
pub fn wide(source: &mut Source) -> Result<(), Error> {
    source.replace_everywhere("#[inline]", "#[inline(always)]", "put its operations in line")
}

/// minifb: no messages but the player's own, and nothing that the player doesn't use.
///
/// Its frames have the size of the window, so nothing is scaled; it reads keys by a callback, and no
/// text, mouse or menus; it ends with the process, so nothing is given back. `keys` are the keys that it names.
pub fn minifb(source: &mut Source, keys: &BTreeSet<String>) -> Result<(), Error> {
    let edit = "shorten its messages";
    let x11 = "src/os/posix/x11.rs";
    for message in ["failed to load Xlib: {:?}", "illegal width: {}", "illegal height: {}"] {
        let old = format!("|e| Error::WindowCreate(format!(\"{message}\", e))");
        source.replace_text(x11, &old, "|_| Error::WindowCreate(String::new())", edit)?;
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

const MINIFB_PACE: &str = r#"        if let Some(target_rate) = self.target_rate {
            unsafe { libc::usleep(target_rate.as_micros() as u32) };
        }
"#;

const MINIFB_TITLE: &str = r#"        let name = [name.as_bytes(), b"\0"].concat();
        let name = unsafe { CStr::from_bytes_with_nul_unchecked(&name) };

"#;

/// rayon-core: as many threads as the system lets this process run on, and no more questions; one pool, which
/// never ends, of threads that the C library starts.
///
/// The published crate also asks environment variables, and the standard library reads the limits
/// of control groups from files.
pub fn rayon_core(source: &mut Source) -> Result<(), Error> {
    source.replace(
        "src/lib.rs",
        "            let default = || {\n                thread::available_parallelism()",
        "        }\n    }\n\n    /// Get the thread name for the thread with the given index.",
        RAYON_COUNT,
        "replace the default number of threads",
    )?;
    let registry = "src/registry.rs";
    let edit = "start threads by the C library";
    source.replace(
        registry,
        "        let mut b = thread::Builder::new();",
        "    }\n}\n\n/// Spawns a thread with a user's custom callback.",
        RAYON_SPAWN,
        edit,
    )?;

    let edit = "keep one pool that never ends";
    source.replace(
        registry,
        "        let breadth_first = builder.get_breadth_first();",
        "    pub(super) fn current() -> Arc<Registry> {",
        RAYON_NEW,
        edit,
    )?;
    source.replace(
        registry,
        "    // If we're running in an environment that doesn't support threads at all",
        "struct Terminator<'a>",
        "    result\n}\n\n",
        edit,
    )?;
    source.replace_text(
        registry,
        "        for info in &self.thread_infos {\n            info.primed.wait();\n        }\n",
        "",
        edit,
    )?;
    source.replace(
        registry,
        "    let worker_thread = &WorkerThread::from(thread);",
        "/// If already in a worker-thread, just execute `op`.",
        RAYON_LOOP,
        edit,
    )?;
    source.replace(
        registry,
        "        Latch::set(&registry.thread_infos[index].stopped);",
        "    fn find_work(&self)",
        "    }\n\n",
        edit,
    )?;
    source.replace(
        registry,
        "    /// Latch set once thread has started",
        "    /// The latch used to signal that terminated",
        "",
        edit,
    )?;
    source.replace_text(
        registry,
        "            primed: LockLatch::new(),\n            stopped: LockLatch::new(),\n",
        "",
        edit,
    )?;
    source.replace(registry, "            } else if (*worker_thread).registry().id() != self.id() {", "            } else {\n                // Perfectly valid to give them a `&T`: this is the\n                // current thread, so we know the data structure won't be\n                // invalidated until we return.\n                op(&*worker_thread, false)", "", edit)?;

    let edit = "leave out broadcasts";
    source.replace_text(
        registry,
        "    stealer: Stealer<JobRef>,\n    registry: Arc<Registry>,\n    index: usize,\n}",
        "    registry: Arc<Registry>,\n    index: usize,\n}",
        edit,
    )?;
    source.replace_text(
        registry,
        "    /// the \"stealer\" half of the worker's broadcast deque\n    stealer: Stealer<JobRef>,\n",
        "",
        edit,
    )?;
    source.replace_text(registry, "            stealer: thread.stealer,\n", "", edit)?;
    source.replace(
        registry,
        "        loop {\n            match self.stealer.steal() {",
        "    fn has_injected_job(&self) -> bool {\n        !self.stealer.is_empty()",
        "        None\n    }\n\n",
        edit,
    )?;
    source.replace_text(registry, "!self.stealer.is_empty() || self.registry", "self.registry", edit)?;

    let edit = "choose victims without hashing";
    source.replace(
        registry,
        "        // Any non-zero seed will do",
        "        XorShift64Star {\n            state: Cell::new(seed),",
        RAYON_SEED,
        edit,
    )
}

/// crossbeam-deque: the same queues behind a lock each, without its collector of garbage.
///
/// Tasks of the engine are long, so queues are rarely asked for.
pub fn crossbeam_deque(source: &mut Source) -> Result<(), Error> {
    source.replace_file("src/lib.rs", CROSSBEAM_DEQUE, "replace its queues")
}

const CROSSBEAM_DEQUE: &str = r#"
use std::cell::UnsafeCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

extern "C" {
    fn sched_yield() -> i32;
}

/// A queue that anyone may push to and take from.
pub struct Injector<T> {
    locked: AtomicBool,
    tasks: UnsafeCell<Vec<T>>,
}

unsafe impl<T: Send> Send for Injector<T> {}
unsafe impl<T: Send> Sync for Injector<T> {}

/// What taking from a queue gave.
pub enum Steal<T> {
    Empty,
    Success(T),
    Retry,
}

impl<T> Injector<T> {
    pub fn new() -> Self {
        Injector { locked: AtomicBool::new(false), tasks: UnsafeCell::new(Vec::new()) }
    }

    fn with<R>(&self, act: impl FnOnce(&mut Vec<T>) -> R) -> R {
        while self.locked.swap(true, Ordering::SeqCst) {
            unsafe { sched_yield() };
        }
        let result = act(unsafe { &mut *self.tasks.get() });
        self.locked.store(false, Ordering::SeqCst);
        result
    }

    #[inline(never)]
    pub fn push(&self, task: T) {
        self.with(|tasks| tasks.push(task))
    }

    /// The oldest task, or the newest.
    #[inline(never)]
    fn take(&self, oldest: bool) -> Option<T> {
        self.with(|tasks| {
            let end = tasks.len().checked_sub(1)?;
            Some(tasks.remove(if oldest { 0 } else { end }))
        })
    }

    pub fn steal(&self) -> Steal<T> {
        match self.take(true) {
            Some(task) => Steal::Success(task),
            None => Steal::Empty,
        }
    }

    #[inline(never)]
    pub fn is_empty(&self) -> bool {
        self.with(|tasks| tasks.is_empty())
    }
}

/// The end of a queue for the thread that owns it: last in, first out.
pub struct Worker<T>(Arc<Injector<T>>);

impl<T> Worker<T> {
    pub fn new_lifo() -> Self {
        Worker(Arc::new(Injector::new()))
    }

    pub fn stealer(&self) -> Stealer<T> {
        Stealer(self.0.clone())
    }

    pub fn push(&self, task: T) {
        self.0.push(task)
    }

    pub fn pop(&self) -> Option<T> {
        self.0.take(false)
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// The other end, for other threads.
pub struct Stealer<T>(Arc<Injector<T>>);

impl<T> Stealer<T> {
    pub fn steal(&self) -> Steal<T> {
        self.0.steal()
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}
"#;

const RAYON_SPAWN: &str = r#"        unsafe extern "C" {
            fn pthread_create(
                thread: *mut usize,
                attributes: *const u8,
                start: extern "C" fn(*mut ThreadBuilder) -> *mut u8,
                argument: *mut ThreadBuilder,
            ) -> i32;
        }
        extern "C" fn start(thread: *mut ThreadBuilder) -> *mut u8 {
            unsafe { main_loop(*Box::from_raw(thread)) };
            ptr::null_mut()
        }
        let thread = Box::into_raw(Box::new(thread));
        match unsafe { pthread_create(&mut 0, ptr::null(), start, thread) } {
            0 => Ok(()),
            error => Err(io::Error::from_raw_os_error(error)),
        }
"#;

const RAYON_NEW: &str = r#"        let mut workers = Vec::new();
        let mut thread_infos = Vec::new();
        for _ in 0..n_threads {
            let worker = Worker::new_lifo();
            thread_infos.push(ThreadInfo::new(worker.stealer()));
            workers.push(worker);
        }
        let registry = mem::ManuallyDrop::new(Arc::new(Registry {
            thread_infos,
            sleep: Sleep::new(n_threads),
            injected_jobs: Injector::new(),
            broadcasts: Mutex::new(Vec::new()),
            terminate_count: AtomicUsize::new(1),
            panic_handler: None,
            start_handler: None,
            exit_handler: None,
        }));
        for (index, worker) in workers.into_iter().enumerate() {
            let thread = ThreadBuilder {
                name: None,
                stack_size: None,
                registry: Arc::clone(&registry),
                worker,
                index,
            };
            if let Err(e) = builder.get_spawn_handler().spawn(thread) {
                return Err(ThreadPoolBuildError::new(ErrorKind::IOError(e)));
            }
        }
        Ok(mem::ManuallyDrop::into_inner(registry))
    }

"#;

const RAYON_LOOP: &str = r#"    let worker_thread = Box::leak(Box::new(WorkerThread::from(thread)));
    WorkerThread::set_current(worker_thread);
    worker_thread.wait_until_out_of_work();
}

"#;

const RAYON_SEED: &str = r#"        static COUNTER: AtomicUsize = AtomicUsize::new(0);
        let seed = COUNTER.fetch_add(1, Ordering::Relaxed) as u64 + 1;
"#;

const RAYON_COUNT: &str = r#"            unsafe extern "C" {
                fn sched_getaffinity(process: i32, size: usize, set: *mut u64) -> i32;
            }
            // Room for as many processors as Linux can have.
            let mut set = [0u64; 128];
            unsafe { sched_getaffinity(0, 1024, set.as_mut_ptr()) };
            let count: u32 = set.iter().map(|word| word.count_ones()).sum();
            (count as usize).max(1)
"#;
