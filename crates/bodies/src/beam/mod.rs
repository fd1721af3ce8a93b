//! Beams: straight elements of two nodes with translations and small rotations, after Euler and Bernoulli or Timoshenko.
//!
//! The axis of an element runs through the centroids of its ends; a node may stand beside it, at a distance that is fixed in the
//! section: `u_centroid = u + θ × e`. Forces are `f = K u` with one constant matrix for each element; of metal that flows they are those of
//! the fibres of its sections.

mod axis;
mod bolts;
mod checks;
mod condensation;
mod element;
mod extremes;
mod fibres;
mod flow;
mod forces;
mod functions;
mod large;
mod results;
mod section;
mod strain;
mod tightened;

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::tensor::{Mat3, Vec3};
use carom_algebra::unknowns::Unknowns;
use carom_materials::{Elastic, Plane};
use carom_mesh::{ElementId, Mesh};

pub use self::axis::BeamAxis;
pub use self::extremes::SectionStress;
pub use self::forces::SectionForces;
pub use self::large::LargeBeam;
pub use self::section::{
    BeamSection, BeamTheory, Extremes, LAYERS, Rotations, SectionProperties, SectionShape,
};

use self::checks::{check, end_weights};
use self::element::{Element, EndWeights, Matrix};
use self::extremes::Places;
use self::tightened::Bolts;
use crate::discrete::VisitRow;
use crate::flowing::Flowing;
use crate::release::Release;
use crate::spec::BodySpec;
use crate::stability::largest_eigenvalue;
use crate::{Error, Placement, Stored};

/// Sine of the angle between orientation and axis below which they are parallel.
const PARALLEL: f64 = 1e-6;

/// Entries of the lumped mass off the diagonal, over those on it, that are rounding.
const ROUNDING: f64 = 1e-12;

/// A body of beam elements on a system.
#[derive(Debug)]
pub struct Beam {
    name: String,
    section: BeamSection,
    material: Elastic,
    cells: Vec<ElementId>,
    dim: usize,
    /// System numbers of the nodes of each element.
    nodes: Vec<[u32; 2]>,
    /// First unknowns of these nodes.
    pub(crate) first: Vec<[usize; 2]>,
    lengths: Vec<f64>,
    /// Axes x, y, z of each element, as rows.
    axes: Vec<Mat3>,
    /// Weights of each element.
    weights: Vec<EndWeights>,
    /// K of each element over its unknowns, row-major.
    stiffness: Vec<f64>,
    /// T of elements with released rotations.
    condensed: Vec<Option<Box<Matrix>>>,
    /// Released rotations of these.
    released: Vec<[bool; 12]>,
    /// Extension and bending of metal that flows.
    pub(crate) flowing: Option<Flowing>,
    /// Where its sections have their largest stresses; none where that is not known.
    pub(crate) places: Option<Places>,
    bolts: Bolts,
}

impl Beam {
    /// Builds the elements on the cells of a mesh. `number`: system number of each mesh node; `unknowns`: of the nodes of the
    /// system, with small rotations.
    ///
    /// # Errors
    /// Cells that are no bars of two nodes, or on a line; one without length, or whose orientation is missing or along it; a
    /// law at finite strain without a uniaxial one; weights that are too few or negative; metal that flows in a section without a shape, with
    /// hinges or with weights.
    pub(crate) fn new(
        mesh: &Mesh,
        spec: BodySpec,
        section: BeamSection,
        number: &[u32],
        unknowns: &Unknowns,
    ) -> Result<Beam, Error> {
        check(mesh, &spec)?;
        let mut beam = Beam {
            weights: end_weights(mesh, &spec)?,
            places: Places::new(&section),
            section,
            material: spec.material.initial(),
            dim: mesh.dim,
            nodes: Vec::new(),
            first: Vec::new(),
            lengths: Vec::new(),
            axes: Vec::new(),
            stiffness: Vec::new(),
            condensed: Vec::new(),
            released: Vec::new(),
            flowing: None,
            bolts: Bolts::of(&spec.cells, &spec.tightened),
            name: spec.name,
            cells: spec.cells,
        };
        for &cell in &beam.cells {
            let nodes = mesh.element_nodes(cell);
            let [from, to] = [nodes[0], nodes[1]].map(|node| Vec3::from(mesh.nodes[node as usize]));
            let along = to - from;
            let refused = |why| Error::BeamAxes {
                body: beam.name.clone(),
                cell,
                why,
            };
            if along.norm() <= 1e-12 * from.norm().max(to.norm()) {
                return Err(refused("has no length"));
            }
            beam.axes
                .push(axes(&along.normalize(), &section, mesh.dim).map_err(refused)?);
            beam.lengths.push(along.norm());
            let nodes = [nodes[0], nodes[1]].map(|node| number[node as usize]);
            beam.first.push(nodes.map(|node| unknowns.first(node)));
            beam.nodes.push(nodes);
        }
        for (element, cell) in beam.cells.iter().enumerate() {
            let released = released(&spec.releases, *cell, beam.dim);
            let t = match released.contains(&true) {
                false => None,
                true => {
                    let t = condensation::transformation(&beam.whole_stiffness(element), &released);
                    Some(t.ok_or_else(|| Error::Mechanism {
                        body: beam.name.clone(),
                        cell: *cell,
                    })?)
                }
            };
            beam.condensed.push(t);
            beam.released.push(released);
        }
        for element in 0..beam.nodes.len() {
            let local = beam.kept(element, beam.whole_stiffness(element));
            let own = beam.turned(element, &local);
            beam.stiffness.extend(own);
        }
        beam.flowing = match spec.material.uniaxial() {
            Some(law) => Some(beam.fibred(law)?),
            None => None,
        };
        beam.complete_bolts()?;
        Ok(beam)
    }

    /// K of an element in its own axes, with that of its foundation.
    fn whole_stiffness(&self, element: usize) -> Matrix {
        let mut k = self.element(element).stiffness();
        self.loosen(element, &mut k);
        let ground = self.element(element).foundation();
        for (k, ground) in k.iter_mut().flatten().zip(ground.iter().flatten()) {
            *k += ground;
        }
        k
    }

    /// A matrix of an element without its released rotations.
    fn kept(&self, element: usize, matrix: Matrix) -> Matrix {
        match &self.condensed[element] {
            Some(t) => condensation::condensed(&matrix, t),
            None => matrix,
        }
    }

    /// Whether an elastic foundation holds it.
    pub(crate) fn has_foundation(&self) -> bool {
        self.section.foundation != [0.0; 3]
    }

    /// Whether a fluid moves with it.
    pub(crate) fn has_fluid(&self) -> bool {
        self.section.added_mass != 0.0
    }

    /// Visits the displacements that the foundation opposes, and what cells without axial stiffness hold, as unknowns and coefficients.
    pub(crate) fn each_spring(&self, visit: &mut VisitRow) {
        self.each_row_of_loose(visit);
        if !self.has_foundation() {
            return;
        }
        let mut row = Vec::new();
        for element in 0..self.nodes.len() {
            let t = self.transformation(element);
            self.element(element).each_foundation_row(&mut |local, _| {
                row.clear();
                for (k, unknown) in self.unknowns(element).enumerate() {
                    let value: f64 = local.iter().zip(&t).map(|(n, t)| n * t[k]).sum();
                    row.push((unknown, value));
                }
                visit(&row);
            });
        }
    }

    /// Adds the forces of the foundation alone: with released rotations those of their ends count at the nodes.
    pub(crate) fn add_foundation_force(&self, at: &Placement, f: &mut [f64]) {
        if !self.has_foundation() {
            return;
        }
        for element in 0..self.nodes.len() {
            let mut local = self.local(element, at.u);
            if let Some(from) = at.from {
                let start = self.local(element, from);
                local = std::array::from_fn(|i| 0.5 * (local[i] + start[i]));
            }
            let ground = self.element(element).foundation();
            let forces = ground.map(|row| row.iter().zip(&local).map(|(k, u)| k * u).sum::<f64>());
            let t = self.transformation(element);
            for (k, unknown) in self.unknowns(element).enumerate() {
                f[unknown] += t.iter().zip(&forces).map(|(t, f)| t[k] * f).sum::<f64>();
            }
        }
    }

    /// Adds what has no weight, the mass of the fluid and the mass that it displaces, consistent, to a matrix over all unknowns. It is for uniform
    /// accelerations.
    pub fn add_fluid_mass(&self, matrix: &mut Csr) {
        for element in 0..self.nodes.len() {
            let local = self.kept(element, self.element(element).fluid_mass());
            let own = self.turned(element, &local);
            self.add(element, 1.0, &own, &(0..usize::MAX), matrix);
        }
    }

    /// Adds the diagonal of [`Beam::add_fluid_mass`] of a lumped mass.
    pub fn add_lumped_fluid(&self, mass: &mut [f64]) {
        let n = 2 * self.per_node();
        for element in 0..self.nodes.len() {
            let fluid = self.section.added_mass + self.section.displaced_mass;
            let half = 0.5 * fluid * self.lengths[element];
            let mut local = [[0.0; 12]; 12];
            for i in [1, 2, 7, 8] {
                local[i][i] = half;
            }
            let own = self.turned(element, &local);
            for (k, i) in self.unknowns(element).enumerate() {
                mass[i] += own[k * n + k];
            }
        }
    }

    /// Name as in the case file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its section.
    pub fn section(&self) -> &BeamSection {
        &self.section
    }

    /// Cells of the mesh.
    pub fn cells(&self) -> &[ElementId] {
        &self.cells
    }

    /// Speed of waves of extension, m/s.
    pub fn wave_speed(&self) -> f64 {
        self.material.wave_speed(Plane::Uniaxial)
    }

    /// Length of the shortest element, m.
    pub fn smallest_size(&self) -> f64 {
        self.lengths.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Unknowns of a node.
    pub(crate) fn per_node(&self) -> usize {
        if self.dim == 2 { 3 } else { 6 }
    }

    fn element(&self, number: usize) -> Element<'_> {
        Element {
            length: self.lengths[number],
            section: &self.section,
            material: &self.material,
            weights: self.weights[number],
        }
    }

    /// An element that shares its volume with no other body.
    fn whole_element(&self, number: usize) -> Element<'_> {
        Element {
            weights: EndWeights::ONE,
            ..self.element(number)
        }
    }

    /// The unknowns of an element in a system vector.
    fn unknowns(&self, element: usize) -> impl Iterator<Item = usize> + '_ {
        let per = self.per_node();
        self.first[element]
            .into_iter()
            .flat_map(move |first| first..first + per)
    }

    /// Tᵀ A T over the unknowns of an element, row-major, of a matrix in its own axes.
    fn turned(&self, element: usize, local: &Matrix) -> Vec<f64> {
        let t = self.transformation(element);
        let n = t[0].len();
        let mut product = vec![0.0; 12 * n];
        for (row, out) in local.iter().zip(product.chunks_exact_mut(n)) {
            for (value, t) in row.iter().zip(&t).filter(|(value, _)| **value != 0.0) {
                for (out, t) in out.iter_mut().zip(t) {
                    *out += value * t;
                }
            }
        }
        let mut own = vec![0.0; n * n];
        for (row, t) in product.chunks_exact(n).zip(&t) {
            for (out, t) in own.chunks_exact_mut(n).zip(t).filter(|(_, t)| **t != 0.0) {
                for (out, value) in out.iter_mut().zip(row) {
                    *out += t * value;
                }
            }
        }
        own
    }

    /// Unknowns in the axes of an element, at the centroid, by those of its nodes: twelve rows.
    fn transformation(&self, element: usize) -> Vec<Vec<f64>> {
        let (axes, per) = (&self.axes[element], self.per_node());
        let [y, z] = self.section.offset;
        let beside = axes.tr_mul(&Vec3::new(0.0, y, z));
        // directions of the unknowns of a node: translation, and rotation
        let mut columns: Vec<(Vec3, Vec3)> = Vec::new();
        for i in 0..self.dim {
            columns.push((unit(i), Vec3::zeros()));
        }
        for i in 3 - (per - self.dim)..3 {
            columns.push((unit(i).cross(&beside), unit(i)));
        }
        let mut rows = vec![vec![0.0; 2 * per]; 12];
        for node in 0..2 {
            for (k, (translation, rotation)) in columns.iter().enumerate() {
                let (translation, rotation) = (axes * translation, axes * rotation);
                for i in 0..3 {
                    rows[6 * node + i][per * node + k] = translation[i];
                    rows[6 * node + 3 + i][per * node + k] = rotation[i];
                }
            }
        }
        rows
    }

    /// System numbers of the nodes of each element.
    pub(crate) fn each_element(&self, visit: &mut dyn FnMut(&[u32])) {
        for nodes in &self.nodes {
            visit(nodes);
        }
    }

    /// Adds K u to `f` and returns the strain energy (J).
    pub(crate) fn internal_force(&self, u: &[f64], f: &mut [f64]) -> f64 {
        let mut energy = 0.0;
        self.each_force(&|i| u[i], &mut |i, force| {
            f[i] += force;
            energy += 0.5 * force * u[i];
        });
        energy
    }

    /// Visits the entries of K u of each element.
    fn each_force(&self, u: &dyn Fn(usize) -> f64, visit: &mut dyn FnMut(usize, f64)) {
        let n = 2 * self.per_node();
        let mut own = [0.0; 12];
        for (element, k) in self.stiffness.chunks_exact(n * n).enumerate() {
            for (own, i) in own.iter_mut().zip(self.unknowns(element)) {
                *own = u(i);
            }
            for (i, row) in self.unknowns(element).zip(k.chunks_exact(n)) {
                visit(i, row.iter().zip(&own).map(|(k, u)| k * u).sum());
            }
        }
    }

    /// Whether forces are linear in the displacement: nothing flows.
    pub(crate) fn is_linear(&self) -> bool {
        self.flowing.is_none()
    }

    /// Adds the internal forces; see [`Body::force`](crate::Body::force).
    pub(crate) fn force(
        &self,
        at: &Placement,
        new: &mut [f64],
        f: &mut [f64],
    ) -> Result<Stored, Error> {
        match &self.flowing {
            None => {
                new.copy_from_slice(at.old);
                Ok(self.linear_force(at, f))
            }
            Some(_) if at.from.is_some() => Err(self.no_between()),
            Some(flowing) => Ok(flowing.force(at, new, f)),
        }
    }

    fn linear_force(&self, at: &Placement, f: &mut [f64]) -> Stored {
        let strain = match at.from {
            None => self.internal_force(at.u, f),
            Some(from) => {
                let mean = |i: usize| 0.5 * (from[i] + at.u[i]);
                self.each_force(&mean, &mut |i, force| f[i] += force);
                let mut energy = 0.0;
                let u = |i: usize| at.u[i];
                self.each_force(&u, &mut |i, force| energy += 0.5 * force * at.u[i]);
                energy
            }
        };
        Stored {
            strain,
            ..Stored::default()
        }
    }

    /// Adds `by_u` ∂f/∂u to a matrix over all unknowns; see [`Body::add_tangent`](crate::Body::add_tangent).
    pub(crate) fn add_tangent(&self, at: &Placement, by_u: f64, matrix: &mut Csr) {
        if let Some(flowing) = &self.flowing {
            return flowing.add_tangent(at, by_u, matrix);
        }
        let share = if at.from.is_some() { 0.5 } else { 1.0 };
        self.add_stiffness(share * by_u, &(0..usize::MAX), matrix);
    }

    fn add_stiffness(&self, factor: f64, part: &Range<usize>, matrix: &mut Csr) {
        let n = 2 * self.per_node();
        for (element, k) in self.stiffness.chunks_exact(n * n).enumerate() {
            self.add(element, factor, k, part, matrix);
        }
    }

    fn add(&self, element: usize, factor: f64, own: &[f64], part: &Range<usize>, to: &mut Csr) {
        if !part.contains(&self.first[element][0]) {
            return;
        }
        for (i, row) in self
            .unknowns(element)
            .zip(own.chunks_exact(2 * self.per_node()))
        {
            for (j, value) in self.unknowns(element).zip(row) {
                to.add(i - part.start, j - part.start, factor * value);
            }
        }
    }

    /// Adds `stiffness` K + `mass` M (consistent); see [`Body::assemble`](crate::Body::assemble).
    pub(crate) fn assemble(
        &self,
        [stiffness, mass]: [f64; 2],
        part: &Range<usize>,
        matrix: &mut Csr,
    ) {
        if stiffness != 0.0 {
            self.add_stiffness(stiffness, part, matrix);
        }
        if mass != 0.0 {
            for element in 0..self.nodes.len() {
                let local = self.kept(element, self.element(element).mass());
                let own = self.turned(element, &local);
                self.add(element, mass, &own, part, matrix);
            }
        }
    }

    /// Adds the diagonal of the lumped mass.
    pub(crate) fn add_lumped_mass(&self, mass: &mut [f64]) {
        let n = 2 * self.per_node();
        for element in 0..self.nodes.len() {
            let own = self.lumped(element);
            for (k, i) in self.unknowns(element).enumerate() {
                mass[i] += own[k * n + k];
            }
        }
    }

    /// The lumped mass of an element over its unknowns, row-major.
    fn lumped(&self, element: usize) -> Vec<f64> {
        let mut local = [[0.0; 12]; 12];
        let released = &self.released[element];
        for (i, m) in self.element(element).lumped().into_iter().enumerate() {
            // the inertia of a rotation without a node is left out
            local[i][i] = if released[i] { 0.0 } else { m };
        }
        self.turned(element, &local)
    }

    /// Whether the lumped mass is diagonal in the axes of coordinates. In space it is not where an element stands at an angle to
    /// them, nor beside its nodes.
    pub(crate) fn lumps(&self) -> bool {
        let n = 2 * self.per_node();
        (0..self.nodes.len()).all(|element| {
            let own = self.lumped(element);
            let root = |k: usize| own[k * n + k].sqrt();
            let mut pairs = (0..n).flat_map(|i| (0..i).map(move |j| (i, j)));
            pairs.all(|(i, j)| own[i * n + j].abs() <= ROUNDING * root(i) * root(j))
        })
    }

    /// Upper bound of the angular frequencies (rad/s) with lumped mass: the largest of an element.
    pub(crate) fn frequency_bound(&self) -> f64 {
        let kept: &[usize] = match self.dim {
            2 => &[0, 1, 5, 6, 7, 11],
            _ => &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11],
        };
        let mut scaled = Vec::new();
        let of = |element: usize| {
            let k = self.kept(element, self.whole_stiffness(element));
            let (m, released) = (self.element(element).lumped(), &self.released[element]);
            scaled.clear();
            for &i in kept.iter().filter(|&&i| !released[i]) {
                let kept = kept.iter().filter(|&&j| !released[j]);
                scaled.extend(kept.map(|&j| k[i][j] / (m[i] * m[j]).sqrt()));
            }
            largest_eigenvalue(&mut scaled)
        };
        (0..self.nodes.len()).map(of).fold(0.0, f64::max).sqrt()
    }
}

/// Which of the unknowns of a cell are released; in the plane only the rotation about z is there to be.
fn released(releases: &[Release], cell: ElementId, dim: usize) -> [bool; 12] {
    let mut released = [false; 12];
    for release in releases.iter().filter(|release| release.cell == cell) {
        for axis in (0..3).filter(|&axis| dim == 3 || axis == 2) {
            released[6 * release.end + 3 + axis] |= release.rotations[axis];
        }
    }
    released
}

fn unit(axis: usize) -> Vec3 {
    Vec3::ith(axis, 1.0)
}

/// The axes of an element as rows, or why it has none.
fn axes(x: &Vec3, section: &BeamSection, dim: usize) -> Result<Mat3, &'static str> {
    let near = match (dim, section.orientation) {
        (2, _) => unit(2).cross(x),
        (_, Some(given)) => Vec3::from(given),
        // all are alike: the axis of coordinates that is farthest from x
        (_, None) if section.is_round() => unit(x.iamin()),
        (_, None) => {
            return Err(
                "needs an orientation, since its section is not round, or lies beside the nodes",
            );
        }
    };
    let y = near - x * x.dot(&near);
    if y.norm() <= PARALLEL * near.norm() {
        return Err("is parallel to its orientation, which must have a part normal to the axis");
    }
    let y = y.normalize();
    Ok(Mat3::from_rows(&[
        x.transpose(),
        y.transpose(),
        x.cross(&y).transpose(),
    ]))
}
