//! Forces at finite strain of several elements at a time, as many as a register has lanes: the inner loop of a nonlinear explicit run.
//!
//! The formulas are those of `element.rs`, `dilatation.rs`, `between.rs` and `hourglass.rs`, which take one element after the other
//! and give the tangents that `tangents.rs` does not. Geometry is computed anew at each call, as at small strain.
//!
//! A batch of elements passes through three functions: geometry and displacement gradients of all points, the law at all points,
//! forces. Each is compiled for each instruction set; with the law apart, kinds and laws add up and do not multiply.

use carom_algebra::number::Number;
use carom_algebra::packed::Packed;
use carom_elements::Kind;
use carom_materials::{MAX_KEPT, Pointwise};
use pulp::{NullaryFnOnce, Simd, WithSimd};

use super::batch::{AtLaw, Bad, Energies, Together, Watch};
use super::body::{Finite, Outcome};
use super::cell::Shape;
use super::element::Fault;
use super::passes::{Elements, Forces, Gradients, Room};
use super::viscosity::{add_pressure, damp};
use super::{Formulation, Placement, Stored};
use crate::block::{Block, Physics};
use crate::chunk::Chunk;
use crate::force::Cell;

/// Whether there is a kernel for the kind.
pub(super) fn takes(kind: Kind) -> bool {
    use Kind::{Hex8, Quad4, Tet4, Tet10, Tri3, Tri6, Wedge6};
    matches!(kind, Tri3 | Tri6 | Quad4 | Tet4 | Tet10 | Wedge6 | Hex8)
}

/// Evaluates an expression with the law behind the choice, whatever its type.
macro_rules! by_law {
    ($choice:expr, $law:ident => $call:expr) => {
        carom_materials::materials!(match_law ($choice) $law $call)
    };
}

/// [`by_law`], with the list of materials behind it.
macro_rules! match_law {
    (
        [($choice:expr) $law:ident $call:expr]
        $($(#[$doc:meta])* $name:ident $key:literal,)*
    ) => {
        match $choice {
            $(carom_materials::Law::$name($law) => $call,)*
        }
    };
}

/// Calls a method with N nodes, D dimensions and E edges along an axis of a kind that [`takes`] has.
macro_rules! by_kind {
    ($kind:expr, $own:ident.$method:ident::<$S:ident>($($argument:expr),*)) => {
        match $kind {
            Kind::Tri3 => $own.$method::<$S, 3, 2, 1>($($argument),*),
            Kind::Tri6 => $own.$method::<$S, 6, 2, 3>($($argument),*),
            Kind::Quad4 => $own.$method::<$S, 4, 2, 2>($($argument),*),
            Kind::Tet4 => $own.$method::<$S, 4, 3, 1>($($argument),*),
            Kind::Tet10 => $own.$method::<$S, 10, 3, 4>($($argument),*),
            Kind::Wedge6 => $own.$method::<$S, 6, 3, 3>($($argument),*),
            _ => $own.$method::<$S, 8, 3, 4>($($argument),*),
        }
    };
}

pub(super) use {by_kind, by_law, match_law};

/// The forces of one chunk.
pub(super) struct Sweep<'a> {
    pub(super) finite: &'a Finite,
    pub(super) block: &'a Block,
    pub(super) chunk: &'a Chunk,
    /// Its history is that of the chunk.
    pub(super) at: &'a Placement<'a>,
    pub(super) new: &'a mut [f64],
    /// One entry for each node of the chunk.
    pub(super) f: &'a mut [[f64; 3]],
}

impl WithSimd for Sweep<'_> {
    type Output = Outcome;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Outcome {
        let zero = Packed::all(simd, 0.0);
        by_kind!(self.block.kind, self.batches::<S>(zero, simd))
    }
}

impl Sweep<'_> {
    /// Takes as many elements at a time as a register has lanes, and adds forces and energies in the order of the elements.
    #[inline(always)]
    fn batches<S: Simd, const N: usize, const D: usize, const E: usize>(
        self,
        zero: Packed<S>,
        simd: S,
    ) -> Outcome {
        let mut out = Outcome::default();
        let Physics::Continuum(physics) = &self.block.physics else {
            return out;
        };
        let elements = Elements {
            cell: Cell::new(physics, &self.block.stiffness_points),
            together: self.finite.shape.together(self.block),
            kind: self.block.kind,
            weighted: self.chunk.weights_of_work().is_some(),
            between: self.at.from.is_some(),
        };
        let points = self.finite.shape.points(self.block);
        let mut room = Room::<_, N, D, E>::new(zero);
        for (place, batch) in self.chunk.connectivity.chunks(N * S::F64_LANES).enumerate() {
            let (first, count) = (place * S::F64_LANES, batch.len() / N);
            self.chunk
                .lanes(batch, self.at.u, [&mut room.x, &mut room.u]);
            if let Some(from) = self.at.from {
                self.chunk.displacements(batch, from, &mut room.from);
            }
            for (q, weight) in room.law.weights.iter_mut().enumerate() {
                self.chunk.weigh(first, q, weight);
            }
            if self.finite.limit.is_some() {
                let old = &self.at.old[first * self.finite.kept * points..];
                let new = &mut self.new[first * self.finite.kept * points..];
                self.finite.leave_out(
                    points,
                    (old, &mut new[..count * self.finite.kept * points]),
                    &mut room.u,
                );
            }
            let mut found = simd.vectorize(Gradients(&elements, &mut room));
            if elements.between && found.is_ok() {
                let (at, strains) = (&mut room.law, elements.together == Together::Dilated);
                let answered = by_law!(
                    &self.finite.law,
                    law => simd.vectorize(AskBetween { law, at, points, strains })
                );
                let Some(answered) = answered else {
                    out.fault = Some((first, Fault::NoBetween));
                    return out;
                };
                found = answered;
            }
            let mut histories = Histories {
                first,
                count,
                points,
                kept: self.finite.kept,
                of_law: self.finite.kept_by_law,
                dt: self.at.dt,
                old: self.at.old,
                new: &mut *self.new,
            };
            if !elements.between && found.is_ok() {
                let at = &mut room.law;
                found = by_law!(
                    &self.finite.law,
                    law => simd.vectorize(AskLaw(law, at, &mut histories))
                );
            }
            if let (Ok(()), false) = (&found, self.chunk.viscosity.is_empty()) {
                let coefficients = &self.chunk.viscosity[first..first + count];
                simd.vectorize(Damp(&mut room.law, &mut histories, coefficients));
                out.stored.compression = out
                    .stored
                    .compression
                    .max(room.law.viscous.compression.largest());
            }
            if let Err(bad) = found {
                out.fault = bad.fault(first, count);
                return out;
            }
            let energies = simd.vectorize(Forces(&elements, &mut room));
            out.stored.add_lanes(&energies, count);
            for (k, element) in batch.chunks_exact(N).enumerate() {
                for a in 0..N {
                    let sum = &mut self.f[element[a] as usize];
                    for i in 0..D {
                        sum[i] += room.f[a][i].lanes()[k];
                    }
                }
            }
        }
        out
    }
}

impl Shape {
    /// How the points of an element act together.
    pub(super) fn together(&self, block: &Block) -> Together {
        match (self.formulation, self.hourglass(block)) {
            (_, Some(modulus)) => Together::OnePoint(modulus),
            // of a single point the mean is its own
            (Formulation::BBar, _) if self.points(block) > 1 => Together::Dilated,
            _ => Together::Full,
        }
    }
}

impl Stored {
    #[inline(always)]
    fn add_lanes<T: Number>(&mut self, energies: &Energies<T>, count: usize) {
        for k in 0..count {
            self.strain += energies[0].lanes()[k];
            self.hardening += energies[1].lanes()[k];
            self.dissipated += energies[2].lanes()[k];
            self.hourglass += energies[3].lanes()[k];
            self.viscous += energies[4].lanes()[k];
        }
    }
}

/// Histories of several elements from one place in the chunk on.
struct Histories<'a> {
    first: usize,
    count: usize,
    /// Of an element.
    points: usize,
    /// Numbers that are kept of a point, and those of them that the law keeps.
    kept: usize,
    of_law: usize,
    dt: f64,
    old: &'a [f64],
    new: &'a mut [f64],
}

/// The law at all points of several elements, in a step between two displacements.
struct AskBetween<'a, L, T> {
    law: &'a L,
    at: &'a mut AtLaw<T>,
    /// Of an element.
    points: usize,
    /// Whether it sees strains.
    strains: bool,
}

impl<L: Pointwise, T: Number> NullaryFnOnce for AskBetween<'_, L, T> {
    /// None of a law without such a stress.
    type Output = Option<Result<(), Bad<T>>>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let AskBetween { law, at, .. } = self;
        let mut watch = Watch::new(at.h[0][0][0].like(0.0));
        for point in 0..self.points {
            let (from, h) = (&at.from[point], &at.h[point]);
            let answer = match self.strains {
                true => law.between_strains(h, from),
                false => law.between([from, h]),
            };
            at.answers[point] = answer?;
            watch.see(point, at.answers[point].positive);
        }
        Some(watch.end())
    }
}

/// The law at all points of several elements.
struct AskLaw<'a, 'b, L, T>(&'a L, &'a mut AtLaw<T>, &'a mut Histories<'b>);

impl<L: Pointwise, T: Number> NullaryFnOnce for AskLaw<'_, '_, L, T> {
    type Output = Result<(), Bad<T>>;

    #[inline(always)]
    fn call(self) -> Result<(), Bad<T>> {
        let AskLaw(law, at, histories) = self;
        let zero = at.h[0][0][0].like(0.0);
        let (mut old, mut new) = ([zero; MAX_KEPT], [zero; MAX_KEPT]);
        let kept = histories.of_law;
        let (old, new) = (&mut old[..kept], &mut new[..kept]);
        let mut watch = Watch::new(zero);
        for point in 0..histories.points {
            histories.read(point, 0, old);
            at.answers[point] = law.answer(&at.h[point], histories.dt, old, new);
            watch.see(point, at.answers[point].positive);
            histories.write(point, 0, new);
        }
        watch.end()
    }
}

impl Histories<'_> {
    /// Place of the history of an element at a point.
    #[inline(always)]
    fn place(&self, element: usize, point: usize) -> usize {
        ((self.first + element) * self.points + point) * self.kept
    }

    /// Numbers at a point at the start of the step, from one of them on; a short batch repeats its last element.
    #[inline(always)]
    fn read<T: Number>(&self, point: usize, from: usize, out: &mut [T]) {
        let Some(lanes) = out.first().map(|out| out.lanes().len()) else {
            return;
        };
        for k in 0..lanes {
            let own = &self.old[self.place(k.min(self.count - 1), point) + from..];
            for (out, own) in out.iter_mut().zip(own) {
                out.lanes_mut()[k] = *own;
            }
        }
    }

    /// Writes numbers at a point at the end of the step, from one of them on.
    #[inline(always)]
    fn write<T: Number>(&mut self, point: usize, from: usize, values: &[T]) {
        if values.is_empty() {
            return;
        }
        for k in 0..self.count {
            let place = self.place(k, point) + from;
            for (new, own) in values.iter().zip(&mut self.new[place..]) {
                *own = new.lanes()[k];
            }
        }
    }
}

/// Adds the bulk viscosity to what the law answered at all points of several elements, which have these coefficients.
struct Damp<'a, 'b, T>(&'a mut AtLaw<T>, &'a mut Histories<'b>, &'a [[f64; 2]]);

impl<T: Number> NullaryFnOnce for Damp<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Damp(at, histories, of_elements) = self;
        let zero = at.h[0][0][0].like(0.0);
        let mut coefficients = [zero; 2];
        for k in 0..zero.lanes().len() {
            let own = &of_elements[k.min(of_elements.len() - 1)];
            coefficients[0].lanes_mut()[k] = own[0];
            coefficients[1].lanes_mut()[k] = own[1];
        }
        at.viscous.compression = zero;
        for point in 0..histories.points {
            let mut before = [zero];
            histories.read(point, histories.of_law, &mut before);
            let damped = damp(&at.h[point], coefficients, (before[0], histories.dt));
            let stress = &mut at.answers[point].stress;
            add_pressure(stress, &at.h[point], damped.pressure);
            at.viscous.works[point] = damped.work;
            at.viscous.compression = at.viscous.compression.most(damped.compression);
            histories.write(point, histories.of_law, &[damped.logarithm]);
        }
    }
}
