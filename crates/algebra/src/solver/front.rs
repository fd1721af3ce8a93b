//! The dense part of a multifrontal factorisation: one front, F = [A; B] over [B C], of which the columns of A are eliminated.
//!
//! L_A L_Aᵀ = A, L_B = B L_A⁻ᵀ, and what is left for the parent is C - L_B L_Bᵀ. Large fronts are cut into strips of a size that the front
//! alone decides, and threads share the strips: an entry is the sum of the same products in the same order on any number of threads.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{
    LltError, LltRegularization, cholesky_in_place, cholesky_in_place_scratch,
};
use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, MatMut, MatRef, Par};
use rayon::prelude::*;

/// Columns of a strip, and columns eliminated at once in large fronts.
const STRIP: usize = 192;

/// Rows of a piece of the triangular solves of large fronts.
const PIECE: usize = 512;

/// Operations from which on a front is cut into strips.
const LARGE: f64 = 2e7;

/// Scratch of the Cholesky factorisations of blocks on the diagonal.
pub(super) struct Room(MemBuffer);

impl Room {
    /// For fronts of up to `columns` columns. None without memory.
    pub fn new(columns: usize) -> Option<Room> {
        let request = cholesky_in_place_scratch::<f64>(columns, Par::Seq, Default::default());
        MemBuffer::try_new(request).ok().map(Room)
    }
}

/// Eliminates the `columns` columns of a front of `rows` rows. `panel`: A over B, column-major, on return L_A over L_B; `rest`: on return the
/// lower triangle of -L_B L_Bᵀ, column-major, square.
///
/// # Errors
/// The column whose pivot is not positive.
pub(super) fn eliminate(
    panel: &mut [f64],
    rest: &mut [f64],
    (rows, columns): (usize, usize),
    room: &mut Room,
) -> Result<(), usize> {
    let below = rows - columns;
    let operations = (columns as f64) * (rows as f64) * (rows as f64);
    if operations < LARGE {
        factor_block(panel, rows, [0, columns], room)?;
        let (top, bottom) =
            MatMut::from_column_major_slice_mut(panel, rows, columns).split_at_row_mut(columns);
        solve(top.as_ref(), bottom);
        reduce(panel, rest, (rows, columns));
        return Ok(());
    }
    for first in (0..columns).step_by(STRIP) {
        let width = STRIP.min(columns - first);
        factor_block(panel, rows, [first, width], room)?;
        let end = first + width;
        let (done, after) = panel.split_at_mut(end * rows);
        let block = &mut done[first * rows..];
        {
            let (_, block) =
                MatMut::from_column_major_slice_mut(block, rows, width).split_at_row_mut(first);
            let (top, bottom) = block.split_at_row_mut(width);
            let top = top.as_ref();
            let pieces = bottom.par_row_chunks_mut(PIECE);
            pieces.for_each(|piece| solve(top, piece));
        }
        let block = MatRef::from_column_major_slice(block, rows, width);
        let strips = after.par_chunks_mut(STRIP * rows).enumerate();
        strips.for_each(|(k, strip)| {
            let place = end + k * STRIP;
            let wide = strip.len() / rows;
            let strip = MatMut::from_column_major_slice_mut(strip, rows, wide);
            let (strip, block) = (strip.split_at_row_mut(place).1, block.split_at_row(place).1);
            subtract(strip, Accum::Add, block);
        });
    }
    if below > 0 {
        let bottom = MatRef::from_column_major_slice(panel, rows, columns)
            .split_at_row(columns)
            .1;
        let strips = rest.par_chunks_mut(STRIP * below).enumerate();
        strips.for_each(|(k, strip)| {
            let place = k * STRIP;
            let wide = strip.len() / below;
            let strip = MatMut::from_column_major_slice_mut(strip, below, wide);
            let (strip, bottom) = (
                strip.split_at_row_mut(place).1,
                bottom.split_at_row(place).1,
            );
            subtract(strip, Accum::Replace, bottom);
        });
    }
    Ok(())
}

/// The Cholesky factor of a block on the diagonal of a panel.
fn factor_block(
    panel: &mut [f64],
    rows: usize,
    [first, width]: [usize; 2],
    room: &mut Room,
) -> Result<(), usize> {
    let columns = &mut panel[first * rows..(first + width) * rows];
    let columns = MatMut::from_column_major_slice_mut(columns, rows, width);
    let block = columns.subrows_mut(first, width);
    cholesky_in_place(
        block,
        LltRegularization::default(),
        Par::Seq,
        MemStack::new(&mut room.0),
        Default::default(),
    )
    .map(|_| ())
    .map_err(|LltError::NonPositivePivot { index }| first + index)
}

/// B ← B L⁻ᵀ.
fn solve(lower: MatRef<f64>, bottom: MatMut<f64>) {
    solve_lower_triangular_in_place(lower, bottom.transpose_mut(), Par::Seq);
}

/// C ← - B Bᵀ, the lower triangle, at once.
fn reduce(panel: &[f64], rest: &mut [f64], (rows, columns): (usize, usize)) {
    let below = rows - columns;
    if below > 0 {
        let bottom = MatRef::from_column_major_slice(panel, rows, columns)
            .split_at_row(columns)
            .1;
        let rest = MatMut::from_column_major_slice_mut(rest, below, below);
        subtract(rest, Accum::Replace, bottom);
    }
}

/// The leading columns of C ← C - B Bᵀ or of C ← - B Bᵀ, on and below the diagonal.
fn subtract(strip: MatMut<f64>, accumulate: Accum, rows: MatRef<f64>) {
    let wide = strip.ncols();
    let (triangle, rectangle) = strip.split_at_row_mut(wide);
    let (top, bottom) = rows.split_at_row(wide);
    let transposed = top.transpose();
    let all = BlockStructure::Rectangular;
    matmul(
        triangle,
        BlockStructure::TriangularLower,
        accumulate,
        top,
        all,
        transposed,
        all,
        -1.0,
        Par::Seq,
    );
    faer::linalg::matmul::matmul(rectangle, accumulate, bottom, transposed, -1.0, Par::Seq);
}
