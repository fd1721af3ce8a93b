//! The internal-force sweep allocates on its first call only.

#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use carom_bodies::{Kinematics, Scratch};
use carom_mesh::generate;

use crate::sample::{Sample, plain_and_weighted};

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

struct Counter;

// SAFETY: every call goes to the system allocator unchanged; the counter itself never allocates.
unsafe impl GlobalAlloc for Counter {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|count| count.set(count.get() + 1));
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static COUNTER: Counter = Counter;

/// On the one thread of a pool, so that all of it is counted: the threads' own queues are rayon's.
#[test]
fn internal_force_allocates_nothing_after_its_first_call() {
    let cube = generate::box_("b", [0.0; 3], [1.0; 3], [9; 3], false);
    let large = Sample::new("hex8 in chunks", cube, Kinematics::Solid);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    for sample in plain_and_weighted().into_iter().chain([large]) {
        let count = pool.install(|| {
            let (u, mut f) = (vec![1e-3; sample.n], vec![0.0; sample.n]);
            let mut scratch = Scratch::default();
            sample.body.internal_force(&u, &mut scratch, &mut f);
            let before = COUNT.get();
            for _ in 0..10 {
                sample.body.internal_force(&u, &mut scratch, &mut f);
            }
            COUNT.get() - before
        });
        assert_eq!(count, 0, "{}", sample.name);
    }
}
