//! What overlaps and borders between zones have in common.

use std::collections::BTreeMap;

use carom_arlequin::{CellWeights, Profile, Region, Rows, Weighting};
use carom_bodies::Kinematics;
use carom_dynamics::{ModelBody, ModelLink};
use carom_mesh::{ElementId, Mesh};

use super::context::Context;
use super::problems::{Problems, plural};
use super::unfit;
use crate::error::Problem;
use crate::schema::{self, OverlapRegion, OverlapShape, ProfileWith};

/// Cells of the outer body across an overlap below which waves notice it.
pub(super) const FEW_LAYERS: f64 = 2.0;

/// An overlap of a built case.
#[derive(Clone, Debug, PartialEq)]
pub struct BuiltOverlap {
    /// Name as in the case file.
    pub name: String,
    /// Its measure, m, m² or m³.
    pub measure: f64,
    /// Least thickness in cells of the outer body, of a beam or shell and a solid in those of the coarser one; infinite without two borders.
    pub layers: f64,
    /// Mean size of the cells of the inner and of the outer body in it, m.
    pub sizes: [f64; 2],
    /// Cells of the outer body that fell away.
    pub removed: usize,
}

/// What the joints of a case come to.
#[derive(Debug, Default)]
pub(super) struct Joints {
    pub(super) links: Vec<ModelLink>,
    pub(super) overlaps: Vec<BuiltOverlap>,
    /// Cells in an overlap, and which.
    pub(super) inside: BTreeMap<ElementId, usize>,
}

pub(super) fn link(
    context: &Context,
    name: &str,
    bodies: (&str, &str),
    rows: Rows,
    joints: &mut Joints,
) {
    let zone = |body: &str| {
        let number = context.case.body.names().position(|one| one == body);
        number.and_then(|number| context.plan.zone_of(number))
    };
    if let (Some(inner), Some(outer)) = (zone(bodies.0), zone(bodies.1)) {
        joints.links.push(ModelLink {
            name: name.to_string(),
            zones: [inner, outer],
            rows: rows.rows,
        });
    }
}

/// Enters an overlap with the cells that it touches or takes away; refuses a cell of two overlaps.
pub(super) fn enter(
    context: &Context,
    mesh: &Mesh,
    overlap: BuiltOverlap,
    all: Vec<ElementId>,
    joints: &mut Joints,
    problems: &mut Problems,
) -> Option<()> {
    let name = overlap.name.clone();
    let twice: Vec<ElementId> = all
        .iter()
        .copied()
        .filter(|cell| joints.inside.contains_key(cell))
        .collect();
    if let Some(first) = twice.first() {
        let other = &joints.overlaps[joints.inside[first]].name;
        let message = format!(
            "{} belong to this overlap and to `{other}`",
            plural(twice.len(), "cell")
        );
        let problem = Problem::new(format!("arlequin.{name}.overlap"), message)
            .accepted(["overlaps with no cell in common"]);
        let problem = unfit::shown(context, problem, (&name, mesh), &twice);
        problems.push(problem);
        return None;
    }
    let number = joints.overlaps.len();
    joints
        .inside
        .extend(all.into_iter().map(|cell| (cell, number)));
    joints.overlaps.push(overlap);
    Some(())
}

pub(super) fn region(
    mesh: &Mesh,
    path: &str,
    given: &OverlapRegion,
    problems: &mut Problems,
) -> Option<Region> {
    match given {
        OverlapRegion::Named(schema::OverlapName::Intersection) => Some(Region::Intersection),
        OverlapRegion::Group(name) => {
            let path = format!("{path}.overlap");
            if !mesh.groups.contains_key(name) {
                let names = mesh.groups.keys().map(String::as_str);
                let problem = Problem::new(path, "no group of this name in the mesh");
                problems.push(problem.unknown(name, names.chain(["intersection"])));
                return None;
            }
            let group = problems.group(mesh, &path, name)?;
            Some(Region::Cells(group.elements.clone()))
        }
        OverlapRegion::Region(OverlapShape::Box(sides)) => {
            let path = format!("{path}.overlap.box");
            let min = problems.vector(mesh, &format!("{path}.min"), &sides.min);
            let max = problems.vector(mesh, &format!("{path}.max"), &sides.max);
            if (0..mesh.dim).any(|i| min[i] >= max[i]) {
                let problem = Problem::new(path, "a box without volume");
                problems.push(problem.accepted(["every component of `max` above that of `min`"]));
                return None;
            }
            Some(Region::Box { min, max })
        }
    }
}

/// Whether a body is one of beams or shells.
pub(super) fn is_thin(body: &ModelBody) -> bool {
    matches!(
        body.spec.kinematics,
        Kinematics::Beam(_) | Kinematics::Shell(_)
    )
}

/// Gives a body the cells that stay and their weights, multiplied where it has some.
pub(super) fn weigh(mesh: &Mesh, body: &mut ModelBody, cells: &[ElementId], weights: &CellWeights) {
    let mut inertia = weights.inertia.clone();
    let mut stiffness = weights.stiffness.clone();
    if let Some(before) = &body.spec.weights {
        let (mut from, mut to) = (0, 0);
        for &cell in &body.spec.cells {
            let nodes = mesh.kind(cell).table().nodes;
            if cells.binary_search(&cell).is_ok() {
                for a in 0..nodes {
                    inertia[to + a] *= before.inertia[from + a];
                    stiffness[to + a] *= before.stiffness[from + a];
                }
                to += nodes;
            }
            from += nodes;
        }
    }
    body.spec.cells = cells.to_vec();
    body.spec.weights = Some(carom_bodies::CellWeights { inertia, stiffness });
}

pub(super) fn weighting(given: schema::Weights) -> Weighting {
    let named = |name: schema::ProfileName| match name {
        schema::ProfileName::Linear => Profile::Linear,
        schema::ProfileName::Smooth => Profile::Smooth,
    };
    let profile = |profile: schema::Profile| match profile {
        schema::Profile::Named(name) => named(name),
        schema::Profile::With(ProfileWith::Constant(value)) => Profile::Constant(value),
    };
    match given {
        schema::Weights::Same(name) => Weighting {
            inertia: named(name),
            stiffness: named(name),
            floor: 0.0,
        },
        schema::Weights::Apart(table) => Weighting {
            inertia: profile(table.inertia),
            stiffness: profile(table.stiffness),
            floor: table.floor,
        },
    }
}
