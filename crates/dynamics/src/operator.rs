//! The effective matrix of one connected part, as the driver and the interface problem see it.

use std::ops::Range;

use carom_algebra::Error as AlgebraError;
use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::solver::{Cholesky, FactorStats, Response, SparseRow, gram};

use crate::error::Error;
use crate::system::{System, push_cliques};

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
}

/// What `respond` keeps of one row.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Column {
    /// The row itself: unknowns of the part and coefficients.
    Diagonal(SparseRow),
    /// L⁻¹ Nᵀ.
    Factored(Response),
}

impl Operator {
    /// Factorises a symmetric positive definite matrix; unknowns marked `fixed` are taken out.
    /// `nodes`: node of each unknown.
    pub(crate) fn factored(
        matrix: &Csr,
        fixed: &[bool],
        nodes: &[u32],
    ) -> Result<Operator, AlgebraError> {
        let factor = Cholesky::new(&matrix.with_identity(fixed), &groups(nodes))?;
        Ok(Operator::Factored(Box::new(factor)))
    }

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
        }
    }

    /// Columns of rows, which name unknowns of the part.
    pub(crate) fn respond(&mut self, rows: Vec<SparseRow>) -> Vec<Column> {
        match self {
            Operator::Diagonal(_) => rows.into_iter().map(Column::Diagonal).collect(),
            Operator::Factored(factor) => factor
                .respond(&rows)
                .into_iter()
                .map(Column::Factored)
                .collect(),
        }
    }

    /// N A⁻¹ Nᵀ of two columns.
    pub(crate) fn dot(&self, one: &Column, other: &Column) -> f64 {
        match (self, one, other) {
            (Operator::Diagonal(a), Column::Diagonal(one), Column::Diagonal(other)) => {
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
            _ => unreachable!("columns are made by their own operator"),
        }
    }

    /// N A⁻¹ Nᵀ of all pairs of some columns, row-major, with the bits of `dot`.
    pub(crate) fn gram(&self, columns: &[&Column]) -> Vec<f64> {
        let responses: Vec<_> = columns
            .iter()
            .filter_map(|column| match column {
                Column::Factored(response) => Some(response),
                Column::Diagonal(_) => None,
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
            Column::Diagonal(row) => row
                .dofs
                .iter()
                .zip(&row.coefficients)
                .map(|(&i, n)| n * y[i as usize])
                .sum(),
            Column::Factored(response) => response.dot_dense(y),
        }
    }

    /// Adds the force of one row to y.
    pub(crate) fn add(&self, column: &Column, force: f64, y: &mut [f64]) {
        match (self, column) {
            (Operator::Diagonal(a), Column::Diagonal(row)) => {
                for (&i, n) in row.dofs.iter().zip(&row.coefficients) {
                    y[i as usize] += force * n / a[i as usize];
                }
            }
            (Operator::Factored(_), Column::Factored(response)) => response.add_scaled(force, y),
            _ => unreachable!("columns are made by their own operator"),
        }
    }

    /// x from y, which is scratch afterwards.
    pub(crate) fn end(&mut self, y: &mut [f64], x: &mut [f64]) {
        match self {
            Operator::Diagonal(_) => x.copy_from_slice(y),
            Operator::Factored(factor) => factor.backward(y, x),
        }
    }

    /// Size and use of the factor, if there is one.
    pub(crate) fn stats(&self) -> Option<&FactorStats> {
        match self {
            Operator::Diagonal(_) => None,
            Operator::Factored(factor) => Some(factor.stats()),
        }
    }
}

/// The operators of all parts.
pub(crate) struct Operators {
    pub(crate) parts: Vec<Range<usize>>,
    pub(crate) operators: Vec<Operator>,
}

impl Operators {
    /// `mass_factor` M + `stiffness_factor` K of every part, ready to solve with; `matrix`: its name for messages.
    ///
    /// # Errors
    /// The matrix of a part is not positive definite.
    pub(crate) fn new(
        system: &System,
        mass_factor: f64,
        stiffness_factor: f64,
        matrix: &'static str,
    ) -> Result<Operators, Error> {
        let mut held = system.fixed.clone();
        if stiffness_factor == 0.0 {
            // nothing moves what has neither mass nor stiffness
            for &unknown in &system.massless {
                held[unknown as usize] = true;
            }
        }
        let operator = |part: &Range<usize>| {
            let fixed = &held[part.clone()];
            if stiffness_factor == 0.0 && system.mass.consistent.is_none() {
                let lumped = system.mass.lumped[part.clone()].iter();
                let diagonal: Vec<f64> = lumped.map(|m| mass_factor * m).collect();
                return Ok(Operator::diagonal(&diagonal, fixed));
            }
            let a = assembled(system, part, mass_factor, stiffness_factor);
            let nodes = &system.unknowns.node_of_each()[part.clone()];
            let node = system.mesh_node[nodes[0] as usize];
            Operator::factored(&a, fixed, nodes).map_err(|cause| Error::Factor {
                matrix,
                node,
                cause,
            })
        };
        let operators = system
            .parts
            .iter()
            .map(operator)
            .collect::<Result<_, _>>()?;
        Ok(Operators {
            parts: system.parts.clone(),
            operators,
        })
    }

    /// One operator for the whole system.
    pub(crate) fn whole(operator: Operator, unknowns: usize) -> Operators {
        Operators {
            parts: std::iter::once(0..unknowns).collect(),
            operators: vec![operator],
        }
    }

    /// `begin` on every part; vectors of the whole system.
    pub(crate) fn begin(&mut self, r: &[f64], y: &mut [f64]) {
        for (part, operator) in self.parts.iter().zip(&mut self.operators) {
            operator.begin(&r[part.clone()], &mut y[part.clone()]);
        }
    }

    /// `end` on every part.
    pub(crate) fn end(&mut self, y: &mut [f64], x: &mut [f64]) {
        for (part, operator) in self.parts.iter().zip(&mut self.operators) {
            operator.end(&mut y[part.clone()], &mut x[part.clone()]);
        }
    }

    /// The part that an unknown belongs to.
    pub(crate) fn part_of(&self, unknown: usize) -> usize {
        self.parts.partition_point(|part| part.end <= unknown)
    }
}

/// Numbers without gaps of the nodes of unknowns, nodes ascending.
fn groups(nodes: &[u32]) -> Vec<u32> {
    let mut number = 0;
    let mut last = nodes.first().copied();
    let group = |&node: &u32| {
        if last != Some(node) {
            (last, number) = (Some(node), number + 1);
        }
        number
    };
    nodes.iter().map(group).collect()
}

/// `mass_factor` M + `stiffness_factor` K of one part.
pub(crate) fn assembled(
    system: &System,
    part: &Range<usize>,
    mass_factor: f64,
    stiffness_factor: f64,
) -> Csr {
    let mut cliques = Cliques::new();
    for body in &system.bodies {
        push_cliques(body, &system.unknowns, part, &mut cliques);
    }
    let mut a = Csr::from_cliques(part.len(), &cliques);
    for body in &system.bodies {
        body.assemble(stiffness_factor, 0.0, part, &mut a);
    }
    system.mass.add_to(mass_factor, part, &mut a);
    a
}
