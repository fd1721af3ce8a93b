//! Counts the allocations of the thread that asks, and the bytes that it holds.

#![allow(
    unsafe_code,
    reason = "an allocator that counts is the only way to see allocations"
)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
    static HELD: Cell<isize> = const { Cell::new(0) };
    static MOST: Cell<isize> = const { Cell::new(0) };
}

/// The system's allocator with a count, for `#[global_allocator]` in a test binary.
#[derive(Debug)]
pub struct Counter;

// SAFETY: every call goes to the system's allocator unchanged; counting touches a thread-local without allocating.
unsafe impl GlobalAlloc for Counter {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|count| count.set(count.get() + 1));
        let held = HELD.with(|held| {
            held.set(held.get() + layout.size() as isize);
            held.get()
        });
        MOST.with(|most| most.set(most.get().max(held)));
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.with(|held| held.set(held.get() - layout.size() as isize));
        unsafe { System.dealloc(pointer, layout) }
    }
}

/// Allocations of this thread so far, where [`Counter`] is the allocator of the binary; zero elsewhere.
pub fn allocations() -> usize {
    COUNT.with(Cell::get)
}

/// Bytes that this thread has taken and not given back, and the most of them since the last call, where [`Counter`] is the allocator
/// of the binary; zeros elsewhere. What another thread gives back counts there.
pub fn held() -> [isize; 2] {
    let held = HELD.with(Cell::get);
    [held, MOST.with(|most| most.replace(held))]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[global_allocator]
    static COUNTER: Counter = Counter;

    #[test]
    fn a_box_is_one_allocation_and_its_end_none() {
        let before = allocations();
        let one = std::hint::black_box(Box::new(1));
        assert_eq!(allocations() - before, 1);
        drop(one);
        assert_eq!(allocations() - before, 1);
    }

    #[test]
    fn bytes_are_held_until_they_are_given_back() {
        let [before, _] = held();
        let list = std::hint::black_box(vec![0_u8; 1000]);
        assert_eq!(held(), [before + 1000; 2]);
        drop(list);
        assert_eq!(held(), [before, before + 1000]);
        assert_eq!(held(), [before; 2]);
    }

    #[test]
    fn other_threads_count_for_themselves() {
        let before = allocations();
        let other = std::thread::spawn(|| {
            let before = allocations();
            std::hint::black_box(vec![0.0; 10]);
            allocations() - before
        });
        let mine = allocations() - before;
        assert_eq!(other.join().unwrap(), 1);
        assert!(mine > 0, "a thread is made of allocations here");
    }
}
