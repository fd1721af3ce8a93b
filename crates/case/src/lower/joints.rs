//! What overlaps and borders between zones have in common.

use std::collections::BTreeMap;

use carom_arlequin::{CellWeights, Profile, Region, Rows, Weighting};
use carom_bodies::Kinematics;
use carom_dynamics::{ModelBody, ModelLink};
use carom_mesh::{ElementId, Mesh};

use super::context::Context;
use super::held::Held;
use super::problems::{Problems, plural, with_cells};
use crate::error::Problem;
use crate::offenders::Offenders;
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

/// An overlap or a border between two bodies.
pub(super) struct Joint<'a> {
    pub(super) context: &'a Context<'a>,
    pub(super) mesh: &'a Mesh,
    pub(super) held: &'a Held,
    pub(super) name: &'a str,
    /// Its key.
    pub(super) path: String,
    /// Numbers of the inner and the outer body.
    pub(super) bodies: [usize; 2],
}

impl Joint<'_> {
    /// Its link, where zones have its bodies.
    pub(super) fn link(&self, rows: Rows) -> Option<ModelLink> {
        let [inner, outer] = self.bodies.map(|body| self.context.plan.zone_of(body));
        Some(ModelLink {
            name: self.name.to_string(),
            zones: [inner?, outer?],
            rows: rows.rows,
        })
    }

    /// A problem with the cells that it is about, if there are any.
    pub(super) fn shown(&self, problem: Problem, cells: &[ElementId]) -> Problem {
        shown(self.context, (self.name, self.mesh), problem, cells)
    }
}

/// A problem with the cells of an overlap that it is about, if there are any.
pub(super) fn shown(
    context: &Context,
    (overlap, mesh): (&str, &Mesh),
    problem: Problem,
    cells: &[ElementId],
) -> Problem {
    if cells.is_empty() {
        return problem;
    }
    let offenders = Offenders::new(format!("overlap-{overlap}"), mesh, cells);
    with_cells(problem, offenders, context.file)
}

/// Enters an overlap with the cells that it touches or takes away; refuses a cell of two overlaps.
pub(super) fn enter(
    joint: &Joint,
    overlap: BuiltOverlap,
    all: Vec<ElementId>,
    joints: &mut Joints,
    problems: &mut Problems,
) -> Option<()> {
    let is_known = |cell: &&ElementId| joints.inside.contains_key(*cell);
    let twice: Vec<ElementId> = all.iter().filter(is_known).copied().collect();
    if let Some(first) = twice.first() {
        let other = &joints.overlaps[joints.inside[first]].name;
        let count = plural(twice.len(), "cell");
        let message = format!("{count} belong to this overlap and to `{other}`");
        let problem = Problem::new(format!("{}.overlap", joint.path), message);
        let problem = problem.accepted(["overlaps with no cell in common"]);
        return problems.refuse(joint.shown(problem, &twice));
    }
    let number = joints.overlaps.len();
    let all = all.into_iter().map(|cell| (cell, number));
    joints.inside.extend(all);
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
                return problems.refuse(problem.unknown(name, names.chain(["intersection"])));
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
                return problems
                    .refuse(problem.accepted(["every component of `max` above that of `min`"]));
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
