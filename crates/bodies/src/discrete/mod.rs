//! Point masses, springs and dashpots, and bolts between two nodes.
//!
//! A spring or a dashpot is between two nodes a and b, or between a node a and the ground, which does not move. Along a
//! unit vector n its elongation is `e = n · (u_b - u_a)`, with `u_b = 0` on the ground. Its force F, positive in tension, is
//! a function of e (spring) or of ė (dashpot), and acts with `n F` on a and with `-n F` on b. In all directions it is one
//! along each axis. n is fixed in space: an element that turns much is none of these.
//!
//! Forces on the ground have no partner in the system, and forces along n have a moment where nodes do not stand along n:
//! [`Body::balances_itself`](crate::Body::balances_itself).

mod across;
mod bolt;
mod curve;
mod fluid;

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::unknowns::{Kind, Unknowns};
use carom_mesh::{ElementId, Mesh};

pub use self::across::Across;
pub use self::curve::{Curve, CurveError};
pub use self::fluid::FluidGap;
use crate::gyroscopic;
use crate::{Bolt, Error, Placement, Stored};

/// What is called for each row, of unknowns and coefficients.
pub type VisitRow<'a> = dyn FnMut(&[(usize, f64)]) + 'a;

/// What a set of discrete elements is made of.
#[derive(Clone, Debug)]
pub struct DiscreteSpec {
    /// Name as in the case file.
    pub name: String,
    /// Cells of the mesh: points for masses and for what stands on the ground, bars of two nodes for what is between them.
    /// A bar may have no length.
    pub cells: Vec<ElementId>,
    /// What each cell is.
    pub kind: DiscreteKind,
}

impl DiscreteSpec {
    /// Whether the linear driver can take it: a dashpot has forces of the velocity, and a curve is not linear.
    pub fn is_linear(&self) -> bool {
        match &self.kind {
            DiscreteKind::Mass(_) | DiscreteKind::Fluid(_) => true,
            DiscreteKind::Spring(link) => link.curve.is_line(),
            DiscreteKind::Bolt(_) => true,
            DiscreteKind::Dashpot(_) => false,
        }
    }
}

/// What a discrete element is.
#[derive(Clone, Debug, PartialEq)]
pub enum DiscreteKind {
    /// A point mass.
    Mass(PointMass),
    /// A spring: force (N) over elongation (m).
    Spring(Link),
    /// A dashpot: force (N) over the rate of elongation (m/s).
    Dashpot(Link),
    /// The inertia of a fluid in a gap between two bodies.
    Fluid(FluidGap),
    /// Bolts.
    Bolt(Tightened),
}

/// A mass at a node, and its moments of inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointMass {
    /// Mass, kg.
    pub mass: f64,
    /// Moments of inertia about the axes of coordinates, kg m²; in the plane the third one counts. Zero on a node without
    /// rotations.
    pub inertia: [f64; 3],
}

impl From<f64> for PointMass {
    /// A mass without extent.
    fn from(mass: f64) -> PointMass {
        PointMass {
            mass,
            inertia: [0.0; 3],
        }
    }
}

/// How the two ends of a spring or a dashpot are linked.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Force, positive in tension.
    pub curve: Curve,
    /// Unit vector n from the first end to the second one, or to the ground; none for all directions.
    pub axis: Option<[f64; 3]>,
}

/// Springs that a static stage tightens; see [`Bolt`].
#[derive(Clone, Debug, PartialEq)]
pub struct Tightened {
    /// The line of the stiffness, and the axis.
    pub link: Link,
    /// Force of each at the end of the static stage, N, positive in tension.
    pub force: f64,
    /// Whether this is the static stage: they have no stiffness.
    pub tightens: bool,
}

/// The rotations of the nodes of point masses with extent, and the moment of inertia of each.
fn rotations(
    body: &str,
    point: &PointMass,
    nodes: &[[u32; 2]],
    unknowns: &Unknowns,
) -> Result<Vec<(usize, f64)>, Error> {
    let mut rotations = Vec::new();
    if point.inertia == [0.0; 3] {
        return Ok(rotations);
    }
    for &[node, _] in nodes {
        let own = unknowns.rotations_of(node);
        if own.is_empty() {
            return Err(Error::NoRotation {
                body: body.to_owned(),
            });
        }
        for unknown in own {
            if let Kind::Rotation(axis) = unknowns.kind(unknown) {
                rotations.push((unknown, point.inertia[axis]));
            }
        }
    }
    Ok(rotations)
}

/// Discrete elements of one kind.
#[derive(Debug)]
pub struct Discrete {
    name: String,
    cells: Vec<ElementId>,
    kind: DiscreteKind,
    dim: usize,
    /// System numbers of the nodes of each element; twice the same on the ground.
    nodes: Vec<[u32; 2]>,
    /// First unknowns of these nodes.
    first: Vec<[usize; 2]>,
    /// Nodes of an element.
    per: usize,
    /// Length of each element, m.
    lengths: Vec<f64>,
    /// Rotations of all point masses, and the moment of inertia of each, kg m².
    rotations: Vec<(usize, f64)>,
    /// First rotations of point masses in space whose axes turn with their nodes.
    spinning: Vec<usize>,
    bolts: Vec<Bolt>,
}

impl Discrete {
    /// Builds the elements on the cells of a mesh. `number`: system number of each mesh node; `unknowns`: of the nodes of the
    /// system.
    ///
    /// # Errors
    /// No cell, cells that are neither all points nor all bars of two nodes, a mass between two nodes, moments of inertia at a
    /// node without rotations.
    pub fn new(
        mesh: &Mesh,
        spec: DiscreteSpec,
        number: &[u32],
        unknowns: &Unknowns,
    ) -> Result<Discrete, Error> {
        let of = |&cell: &ElementId| mesh.element_nodes(cell);
        let Some(per) = spec.cells.first().map(|cell| of(cell).len()) else {
            return Err(Error::Empty { body: spec.name });
        };
        let most = match spec.kind {
            DiscreteKind::Mass(_) => 1,
            DiscreteKind::Spring(_)
            | DiscreteKind::Dashpot(_)
            | DiscreteKind::Fluid(_)
            | DiscreteKind::Bolt(_) => 2,
        };
        let alone = |per: usize| per == 1 && matches!(spec.kind, DiscreteKind::Fluid(_));
        let unfit = |cell: &&ElementId| of(cell).len() != per || per > most || alone(per);
        if let Some(&cell) = spec.cells.iter().find(unfit) {
            return Err(Error::NotDiscrete {
                body: spec.name,
                found: mesh.kind(cell).table().name,
            });
        }
        let ends = |cell: &ElementId| {
            let nodes = of(cell);
            [nodes[0], nodes[per - 1]].map(|node| number[node as usize])
        };
        let nodes: Vec<[u32; 2]> = spec.cells.iter().map(ends).collect();
        let first = |ends: &[u32; 2]| ends.map(|node| unknowns.first(node));
        let rotations = match &spec.kind {
            DiscreteKind::Mass(point) => rotations(&spec.name, point, &nodes, unknowns)?,
            DiscreteKind::Spring(_)
            | DiscreteKind::Dashpot(_)
            | DiscreteKind::Fluid(_)
            | DiscreteKind::Bolt(_) => Vec::new(),
        };
        let turns = |node: &u32| unknowns.frame(*node).is_some() && mesh.dim == 3;
        let spinning = match rotations.is_empty() {
            true => Vec::new(),
            false => {
                let turning = nodes.iter().map(|[node, _]| *node).filter(turns);
                turning
                    .map(|node| unknowns.rotations_of(node).start)
                    .collect()
            }
        };
        let corners = |cell: &ElementId| [of(cell)[0], of(cell)[per - 1]];
        let mut discrete = Discrete {
            lengths: across::lengths(mesh, spec.cells.iter().map(corners)),
            rotations,
            spinning,
            first: nodes.iter().map(first).collect(),
            nodes,
            name: spec.name,
            cells: spec.cells,
            kind: spec.kind,
            dim: mesh.dim,
            per,
            bolts: Vec::new(),
        };
        discrete.bolts = discrete.bolted();
        Ok(discrete)
    }

    /// Name as in the case file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Cells of the mesh.
    pub fn cells(&self) -> &[ElementId] {
        &self.cells
    }

    /// What each of them is.
    pub fn kind(&self) -> &DiscreteKind {
        &self.kind
    }

    /// Whether forces are linear in displacement and velocity.
    pub(crate) fn is_linear(&self) -> bool {
        self.spinning.is_empty() && self.link().is_none_or(|link| link.curve.is_line())
    }

    /// Adds the forces of springs, and W × J W of point masses whose axes turn, and returns the energy; see
    /// [`Body::force`](crate::Body::force).
    pub(crate) fn force(&self, at: &Placement, f: &mut [f64]) -> Stored {
        if let DiscreteKind::Mass(point) = &self.kind {
            for &first in &self.spinning {
                gyroscopic::add_moment(&point.inertia, (at.v, first), f);
            }
        }
        self.add_spring_force(at, f)
    }

    /// Whether forces depend on the velocity.
    pub(crate) fn has_damping(&self) -> bool {
        matches!(self.kind, DiscreteKind::Dashpot(_))
    }

    /// Whether the elements have stiffness.
    pub(crate) fn has_stiffness(&self) -> bool {
        match &self.kind {
            DiscreteKind::Spring(_) => true,
            DiscreteKind::Bolt(bolt) => !bolt.tightens,
            DiscreteKind::Mass(_) | DiscreteKind::Dashpot(_) | DiscreteKind::Fluid(_) => false,
        }
    }

    /// Whether its mass couples nodes.
    pub(crate) fn couples_mass(&self) -> bool {
        matches!(self.kind, DiscreteKind::Fluid(_))
    }

    fn link(&self) -> Option<&Link> {
        match &self.kind {
            DiscreteKind::Mass(_) | DiscreteKind::Fluid(_) => None,
            DiscreteKind::Spring(link) | DiscreteKind::Dashpot(link) => Some(link),
            DiscreteKind::Bolt(bolt) => Some(&bolt.link),
        }
    }

    fn spring(&self) -> Option<&Link> {
        self.link().filter(|_| self.has_stiffness())
    }

    fn dashpot(&self) -> Option<&Link> {
        self.link().filter(|_| self.has_damping())
    }

    /// System numbers of the nodes of each element.
    pub(crate) fn each_element(&self, visit: &mut dyn FnMut(&[u32])) {
        for nodes in &self.nodes {
            visit(&nodes[..self.per]);
        }
    }

    /// Elongation (m) of an element along its axis for displacements, or its rate (m/s) for velocities; of an element in
    /// all directions along one of the axes of space.
    fn elongation(&self, element: usize, direction: usize, u: &[f64]) -> f64 {
        let first = &self.first[element];
        let axis = self.link().map_or([0.0; 3], |link| axis(link, direction));
        let along = |first: usize| -> f64 {
            let u = &u[first..][..self.dim];
            u.iter().zip(axis).map(|(u, n)| u * n).sum()
        };
        match self.per {
            1 => -along(first[0]),
            _ => along(first[1]) - along(first[0]),
        }
    }

    /// Length of an element, m: between its ends, or the size of the mesh where these are at one place or one is the ground.
    pub fn length(&self, place: u32) -> f64 {
        self.lengths[place as usize]
    }

    /// The element that has moved farthest across its axis at the displacement `u` (m, system vector); none of masses, and of links without an
    /// axis.
    pub fn across(&self, u: &[f64]) -> Option<Across> {
        let axis = match &self.kind {
            DiscreteKind::Mass(_) => return None,
            DiscreteKind::Spring(_) | DiscreteKind::Dashpot(_) | DiscreteKind::Bolt(_) => {
                self.link()?.axis?
            }
            // in the plane the axis is across it
            DiscreteKind::Fluid(gap) => gap.axis.unwrap_or([0.0; 3]),
        };
        let of = |first: usize, i: usize| if i < self.dim { u[first + i] } else { 0.0 };
        let ways = self.first.iter().map(|first| {
            [0, 1, 2].map(|i| match self.per {
                1 => -of(first[0], i),
                _ => of(first[1], i) - of(first[0], i),
            })
        });
        Some(across::farthest(&axis, ways))
    }

    /// Name of the kind: `mass`, `spring`, `dashpot`, `fluid` or `pretension`.
    pub fn kind_name(&self) -> &'static str {
        match self.kind {
            DiscreteKind::Mass(_) => "mass",
            DiscreteKind::Spring(_) => "spring",
            DiscreteKind::Dashpot(_) => "dashpot",
            DiscreteKind::Fluid(_) => "fluid",
            DiscreteKind::Bolt(_) => "pretension",
        }
    }

    /// Sum of the forces of all elements along the axis or along one of those of space, N, positive in tension, and the mean of
    /// what they depend on: the elongation (m) of springs, its rate (m/s) of dashpots. Zero of masses. Of bolts the part of the stiffness.
    pub fn response(&self, direction: usize, [u, v]: [&[f64]; 2]) -> [f64; 2] {
        let Some(link) = self.link() else {
            return [0.0; 2];
        };
        let x = if self.has_damping() { v } else { u };
        let (mut force, mut mean) = (0.0, 0.0);
        for element in 0..self.nodes.len() {
            let extent = self.elongation(element, direction, x);
            force += link.curve.value(extent);
            mean += extent / self.nodes.len() as f64;
        }
        [force, mean]
    }

    /// Directions in which each element acts: one along an axis, as many as space has otherwise.
    pub fn directions(&self) -> usize {
        match self.link() {
            None => 0,
            Some(Link { axis: Some(_), .. }) => 1,
            Some(Link { axis: None, .. }) => self.dim,
        }
    }

    /// Adds the forces of springs and returns their energy; see [`Body::force`](crate::Body::force).
    pub fn add_spring_force(&self, at: &Placement, f: &mut [f64]) -> Stored {
        let mut stored = Stored::default();
        let Some(link) = self.spring() else {
            return stored;
        };
        for element in 0..self.nodes.len() {
            for direction in 0..self.directions() {
                let end = self.elongation(element, direction, at.u);
                stored.strain += link.curve.integral(end);
                let force = match at.from {
                    None => link.curve.value(end),
                    Some(from) => {
                        let start = self.elongation(element, direction, from);
                        link.curve.mean(start, end).0
                    }
                };
                self.add(element, axis(link, direction), force, f);
            }
        }
        stored
    }

    /// Adds the forces of linear springs and returns their energy.
    pub(crate) fn internal_force(&self, u: &[f64], f: &mut [f64]) -> f64 {
        let at = Placement {
            u,
            v: &[],
            from: None,
            frames: &[],
            dt: 0.0,
            old: &[],
        };
        self.add_spring_force(&at, f).strain
    }

    /// Adds the forces of dashpots.
    pub(crate) fn add_damping_force(&self, v: &[f64], f: &mut [f64]) {
        let Some(link) = self.dashpot() else {
            return;
        };
        for element in 0..self.nodes.len() {
            for direction in 0..self.directions() {
                let rate = self.elongation(element, direction, v);
                let force = link.curve.value(rate);
                self.add(element, axis(link, direction), force, f);
            }
        }
    }

    /// Adds the force on the rest of the system reversed: -n F at the first node, n F at the second.
    fn add(&self, element: usize, axis: [f64; 3], force: f64, f: &mut [f64]) {
        for (&first, sign) in self.first[element][..self.per].iter().zip([-1.0, 1.0]) {
            let f = &mut f[first..][..self.dim];
            for (f, n) in f.iter_mut().zip(axis) {
                *f += sign * n * force;
            }
        }
    }

    /// Adds `by_u` ∂f/∂u + `by_v` ∂f/∂v; see [`Body::add_tangent`](crate::Body::add_tangent).
    pub(crate) fn add_tangent(&self, at: &Placement, [by_u, by_v]: [f64; 2], matrix: &mut Csr) {
        if let DiscreteKind::Mass(point) = &self.kind {
            for &first in &self.spinning {
                gyroscopic::add_slope(&point.inertia, (at.v, first), by_v, matrix);
            }
        }
        for element in 0..self.nodes.len() {
            for direction in 0..self.directions() {
                let along = |x| self.elongation(element, direction, x);
                let slope = match &self.kind {
                    DiscreteKind::Mass(_) | DiscreteKind::Fluid(_) => 0.0,
                    DiscreteKind::Dashpot(link) => by_v * link.curve.slope(along(at.v)),
                    DiscreteKind::Bolt(bolt) if bolt.tightens => 0.0,
                    DiscreteKind::Spring(link) | DiscreteKind::Bolt(Tightened { link, .. }) => {
                        by_u * match at.from {
                            None => link.curve.slope(along(at.u)),
                            Some(from) => link.curve.mean(along(from), along(at.u)).1,
                        }
                    }
                };
                self.each_entry((element, direction), slope, &mut |i, j, k| {
                    matrix.add(i, j, k);
                });
            }
        }
    }

    /// Visits the entries of slope · n nᵀ over the unknowns of an element.
    fn each_entry(
        &self,
        (element, direction): (usize, usize),
        slope: f64,
        visit: &mut dyn FnMut(usize, usize, f64),
    ) {
        let Some(link) = self.link() else {
            return;
        };
        let (axis, first) = (axis(link, direction), &self.first[element][..self.per]);
        for (&a, sign_a) in first.iter().zip([-1.0, 1.0]) {
            for (&b, sign_b) in first.iter().zip([-1.0, 1.0]) {
                for i in (0..self.dim).filter(|&i| axis[i] != 0.0) {
                    for j in (0..self.dim).filter(|&j| axis[j] != 0.0) {
                        let value = sign_a * sign_b * slope * axis[i] * axis[j];
                        visit(a + i, b + j, value);
                    }
                }
            }
        }
    }

    /// Visits the rows n of springs, as unknowns and coefficients: what they hold.
    pub(crate) fn each_spring(&self, visit: &mut VisitRow) {
        let Some(link) = self.spring() else {
            return;
        };
        let mut entries = Vec::new();
        for first in &self.first {
            for direction in 0..self.directions() {
                entries.clear();
                let n = axis(link, direction);
                entries.extend(row(&first[..self.per], (n, self.dim)));
                visit(&entries);
            }
        }
    }

    /// Adds the point masses (kg) and their moments of inertia (kg m²) to the entries of a system vector.
    pub(crate) fn add_lumped_mass(&self, mass: &mut [f64]) {
        let DiscreteKind::Mass(point) = self.kind else {
            return;
        };
        for first in &self.first {
            for entry in &mut mass[first[0]..][..self.dim] {
                *entry += point.mass;
            }
        }
        for &(unknown, inertia) in &self.rotations {
            mass[unknown] += inertia;
        }
    }

    /// Adds `stiffness` K + `damping` C, both at rest, + `mass` M; see [`Body::assemble`](crate::Body::assemble).
    pub(crate) fn assemble(
        &self,
        [stiffness, damping, mass]: [f64; 3],
        part: &Range<usize>,
        matrix: &mut Csr,
    ) {
        for (element, &[first, _]) in self.first.iter().enumerate() {
            if !part.contains(&first) {
                continue;
            }
            let slope = match &self.kind {
                DiscreteKind::Mass(point) => {
                    for i in first - part.start..first - part.start + self.dim {
                        matrix.add(i, i, mass * point.mass);
                    }
                    continue;
                }
                DiscreteKind::Fluid(gap) => {
                    let add = &mut |i: usize, j: usize, m: f64| {
                        matrix.add(i - part.start, j - part.start, mass * m);
                    };
                    gap.each_entry((&self.first[element], self.dim), add);
                    continue;
                }
                DiscreteKind::Bolt(bolt) if bolt.tightens => 0.0,
                DiscreteKind::Spring(link) | DiscreteKind::Bolt(Tightened { link, .. }) => {
                    stiffness * link.curve.slope(0.0)
                }
                DiscreteKind::Dashpot(link) => damping * link.curve.slope(0.0),
            };
            for direction in 0..self.directions() {
                self.each_entry((element, direction), slope, &mut |i, j, k| {
                    matrix.add(i - part.start, j - part.start, k);
                });
            }
        }
        for &(unknown, inertia) in &self.rotations {
            if part.contains(&unknown) {
                let i = unknown - part.start;
                matrix.add(i, i, mass * inertia);
            }
        }
    }

    /// Adds the largest sums of the magnitudes in the rows of the stiffness (N/m) or of the damping matrix (N s/m) to system
    /// vectors: over the mass they bound the eigenvalues (Gershgorin).
    pub(crate) fn add_row_sums(&self, stiffness: &mut [f64], damping: &mut [f64]) {
        let sums = match self.has_damping() {
            true => damping,
            false => stiffness,
        };
        let Some(link) = self.link() else {
            return;
        };
        for element in 0..self.nodes.len() {
            for direction in 0..self.directions() {
                let slope = link.curve.steepest();
                self.each_entry((element, direction), slope, &mut |i, _, k| {
                    sums[i] += k.abs();
                });
            }
        }
    }
}

/// The elongation of an element along n, as unknowns and coefficients, from the first unknowns of its nodes.
fn row(first: &[usize], (n, dim): ([f64; 3], usize)) -> impl Iterator<Item = (usize, f64)> + '_ {
    let ends = first.iter().zip([-1.0, 1.0]);
    ends.flat_map(move |(&first, sign)| (0..dim).map(move |i| (first + i, sign * n[i])))
}

/// The unit vector along which an element acts in one of its directions.
fn axis(link: &Link, direction: usize) -> [f64; 3] {
    link.axis
        .unwrap_or_else(|| [0, 1, 2].map(|i| f64::from(u8::from(i == direction))))
}
