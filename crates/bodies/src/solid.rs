//! Solids and bars: elements of a mesh with one kinematics and one material.

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::tensor::Mat3;
use carom_algebra::unknowns::Unknowns;
use carom_elements::Kind;
use carom_materials::{Law, Plane};
use carom_mesh::{ElementId, Mesh};

use crate::Error;
use crate::bar::Bar;
use crate::block::{Block, Physics, Visit, by_kind};
use crate::continuum;
use crate::finite::{BulkViscosity, Finite, Formulation, Shape};
use crate::flowing::{Fibre, FibreSection, Flowing, Point};
use crate::gather::Gather;
use crate::layers::Layers;
use crate::nodes::Nodes;
use crate::scratch::Scratch;
use crate::spec::BodySpec;
use crate::weights::CellWeights;
use crate::{Kinematics, size};

/// A discretised solid or bar, at small strain or total Lagrangian.
#[derive(Debug)]
pub struct Solid {
    pub(crate) name: String,
    pub(crate) kinematics: Kinematics,
    pub(crate) material: Law,
    pub(crate) cells: Vec<ElementId>,
    pub(crate) blocks: Vec<Block>,
    /// Law and formulation at finite strain; none at small strain.
    pub(crate) finite: Option<Finite>,
    /// Bars of metal that flows.
    pub(crate) flowing: Option<Flowing>,
    pub(crate) dim: usize,
    pub(crate) smallest: f64,
    /// Nodes of the kind that has most of them, of the whole body.
    pub(crate) most_nodes: usize,
    pub(crate) viscosity: Option<BulkViscosity>,
    /// Mass beyond that of the material, kg.
    pub(crate) added_mass: f64,
    /// How the forces of chunks are added.
    pub(crate) gather: Gather,
    /// Layers that a static stage tightens.
    pub(crate) layers: Layers,
}

impl Solid {
    /// Builds a body on a mesh. `number`: system number of each mesh node; `unknowns`: of the nodes of the system.
    ///
    /// # Errors
    /// No element, elements of a wrong dimension, a negative radius in axisymmetry, weights that are too few or too many
    /// or give a negative mass or stiffness.
    pub fn new(
        mesh: &Mesh,
        spec: BodySpec,
        number: &[u32],
        unknowns: &Unknowns,
    ) -> Result<Solid, Error> {
        if spec.cells.is_empty() {
            return Err(Error::Empty { body: spec.name });
        }
        check(mesh, &spec)?;
        let mut x = vec![[0.0; 3]; mesh.nodes.len()];
        for (node, &system) in number.iter().enumerate() {
            if system != u32::MAX {
                x[system as usize] = mesh.nodes[node];
            }
        }
        let elastic = spec.material.initial();
        let physics = match spec.kinematics {
            Kinematics::Bar { area } => Physics::Bar(Bar {
                young: elastic.young,
                area,
                density: elastic.density,
            }),
            kinematics => Physics::Continuum(continuum::Law::new(kinematics, elastic, mesh.dim)),
        };
        let shape = Shape {
            kinematics: spec.kinematics,
            formulation: spec.formulation,
            shear_modulus: elastic.shear_modulus(),
        };
        let is_viscous = spec.viscosity.is_some();
        let finite = |law: Law| Finite::new(law, shape, is_viscous, spec.deletion);
        let parts = Parts {
            mesh,
            spec: &spec,
            physics,
            number,
            x: &x,
            unknowns,
        };
        let (cells, blocks) = parts.blocks(None);
        let sizes = cells.iter().map(|&cell| size::smallest(mesh, cell));
        let mut body = Solid {
            name: spec.name.clone(),
            kinematics: spec.kinematics,
            material: spec.material,
            smallest: sizes.fold(f64::INFINITY, f64::min),
            most_nodes: most_nodes(&blocks),
            viscosity: spec.viscosity,
            added_mass: 0.0,
            gather: Gather::new(mesh.dim, &blocks),
            cells,
            blocks,
            finite: is_finite(&spec).then(|| finite(spec.material)),
            flowing: None,
            dim: mesh.dim,
            layers: Layers::default(),
        };
        body.set_viscosity(mesh, None);
        if let Some(scaling) = &spec.scaling {
            let (factors, before) = (body.mass_factors(scaling), body.mass());
            (body.cells, body.blocks) = parts.blocks(Some(&factors));
            body.set_viscosity(mesh, Some(&factors));
            body.added_mass = body.mass() - before;
        }
        if let Kinematics::Bar { area } = spec.kinematics
            && let Some(law) = spec.material.uniaxial()
        {
            let fibre = Fibre {
                place: [0.0; 2],
                area,
            };
            body.flowing = Some(parts.bars(FibreSection::new(law, vec![fibre])));
        }
        if spec.weights.is_some() {
            body.check_mass(mesh)?;
            body.check_stiffness()?;
        }
        if body.is_linear() {
            body.layers = body.layers_of(&spec.layers, (&x, unknowns));
        }
        Ok(body)
    }

    /// Mass, kg, that of mass scaling included.
    fn mass(&self) -> f64 {
        let mut mass = 0.0;
        self.each_matrix(false, &mut |element| {
            mass += element.lumped.iter().sum::<f64>()
        });
        mass
    }

    /// Mass that mass scaling has added, kg.
    pub fn added_mass(&self) -> f64 {
        self.added_mass
    }

    fn check_mass(&self, mesh: &Mesh) -> Result<(), Error> {
        let (mut place, mut negative) = (0, None);
        self.each_matrix(false, &mut |element| {
            for (a, &mass) in element.lumped.iter().enumerate() {
                if mass.is_nan() || mass < 0.0 {
                    negative.get_or_insert((place, a, mass));
                }
            }
            place += 1;
        });
        let Some((place, a, mass)) = negative else {
            return Ok(());
        };
        Err(Error::NegativeMass {
            body: self.name.clone(),
            cell: self.cells[place],
            node: mesh.element_nodes(self.cells[place])[a],
            mass,
        })
    }

    fn check_stiffness(&self) -> Result<(), Error> {
        let mut first = 0;
        for block in &self.blocks {
            if let Some((place, weight)) = block.negative_stiffness() {
                return Err(Error::NegativeStiffness {
                    body: self.name.clone(),
                    cell: self.cells[first + place],
                    weight,
                });
            }
            first += block.len();
        }
        Ok(())
    }

    /// Name as in the case file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Kinematics and section.
    pub fn kinematics(&self) -> Kinematics {
        self.kinematics
    }

    /// Material.
    pub fn material(&self) -> &Law {
        &self.material
    }

    /// Cells of the mesh, in the order of [`Solid::stresses`].
    pub fn cells(&self) -> &[ElementId] {
        &self.cells
    }

    /// Elements by kind, in the order of [`Solid::cells`].
    pub(crate) fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// Unknowns of a node.
    pub(crate) fn dim(&self) -> usize {
        self.dim
    }

    /// Speed of compression waves in m/s.
    pub fn wave_speed(&self) -> f64 {
        self.material.wave_speed(self.kinematics.plane())
    }

    /// Smallest size of an element over its faces, in m: the h_e of the Courant number c dt / h_e.
    pub fn smallest_size(&self) -> f64 {
        self.smallest
    }

    /// Adds the internal forces f(u) (N) of this body at small strain to `f` and returns its strain energy U(u) (J);
    /// [`Solid::force`] serves all bodies.
    ///
    /// `u`, `f`: system vectors, m and N. `scratch`: this body's own, empty before the first call; later calls allocate
    /// nothing. The sums run in a fixed order whatever the number of threads.
    pub fn internal_force(&self, u: &[f64], scratch: &mut Scratch, f: &mut [f64]) -> f64 {
        debug_assert!(self.is_linear());
        scratch.prepare(&self.blocks);
        let (mut forces, mut energies) = (&mut scratch.forces[..], &mut scratch.energies[..]);
        for block in &self.blocks {
            let (block_forces, rest) = forces.split_at_mut(block.chunks.len());
            forces = rest;
            let (block_energies, rest) = energies.split_at_mut(block.chunks.len());
            energies = rest;
            block.forces(self.dim, u, block_forces, block_energies);
        }
        self.gather.add(&scratch.forces, f);
        let energy = scratch.energies.iter().sum::<f64>();
        energy - self.layers.loosen(u, f)
    }

    /// Adds the lumped mass (kg) to the entries of a system vector: the row sums ∫ ρ N_a dV of linear elements, and of
    /// quadratic ones, where these are zero or negative at corners, the diagonal of the consistent mass scaled to the
    /// mass of the element. Hinton, Rock and Zienkiewicz (1976).
    pub fn add_lumped_mass(&self, mass: &mut [f64]) {
        let dim = self.dim;
        self.each_matrix(false, &mut |element| {
            for (&first, lumped) in element.first.iter().zip(element.lumped) {
                for i in 0..dim {
                    mass[first as usize + i] += lumped;
                }
            }
        });
    }

    /// Adds `stiffness_factor` K + `mass_factor` M (consistent) to the rows of one connected part.
    ///
    /// At finite strain K is that of the undeformed body, fully integrated. `part`: system numbers of the unknowns that `matrix` holds; elements outside are left out.
    pub fn assemble(
        &self,
        stiffness_factor: f64,
        mass_factor: f64,
        part: &Range<usize>,
        matrix: &mut Csr,
    ) {
        let dim = self.dim;
        let (mut rows, mut block) = (Vec::new(), Vec::new());
        self.each_matrix(true, &mut |element| {
            let (first, k, m) = (element.first, element.stiffness, element.mass);
            let n = first.len();
            if !part.contains(&(first[0] as usize)) {
                return;
            }
            rows.clear();
            rows.extend(first.iter().map(|&row| row - part.start as u32));
            block.clear();
            block.extend(k.iter().map(|k| stiffness_factor * k));
            for (a, masses) in m.chunks_exact(n).enumerate() {
                for (b, mass) in masses.iter().enumerate() {
                    for i in 0..dim {
                        block[(dim * a + i) * dim * n + dim * b + i] += mass_factor * mass;
                    }
                }
            }
            matrix.add_nodes(&rows, dim, (1.0, &block));
        });
        self.layers.loosen_matrix(stiffness_factor, part, matrix);
    }

    /// System numbers of the nodes of each element, in the order of [`Solid::cells`].
    pub fn each_element(&self, visit: &mut dyn FnMut(&[u32])) {
        for block in &self.blocks {
            block.elements(visit);
        }
    }

    /// Calls `visit` with the nodes of each element that is not deleted in this history of the body.
    pub fn each_element_left(&self, history: &[f64], visit: &mut dyn FnMut(&[u32])) {
        let Some(deleted) = self.deleted(history) else {
            return self.each_element(visit);
        };
        let mut deleted = deleted.into_iter();
        self.each_element(&mut |nodes| {
            if deleted.next() != Some(true) {
                visit(nodes);
            }
        });
    }

    /// Volume (m³) and mean stress (Pa) of each element, in the order of [`Solid::cells`].
    ///
    /// At finite strain the current volume and the Cauchy stress of `history`, that of this body at `u`; not numbers in an
    /// element whose law gives none.
    pub fn stresses(&self, u: &[f64], history: &[f64]) -> Vec<(f64, Mat3)> {
        self.stresses_of(0..self.cells.len(), (u, history))
    }

    /// The same of some elements.
    pub(crate) fn stresses_of(
        &self,
        of: Range<usize>,
        (u, history): (&[f64], &[f64]),
    ) -> Vec<(f64, Mat3)> {
        if let Some(finite) = &self.finite {
            return finite.stresses((&self.blocks, of), u, history);
        }
        if let Some(flowing) = &self.flowing {
            return self.stresses_of_bars(flowing, (u, history))[of].to_vec();
        }
        let (mut out, mut first) = (Vec::with_capacity(of.len()), 0);
        for block in &self.blocks {
            block.stresses((self.dim, block.within(&of, first)), u, &mut out);
            first += block.len();
        }
        if !self.layers.bolts().is_empty() {
            for (place, (_, stress)) in of.zip(&mut out) {
                *stress += self.layers.kept_stress(place, history);
            }
        }
        out
    }

    /// The same of bars that flow.
    fn stresses_of_bars(&self, flowing: &Flowing, at: (&[f64], &[f64])) -> Vec<(f64, Mat3)> {
        let mut out = Vec::with_capacity(self.cells.len());
        for block in &self.blocks {
            block.bars(&mut |axis, volume| {
                let stress = flowing.mean_stress(out.len(), at);
                out.push((volume, Mat3::from_fn(|i, j| stress * axis[i] * axis[j])));
            });
        }
        out
    }

    /// Mean equivalent plastic strain of each element in the `history` of this body, in the order of [`Solid::cells`]; none of
    /// a law without plasticity.
    pub fn plastic_strains(&self, history: &[f64]) -> Option<Vec<f64>> {
        if let Some(flowing) = &self.flowing {
            return Some(flowing.plastic_strains(history));
        }
        let finite = self.finite.as_ref()?;
        finite.plastic_strains(&self.blocks, history)
    }

    pub(crate) fn each_matrix(&self, stiffness: bool, visit: &mut Visit) {
        for block in &self.blocks {
            block.matrices(self.dim, stiffness, visit);
        }
    }
}

/// Nodes of the kind that has most of them.
fn most_nodes(blocks: &[Block]) -> usize {
    let nodes = blocks.iter().map(|block| block.kind.table().nodes);
    nodes.max().unwrap_or(1)
}

fn check(mesh: &Mesh, spec: &BodySpec) -> Result<(), Error> {
    if let Some(weights) = &spec.weights {
        weights.check(&spec.name, mesh, &spec.cells)?;
    }
    check_formulation(mesh, spec)?;
    if let Kinematics::Beam(_) = spec.kinematics {
        return Err(Error::NotSolid {
            body: spec.name.clone(),
            kinematics: spec.kinematics.name(),
        });
    }
    let dim = spec.kinematics.dim();
    for &cell in &spec.cells {
        let element = mesh.kind(cell).table();
        if element.dim != dim || (dim > 1 && mesh.dim != dim) {
            return Err(Error::WrongElement {
                body: spec.name.clone(),
                found: element.name,
                kinematics: spec.kinematics.name(),
                dim,
            });
        }
        if element.kind == Kind::Bar3 {
            return Err(Error::QuadraticBar {
                body: spec.name.clone(),
            });
        }
        if spec.kinematics == Kinematics::Axisymmetric {
            for &node in mesh.element_nodes(cell) {
                let radius = mesh.nodes[node as usize][0];
                if radius < 0.0 {
                    return Err(Error::NegativeRadius {
                        body: spec.name.clone(),
                        node,
                        radius,
                    });
                }
            }
        }
    }
    Ok(())
}

/// Whether the law of a body is one at finite strain; bars of metal that flows take that under uniaxial stress.
fn is_finite(spec: &BodySpec) -> bool {
    let flows =
        matches!(spec.kinematics, Kinematics::Bar { .. }) && spec.material.uniaxial().is_some();
    spec.material.finite().is_some() && !flows
}

fn check_formulation(mesh: &Mesh, spec: &BodySpec) -> Result<(), Error> {
    let body = || spec.name.clone();
    if !is_finite(spec) {
        return match spec.formulation {
            Formulation::Full => Ok(()),
            _ => Err(Error::LinearFormulation { body: body() }),
        };
    }
    if spec.kinematics.plane() != Plane::Full {
        return Err(Error::FiniteKinematics {
            body: body(),
            kinematics: spec.kinematics.name(),
        });
    }
    if let Formulation::Reduced { .. } = spec.formulation {
        for &cell in &spec.cells {
            let kind = mesh.kind(cell);
            let single = kind.table().stiffness_rule.points.len() == 1;
            if !single && kind != Kind::Quad4 && kind != Kind::Hex8 {
                return Err(Error::NotReduced {
                    body: body(),
                    found: kind.table().name,
                });
            }
        }
    }
    Ok(())
}

/// What the blocks of a body are built of.
struct Parts<'a> {
    mesh: &'a Mesh,
    spec: &'a BodySpec,
    physics: Physics,
    number: &'a [u32],
    x: &'a [[f64; 3]],
    unknowns: &'a Unknowns,
}

impl Parts<'_> {
    /// Bars of this section, all of which flow: one point each, with the mean of the weights of its nodes.
    fn bars(&self, section: FibreSection) -> Flowing {
        let (mesh, spec) = (self.mesh, self.spec);
        let mut flowing = Flowing::new(section, 2 * mesh.dim, 1);
        for (place, &cell) in spec.cells.iter().enumerate() {
            let nodes = mesh.element_nodes(cell);
            let x = [nodes[0], nodes[1]].map(|node| mesh.nodes[node as usize]);
            let (axis, length) = Bar::axis(&x);
            let weight = spec.weights.as_ref().map_or(1.0, |weights| {
                0.5 * (weights.stiffness[2 * place] + weights.stiffness[2 * place + 1])
            });
            let mut rows = [[0.0; 12]; 3];
            for i in 0..mesh.dim {
                rows[0][i] = -axis[i] / length;
                rows[0][mesh.dim + i] = axis[i] / length;
            }
            let own = nodes.iter().map(|&node| self.number[node as usize]);
            let unknowns = own.flat_map(|node| {
                let first = self.unknowns.first(node);
                first..first + mesh.dim
            });
            let point = Point {
                length: weight * length,
                rows,
            };
            flowing.push(unknowns, std::iter::once(point), &[]);
        }
        flowing
    }

    /// The cells by kind, and their blocks. `factors`: of their masses.
    fn blocks(&self, factors: Option<&[f64]>) -> (Vec<ElementId>, Vec<Block>) {
        let (mesh, spec) = (self.mesh, self.spec);
        let (cells, mut blocks) = (by_kind(mesh, &spec.cells), Vec::new());
        let mut before = 0;
        for of_kind in cells.chunk_by(|one, other| mesh.kind(*one) == mesh.kind(*other)) {
            let kind = mesh.kind(of_kind[0]);
            let nodes = of_kind.iter().flat_map(|&cell| mesh.element_nodes(cell));
            let elements: Vec<u32> = nodes.map(|&node| self.number[node as usize]).collect();
            let of_all = |all: &CellWeights| all.of_kind(mesh, &spec.cells, kind);
            let mut weights = spec.weights.as_ref().map(of_all);
            if let Some(factors) = factors {
                let own = &factors[before..][..of_kind.len()];
                let count = elements.len();
                let weights = weights.get_or_insert_with(|| CellWeights::ones(count));
                weights.scale_inertia(own, kind.table().nodes);
            }
            let nodes = Nodes {
                elements: &elements,
                x: self.x,
                unknowns: self.unknowns,
            };
            let rule = match spec.exact_products && spec.material.finite().is_none() {
                true => kind.table().weighted_stiffness_rule(),
                false => kind.table().stiffness_rule,
            };
            let weights = weights.as_ref();
            blocks.push(Block::new((kind, rule), self.physics, &nodes, weights));
            before += of_kind.len();
        }
        (cells, blocks)
    }
}
