//! The page.

use carom_verification::Row;
use carom_verification::inside::{head, part};

#[test]
fn the_head_of_a_file_is_its_first_comment() {
    let source = "//! Two bars.\n//!\n//! Problem: [`Run`].\n\nuse x;\n//! later\n";
    assert_eq!(head(source), "Two bars.\n\nProblem: `Run`.");
}

#[test]
fn a_row_takes_a_part_of_its_tolerance() {
    assert_eq!(part(&Row::near("x", 1.5, 1.0, 2.0)), Some(0.25));
    assert_eq!(part(&Row::at_most("x", 1.0, 4.0)), Some(0.25));
    assert_eq!(part(&Row::at_most("x", -1.0, 4.0)), Some(0.0));
    assert_eq!(part(&Row::count("x", 3, 3)), None);
    assert_eq!(part(&Row::at_least("x", 3.0, 1.0)), None);
}
