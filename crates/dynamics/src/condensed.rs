//! The condensed problem of the links, `H ΔL = Σ C v`, in its two forms.
//!
//! *Dense*: H is made from the answers of the zones, and factored. *Joined*: for one step at a time,
//! `H = Σ s_z C A_z⁻¹ Cᵀ`, and H is never made: the rows join the effective matrices of the implicit zones in a sparse
//! quasi-definite matrix `[A/s, -Cᵀ; -C, -D]`, in which diagonal zones enter by `D = Σ s_z C A_z⁻¹ Cᵀ`, sparse as rows that
//! share no node do not meet. Its solution for the right-hand side (0, r) has `ΔL = -H⁻¹ r`.

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::dense::DenseCholesky;
use carom_algebra::pattern::Cliques;
use carom_algebra::solver::QuasiDefinite;

use crate::error::Error;
use crate::system::{LinkRow, System};

/// Rows above which the joined form is taken where it can be: a dense H has 8 MB there.
pub const DENSE: usize = 1000;

/// A factor of H.
pub enum Condensed {
    /// H itself.
    Dense(DenseCholesky),
    /// The rows with the unknowns of the implicit zones.
    Joined(Box<Joined>),
}

impl Condensed {
    /// r ← H⁻¹ r.
    pub fn solve(&mut self, r: &mut [f64]) {
        match self {
            Condensed::Dense(factor) => factor.solve(r),
            Condensed::Joined(joined) => joined.solve(r),
        }
    }

    /// Bytes held.
    pub fn bytes(&self, rows: usize) -> usize {
        match self {
            Condensed::Dense(_) => 8 * rows * rows,
            Condensed::Joined(joined) => joined.bytes(),
        }
    }
}

/// The rows in one sparse matrix with the implicit zones.
pub struct Joined {
    factor: QuasiDefinite,
    unknowns: usize,
    x: Vec<f64>,
}

/// A of connected parts.
pub enum Matrix {
    /// Lumped mass of an explicit scheme.
    Diagonal(Vec<f64>),
    /// Any other.
    Sparse(Csr),
}

/// Connected parts in H: velocity `scale` A⁻¹ Cᵀ L.
pub struct Answer<'a> {
    /// Their system.
    pub system: &'a System,
    /// Their unknowns.
    pub span: Range<usize>,
    /// Number and terms of the rows that act on them; no term is outside.
    pub rows: Vec<(u32, LinkRow)>,
    /// A over these unknowns.
    pub matrix: Matrix,
    /// Factor of A⁻¹ Cᵀ L in the velocity.
    pub scale: f64,
}

impl Answer<'_> {
    /// Terms of a row on unknowns that move, counted from the first of the span.
    fn terms<'a>(&'a self, row: &'a LinkRow) -> impl Iterator<Item = (usize, f64)> + 'a {
        let free = row
            .iter()
            .filter(|(dof, _)| !self.system.fixed[*dof as usize]);
        free.map(|&(dof, c)| (dof as usize - self.span.start, c))
    }

    /// Number of its unknowns in the joined matrix.
    fn own(&self) -> usize {
        match self.matrix {
            Matrix::Diagonal(_) => 0,
            Matrix::Sparse(_) => self.span.len(),
        }
    }
}

impl Joined {
    /// Joins `count` rows.
    ///
    /// # Errors
    /// Rows that say the same twice.
    pub fn new(answers: &[Answer], count: usize) -> Result<Joined, Error> {
        let mut first = vec![0];
        for answer in answers {
            first.push(first[first.len() - 1] + answer.own());
        }
        let unknowns = first[answers.len()];
        let neighbours = neighbours(answers, count);
        let cliques = cliques(answers, &first, &neighbours);
        let mut matrix = Csr::from_cliques(unknowns + count, &cliques);
        let mut groups: Vec<u32> = (0..unknowns + count).map(|i| i as u32).collect();
        for (answer, &first) in answers.iter().zip(&first) {
            match &answer.matrix {
                Matrix::Diagonal(masses) => add_diagonal(answer, masses, unknowns, &mut matrix),
                Matrix::Sparse(own) => {
                    for i in 0..answer.span.len() {
                        groups[first + i] = (first + first_of_node(answer, i)) as u32;
                    }
                    add_implicit(answer, own, [first, unknowns], &mut matrix);
                    group(answer, first, &mut groups[unknowns..]);
                }
            }
        }
        hold_empty_rows(answers, [unknowns, count], &mut matrix);
        let groups = dense_numbers(&groups);
        let factor = QuasiDefinite::new(&matrix, &groups, unknowns)
            .map_err(|cause| Error::Redundant { rows: count, cause })?;
        Ok(Joined {
            factor,
            unknowns,
            x: vec![0.0; unknowns + count],
        })
    }

    /// Bytes of the factor.
    pub fn bytes(&self) -> usize {
        self.factor.bytes()
    }

    /// r ← H⁻¹ r.
    pub fn solve(&mut self, r: &mut [f64]) {
        let (above, below) = self.x.split_at_mut(self.unknowns);
        above.fill(0.0);
        below.copy_from_slice(r);
        self.factor.solve(&mut self.x);
        for (r, x) in r.iter_mut().zip(&self.x[self.unknowns..]) {
            *r = -x;
        }
    }
}

/// Terms by unknown: which rows act on it, with what coefficient.
fn by_unknown(answer: &Answer) -> Vec<Vec<(u32, f64)>> {
    let mut columns = vec![Vec::new(); answer.span.len()];
    for (row, terms) in &answer.rows {
        for (i, c) in answer.terms(terms) {
            columns[i].push((*row, c));
        }
    }
    columns
}

/// For each row those that act on an unknown of a diagonal matrix with it, ascending.
fn neighbours(answers: &[Answer], count: usize) -> Vec<Vec<u32>> {
    let mut rows: Vec<Vec<u32>> = (0..count as u32).map(|row| vec![row]).collect();
    for answer in answers.iter().filter(|answer| answer.own() == 0) {
        for column in by_unknown(answer) {
            for (row, _) in &column {
                rows[*row as usize].extend(column.iter().map(|(other, _)| *other));
            }
        }
        for row in &mut rows {
            row.sort_unstable();
            row.dedup();
        }
    }
    rows
}

fn cliques(answers: &[Answer], first: &[usize], neighbours: &[Vec<u32>]) -> Cliques {
    let unknowns = first[answers.len()] as u32;
    let mut cliques = Cliques::new();
    for (answer, &first) in answers.iter().zip(first) {
        let Matrix::Sparse(matrix) = &answer.matrix else {
            continue;
        };
        let first = first as u32;
        for i in 0..answer.span.len() {
            let (columns, _) = matrix.row(i);
            for &j in columns.iter().filter(|&&j| j as usize <= i) {
                cliques.push(&[first + i as u32, first + j]);
            }
        }
        for (row, terms) in &answer.rows {
            for (i, _) in answer.terms(terms) {
                cliques.push(&[first + i as u32, unknowns + row]);
            }
        }
    }
    for (row, others) in neighbours.iter().enumerate() {
        for other in others {
            cliques.push(&[unknowns + row as u32, unknowns + other]);
        }
    }
    cliques
}

/// -D of a diagonal matrix.
fn add_diagonal(answer: &Answer, masses: &[f64], unknowns: usize, matrix: &mut Csr) {
    for (mass, column) in masses.iter().zip(by_unknown(answer)) {
        for (row, c) in &column {
            for (other, d) in &column {
                let (i, j) = (unknowns + *row as usize, unknowns + *other as usize);
                matrix.add(i, j, -answer.scale * c * d / mass);
            }
        }
    }
}

/// Gives rows that act on nothing that moves a multiplier of nothing: supports hold them already.
fn hold_empty_rows(answers: &[Answer], [unknowns, count]: [usize; 2], matrix: &mut Csr) {
    let mut acts = vec![false; count];
    for answer in answers {
        for (row, terms) in &answer.rows {
            acts[*row as usize] |= answer.terms(terms).any(|(_, c)| c != 0.0);
        }
    }
    for row in (0..count).filter(|row| !acts[*row]) {
        matrix.add(unknowns + row, unknowns + row, -1.0);
    }
}

/// A / s and -C.
fn add_implicit(answer: &Answer, own: &Csr, [first, unknowns]: [usize; 2], matrix: &mut Csr) {
    let fixed = |i: usize| answer.system.fixed[answer.span.start + i];
    for i in 0..answer.span.len() {
        if fixed(i) {
            matrix.add(first + i, first + i, 1.0);
            continue;
        }
        let (columns, values) = own.row(i);
        for (&j, &value) in columns.iter().zip(values) {
            if !fixed(j as usize) && value != 0.0 {
                matrix.add(first + i, first + j as usize, value / answer.scale);
            }
        }
    }
    for (row, terms) in &answer.rows {
        let row = unknowns + *row as usize;
        for (i, c) in answer.terms(terms) {
            matrix.add(first + i, row, -c);
            matrix.add(row, first + i, -c);
        }
    }
}

/// Puts each multiplier in the group of the node that it acts on most.
fn group(answer: &Answer, first: usize, groups: &mut [u32]) {
    for (row, terms) in &answer.rows {
        let most =
            answer
                .terms(terms)
                .fold((0.0, None), |(most, at), (i, c)| match c.abs() > most {
                    true => (c.abs(), Some(i)),
                    false => (most, at),
                });
        if let (_, Some(i)) = most {
            groups[*row as usize] = (first + first_of_node(answer, i)) as u32;
        }
    }
}

/// First unknown of the node of an unknown, both counted from the first of the span.
fn first_of_node(answer: &Answer, unknown: usize) -> usize {
    let unknowns = &answer.system.unknowns;
    unknowns.first(unknowns.node(answer.span.start + unknown)) - answer.span.start
}

/// Group numbers without gaps, in the order of the old ones.
fn dense_numbers(groups: &[u32]) -> Vec<u32> {
    let mut names = groups.to_vec();
    names.sort_unstable();
    names.dedup();
    groups
        .iter()
        .map(|group| names.partition_point(|name| name < group) as u32)
        .collect()
}
