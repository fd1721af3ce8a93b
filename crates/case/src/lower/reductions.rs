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
use crate::schema::Body;

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
    let rows = links.iter().flat_map(|link| &link.rows);
    let terms = rows.flat_map(|row| row.inner.iter().chain(&row.outer));
    let nodes: Vec<u32> = terms.map(|term| term.node).collect();
    let mut sources = Vec::new();
    for (number, (name, body)) in context.case.body.iter().enumerate() {
        let source = reduced(context, model, (number, body), &nodes, problems);
        sources.extend(source.map(|source| (name.to_owned(), source)));
    }
    sources
}

/// Reduces one body, if it is to be; where its reduction comes from, if it has a file. `joined`: nodes of links.
fn reduced(
    context: &Context,
    model: &mut Model,
    (number, body): (usize, &Body),
    joined: &[u32],
    problems: &mut Problems,
) -> Option<String> {
    let given = body.reduction.as_ref()?;
    let path = format!("body.{}.reduction", model.bodies[number].spec.name);
    if body.rigid.is_some() {
        let problem = Problem::new(&path, "a rigid body has no modes");
        return problems.refuse(problem.accepted(["either `rigid` or `reduction`"]));
    }
    let mut nodes = joined.to_vec();
    for group in &given.retain {
        let path = format!("{path}.retain");
        if let Some(group) = problems.group(&model.mesh, &path, group) {
            nodes.extend(model.mesh.group_nodes(group));
        }
    }
    let damping = model.nonlinear.damping.get(number).copied();
    let keep = Keep {
        modes: given.modes as usize,
        nodes,
        massless: given.massless,
        ratio: given.damping_ratio,
        rayleigh: damping.unwrap_or_default(),
    };
    let saved = saved(&path, given.file.as_deref(), context.folder, problems)?;
    let source = match given.file {
        None => reduce(model, number, &keep).map(|()| None),
        Some(_) => reduce_from(model, number, &keep, saved.as_deref()).map(Some),
    };
    let source = match source {
        Ok(source) => source,
        Err(error) => return problems.refuse(not_reduced(&path, &error)),
    };
    // it is part of the reduced matrices
    if let Some(damping) = model.nonlinear.damping.get_mut(number) {
        *damping = Default::default();
    }
    kept(
        context,
        &path,
        given.file.as_ref()?,
        (source?, saved.is_some()),
        problems,
    )
}

/// The problem of a reduction that fails.
fn not_reduced(path: &str, error: &Error) -> Problem {
    let message = error.to_string();
    match error {
        Error::Count { exist, .. } => {
            Problem::new(format!("{path}.modes"), message).accepted([format!("1 to {exist}")])
        }
        Error::Saved { .. } => Problem::new(format!("{path}.file"), message)
            .accepted(["a file that carom saved, or one that does not exist yet"]),
        _ => Problem::new(path, message),
    }
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
