//! What the sections of a case report.

use carom_mesh::{Group, Mesh};

use crate::error::Problem;
use crate::schema::Vector;

/// What is wrong with a case, and what is strange about it.
#[derive(Default)]
pub(super) struct Problems {
    pub(super) all: Vec<Problem>,
    pub(super) warnings: Vec<String>,
    /// Those of them that concern the result.
    pub(super) doubts: Vec<String>,
}

impl Problems {
    pub(super) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    pub(super) fn push(&mut self, problem: Problem) {
        self.all.push(problem);
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
                self.push(problem.unknown(name, mesh.groups.keys().map(String::as_str)));
                None
            }
            Some(group) if group.elements.is_empty() => {
                let problem = Problem::new(path, "this group of the mesh is empty").found(name);
                self.push(problem.accepted(["a group with elements"]));
                None
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
