//! Tension that laws cut off: the points that would pull have no force, normal or tangential, and the others are solved for without them.
//!
//! A law with a damper pulls where it lets go. Its force is then zero, and what it would have held back, the gaps and slidings of the points
//! around it, must be known to their forces: otherwise the iterations of a step would ask for the same tension again and again. Points are cut
//! off until none pulls; one comes back where its law presses after all, `R(g₊, ġ₊) < 0` without its force.

use carom_laws::Status;

use super::{Coulomb, FrictionFailure, Posed, Slip, Tangential};
use crate::interface::Candidate;
use crate::{Compliance, PointForces};

impl Coulomb {
    /// Cuts tension off in the solution just found, where D is known entry by entry. Where no set of points is found in which none pulls
    /// and none presses, tension is cut off in this solution as it is.
    pub(super) fn cut_off(&mut self, problem: &Posed) {
        let Compliance::Dense(d) = problem.d else {
            return;
        };
        let pulls = |coulomb: &Coulomb, place: usize, i: usize| {
            let row = place * (1 + problem.tangents);
            coulomb.trial.p[row] < 0.0 && problem.candidates[i].law.get().clips()
        };
        if !(0..problem.len()).any(|i| pulls(self, i, i)) {
            return;
        }
        let mut kept: Vec<usize> = (0..problem.len()).collect();
        let whole: Vec<PointForces> = self.found().collect();
        let (passes, sweeps) = (self.passes, self.sweeps);
        let mut settled = None;
        for _ in 0..2 * problem.len() {
            let places = kept.iter().enumerate();
            let pulling = places.filter(|(place, i)| pulls(self, *place, **i));
            let pulling: Vec<usize> = pulling.map(|(_, i)| *i).collect();
            match pulling.is_empty() {
                false => kept.retain(|i| !pulling.contains(i)),
                true => {
                    let found = self.spread(&kept, &whole);
                    let Some(back) = pressing((problem, d), &kept, &found) else {
                        settled = Some(found);
                        break;
                    };
                    kept.insert(kept.partition_point(|i| *i < back), back);
                }
            }
            if self.solve_kept((problem, d), &kept).is_err() {
                break;
            }
        }
        let found = settled.unwrap_or_else(|| without_tension(problem, whole));
        (self.passes, self.sweeps) = (passes, sweeps);
        let n = problem.len();
        self.forces.resize(n, 0.0);
        self.tangential.resize(n, [0.0; 2]);
        self.statuses.resize(n, Status::Open);
        self.slips.resize(n, Slip::Open);
        self.give(problem, &found);
    }

    /// Solves for some of the points alone.
    fn solve_kept(
        &mut self,
        (problem, d): (&Posed, &[f64]),
        kept: &[usize],
    ) -> Result<(), FrictionFailure> {
        let width = 1 + problem.tangents;
        let rows = || {
            let of = |&i: &usize| i * width..(i + 1) * width;
            kept.iter().flat_map(of)
        };
        let n = problem.rows();
        let block: Vec<f64> = rows()
            .flat_map(|row| rows().map(move |column| d[row * n + column]))
            .collect();
        let candidates: Vec<Candidate> = kept.iter().map(|&i| problem.candidates[i]).collect();
        let friction: Vec<Tangential> = kept.iter().map(|&i| problem.friction[i]).collect();
        let own = Posed {
            candidates: &candidates,
            friction: &friction,
            d: Compliance::Dense(&block),
            ..*problem
        };
        if kept.is_empty() {
            self.trial.start(&own);
            self.finish(&own);
            return Ok(());
        }
        self.settle_with_tension(&own)
    }

    /// What was found of the points kept; the others have the status that they had with tension, and no force.
    fn spread(&self, kept: &[usize], whole: &[PointForces]) -> Vec<PointForces> {
        let open = whole.iter().map(|point| PointForces {
            status: point.status,
            ..PointForces::default()
        });
        let mut found: Vec<PointForces> = open.collect();
        for (&i, own) in kept.iter().zip(self.found()) {
            found[i] = own;
        }
        found
    }

    /// Makes this the solution of the problem.
    fn give(&mut self, problem: &Posed, found: &[PointForces]) {
        self.trial.start(problem);
        let width = 1 + problem.tangents;
        for (i, own) in found.iter().enumerate() {
            self.trial.p[i * width] = own.normal;
            self.trial.p[i * width + 1..(i + 1) * width]
                .copy_from_slice(&own.tangential[..problem.tangents]);
            self.trial.statuses[i] = own.status;
            (self.forces[i], self.tangential[i]) = (own.normal, own.tangential);
            (self.statuses[i], self.slips[i]) = (own.status, own.slip);
        }
        self.trial.multiply(problem);
    }
}

/// A point without force whose law presses.
fn pressing(
    (problem, d): (&Posed, &[f64]),
    kept: &[usize],
    found: &[PointForces],
) -> Option<usize> {
    let (n, width) = (problem.rows(), 1 + problem.tangents);
    let product = |i: usize| -> f64 {
        let row = &d[i * width * n..(i * width + 1) * n];
        let of_point = |(j, own): (usize, &PointForces)| {
            let t = &own.tangential[..problem.tangents];
            let along = t.iter().zip(&row[j * width + 1..]);
            row[j * width] * own.normal + along.map(|(t, d)| t * d).sum::<f64>()
        };
        found.iter().enumerate().map(of_point).sum()
    };
    let presses = |&i: &usize| {
        let relation = problem.relation(i, found[i].status);
        let product = product(i);
        let end = problem.end(i, 0.0, product, product);
        relation.gap * end.gap + relation.rate * end.rate + relation.offset < 0.0
    };
    (0..problem.len())
        .filter(|i| kept.binary_search(i).is_err())
        .find(presses)
}

/// A solution with tension set to zero in it.
fn without_tension(problem: &Posed, mut found: Vec<PointForces>) -> Vec<PointForces> {
    for (own, candidate) in found.iter_mut().zip(problem.candidates) {
        if candidate.law.get().clips() {
            own.normal = own.normal.max(0.0);
        }
    }
    found
}
