//! Functions of the caller that C calls. A panic must not cross it.

use std::ffi::{c_char, c_void, CStr};
use std::ops::Range;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::Arc;

use voxtet_sys as sys;

use crate::options::LogFunction;

/// Severity of a line of the log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogLevel {
    /// What the library chose.
    Info,
    /// What is probably a mistake.
    Warning,
}

/// Threads that run the tasks of a step.
pub trait TaskSystem: Send + Sync {
    /// How many workers there are: the second argument of `task` is below it. At least 1.
    fn workers(&self) -> u32;

    /// Splits the items [0, items) into ranges, of at least `min_range` items where possible, calls `task(range, worker)`
    /// once for each, on any threads, and returns when all have returned. Calls that run at the same time have different
    /// workers. A system that breaks these rules makes the step fail, and nothing worse.
    fn run(&self, items: u64, min_range: u64, task: &(dyn Fn(Range<u64>, u32) + Sync));
}

/// Steps run on rayon's threads.
#[cfg(feature = "rayon")]
#[derive(Clone, Copy, Debug, Default)]
pub struct RayonTasks;

#[cfg(feature = "rayon")]
impl TaskSystem for RayonTasks {
    fn workers(&self) -> u32 {
        rayon::current_num_threads().clamp(1, sys::VOX_MAX_WORKERS as usize) as u32
    }

    fn run(&self, items: u64, min_range: u64, task: &(dyn Fn(Range<u64>, u32) + Sync)) {
        let workers = u64::from(self.workers());
        // A few ranges for each worker, so that those which are done early take more.
        let size = items.div_ceil(8 * workers).max(min_range).max(1);
        let next = std::sync::atomic::AtomicU64::new(0);
        rayon::scope(|scope| {
            for worker in 0..workers as u32 {
                let next = &next;
                scope.spawn(move |_| loop {
                    let begin = next.fetch_add(size, std::sync::atomic::Ordering::Relaxed);
                    if begin >= items {
                        break;
                    }
                    task(begin..items.min(begin + size), worker);
                });
            }
        });
    }
}

/// What a grid keeps for C to call, at a fixed address.
pub(crate) struct Callbacks {
    log: Option<LogFunction>,
    tasks: Option<Arc<dyn TaskSystem>>,
}

impl Callbacks {
    /// Null without callbacks. Sets the fields of `desc` that call them.
    pub(crate) fn install(
        log: Option<LogFunction>,
        tasks: Option<Arc<dyn TaskSystem>>,
        desc: &mut sys::vox_grid_desc,
    ) -> Option<Box<Self>> {
        if log.is_none() && tasks.is_none() {
            return None;
        }
        let callbacks = Box::new(Self { log, tasks });
        let user = std::ptr::from_ref(&*callbacks).cast_mut().cast::<c_void>();
        if callbacks.log.is_some() {
            desc.log = sys::vox_log { write: Some(write), user };
        }
        if let Some(tasks) = &callbacks.tasks {
            desc.tasks = sys::vox_task_system { enqueue: Some(enqueue), finish: Some(finish), user };
            desc.worker_count = tasks.workers();
        }
        Some(callbacks)
    }
}

unsafe extern "C" fn write(level: sys::vox_log_level, text: *const c_char, user: *mut c_void) {
    let level = if level == sys::VOX_LOG_WARNING { LogLevel::Warning } else { LogLevel::Info };
    // SAFETY: `user` is what install() gave, and lives as long as the grid; the text, during the call.
    let (callbacks, text) = unsafe { (&*user.cast::<Callbacks>(), CStr::from_ptr(text)) };
    if let Some(log) = &callbacks.log {
        // A log that panics loses its line. The panic was reported by its hook.
        let _ = catch_unwind(AssertUnwindSafe(|| log(level, &text.to_string_lossy())));
    }
}

struct Context(*mut c_void);
// SAFETY: the library's, which it gives to any thread.
unsafe impl Sync for Context {}

unsafe extern "C" fn enqueue(
    task: sys::vox_task,
    items: u64,
    min_range: u64,
    context: *mut c_void,
    user: *mut c_void,
) -> *mut c_void {
    // SAFETY: as in write().
    let callbacks = unsafe { &*user.cast::<Callbacks>() };
    if let (Some(tasks), Some(task)) = (&callbacks.tasks, task) {
        let context = Context(context);
        let context = &context;
        // Of a system that panics, the library sees that items are missing, and the step fails.
        let _ = catch_unwind(AssertUnwindSafe(|| {
            tasks.run(items, min_range, &|range, worker| {
                // SAFETY: the library checks range and worker.
                unsafe { task(range.start, range.end, worker, context.0) }
            });
        }));
    }
    std::ptr::null_mut()
}

unsafe extern "C" fn finish(_handle: *mut c_void, _user: *mut c_void) {}
