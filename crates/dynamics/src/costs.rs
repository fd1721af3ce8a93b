//! What a run costs: times, factors, sweeps.

use std::time::Duration;

use carom_algebra::solver::FactorStats;
use serde::{Deserialize, Serialize};

use crate::operator::Operators;

/// No run takes as long: a thousand years.
pub const LONGEST: Duration = Duration::from_secs(1000 * 365 * 24 * 3600);

/// Wall time spent so far by phase of the step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Phases {
    /// Analysis and factorisation.
    pub factorisation: Duration,
    /// Internal forces.
    pub forces: Duration,
    /// Forward and backward sweeps of the free motion and the correction.
    pub sweeps: Duration,
    /// Pairing, columns, interface problem without friction.
    pub contact: Duration,
    /// Columns and interface problem of contacts with friction.
    pub friction: Duration,
    /// Balance, records, vector updates.
    pub balance: Duration,
    /// Multipliers between zones that step apart: making and solving their problem.
    pub links: Duration,
}

/// Counts of what factors were made and used for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Work {
    /// Factors computed.
    pub factorisations: usize,
    /// Triangular sweeps, forward or backward.
    pub sweeps: usize,
    /// Columns A⁻¹ Nᵀ computed.
    pub columns: usize,
    /// Products with matrices that are solved with by iterations.
    pub products: usize,
}

impl Work {
    /// Adds what factors were made and used for.
    pub fn add_factors(&mut self, operators: &Operators) {
        for stats in operators.stats() {
            self.add_factor(stats);
        }
        self.products += operators.products();
    }

    pub(crate) fn add_factor(&mut self, stats: &FactorStats) {
        self.factorisations += stats.factorisations;
        self.sweeps += stats.sweeps;
    }
}

/// What the run cost so far. Saved without what belongs to the present size of the step.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Costs {
    /// One entry per factor, for the present size of the step.
    #[serde(skip)]
    pub factors: Vec<FactorStats>,
    /// Over all sizes of the step.
    pub work: Work,
    /// Bytes of columns and compliance for the present size of the step.
    #[serde(skip)]
    pub compliance_bytes: usize,
    /// Internal-force sweeps.
    pub force_sweeps: usize,
    /// Elements whose internal forces were computed, over all sweeps.
    pub element_updates: u64,
    /// Times.
    pub phases: Phases,
    /// Those of each zone, where zones step apart; empty elsewhere.
    pub zones: Vec<Costs>,
}

impl Costs {
    /// Whether all times are below [`LONGEST`], as those of a run are: others would not add up.
    pub fn are_times(&self) -> bool {
        let phases = &self.phases;
        let times = [
            phases.factorisation,
            phases.forces,
            phases.sweeps,
            phases.contact,
            phases.friction,
            phases.balance,
            phases.links,
        ];
        times.iter().all(|time| *time < LONGEST) && self.zones.iter().all(Costs::are_times)
    }

    /// Adds the costs of another driver, or those before a run was gone on with.
    pub fn add(&mut self, other: &Costs) {
        self.factors.extend_from_slice(&other.factors);
        let (work, its) = (&mut self.work, other.work);
        work.factorisations += its.factorisations;
        work.sweeps += its.sweeps;
        work.columns += its.columns;
        work.products += its.products;
        self.compliance_bytes += other.compliance_bytes;
        self.force_sweeps += other.force_sweeps;
        self.element_updates += other.element_updates;
        let (phases, its) = (&mut self.phases, other.phases);
        phases.factorisation += its.factorisation;
        phases.forces += its.forces;
        phases.sweeps += its.sweeps;
        phases.contact += its.contact;
        phases.friction += its.friction;
        phases.balance += its.balance;
        phases.links += its.links;
    }

    /// Solutions with a factor: pairs of a forward and a backward sweep.
    pub fn solves(&self) -> u64 {
        self.work.sweeps as u64 / 2
    }
}
