//! Layers of solids that a static stage tightens: sections of bolts that are meshed.
//!
//! A layer lies between two planes across the axis n of the bolt. Its elongation is a uniform strain ε = δ/L n ⊗ n of its stress-free state, of one δ for all
//! of it: sections stay plane, and carry moments and shear as always. With the displacement w = (n·x) n, the matrix K of the cells of the layer, `q = K w/L`
//! and `κ = w·K w/L²` the force across it is `N = q·u - κ δ`: the mean of ∫ σ_nn dV/L is the resultant of each section between the planes, since no force acts on the
//! sides. Of a prescribed N the internal force is `(K - q qᵀ/κ) u + N q/κ`: the bolt has the elongation `e = q·u/κ` and the stiffness κ, which the cells have
//! in the dynamics.

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::tensor::Mat3;
use carom_mesh::ElementId;

use crate::Bolt;
use crate::discrete::VisitRow;

/// A layer of cells of a solid that is tightened.
#[derive(Clone, Debug, PartialEq)]
pub struct TightenedLayer {
    /// Name of the bolt.
    pub name: String,
    /// Its cells: all that the body has between two planes.
    pub cells: Vec<ElementId>,
    /// Unit vector n across both planes.
    pub axis: [f64; 3],
    /// Force at the end of the static stage, N, positive in tension.
    pub force: f64,
    /// Whether the body is that of the static stage: the layer has no stiffness against its mean elongation.
    pub tightens: bool,
}

/// Layers of a body.
#[derive(Debug, Default)]
pub(crate) struct Layers {
    all: Vec<Layer>,
    bolts: Vec<Bolt>,
}

/// What a layer is in its body.
#[derive(Debug)]
pub(crate) struct Layer {
    pub(crate) tightens: bool,
    /// Places of its cells in the body, ascending.
    pub(crate) places: Vec<usize>,
    /// System numbers of its nodes: those below and those above the middle.
    pub(crate) sides: [Vec<u32>; 2],
    /// All of them.
    pub(crate) nodes: Vec<u32>,
    /// What it holds beside its elongation, as rows of unknowns.
    pub(crate) rows: Vec<Vec<(usize, f64)>>,
    /// Stress over the force that the bolt keeps, 1/m².
    pub(crate) kept: Mat3,
}

impl Layers {
    /// Adds a layer and its bolt.
    pub(crate) fn push(&mut self, (layer, bolt): (Layer, Bolt)) {
        self.all.push(layer);
        self.bolts.push(bolt);
    }

    /// Bolts, in the order of the layers.
    pub(crate) fn bolts(&self) -> &[Bolt] {
        &self.bolts
    }

    /// Takes the stiffness against the elongation of layers that are tightened from forces; returns the energy that they lack, J.
    pub(crate) fn loosen(&self, u: &[f64], f: &mut [f64]) -> f64 {
        let mut energy = 0.0;
        for (_, bolt) in self.tightened() {
            let elongation = bolt.elongation(u);
            bolt.add_load(bolt.stiffness * elongation, f);
            energy += 0.5 * bolt.stiffness * elongation * elongation;
        }
        energy
    }

    /// The same of a matrix over the unknowns of a part, with a factor.
    pub(crate) fn loosen_matrix(&self, factor: f64, part: &Range<usize>, matrix: &mut Csr) {
        let first = part.start;
        let inside = |bolt: &Bolt| bolt.row.iter().any(|(i, _)| part.contains(i));
        for (_, bolt) in self.tightened().filter(|(_, bolt)| inside(bolt)) {
            for &(i, c) in &bolt.row {
                for &(j, d) in &bolt.row {
                    matrix.add(i - first, j - first, -factor * bolt.stiffness * c * d);
                }
            }
        }
    }

    fn tightened(&self) -> impl Iterator<Item = (&Layer, &Bolt)> {
        let all = self.all.iter().zip(&self.bolts);
        all.filter(|(layer, _)| layer.tightens)
    }

    /// The nodes of each layer whose unknowns the tightening couples.
    pub(crate) fn each_clique(&self, visit: &mut dyn FnMut(&[u32])) {
        self.tightened().for_each(|(layer, _)| visit(&layer.nodes));
    }

    /// What layers that are tightened hold.
    pub(crate) fn each_row(&self, visit: &mut VisitRow) {
        let rows = self.tightened().flat_map(|(layer, _)| &layer.rows);
        rows.for_each(|row| visit(row));
    }

    /// The nodes of either side of each layer that is tightened.
    pub(crate) fn each_side(&self, visit: &mut dyn FnMut(&[u32])) {
        let sides = self.tightened().flat_map(|(layer, _)| &layer.sides);
        sides.for_each(|nodes| visit(nodes));
    }

    /// Whether the cell at a place is one of a layer that is tightened.
    pub(crate) fn loosens(&self, place: usize) -> bool {
        let mut layers = self.tightened();
        layers.any(|(layer, _)| layer.places.binary_search(&place).is_ok())
    }

    /// Stress (Pa) of the cell at a place by the force that its bolt keeps. `history`: of the body.
    pub(crate) fn kept_stress(&self, place: usize, history: &[f64]) -> Mat3 {
        let mut stress = Mat3::zeros();
        for (layer, kept) in self.all.iter().zip(history) {
            if layer.places.binary_search(&place).is_ok() {
                stress += layer.kept * *kept;
            }
        }
        stress
    }
}
