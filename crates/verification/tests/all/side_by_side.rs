//! Checks side by side.

use std::io;

use carom_verification::inside::{LONGEST, longest_first, side_by_side};
use carom_verification::{Check, Made, checks};

#[test]
fn the_longest_are_checks_and_begin_first() {
    let checks = checks();
    let begun: Vec<_> = longest_first(&checks)
        .into_iter()
        .map(|place| checks[place].name)
        .collect();
    assert_eq!(begun[..LONGEST.len()], LONGEST);
    assert_eq!(begun.len(), checks.len());
}

fn taken(workers: usize, most: usize) -> (io::Result<()>, Vec<&'static str>) {
    let checks = checks();
    let make = |check: &Check| Made {
        check: *check,
        rows: Ok(Vec::new()),
        seconds: rayon::current_num_threads() as f64,
        shown: Default::default(),
    };
    let mut names = Vec::new();
    let ended = side_by_side(&checks, workers, make, &mut |made| {
        assert!(workers == 1 || made.seconds == 1.0, "more than a thread");
        names.push(made.check.name);
        match names.len() < most {
            true => Ok(()),
            false => Err(io::ErrorKind::BrokenPipe.into()),
        }
    });
    (ended, names)
}

#[test]
fn checks_are_handed_over_in_the_order_of_the_list() {
    let names: Vec<_> = checks().iter().map(|check| check.name).collect();
    for workers in [1, 3] {
        let (ended, taken) = taken(workers, usize::MAX);
        assert!(ended.is_ok());
        assert_eq!(taken, names);
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
