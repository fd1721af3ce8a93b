//! The effective matrix of one connected part, as the driver and the interface problem see it.

use std::ops::Range;

use carom_algebra::Error as AlgebraError;
use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::solver::{Cholesky, FactorStats, Ordering, Response, SparseRow, gram};

use crate::at_rows::{AtRows, groups};
use crate::distributed::Distributed;
use crate::error::{Error, MeshNode};
use crate::iterated::Iterated;
use crate::low_rank::LowRank;
use crate::system::{LinkRow, System, push_cliques};

/// A of the step for one connected part.
///
/// `begin` is the first half of a solve, `respond` the same half for the rows of N, `end` the second half. With
/// A = L Lᵀ: y = L⁻¹ r, Y = L⁻¹ Nᵀ, x = L⁻ᵀ (y + Y P), so that a step with contact costs one forward and one
/// backward sweep, and N A⁻¹ Nᵀ = Yᵀ Y. A diagonal A has y = A⁻¹ r and Y = A⁻¹ Nᵀ instead.
pub(crate) enum Operator {
    /// Lumped mass of an explicit scheme; unknowns that are held have an infinite entry.
    Diagonal(Vec<f64>),
    /// Sparse Cholesky factor.
    Factored(Box<Cholesky>),
    /// With a part of low rank: y = (A + B Bᵀ)⁻¹ r but for the backward sweep, Y = L⁻¹ Nᵀ beside its products with H.
    Updated(LowRank),
    /// A matrix that is solved with by iterations: y = A⁻¹ r, and Y is no more than Nᵀ. Forces of rows are found together with their motion, which is
    /// added to y at once.
    Iterated(Iterated),
    /// A factor that an engine has over all ranks: y = A⁻¹ r, and of Y the entries at the unknowns of rows; forces of rows are kept beside y.
    Distributed(Box<Distributed>),
}

/// What `respond` keeps of one row.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Column {
    /// The row itself: unknowns of the part and coefficients.
    Row(SparseRow),
    /// L⁻¹ Nᵀ.
    Factored(Response),
    /// L⁻¹ Nᵀ and Hᵀ L⁻¹ Nᵀ.
    Updated(Response, Vec<f64>),
    /// The row, and A⁻¹ Nᵀ at the unknowns of the rows met up to it.
    Moved(SparseRow, Vec<f64>),
}

impl Operator {
    /// The inverse of a diagonal matrix; unknowns marked `fixed` do not move.
    pub(crate) fn diagonal(diagonal: &[f64], fixed: &[bool]) -> Operator {
        let entries = diagonal.iter().zip(fixed);
        Operator::Diagonal(
            entries
                .map(|(&a, &fixed)| if fixed { f64::INFINITY } else { a })
                .collect(),
        )
    }

    /// y from r.
    pub(crate) fn begin(&mut self, r: &[f64], y: &mut [f64]) {
        match self {
            Operator::Diagonal(a) => {
                for i in 0..y.len() {
                    y[i] = r[i] / a[i];
                }
            }
            Operator::Factored(factor) => factor.forward(r, y),
            Operator::Updated(updated) => updated.begin(r, y),
            Operator::Iterated(iterated) => iterated.begin(r, y),
            Operator::Distributed(factor) => factor.begin(r, y),
        }
    }

    /// Columns of rows, which name unknowns of the part.
    pub(crate) fn respond(&mut self, rows: Vec<SparseRow>) -> Vec<Column> {
        match self {
            Operator::Diagonal(_) | Operator::Iterated(_) => {
                rows.into_iter().map(Column::Row).collect()
            }
            Operator::Factored(factor) => factor
                .respond(&rows)
                .into_iter()
                .map(Column::Factored)
                .collect(),
            Operator::Updated(updated) => {
                let responses = updated.factor.respond(&rows).into_iter();
                let columns = responses.map(|response| {
                    let products = updated.products(&response);
                    Column::Updated(response, products)
                });
                columns.collect()
            }
            Operator::Distributed(factor) => {
                let moved = factor.respond(rows).into_iter();
                moved
                    .map(|(row, motion)| Column::Moved(row, motion))
                    .collect()
            }
        }
    }

    /// N A⁻¹ Nᵀ of two columns.
    pub(crate) fn dot(&self, one: &Column, other: &Column) -> f64 {
        match (self, one, other) {
            (Operator::Diagonal(a), Column::Row(one), Column::Row(other)) => {
                let mut sum = 0.0;
                for (i, n) in one.dofs.iter().zip(&one.coefficients) {
                    for (j, m) in other.dofs.iter().zip(&other.coefficients) {
                        if i == j {
                            sum += n * m / a[*i as usize];
                        }
                    }
                }
                sum
            }
            (Operator::Factored(_), Column::Factored(one), Column::Factored(other)) => {
                one.dot(other)
            }
            (Operator::Updated(_), Column::Updated(one, g), Column::Updated(other, h)) => {
                let products = g.iter().zip(h).map(|(g, h)| g * h);
                one.dot(other) - products.sum::<f64>()
            }
            (Operator::Distributed(factor), Column::Moved(one, x), Column::Moved(other, y)) => {
                factor.dot((one, x), (other, y))
            }
            _ => unreachable!("columns are made by their own operator"),
        }
    }

    /// N A⁻¹ Nᵀ of all pairs of some columns, row-major, with the bits of `dot`.
    pub(crate) fn gram(&self, columns: &[&Column]) -> Vec<f64> {
        let responses: Vec<_> = columns
            .iter()
            .filter_map(|column| match column {
                Column::Factored(response) => Some(response),
                Column::Row(_) | Column::Updated(..) | Column::Moved(..) => None,
            })
            .collect();
        if responses.len() == columns.len() {
            return gram(&responses);
        }
        // the order of the two decides on the last bits
        let n = columns.len();
        let entry = |k: usize| self.dot(columns[(k / n).min(k % n)], columns[(k / n).max(k % n)]);
        (0..n * n).map(entry).collect()
    }

    /// N A⁻¹ r from the y of `begin`.
    pub(crate) fn free(&self, column: &Column, y: &[f64]) -> f64 {
        match column {
            Column::Row(row) | Column::Moved(row, _) => row
                .dofs
                .iter()
                .zip(&row.coefficients)
                .map(|(&i, n)| n * y[i as usize])
                .sum(),
            Column::Factored(response) | Column::Updated(response, _) => response.dot_dense(y),
        }
    }

    /// Adds the force of one row to y.
    pub(crate) fn add(&mut self, column: &Column, force: f64, y: &mut [f64]) {
        match (self, column) {
            (Operator::Diagonal(a), Column::Row(row)) => {
                for (&i, n) in row.dofs.iter().zip(&row.coefficients) {
                    y[i as usize] += force * n / a[i as usize];
                }
            }
            (Operator::Factored(_), Column::Factored(response)) => response.add_scaled(force, y),
            (Operator::Updated(updated), Column::Updated(response, products)) => {
                updated.add((response, products), force, y);
            }
            (Operator::Distributed(factor), Column::Moved(row, _)) => factor.push(row, force),
            (Operator::Iterated(_), Column::Row(_)) => {}
            _ => unreachable!("columns are made by their own operator"),
        }
    }

    /// x from y, which is scratch afterwards.
    pub(crate) fn end(&mut self, y: &mut [f64], x: &mut [f64]) {
        match self {
            Operator::Diagonal(_) | Operator::Iterated(_) => x.copy_from_slice(y),
            Operator::Factored(factor) => factor.backward(y, x),
            Operator::Updated(updated) => updated.factor.backward(y, x),
            Operator::Distributed(factor) => factor.end(y, x),
        }
    }

    /// Size and use of the factor, if there is one.
    pub(crate) fn stats(&self) -> Option<&FactorStats> {
        match self {
            Operator::Diagonal(_) | Operator::Iterated(_) => None,
            Operator::Distributed(factor) => Some(factor.stats()),
            Operator::Factored(factor) => Some(factor.stats()),
            Operator::Updated(updated) => Some(updated.factor.stats()),
        }
    }

    /// Products with a matrix that is solved with by iterations, so far.
    pub(crate) fn products(&self) -> usize {
        match self {
            Operator::Iterated(iterated) => iterated.solver.as_ref().map_or(0, |s| s.products()),
            Operator::Diagonal(_)
            | Operator::Factored(_)
            | Operator::Updated(_)
            | Operator::Distributed(_) => 0,
        }
    }

    /// With B Bᵀ, of these columns of B over the unknowns of the part, in the matrix.
    ///
    /// # Errors
    /// Columns that are not finite.
    pub(crate) fn with_columns(self, columns: &[Vec<f64>]) -> Result<Operator, AlgebraError> {
        match self {
            Operator::Factored(factor) if !columns.is_empty() => {
                Ok(Operator::Updated(LowRank::new(factor, columns)?))
            }
            other => Ok(other),
        }
    }
}

/// The operators of groups of connected parts: of a part alone, or of parts that contact forces join.
pub struct Operators {
    pub(crate) groups: Vec<Group>,
    parts: Vec<Range<usize>>,
    /// Group of each part, and where its unknowns begin there.
    homes: Vec<(usize, usize)>,
}

/// Connected parts with one operator.
pub(crate) struct Group {
    /// Their unknowns.
    pub(crate) parts: Vec<Range<usize>>,
    /// The place of these unknowns in the y of `begin`, one part after the other.
    pub(crate) place: Range<usize>,
    /// `None` before the matrix is factored.
    pub(crate) operator: Option<Operator>,
    /// Room for their entries of a system vector, of more than one part.
    gathered: Vec<f64>,
}

impl Group {
    pub(crate) fn begin(&mut self, r: &[f64], y: &mut [f64]) {
        let Some(operator) = &mut self.operator else {
            return;
        };
        let y = &mut y[self.place.clone()];
        if let [part] = &self.parts[..] {
            return operator.begin(&r[part.clone()], y);
        }
        self.gathered.clear();
        for part in &self.parts {
            self.gathered.extend_from_slice(&r[part.clone()]);
        }
        operator.begin(&self.gathered, y);
    }

    fn end(&mut self, y: &mut [f64], x: &mut [f64]) {
        let Some(operator) = &mut self.operator else {
            return;
        };
        let y = &mut y[self.place.clone()];
        if let [part] = &self.parts[..] {
            return operator.end(y, &mut x[part.clone()]);
        }
        self.gathered.resize(y.len(), 0.0);
        operator.end(y, &mut self.gathered);
        let mut rest = &self.gathered[..];
        for part in &self.parts {
            let (own, others) = rest.split_at(part.len());
            x[part.clone()].copy_from_slice(own);
            rest = others;
        }
    }
}

impl Operators {
    /// `mass_factor` M + `stiffness_factor` K of every part, ready to solve with; `matrix`: its name for messages.
    ///
    /// # Errors
    /// The matrix of a part is not positive definite.
    pub fn new(
        system: &System,
        mass_factor: f64,
        stiffness_factor: f64,
        matrix: &'static str,
    ) -> Result<Operators, Error> {
        let mut operators = Operators::of(&system.parts, single(system.parts.len()));
        let factors = |_: usize| stiffness_factor;
        for group in &mut operators.groups {
            let part = &group.parts[0];
            let operator = of_part(system, part, mass_factor, &factors, matrix)?;
            group.operator = Some(operator);
        }
        Ok(operators)
    }

    /// Room for the operators of groups of parts; every part is in one.
    pub(crate) fn of(parts: &[Range<usize>], groups: Vec<Vec<usize>>) -> Operators {
        let mut operators = Operators {
            groups: Vec::new(),
            parts: parts.to_vec(),
            homes: vec![(0, 0); parts.len()],
        };
        operators.regroup(0, groups);
        operators
    }

    /// Replaces the groups from the number `first` on; returns those that were there.
    pub(crate) fn regroup(&mut self, first: usize, groups: Vec<Vec<usize>>) -> Vec<Group> {
        let old = self.groups.split_off(first);
        for parts in groups {
            let begin = self.groups.last().map_or(0, |group| group.place.end);
            let mut offset = 0;
            for &part in &parts {
                self.homes[part] = (self.groups.len(), offset);
                offset += self.parts[part].len();
            }
            self.groups.push(Group {
                parts: parts.iter().map(|&part| self.parts[part].clone()).collect(),
                place: begin..begin + offset,
                operator: None,
                gathered: Vec::new(),
            });
        }
        old
    }

    /// `begin` on every group; `r` of the whole system.
    pub fn begin(&mut self, r: &[f64], y: &mut [f64]) {
        for group in &mut self.groups {
            group.begin(r, y);
        }
    }

    /// `end` on every group; `x` of the whole system.
    pub fn end(&mut self, y: &mut [f64], x: &mut [f64]) {
        for group in &mut self.groups {
            group.end(y, x);
        }
    }

    /// The group of an unknown, and its number there.
    pub(crate) fn home(&self, unknown: usize) -> (usize, usize) {
        let part = self.parts.partition_point(|part| part.end <= unknown);
        let (group, offset) = self.homes[part];
        (group, offset + unknown - self.parts[part].start)
    }

    /// What the rows with this unknown share with others through the matrices: the unknown itself where its matrix is diagonal, else
    /// its factor. Below [`Operators::keys`].
    pub(crate) fn key(&self, unknown: usize) -> usize {
        let (group, _) = self.home(unknown);
        match self.operator(group) {
            Operator::Diagonal(_) => unknown,
            Operator::Factored(_)
            | Operator::Updated(_)
            | Operator::Iterated(_)
            | Operator::Distributed(_) => self.unknowns() + group,
        }
    }

    /// Number of such keys.
    pub(crate) fn keys(&self) -> usize {
        self.unknowns() + self.groups.len()
    }

    fn unknowns(&self) -> usize {
        self.parts.last().map_or(0, |part| part.end)
    }

    /// The operator of a group.
    pub(crate) fn operator(&self, group: usize) -> &Operator {
        match &self.groups[group].operator {
            Some(operator) => operator,
            None => unreachable!("no group answers before its matrix is factored"),
        }
    }

    /// Columns of rows, which name unknowns of the group.
    pub(crate) fn respond(&mut self, group: usize, rows: Vec<SparseRow>) -> Vec<Column> {
        let operator = &mut self.groups[group].operator;
        operator
            .as_mut()
            .map_or(Vec::new(), |operator| operator.respond(rows))
    }

    /// The part of the y of `begin` that is a group's.
    pub(crate) fn of_group<'a>(&self, group: usize, y: &'a [f64]) -> &'a [f64] {
        &y[self.groups[group].place.clone()]
    }

    /// Adds the force of one row to the y of `begin`.
    pub(crate) fn add(&mut self, group: usize, column: &Column, force: f64, y: &mut [f64]) {
        let group = &mut self.groups[group];
        match &mut group.operator {
            Some(operator) => operator.add(column, force, &mut y[group.place.clone()]),
            None => unreachable!("no group is pushed before its matrix is factored"),
        }
    }

    /// Products with matrices that are solved with by iterations, so far.
    pub(crate) fn products(&self) -> usize {
        let operators = self.groups.iter().filter_map(|g| g.operator.as_ref());
        operators.map(Operator::products).sum()
    }

    /// The place of a row of a group in the y of `begin`.
    pub(crate) fn place(&self, group: usize) -> usize {
        self.groups[group].place.start
    }

    /// Sizes and uses of the factors.
    pub(crate) fn stats(&self) -> impl Iterator<Item = &FactorStats> {
        let operators = self.groups.iter().filter_map(|g| g.operator.as_ref());
        operators.filter_map(Operator::stats)
    }
}

/// Each of some parts for itself.
pub(crate) fn single(parts: usize) -> Vec<Vec<usize>> {
    (0..parts).map(|part| vec![part]).collect()
}

/// `mass_factor` M + `stiffness_factors` K of one part, with a factor for each body; `matrix`: its name for messages.
///
/// # Errors
/// The matrix is not positive definite.
pub(crate) fn of_part(
    system: &System,
    part: &Range<usize>,
    mass_factor: f64,
    stiffness_factors: &dyn Fn(usize) -> f64,
    matrix: &'static str,
) -> Result<Operator, Error> {
    let explicit = (0..system.bodies.len()).all(|body| stiffness_factors(body) == 0.0);
    let mut held = system.fixed[part.clone()].to_vec();
    if explicit {
        // nothing moves what has neither mass nor stiffness
        for &unknown in &system.massless {
            if part.contains(&(unknown as usize)) {
                held[unknown as usize - part.start] = true;
            }
        }
    }
    if explicit && !system.mass.couples(part) {
        let lumped = system.mass.lumped[part.clone()].iter();
        let diagonal: Vec<f64> = lumped.map(|m| mass_factor * m).collect();
        return Ok(Operator::diagonal(&diagonal, &held));
    }
    let a = assembled(system, part, [mass_factor, 0.0], stiffness_factors);
    factored(system, part, &a, &held, matrix)
}

/// The error of the matrix of a part, which names the first node of the part.
pub(crate) fn unsolvable(
    system: &System,
    part: &Range<usize>,
    (matrix, cause): (&'static str, AlgebraError),
) -> Error {
    Error::Factor {
        matrix,
        node: MeshNode::of(system, system.unknowns.node(part.start)),
        cause,
    }
}

/// The factor of the matrix of a part, or the error that names its first node.
pub(crate) fn factored(
    system: &System,
    part: &Range<usize>,
    a: &Csr,
    held: &[bool],
    matrix: &'static str,
) -> Result<Operator, Error> {
    let nodes = &system.unknowns.node_of_each()[part.clone()];
    let place = |unknown: usize| system.x[nodes[unknown] as usize];
    let free = a.with_identity(held);
    let factor = Ordering::new(&free, &groups(nodes), Some(&place))
        .and_then(|order| Cholesky::ordered(&free, order))
        .map_err(|cause| unsolvable(system, part, (matrix, cause)))?;
    Ok(Operator::Factored(Box::new(factor)))
}

/// `mass` M + `damping` C + `stiffness_factors` K of one part, C that of dashpots, with a factor of K for each body.
pub fn assembled(
    system: &System,
    part: &Range<usize>,
    factors: [f64; 2],
    stiffness_factors: &dyn Fn(usize) -> f64,
) -> Csr {
    assembled_at((system, &AtRows::all()), part, factors, stiffness_factors)
}

/// The same in some rows.
pub(crate) fn assembled_at(
    (system, at): (&System, &AtRows),
    part: &Range<usize>,
    [mass, damping]: [f64; 2],
    stiffness_factors: &dyn Fn(usize) -> f64,
) -> Csr {
    let bodies = 0..system.bodies.len();
    let mut cliques = Cliques::new();
    for k in bodies.clone() {
        push_cliques(at.body(system, k), &system.unknowns, part, &mut cliques);
    }
    push_rows(system, part, &mut cliques);
    let mut a = at.matrix(part, &cliques);
    for k in bodies {
        let factors = [stiffness_factors(k), damping, 0.0];
        at.body(system, k).assemble(factors, part, &mut a);
    }
    system.mass.add_to(mass, part, part.start, &mut a);
    a
}

/// Adds the unknowns of each row of constraints inside `range`, counted from its start: the pattern that [`add_rows`] needs. Nothing without a static
/// stage.
pub(crate) fn push_rows(system: &System, range: &Range<usize>, cliques: &mut Cliques) {
    for row in rows_within((system, &system.links.rows), range) {
        let own: Vec<u32> = row.iter().map(|(i, _)| i - range.start as u32).collect();
        cliques.push(&own);
    }
}

/// Adds ρ Cᵀ C of the rows of constraints inside `range` to the matrix of a static step, which has no mass: a body that constraints alone hold has a matrix that is
/// positive definite then, and with C x = 0 the solution is the same for each ρ > 0. ρ is the least stiffness of an unknown of the row along it, so that
/// the condition stays that of the bodies. `begin`: the unknown of the first row of `a`.
pub(crate) fn add_rows(
    rows: (&System, &[LinkRow]),
    range: &Range<usize>,
    begin: usize,
    a: &mut Csr,
) {
    for row in rows_within(rows, range) {
        let stiffness = row.iter().filter(|(_, c)| *c != 0.0).map(|&(i, c)| {
            let i = i as usize - begin;
            a.get(i, i) / (c * c)
        });
        let least = stiffness.filter(|k| *k > 0.0).fold(f64::INFINITY, f64::min);
        let factor = if least.is_finite() { least } else { 1.0 };
        for &(i, c) in row {
            for &(j, d) in row {
                a.add(i as usize - begin, j as usize - begin, factor * c * d);
            }
        }
    }
}

fn rows_within<'a>(
    (system, rows): (&'a System, &'a [LinkRow]),
    range: &'a Range<usize>,
) -> impl Iterator<Item = &'a LinkRow> + 'a {
    let staged = system.nonlinear.preload.is_some();
    let inside = |row: &&LinkRow| row.iter().all(|(i, _)| range.contains(&(*i as usize)));
    rows.iter().filter(move |_| staged).filter(inside)
}
