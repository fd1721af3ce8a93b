//! Cells of a table of runs that are empty, each with its reason.

/// Cells of one column that are empty for one reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Absent {
    /// Head of the column.
    pub column: String,
    /// Why, in a sentence without its beginning.
    pub reason: String,
    /// The runs.
    pub runs: Vec<String>,
    /// Whether these are all runs that were computed.
    all: bool,
}

impl Absent {
    /// The cells of runs, of which `count` were computed: column, run and reason. Those of one column and reason are taken together.
    pub fn gather<'a>(
        cells: impl Iterator<Item = (&'a str, &'a str, String)>,
        count: usize,
    ) -> Vec<Absent> {
        let mut found: Vec<Absent> = Vec::new();
        for (column, run, reason) in cells {
            let mut known = found.iter_mut();
            match known.find(|one| one.column == column && one.reason == reason) {
                Some(one) => one.runs.push(run.to_owned()),
                None => found.push(Absent {
                    column: column.to_owned(),
                    reason,
                    runs: vec![run.to_owned()],
                    all: false,
                }),
            }
        }
        for one in &mut found {
            one.all = one.runs.len() == count;
        }
        found
    }

    /// The reason with column and runs.
    pub fn text(&self) -> String {
        let runs = match self.all && self.runs.len() > 1 {
            true => "all runs".to_owned(),
            false => self.runs.join(", "),
        };
        format!("{} of {runs}: {}", self.column, self.reason)
    }
}

#[cfg(test)]
mod tests {
    use super::Absent;

    #[test]
    fn cells_of_one_reason_are_told_once() {
        let cells = [
            ("restitution", "a", "gravity acts"),
            ("restitution", "b", "gravity acts"),
            ("force error", "b", "no reference"),
        ];
        let cells = cells.map(|(column, run, reason)| (column, run, reason.to_owned()));
        let found = Absent::gather(cells.into_iter(), 2);
        let texts: Vec<String> = found.iter().map(Absent::text).collect();
        assert_eq!(
            texts,
            [
                "restitution of all runs: gravity acts",
                "force error of b: no reference"
            ]
        );
    }
}
