//! Tangents at finite strain of several elements at a time, as many as a register has lanes: full integration, and laws with a
//! stored energy alone, whose moduli have a closed form.
//!
//! K = Σ w dV Bᵀ A B with A = ∂P/∂F, as in `element.rs`, which gives the tangents of all others. Geometry and displacement gradients are
//! those of the forces (`passes.rs`); law and sum are functions of one point of a batch, so that A stays in the first cache.

use carom_algebra::number::Number;
use carom_algebra::packed::Packed;
use carom_elements::Kind;
use carom_materials::{Derivative, Pointwise, Tensor};
use pulp::{NullaryFnOnce, Simd, WithSimd};

use super::Placement;
use super::batch::{Together, Watch};
use super::body::{Failed, Finite};
use super::element::Fault;
use super::kernel::{self, by_kind, by_law, match_law};
use super::passes::{Elements, Gradients, Room};
use crate::block::{Block, Physics};
use crate::chunk::Chunk;
use crate::force::Cell;

/// Tangents of several elements: entry `[a][i][b][k]` is the derivative of component i of the force on node a by component k of the
/// displacement of node b.
type Blocks<T, const N: usize, const D: usize> = [[[[T; D]; N]; D]; N];

impl Finite {
    /// Whether tangents of a block are computed several at a time.
    pub(super) fn takes_tangents(&self, block: &Block) -> bool {
        let has_derivative = by_law!(&self.law, law => has_derivative(law));
        let full = self.shape.together(block) == Together::Full;
        // of a deleted element there is no displacement
        kernel::takes(block.kind) && full && has_derivative && self.limit.is_none()
    }
}

fn has_derivative(law: &impl Pointwise) -> bool {
    law.derivative(&[[0.0; 3]; 3], None).is_some()
}

/// Tangents of some elements of a chunk.
pub(super) struct Tangents<'a> {
    pub(super) finite: &'a Finite,
    pub(super) block: &'a Block,
    pub(super) chunk: &'a Chunk,
    pub(super) at: &'a Placement<'a>,
    /// The first of them, a multiple of the number of lanes.
    pub(super) first: usize,
    /// Their matrices one after the other, in N/m, row-major.
    pub(super) out: &'a mut [f64],
}

impl WithSimd for Tangents<'_> {
    /// The first element without tangent.
    type Output = Result<(), Failed>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let zero = Packed::all(simd, 0.0);
        by_kind!(self.block.kind, self.batches::<S>(zero, simd))
    }
}

impl Tangents<'_> {
    #[inline(always)]
    fn batches<S: Simd, const N: usize, const D: usize, const E: usize>(
        self,
        zero: Packed<S>,
        simd: S,
    ) -> Result<(), Failed> {
        let Physics::Continuum(physics) = &self.block.physics else {
            return Ok(());
        };
        let elements = Elements {
            cell: Cell::new(physics, &self.block.stiffness_points),
            together: Together::Full,
            kind: self.block.kind,
            weighted: self.chunk.weights_of_work().is_some(),
            between: self.at.from.is_some(),
        };
        let entries = (N * D).pow(2);
        let count = self.out.len() / entries;
        let nodes = &self.chunk.connectivity[N * self.first..][..N * count];
        let mut room = Room::<_, N, D, E>::new(zero);
        let mut sum = Sum::<_, N, D>::new(zero);
        let outs = self.out.chunks_mut(entries * S::F64_LANES);
        for (place, (batch, out)) in nodes.chunks(N * S::F64_LANES).zip(outs).enumerate() {
            let first = self.first + place * S::F64_LANES;
            self.chunk
                .lanes(batch, self.at.u, [&mut room.x, &mut room.u]);
            if let Some(from) = self.at.from {
                self.chunk.displacements(batch, from, &mut room.from);
            }
            for (q, weight) in room.law.weights.iter_mut().enumerate() {
                self.chunk.weigh(first, q, weight);
            }
            let count = batch.len() / N;
            let mut found = simd.vectorize(Gradients(&elements, &mut room));
            let mut watch = Watch::new(zero);
            sum.k = [[[[zero; D]; N]; D]; N];
            for q in 0..elements.cell.points().len() {
                let h = &room.law.h[q];
                let from = elements.between.then_some(&room.law.from[q]);
                let derivative = by_law!(
                    &self.finite.law,
                    law => simd.vectorize(AskDerivative { law, h, from })
                );
                let Some(derivative) = derivative else {
                    return Err((first, Fault::NoBetween));
                };
                watch.see(q, derivative.positive);
                simd.vectorize(AddPoint {
                    of: (&elements, &room, q),
                    derivative: &derivative,
                    sum: &mut sum,
                });
            }
            found = found.and(watch.end());
            if let Some(fault) = found.err().and_then(|bad| bad.fault(first, count)) {
                return Err(fault);
            }
            for (lane, out) in out.chunks_exact_mut(entries).enumerate() {
                sum.write(lane, elements.between, out);
            }
        }
        Ok(())
    }
}

/// The derivative of the law at one point of several elements.
struct AskDerivative<'a, L, T> {
    law: &'a L,
    h: &'a Tensor<T>,
    from: Option<&'a Tensor<T>>,
}

impl<L: Pointwise, T: Number> NullaryFnOnce for AskDerivative<'_, L, T> {
    type Output = Option<Derivative<T>>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        self.law.derivative(self.h, self.from)
    }
}

/// A sum over the points of several elements.
struct Sum<T, const N: usize, const D: usize> {
    /// A of one point.
    a: [[T; 9]; 9],
    /// Where K is symmetric only the blocks with b not below a.
    k: Blocks<T, N, D>,
}

impl<T: Number, const N: usize, const D: usize> Sum<T, N, D> {
    #[inline(always)]
    fn new(zero: T) -> Self {
        Sum {
            a: [[zero; 9]; 9],
            k: [[[[zero; D]; N]; D]; N],
        }
    }

    /// Writes the tangent of one of the elements. `whole`: it is not symmetric.
    #[inline(always)]
    fn write(&self, lane: usize, whole: bool, out: &mut [f64]) {
        let size = N * D;
        for a in 0..N {
            for i in 0..D {
                let first = if whole { 0 } else { a };
                for b in first..N {
                    // of a symmetric matrix what is on and above the diagonal
                    let least = if !whole && b == a { i } else { 0 };
                    for k in least..D {
                        let entry = self.k[a][i][b][k].lanes()[lane];
                        out[(D * a + i) * size + D * b + k] = entry;
                        if !whole {
                            out[(D * b + k) * size + D * a + i] = entry;
                        }
                    }
                }
            }
        }
    }
}

/// Adds w dV Bᵀ A B of one point.
struct AddPoint<'a, T, const N: usize, const D: usize, const E: usize> {
    /// Elements, their room, and the point.
    of: (&'a Elements<'a, N, D, E>, &'a Room<T, N, D, E>, usize),
    derivative: &'a Derivative<T>,
    sum: &'a mut Sum<T, N, D>,
}

impl<T: Number, const N: usize, const D: usize, const E: usize> NullaryFnOnce
    for AddPoint<'_, T, N, D, E>
{
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (elements, room, q) = self.of;
        let (cell, metric) = (&elements.cell, &room.metrics[q]);
        let ring = cell.has_hoop();
        let Sum { a, k } = self.sum;
        self.derivative.write::<D>(ring, a);
        let weight = metric.volume() * room.law.weights[q];
        let (gradients, around) = cell.shape_gradients((&cell.points()[q], metric));
        for node in 0..N {
            let mut own = gradients[node];
            for own in &mut own {
                *own = *own * weight;
            }
            let own_around = around[node] * weight;
            let first = if elements.between { 0 } else { node };
            for i in 0..D {
                let mut row = [[weight.like(0.0); D]; D];
                let mut row_around = weight.like(0.0);
                for c in 0..D {
                    for l in 0..D {
                        let mut sum = own[0] * a[3 * i][3 * c + l];
                        for j in 1..D {
                            sum = own[j].mul_add(a[3 * i + j][3 * c + l], sum);
                        }
                        if ring && i == 0 {
                            sum = own_around.mul_add(a[8][3 * c + l], sum);
                        }
                        row[c][l] = sum;
                    }
                }
                if ring {
                    for j in 0..D {
                        row_around = own[j].mul_add(a[3 * i + j][8], row_around);
                    }
                    if i == 0 {
                        row_around = own_around.mul_add(a[8][8], row_around);
                    }
                }
                for b in first..N {
                    for c in 0..D {
                        let mut sum = k[node][i][b][c];
                        for l in 0..D {
                            sum = row[c][l].mul_add(gradients[b][l], sum);
                        }
                        if ring && c == 0 {
                            sum = row_around.mul_add(around[b], sum);
                        }
                        k[node][i][b][c] = sum;
                    }
                }
            }
        }
    }
}
