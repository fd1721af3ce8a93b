//! The condensed problem of the links, `H ΔL = Σ C v`, in its two forms.
//!
//! *Dense*: H is made from the answers of the zones, and factored. *Joined*: for one step at a time,
//! `H = Σ s_z C A_z⁻¹ Cᵀ`, and H is never made: the rows join the effective matrices of the implicit zones in a sparse
//! quasi-definite matrix `[A/s, -Cᵀ; -C, -D]`, in which diagonal zones enter by `D = Σ s_z C A_z⁻¹ Cᵀ`, sparse as rows that
//! share no node do not meet. Its solution for the right-hand side (0, r) has `ΔL = -H⁻¹ r`.

use carom_algebra::csr::Csr;
use carom_algebra::dense::DenseCholesky;
use carom_algebra::pattern::Cliques;
use carom_algebra::solver::QuasiDefinite;

use crate::driver::linked::LinkRow;
use crate::error::Error;
use crate::system::System;

/// Rows above which the joined form is taken where it can be: a dense H has 8 MB there.
pub(super) const DENSE: usize = 1000;

/// A factor of H.
pub(super) enum Condensed {
    /// H itself.
    Dense(DenseCholesky),
    /// The rows with the unknowns of the implicit zones.
    Joined(Box<Joined>),
}

impl Condensed {
    /// r ← H⁻¹ r.
    pub(super) fn solve(&mut self, r: &mut [f64]) {
        match self {
            Condensed::Dense(factor) => factor.solve(r),
            Condensed::Joined(joined) => joined.solve(r),
        }
    }

    /// Bytes held.
    pub(super) fn bytes(&self, rows: usize) -> usize {
        match self {
            Condensed::Dense(_) => 8 * rows * rows,
            Condensed::Joined(joined) => joined.factor.bytes(),
        }
    }
}

/// The rows in one sparse matrix with the implicit zones.
pub(super) struct Joined {
    factor: QuasiDefinite,
    unknowns: usize,
    x: Vec<f64>,
}

/// A zone in H: velocity `scale` A⁻¹ Cᵀ L with A = `mass` M + `stiffness` K.
#[derive(Clone, Copy)]
pub(super) struct Answer<'a> {
    pub(super) system: &'a System,
    pub(super) rows: &'a [(u32, LinkRow)],
    pub(super) mass: f64,
    pub(super) stiffness: f64,
    pub(super) scale: f64,
}

impl Answer<'_> {
    fn is_diagonal(&self) -> bool {
        self.stiffness == 0.0 && self.system.mass.consistent.is_none()
    }
}

impl Joined {
    /// Joins `count` rows of the zones.
    ///
    /// # Errors
    /// Rows that say the same twice.
    pub(super) fn new(zones: &[Answer], count: usize) -> Result<Joined, Error> {
        let mut first = vec![0];
        for zone in zones {
            let own = match zone.is_diagonal() {
                true => 0,
                false => zone.system.unknowns(),
            };
            first.push(first[first.len() - 1] + own);
        }
        let unknowns = first[zones.len()];
        let neighbours = neighbours(zones, count);
        let mut matrix = Csr::from_cliques(unknowns + count, &cliques(zones, &first, &neighbours));
        let mut groups: Vec<u32> = (0..unknowns + count).map(|i| i as u32).collect();
        for (zone, &first) in zones.iter().zip(&first) {
            match zone.is_diagonal() {
                true => add_diagonal(zone, unknowns, &mut matrix),
                false => {
                    for i in 0..zone.system.unknowns() {
                        groups[first + i] = (first + first_of_node(zone, i)) as u32;
                    }
                    add_implicit(zone, first, unknowns, &mut matrix);
                    group(zone, first, &mut groups[unknowns..]);
                }
            }
        }
        let groups = dense_numbers(&groups);
        let factor = QuasiDefinite::new(&matrix, &groups, unknowns)
            .map_err(|cause| Error::Redundant { rows: count, cause })?;
        Ok(Joined {
            factor,
            unknowns,
            x: vec![0.0; unknowns + count],
        })
    }

    fn solve(&mut self, r: &mut [f64]) {
        let (above, below) = self.x.split_at_mut(self.unknowns);
        above.fill(0.0);
        below.copy_from_slice(r);
        self.factor.solve(&mut self.x);
        for (r, x) in r.iter_mut().zip(&self.x[self.unknowns..]) {
            *r = -x;
        }
    }
}

/// Terms of a zone by unknown: which rows act on it, with what coefficient.
fn by_unknown(zone: &Answer) -> Vec<Vec<(u32, f64)>> {
    let mut columns = vec![Vec::new(); zone.system.unknowns()];
    for (row, terms) in zone.rows {
        for &(dof, c) in terms {
            if !zone.system.fixed[dof as usize] {
                columns[dof as usize].push((*row, c));
            }
        }
    }
    columns
}

/// For each row those that act on an unknown of a diagonal zone with it, ascending.
fn neighbours(zones: &[Answer], count: usize) -> Vec<Vec<u32>> {
    let mut rows: Vec<Vec<u32>> = (0..count as u32).map(|row| vec![row]).collect();
    for zone in zones.iter().filter(|zone| zone.is_diagonal()) {
        for column in by_unknown(zone) {
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

fn cliques(zones: &[Answer], first: &[usize], neighbours: &[Vec<u32>]) -> Cliques {
    let unknowns = first[zones.len()] as u32;
    let mut cliques = Cliques::new();
    for (zone, &first) in zones.iter().zip(first) {
        if zone.is_diagonal() {
            continue;
        }
        let (map, first) = (&zone.system.unknowns, first as u32);
        let mut dofs = Vec::new();
        for body in &zone.system.bodies {
            body.each_element(&mut |nodes| {
                dofs.clear();
                dofs.extend(
                    nodes
                        .iter()
                        .flat_map(|&node| map.of(node).map(move |i| first + i as u32)),
                );
                cliques.push(&dofs);
            });
        }
        for (row, terms) in zone.rows {
            for (dof, _) in terms {
                cliques.push(&[first + dof, unknowns + row]);
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

/// -D of a diagonal zone.
fn add_diagonal(zone: &Answer, unknowns: usize, matrix: &mut Csr) {
    for (dof, column) in by_unknown(zone).iter().enumerate() {
        let mass = zone.mass * zone.system.mass.lumped[dof];
        for (row, c) in column {
            for (other, d) in column {
                let (i, j) = (unknowns + *row as usize, unknowns + *other as usize);
                matrix.add(i, j, -zone.scale * c * d / mass);
            }
        }
    }
}

/// A / s and -C of an implicit zone.
fn add_implicit(zone: &Answer, first: usize, unknowns: usize, matrix: &mut Csr) {
    let system = zone.system;
    let (mass, stiffness) = (zone.mass / zone.scale, zone.stiffness / zone.scale);
    let fixed = |i: usize| system.fixed[i];
    for part in &system.parts {
        let a = crate::operator::assembled(system, part, [mass, 0.0], &|_| stiffness);
        for i in part.clone() {
            let (columns, values) = a.row(i - part.start);
            for (&j, &value) in columns.iter().zip(values) {
                let j = part.start + j as usize;
                if fixed(i) || fixed(j) {
                    continue;
                }
                if value != 0.0 {
                    matrix.add(first + i, first + j, value);
                }
            }
            if fixed(i) {
                matrix.add(first + i, first + i, 1.0);
            }
        }
    }
    for (row, terms) in zone.rows {
        let row = unknowns + *row as usize;
        for &(dof, c) in terms.iter().filter(|(dof, _)| !fixed(*dof as usize)) {
            matrix.add(first + dof as usize, row, -c);
            matrix.add(row, first + dof as usize, -c);
        }
    }
}

/// Puts each multiplier in the group of the node that it acts on most.
fn group(zone: &Answer, first: usize, groups: &mut [u32]) {
    for (row, terms) in zone.rows {
        let free = terms
            .iter()
            .filter(|(dof, _)| !zone.system.fixed[*dof as usize]);
        let most = free.fold((0.0, None), |(most, at), (dof, c)| match c.abs() > most {
            true => (c.abs(), Some(*dof as usize)),
            false => (most, at),
        });
        if let (_, Some(dof)) = most {
            groups[*row as usize] = (first + first_of_node(zone, dof)) as u32;
        }
    }
}

/// First unknown of the node of an unknown.
fn first_of_node(zone: &Answer, unknown: usize) -> usize {
    let unknowns = &zone.system.unknowns;
    unknowns.first(unknowns.node(unknown))
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
