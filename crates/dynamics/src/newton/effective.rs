//! The effective matrix of an iteration, its factor, and the compliance of the contact points in it.

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::solver::FactorStats;
use carom_algebra::unknowns::Unknowns;
use carom_bodies::Placement;
use carom_contact::Pairing;

use crate::compliance::Compliance;
use crate::driver::Work;
use crate::error::Error;
use crate::operator::{Operator, Operators};
use crate::step_map::StepMap;
use crate::system::{System, push_cliques};

/// A of the nonlinear step over the whole system, with its factor.
pub(super) struct Effective {
    operators: Option<Operators>,
    pub(super) compliance: Compliance,
    /// A with the rows and columns of held unknowns: supports that move load the others through them.
    matrix: Option<Csr>,
    /// Unknowns of the rows whose curvature the pattern has room for, one after the other.
    coupled: Vec<Vec<u32>>,
    /// Factors of dt and stage for which a constant matrix was made.
    constant: Option<[f64; 4]>,
    /// Scratch of the curvature.
    loads: Vec<f64>,
    retired: Work,
}

/// Where the tangent of the bodies is taken.
pub(super) struct At<'a> {
    /// The map of the step.
    pub(super) map: &'a StepMap,
    /// Size of the step, s.
    pub(super) dt: f64,
    /// Instant of the balance, s.
    pub(super) time: f64,
    /// Configuration of the internal forces, m.
    pub(super) u: &'a [f64],
    /// Velocity at the same instant, m/s.
    pub(super) v: &'a [f64],
    /// The one at the start, for stresses between the two.
    pub(super) from: Option<&'a [f64]>,
    /// Histories at the start of the step.
    pub(super) history: &'a [f64],
    /// Parts with a proximal term, and its part of the diagonal.
    pub(super) proximal: (&'a [Range<usize>], f64),
}

/// The contact points whose forces turn with the configuration.
pub(super) struct Turning<'a> {
    /// Rows and their derivatives.
    pub(super) pairing: &'a Pairing,
    /// Force of each point in N, times the derivative of its configuration by the unknown.
    pub(super) forces: Vec<f64>,
    /// Factor of contact forces in the balance.
    pub(super) factor: f64,
}

impl Effective {
    pub(super) fn new(system: &System) -> Effective {
        Effective {
            operators: None,
            compliance: Compliance::new(system.points() * (1 + system.tangents())),
            matrix: None,
            coupled: Vec::new(),
            constant: None,
            loads: Vec::new(),
            retired: Work::default(),
        }
    }

    /// Whether the factor at hand is that of this step's constant matrix.
    pub(super) fn stands(&self, key: [f64; 4]) -> bool {
        self.constant == Some(key)
    }

    /// Flops of a factorisation per flop of a pair of sweeps; none without a factor.
    pub(super) fn price(&self) -> Option<f64> {
        let stats = self.stats()?;
        Some(stats.flops / (4.0 * stats.nnz_factor as f64))
    }

    /// Makes A and its factor anew. `constant`: the key under which it need not be made again.
    ///
    /// # Errors
    /// A matrix that is not positive definite, an element without tangent.
    pub(super) fn renew(
        &mut self,
        system: &System,
        at: &At,
        turning: &mut Turning,
        constant: Option<[f64; 4]>,
    ) -> Result<(), Error> {
        self.constant = constant;
        self.compliance.forget();
        let map = at.map;
        if map.force.x == 0.0 && system.mass.consistent.is_none() {
            let lumped = system.mass.lumped.iter();
            let diagonal: Vec<f64> = lumped.map(|m| map.inertia.x * m).collect();
            self.operators = Some(Operators::whole(
                Operator::diagonal(&diagonal, &system.fixed),
                system.unknowns(),
            ));
            self.matrix = None;
            return Ok(());
        }
        self.renew_pattern(system, turning);
        let Some(mut a) = self.matrix.take() else {
            return Ok(());
        };
        a.clear();
        assemble(system, at, &mut a)?;
        super::loads::add_tangent(system, at.time, at.u, map.force.x, &mut a);
        let forces = turning.forces.iter().copied().enumerate();
        let forces = forces.filter(|(_, force)| *force != 0.0);
        turning
            .pairing
            .add_curvatures(forces, -turning.factor, &mut self.loads, &mut a);
        let mut free = a.with_identity(&system.fixed);
        let (parts, weight) = at.proximal;
        for i in parts.iter().flat_map(Range::clone) {
            if !system.fixed[i] {
                free.add(i, i, weight * a.get(i, i).abs());
            }
        }
        let factored = self.factorise(&free, &system.unknowns);
        self.matrix = Some(a);
        factored.map_err(|cause| {
            // the factor is of no use any more, but it was computed
            self.retired = self.work();
            self.operators = None;
            let node = match &cause {
                carom_algebra::Error::NotPositiveDefinite { unknown, .. } => {
                    system.unknowns.node(*unknown) as usize
                }
                _ => 0,
            };
            Error::Factor {
                matrix: "effective matrix",
                node: system.mesh_node[node],
                cause,
            }
        })
    }

    fn factorise(&mut self, free: &Csr, unknowns: &Unknowns) -> Result<(), carom_algebra::Error> {
        if let Some(Operator::Factored(factor)) =
            self.operators.as_mut().map(|o| &mut o.operators[0])
        {
            return factor.refactor(free);
        }
        let none = vec![false; free.n];
        self.operators = Some(Operators::whole(
            Operator::factored(free, &none, unknowns.node_of_each())?,
            free.n,
        ));
        Ok(())
    }

    /// Pattern of the bodies and of the rows that turn; the factor is dropped where the pattern changes.
    fn renew_pattern(&mut self, system: &System, turning: &Turning) {
        let mut rows: Vec<Vec<u32>> = Vec::new();
        let loaded = turning.forces.iter().enumerate();
        for (point, _) in loaded.filter(|(_, force)| **force != 0.0) {
            turning
                .pairing
                .cliques(point, |unknowns| rows.push(unknowns.to_vec()));
        }
        if self.matrix.is_some() && rows == self.coupled {
            return;
        }
        let n = system.unknowns();
        let mut cliques = Cliques::new();
        for body in &system.bodies {
            push_cliques(body, &system.unknowns, &(0..n), &mut cliques);
        }
        for row in &rows {
            cliques.push(row);
        }
        self.matrix = Some(Csr::from_cliques(n, &cliques));
        self.coupled = rows;
        self.retired = self.work();
        self.operators = None;
    }

    /// y = A_held x: what a motion of held unknowns does to the others, N.
    pub(super) fn load_of(&self, x: &[f64], y: &mut [f64]) {
        match &self.matrix {
            Some(matrix) => matrix.multiply(x, y),
            None => y.fill(0.0),
        }
    }

    /// The factor, and the compliance that goes with it.
    pub(super) fn both(&mut self) -> Option<(&mut Operators, &mut Compliance)> {
        Some((self.operators.as_mut()?, &mut self.compliance))
    }

    /// Norm of the diagonal of the stiffness in A times `x`, N; zero without a matrix.
    pub(super) fn stiffness_norm(
        &self,
        system: &System,
        map: &StepMap,
        x: impl Iterator<Item = f64>,
    ) -> f64 {
        let Some(a) = self.matrix.as_ref().filter(|_| map.force.x != 0.0) else {
            return 0.0;
        };
        let of = |(i, x): (usize, f64)| (a.get(i, i) - map.inertia.x * system.mass.lumped[i]) * x;
        let squares = x.enumerate().map(|at| of(at).powi(2)).sum::<f64>();
        squares.sqrt() / map.force.x
    }

    pub(super) fn stats(&self) -> Option<&FactorStats> {
        self.operators.as_ref()?.operators[0].stats()
    }

    pub(super) fn work(&self) -> Work {
        let mut work = self.retired;
        if let Some(stats) = self.stats() {
            work.factorisations += stats.factorisations;
            work.sweeps += stats.sweeps;
        }
        work.columns = self.compliance.columns_computed;
        work
    }

    pub(super) fn compliance_bytes(&self) -> usize {
        self.compliance.bytes()
    }
}

/// `inertia.x M + force.x K + damping` into a matrix of zeros.
fn assemble(system: &System, at: &At, a: &mut Csr) -> Result<(), Error> {
    let map = at.map;
    for (k, body) in system.bodies.iter().enumerate() {
        let placement = Placement {
            u: at.u,
            v: at.v,
            from: at.from,
            dt: at.dt,
            old: &at.history[system.nonlinear.histories[k].clone()],
        };
        let rate = super::loads::damping_rate(map).x;
        body.add_tangent(&placement, [map.force.x, rate], a)?;
        let damping = system.nonlinear.damping.get(k).copied().unwrap_or_default();
        if damping.stiffness != 0.0 {
            body.add_tangent(&placement, [rate * damping.stiffness, 0.0], a)?;
        }
        if damping.mass != 0.0 {
            for &(node, m) in &system.body_masses[k] {
                for unknown in system.unknowns.translations_of(node) {
                    a.add(unknown, unknown, rate * damping.mass * m);
                }
            }
        }
    }
    if map.inertia.x != 0.0 {
        system
            .mass
            .add_to(map.inertia.x, &(0..system.unknowns()), a);
    }
    Ok(())
}
