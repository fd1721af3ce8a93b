//! Groups of points that share no unknown, and follow each other: one thread solves them.

use std::ops::Range;

use carom_algebra::Interrupt;
use carom_contact::law::Status;
use carom_nonsmooth::Compliance;

use crate::coulomb::{Coulomb, FrictionFailure, Posed, Slip, Tangential};
use crate::groups::{Masses, OfGroup, PointRows};
use crate::interface::{Candidate, Failure, Interface};

/// The candidates of all groups, group after group, and what their problems have in common.
#[derive(Clone, Copy)]
pub(super) struct Candidates<'a> {
    pub(super) points: &'a [u32],
    pub(super) data: &'a [Candidate],
    /// Empty without friction.
    pub(super) friction: &'a [Tangential],
    /// Rows of all points.
    pub(super) rows: PointRows<'a>,
    pub(super) masses: Masses<'a>,
    /// Factors of D p in gap, rate and sliding.
    pub(super) factors: [f64; 3],
    /// Relative defect that solutions with friction may have.
    pub(super) tolerance: f64,
    /// Ends all of them.
    pub(super) interrupt: &'a Interrupt,
}

impl Candidates<'_> {
    /// D of a group, over the tangents too where it has friction.
    fn compliance<'a>(
        &self,
        (group, has_friction): (Range<usize>, bool),
        of_group: &'a mut OfGroup,
    ) -> Compliance<'a> {
        let width = if has_friction { self.rows.width() } else { 1 };
        of_group.over(&self.points[group], width, self.rows, self.masses)
    }
}

/// What is found for a candidate.
#[derive(Clone, Copy)]
pub(super) struct Found {
    pub(super) force: f64,
    pub(super) tangential: [f64; 2],
    pub(super) status: Status,
    pub(super) slip: Slip,
}

/// A group without solution.
pub(super) enum Unsolved {
    Normal(Failure),
    Friction(FrictionFailure),
}

/// Some groups, with what solving them needs.
#[derive(Default)]
pub(super) struct Span {
    /// The groups, as ranges of the candidates.
    pub(super) groups: Vec<Range<usize>>,
    /// Of each of their candidates.
    pub(super) found: Vec<Found>,
    /// Most passes of a group without friction.
    pub(super) passes: usize,
    /// Candidates from which on statuses changed one at a time.
    pub(super) circled: Vec<usize>,
    /// A candidate whose tension did not settle.
    pub(super) unsettled: Option<usize>,
    /// The first group that was not solved.
    pub(super) unsolved: Option<(Range<usize>, Unsolved)>,
    of_group: OfGroup,
    version: u64,
    interface: Interface,
    coulomb: Coulomb,
}

impl Span {
    /// Solves the groups, up to the first without solution.
    pub(super) fn solve(&mut self, of: &Candidates) {
        self.found.clear();
        self.circled.clear();
        (self.passes, self.unsettled) = (0, None);
        self.interface.interrupt.clone_from(of.interrupt);
        self.coulomb.interrupt.clone_from(of.interrupt);
        let groups = std::mem::take(&mut self.groups);
        let solved = groups
            .iter()
            .try_for_each(|group| self.solve_group(of, group));
        self.unsolved = solved.err();
        self.groups = groups;
    }

    fn solve_group(
        &mut self,
        of: &Candidates,
        group: &Range<usize>,
    ) -> Result<(), (Range<usize>, Unsolved)> {
        let own = of.friction.get(group.clone()).unwrap_or_default();
        let solved = match own.iter().any(|own| own.mu > 0.0) {
            true => self.solve_rubbing(of, group.clone()),
            false => self.solve_normal(of, group.clone()),
        };
        solved.map_err(|failure| (group.clone(), failure))
    }

    /// One group without friction.
    fn solve_normal(&mut self, of: &Candidates, group: Range<usize>) -> Result<(), Unsolved> {
        self.version += 1;
        let compliance = of.compliance((group.clone(), false), &mut self.of_group);
        let factors = [of.factors[0], of.factors[1]];
        let problem = (compliance, self.version);
        let solved = self
            .interface
            .solve(&of.data[group.clone()], problem, factors);
        solved.map_err(Unsolved::Normal)?;
        self.passes = self.passes.max(self.interface.passes);
        let circled = self.interface.circled;
        self.circled.extend(circled.map(|k| group.start + k));
        let unsettled = self.interface.unsettled.map(|k| group.start + k);
        self.unsettled = self.unsettled.or(unsettled);
        let both = self.interface.forces.iter().zip(&self.interface.statuses);
        self.found.extend(both.map(|(&force, &status)| Found {
            force,
            tangential: [0.0; 2],
            status,
            slip: Slip::Open,
        }));
        Ok(())
    }

    /// One group with friction.
    fn solve_rubbing(&mut self, of: &Candidates, group: Range<usize>) -> Result<(), Unsolved> {
        let compliance = of.compliance((group.clone(), true), &mut self.of_group);
        let posed = Posed {
            candidates: &of.data[group.clone()],
            friction: &of.friction[group],
            tangents: of.rows.tangents.len(),
            d: compliance,
            s: of.factors,
            tolerance: of.tolerance,
        };
        self.coulomb.solve(&posed).map_err(Unsolved::Friction)?;
        let solver = &self.coulomb;
        self.found.extend((0..solver.forces.len()).map(|k| Found {
            force: solver.forces[k],
            tangential: solver.tangential[k],
            status: solver.statuses[k],
            slip: solver.slips[k],
        }));
        Ok(())
    }

    /// D of a group over its rows, those of tangents too where it has friction, if they are at most `most`.
    pub(super) fn entries(
        &mut self,
        of: &Candidates,
        group: Range<usize>,
        (has_friction, most): (bool, usize),
    ) -> Option<Vec<f64>> {
        let compliance = of.compliance((group, has_friction), &mut self.of_group);
        compliance.entries(most)
    }

    /// Bytes of the largest D so far.
    pub(super) fn bytes(&self) -> usize {
        self.of_group.bytes
    }
}
