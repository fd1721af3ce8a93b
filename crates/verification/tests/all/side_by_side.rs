//! Checks side by side.

use std::io;

use carom_verification::checks;
use carom_verification::inside::{LONGEST, longest_first, side_by_side};

fn names() -> Vec<&'static str> {
    checks().iter().map(|check| check.name).collect()
}

#[test]
fn the_longest_are_checks_and_begin_first() {
    let names = names();
    let begun = longest_first(&names).into_iter().map(|place| names[place]);
    let begun: Vec<_> = begun.collect();
    assert_eq!(begun[..LONGEST.len()], LONGEST);
    assert_eq!(begun.len(), names.len());
}

/// The first `most` of the places that are handed over.
fn taken(workers: usize, most: usize) -> (io::Result<()>, Vec<usize>) {
    let make = |place| (place, rayon::current_num_threads());
    let mut places = Vec::new();
    let ended = side_by_side(&names(), workers, make, &mut |(place, threads)| {
        assert!(workers == 1 || threads == 1, "more than a thread");
        places.push(place);
        match places.len() < most {
            true => Ok(()),
            false => Err(io::ErrorKind::BrokenPipe.into()),
        }
    });
    (ended, places)
}

#[test]
fn checks_are_handed_over_in_the_order_of_the_list() {
    for workers in [1, 3] {
        let (ended, taken) = taken(workers, usize::MAX);
        assert!(ended.is_ok());
        assert!(taken.into_iter().eq(0..names().len()));
    }
}

#[test]
fn a_failure_of_the_output_ends_it() {
    for workers in [1, 3] {
        let (ended, taken) = taken(workers, 4);
        assert!(ended.is_err());
        assert_eq!(taken.len(), 4);
    }
}
