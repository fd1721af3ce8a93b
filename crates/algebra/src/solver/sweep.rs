//! Forward and backward sweeps over the supernodes of a factor.
//!
//! A supernode is a run of columns with one list of rows below its triangle, stored as one dense panel. A sweep gathers the
//! right-hand side of a panel, solves with it, and scatters. Dense right-hand sides visit all panels; sparse ones only those
//! on the paths of the elimination tree from their entries to the roots, the others being zero (Gilbert and Peierls 1988).

use super::panel::{self, Lanes};
use super::supernodal::Symbolic;
use pulp::{Simd, WithSimd};

/// Where the panels of a factor lie.
pub(crate) struct Panels {
    pub(super) list: Vec<Panel>,
    /// Rows below the triangles, panel after panel, ascending within one.
    pub(super) rows: Vec<u32>,
    /// Panel of each column.
    of_column: Vec<u32>,
    /// Rows of the tallest panel.
    tallest: usize,
}

/// One supernode.
#[derive(Clone, Copy)]
pub(super) struct Panel {
    /// First column, and number of columns.
    pub(super) begin: usize,
    pub(super) columns: usize,
    /// First entry in `Panels::rows`, and number of rows below the triangle.
    pub(super) first_row: usize,
    pub(super) below: usize,
    /// First entry in the values of the factor.
    pub(super) value: usize,
}

impl Panel {
    pub(super) fn rows(&self) -> usize {
        self.columns + self.below
    }

    fn values<'a>(&self, values: &'a [f64]) -> &'a [f64] {
        &values[self.value..self.value + self.rows() * self.columns]
    }

    /// Additions and multiplications that eliminate its columns.
    pub(super) fn operations(&self) -> f64 {
        let lengths = self.below + 1..=self.rows();
        lengths.map(|length| (length * length) as f64).sum()
    }
}

impl Panels {
    pub fn new(symbolic: &Symbolic) -> Self {
        let count = symbolic.n_supernodes();
        let mut panels = Self {
            list: Vec::with_capacity(count),
            rows: symbolic.row_idx().iter().map(|&i| i as u32).collect(),
            of_column: vec![0; symbolic.ncols()],
            tallest: 0,
        };
        for s in 0..count {
            let (begin, end) = (symbolic.supernode_begin()[s], symbolic.supernode_end()[s]);
            let panel = Panel {
                begin,
                columns: end - begin,
                first_row: symbolic.col_ptr_for_row_idx()[s],
                below: symbolic.supernode(s).pattern().len(),
                value: symbolic.col_ptr_for_val()[s],
            };
            panels.of_column[begin..end].fill(s as u32);
            panels.tallest = panels.tallest.max(panel.rows());
            panels.list.push(panel);
        }
        panels
    }

    /// Rows of the tallest panel: the length of the scratch of a sweep.
    pub fn tallest(&self) -> usize {
        self.tallest
    }

    /// Stored entries of the factor (lower triangles only) and operations to compute them.
    pub fn work(&self) -> (usize, f64) {
        let entries = |p: &Panel| p.columns * p.rows() - p.columns * (p.columns - 1) / 2;
        (
            self.list.iter().map(entries).sum(),
            self.list.iter().map(Panel::operations).sum(),
        )
    }

    /// Bytes held by the index arrays.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.list) + size_of_val(&*self.rows) + size_of_val(&*self.of_column)
    }

    /// Columns of a panel as a range of positions.
    pub fn columns(&self, s: u32) -> std::ops::Range<usize> {
        let panel = &self.list[s as usize];
        panel.begin..panel.begin + panel.columns
    }

    /// Adds to `path`, unsorted, the panels on the tree paths from the given positions to the roots that `mark` does not hold
    /// yet; marks them.
    pub fn climb(
        &self,
        positions: impl Iterator<Item = usize>,
        mark: &mut [bool],
        path: &mut Vec<u32>,
    ) {
        for position in positions {
            let mut s = self.of_column[position];
            while !std::mem::replace(&mut mark[s as usize], true) {
                path.push(s);
                match self.parent(s) {
                    Some(parent) => s = parent,
                    None => break,
                }
            }
        }
    }

    /// Number of panels.
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Panel in which the first row below panel `s` is a column.
    pub(super) fn parent(&self, s: u32) -> Option<u32> {
        let row = self.rows_below(&self.list[s as usize]).first()?;
        Some(self.of_column[*row as usize])
    }

    /// Row of the front of a panel: its columns, then the rows below them. The panel has the row.
    pub(super) fn local(&self, panel: &Panel, row: u32) -> u32 {
        match (row as usize).checked_sub(panel.begin) {
            Some(column) if column < panel.columns => column as u32,
            _ => {
                let place = self.rows_below(panel).partition_point(|&other| other < row);
                (panel.columns + place) as u32
            }
        }
    }

    /// Rows below the triangle of a panel, ascending.
    pub(super) fn rows_below(&self, panel: &Panel) -> &[u32] {
        &self.rows[panel.first_row..panel.first_row + panel.below]
    }
}

/// y ← L⁻¹ y for one dense right-hand side.
pub(crate) struct Forward<'a> {
    pub panels: &'a Panels,
    pub values: &'a [f64],
    pub y: &'a mut [f64],
    pub scratch: &'a mut [f64],
}

impl WithSimd for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for p in &self.panels.list {
            let rows = self.panels.rows_below(p);
            let values = p.values(self.values);
            let x = &mut self.scratch[..p.rows()];
            let (top, bottom) = x.split_at_mut(p.columns);
            top.copy_from_slice(&self.y[p.begin..p.begin + p.columns]);
            for (x, &i) in bottom.iter_mut().zip(rows) {
                *x = self.y[i as usize];
            }
            panel::forward::<S>(values, p.rows(), p.columns, x);
            self.y[p.begin..p.begin + p.columns].copy_from_slice(&x[..p.columns]);
            for (x, &i) in x[p.columns..].iter().zip(rows) {
                self.y[i as usize] = *x;
            }
        }
    }
}

/// y ← L⁻ᵀ y for one dense right-hand side.
pub(crate) struct Backward<'a> {
    pub panels: &'a Panels,
    pub values: &'a [f64],
    pub y: &'a mut [f64],
    pub scratch: &'a mut [f64],
}

impl WithSimd for Backward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for p in self.panels.list.iter().rev() {
            let rows = self.panels.rows_below(p);
            let x = &mut self.scratch[..p.rows()];
            let (top, bottom) = x.split_at_mut(p.columns);
            top.copy_from_slice(&self.y[p.begin..p.begin + p.columns]);
            for (x, &i) in bottom.iter_mut().zip(rows) {
                *x = self.y[i as usize];
            }
            panel::backward(simd, p.values(self.values), p.rows(), p.columns, x);
            self.y[p.begin..p.begin + p.columns].copy_from_slice(&x[..p.columns]);
        }
    }
}

/// y ← L⁻¹ y for several sparse right-hand sides at once, over the panels of `path` (ascending, closed under parents).
pub(crate) struct ForwardLanes<'a> {
    pub panels: &'a Panels,
    pub values: &'a [f64],
    pub path: &'a [u32],
    pub y: &'a mut [Lanes],
    pub scratch: &'a mut [Lanes],
}

impl WithSimd for ForwardLanes<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for &s in self.path {
            let p = &self.panels.list[s as usize];
            let rows = self.panels.rows_below(p);
            let x = &mut self.scratch[..p.rows()];
            let (top, bottom) = x.split_at_mut(p.columns);
            top.copy_from_slice(&self.y[p.begin..p.begin + p.columns]);
            for (x, &i) in bottom.iter_mut().zip(rows) {
                *x = self.y[i as usize];
            }
            panel::forward_lanes::<S>(p.values(self.values), p.rows(), p.columns, x);
            self.y[p.begin..p.begin + p.columns].copy_from_slice(&x[..p.columns]);
            for (x, &i) in x[p.columns..].iter().zip(rows) {
                self.y[i as usize] = *x;
            }
        }
    }
}
