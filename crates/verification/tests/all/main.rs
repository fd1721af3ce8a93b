//! Tests of the crate: each case at its quick size, and the run over cases.
//!
//! None is in the library, which takes longest of all crates to compile: it is compiled once.

// Clippy's exemption for tests covers the test functions, not their helpers.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod check;
mod combinations;
mod kind;
mod page;
mod side_by_side;
mod witness;
mod words;

use carom_verification::inside::{head, of_module, sources};
use carom_verification::{Size, checks};

/// Makes of the list of case modules one test per case at its quick size.
macro_rules! tests {
    ($($case:ident)*) => {
        mod quick {
            $(
                #[test]
                fn $case() {
                    super::assert_quick(stringify!($case));
                }
            )*
        }
    };
}

carom_verification::cases!(tests);

#[test]
fn names_differ_and_facts_are_stated() {
    let mut names: Vec<_> = checks().iter().map(|check| check.name).collect();
    let count = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), count);
    assert!(checks().iter().all(|check| !check.fact.is_empty()));
    // each file states its problem
    let states = |(_, source): &(&str, &str)| head(source).len() > 60;
    assert!(sources().iter().all(states));
}

fn assert_quick(module: &str) {
    let check = of_module(module).unwrap();
    let rows = (check.run)(Size::Quick).unwrap();
    assert!(!rows.is_empty(), "nothing was checked");
    for row in &rows {
        println!("{row}");
    }
    let failed = rows.iter().filter(|row| !row.holds()).count();
    assert_eq!(failed, 0, "{}: {}", check.name, check.fact);
}
