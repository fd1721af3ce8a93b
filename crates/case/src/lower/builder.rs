//! What the parts of the building share.

use std::path::PathBuf;

use carom_mesh::{Group, Mesh};
use carom_zones::LinkKind;

use super::course::Signals;
use super::plan::Plan;
use crate::error::Problem;
use crate::input::Input;
use crate::schema::{Case, Vector};

/// Collects problems while it builds.
pub(super) struct Builder<'a> {
    pub(super) case: &'a Case,
    pub(super) problems: Vec<Problem>,
    pub(super) warnings: Vec<String>,
    /// Those of them that concern the result.
    pub(super) doubts: Vec<String>,
    /// Name of each contact with the damped law, and twice the rate of its spring against the elements behind it, 1/s.
    pub(super) springs: Vec<(String, f64)>,
    /// Functions of time.
    pub(super) signals: Signals,
    /// The zones of the case.
    pub(super) plan: Plan,
    /// Path of the case file, and the folder that its paths start from.
    pub(super) file: PathBuf,
    pub(super) folder: PathBuf,
    /// Bodies whose reduction has a file, and where the reduction comes from.
    pub(super) reductions: Vec<(String, String)>,
    /// Signals, and what they have in words.
    pub(super) told_signals: Vec<(String, String)>,
    /// Whether a reduction that is made anew is saved in its file.
    pub(super) saves: bool,
}

impl<'a> Builder<'a> {
    /// Before anything is built.
    pub(super) fn new(case: &'a Case, input: &Input) -> Builder<'a> {
        let mut builder = Builder {
            case,
            problems: Vec::new(),
            warnings: Vec::new(),
            doubts: Vec::new(),
            springs: Vec::new(),
            signals: Signals::new(),
            plan: Plan {
                zones: Vec::new(),
                kind: LinkKind::GravouilCombescure,
            },
            file: input
                .sources
                .first()
                .map_or_else(PathBuf::new, |source| PathBuf::from(&source.name)),
            folder: input.folder.clone(),
            reductions: Vec::new(),
            told_signals: Vec::new(),
            saves: true,
        };
        builder.plan = builder.plan_zones();
        builder
    }
}

impl Builder<'_> {
    /// Warns of what concerns the result: it is a line of the verdict too.
    pub(super) fn doubt(&mut self, warning: String) {
        self.doubts.push(warning.clone());
        self.warnings.push(warning);
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
                self.problems
                    .push(problem.unknown(name, mesh.groups.keys().map(String::as_str)));
                None
            }
            Some(group) if group.elements.is_empty() => {
                let problem = Problem::new(path, "this group of the mesh is empty").found(name);
                self.problems
                    .push(problem.accepted(["a group with elements"]));
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
            self.problems.push(problem.accepted([format!(
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
