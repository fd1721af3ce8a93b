//! Groups of points that share no unknown, and follow each other: one thread solves them.

use std::ops::Range;

use carom_algebra::Interrupt;
use carom_nonsmooth::{CandidateData, Compliance, Condensed, ContactSolver, PointForces, Unsolved};

use crate::groups::{Masses, OfGroup, PointRows};

/// The candidates of all groups, group after group, and what their problems have in common.
#[derive(Clone, Copy)]
pub(crate) struct Candidates<'a> {
    pub(crate) points: &'a [u32],
    pub(crate) data: &'a CandidateData,
    /// Rows of all points.
    pub(crate) rows: PointRows<'a>,
    pub(crate) masses: Masses<'a>,
    /// Factors of D p in gap, rate and sliding.
    pub(crate) factors: [f64; 3],
    /// Relative defect that solutions with friction may have.
    pub(crate) tolerance: f64,
    /// Ends all of them.
    pub(crate) interrupt: &'a Interrupt,
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

/// Some groups, with what solving them needs.
#[derive(Default)]
pub(crate) struct Span {
    /// The groups, as ranges of the candidates.
    pub(crate) groups: Vec<Range<usize>>,
    /// Of each of their candidates.
    pub(crate) found: Vec<PointForces>,
    /// Most passes of a group without friction.
    pub(crate) passes: usize,
    /// Candidates from which on statuses changed one at a time.
    pub(crate) circled: Vec<usize>,
    /// A candidate whose tension did not settle.
    pub(crate) unsettled: Option<usize>,
    /// The first group that was not solved.
    pub(crate) unsolved: Option<(Range<usize>, Unsolved)>,
    of_group: OfGroup,
    version: u64,
    solver: ContactSolver,
}

impl Span {
    /// Solves the groups, up to the first without solution.
    pub(crate) fn solve(&mut self, of: &Candidates) {
        self.found.clear();
        self.circled.clear();
        (self.passes, self.unsettled) = (0, None);
        self.solver.heed(of.interrupt);
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
        let own = of.data.within(group.clone());
        let rubs = own.friction.iter().any(|own| own.mu > 0.0);
        self.version += 1;
        let problem = Condensed {
            d: of.compliance((group.clone(), rubs), &mut self.of_group),
            version: self.version,
            s: of.factors,
            tangents: if rubs { of.rows.tangents.len() } else { 0 },
            tolerance: of.tolerance,
        };
        let solved = self.solver.solve(own, &problem);
        solved.map_err(|failure| (group.clone(), failure))?;
        self.found.extend(&self.solver.found);
        self.passes = self.passes.max(self.solver.passes);
        let place = |k: usize| group.start + k;
        self.circled.extend(self.solver.circled.map(place));
        self.unsettled = self.unsettled.or(self.solver.unsettled.map(place));
        Ok(())
    }

    /// D of a group over its rows, those of tangents too where it has friction, if they are at most `most`.
    pub(crate) fn entries(
        &mut self,
        of: &Candidates,
        group: Range<usize>,
        (has_friction, most): (bool, usize),
    ) -> Option<Vec<f64>> {
        let compliance = of.compliance((group, has_friction), &mut self.of_group);
        compliance.entries(most)
    }

    /// Bytes of the largest D so far.
    pub(crate) fn bytes(&self) -> usize {
        self.of_group.bytes
    }
}
