//! The condensed compliance (Delassus operator) D = N A⁻¹ Nᵀ of the contact points within reach.
//!
//! A column is computed when its point first comes within reach and kept as long as its row of N keeps its bits. An
//! entry is a function of two columns only, taken in the order of the points, so that it does not depend on when a
//! point was met first.

use carom_algebra::solver::SparseRow;
use carom_contact::Rows;

use crate::operator::{Column, Operators};

/// The response of one contact point, in the groups of parts that it touches.
struct Kept {
    dofs: Vec<u32>,
    coefficients: Vec<f64>,
    columns: Vec<(usize, Column)>,
    /// Whether the column of a group has been dropped.
    lacks: bool,
}

/// Columns of the points met so far, and D over the current candidates.
#[derive(Default)]
pub(crate) struct Compliance {
    /// By contact point.
    kept: Vec<Option<Kept>>,
    /// Whether an unknown is one of a rigid body; empty without any.
    rigid: Vec<bool>,
    /// Part by which the own response of a point of a rigid body grows.
    softening: f64,
    /// Candidates of the current matrix, ascending.
    pub(crate) candidates: Vec<u32>,
    /// D over the candidates, row-major; x per N.
    pub(crate) matrix: Vec<f64>,
    /// Counts the changes of `matrix`.
    pub(crate) version: u64,
    /// Columns computed so far.
    pub(crate) columns_computed: usize,
}

impl Compliance {
    /// `rigid`: whether an unknown is one of a rigid body, empty without any; `softening`: the part by which the own response of a
    /// point of such a body grows.
    pub(crate) fn new(points: usize, (rigid, softening): (Vec<bool>, f64)) -> Compliance {
        Compliance {
            kept: (0..points).map(|_| None).collect(),
            rigid,
            softening,
            ..Compliance::default()
        }
    }

    /// Drops the columns of some groups, whose operators have changed.
    pub(crate) fn forget(&mut self, changed: impl Fn(usize) -> bool) {
        for kept in self.kept.iter_mut().flatten() {
            let before = kept.columns.len();
            kept.columns.retain(|(group, _)| !changed(*group));
            kept.lacks |= kept.columns.len() < before;
        }
        self.candidates.clear();
        self.matrix.clear();
        self.version += 1;
    }

    /// Brings the columns and D up to date for these candidates (ascending). `fixed`: held unknowns, which no force
    /// moves.
    pub(crate) fn update(
        &mut self,
        candidates: &[u32],
        rows: &Rows,
        fixed: &[bool],
        operators: &mut Operators,
    ) {
        let stale: Vec<u32> = candidates
            .iter()
            .copied()
            .filter(|&point| !self.is_current(point, rows))
            .collect();
        if stale.is_empty() && self.candidates == candidates {
            return;
        }
        self.compute(&stale, rows, fixed, operators);
        let n = candidates.len();
        let before = std::mem::take(&mut self.candidates);
        let matrix = std::mem::take(&mut self.matrix);
        // places of the entries that still stand in the old matrix
        let place = |point: u32| match stale.binary_search(&point) {
            Ok(_) => None,
            Err(_) => before.binary_search(&point).ok(),
        };
        let places: Vec<Option<usize>> = candidates.iter().map(|&point| place(point)).collect();
        let fresh = self.fresh(&stale, operators);
        let mut next = vec![0.0; n * n];
        for row in 0..n {
            for column in 0..=row {
                let new = |point: u32| stale.binary_search(&point);
                let entry = match (places[row], places[column]) {
                    (Some(i), Some(j)) => matrix[i * before.len() + j],
                    _ => match (new(candidates[row]), new(candidates[column])) {
                        (Ok(i), Ok(j)) => fresh[i * stale.len() + j],
                        _ => self.entry(candidates[column], candidates[row], operators),
                    },
                };
                let softened = row == column && places[row].is_none();
                let entry = match softened && self.is_rigid(candidates[row]) {
                    true => entry * (1.0 + self.softening),
                    false => entry,
                };
                next[row * n + column] = entry;
                next[column * n + row] = entry;
            }
        }
        self.matrix = next;
        self.candidates = candidates.to_vec();
        self.version += 1;
    }

    /// Whether the point is one of a rigid body.
    fn is_rigid(&self, point: u32) -> bool {
        let rigid = |&dof: &u32| self.rigid.get(dof as usize) == Some(&true);
        let kept = self.kept[point as usize].as_ref();
        kept.is_some_and(|kept| kept.dofs.iter().any(rigid))
    }

    fn is_current(&self, point: u32, rows: &Rows) -> bool {
        let kept = &self.kept[point as usize];
        kept.as_ref()
            .is_some_and(|kept| !kept.lacks && kept.is_of(rows.row(point as usize)))
    }

    fn compute(&mut self, points: &[u32], rows: &Rows, fixed: &[bool], operators: &mut Operators) {
        let mut by_group: Vec<(Vec<u32>, Vec<SparseRow>)> =
            vec![Default::default(); operators.groups.len()];
        for &point in points {
            let (dofs, coefficients) = rows.row(point as usize);
            let slot = &mut self.kept[point as usize];
            let kept = match slot {
                Some(kept) if kept.is_of((dofs, coefficients)) => kept,
                _ => slot.insert(Kept {
                    dofs: dofs.to_vec(),
                    coefficients: coefficients.to_vec(),
                    columns: Vec::new(),
                    lacks: false,
                }),
            };
            kept.lacks = false;
            for (&dof, &n) in dofs
                .iter()
                .zip(coefficients)
                .filter(|(dof, _)| !fixed[**dof as usize])
            {
                let (group, place) = operators.home(dof as usize);
                if kept.columns.iter().any(|(of, _)| *of == group) {
                    continue;
                }
                let (owners, sparse) = &mut by_group[group];
                if owners.last() != Some(&point) {
                    owners.push(point);
                    sparse.push(SparseRow::default());
                }
                if let Some(row) = sparse.last_mut() {
                    row.dofs.push(place as u32);
                    row.coefficients.push(n);
                }
            }
        }
        for (group, (owners, sparse)) in by_group.into_iter().enumerate() {
            self.columns_computed += sparse.len();
            let columns = operators.respond(group, sparse);
            for (point, column) in owners.into_iter().zip(columns) {
                if let Some(kept) = &mut self.kept[point as usize] {
                    kept.columns.push((group, column));
                }
            }
        }
    }

    fn columns(&self, point: u32) -> &[(usize, Column)] {
        self.kept[point as usize]
            .as_ref()
            .map_or(&[], |kept| &kept.columns)
    }

    fn entry(&self, one: u32, other: u32, operators: &Operators) -> f64 {
        let mut sum = 0.0;
        for (group, column) in self.columns(one) {
            for (_, second) in self
                .columns(other)
                .iter()
                .filter(|(second, _)| second == group)
            {
                sum += operators.operator(*group).dot(column, second);
            }
        }
        sum
    }

    /// D over points whose columns have just been computed, row-major, with the bits of `entry`: group after group, each at
    /// once.
    fn fresh(&self, points: &[u32], operators: &Operators) -> Vec<f64> {
        let mut matrix = vec![0.0; points.len().pow(2)];
        for number in 0..operators.groups.len() {
            let of_group = |&point: &u32| self.columns(point).iter().find(|(g, _)| *g == number);
            let (places, columns): (Vec<usize>, Vec<&Column>) = points
                .iter()
                .enumerate()
                .filter_map(|(k, point)| of_group(point).map(|(_, column)| (k, column)))
                .unzip();
            if columns.is_empty() {
                continue;
            }
            let block = operators.operator(number).gram(&columns);
            for (i, row) in places.iter().zip(block.chunks_exact(places.len())) {
                for (j, entry) in places.iter().zip(row) {
                    matrix[i * points.len() + j] += entry;
                }
            }
        }
        matrix
    }

    /// N x of a point for the free motion, from the y of `begin`.
    pub(crate) fn free(&self, point: u32, operators: &Operators, y: &[f64]) -> f64 {
        let columns = self.columns(point).iter();
        let of_group = |(group, column): &(usize, Column)| {
            let y = operators.of_group(*group, y);
            operators.operator(*group).free(column, y)
        };
        columns.map(of_group).sum()
    }

    /// Adds the force of a point to y, before `end`.
    pub(crate) fn add(&self, point: u32, force: f64, operators: &Operators, y: &mut [f64]) {
        for (group, column) in self.columns(point) {
            operators.add(*group, column, force, y);
        }
    }

    /// Bytes held by the columns and the matrix.
    pub(crate) fn bytes(&self) -> usize {
        let columns = self.kept.iter().flatten().flat_map(|kept| &kept.columns);
        let bytes = columns.map(|(_, column)| match column {
            Column::Diagonal(row) => 12 * row.dofs.len(),
            Column::Factored(response) => response.bytes(),
        });
        bytes.sum::<usize>() + 8 * self.matrix.len()
    }
}

impl Kept {
    /// Whether it answers to this row.
    fn is_of(&self, (dofs, coefficients): (&[u32], &[f64])) -> bool {
        self.dofs == dofs && self.coefficients == coefficients
    }
}
