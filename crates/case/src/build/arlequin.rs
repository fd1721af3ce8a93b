//! Overlaps and borders between zones: cells that fall away, weights, rows, and what is wrong with them.

use std::collections::BTreeMap;

use carom_arlequin::{
    Bracket, CellWeights, Coupling, Error, Mediator, Model, Models, Overlap, Profile, Region, Rows,
    Warning, Weighting,
};
use carom_dynamics::{ModelBody, ModelContact, ModelLink, ModelTarget, Support};
use carom_mesh::{ElementId, Mesh};

use super::Builder;
use super::ties::Ties;
use crate::error::Problem;
use crate::offenders::Offenders;
use crate::schema::{self, BracketLength, BracketWith, OverlapRegion, OverlapShape, ProfileWith};

/// Least eigenvalue of the Gram matrix of the rows, each of length one, below which they count as dependent: the
/// multipliers would keep less than half of their digits.
const LEAST_RANK: f64 = 1e-8;
/// Nodes named in one message; the others are counted.
const LISTED: usize = 3;
/// Cells of the outer body across an overlap below which waves notice it.
const FEW_LAYERS: f64 = 2.0;

/// An overlap of a built case.
#[derive(Clone, Debug, PartialEq)]
pub struct BuiltOverlap {
    /// Name as in the case file.
    pub name: String,
    /// Its measure, m, m² or m³.
    pub measure: f64,
    /// Least thickness in cells of the outer body; infinite without two borders.
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
    inside: BTreeMap<ElementId, usize>,
}

/// Directions in which supports hold each node of the mesh.
struct Held(Vec<[bool; 3]>);

impl Held {
    fn new(mesh: &Mesh, supports: &[Support]) -> Held {
        let mut held = vec![[false; 3]; mesh.nodes.len()];
        for support in supports {
            for &node in &support.nodes {
                for (held, fix) in held[node as usize].iter_mut().zip(support.fix) {
                    *held |= fix;
                }
            }
        }
        Held(held)
    }

    fn has(&self, node: u32, component: u32) -> bool {
        self.0[node as usize][component as usize]
    }

    /// Drops the rows whose node supports hold in both bodies; the multiplier there has nothing to do.
    fn drop_rows(&self, rows: &mut Rows) -> Vec<(u32, u32)> {
        let held = |terms: &[carom_arlequin::Term], component| {
            let mut terms = terms.iter();
            terms.any(|t| t.component == component && self.has(t.node, component))
        };
        let both = rows.rows.iter().filter(|row| {
            self.has(row.node, row.component)
                && held(&row.inner, row.component)
                && held(&row.outer, row.component)
        });
        let both: Vec<(u32, u32)> = both.map(|row| (row.node, row.component)).collect();
        rows.drop(|node, component| both.contains(&(node, component)))
    }
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

    fn link(&mut self, name: &str, bodies: (&str, &str), rows: Rows, joints: &mut Joints) {
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
        self.same_section(&path, &bodies[inner], &bodies[outer]);
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
        self.enter(name, mesh, &overlap, joints)?;
        for warning in &weights.warnings {
            self.warnings
                .push(format!("overlap `{name}`: {}", doubt(warning)));
        }
        if overlap.layers() < FEW_LAYERS {
            self.warnings.push(format!(
                "overlap `{name}`: {:.2} cells of `{}` across; two to four let waves pass better",
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
            "dropped: supports hold both bodies there",
        );
        let slivers: Vec<(u32, u32)> = rows.slivers.iter().map(|s| (s.node, 0)).collect();
        self.name_nodes(
            name,
            mesh,
            &slivers,
            "merged into neighbours: the overlap holds too little of their support",
        );
        Some(rows)
    }

    /// Enters the cells of an overlap; refuses a cell of two overlaps, or one that another overlap took away.
    fn enter(
        &mut self,
        name: &str,
        mesh: &Mesh,
        overlap: &Overlap,
        joints: &mut Joints,
    ) -> Option<()> {
        let touched = [Model::Inner, Model::Outer].map(|model| overlap.touched(model));
        let touched = touched.iter().flatten().map(|(cell, _)| *cell);
        let all: Vec<ElementId> = touched.chain(overlap.removed().iter().copied()).collect();
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
            let problem = self.shown(problem, (name, mesh), &twice);
            self.problems.push(problem);
            return None;
        }
        let number = joints.overlaps.len();
        joints
            .inside
            .extend(all.into_iter().map(|cell| (cell, number)));
        joints.overlaps.push(BuiltOverlap {
            name: name.to_string(),
            measure: overlap.measure(),
            layers: overlap.layers(),
            sizes: [Model::Inner, Model::Outer].map(|model| overlap.size(model)),
            removed: overlap.removed().len(),
        });
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

    fn region(&mut self, mesh: &Mesh, path: &str, given: &OverlapRegion) -> Option<Region> {
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
                    "overlap `{name}`: {} dropped: another overlap has the same",
                    super::plural(dropped.len(), "row")
                ));
            }
        }
        rows
    }

    /// Refuses rows that are dependent on the unknowns that are free.
    fn full_rank(
        &mut self,
        path: &str,
        mesh: &Mesh,
        bodies: &[ModelBody],
        rows: &Rows,
        held: &Held,
    ) {
        let rank = match rows.rank(|node, component| held.has(node, component)) {
            Ok(rank) => rank,
            Err(error) => {
                self.problems.push(Problem::new(path, error.to_string()));
                return;
            }
        };
        if rank.smallest >= LEAST_RANK {
            return;
        }
        let (node, component) = rank.weakest;
        let at = place(mesh, node);
        let message =
            "the mediator has functions that the two bodies do not see: their rows are dependent";
        let problem = Problem::new(format!("{path}.mediator"), message)
            .found(format!(
                "a least eigenvalue of {:.1e} of the scaled rows, most of it of node {node}, {at}, in {}",
                rank.smallest,
                axis(component)
            ))
            .accepted([
                format!("at least {LEAST_RANK:e}"),
                "mediator = \"coarser\"".to_string(),
                "supports that end outside the overlap".to_string(),
            ]);
        let cells = bodies.iter().flat_map(|body| &body.spec.cells);
        let around = cells.filter(|&&cell| mesh.element_nodes(cell).contains(&node));
        let around: Vec<ElementId> = around.copied().collect();
        let name = path.rsplit('.').next().unwrap_or(path);
        let problem = self.shown(problem, (name, mesh), &around);
        self.problems.push(problem);
    }

    /// The borders where zones are tied node to node.
    fn borders(&mut self, mesh: &Mesh, bodies: &[ModelBody], held: &Held, joints: &mut Joints) {
        let case = self.case;
        let mut ties = Ties::new(mesh, bodies, &self.plan);
        for (name, given) in case.interface.iter() {
            let path = format!("interface.{name}");
            let (Some(inner), Some(outer)) = (
                self.body(&format!("{path}.inner"), &given.inner),
                self.body(&format!("{path}.outer"), &given.outer),
            ) else {
                continue;
            };
            let mut rows = match ties.rows(inner, outer) {
                Ok(rows) => rows,
                Err(error) => {
                    let problem = Problem::new(path, error.to_string());
                    self.problems
                        .push(problem.accepted(["two bodies with nodes at the same places"]));
                    continue;
                }
            };
            let known = ties.join([inner, outer], &mut rows);
            self.name_rows(
                name,
                mesh,
                &known,
                "dropped: other interfaces tie them already",
            );
            let dropped = held.drop_rows(&mut rows);
            self.name_rows(
                name,
                mesh,
                &dropped,
                "dropped: supports hold both bodies there",
            );
            self.link(name, (&given.inner, &given.outer), rows, joints);
        }
        for (bodies, nodes) in ties.loose() {
            let message = format!(
                "the bodies `{}` and `{}` share {} and are in two zones, which nothing ties",
                bodies[0],
                bodies[1],
                super::plural(nodes.len(), "node")
            );
            let accepted = format!(
                "[interface.<name>] with inner = \"{}\", outer = \"{}\"",
                bodies[0], bodies[1]
            );
            self.problems
                .push(Problem::new("zone", message).accepted([accepted]));
        }
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
                ModelTarget::Plane(_) | ModelTarget::Sphere(_) => &[],
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

    /// The problem behind an error of an overlap. `all`: cells of both bodies.
    fn unfit(
        &self,
        (path, name): (&str, &str),
        mesh: &Mesh,
        error: &Error,
        all: &[ElementId],
    ) -> Problem {
        let (key, cells, accepted): (&str, &[ElementId], &str) = match error {
            Error::NotCovered { cells, .. } => {
                (".overlap", cells, "a group of cells that both bodies cover")
            }
            Error::EndsOutside { cells } => (
                ".overlap",
                cells,
                "an overlap up to the end of the inner body",
            ),
            Error::Thin { cells, .. } => (
                ".overlap",
                cells,
                "at least one cell of the outer body, better two to four",
            ),
            Error::Empty => (".overlap", all, "a place where both bodies are"),
            Error::NoBorder { .. } => (".weights", all, "an overlap in which each body ends"),
            Error::Range { .. } | Error::Reflects { .. } => (".weights", &[], "\"linear\""),
            Error::NoMediator => (".mediator", all, "\"coarser\""),
            Error::Dimension { cell, .. } | Error::InverseMap { cell } => (
                "",
                std::slice::from_ref(cell),
                "sound cells that fill the space of the mesh",
            ),
            Error::SharedNode { .. } => ("", &[], "bodies with meshes of their own"),
            Error::NoCells { .. } => ("", &[], "bodies with cells"),
            Error::Defect(_)
            | Error::NoInterface { .. }
            | Error::Ambiguous { .. }
            | Error::Algebra(_) => ("", &[], "two sound bodies"),
        };
        let problem = Problem::new(format!("{path}{key}"), error.to_string()).accepted([accepted]);
        self.shown(problem, (name, mesh), cells)
    }

    /// A problem with the cells that it is about, if there are any.
    fn shown(&self, problem: Problem, (name, mesh): (&str, &Mesh), cells: &[ElementId]) -> Problem {
        if cells.is_empty() {
            return problem;
        }
        let offenders = Offenders::new(format!("overlap-{name}"), mesh, cells);
        let path = offenders.path(&self.file);
        let note = format!("`carom check` writes the cells to {}", path.display());
        Problem {
            offenders: Some(offenders),
            ..problem.note(note)
        }
    }

    /// Warns of rows, named by node and direction.
    fn name_rows(&mut self, joint: &str, mesh: &Mesh, rows: &[(u32, u32)], what: &str) {
        let name = |&(node, component): &(u32, u32)| {
            format!("{} of node {node}, {}", axis(component), place(mesh, node))
        };
        self.name_all(joint, rows.iter().map(name), "row", what);
    }

    /// Warns of mediator functions, named by their node.
    fn name_nodes(&mut self, joint: &str, mesh: &Mesh, nodes: &[(u32, u32)], what: &str) {
        let name = |&(node, _): &(u32, u32)| format!("node {node}, {}", place(mesh, node));
        self.name_all(joint, nodes.iter().map(name), "mediator function", what);
    }

    fn name_all(
        &mut self,
        joint: &str,
        names: impl ExactSizeIterator<Item = String>,
        noun: &str,
        what: &str,
    ) {
        let count = names.len();
        if count == 0 {
            return;
        }
        let first: Vec<String> = names.take(LISTED).collect();
        let more = match count > LISTED {
            true => format!("; and {} more", count - LISTED),
            false => String::new(),
        };
        self.warnings.push(format!(
            "joint `{joint}`: {} {what} ({}{more})",
            super::plural(count, noun),
            first.join("; ")
        ));
    }
}

/// Gives a body the cells that stay and their weights, multiplied where it has some.
fn weigh(mesh: &Mesh, body: &mut ModelBody, cells: &[ElementId], weights: &CellWeights) {
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

fn weighting(given: schema::Weights) -> Weighting {
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

fn doubt(warning: &Warning) -> String {
    match warning {
        Warning::NotPatchExact => "a constant strain is not reproduced exactly: only linear weights between two plane parallel borders do that".to_string(),
        Warning::SmallStep { model, factor } => format!(
            "the weights cut the critical step of the {model} body to about {factor:.2} of its own"
        ),
    }
}

fn axis(component: u32) -> &'static str {
    ["x", "y", "z"][component.min(2) as usize]
}

fn place(mesh: &Mesh, node: u32) -> String {
    let x = mesh.nodes[node as usize];
    format!("({:.6}, {:.6}, {:.6}) m", x[0], x[1], x[2])
}
