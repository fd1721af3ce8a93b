//! What the sections of a case report.

use std::path::Path;

use carom_mesh::{Group, Mesh};

use crate::error::Problem;
use crate::offenders::Offenders;
use crate::schema::Vector;

/// What is wrong with a case, and what is strange about it.
#[derive(Default)]
pub(super) struct Problems {
    pub(super) all: Vec<Problem>,
    pub(super) warnings: Vec<String>,
    /// Those of them that concern the result.
    pub(super) doubts: Vec<String>,
}

/// A row of a table of what is refused.
pub(super) struct Refusal<'a> {
    /// Whether it is there.
    pub(super) is: bool,
    /// Its key below that of the table, or nothing.
    pub(super) key: &'a str,
    pub(super) message: &'a str,
    pub(super) accepted: &'a [&'a str],
}

impl Refusal<'_> {
    /// `path`: key of the table.
    fn problem(&self, path: &str) -> Problem {
        let path = match self.key {
            "" => path.to_owned(),
            key => format!("{path}.{key}"),
        };
        Problem::new(path, self.message).accepted(self.accepted.to_vec())
    }
}

impl Problems {
    pub(super) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    pub(super) fn push(&mut self, problem: Problem) {
        self.all.push(problem);
    }

    /// Nothing, after a problem.
    pub(super) fn refuse<T>(&mut self, problem: Problem) -> Option<T> {
        self.push(problem);
        None
    }

    /// Refuses all rows of a table that are there; `path`: its key.
    pub(super) fn refuse_each(&mut self, path: &str, table: &[Refusal]) {
        let there = table.iter().filter(|row| row.is);
        self.all.extend(there.map(|row| row.problem(path)));
    }

    /// Refuses the first row of a table that is there; `path`: its key.
    pub(super) fn refuse_first(
        &mut self,
        (path, found): (&str, Option<&str>),
        table: &[Refusal],
    ) -> Option<()> {
        let Some(row) = table.iter().find(|row| row.is) else {
            return Some(());
        };
        let problem = row.problem(path);
        self.refuse(match found {
            Some(found) => problem.found(found),
            None => problem,
        })
    }

    pub(super) fn warn(&mut self, warning: String) {
        self.warnings.push(warning);
    }

    /// Warns of what concerns the result: it is a line of the verdict too.
    pub(super) fn doubt(&mut self, warning: String) {
        self.doubts.push(warning.clone());
        self.warn(warning);
    }

    /// The group called `name`, or a problem at `path`.
    pub(super) fn group<'m>(
        &mut self,
        mesh: &'m Mesh,
        path: &str,
        name: &str,
    ) -> Option<&'m Group> {
        match mesh.groups.get(name) {
            None => {
                let problem = Problem::new(path, "no group of this name in the mesh");
                self.refuse(problem.unknown(name, mesh.groups.keys().map(String::as_str)))
            }
            Some(group) if group.elements.is_empty() => {
                let problem = Problem::new(path, "this group of the mesh is empty").found(name);
                self.refuse(problem.accepted(["a group with elements"]))
            }
            Some(group) => Some(group),
        }
    }

    /// The components of a vector, or a problem where it has more than the mesh.
    pub(super) fn vector<Q: Copy + Into<f64>>(
        &mut self,
        mesh: &Mesh,
        path: &str,
        vector: &Vector<Q>,
    ) -> [f64; 3] {
        let components = vector.si();
        if components[mesh.dim..].iter().any(|c| *c != 0.0) {
            let message = format!(
                "a component beyond the {} of the mesh",
                dimensions(mesh.dim)
            );
            let problem = Problem::new(path, message).found(format!("{components:?}"));
            self.push(problem.accepted([format!(
                "{}, or zeros after it",
                plural(mesh.dim, "component")
            )]));
        }
        components
    }
}

/// A problem with the cells that it is about; `file`: of the case.
pub(super) fn with_cells(problem: Problem, offenders: Offenders, file: &Path) -> Problem {
    let path = offenders.path(file);
    let note = format!(
        "`carom check --cells` writes the cells to {}",
        path.display()
    );
    Problem {
        offenders: Some(offenders),
        ..problem.note(note)
    }
}

/// A place in m.
pub(super) fn place([x, y, z]: [f64; 3]) -> String {
    format!("({x:.6}, {y:.6}, {z:.6}) m")
}

pub(super) fn dimensions(dim: usize) -> String {
    plural(dim, "dimension")
}

pub(crate) fn plural(count: usize, noun: &str) -> String {
    if count == 1 {
        format!("1 {noun}")
    } else {
        format!("{count} {noun}s")
    }
}
