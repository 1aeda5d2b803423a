//! Functions of the caller that C calls. A panic must not cross it.

use std::ffi::{c_char, c_void, CStr};
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
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
    /// How many workers there are; 0: one. Asked once, when the grid is made;
    /// [`Grid::set_workers`](crate::Grid::set_workers) changes it.
    fn workers(&self) -> u32;

    /// Calls `task(worker)` once for each worker in [0, workers), on any threads, as many at the same time as it likes,
    /// and returns when all have returned. `workers` is at most that of the grid. Each call works until nothing is left
    /// to do. A system that calls none, or two with the same worker at the same time, makes the step fail, and nothing
    /// worse.
    fn run(&self, workers: u32, task: &(dyn Fn(u32) + Sync));
}

/// Steps run on rayon's threads: those of the pool in which the step is called, with as many workers as the pool had
/// in which the grid was made.
#[cfg(feature = "rayon")]
#[derive(Clone, Copy, Debug, Default)]
pub struct RayonTasks;

#[cfg(feature = "rayon")]
impl TaskSystem for RayonTasks {
    fn workers(&self) -> u32 {
        rayon::current_num_threads().clamp(1, sys::VOX_MAX_WORKERS as usize) as u32
    }

    fn run(&self, workers: u32, task: &(dyn Fn(u32) + Sync)) {
        rayon::scope(|scope| (0..workers).for_each(|worker| scope.spawn(move |_| task(worker))));
    }
}

/// What a grid keeps for C to call, at a fixed address. Shared, as C's pointer to it is.
pub(crate) struct Callbacks {
    log: Option<LogFunction>,
    tasks: Option<Arc<dyn TaskSystem>>,
    pub(crate) workers: AtomicU32, // the grid's worker_count
}

impl Callbacks {
    /// A task system says itself how many workers there are.
    pub(crate) fn new(log: Option<LogFunction>, tasks: Option<Arc<dyn TaskSystem>>, workers: u32) -> Arc<Self> {
        let workers = tasks.as_ref().map_or(workers, |tasks| tasks.workers()).into();
        Arc::new(Self { log, tasks, workers })
    }

    /// As C calls them, while they live. Without a function the library does as without a struct.
    pub(crate) fn to_c(self: &Arc<Self>) -> (sys::vox_log, sys::vox_task_system) {
        let user = Arc::as_ptr(self).cast_mut().cast();
        let (log, tasks) = (self.log.as_ref(), self.tasks.as_ref());
        (
            sys::vox_log { write: log.map(|_| write as _), user },
            sys::vox_task_system { enqueue: tasks.map(|_| enqueue as _), finish: tasks.map(|_| finish as _), user },
        )
    }
}

unsafe extern "C" fn write(level: sys::vox_log_level, text: *const c_char, user: *mut c_void) {
    let level = if level == sys::VOX_LOG_WARNING { LogLevel::Warning } else { LogLevel::Info };
    // SAFETY: `user` is what to_c() gave, and lives as long as the grid; the text, during the call.
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
        let workers = u64::from(callbacks.workers.load(Ordering::Relaxed).max(1));
        // A few ranges for each worker, so that those which are done early take more. They are dealt out here: the
        // library's tasks would race if a task system ran an item twice at the same time.
        let size = items.div_ceil(8 * workers).max(min_range).max(1);
        let next = AtomicU64::new(0);
        let context = Context(context);
        let context = &context;
        // Of a system that panics, the library sees that items are missing, and the step fails.
        let _ = catch_unwind(AssertUnwindSafe(|| {
            tasks.run(workers.min(items.div_ceil(size)) as u32, &|worker| loop {
                let begin = next.fetch_add(size, Ordering::Relaxed);
                if begin >= items {
                    break;
                }
                // SAFETY: each item once; the library checks the worker.
                unsafe { task(begin, items.min(begin + size), worker, context.0) }
            });
        }));
    }
    std::ptr::null_mut()
}

unsafe extern "C" fn finish(_handle: *mut c_void, _user: *mut c_void) {}

// The library's part is played by the tests, so that miri can run them.
#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    struct Threads(u32);
    impl TaskSystem for Threads {
        fn workers(&self) -> u32 {
            self.0
        }
        fn run(&self, workers: u32, task: &(dyn Fn(u32) + Sync)) {
            std::thread::scope(|scope| (0..workers).for_each(|worker| drop(scope.spawn(move || task(worker)))));
        }
    }

    struct Panics;
    impl TaskSystem for Panics {
        fn workers(&self) -> u32 {
            2
        }
        fn run(&self, _: u32, task: &(dyn Fn(u32) + Sync)) {
            task(0);
            panic!("a task system that panics");
        }
    }

    type Runs = Mutex<Vec<u32>>;

    unsafe extern "C" fn count(begin: u64, end: u64, _worker: u32, context: *mut c_void) {
        let runs = unsafe { &*context.cast::<Runs>() };
        runs.lock().unwrap()[begin as usize..end as usize].iter_mut().for_each(|n| *n += 1);
    }

    /// How often each of `items` items runs.
    fn run(system: impl TaskSystem + 'static, items: usize, min_range: u64) -> Vec<u32> {
        let callbacks = Callbacks::new(None, Some(Arc::new(system)), 99);
        let (_, tasks) = callbacks.to_c();
        let runs: Runs = Mutex::new(vec![0; items]);
        let context = std::ptr::from_ref(&runs).cast_mut().cast();
        unsafe {
            let handle = tasks.enqueue.unwrap()(Some(count), items as u64, min_range, context, tasks.user);
            assert!(handle.is_null());
            tasks.finish.unwrap()(handle, tasks.user);
        }
        runs.into_inner().unwrap()
    }

    #[test]
    fn each_item_runs_once() {
        for (items, min_range) in [(0, 1), (1, 1), (2, 0), (100, 1), (100, 7), (100, 1000)] {
            for workers in [0, 3] {
                let found = run(Threads(workers), items, min_range);
                assert_eq!(found, vec![1; items], "{workers} workers, {items} items, ranges of {min_range}");
            }
        }
    }

    #[test]
    fn panics_do_not_cross() {
        assert_eq!(run(Panics, 50, 1), vec![1; 50]);
        let callbacks = Callbacks::new(Some(Box::new(|_, text| assert_eq!(text, "a line"))), None, 0);
        let (log, tasks) = callbacks.to_c();
        assert!(tasks.enqueue.is_none());
        for text in [c"a line", c"another line"] {
            unsafe { log.write.unwrap()(sys::VOX_LOG_WARNING, text.as_ptr(), log.user) };
        }
    }
}
