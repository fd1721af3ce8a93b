//! Bodies reduced to nodes and modes.

use std::io::ErrorKind;
use std::path::Path;

use carom_dynamics::{Model, ModelLink};
use carom_mesh::read::file;
use carom_output::atomic;
use carom_reduction::{Error, Keep, Source, reduce, reduce_from};

use super::context::Context;
use super::problems::Problems;
use crate::error::Problem;

/// Most bytes of a file of a reduction, 1 GiB.
const LARGEST: u64 = 1 << 30;

/// Reduces the bodies of a model that are to be; returns those whose reduction has a file, and where it comes from. `links`: between zones, with
/// terms at nodes of the mesh.
pub(super) fn lower(
    context: &Context,
    model: &mut Model,
    links: &[ModelLink],
    problems: &mut Problems,
) -> Vec<(String, String)> {
    let case = context.case;
    let mut sources = Vec::new();
    for (number, (name, body)) in case.body.iter().enumerate() {
        let Some(given) = &body.reduction else {
            continue;
        };
        let path = format!("body.{name}.reduction");
        if body.rigid.is_some() {
            let problem = Problem::new(&path, "a rigid body has no modes");
            problems.push(problem.accepted(["either `rigid` or `reduction`"]));
            continue;
        }
        let rows = links.iter().flat_map(|link| &link.rows);
        let terms = rows.flat_map(|row| row.inner.iter().chain(&row.outer));
        let mut nodes: Vec<u32> = terms.map(|term| term.node).collect();
        for group in &given.retain {
            let path = format!("{path}.retain");
            if let Some(group) = problems.group(&model.mesh, &path, group) {
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
        let Some(saved) = saved(&path, given.file.as_deref(), context.folder, problems) else {
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
                    let told = kept(context, &path, file, (source, existed), problems);
                    sources.extend(told.map(|told| (name.to_owned(), told)));
                }
            }
            Err(error) => {
                let path = match error {
                    Error::Count { .. } => format!("{path}.modes"),
                    Error::Saved { .. } => format!("{path}.file"),
                    _ => path,
                };
                let problem = Problem::new(path, error.to_string());
                problems.push(match error {
                    Error::Count { exist, .. } => problem.accepted([format!("1 to {exist}")]),
                    Error::Saved { .. } => problem
                        .accepted(["a file that carom saved, or one that does not exist yet"]),
                    _ => problem,
                });
            }
        }
    }
    sources
}

/// The bytes of the file of a reduction, if there is one. `None` after a problem.
fn saved(
    path: &str,
    name: Option<&str>,
    folder: &Path,
    problems: &mut Problems,
) -> Option<Option<Vec<u8>>> {
    let Some(name) = name else {
        return Some(None);
    };
    match file::regular(&folder.join(name), LARGEST) {
        Ok(bytes) => Some(Some(bytes)),
        Err(error) if error.kind() == ErrorKind::NotFound => Some(None),
        Err(error) => {
            let message = format!("{name}: {error}");
            problems.refuse(Problem::new(format!("{path}.file"), message))
        }
    }
}

/// Saves a reduction that was made anew, if reductions are saved; where the reduction comes from.
fn kept(
    context: &Context,
    path: &str,
    file: &str,
    (source, existed): (Source, bool),
    problems: &mut Problems,
) -> Option<String> {
    Some(match source {
        Source::Saved => format!("read from '{file}'"),
        Source::Made(_) if !context.saves => match existed {
            true => format!(
                "made anew, since that in '{file}' is of something else; a run saves it there"
            ),
            false => format!("made anew; a run saves it to '{file}'"),
        },
        Source::Made(bytes) => {
            let written = atomic::write(&context.folder.join(file), |to| to.write_all(&bytes));
            if let Err(error) = written {
                return problems.refuse(Problem::new(format!("{path}.file"), error.to_string()));
            }
            match existed {
                true => format!(
                    "made anew, since that in '{file}' is of something else, and saved there"
                ),
                false => format!("saved to '{file}'"),
            }
        }
    })
}
