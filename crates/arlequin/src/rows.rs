//! The rows of the coupling condition, and what can be asked of them.

use std::collections::{BTreeMap, BTreeSet};

use carom_algebra::{csr::Csr, pattern::Cliques, solver::Cholesky};

use crate::error::Error;

/// One coefficient of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// Node of the mesh.
    pub node: u32,
    /// Component of the velocity there: below the dimension of the mesh, or from there on a rotation.
    pub component: u32,
    /// Coefficient, in m^dim (dimensionless for a matching interface).
    pub coefficient: f64,
}

/// What the axes of a node do in a row whose mediator turns: Σ_ac G_ac (R_A e_a)·(R_B e_c), with the rotations R_A of the node of the mediator and R_B of
/// this node, and the axes e of coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisProducts {
    /// Node of the mesh, B.
    pub node: u32,
    /// G, in the unit of the coefficients times m.
    pub factors: [[f64; 3]; 3],
}

impl AxisProducts {
    /// Coefficients of small rotations of the node: for G = u ⊗ v they are v × u.
    pub(crate) fn of_small_turns(factors: &[[f64; 3]; 3]) -> [f64; 3] {
        [[2, 1], [0, 2], [1, 0]].map(|[a, c]: [usize; 2]| factors[a][c] - factors[c][a])
    }
}

/// One row: Σ inner terms · v_c - Σ outer terms · v_s = 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row {
    /// Node of the mediator function.
    pub node: u32,
    /// Component of the mediator.
    pub component: u32,
    /// C_c = <μ, φ_c>, on nodes of the inner model, sorted.
    pub inner: Vec<Term>,
    /// C_s = <μ, φ_s>, on nodes of the outer model, sorted.
    pub outer: Vec<Term>,
    /// Of a shell, what the coefficients of rotations are the derivatives of, with the sign of inner less outer terms.
    pub axes: Vec<AxisProducts>,
}

impl Row {
    /// The same row of another component.
    fn of(&self, component: u32) -> Row {
        let side = |terms: &[Term]| {
            let terms = terms.iter();
            terms.map(|term| Term { component, ..*term }).collect()
        };
        Row {
            node: self.node,
            component,
            inner: side(&self.inner),
            outer: side(&self.outer),
            axes: Vec::new(),
        }
    }

    /// Σ terms · field, the field given by node and component.
    pub fn apply(terms: &[Term], field: impl Fn(u32, usize) -> f64) -> f64 {
        let value = |t: &Term| t.coefficient * field(t.node, t.component as usize);
        terms.iter().map(value).sum()
    }
}

/// A mediator function with a sliver of support in S.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sliver {
    /// Its node.
    pub node: u32,
    /// Fraction of its support that lies in S.
    pub fraction: f64,
    /// The function that took it over; `None` if it was dropped.
    pub into: Option<u32>,
}

/// The rows of one overlap or interface.
#[derive(Clone, Debug, PartialEq)]
pub struct Rows {
    /// Sorted by node, then by component.
    pub rows: Vec<Row>,
    /// Functions merged or dropped for want of support.
    pub slivers: Vec<Sliver>,
}

/// Entries (row, coefficient) of each unknown: outer model or not, node, component.
type Columns = BTreeMap<(bool, u32, u32), Vec<(u32, f64)>>;

/// How far some rows are from dependence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rank {
    /// Least eigenvalue of the Gram matrix of the rows, each scaled to length one: 0 if they are dependent, at most 1.
    pub smallest: f64,
    /// Node and component of the row that is most involved.
    pub weakest: (u32, u32),
}

impl Rows {
    /// Drops the rows of some mediator unknowns (node, component) and names those that were there.
    ///
    /// For unknowns that supports block in both models, and those of another overlap ([`Rows::shared`]).
    pub fn drop(&mut self, unwanted: impl Fn(u32, u32) -> bool) -> Vec<(u32, u32)> {
        let unknown = |row: &Row| (row.node, row.component);
        let (gone, kept): (Vec<Row>, Vec<Row>) = std::mem::take(&mut self.rows)
            .into_iter()
            .partition(|row| unwanted(row.node, row.component));
        self.rows = kept;
        gone.iter().map(unknown).collect()
    }

    /// The same rows with those of the rotations at the same nodes, which follow the `dim` translations: of two beams.
    #[must_use]
    pub fn with_rotations(mut self, dim: u32) -> Rows {
        let axes = if dim == 2 { 2..3 } else { 3..6 };
        let first = self.rows.iter().filter(|row| row.component == 0);
        let turned = first.flat_map(|row| axes.clone().map(|axis| row.of(axis)));
        let turned: Vec<Row> = turned.collect();
        self.rows.extend(turned);
        self.rows.sort_by_key(|row| (row.node, row.component));
        self
    }

    /// Mediator unknowns that another overlap has too.
    pub fn shared(&self, other: &Rows) -> BTreeSet<(u32, u32)> {
        let unknowns = |rows: &Rows| -> BTreeSet<(u32, u32)> {
            rows.rows
                .iter()
                .map(|row| (row.node, row.component))
                .collect()
        };
        unknowns(self)
            .intersection(&unknowns(other))
            .copied()
            .collect()
    }

    /// How far the rows (C_c, -C_s) are from dependence, on the unknowns that are free.
    ///
    /// The least eigenvalue of G = C Cᵀ with unit diagonal, by inverse iteration on its sparse factor. `blocked`: whether
    /// supports hold an unknown (node, component). Without rows the answer is 1. A row without a free unknown gives 0.
    /// Errors: the factorisation runs out of memory.
    pub fn rank(&self, blocked: impl Fn(u32, u32) -> bool) -> Result<Rank, Error> {
        let n = self.rows.len();
        let name = |i: usize| (self.rows[i].node, self.rows[i].component);
        let (columns, lengths) = self.columns(blocked);
        if n == 0 {
            return Ok(Rank {
                smallest: 1.0,
                weakest: (0, 0),
            });
        }
        if let Some(i) = lengths.iter().position(|&length| length == 0.0) {
            return Ok(Rank {
                smallest: 0.0,
                weakest: name(i),
            });
        }
        let mut cliques = Cliques::new();
        for column in columns.values() {
            cliques.push(&column.iter().map(|c| c.0).collect::<Vec<u32>>());
        }
        let mut gram = Csr::from_cliques(n, &cliques);
        for column in columns.values() {
            let unknowns: Vec<u32> = column.iter().map(|c| c.0).collect();
            let scaled: Vec<f64> = column.iter().map(|c| c.1 / lengths[c.0 as usize]).collect();
            let block = scaled
                .iter()
                .flat_map(|a| scaled.iter().map(move |b| a * b));
            gram.add_block(&unknowns, &block.collect::<Vec<f64>>());
        }
        let groups: Vec<u32> = (0..n as u32).collect();
        match Cholesky::new(&gram, &groups) {
            Ok(mut factor) => {
                let (smallest, weakest) = least_eigenvalue(&mut factor, n);
                Ok(Rank {
                    smallest,
                    weakest: name(weakest),
                })
            }
            Err(carom_algebra::Error::NotPositiveDefinite { unknown, .. }) => Ok(Rank {
                smallest: 0.0,
                weakest: name(unknown),
            }),
            Err(error) => Err(error.into()),
        }
    }

    /// Entries (row, coefficient) of every free unknown, those of the two models apart, and the length of each row.
    fn columns(&self, blocked: impl Fn(u32, u32) -> bool) -> (Columns, Vec<f64>) {
        let mut columns = Columns::new();
        let mut squares = vec![0.0; self.rows.len()];
        for (i, row) in self.rows.iter().enumerate() {
            for (side, terms) in [(false, &row.inner), (true, &row.outer)] {
                for t in terms.iter().filter(|t| !blocked(t.node, t.component)) {
                    let sign = if side { -1.0 } else { 1.0 };
                    let column = columns.entry((side, t.node, t.component)).or_default();
                    column.push((i as u32, sign * t.coefficient));
                    squares[i] += t.coefficient * t.coefficient;
                }
            }
        }
        (columns, squares.iter().map(|s: &f64| s.sqrt()).collect())
    }
}

/// Least eigenvalue of a factored matrix and the largest entry of its vector, by inverse iteration from a vector without
/// symmetry.
fn least_eigenvalue(factor: &mut Cholesky, n: usize) -> (f64, usize) {
    let mut x: Vec<f64> = (0..n).map(|i| 1.0 + (i as f64 * 0.7).sin()).collect();
    let mut value = 0.0;
    for _ in 0..60 {
        let length = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        x.iter_mut().for_each(|x| *x /= length);
        factor.solve(&mut x);
        let next = 1.0 / x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let settled = (next - value).abs() <= 1e-6 * next;
        value = next;
        if settled {
            break;
        }
    }
    let weakest = (1..n).fold(
        0,
        |best, i| if x[i].abs() > x[best].abs() { i } else { best },
    );
    (value, weakest)
}
