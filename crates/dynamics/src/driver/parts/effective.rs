//! The effective matrices of a step, their factors, and the compliance of the contact points in them.
//!
//! Each connected part has a matrix of its own. That of a linear part changes with the size of the step and the stage only, and
//! so does its factor. Those of the other parts are made anew within the iterations; while contact forces that turn act
//! between two of them, these parts have one matrix together.

use std::cmp::Reverse;
use std::sync::Arc;

use carom_algebra::csr::Csr;
use carom_algebra::part::Part;
use carom_algebra::rotation::Rotation;
use carom_algebra::solver::{FactorStats, SharedRows};
use carom_contact::Pairing;
use carom_ranks::Ranks;

use super::linear_part::linear_part;
use super::pieces::Pieces;
use super::tangent_solver::tangent_solver;
use crate::at_rows::AtRows;
use crate::choice;
use crate::columns::HeldColumns;
use crate::compliance::Compliance;
use crate::costs::Work;
use crate::driver::links::linking::{Linking, Made};
use crate::driver::loads::damping_rate;
use crate::error::Error;
use crate::operator::{Operators, single};
use crate::step_map::StepMap;
use crate::system::{LinkRow, Maps, Solver, System};

/// Sizes of the step and stages whose factors are kept beside those of the present one.
const KEPT: usize = 3;

/// What the matrices of linear parts depend on, of each zone: factors of mass, stiffness and damping, and of x in the rows of links.
type Key = Vec<[f64; 4]>;

/// The key of a step.
fn key(maps: &Maps) -> impl Iterator<Item = [f64; 4]> {
    let of_zone = |map: &StepMap| {
        let links = maps.link_factor(map);
        [map.inertia.x, map.force.x, damping_rate(map).x, links]
    };
    maps.all().iter().map(of_zone)
}

/// The matrices of all sizes of the step that are kept.
pub(crate) struct Effective {
    pub(crate) now: Option<Matrices>,
    kept: Vec<Matrices>,
    /// Those with factors of steps in which iterations have failed; in such a step the others.
    pub(crate) aside: Option<Box<Matrices>>,
    /// Number of all made so far.
    pub(crate) made: u64,
    /// Work with factors that are not kept any more.
    pub(crate) retired: Work,
    /// Scratch of the curvature.
    loads: Vec<f64>,
    /// Who shares the products of iterations.
    pub(crate) ranks: Ranks,
}

/// The matrices of one size of the step.
pub(crate) struct Matrices {
    pub(crate) key: Key,
    /// Configuration parts the iterations make anew.
    pub(crate) iterated: Vec<bool>,
    pub(crate) operators: Operators,
    /// Number of the first group of the operators that the iterations make anew; those of linear parts are before it.
    pub(crate) first: usize,
    pub(crate) compliance: Compliance,
    /// What the rows of links change; none without links, and before the first factors of iterated parts that they join.
    pub(crate) linking: Option<Linking>,
    /// Whether links join parts that the iterations make anew.
    pub(crate) links_iterate: bool,
    /// The columns of held unknowns in the matrices of linear parts where supports move.
    pub(crate) held: HeldColumns,
    /// Those of the other parts together, with the rows and columns of held unknowns.
    pub(crate) matrix: Option<Csr>,
    /// The elements that give their rows here, and on several ranks the rows of each group.
    pub(crate) at: AtRows,
    pub(crate) rows: Vec<SharedRows>,
    /// Its parts without held unknowns, of each group that the iterations make anew; none before they are first taken from a new pattern.
    pub(crate) free: Vec<Part>,
    /// The whole derivative of what bodies, inertia and loads give, without contact forces, not symmetric; none unless wanted.
    pub(crate) whole: Option<Csr>,
    /// What solves with all of them; none before the first that is not diagonal.
    pub(crate) solver: Option<Solver>,
    /// Whether this step alone has factors of tangents.
    pub(crate) left: bool,
    /// Who shares the products of iterations.
    pub(crate) ranks: Ranks,
    /// Unknowns of the contact points whose curvature the pattern has room for, by group, one after the other.
    pub(crate) coupled: Vec<Vec<Vec<u32>>>,
    /// Diagonals, by unknown.
    pub(crate) diagonal: Vec<f64>,
    /// The part of the stiffness in them, N/m or N m, of linear parts; zero of held unknowns. Empty until somebody asks.
    pub(crate) stiffness: Vec<f64>,
}

/// Where the tangent of the bodies is taken.
pub(crate) struct At<'a> {
    /// The maps of the step.
    pub(crate) maps: &'a Maps,
    /// Size of the step, s.
    pub(crate) dt: f64,
    /// Whether forces belong to the way of the step.
    pub(crate) between: bool,
    /// Start of the step, s.
    pub(crate) start: f64,
    /// Configuration of the internal forces, m.
    pub(crate) u: &'a [f64],
    /// Velocity at the same instant, m/s.
    pub(crate) v: &'a [f64],
    /// The one at the start, for stresses between the two.
    pub(crate) from: Option<&'a [f64]>,
    /// Rotations at the start of the step.
    pub(crate) frames: &'a [Rotation],
    /// Histories at the start of the step.
    pub(crate) history: &'a [f64],
    /// The rows of the links there.
    pub(crate) rows: &'a Arc<Vec<LinkRow>>,
    /// Pieces with a proximal term, and its part of the diagonal.
    pub(crate) proximal: (Option<&'a Pieces>, f64),
    /// Stiffness for the proximal term where nothing in the model has any, N/m.
    pub(crate) without: f64,
    /// Whether the derivative without contact forces is kept, where all parts have one that changes.
    pub(crate) whole: bool,
    /// Whether the curvature of contacts is taken within each of their sides alone, where passes make up for what couples the two.
    pub(crate) apart: bool,
}

/// The contact points whose forces turn with the configuration.
pub(crate) struct Turning<'a> {
    /// Rows and their derivatives.
    pub(crate) pairing: &'a Pairing,
    /// Force of each point in N, times the derivative of its configuration by the unknown.
    pub(crate) forces: Vec<f64>,
    /// Factor of contact forces in the balance.
    pub(crate) factor: f64,
}

impl Effective {
    pub(crate) fn new() -> Effective {
        Effective {
            now: None,
            kept: Vec::new(),
            aside: None,
            made: 0,
            retired: Work::default(),
            loads: Vec::new(),
            ranks: Ranks::alone(),
        }
    }

    /// Shares the products of iterations with others. Matrices at hand are made anew.
    pub(crate) fn share(&mut self, ranks: &Ranks) {
        self.ranks = ranks.clone();
        self.forget();
    }

    /// Drops all matrices: they are made anew.
    pub(crate) fn forget(&mut self) {
        let aside = self.aside.take().map(|aside| *aside);
        let all = self.now.take().into_iter().chain(self.kept.drain(..));
        for dropped in all.chain(aside) {
            dropped.add_work(&mut self.retired);
        }
    }

    /// Whether the matrices at hand are those of these maps.
    pub(crate) fn stands(&self, maps: &Maps) -> bool {
        let stands = |now: &Matrices| now.key.iter().copied().eq(key(maps));
        self.now.as_ref().is_some_and(stands)
    }

    /// Takes the matrices of this step: those kept from before, or new ones, in which linear parts are factored. `iterated`: the parts that
    /// are not linear; `between`: whether internal forces are means over the step.
    ///
    /// # Errors
    /// A matrix that is not positive definite.
    pub(crate) fn take(
        &mut self,
        system: &System,
        maps: &Maps,
        iterated: Vec<bool>,
        between: bool,
    ) -> Result<(), Error> {
        let key: Key = key(maps).collect();
        if let Some(now) = &mut self.now {
            if now.key == key {
                return Ok(());
            }
            if now.first == 0 && now.iterated == iterated {
                // nothing of it outlives a step
                now.key = key;
                return Ok(());
            }
        }
        let of_key = |kept: &Matrices| kept.key == key && kept.iterated == iterated;
        let next = match self.kept.iter().position(of_key) {
            Some(place) => self.kept.remove(place),
            None => {
                self.made += 1;
                let of = (between, self.made, &self.ranks);
                Matrices::new(system, maps, iterated, of, None)?
            }
        };
        if let Some(before) = self.now.replace(next) {
            if self.kept.len() == KEPT {
                let forgotten = self.kept.remove(0);
                forgotten.add_work(&mut self.retired);
            }
            self.kept.push(before);
        }
        Ok(())
    }

    /// Whether the iterations make any matrix anew.
    pub(crate) fn iterates(&self) -> bool {
        let now = self.now.as_ref();
        now.is_some_and(|now| now.iterated.contains(&true))
    }

    /// Flops of the factorisations of an iteration per flop of a pair of sweeps; none without a factor.
    pub(crate) fn price(&self) -> Option<f64> {
        let now = self.now.as_ref()?;
        let groups = &now.operators.groups[now.first..];
        let (mut flops, mut entries) = (0.0, 0);
        for group in groups {
            if let Some(stats) = group.operator.as_ref()?.stats() {
                flops += stats.flops;
                entries += stats.nnz_factor;
            }
        }
        (entries > 0).then(|| flops / (4.0 * entries as f64))
    }

    /// Makes the matrices that are not those of linear parts, and their factors, anew.
    ///
    /// # Errors
    /// A matrix that is not positive definite, an element without tangent.
    pub(crate) fn renew(
        &mut self,
        system: &System,
        at: &At,
        turning: &Turning,
    ) -> Result<(), Error> {
        match &mut self.now {
            Some(now) => now.renew(system, at, turning, (&mut self.loads, &mut self.retired)),
            None => Ok(()),
        }
    }

    /// y = A_held x: what a motion of held unknowns does to the others, N.
    pub(super) fn load_of(&self, x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        let Some(now) = &self.now else { return };
        if let Some(matrix) = &now.matrix {
            now.at.multiply(matrix, x, y);
        }
        now.held.add_product(x, y);
    }

    /// Whether the whole derivative of inertia, internal and damping forces of all parts is at hand.
    pub(crate) fn has_whole_tangent(&self) -> bool {
        let now = self.now.as_ref();
        now.is_some_and(|now| now.first == 0 && now.whole.is_some())
    }

    /// y = K̂ x with that derivative, N.
    pub(crate) fn whole_product(&self, x: &[f64], y: &mut Vec<f64>) {
        y.resize(x.len(), 0.0);
        let Some(now) = &self.now else { return };
        if let Some(whole) = &now.whole {
            now.at.multiply(whole, x, y);
        }
    }

    /// Whether there are matrices to solve with.
    pub(crate) fn has_matrices(&self) -> bool {
        self.now.as_ref().is_some_and(Matrices::are_ready)
    }

    /// The factors, and the compliance that goes with them; none before all are made.
    pub(crate) fn both(&mut self) -> Option<(&mut Operators, &mut Compliance)> {
        let (operators, compliance, _) = self.all()?;
        Some((operators, compliance))
    }

    /// The factors, the compliance, and what links change, none without links; none of all before all factors are made.
    pub(crate) fn all(
        &mut self,
    ) -> Option<(&mut Operators, &mut Compliance, Option<&mut Linking>)> {
        let now = self.now.as_mut().filter(|now| now.are_ready())?;
        Some((
            &mut now.operators,
            &mut now.compliance,
            now.linking.as_mut(),
        ))
    }

    /// What the own response of a point has grown by ([`Compliance::softened`]), m/N.
    pub(crate) fn softened(&self, point: u32) -> f64 {
        let now = self.now.as_ref();
        now.map_or(0.0, |now| now.compliance.softened(point))
    }

    /// N x of the free motion, from the y of `begin`, of a point whose column is at hand.
    pub(crate) fn free(&self, point: u32, y: &[f64]) -> f64 {
        let now = self.now.as_ref();
        now.map_or(0.0, |now| now.compliance.free(point, &now.operators, y))
    }

    /// Squares of the diagonal of the stiffness in A times `x`, by unknown, N².
    pub(super) fn stiffness_squares(
        &self,
        (system, maps): (&System, &Maps),
        mut x: impl Iterator<Item = f64>,
        mut add: impl FnMut(usize, f64),
    ) {
        let Some(now) = self.now.as_ref() else {
            return;
        };
        for (span, map) in maps.spans() {
            let own = x.by_ref().take(span.len());
            if map.force.x == 0.0 {
                own.for_each(drop);
                continue;
            }
            for (i, x) in span.zip(own) {
                let stiffness = now.diagonal[i] - map.inertia.x * system.mass.lumped[i];
                add(i, (stiffness * x / map.force.x).powi(2));
            }
        }
    }

    /// Sizes and uses of the factors at hand.
    pub(crate) fn stats(&self) -> impl Iterator<Item = &FactorStats> {
        let now = self.now.iter();
        now.flat_map(|now| now.operators.stats())
    }

    pub(crate) fn work(&self) -> Work {
        let mut work = self.retired;
        let aside = self.aside.as_deref();
        for matrices in self.now.iter().chain(&self.kept).chain(aside) {
            matrices.add_work(&mut work);
        }
        work
    }

    pub(crate) fn compliance_bytes(&self) -> usize {
        self.now.as_ref().map_or(0, |now| now.compliance.bytes())
    }
}

/// Whether rows of links act on any of some parts.
fn is_any_linked(system: &System, parts: &[bool]) -> bool {
    let mut linked = system.links.rows.iter().flatten();
    linked.any(|(unknown, _)| parts[system.part_of(*unknown as usize)])
}

impl Matrices {
    /// Whether all factors are made.
    fn are_ready(&self) -> bool {
        let mut groups = self.operators.groups.iter();
        groups.all(|group| group.operator.is_some())
    }

    /// Makes the matrices of the linear parts, and what solves with them. `made`: a number that no other matrices of the run have; `asked`: what solves
    /// with them in place of what is chosen.
    pub(crate) fn new(
        system: &System,
        maps: &Maps,
        iterated: Vec<bool>,
        (between, made, ranks): (bool, u64, &Ranks),
        asked: Option<Solver>,
    ) -> Result<Matrices, Error> {
        let (others, linear): (Vec<_>, Vec<_>) = single(iterated.len())
            .into_iter()
            .partition(|group| iterated[group[0]]);
        let first = linear.len();
        let coupled = vec![Vec::new(); others.len()];
        let mut operators = Operators::of(&system.parts, [linear, others].concat());
        let mut diagonal = vec![0.0; system.unknowns()];
        let mut held = HeldColumns::default();
        let mut solver = match (first, coupled.is_empty()) {
            (_, true) => asked,
            (0, false) => Some(tangent_solver(system, &iterated, ranks)),
            // the counts are of one kind or the other
            (_, false) => Some(Solver::Direct),
        };
        let of_size = |group: &usize| Reverse(operators.groups[*group].place.len());
        let mut largest_first: Vec<usize> = (0..first).collect();
        largest_first.sort_by_key(of_size);
        for group in largest_first {
            let group = &mut operators.groups[group];
            let part = group.parts[0].clone();
            let map = maps.of(part.start);
            let of = (map, between, (ranks, solver));
            let operator = linear_part(system, &part, of, (&mut diagonal, &mut held))?;
            solver = solver.or(choice::solver_of(&operator));
            group.operator = Some(operator);
        }
        let mut compliance = Compliance::new(
            system.points() * (1 + system.tangents()),
            system.rigid_points(),
        );
        compliance.version = made << 32;
        let links_iterate = is_any_linked(system, &iterated);
        let linking = match system.links.rows.is_empty() || links_iterate {
            true => None,
            false => {
                let made = Made {
                    matrix: None,
                    iterated: &iterated,
                    coupled: false,
                    version: compliance.version,
                };
                let rows = (system, &system.links.rows);
                let links = Linking::new(rows, (maps, between), (&mut operators, &made));
                Some(links?)
            }
        };
        Ok(Matrices {
            linking,
            links_iterate,
            key: key(maps).collect(),
            iterated,
            operators,
            first,
            compliance,
            held,
            matrix: None,
            at: AtRows::all(),
            rows: Vec::new(),
            free: Vec::new(),
            whole: None,
            solver,
            left: false,
            ranks: ranks.clone(),
            coupled,
            diagonal,
            stiffness: Vec::new(),
        })
    }

    fn add_work(&self, work: &mut Work) {
        work.add_factors(&self.operators);
        work.columns += self.compliance.columns_computed;
    }
}
