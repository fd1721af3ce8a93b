//! Overlaps and borders between zones: cells that fall away, weights, rows, and what is wrong with them.

use std::collections::BTreeMap;

use carom_arlequin::{
    Bracket, CellWeights, Coupling, Error, Mediator, Model, Models, Overlap, Profile, Region, Rows,
    Weighting,
};
use carom_bodies::Kinematics;
use carom_dynamics::{ModelBody, ModelContact, ModelLink, ModelTarget, Support};
use carom_mesh::{ElementId, Mesh};

use super::Builder;
use super::held::Held;
use super::unfit::doubt;
use crate::error::Problem;
use crate::schema::{self, BracketLength, BracketWith, OverlapRegion, OverlapShape, ProfileWith};

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

impl Builder<'_> {
    /// Joins the zones: takes cells away and gives weights where bodies overlap, and makes the rows of all joints.
    pub(super) fn joints_of(
        &mut self,
        mesh: &Mesh,
        bodies: &mut [ModelBody],
        supports: &[Support],
    ) -> Joints {
        let case = self.case;
        let held = Held::new(mesh, supports);
        let mut joints = Joints::default();
        let mut before: Vec<Rows> = Vec::new();
        for (name, given) in case.arlequin.iter() {
            if let Some(rows) = self.overlap((name, given), mesh, bodies, &held, &mut joints) {
                let rows = self.apart_from(name, rows, &before);
                self.full_rank(&format!("arlequin.{name}"), mesh, bodies, &rows, &held);
                self.link(
                    name,
                    (&given.inner, &given.outer),
                    rows.clone(),
                    &mut joints,
                );
                before.push(rows);
            }
        }
        self.borders(mesh, bodies, &held, &mut joints);
        joints
    }

    pub(super) fn link(
        &mut self,
        name: &str,
        bodies: (&str, &str),
        rows: Rows,
        joints: &mut Joints,
    ) {
        let zone = |body: &str| {
            let number = self.case.body.names().position(|one| one == body);
            number.and_then(|number| self.plan.zone_of(number))
        };
        if let (Some(inner), Some(outer)) = (zone(bodies.0), zone(bodies.1)) {
            joints.links.push(ModelLink {
                name: name.to_string(),
                zones: [inner, outer],
                rows: rows.rows,
            });
        }
    }

    /// One overlap: its rows, with cells and weights of the two bodies changed.
    fn overlap(
        &mut self,
        (name, given): (&str, &schema::Arlequin),
        mesh: &Mesh,
        bodies: &mut [ModelBody],
        held: &Held,
        joints: &mut Joints,
    ) -> Option<Rows> {
        let path = format!("arlequin.{name}");
        let inner = self.body(&format!("{path}.inner"), &given.inner)?;
        let outer = self.body(&format!("{path}.outer"), &given.outer)?;
        if [inner, outer].iter().any(|&body| is_thin(&bodies[body])) {
            let of = ([inner, outer], held);
            return self.thin_overlap((name, given), mesh, bodies, of, joints);
        }
        self.same_section(&path, &bodies[inner], &bodies[outer]);
        if bodies[inner].spec.kinematics == Kinematics::Axisymmetric {
            let message =
                "axisymmetric bodies cannot be glued: the products of the link carry no radius";
            let problem = Problem::new(format!("{path}.inner"), message).found(&given.inner);
            self.problems
                .push(problem.accepted(["bars, plane bodies, solids"]));
            return None;
        }
        let region = self.region(mesh, &path, &given.overlap)?;
        let cells = [inner, outer].map(|body| bodies[body].spec.cells.clone());
        let models = Models {
            mesh,
            inner: &cells[0],
            outer: &cells[1],
        };
        let refuse = |builder: &mut Self, error: &Error| {
            let all = cells.concat();
            let problem = builder.unfit((&path, name), mesh, error, &all);
            builder.problems.push(problem);
        };
        let overlap = Overlap::new(models, &region)
            .map_err(|error| refuse(self, &error))
            .ok()?;
        let weights = overlap
            .weights(&weighting(given.weights))
            .map_err(|error| refuse(self, &error))
            .ok()?;
        let coupling = coupling(given);
        let mut rows = overlap
            .rows(&coupling)
            .map_err(|error| refuse(self, &error))
            .ok()?;
        let touched = [Model::Inner, Model::Outer].map(|model| overlap.touched(model));
        let touched = touched.iter().flatten().map(|(cell, _)| *cell);
        let all: Vec<ElementId> = touched.chain(overlap.removed().iter().copied()).collect();
        let built = BuiltOverlap {
            name: name.to_string(),
            measure: overlap.measure(),
            layers: overlap.layers(),
            sizes: [Model::Inner, Model::Outer].map(|model| overlap.size(model)),
            removed: overlap.removed().len(),
        };
        self.enter(mesh, built, all, joints)?;
        for warning in &weights.warnings {
            self.warnings
                .push(format!("overlap `{name}`: {}", doubt(warning)));
        }
        if overlap.layers() < FEW_LAYERS {
            self.warnings.push(format!(
                "overlap `{name}`: {:.2} cells of `{}` wide; two to four transmit waves better",
                overlap.layers(),
                given.outer
            ));
        }
        weigh(
            mesh,
            &mut bodies[inner],
            overlap.cells(Model::Inner),
            &weights.inner,
        );
        weigh(
            mesh,
            &mut bodies[outer],
            overlap.cells(Model::Outer),
            &weights.outer,
        );
        let dropped = held.drop_rows(&mut rows);
        self.name_rows(
            name,
            mesh,
            &dropped,
            "removed: supports hold both bodies there",
        );
        let slivers: Vec<(u32, u32)> = rows.slivers.iter().map(|s| (s.node, 0)).collect();
        self.name_nodes(
            name,
            mesh,
            &slivers,
            "merged into neighbours: the overlap contains too little of their support",
        );
        Some(rows)
    }

    /// Enters an overlap with the cells that it touches or takes away; refuses a cell of two overlaps.
    pub(super) fn enter(
        &mut self,
        mesh: &Mesh,
        overlap: BuiltOverlap,
        all: Vec<ElementId>,
        joints: &mut Joints,
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
                super::plural(twice.len(), "cell")
            );
            let problem = Problem::new(format!("arlequin.{name}.overlap"), message)
                .accepted(["overlaps with no cell in common"]);
            let problem = self.shown(problem, (&name, mesh), &twice);
            self.problems.push(problem);
            return None;
        }
        let number = joints.overlaps.len();
        joints
            .inside
            .extend(all.into_iter().map(|cell| (cell, number)));
        joints.overlaps.push(overlap);
        Some(())
    }

    fn same_section(&mut self, path: &str, inner: &ModelBody, outer: &ModelBody) {
        if inner.spec.kinematics != outer.spec.kinematics {
            let message = format!(
                "the bodies `{}` and `{}` overlap and have different sections",
                inner.spec.name, outer.spec.name
            );
            self.problems
                .push(Problem::new(path, message).accepted(["bodies of the same section"]));
        }
    }

    pub(super) fn region(
        &mut self,
        mesh: &Mesh,
        path: &str,
        given: &OverlapRegion,
    ) -> Option<Region> {
        match given {
            OverlapRegion::Named(schema::OverlapName::Intersection) => Some(Region::Intersection),
            OverlapRegion::Group(name) => {
                let path = format!("{path}.overlap");
                if !mesh.groups.contains_key(name) {
                    let names = mesh.groups.keys().map(String::as_str);
                    let problem = Problem::new(path, "no group of this name in the mesh");
                    self.problems
                        .push(problem.unknown(name, names.chain(["intersection"])));
                    return None;
                }
                let group = self.group(mesh, &path, name)?;
                Some(Region::Cells(group.elements.clone()))
            }
            OverlapRegion::Region(OverlapShape::Box(sides)) => {
                let path = format!("{path}.overlap.box");
                let min = self.vector(mesh, &format!("{path}.min"), &sides.min);
                let max = self.vector(mesh, &format!("{path}.max"), &sides.max);
                if (0..mesh.dim).any(|i| min[i] >= max[i]) {
                    let problem = Problem::new(path, "a box without volume");
                    self.problems
                        .push(problem.accepted(["every component of `max` above that of `min`"]));
                    return None;
                }
                Some(Region::Box { min, max })
            }
        }
    }

    /// Drops the rows that overlaps before have too.
    fn apart_from(&mut self, name: &str, mut rows: Rows, before: &[Rows]) -> Rows {
        for other in before {
            let shared = rows.shared(other);
            let dropped = rows.drop(|node, component| shared.contains(&(node, component)));
            if !dropped.is_empty() {
                self.warnings.push(format!(
                    "overlap `{name}`: {} removed: another overlap has the same",
                    super::plural(dropped.len(), "constraint")
                ));
            }
        }
        rows
    }

    /// Refuses contact surfaces in an overlap.
    pub(super) fn contacts_outside(
        &mut self,
        mesh: &Mesh,
        contacts: &[ModelContact],
        joints: &Joints,
    ) {
        for contact in contacts {
            let primary = match &contact.primary {
                ModelTarget::Surface(surface) => &surface.faces[..],
                ModelTarget::Rigid(_) => &[],
            };
            let sides = [
                ("secondary", &contact.secondary.faces[..]),
                ("primary", primary),
            ];
            for (key, faces) in sides {
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
                    super::plural(inside.len(), "face")
                );
                let problem = Problem::new(format!("contact.{}.{key}", contact.name), message)
                    .accepted(["a surface outside all overlaps"]);
                let problem = self.shown(problem, (&name, mesh), &inside);
                self.problems.push(problem);
            }
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
