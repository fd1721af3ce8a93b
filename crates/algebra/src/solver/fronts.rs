//! Multifrontal Cholesky factorisation over the supernodes of a factor (Duff and Reid 1983; Liu 1992).
//!
//! A front gathers the entries of its columns and what its children in the elimination tree leave, eliminates its columns into the panel of
//! the factor, and leaves the rest to its parent. Subtrees are independent: threads share them, and the strips of large fronts. Children are
//! added in ascending order and places are found once, so that the bits of the factor depend on matrix and processor alone.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};

use super::front::{self, Room};
use super::squares::Squares;
use super::sweep::{Panel, Panels};
use crate::{Error, csr::Csr};

/// Marks an entry above the diagonal, and the parent of a root.
const NONE: u32 = u32::MAX;

/// Part of all operations up to which a subtree is one piece of work.
const PIECE: f64 = 1.0 / 48.0;

/// Operations up to which one thread takes the whole tree.
const SMALL: f64 = 2e7;

/// Why there is no factor.
pub(super) enum Failure {
    /// An entry of this row and column is no number.
    NotFinite(u32, u32, f64),
    /// The pivot of this position is not positive.
    Pivot(usize),
    /// No memory for a front.
    Memory,
}

/// What a front leaves to its parent: the lower triangle of a square matrix by columns, or why there is none.
type Rest = Result<Vec<f64>, Failure>;

/// The elimination tree, and where entries go.
pub(super) struct Fronts {
    /// Parent of each supernode.
    parent: Vec<u32>,
    /// First supernode of the subtree of each.
    first: Vec<u32>,
    /// Number of its children.
    children: Vec<u32>,
    /// Supernodes whose subtrees are one piece of work, ascending.
    pieces: Vec<u32>,
    /// For each row below the triangles, in the order of `Panels`: its row in the front of the parent.
    local: Vec<u32>,
    /// For each entry of the matrix, row after row in order of elimination: its place in the panel of the row, [`NONE`] above the diagonal.
    places: Vec<u32>,
    /// First of these of each position, and an end.
    starts: Vec<usize>,
    /// Columns of the widest panel.
    widest: usize,
    /// Of a tree that one thread takes whole, kept from one factorisation to the next.
    room: Option<Room>,
    squares: Mutex<Squares>,
}

impl Fronts {
    /// The tree of a factor. `connected`: unknown of each position, `position` the inverse.
    pub fn new(panels: &Panels, matrix: &Csr, connected: &[u32], position: &[u32]) -> Fronts {
        let count = panels.len();
        let mut fronts = Fronts {
            parent: vec![NONE; count],
            first: (0..count as u32).collect(),
            children: vec![0; count],
            pieces: Vec::new(),
            local: Vec::with_capacity(panels.rows.len()),
            places: Vec::new(),
            starts: Vec::with_capacity(connected.len() + 1),
            widest: panels.list.iter().map(|p| p.columns).max().unwrap_or(0),
            room: None,
            squares: Mutex::new(Squares::new(0)),
        };
        let mut operations: Vec<f64> = panels.list.iter().map(Panel::operations).collect();
        for s in 0..count {
            if let Some(parent) = panels.parent(s as u32) {
                fronts.parent[s] = parent;
                let parent = parent as usize;
                fronts.children[parent] += 1;
                fronts.first[parent] = fronts.first[parent].min(fronts.first[s]);
                operations[parent] += operations[s];
            }
        }
        fronts.squares = Mutex::new(Squares::new(fronts.most_in_use(panels)));
        fronts.cut(&operations);
        fronts.find_rows(panels);
        fronts.find_entries(panels, matrix, connected, position);
        fronts
    }

    /// Numbers that fronts leave to parents, the most that are there at once where they come one after the other.
    pub fn most_in_use(&self, panels: &Panels) -> usize {
        let square = |s: u32| panels.list[s as usize].below.pow(2);
        let (mut now, mut most) = (0, 0);
        for s in 0..self.parent.len() as u32 {
            now += square(s);
            most = most.max(now);
            now -= self.children_of(s).into_iter().map(square).sum::<usize>();
        }
        most
    }

    /// Cuts the tree into pieces of work.
    fn cut(&mut self, operations: &[f64]) {
        let roots = (0..self.parent.len()).filter(|&s| self.parent[s] == NONE);
        let all: f64 = roots.map(|s| operations[s]).sum();
        let most = match all > SMALL {
            true => PIECE * all,
            false => f64::INFINITY,
        };
        let is_piece = |s: usize| operations[s] <= most || self.children[s] == 0;
        let is_whole = |s: usize| match self.parent[s] {
            NONE => true,
            parent => !is_piece(parent as usize),
        };
        let pieces = (0..self.parent.len()).filter(|&s| is_piece(s) && is_whole(s));
        self.pieces = pieces.map(|s| s as u32).collect();
    }

    fn find_rows(&mut self, panels: &Panels) {
        for (s, panel) in panels.list.iter().enumerate() {
            let Some(parent) = panels.list.get(self.parent[s] as usize) else {
                continue;
            };
            let rows = panels.rows_below(panel).iter();
            self.local
                .extend(rows.map(|&row| panels.local(parent, row)));
        }
    }

    fn find_entries(&mut self, panels: &Panels, matrix: &Csr, connected: &[u32], position: &[u32]) {
        for panel in &panels.list {
            for k in panel.begin..panel.begin + panel.columns {
                self.starts.push(self.places.len());
                let columns = matrix.row(connected[k] as usize).0.iter();
                self.places.extend(columns.map(|&j| {
                    let row = position[j as usize];
                    match (row as usize) < k {
                        true => NONE,
                        false => {
                            let place = (k - panel.begin) * panel.rows();
                            place as u32 + panels.local(panel, row)
                        }
                    }
                }));
            }
        }
        self.starts.push(self.places.len());
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        12 * self.parent.len() + 4 * (self.local.len() + self.places.len()) + 8 * self.starts.len()
    }

    /// Computes the panels of the factor of a matrix of the pattern.
    ///
    /// # Errors
    /// The failure with the lowest position.
    pub fn factorise(
        &mut self,
        panels: &Panels,
        (matrix, connected): (&Csr, &[u32]),
        values: &mut [f64],
    ) -> Result<(), Failure> {
        let kept = self.room.take();
        let job = Job {
            fronts: self,
            panels,
            matrix,
            connected,
        };
        let small = job.fronts.pieces.len() <= 1;
        let done = if small || rayon::current_num_threads() == 1 {
            let Some(mut room) = kept.or_else(|| Room::new(job.fronts.widest)) else {
                return Err(Failure::Memory);
            };
            let done = job.subtrees(values, &mut room);
            self.room = small.then_some(room);
            done
        } else {
            job.share(values)
        };
        lock(&self.squares).end(small);
        done
    }
}

/// One factorisation.
struct Job<'a> {
    fronts: &'a Fronts,
    panels: &'a Panels,
    matrix: &'a Csr,
    connected: &'a [u32],
}

impl Job<'_> {
    /// All fronts one after the other.
    fn subtrees(&self, values: &mut [f64], room: &mut Room) -> Result<(), Failure> {
        let count = self.panels.len() as u32;
        let mut left = Vec::new();
        self.run(0..count, values, &mut left, room);
        match left.into_iter().find_map(|(_, rest)| rest.err()) {
            Some(failure) => Err(failure),
            None => Ok(()),
        }
    }

    /// The fronts of a run of supernodes that is closed under children. `values`: their panels; `left`: what they leave to parents beyond.
    fn run(
        &self,
        range: std::ops::Range<u32>,
        values: &mut [f64],
        left: &mut Vec<(u32, Rest)>,
        room: &mut Room,
    ) {
        let begin = self
            .panels
            .list
            .get(range.start as usize)
            .map_or(0, |panel| panel.value);
        for s in range {
            let panel = &self.panels.list[s as usize];
            let own = &mut values[panel.value - begin..][..panel.rows() * panel.columns];
            let children = left.len() - self.fronts.children[s as usize] as usize;
            debug_assert!(
                left[children..]
                    .iter()
                    .all(|(c, _)| self.fronts.parent[*c as usize] == s)
            );
            let rest = self.front(s, own, left.drain(children..), room);
            left.push((s, rest));
        }
    }

    /// Threads take pieces, and the fronts above as soon as their last child is there.
    fn share(&self, values: &mut [f64]) -> Result<(), Failure> {
        let fronts = self.fronts;
        let count = self.panels.len();
        let waiting: Vec<AtomicU32> = fronts.children.iter().map(|&n| AtomicU32::new(n)).collect();
        let left: Vec<Mutex<Option<Rest>>> = (0..count).map(|_| Mutex::new(None)).collect();
        let slots = self.slots(values);
        let take = |s: u32| lock(&left[s as usize]).take();
        let work = |mut s: u32| {
            let Some(mut room) = Room::new(fronts.widest) else {
                *lock(&left[s as usize]) = Some(Err(Failure::Memory));
                return;
            };
            let Some(values) = lock(&slots[s as usize]).take() else {
                return;
            };
            let mut last = Vec::new();
            self.run(
                fronts.first[s as usize]..s + 1,
                values,
                &mut last,
                &mut room,
            );
            loop {
                if let Some((_, rest)) = last.pop() {
                    *lock(&left[s as usize]) = Some(rest);
                }
                let parent = fronts.parent[s as usize];
                if parent == NONE || waiting[parent as usize].fetch_sub(1, Ordering::AcqRel) > 1 {
                    return;
                }
                s = parent;
                let Some(own) = lock(&slots[s as usize]).take() else {
                    return;
                };
                let rests: Vec<(u32, Rest)> = fronts
                    .children_of(s)
                    .into_iter()
                    .filter_map(|child| take(child).map(|rest| (child, rest)))
                    .collect();
                last.push((s, self.front(s, own, rests.into_iter(), &mut room)));
            }
        };
        rayon::in_place_scope_fifo(|scope| {
            for &piece in &fronts.pieces {
                let work = &work;
                scope.spawn_fifo(move |_| work(piece));
            }
        });
        let mut failed = left.into_iter().filter_map(|rest| match rest.into_inner() {
            Ok(Some(Err(failure))) => Some(failure),
            _ => None,
        });
        failed.next().map_or(Ok(()), Err)
    }

    /// The values of each piece, at its root, and of each front above.
    fn slots<'v>(&self, values: &'v mut [f64]) -> Vec<Mutex<Option<&'v mut [f64]>>> {
        let fronts = self.fronts;
        let mut slots: Vec<_> = (0..self.panels.len()).map(|_| Mutex::new(None)).collect();
        let mut rest = values;
        let mut pieces = fronts.pieces.iter().copied().peekable();
        let mut s = 0;
        while s < self.panels.len() {
            let root = match pieces.peek() {
                Some(&piece) if fronts.first[piece as usize] as usize == s => {
                    pieces.next();
                    piece as usize
                }
                _ => s,
            };
            let length = self.panels.list[s..=root]
                .iter()
                .map(|panel| panel.rows() * panel.columns)
                .sum();
            let (own, after) = rest.split_at_mut(length);
            slots[root] = Mutex::new(Some(own));
            rest = after;
            s = root + 1;
        }
        slots
    }

    /// Gathers, eliminates, and leaves the rest.
    fn front(
        &self,
        s: u32,
        own: &mut [f64],
        children: impl Iterator<Item = (u32, Rest)>,
        room: &mut Room,
    ) -> Rest {
        let panel = &self.panels.list[s as usize];
        self.entries(panel, own)?;
        let taken = lock(&self.fronts.squares).take(panel.below.pow(2));
        let Some(mut rest) = taken else {
            return Err(Failure::Memory);
        };
        let mut lefts = Vec::new();
        for (child, left) in children {
            let left = left?;
            let child = &self.panels.list[child as usize];
            let inner = self.extend_panel(child, &left, panel, own);
            lefts.push((child, left, inner));
        }
        let size = (panel.rows(), panel.columns);
        front::eliminate(own, &mut rest[..panel.below * panel.below], size, room)
            .map_err(|column| Failure::Pivot(panel.begin + column))?;
        for (child, left, inner) in lefts {
            self.extend_rest((child, inner), &left, panel, &mut rest);
            lock(&self.fronts.squares).give(left);
        }
        Ok(rest)
    }

    /// The entries of the matrix in the columns of a panel.
    fn entries(&self, panel: &Panel, own: &mut [f64]) -> Result<(), Failure> {
        own.fill(0.0);
        for k in panel.begin..panel.begin + panel.columns {
            let unknown = self.connected[k];
            let (columns, values) = self.matrix.row(unknown as usize);
            let places = &self.fronts.places[self.fronts.starts[k]..self.fronts.starts[k + 1]];
            for ((&place, &value), &column) in places.iter().zip(values).zip(columns) {
                if !value.is_finite() {
                    return Err(Failure::NotFinite(unknown, column, value));
                }
                if place != NONE {
                    own[place as usize] = value;
                }
            }
        }
        Ok(())
    }

    /// Adds what a child leaves to the columns of a panel; returns how many of its columns these were.
    fn extend_panel(&self, child: &Panel, left: &[f64], panel: &Panel, own: &mut [f64]) -> usize {
        let (n, rows) = (child.below, panel.rows());
        let local = self.local(child);
        let inner = local.partition_point(|&place| (place as usize) < panel.columns);
        for (j, &place) in local[..inner].iter().enumerate() {
            let from = &left[j * n + j..(j + 1) * n];
            let to = &mut own[place as usize * rows..][..rows];
            for (&row, value) in local[j..].iter().zip(from) {
                to[row as usize] += value;
            }
        }
        inner
    }

    /// Adds the other columns to what the panel leaves. `inner`: number of those before.
    fn extend_rest(
        &self,
        (child, inner): (&Panel, usize),
        left: &[f64],
        panel: &Panel,
        rest: &mut [f64],
    ) {
        let (n, below) = (child.below, panel.below);
        let local = self.local(child);
        for (j, &place) in local.iter().enumerate().skip(inner) {
            let from = &left[j * n + j..(j + 1) * n];
            let to = &mut rest[(place as usize - panel.columns) * below..][..below];
            for (&row, value) in local[j..].iter().zip(from) {
                to[row as usize - panel.columns] += value;
            }
        }
    }

    /// Rows of the parent's front for the rows below the triangle of a child.
    fn local(&self, child: &Panel) -> &[u32] {
        &self.fronts.local[child.first_row..child.first_row + child.below]
    }
}

impl Fronts {
    /// Children of a supernode, ascending.
    fn children_of(&self, s: u32) -> Vec<u32> {
        let mut children = Vec::with_capacity(self.children[s as usize] as usize);
        // the last child is the supernode before, and each child begins where the one before it ends
        let mut next = s;
        while next > self.first[s as usize] {
            children.push(next - 1);
            next = self.first[next as usize - 1];
        }
        children.reverse();
        children
    }
}

/// Nothing that holds a lock panics.
fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex
        .lock()
        .unwrap_or_else(std::sync::PoisonError::into_inner)
}

impl Failure {
    /// The error of a matrix. `unknown`: that of each position.
    pub fn of(self, matrix: &Csr, connected: &[u32]) -> Error {
        match self {
            Failure::NotFinite(row, column, value) => Error::NotFinite {
                row: row as usize,
                column: column as usize,
                value,
            },
            Failure::Pivot(position) => {
                let unknown = connected[position] as usize;
                Error::NotPositiveDefinite {
                    unknown,
                    diagonal: matrix.get(unknown, unknown),
                }
            }
            Failure::Memory => Error::Analysis {
                unknowns: connected.len(),
                reason: "out of memory".into(),
            },
        }
    }
}
