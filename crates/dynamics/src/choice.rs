//! A factor or iterations: which costs less, as predicted from counts.

use std::ops::Range;

use carom_algebra::Error as AlgebraError;
use carom_algebra::csr::Csr;
use carom_algebra::solver::{Cholesky, FactorStats, Iterative, Ordering, SharedRows};
use carom_contact::{Pairing, Search};
use carom_ranks::Ranks;

use crate::at_rows::{graph_of_nodes, groups, shared_rows};
use crate::distributed::Distributed;
use crate::error::Error;
use crate::iterated::Iterated;
use crate::operator::{Operator, unsolvable};
use crate::system::{Solver, System};

/// Unknowns below which a factor is always cheap.
pub(crate) const FEW: usize = 5000;

/// Additions and multiplications of a factorisation in the time of reading a byte of memory: some 25e9 and 10e9 of them a second.
const OPERATIONS_PER_BYTE: f64 = 2.5;

/// Bytes of a factor from which on it is not made: it, and the fronts that its making takes, would not fit in 16 GiB.
const MOST_BYTES: f64 = 8e9;

/// Steps that a matrix is taken to serve. The length of the run does not count: a run that goes on from a checkpoint to a later end takes the
/// same solver.
const STEPS: f64 = 100.0;

/// What the column of a contact point and its entries of D cost, in pairs of sweeps over the whole factor: 0.018 were measured for a block of
/// 48³ elements on its face, 0.026 for one of 24³.
const COLUMN: f64 = 0.02;

/// Products of a step over those of a solve with a load of all wave lengths: motion and contact forces are found together, and loads of steps
/// are smooth. Over 100 steps of a block that falls 0.84 were measured with 24³ elements, 0.80 with 32³.
const SOLVES: f64 = 0.85;

/// The same with friction, whose slip forces are found with them: 1.34 times as many products were measured with 16³, 20³ and 24³ elements.
const SOLVES_WITH_FRICTION: f64 = 1.34 * SOLVES;

/// Additions and multiplications of the dense problem of a step with friction beside a factor, over the cube of its rows: 1.1 were measured for a block
/// of 24³ elements on its face, half of whose steps are in contact.
const DENSE: f64 = 1.1;

/// Bytes that the cache of a processor keeps from one iteration to the next, which come twice as fast as those of memory.
const CACHE: f64 = 16e6;

/// Iterations of Newton's method that a tangent is taken to serve.
const ITERATIONS: f64 = 3.0;

/// Residual over the load at which iterations end. Contact forces are found whole in each iteration of a step, not what they change by, so that a
/// tangent needs as many digits as a matrix that stays.
const TOLERANCE: f64 = 1e-12;

/// What the matrix of a part serves.
#[derive(Clone, Copy)]
pub(crate) struct Use<'a> {
    /// The part, of a matrix that stays the same over steps; none of a tangent, which serves some iterations.
    pub(crate) part: Option<&'a Range<usize>>,
    /// Whether the matrix has a mass: without, iterations grow with the mesh.
    pub(crate) inertia: bool,
    /// What solves with the other matrices of the system: contact forces between parts want the same for all. None of the first one.
    pub(crate) others: Option<Solver>,
    /// Who shares the products of iterations.
    pub(crate) ranks: &'a Ranks,
}

/// What solves with a matrix, where others of the system shall have the same; none of a diagonal one, which goes with each.
pub(crate) fn solver_of(operator: &Operator) -> Option<Solver> {
    match operator {
        Operator::Diagonal(_) => None,
        Operator::Factored(_) | Operator::Updated(_) => Some(Solver::Direct),
        Operator::Iterated(_) | Operator::Distributed(_) => Some(Solver::Iterative),
    }
}

/// How a matrix is solved with.
pub(crate) enum Chosen {
    /// A factor in this order.
    Direct(Ordering),
    Iterative(Box<Iterative>),
}

/// What is asked for with a matrix of so many unknowns, or taken because others have it; [`Solver::Auto`] where that which costs less is to be found.
fn wanted((system, of): (&System, Use), unknowns: usize) -> Solver {
    let few = unknowns < FEW || !of.inertia || system.needs_factor().is_some();
    match (system.nonlinear.iteration.solver, of.others) {
        (Solver::Auto, Some(same)) => same,
        (Solver::Auto, None) if few => Solver::Direct,
        (asked, _) => asked,
    }
}

/// Chooses what solves with a symmetric positive definite matrix. `nodes`: node of each unknown.
pub(crate) fn choose(
    (system, of): (&System, Use),
    matrix: &Csr,
    nodes: &[u32],
) -> Result<Chosen, AlgebraError> {
    let groups = groups(nodes);
    let place = |unknown: usize| system.x[nodes[unknown] as usize];
    let order = || Ordering::new(matrix, &groups, Some(&place));
    match wanted((system, of), matrix.n) {
        Solver::Direct => Ok(Chosen::Direct(order()?)),
        Solver::Iterative => Ok(Chosen::Iterative(Box::new(Iterative::new(
            matrix, &groups,
        )?))),
        Solver::Auto => {
            let order = order()?;
            let mut solver = Iterative::new(matrix, &groups)?;
            match pays(&mut solver, (system, of), order.work()) {
                true => Ok(Chosen::Iterative(Box::new(solver))),
                false => Ok(Chosen::Direct(order)),
            }
        }
    }
}

/// How several ranks share the rows of the matrix of some parts, where these may have iterations. Parts are numbered one after the other.
/// `coupled`: see [`shared_rows`].
pub(crate) fn rows_on_ranks(
    (system, of): (&System, Use),
    parts: &[Range<usize>],
    coupled: &[Vec<u32>],
) -> Option<SharedRows> {
    let unknowns = parts.iter().map(ExactSizeIterator::len).sum();
    let shares = of.ranks.count() > 1 && wanted((system, of), unknowns) != Solver::Direct;
    shares.then(|| shared_rows(system, parts, coupled, of.ranks))
}

/// What solves with the matrix of some parts over ranks, of which this one has some rows; none where a factor costs less. `matrix`: with
/// [`Csr::with_identity`].
pub(crate) fn choose_on_ranks(
    (system, of): (&System, Use),
    matrix: &Csr,
    rows: SharedRows,
    parts: &[Range<usize>],
) -> Result<Option<Box<Iterative>>, AlgebraError> {
    let wanted = wanted((system, of), matrix.n);
    let mut solver = Iterative::on(matrix, rows)?;
    if wanted == Solver::Auto {
        let FactorStats {
            nnz_factor, flops, ..
        } = counted(system, parts)?;
        if !pays(&mut solver, (system, of), [nnz_factor as f64, flops]) {
            return Ok(None);
        }
    }
    Ok(Some(Box::new(solver)))
}

/// The size of a factor of the matrix of some parts.
fn counted(system: &System, parts: &[Range<usize>]) -> Result<FactorStats, AlgebraError> {
    let (nodes, pattern, weights) = graph_of_nodes(system, parts);
    let place = |node: usize| system.x[nodes[node] as usize];
    FactorStats::counted(&pattern, &weights, &place)
}

/// The operator of such a solver: with the engine of the ranks, where they have one.
pub(crate) fn operator_on_ranks(
    system: &System,
    solver: Box<Iterative>,
    (matrix, parts): (&Csr, &[Range<usize>]),
) -> Result<Operator, AlgebraError> {
    let all = system.unknowns.node_of_each();
    let unknowns = || parts.iter().cloned().flatten();
    let places: Vec<[f64; 3]> = unknowns().map(|i| system.x[all[i] as usize]).collect();
    let solver = Box::new(solver.engaged((matrix, |unknown| places[unknown]))?);
    if solver.is_factored() {
        let size = counted(system, parts)?;
        let factor = Distributed::new(solver, (TOLERANCE, size));
        return Ok(Operator::Distributed(Box::new(factor)));
    }
    Ok(iterated(solver))
}

fn iterated(solver: Box<Iterative>) -> Operator {
    Operator::Iterated(Iterated {
        solver: Some(solver),
        tolerance: TOLERANCE,
        failed: None,
    })
}

/// An operator of a symmetric positive definite matrix; unknowns marked `fixed` are taken out. `nodes`: node of each unknown.
pub(crate) fn operator(
    (system, of): (&System, Use),
    matrix: &Csr,
    fixed: &[bool],
    nodes: &[u32],
) -> Result<Operator, AlgebraError> {
    let matrix = matrix.with_identity(fixed);
    match choose((system, of), &matrix, nodes)? {
        Chosen::Direct(order) => {
            let factor = Cholesky::ordered(&matrix, order)?;
            Ok(Operator::Factored(Box::new(factor)))
        }
        Chosen::Iterative(solver) => Ok(iterated(solver)),
    }
}

/// The operator of the matrix of a part, or the error that names its first node.
pub(crate) fn solvable(
    (system, of): (&System, Use),
    part: &Range<usize>,
    a: &Csr,
    held: &[bool],
    matrix: &'static str,
) -> Result<Operator, Error> {
    let nodes = &system.unknowns.node_of_each()[part.clone()];
    operator((system, of), a, held, nodes)
        .map_err(|cause| unsolvable(system, part, (matrix, cause)))
}

/// Whether iterations are predicted to cost less than a factor of so many entries, made with so many operations.
fn pays(
    solver: &mut Iterative,
    (system, of): (&System, Use),
    [entries, operations]: [f64; 2],
) -> bool {
    let uses = of.part.map_or(ITERATIONS, |_| STEPS);
    let rubs = system.tangents() > 0;
    let solves = uses * if rubs { SOLVES_WITH_FRICTION } else { SOLVES };
    let rows = ((1 + system.tangents()) * closing(system, of.part)) as f64;
    let columns = if of.part.is_some() { rows } else { 0.0 };
    // each use of a factor reads it twice, whatever its contacts
    let sweeps = 2.0 * (uses + COLUMN * columns);
    let dense = if rubs {
        uses * DENSE * rows.powi(3)
    } else {
        0.0
    };
    let direct = (operations + dense) / OPERATIONS_PER_BYTE + sweeps * 8.0 * entries;
    let n = solver.unknowns();
    let bytes = solver.bytes() as f64;
    let iteration = bytes - 0.5 * bytes.min(CACHE);
    // more of them than would cost as much as a factor are not counted
    let most = match 8.0 * entries > MOST_BYTES {
        true => usize::MAX,
        false => (direct / (solves * iteration)) as usize,
    };
    let iterations = iterations(solver, (TOLERANCE, most));
    tracing::debug!(
        "{n} unknowns: a factor would cost as much as reading {direct:.1e} bytes, or {most} iterations; iterations: {iterations:?}",
    );
    iterations.is_some()
}

/// Contact points on a part, or on any, that close within the steps which a matrix is taken to serve, if all moves on as it does at first. A
/// point that loads alone bring to its contact is not among them.
fn closing(system: &System, part: Option<&Range<usize>>) -> usize {
    let (u, v) = (&system.initial.displacement, &system.initial.velocity);
    let places = system.places(0.0, u, &system.initial.frames);
    let mut pairing = Pairing::default();
    pairing.clear();
    for contact in &system.contacts {
        contact.pair_fully(&places, &mut Search::default(), &mut pairing);
    }
    let rows = &pairing.rows;
    let closes = |point: &usize| {
        let rate = rows.product(*point, v) + rows.rate(*point);
        rows.gap(*point) + STEPS * system.dt * rate.min(0.0) <= system.tolerance_at(*point)
    };
    let inside = |point: &usize| {
        let mut unknowns = rows.row(*point).0.iter();
        part.is_none_or(|part| unknowns.any(|unknown| part.contains(&(*unknown as usize))))
    };
    (0..rows.len()).filter(closes).filter(inside).count()
}

/// Whether a factor of a matrix fits in memory.
pub(crate) fn fits(system: &System, matrix: &Csr, nodes: &[u32]) -> Result<bool, AlgebraError> {
    let place = |unknown: usize| system.x[nodes[unknown] as usize];
    let order = Ordering::new(matrix, &groups(nodes), Some(&place))?;
    Ok(8.0 * order.work()[0] <= MOST_BYTES)
}

/// Iterations of a solve with some load up to a tolerance; none if they do not end or are more than `most`.
fn iterations(solver: &mut Iterative, (tolerance, most): (f64, usize)) -> Option<usize> {
    // a fixed load with all wave lengths: numbers of a linear congruence
    let next = |state: u64| {
        state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1)
    };
    let states = std::iter::successors(Some(1), |state| Some(next(*state)));
    let n = solver.unknowns();
    let load: Vec<f64> = states
        .take(n)
        .map(|state: u64| (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5)
        .collect();
    let mut x = vec![0.0; n];
    solver.solve_within(&load, &mut x, (tolerance, most)).ok()
}
