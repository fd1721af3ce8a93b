//! Checks side by side, one on each thread: of most of them the models are too small to keep several threads busy.
//!
//! Those that take longest begin first, so that none of them runs alone at the end. What they find does not depend on the threads
//! (check `threads`).

use std::collections::BTreeMap;
use std::io;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;

use rayon::ThreadPoolBuilder;

/// Checks that take longest at full size, the longest first. Only the time of all checks depends on this list.
pub const LONGEST: [&str; 8] = [
    "glued-substeps",
    "arlequin-block",
    "large-shells",
    "shell-solid-waves",
    "tori",
    "beam-solid-waves",
    "shell-solid-impact",
    "ironing",
];

/// Makes the checks of these names, `workers` at a time, each on a thread of its own; `make` has the place of a check in the list. Hands each
/// to `take` as soon as those before it in the list are handed over. One worker takes all threads, and keeps the order of the list.
///
/// # Errors
/// Those of `take`, after which no check begins, and of threads that do not start.
pub fn side_by_side<Made: Send>(
    names: &[&str],
    workers: usize,
    make: impl Fn(usize) -> Made + Sync,
    take: &mut dyn FnMut(Made) -> io::Result<()>,
) -> io::Result<()> {
    let workers = workers.min(names.len());
    if workers <= 1 {
        return (0..names.len()).try_for_each(|place| take(make(place)));
    }
    let places = Mutex::new(longest_first(names).into_iter());
    let stopped = AtomicBool::new(false);
    let next = || {
        let mut places = places.lock().ok()?;
        places.next().filter(|_| !stopped.load(Ordering::Relaxed))
    };
    let (sender, found) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..workers {
            let (sender, next, make) = (sender.clone(), &next, &make);
            let pool = ThreadPoolBuilder::new().num_threads(1).build();
            let pool = pool.map_err(io::Error::other)?;
            scope.spawn(move || {
                while let Some(place) = next() {
                    let made = pool.install(|| make(place));
                    if sender.send((place, made)).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        let mut early = BTreeMap::new();
        let mut due = 0;
        for (place, made) in found {
            early.insert(place, made);
            while let Some(made) = early.remove(&due) {
                due += 1;
                take(made).inspect_err(|_| stopped.store(true, Ordering::Relaxed))?;
            }
        }
        Ok(())
    })
}

/// Places in the list, in the order in which they begin.
pub fn longest_first(names: &[&str]) -> Vec<usize> {
    let rank = |place: &usize| {
        let longer = LONGEST.iter().position(|name| *name == names[*place]);
        longer.unwrap_or(LONGEST.len())
    };
    let mut places: Vec<usize> = (0..names.len()).collect();
    places.sort_by_key(rank);
    places
}
