//! The condensed compliance (Delassus operator) D = N A⁻¹ Nᵀ of the contact points within reach.
//!
//! Points that share neither a factor nor an unknown of a diagonal matrix do not act on each other: D is kept by groups of points that
//! do.
//!
//! A column is computed when its point first comes within reach and kept as long as its row of N keeps its bits. An
//! entry is a function of two columns only, taken in the order of the points, so that it does not depend on when a
//! point was met first.

use carom_algebra::solver::SparseRow;
use carom_contact::Rows;
use carom_ranks::memory::{LITTLE, Short, room_for};

use crate::groups::Groups;
use crate::operator::{Column, Operators};

/// The response of one contact point, in the groups of parts that it touches.
struct Kept {
    dofs: Vec<u32>,
    coefficients: Vec<f64>,
    columns: Vec<(usize, Column)>,
    /// Whether the column of a group has been dropped.
    lacks: bool,
}

/// D over the rows of each group of candidates.
#[derive(Default)]
struct Blocks {
    /// Rows, group after group.
    rows: Vec<u32>,
    /// Where the rows of groups begin, and one end more; where their entries do.
    starts: Vec<[usize; 2]>,
    /// Row, its group, and its place there, by row.
    places: Vec<(u32, u32, u32)>,
    /// D, row-major, group after group; x per N.
    entries: Vec<f64>,
}

impl Blocks {
    /// Begins a group of these rows.
    fn begin(&mut self, rows: impl Iterator<Item = u32>) {
        let first = self.rows.len();
        self.rows.extend(rows);
        let group = self.starts.len() as u32;
        let places = self.rows[first..].iter().enumerate();
        self.places
            .extend(places.map(|(k, &row)| (row, group, k as u32)));
        self.starts.push([first, self.entries.len()]);
    }

    /// The rows of a group.
    fn rows(&self, group: usize) -> &[u32] {
        let next = self.starts.get(group + 1);
        let end = next.map_or(self.rows.len(), |next| next[0]);
        &self.rows[self.starts[group][0]..end]
    }

    /// D over the rows of a group.
    fn entries(&self, group: usize) -> &[f64] {
        let next = self.starts.get(group + 1);
        let end = next.map_or(self.entries.len(), |next| next[1]);
        &self.entries[self.starts[group][1]..end]
    }

    /// Group and place of a row.
    fn place(&self, row: u32) -> Option<(u32, u32)> {
        let found = self.places.binary_search_by_key(&row, |place| place.0);
        found.ok().map(|k| (self.places[k].1, self.places[k].2))
    }

    fn clear(&mut self) {
        self.rows.clear();
        self.starts.clear();
        self.places.clear();
        self.entries.clear();
    }
}

/// What a candidate shares with others: the unknowns of its `width` rows that are not held, or their factors.
fn keys<'a>(
    (point, width): (u32, u32),
    (rows, fixed): (&'a Rows, &'a [bool]),
    operators: &'a Operators,
) -> impl Iterator<Item = usize> + 'a {
    let numbers = point * width..(point + 1) * width;
    let dofs = numbers.flat_map(move |number| rows.row(number as usize).0);
    let dofs = dofs.map(|&dof| dof as usize);
    let free = dofs.filter(move |&dof| !fixed[dof]);
    free.map(move |dof| operators.key(dof))
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
    /// Candidates, ascending.
    candidates: Vec<u32>,
    /// Whether they are one group, whatever they share.
    together: bool,
    groups: Groups,
    blocks: Blocks,
    /// Counts the changes of D.
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
        self.blocks.clear();
        self.version += 1;
    }

    /// Brings the columns and D up to date for these candidates (ascending), with `width` rows each. `together`: whether they are one group, whatever they share;
    /// `fixed`: held unknowns, which no force moves.
    pub(crate) fn update(
        &mut self,
        (candidates, width, together): (&[u32], u32, bool),
        rows: &Rows,
        fixed: &[bool],
        operators: &mut Operators,
    ) {
        let of_point = |&point: &u32| point * width..(point + 1) * width;
        let stale = candidates.iter().flat_map(of_point);
        let stale: Vec<u32> = stale.filter(|&row| !self.is_current(row, rows)).collect();
        let same = self.candidates == candidates && self.together == together;
        if stale.is_empty() && same && self.blocks.rows.len() == candidates.len() * width as usize {
            return;
        }
        self.compute(&stale, rows, fixed, operators);
        self.candidates.clear();
        self.candidates.extend_from_slice(candidates);
        self.together = together;
        if operators.iterate() {
            self.groups.join_all(candidates.len());
            self.version += 1;
            return;
        }
        match together {
            true => self.groups.join_all(candidates.len()),
            false => {
                let operators = &*operators;
                let keys = |point: u32| keys((point, width), (rows, fixed), operators);
                self.groups.split(candidates, keys, operators.keys());
            }
        }
        let before = std::mem::take(&mut self.blocks);
        let mut blocks = Blocks::default();
        for range in self.groups.ranges() {
            let points = self.groups.order()[range].iter();
            blocks.begin(points.flat_map(|&place| of_point(&candidates[place as usize])));
            self.fill(&mut blocks, (&before, &stale), operators);
        }
        blocks.places.sort_unstable_by_key(|place| place.0);
        self.blocks = blocks;
        self.version += 1;
    }

    /// Whether there is room for D over these candidates, of the same arguments as [`Compliance::update`].
    ///
    /// # Errors
    /// There is none.
    pub(crate) fn has_room(
        &self,
        (candidates, width, together): (&[u32], u32, bool),
        rows: &Rows,
        fixed: &[bool],
        operators: &Operators,
    ) -> Result<(), Short> {
        let bytes = |points: usize| 8 * (points as u64 * u64::from(width)).pow(2);
        let there = 8 * self.blocks.entries.len() as u64;
        if operators.iterate() || bytes(candidates.len()) <= there.max(LITTLE) {
            return Ok(());
        }
        let mut groups = Groups::default();
        let keys = |point: u32| keys((point, width), (rows, fixed), operators);
        match together {
            true => groups.join_all(candidates.len()),
            false => groups.split(candidates, keys, operators.keys()),
        }
        let needed: u64 = groups.ranges().map(|group| bytes(group.len())).sum();
        if needed <= there {
            return Ok(());
        }
        let count = candidates.len();
        room_for(
            format_args!("the compliance of {count} contact points"),
            needed,
        )
    }

    /// D over the last group. `before`: the blocks before; `stale`: rows whose entries have changed.
    fn fill(&self, blocks: &mut Blocks, (before, stale): (&Blocks, &[u32]), operators: &Operators) {
        let own = blocks.rows(blocks.starts.len() - 1).to_vec();
        let n = own.len();
        let is_stale = |row: &u32| stale.binary_search(row).is_ok();
        // places of the entries that still stand in the old matrix
        let place = |row: &u32| match is_stale(row) {
            true => None,
            false => before.place(*row),
        };
        let places: Vec<Option<(u32, u32)>> = own.iter().map(place).collect();
        let renewed: Vec<u32> = own.iter().copied().filter(is_stale).collect();
        let fresh = self.fresh(&renewed, operators);
        let first = blocks.entries.len();
        blocks.entries.resize(first + n * n, 0.0);
        let next = &mut blocks.entries[first..];
        for row in 0..n {
            for column in 0..=row {
                let new = |row: u32| renewed.binary_search(&row);
                let entry = match (places[row], places[column]) {
                    (Some((group, i)), Some((other, j))) if group == other => {
                        let width = before.rows(group as usize).len();
                        before.entries(group as usize)[i as usize * width + j as usize]
                    }
                    _ => match (new(own[row]), new(own[column])) {
                        (Ok(i), Ok(j)) => fresh[i * renewed.len() + j],
                        _ => self.entry(own[column], own[row], operators),
                    },
                };
                let softened = row == column && places[row].is_none();
                let entry = match softened && self.is_rigid(own[row]) {
                    true => entry * (1.0 + self.softening),
                    false => entry,
                };
                next[row * n + column] = entry;
                next[column * n + row] = entry;
            }
        }
    }

    /// Places of the candidates, group after group.
    pub(crate) fn groups(&self) -> &Groups {
        &self.groups
    }

    /// The row of a point over the y of `begin`, where matrices are solved with by iterations.
    pub(crate) fn row(&self, point: u32, operators: &Operators) -> SparseRow {
        let mut all = SparseRow::default();
        for (group, column) in self.columns(point) {
            if let Column::Row(row) = column {
                let first = operators.place(*group) as u32;
                all.dofs.extend(row.dofs.iter().map(|dof| first + dof));
                all.coefficients.extend_from_slice(&row.coefficients);
            }
        }
        all
    }

    /// D over the rows of a group, row-major.
    pub(crate) fn block(&self, group: usize) -> &[f64] {
        self.blocks.entries(group)
    }

    /// The rows, where they are one group.
    pub(crate) fn rows(&self) -> &[u32] {
        &self.blocks.rows
    }

    /// D, where all rows are one group.
    pub(crate) fn matrix(&self) -> &[f64] {
        &self.blocks.entries
    }

    /// Whether the point is one of a rigid body.
    /// What the own response of a candidate has grown by, m/N; zero of points on no rigid body.
    pub(crate) fn softened(&self, point: u32) -> f64 {
        let Some((group, row)) = self.blocks.place(point).filter(|_| self.is_rigid(point)) else {
            return 0.0;
        };
        let (group, row) = (group as usize, row as usize);
        let own = self.blocks.entries(group)[row * (self.blocks.rows(group).len() + 1)];
        own * self.softening / (1.0 + self.softening)
    }

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
            if !operators.iterates(group) {
                self.columns_computed += sparse.len();
            }
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
        let columns = points.iter().flat_map(|&point| self.columns(point));
        let mut numbers: Vec<usize> = columns.map(|(group, _)| *group).collect();
        numbers.sort_unstable();
        numbers.dedup();
        for number in numbers {
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
    pub(crate) fn add(&self, point: u32, force: f64, operators: &mut Operators, y: &mut [f64]) {
        for (group, column) in self.columns(point) {
            operators.add(*group, column, force, y);
        }
    }

    /// Adds the force of a row along its entries to a system vector, as its column has them.
    pub(crate) fn add_force(&self, row: u32, force: f64, f: &mut [f64]) {
        if let Some(kept) = &self.kept[row as usize] {
            for (&dof, n) in kept.dofs.iter().zip(&kept.coefficients) {
                f[dof as usize] += n * force;
            }
        }
    }

    /// Bytes held by the columns and the matrix.
    pub(crate) fn bytes(&self) -> usize {
        let columns = self.kept.iter().flatten().flat_map(|kept| &kept.columns);
        let bytes = columns.map(|(_, column)| match column {
            Column::Row(row) => 12 * row.dofs.len(),
            Column::Factored(response) => response.bytes(),
            Column::Updated(response, products) => response.bytes() + 8 * products.len(),
            Column::Moved(row, motion) => 12 * row.dofs.len() + 8 * motion.len(),
        });
        bytes.sum::<usize>() + 8 * self.blocks.entries.len()
    }
}

impl Kept {
    /// Whether it answers to this row.
    fn is_of(&self, (dofs, coefficients): (&[u32], &[f64])) -> bool {
        self.dofs == dofs && self.coefficients == coefficients
    }
}
