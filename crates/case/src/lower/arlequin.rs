//! Overlaps and borders between zones: cells that fall away, weights, rows, and what is wrong with them.

use carom_arlequin::{Bracket, Coupling, Mediator, Model, Models, Overlap, Rows};
use carom_bodies::Kinematics;
use carom_dynamics::{ModelBody, ModelContact, Support};
use carom_mesh::{ElementId, Mesh};

use super::context::Context;
use super::held::Held;
use super::joints::{self, BuiltOverlap, FEW_LAYERS, Joint, Joints, is_thin};
use super::problems::{Problems, plural};
use super::unfit::{self, doubt};
use super::{lookup, thin_overlaps, ties};
use crate::error::Problem;
use crate::schema::{self, BracketLength, BracketWith};

/// Joins the zones: takes cells away and gives weights where bodies overlap, and makes the rows of all joints.
pub(super) fn lower(
    context: &Context,
    mesh: &Mesh,
    bodies: &mut [ModelBody],
    supports: &[Support],
    problems: &mut Problems,
) -> Joints {
    let held = Held::new(mesh, supports);
    let mut joints = Joints::default();
    let mut before: Vec<Rows> = Vec::new();
    for (name, given) in context.case.arlequin.iter() {
        let path = format!("arlequin.{name}");
        let names = [&given.inner[..], &given.outer];
        let Some(numbers) = lookup::bodies(context.case, &path, names, problems) else {
            continue;
        };
        let joint = Joint {
            context,
            mesh,
            held: &held,
            name,
            path,
            bodies: numbers,
        };
        let Some(rows) = overlap(&joint, given, bodies, &mut joints, problems) else {
            continue;
        };
        let rows = apart_from(name, rows, &before, problems);
        unfit::full_rank(&joint, bodies, &rows, problems);
        joints.links.extend(joint.link(rows.clone()));
        before.push(rows);
    }
    let borders = ties::borders(context, mesh, bodies, &held, problems);
    joints.links.extend(borders);
    joints
}

/// One overlap: its rows, with cells and weights of the two bodies changed.
fn overlap(
    joint: &Joint,
    given: &schema::Arlequin,
    bodies: &mut [ModelBody],
    joints: &mut Joints,
    problems: &mut Problems,
) -> Option<Rows> {
    let (mesh, name, path) = (joint.mesh, joint.name, &joint.path);
    let [inner, outer] = joint.bodies;
    if joint.bodies.iter().any(|&body| is_thin(&bodies[body])) {
        return thin_overlaps::thin_overlap(joint, given, bodies, joints, problems);
    }
    same_section(path, &bodies[inner], &bodies[outer], problems);
    if bodies[inner].spec.kinematics == Kinematics::Axisymmetric {
        let message =
            "axisymmetric bodies cannot be glued: the products of the link carry no radius";
        let problem = Problem::new(format!("{path}.inner"), message).found(&given.inner);
        return problems.refuse(problem.accepted(["bars, plane bodies, solids"]));
    }
    let region = joints::region(mesh, path, &given.overlap, problems)?;
    let cells = joint.bodies.map(|body| bodies[body].spec.cells.clone());
    let models = Models {
        mesh,
        inner: &cells[0],
        outer: &cells[1],
    };
    let glued = Overlap::new(models, &region).and_then(|overlap| {
        let weights = overlap.weights(&joints::weighting(given.weights))?;
        let rows = overlap.rows(&coupling(given))?;
        Ok((overlap, weights, rows))
    });
    let (overlap, weights, mut rows) = match glued {
        Ok(glued) => glued,
        Err(error) => return problems.refuse(unfit::problem(joint, &error, &cells.concat())),
    };
    let sides = [Model::Inner, Model::Outer];
    let touched = sides.map(|model| overlap.touched(model));
    let touched = touched.iter().flatten().map(|(cell, _)| *cell);
    let all: Vec<ElementId> = touched.chain(overlap.removed().iter().copied()).collect();
    let built = BuiltOverlap {
        name: name.to_string(),
        measure: overlap.measure(),
        layers: overlap.layers(),
        sizes: sides.map(|model| overlap.size(model)),
        removed: overlap.removed().len(),
    };
    joints::enter(joint, built, all, joints, problems)?;
    for warning in &weights.warnings {
        problems.warn(format!("overlap `{name}`: {}", doubt(warning)));
    }
    if overlap.layers() < FEW_LAYERS {
        problems.warn(format!(
            "overlap `{name}`: {:.2} cells of `{}` wide; two to four transmit waves better",
            overlap.layers(),
            given.outer
        ));
    }
    for (model, body, weights) in [
        (Model::Inner, inner, &weights.inner),
        (Model::Outer, outer, &weights.outer),
    ] {
        joints::weigh(mesh, &mut bodies[body], overlap.cells(model), weights);
    }
    unfit::drop_held(joint, &mut rows, problems);
    let slivers: Vec<u32> = rows.slivers.iter().map(|sliver| sliver.node).collect();
    let what = "merged into neighbours: the overlap contains too little of their support";
    unfit::name_nodes(joint, &slivers, what, problems);
    Some(rows)
}

fn same_section(path: &str, inner: &ModelBody, outer: &ModelBody, problems: &mut Problems) {
    if inner.spec.kinematics != outer.spec.kinematics {
        let message = format!(
            "the bodies `{}` and `{}` overlap and have different sections",
            inner.spec.name, outer.spec.name
        );
        problems.push(Problem::new(path, message).accepted(["bodies of the same section"]));
    }
}

/// Drops the rows that overlaps before have too.
fn apart_from(name: &str, mut rows: Rows, before: &[Rows], problems: &mut Problems) -> Rows {
    for other in before {
        let shared = rows.shared(other);
        let dropped = rows.drop(|node, component| shared.contains(&(node, component)));
        if !dropped.is_empty() {
            problems.warn(format!(
                "overlap `{name}`: {} removed: another overlap has the same",
                plural(dropped.len(), "constraint")
            ));
        }
    }
    rows
}

/// Refuses contact surfaces in an overlap.
pub(super) fn contacts_outside(
    context: &Context,
    mesh: &Mesh,
    contacts: &[ModelContact],
    joints: &Joints,
    problems: &mut Problems,
) {
    for contact in contacts {
        for (key, faces) in ["secondary", "primary"]
            .into_iter()
            .zip(lookup::faces_of(contact))
        {
            let parents = faces.iter().map(|face| face.parent);
            let inside: Vec<ElementId> = parents
                .filter(|cell| joints.inside.contains_key(cell))
                .collect();
            let Some(first) = inside.first() else {
                continue;
            };
            let name = joints.overlaps[joints.inside[first]].name.clone();
            let message = format!(
                "{} of this contact surface lie in the overlap `{name}`",
                plural(inside.len(), "face")
            );
            let problem = Problem::new(format!("contact.{}.{key}", contact.name), message)
                .accepted(["a surface outside all overlaps"]);
            let problem = joints::shown(context, (&name, mesh), problem, &inside);
            problems.push(problem);
        }
    }
}

fn coupling(given: &schema::Arlequin) -> Coupling {
    Coupling {
        mediator: match given.mediator {
            schema::Mediator::Coarser => Mediator::Coarser,
            schema::Mediator::Inner => Mediator::Of(Model::Inner),
            schema::Mediator::Outer => Mediator::Of(Model::Outer),
        },
        bracket: match given.bracket {
            schema::Bracket::Named(schema::BracketName::L2) => Bracket::L2,
            schema::Bracket::With(BracketWith::H1(h1)) => Bracket::H1 {
                kappa: match h1.length {
                    BracketLength::Named(schema::LengthName::Auto) => None,
                    BracketLength::Given(length) => Some(length.0),
                },
            },
        },
        ..Coupling::default()
    }
}
