//! Weights of a body that shares its volume with another, as in the Arlequin method, where two models of one material
//! overlap and each carries its part.

use carom_algebra::lanes::Lanes;
use carom_algebra::number::Number;
use carom_elements::Kind;
use carom_mesh::{ElementId, Mesh};

use crate::Error;
use crate::continuum::{Point, Points};

/// Elements of the widest batch of the force kernels.
pub(crate) const WIDEST: usize = 16;

/// Weights α of inertia and δ of internal work: M = ∫ α ρ N_a N_b dV and U = ∫ δ W(ε) dV, where both weights are
/// w(ξ) = Σ_a w_a N_a(ξ) in a cell, free to jump to the next cell.
///
/// Each list holds the w_a cell after cell in the order of [`crate::BodySpec::cells`], as many as the kind of the cell
/// has nodes, without unit. Masses take the weight at the points of the kind's mass rule (bars: integrated exactly),
/// forces, energies and stiffness at those of its stiffness rule (bars: the mean of the two values; beams: exactly). Weights of two
/// bodies on the same cells that sum to 1 everywhere give the whole body. Values may be negative as long as the weights
/// at the points of the stiffness rule and the lumped masses are not. Lumped masses of the two bodies add up at each node
/// of linear cells; of quadratic ones, lumped by scaling the diagonal, in the total alone. Ben Dhia (1998).
#[derive(Clone, Debug, PartialEq)]
pub struct CellWeights {
    /// α: masses, hence weights of gravity.
    pub inertia: Vec<f64>,
    /// δ: internal forces, strain energy and stiffness.
    pub stiffness: Vec<f64>,
}

impl CellWeights {
    /// Refuses lists that are too short or too long for the cells.
    pub(crate) fn check(&self, body: &str, mesh: &Mesh, cells: &[ElementId]) -> Result<(), Error> {
        let nodes = |&cell: &ElementId| mesh.kind(cell).table().nodes;
        let expected = cells.iter().map(nodes).sum();
        for (quantity, list) in [("inertia", &self.inertia), ("stiffness", &self.stiffness)] {
            if list.len() != expected {
                return Err(Error::WeightCount {
                    body: body.to_owned(),
                    quantity,
                    found: list.len(),
                    expected,
                });
            }
        }
        Ok(())
    }

    /// Weights of 1 at so many nodes of cells.
    pub(crate) fn ones(count: usize) -> CellWeights {
        CellWeights {
            inertia: vec![1.0; count],
            stiffness: vec![1.0; count],
        }
    }

    /// Multiplies α of each cell, of so many nodes, by its factor.
    pub(crate) fn scale_inertia(&mut self, factors: &[f64], nodes: usize) {
        for (inertia, factor) in self.inertia.chunks_exact_mut(nodes).zip(factors) {
            inertia.iter_mut().for_each(|weight| *weight *= factor);
        }
    }

    /// The values of the cells of one kind.
    pub(crate) fn of_kind(&self, mesh: &Mesh, cells: &[ElementId], kind: Kind) -> CellWeights {
        let (mut inertia, mut stiffness) = (Vec::new(), Vec::new());
        let mut end = 0;
        for &cell in cells {
            let found = mesh.kind(cell);
            let begin = end;
            end += found.table().nodes;
            if found == kind {
                inertia.extend_from_slice(&self.inertia[begin..end]);
                stiffness.extend_from_slice(&self.stiffness[begin..end]);
            }
        }
        CellWeights { inertia, stiffness }
    }
}

/// Weights of the elements of a chunk, in the form that the kernels want.
#[derive(Debug)]
pub(crate) struct ChunkWeights {
    /// α at the nodes, element after element.
    inertia: Vec<f64>,
    /// δ at the points of the stiffness rule: of all elements at the first point, then at the second.
    stiffness: Vec<f64>,
    /// Values per point: the elements, and what fills the last batch, so that batches are read as they lie.
    stride: usize,
    /// Whether all δ are 1.
    pub(crate) is_inertia_alone: bool,
}

impl ChunkWeights {
    /// `inertia`, `stiffness`: values at the nodes, `nodes` for each element.
    pub(crate) fn new(
        inertia: &[f64],
        stiffness: &[f64],
        nodes: usize,
        points: &Points,
    ) -> ChunkWeights {
        let stride = (stiffness.len() / nodes).next_multiple_of(WIDEST);
        let mut at_points = vec![0.0; stride * points.points.len()];
        for (row, point) in at_points.chunks_exact_mut(stride).zip(&points.points) {
            for (weight, nodal) in row.iter_mut().zip(stiffness.chunks_exact(nodes)) {
                *weight = interpolate(point, nodal);
            }
        }
        ChunkWeights {
            inertia: inertia.to_vec(),
            is_inertia_alone: stiffness.iter().all(|weight| *weight == 1.0),
            stiffness: at_points,
            stride,
        }
    }

    /// Those of some elements by their α at the nodes, which lie at the nodes of element after element, with δ = 1.
    pub(crate) fn of_inertia(inertia: &[f64], nodes: usize, points: &Points) -> ChunkWeights {
        ChunkWeights::new(inertia, &vec![1.0; inertia.len()], nodes, points)
    }

    /// α at the nodes of an element.
    pub(crate) fn inertia_of(&self, nodes: usize, element: usize) -> &[f64] {
        &self.inertia[nodes * element..][..nodes]
    }

    /// An element whose weight of internal work is below zero or no number, and that weight.
    pub(crate) fn negative_stiffness(&self) -> Option<(usize, f64)> {
        let bad = |w: &f64| w.is_nan() || *w < 0.0;
        let place = self.stiffness.iter().position(bad)?;
        Some((place % self.stride, self.stiffness[place]))
    }

    /// Whether one of the weights of an element differs from point to point by more than rounding.
    pub(crate) fn varies(&self, nodes: usize, element: usize) -> bool {
        let inertia = self.inertia_of(nodes, element).iter();
        let stiffness = self.stiffness.chunks_exact(self.stride);
        uneven(inertia.copied()) || uneven(stiffness.map(|row| row[element]))
    }

    /// δ of an element at a point of the stiffness rule.
    pub(crate) fn stiffness_at(&self, element: usize, point: usize) -> f64 {
        self.stiffness[point * self.stride + element]
    }

    /// δ of elements from one of them on, at a point of the stiffness rule; those beyond the last have 0.
    #[inline(always)]
    pub(crate) fn batch<T: Number>(&self, first: usize, point: usize, out: &mut T) {
        let Some(row) = self.stiffness.chunks_exact(self.stride).nth(point) else {
            return;
        };
        let lanes = out.lanes_mut();
        lanes.copy_from_slice(&row[first..first + lanes.len()]);
    }

    /// The force kernels' view.
    #[inline(always)]
    pub(crate) fn at_points(&self) -> AtPoints<'_> {
        AtPoints {
            weights: self,
            first: 0,
        }
    }
}

/// Weights of one element: 1 unless it is weighted.
#[derive(Debug)]
pub(crate) struct ElementWeights<const N: usize> {
    /// α at the nodes.
    pub(crate) nodes: [f64; N],
    /// α at the points of the mass rule.
    pub(crate) inertia: Vec<f64>,
    /// δ at the points of the stiffness rule.
    pub(crate) stiffness: Vec<f64>,
}

impl<const N: usize> ElementWeights<N> {
    pub(crate) fn ones(mass: &Points, stiffness: &Points) -> Self {
        ElementWeights {
            nodes: [1.0; N],
            inertia: vec![1.0; mass.points.len()],
            stiffness: vec![1.0; stiffness.points.len()],
        }
    }

    /// Takes those of an element of a chunk.
    pub(crate) fn set(&mut self, mass: &Points, chunk: &ChunkWeights, element: usize) {
        self.nodes
            .copy_from_slice(&chunk.inertia[N * element..][..N]);
        for (weight, point) in self.inertia.iter_mut().zip(&mass.points) {
            *weight = interpolate(point, &self.nodes);
        }
        for (q, weight) in self.stiffness.iter_mut().enumerate() {
            *weight = chunk.stiffness[q * chunk.stride + element];
        }
    }
}

fn uneven(values: impl Iterator<Item = f64> + Clone) -> bool {
    let least = values.clone().fold(f64::INFINITY, f64::min);
    let most = values.fold(f64::NEG_INFINITY, f64::max);
    most - least > 1e-12 * most.abs()
}

fn interpolate(point: &Point, nodal: &[f64]) -> f64 {
    nodal.iter().zip(&point.n).map(|(w, n)| w * n).sum()
}

/// What multiplies the internal work of a batch of elements.
pub(crate) trait Weight: Copy {
    /// That of the batch that begins with this element of the chunk.
    fn batch(self, first: usize) -> Self;

    /// `value` times the weight at point `q`.
    fn times<const W: usize>(self, q: usize, value: Lanes<W>) -> Lanes<W>;
}

/// No weight, and no multiplication by 1 either.
#[derive(Clone, Copy)]
pub(crate) struct Unweighted;

impl Weight for Unweighted {
    #[inline(always)]
    fn batch(self, _: usize) -> Self {
        self
    }

    #[inline(always)]
    fn times<const W: usize>(self, _: usize, value: Lanes<W>) -> Lanes<W> {
        value
    }
}

/// The weights of a chunk from one of its elements on.
#[derive(Clone, Copy)]
pub(crate) struct AtPoints<'a> {
    weights: &'a ChunkWeights,
    first: usize,
}

impl Weight for AtPoints<'_> {
    #[inline(always)]
    fn batch(self, first: usize) -> Self {
        AtPoints { first, ..self }
    }

    #[inline(always)]
    fn times<const W: usize>(self, q: usize, value: Lanes<W>) -> Lanes<W> {
        let first = q * self.weights.stride + self.first;
        let weights = &self.weights.stiffness[first..first + W];
        let mut out = value;
        for k in 0..W {
            out.0[k] *= weights[k];
        }
        out
    }
}
