//! Bounds of the frequencies of a solid, what bulk viscosity does to them, and the mass that a wanted step asks for.

use std::collections::BTreeSet;

use carom_materials::Plane;
use carom_mesh::Mesh;

use rayon::prelude::*;

use crate::block::Block;
use crate::chunk::Chunk;
use crate::scaling::MassScaling;
use crate::solid::Solid;
use crate::together::Together;
use crate::{size, stability};

impl Solid {
    /// Sets the coefficients of the bulk viscosity of all elements, whose masses are `factors` times those of the material.
    pub(crate) fn set_viscosity(&mut self, mesh: &Mesh, factors: Option<&[f64]>) {
        let (Some(viscosity), Some(_)) = (&self.viscosity, &self.finite) else {
            return;
        };
        let (material, mut element) = (self.material().initial(), 0);
        let cells = self.cells().to_vec();
        for block in &mut self.blocks {
            let nodes = block.kind.table().nodes;
            for chunk in &mut block.chunks {
                let all = element..element + chunk.len(nodes);
                element = all.end;
                let of_element = |element: usize| {
                    let size = size::smallest(mesh, cells[element]);
                    let scaled = factors.map_or(1.0, |factors| factors[element]);
                    viscosity.coefficients(&material, size, scaled)
                };
                chunk.viscosity = all.map(of_element).collect();
            }
        }
    }

    /// The mass of each element over that of its material.
    pub(crate) fn mass_factors(&self, scaling: &MassScaling) -> Vec<f64> {
        let dim = self.dim();
        let factors = self.by_chunk(|block, chunk, first| {
            let (mut factors, mut scaled) = (Vec::new(), Vec::new());
            block.matrices_of(chunk, dim, true, &mut |element| {
                stability::scale(dim, element.stiffness, element.lumped, &mut scaled);
                let square = stability::largest_eigenvalue(&mut scaled);
                let frequency = self.damped_frequency(first + factors.len(), square);
                factors.push(scaling.factor(frequency));
            });
            factors
        });
        factors.concat()
    }

    /// What `of` gives for each chunk, in their order; it gets the place of its first element in [`Solid::cells`].
    fn by_chunk<T: Send>(&self, of: impl Fn(&Block, &Chunk, usize) -> T + Sync) -> Vec<T> {
        let (mut out, mut first) = (Vec::new(), 0);
        for block in &self.blocks {
            let length = block.chunk_length();
            let chunks = block.chunks.par_iter().enumerate();
            out.par_extend(chunks.map(|(k, chunk)| of(block, chunk, first + k * length)));
            first += block.len();
        }
        out
    }

    /// Upper bound of the angular frequencies (rad/s) with lumped mass: the largest eigenvalue of M_e⁻¹ K_e over parts of
    /// the body that add up to it bounds that of the body (Irons). An explicit step is stable below 2/ω.
    ///
    /// The parts are the elements, and if that is less, one part of all elements in which weights vary and of four layers
    /// around them, with a bound of its own (Collatz, Wielandt: B = M⁻¹ |K| has no negative entry, so that its spectral
    /// radius, not below λ, is at most max_i (B x)_i / x_i for any x > 0). With linear weights on straight bars the step
    /// keeps 0.983, where the elements alone give 0.943. Elements whose weights are all zero do not count; a node with
    /// stiffness and no mass in its part makes the bound infinite. At finite strain it is that of the undeformed body, fully
    /// integrated, which no other formulation exceeds on rectangular elements as long as the hourglass factor is not above 1:
    /// hourglass modes have at most 4 μ κ/(ρ h²), h the least edge, and full integration at least 4 (λ + 2μ)/(ρ h²). With linear bulk
    /// viscosity it is 2 over the stable step of an element, which is smaller ([`BulkViscosity`](crate::BulkViscosity)).
    pub fn frequency_bound(&self) -> f64 {
        let varying: Vec<bool> = self.blocks.iter().flat_map(Block::varying).collect();
        let dim = self.dim();
        let largest = self.by_chunk(|block, chunk, first| {
            let (mut place, mut largest, mut scaled) = (first, [0.0_f64; 2], Vec::new());
            block.matrices_of(chunk, dim, true, &mut |element| {
                stability::scale(dim, element.stiffness, element.lumped, &mut scaled);
                let value = stability::largest_eigenvalue(&mut scaled);
                let value = self.damped_frequency(place, value).powi(2);
                let of = &mut largest[usize::from(varying[place])];
                *of = of.max(value);
                place += 1;
            });
            largest
        });
        let most = |which: usize| largest.iter().map(|of| of[which]).fold(0.0, f64::max);
        let [even, mut uneven] = [0, 1].map(most);
        if uneven > even {
            uneven = uneven.min(self.together(varying));
        }
        f64::max(even, uneven).sqrt()
    }

    /// 2 over the stable step of an element (rad/s) with the eigenvalue `square` = ω² (1/s²), linear bulk viscosity included: with
    /// γ = ω² ρ l b₁ c/κ, the bulk modulus κ, 2/dt = (γ + sqrt(γ² + 4 ω²))/2.
    pub(crate) fn damped_frequency(&self, element: usize, square: f64) -> f64 {
        let Some([linear, _]) = self.coefficients(element) else {
            return square.sqrt();
        };
        let rate = linear / self.bulk_modulus() * square;
        match square.is_finite() {
            true => 0.5 * (rate + (rate * rate + 4.0 * square).sqrt()),
            false => square,
        }
    }

    /// Bulk modulus of the undeformed material, Pa.
    pub(crate) fn bulk_modulus(&self) -> f64 {
        let elastic = self.material().initial();
        elastic.lame_1(Plane::Full) + 2.0 / 3.0 * elastic.shear_modulus()
    }

    /// Coefficients of the bulk viscosity of an element.
    pub(crate) fn coefficients(&self, element: usize) -> Option<[f64; 2]> {
        self.viscosity?;
        let mut first = 0;
        for block in &self.blocks {
            let (length, count) = (block.chunk_length(), block.len());
            if element < first + count {
                let (chunk, place) = ((element - first) / length, (element - first) % length);
                return block.chunks[chunk].viscosity.get(place).copied();
            }
            first += count;
        }
        None
    }

    /// Bound of the eigenvalue of the elements marked and their neighbours, taken out of the body.
    fn together(&self, mut marked: Vec<bool>) -> f64 {
        // by then a motion at the ends of the weights has died away
        const LAYERS: usize = 4;
        let mut elements = Vec::new();
        self.each_element(&mut |nodes| elements.push(nodes.to_vec()));
        for _ in 0..LAYERS {
            let touched = elements.iter().zip(&marked).filter(|(_, marked)| **marked);
            let nodes: BTreeSet<u32> = touched.flat_map(|(nodes, _)| nodes).copied().collect();
            for (element, marked) in elements.iter().zip(&mut marked) {
                *marked |= element.iter().any(|node| nodes.contains(node));
            }
        }
        let mut kept = marked.iter();
        elements.retain(|_| kept.next() == Some(&true));
        let mut together = Together::new(self.dim(), &elements);
        let mut place = 0;
        self.each_matrix(true, &mut |element| {
            if marked[place] {
                together.add(element.nodes, element.stiffness, element.lumped);
            }
            place += 1;
        });
        together.largest_eigenvalue()
    }
}
