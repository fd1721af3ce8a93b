//! What a case must give, on the terminal.

use carom_output::expectations::{Expectations, Told};
use carom_output::table::Table;

use crate::terminal::{line, out};

/// Letters of a line.
const WIDTH: usize = 160;

/// The rows with what was found, and why they are not judged where they are not.
pub fn print(found: &Expectations) {
    let count = found.rows.len();
    match (&found.unjudged, found.missed) {
        (Some(why), _) => out!("  expectations, not judged: {}", line(why)),
        (None, 0) => out!("  expectations: all {count} met"),
        (None, missed) => out!("  expectations: {missed} of {count} MISSED"),
    }
    for told in table(found).text(WIDTH).lines() {
        out!("    {}", line(told));
    }
}

fn table(found: &Expectations) -> Table {
    let heads = [
        "",
        "expected",
        "tolerance",
        "found",
        "difference",
        "",
        "kind",
    ];
    let cells = |row: Told| {
        let name = format!("{} ({})", row.name, row.quantity);
        [
            name,
            row.expected,
            row.tolerance,
            row.found,
            row.difference,
            row.met.to_owned(),
            row.kind.to_owned(),
        ]
        .to_vec()
    };
    Table {
        heads: heads.map(str::to_owned).to_vec(),
        rows: found.told().into_iter().map(cells).collect(),
    }
}
