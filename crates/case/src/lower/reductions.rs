//! Bodies reduced to nodes and modes.

use std::io::ErrorKind;
use std::path::Path;

use carom_dynamics::{Model, ModelLink};
use carom_mesh::read::file;
use carom_output::atomic;
use carom_reduction::{Error, Keep, Source, reduce, reduce_from};

use super::Builder;
use crate::error::Problem;

/// Most bytes of a file of a reduction, 1 GiB.
const LARGEST: u64 = 1 << 30;

impl Builder<'_> {
    /// Reduces the bodies of a model that are to be. `links`: between zones, with terms at nodes of the mesh; `folder`: of the case.
    pub(super) fn reduce(&mut self, model: &mut Model, links: &[ModelLink], folder: &Path) {
        let case = self.case;
        for (number, (name, body)) in case.body.iter().enumerate() {
            let Some(given) = &body.reduction else {
                continue;
            };
            let path = format!("body.{name}.reduction");
            if body.rigid.is_some() {
                let problem = Problem::new(&path, "a rigid body has no modes");
                self.problems
                    .push(problem.accepted(["either `rigid` or `reduction`"]));
                continue;
            }
            let rows = links.iter().flat_map(|link| &link.rows);
            let terms = rows.flat_map(|row| row.inner.iter().chain(&row.outer));
            let mut nodes: Vec<u32> = terms.map(|term| term.node).collect();
            for group in &given.retain {
                let path = format!("{path}.retain");
                if let Some(group) = self.group(&model.mesh, &path, group) {
                    nodes.extend(model.mesh.group_nodes(group));
                }
            }
            let keep = Keep {
                modes: given.modes as usize,
                nodes,
                massless: given.massless,
                ratio: given.damping_ratio,
                rayleigh: model
                    .nonlinear
                    .damping
                    .get(number)
                    .copied()
                    .unwrap_or_default(),
            };
            let Some(saved) = self.saved(&path, given.file.as_deref(), folder) else {
                continue;
            };
            let source = match given.file {
                None => reduce(model, number, &keep).map(|()| None),
                Some(_) => reduce_from(model, number, &keep, saved.as_deref()).map(Some),
            };
            match source {
                Ok(source) => {
                    // it is part of the reduced matrices
                    if let Some(damping) = model.nonlinear.damping.get_mut(number) {
                        *damping = Default::default();
                    }
                    if let (Some(source), Some(file)) = (source, &given.file) {
                        let existed = saved.is_some();
                        self.keep(&path, (name, file), folder, (source, existed));
                    }
                }
                Err(error) => {
                    let path = match error {
                        Error::Count { .. } => format!("{path}.modes"),
                        Error::Saved { .. } => format!("{path}.file"),
                        _ => path,
                    };
                    let problem = Problem::new(path, error.to_string());
                    self.problems.push(match error {
                        Error::Count { exist, .. } => problem.accepted([format!("1 to {exist}")]),
                        Error::Saved { .. } => problem
                            .accepted(["a file that carom saved, or one that does not exist yet"]),
                        _ => problem,
                    });
                }
            }
        }
    }

    /// The bytes of the file of a reduction, if there is one. `None` after a problem.
    fn saved(&mut self, path: &str, name: Option<&str>, folder: &Path) -> Option<Option<Vec<u8>>> {
        let Some(name) = name else {
            return Some(None);
        };
        match file::regular(&folder.join(name), LARGEST) {
            Ok(bytes) => Some(Some(bytes)),
            Err(error) if error.kind() == ErrorKind::NotFound => Some(None),
            Err(error) => {
                let message = format!("{name}: {error}");
                self.problems
                    .push(Problem::new(format!("{path}.file"), message));
                None
            }
        }
    }

    /// Saves a reduction that was made anew, if reductions are saved, and notes where the reduction comes from.
    fn keep(
        &mut self,
        path: &str,
        (body, file): (&str, &str),
        folder: &Path,
        (source, existed): (Source, bool),
    ) {
        let told = match source {
            Source::Saved => format!("read from '{file}'"),
            Source::Made(_) if !self.saves => match existed {
                true => format!(
                    "made anew, since that in '{file}' is of something else; a run saves it there"
                ),
                false => format!("made anew; a run saves it to '{file}'"),
            },
            Source::Made(bytes) => {
                let written = atomic::write(&folder.join(file), |to| to.write_all(&bytes));
                if let Err(error) = written {
                    self.problems
                        .push(Problem::new(format!("{path}.file"), error.to_string()));
                    return;
                }
                match existed {
                    true => format!(
                        "made anew, since that in '{file}' is of something else, and saved there"
                    ),
                    false => format!("saved to '{file}'"),
                }
            }
        };
        self.reductions.push((body.to_owned(), told));
    }
}
