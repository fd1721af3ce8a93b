//! Sweeps over all elements of a body at finite strain.
//!
//! Elements are computed in parallel, each into its own place, and added in their order: equal bits for any number of
//! threads.

use carom_algebra::csr::Csr;
use carom_algebra::tensor::Mat3;
use carom_materials::Law;
use rayon::prelude::*;

use super::cells::Cells;
use super::element::{Fault, Local};
use super::{Placement, Stored};

/// Elements per piece of parallel work.
const PIECE: usize = 32;
/// Entries of element tangents that are held at a time.
const HELD: usize = 1 << 19;

/// The elements of a body at finite strain.
#[derive(Debug)]
pub(crate) struct Finite {
    law: Law,
    /// Numbers that the law keeps of a point.
    kept: usize,
    pub(super) cells: Vec<Cells>,
}

/// Forces and energies of the elements before they are added.
#[derive(Debug, Default)]
pub(crate) struct Elements {
    /// N, unknowns of each element.
    forces: Vec<f64>,
    /// One of each piece.
    pieces: Vec<Piece>,
}

/// Result of some elements.
#[derive(Clone, Debug, Default)]
struct Piece {
    stored: Stored,
    /// Place in the block, and what went wrong.
    fault: Option<(usize, Fault)>,
}

/// What is called for each element: first unknowns of its nodes, unknowns of a node, tangent in N/m, row-major.
pub(super) type VisitTangent<'a> = dyn FnMut(&[u32], usize, &mut [f64]) + 'a;

/// A place in the body, and what went wrong there.
pub(super) type Failed = (usize, Fault);

impl Finite {
    pub(crate) fn new(law: Law, cells: Vec<Cells>) -> Finite {
        let kept = law.finite().map_or(0, |law| law.history_len());
        Finite { law, kept, cells }
    }

    /// Numbers that all points keep.
    pub(super) fn history_len(&self) -> usize {
        let points = self.cells.iter().map(|cells| cells.len() * cells.points);
        self.kept * points.sum::<usize>()
    }

    pub(super) fn start_history(&self, out: &mut [f64]) {
        let Some(law) = self.law.finite().filter(|_| self.kept > 0) else {
            return;
        };
        for point in out.chunks_exact_mut(self.kept) {
            law.start(point);
        }
    }

    /// Adds all forces to `f`.
    pub(super) fn force(
        &self,
        at: &Placement,
        mut new: &mut [f64],
        elements: &mut Elements,
        f: &mut [f64],
    ) -> Result<Stored, Failed> {
        let (mut stored, mut first, mut kept) = (Stored::default(), 0, 0);
        for cells in &self.cells {
            let length = cells.len() * cells.points * self.kept;
            let old = &at.old[kept..kept + length];
            let (own, rest) = std::mem::take(&mut new).split_at_mut(length);
            (new, kept) = (rest, kept + length);
            self.sweep(cells, &Placement { old, ..*at }, own, elements);
            let pieces = &elements.pieces;
            if let Some((place, fault)) = pieces.iter().find_map(|piece| piece.fault.clone()) {
                return Err((first + place, fault));
            }
            for piece in pieces {
                stored.strain += piece.stored.strain;
                stored.hardening += piece.stored.hardening;
                stored.dissipated += piece.stored.dissipated;
            }
            let forces = elements.forces.chunks_exact(cells.dim);
            for (f_a, &first) in forces.zip(&cells.first) {
                let f = &mut f[first as usize..][..cells.dim];
                for (f, f_a) in f.iter_mut().zip(f_a) {
                    *f += f_a;
                }
            }
            first += cells.len();
        }
        Ok(stored)
    }

    /// Forces of the elements of one kind; `at.old` and `new` are theirs.
    fn sweep(&self, cells: &Cells, at: &Placement, new: &mut [f64], out: &mut Elements) {
        let unknowns = cells.unknowns();
        out.forces.clear();
        out.forces.resize(cells.len() * unknowns, 0.0);
        out.pieces.clear();
        out.pieces
            .resize(cells.len().div_ceil(PIECE), Piece::default());
        let kept = cells.points * self.kept;
        let work = |place: usize, new: &mut [f64], forces: &mut [f64], piece: &mut Piece| {
            for (k, f) in forces.chunks_exact_mut(unknowns).enumerate() {
                let element = place * PIECE + k;
                let new = &mut new[kept * k..kept * (k + 1)];
                let force = self.at_element(cells, element, at, |local| {
                    cells.force(element, local, new, f)
                });
                match force {
                    Ok(stored) => {
                        piece.stored.strain += stored.strain;
                        piece.stored.hardening += stored.hardening;
                        piece.stored.dissipated += stored.dissipated;
                    }
                    Err(fault) => {
                        piece.fault = Some((element, fault));
                        return;
                    }
                }
            }
        };
        if out.pieces.len() == 1 {
            // waking a thread takes as long as the work
            return work(0, new, &mut out.forces, &mut out.pieces[0]);
        }
        let pieces = out.forces.par_chunks_mut(PIECE * unknowns);
        let pieces = pieces.zip(&mut out.pieces).enumerate();
        if kept == 0 {
            pieces.for_each(|(place, (f, piece))| work(place, &mut [], f, piece));
        } else {
            let histories = new.par_chunks_mut(PIECE * kept);
            pieces
                .zip(histories)
                .for_each(|((place, (f, piece)), new)| work(place, new, f, piece));
        }
    }

    /// Calls `then` with an element where it is; `at.old` begins with the elements of `cells`.
    fn at_element<T>(
        &self,
        cells: &Cells,
        element: usize,
        at: &Placement,
        then: impl FnOnce(&Local) -> Result<T, Fault>,
    ) -> Result<T, Fault> {
        let kept = cells.points * self.kept;
        let n = cells.unknowns();
        let u = cells.gather(element, at.u);
        let from = at.from.map(|from| cells.gather(element, from));
        let Some(law) = self.law.finite() else {
            return Err(Fault::NoBetween);
        };
        then(&Local {
            law,
            u: &u[..n],
            from: from.as_ref().map(|from| &from[..n]),
            dt: at.dt,
            old: &at.old[kept * element..kept * (element + 1)],
        })
    }

    /// Adds `factor` times all tangents to a matrix over all unknowns.
    pub(super) fn add_tangent(
        &self,
        at: &Placement,
        factor: f64,
        matrix: &mut Csr,
    ) -> Result<(), Failed> {
        let mut unknowns = Vec::new();
        self.each_tangent(at, &mut |first, dim, k| {
            unknowns.clear();
            let of_node = |&first: &u32| first..first + dim as u32;
            unknowns.extend(first.iter().flat_map(of_node));
            k.iter_mut().for_each(|k| *k *= factor);
            matrix.add_block(&unknowns, k);
        })
    }

    /// Calls `visit` with each element in their order.
    pub(super) fn each_tangent(
        &self,
        at: &Placement,
        visit: &mut VisitTangent,
    ) -> Result<(), Failed> {
        let (mut first, mut kept) = (0, 0);
        let (mut tangents, mut results) = (Vec::new(), Vec::new());
        for cells in &self.cells {
            let length = cells.len() * cells.points * self.kept;
            let old = &at.old[kept..kept + length];
            let at = Placement { old, ..*at };
            let entries = cells.unknowns().pow(2);
            let held = (HELD / entries).max(1);
            for begin in (0..cells.len()).step_by(held) {
                let count = held.min(cells.len() - begin);
                tangents.resize(count * entries, 0.0);
                let all = tangents.par_chunks_exact_mut(entries).enumerate();
                let room = || vec![0.0; cells.points * self.kept];
                all.map_init(room, |new, (place, k)| {
                    let element = begin + place;
                    self.at_element(cells, element, &at, |local| {
                        cells.tangent(element, local, new, k)
                    })
                })
                .collect_into_vec(&mut results);
                for (place, result) in results.drain(..).enumerate() {
                    result.map_err(|fault| (first + begin + place, fault))?;
                    let k = &mut tangents[place * entries..][..entries];
                    visit(cells.element_first(begin + place), cells.dim, k);
                }
            }
            first += cells.len();
            kept += length;
        }
        Ok(())
    }

    /// Current volume (m³) and mean Cauchy stress (Pa) of each element; no number where the law gives none.
    pub(crate) fn stresses(&self, u: &[f64], history: &[f64]) -> Vec<(f64, Mat3)> {
        let (mut out, mut kept) = (Vec::new(), 0);
        for cells in &self.cells {
            let mut new = vec![0.0; cells.points * self.kept];
            let length = cells.len() * new.len();
            let at = Placement {
                u,
                v: &[],
                from: None,
                dt: 0.0,
                old: &history[kept..kept + length],
            };
            kept += length;
            out.extend((0..cells.len()).map(|element| {
                let stress = self.at_element(cells, element, &at, |local| {
                    cells.cauchy(element, local, &mut new)
                });
                stress.unwrap_or((f64::NAN, Mat3::repeat(f64::NAN)))
            }));
        }
        out
    }

    /// Mean equivalent plastic strain of each element, by volume; none of a law without.
    pub(crate) fn plastic_strains(&self, history: &[f64]) -> Option<Vec<f64>> {
        self.law.plastic_strain(history)?;
        let (mut out, mut points) = (Vec::new(), history.chunks_exact(self.kept));
        for cells in &self.cells {
            for element in 0..cells.len() {
                let (mut volume, mut sum) = (0.0, 0.0);
                for (point, kept) in points.by_ref().take(cells.points).enumerate() {
                    volume += cells.volume(element, point);
                    sum += cells.volume(element, point) * self.law.plastic_strain(kept)?;
                }
                out.push(sum / volume);
            }
        }
        Some(out)
    }
}
