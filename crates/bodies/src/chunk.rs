//! Neighbouring elements with the places of their nodes.

use carom_algebra::number::Number;

use crate::weights::ChunkWeights;

/// A fixed number of neighbouring elements with their own node list.
#[derive(Debug)]
pub(crate) struct Chunk {
    /// System numbers of the nodes.
    pub(crate) nodes: Vec<u32>,
    /// First unknowns of the nodes.
    pub(crate) first: Vec<u32>,
    /// Coordinates of the nodes in m.
    pub(crate) x: Vec<[f64; 3]>,
    /// Nodes of each element, as places in `nodes`.
    pub(crate) connectivity: Vec<u32>,
    pub(crate) weights: Option<ChunkWeights>,
    /// Of each element the coefficients of its bulk viscosity; empty without.
    pub(crate) viscosity: Vec<[f64; 2]>,
}

impl Chunk {
    /// Number of elements, of so many nodes each.
    pub(crate) fn len(&self, nodes: usize) -> usize {
        self.connectivity.len() / nodes
    }

    /// Weights, where any δ is not 1.
    #[inline(always)]
    pub(crate) fn weights_of_work(&self) -> Option<&ChunkWeights> {
        let weights = self.weights.as_ref();
        weights.filter(|weights| !weights.is_inertia_alone)
    }

    /// δ of an element at a point of the stiffness rule.
    pub(crate) fn weight(&self, element: usize, point: usize) -> f64 {
        match self.weights_of_work() {
            Some(weights) => weights.stiffness_at(element, point),
            None => 1.0,
        }
    }

    /// Writes places and displacements of the nodes of as many elements as a number has lanes; a short batch repeats its last
    /// element, whose results are dropped.
    #[inline(always)]
    pub(crate) fn lanes<T: Number, const N: usize, const D: usize>(
        &self,
        batch: &[u32],
        u: &[f64],
        [x, moved]: [&mut [[T; D]; N]; 2],
    ) {
        let count = batch.len() / N;
        for k in 0..x[0][0].lanes().len() {
            let element = &batch[N * k.min(count - 1)..][..N];
            for a in 0..N {
                let place = element[a] as usize;
                let x_a = &self.x[place];
                let u_a = &u[self.first[place] as usize..][..D];
                for i in 0..D {
                    x[a][i].lanes_mut()[k] = x_a[i];
                    moved[a][i].lanes_mut()[k] = u_a[i];
                }
            }
        }
    }

    /// Writes another displacement of the same nodes.
    #[inline(always)]
    pub(crate) fn displacements<T: Number, const N: usize, const D: usize>(
        &self,
        batch: &[u32],
        u: &[f64],
        moved: &mut [[T; D]; N],
    ) {
        let count = batch.len() / N;
        for k in 0..moved[0][0].lanes().len() {
            let element = &batch[N * k.min(count - 1)..][..N];
            for a in 0..N {
                let u_a = &u[self.first[element[a] as usize] as usize..][..D];
                for i in 0..D {
                    moved[a][i].lanes_mut()[k] = u_a[i];
                }
            }
        }
    }

    /// δ of the elements from one of them on, at a point of the stiffness rule; without weights nothing changes.
    #[inline(always)]
    pub(crate) fn weigh<T: Number>(&self, first: usize, point: usize, out: &mut T) {
        if let Some(weights) = self.weights_of_work() {
            weights.batch(first, point, out);
        }
    }

    pub(crate) fn gather<const N: usize>(
        &self,
        element: &[u32],
        dim: usize,
        u: &[f64],
    ) -> ([[f64; 3]; N], [[f64; 3]; N]) {
        let x = element_nodes::<N, _>(element, |node| self.x[node]);
        let u = element_nodes::<N, _>(element, |node| {
            let first = self.first[node] as usize;
            let mut u_a = [0.0; 3];
            u_a[..dim].copy_from_slice(&u[first..first + dim]);
            u_a
        });
        (x, u)
    }
}

#[inline]
pub(crate) fn element_nodes<const N: usize, T>(element: &[u32], of: impl Fn(usize) -> T) -> [T; N] {
    std::array::from_fn(|a| of(element[a] as usize))
}
