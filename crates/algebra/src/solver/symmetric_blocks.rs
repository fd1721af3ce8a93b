//! Half of a symmetric matrix, in square blocks: the diagonal and what is right of it.
//!
//! A product reads each block once and uses it twice, for its row and, transposed, for its column. Half the entries and one index a block
//! are 4.2 bytes for each entry of a matrix with three unknowns a node, where rows take 12; products are at the speed of memory.
//!
//! Rows are cut into chunks of a size that the matrix decides on. A chunk sums into its own vector, over its rows and the columns right of them
//! ("outside"), and the chunks' vectors are added in their order: the bits of a product are the same on any number of threads and ranks.

use std::ops::Range;

use rayon::prelude::*;

use super::shared_rows::SharedRows;
use crate::csr::Csr;

/// Half of a symmetric matrix, or of the rows of it that a rank multiplies.
pub(super) struct SymmetricBlocks {
    /// Rows of a block.
    size: usize,
    /// Block rows of all chunks but the last.
    length: usize,
    /// Those that are multiplied; the others are empty.
    kept: Range<usize>,
    chunks: Vec<Chunk>,
}

/// Some block rows that follow each other.
#[derive(Default)]
struct Chunk {
    rows: Range<usize>,
    /// First block of each row, that on the diagonal, and an end.
    starts: Vec<u32>,
    /// Places of their columns among the own rows and, after these, the outside ones.
    places: Vec<u32>,
    /// Row-major.
    values: Vec<f64>,
    /// Block columns beyond the own rows, ascending.
    outside: Vec<u32>,
    /// Chunks before that have outside columns here, and which of theirs.
    from: Vec<(usize, Range<usize>)>,
    /// Entries of the factor and the product at these places.
    x: Vec<f64>,
    y: Vec<f64>,
}

impl SymmetricBlocks {
    /// Takes the diagonal and the right half of a matrix, of which blocks are a fair part: they are stored whole. The chunks that are not
    /// multiplied here need no rows.
    pub(super) fn new(matrix: &Csr, rows: &SharedRows) -> SymmetricBlocks {
        let (size, length) = (rows.size, rows.length);
        let mut blocks = SymmetricBlocks {
            size,
            length,
            kept: rows.chunks.clone(),
            chunks: Vec::new(),
        };
        blocks
            .chunks
            .resize_with(rows.chunk_count(), Chunk::default);
        blocks.take(matrix);
        blocks
    }

    /// Takes the pattern and the values of the kept chunks.
    fn take(&mut self, matrix: &Csr) {
        let (size, length, kept) = (self.size, self.length, self.kept.clone());
        let (rows, chunks) = (matrix.n / size, &mut self.chunks);
        for number in kept.clone() {
            let start = number * length;
            chunks[number] = Chunk::new(matrix, size, start..(start + length).min(rows));
        }
        for number in kept {
            let outside = std::mem::take(&mut chunks[number].outside);
            let mut begin = 0;
            for of in outside.chunk_by(|a, b| *a as usize / length == *b as usize / length) {
                let range = begin..begin + of.len();
                begin = range.end;
                chunks[of[0] as usize / length].from.push((number, range));
            }
            chunks[number].outside = outside;
        }
    }

    /// Takes the values of another matrix; the pattern too, where it is another.
    pub(super) fn renew(&mut self, matrix: &Csr) {
        let size = self.size;
        let renewed = self.chunks[self.kept.clone()].par_iter_mut();
        let renewed = renewed.map(|chunk| chunk.take_values(matrix, size));
        if !renewed.reduce(|| true, |one, other| one && other) {
            self.chunks.fill_with(Chunk::default);
            self.take(matrix);
        }
    }

    /// Unknowns of all chunks but the last.
    pub(super) fn length(&self) -> usize {
        self.length * self.size
    }

    /// Bytes that a product of some chunks reads and writes beside its two vectors.
    pub(super) fn bytes(&self, own: Range<usize>) -> usize {
        let of = |chunk: &Chunk| {
            8 * chunk.values.len() + 4 * chunk.places.len() + 16 * (chunk.x.len() + chunk.y.len())
        };
        self.chunks[own].iter().map(of).sum()
    }

    /// Entries kept.
    pub(super) fn entries(&self) -> usize {
        self.chunks.iter().map(|chunk| chunk.values.len()).sum()
    }

    /// y = A x in the rows of some chunks, the own ones of the rank; `y` has all rows, of which the others stay.
    pub(super) fn multiply(&mut self, own: Range<usize>, x: &[f64], y: &mut [f64]) {
        let size = self.size;
        let before = self.chunks[own.clone()].iter();
        let before = before.filter_map(|chunk| Some(chunk.from.first()?.0)).min();
        let first = before.unwrap_or(own.start).min(own.start);
        let needed = self.chunks[first..own.end].par_iter_mut();
        needed.for_each(|chunk| match size {
            6 => chunk.multiply::<6>(x),
            3 => chunk.multiply::<3>(x),
            2 => chunk.multiply::<2>(x),
            _ => chunk.multiply::<1>(x),
        });
        let length = self.length();
        let [begin, end] = [own.start, own.end].map(|chunk| y.len().min(chunk * length));
        let chunks = &self.chunks;
        let parts = y[begin..end].par_chunks_mut(length).enumerate();
        parts.for_each(|(k, y)| {
            let chunk = &chunks[own.start + k];
            y.copy_from_slice(&chunk.y[..y.len()]);
            for (other, range) in &chunk.from {
                let other = &chunks[*other];
                let sums = other.y[size * other.rows.len()..].chunks_exact(size);
                let outside = other.outside.iter().zip(sums);
                for (&column, sums) in outside.skip(range.start).take(range.len()) {
                    let place = size * (column as usize - chunk.rows.start);
                    for (y, sum) in y[place..place + size].iter_mut().zip(sums) {
                        *y += sum;
                    }
                }
            }
        });
    }
}

impl Chunk {
    fn new(matrix: &Csr, size: usize, rows: Range<usize>) -> Chunk {
        let mut columns: Vec<u32> = Vec::new();
        let mut chunk = Chunk {
            starts: vec![0],
            ..Chunk::default()
        };
        for row in rows.clone() {
            let begin = columns.len();
            columns.push(row as u32);
            for i in size * row..size * (row + 1) {
                let all = matrix.row(i).0.iter().map(|j| j / size as u32);
                columns.extend(all.filter(|column| *column as usize > row));
            }
            columns[begin..].sort_unstable();
            let mut kept = begin + 1;
            for k in begin + 1..columns.len() {
                if columns[k] != columns[kept - 1] {
                    columns[kept] = columns[k];
                    kept += 1;
                }
            }
            columns.truncate(kept);
            chunk.starts.push(kept as u32);
        }
        let beyond = columns.iter().filter(|j| **j as usize >= rows.end);
        let mut outside: Vec<u32> = beyond.copied().collect();
        outside.sort_unstable();
        outside.dedup();
        let place = |column: &u32| match (*column as usize) < rows.end {
            true => column - rows.start as u32,
            false => (rows.len() + outside.partition_point(|other| other < column)) as u32,
        };
        chunk.places = columns.iter().map(place).collect();
        let length = size * (rows.len() + outside.len());
        (chunk.x, chunk.y) = (vec![0.0; length], vec![0.0; length]);
        chunk.values = vec![0.0; columns.len() * size * size];
        (chunk.rows, chunk.outside) = (rows, outside);
        chunk.take_values(matrix, size);
        chunk
    }

    /// Whether the matrix has no entry outside of the blocks; its values are then taken.
    fn take_values(&mut self, matrix: &Csr, size: usize) -> bool {
        self.values.fill(0.0);
        let own = self.rows.len();
        let column = |place: u32| match (place as usize).checked_sub(own) {
            None => self.rows.start + place as usize,
            Some(outside) => self.outside[outside] as usize,
        };
        for (row, ends) in self.rows.clone().zip(self.starts.windows(2)) {
            let (begin, end) = (ends[0] as usize, ends[1] as usize);
            for i in 0..size {
                let (all, values) = matrix.row(size * row + i);
                let mut block = begin;
                let right = all.partition_point(|j| (*j as usize) < size * row);
                for (&j, &value) in all[right..].iter().zip(&values[right..]) {
                    let wanted = j as usize / size;
                    while block < end && column(self.places[block]) < wanted {
                        block += 1;
                    }
                    if block == end || column(self.places[block]) != wanted {
                        return false;
                    }
                    self.values[(block * size + i) * size + j as usize % size] = value;
                }
            }
        }
        true
    }

    /// y = A x of the own blocks.
    fn multiply<const D: usize>(&mut self, x: &[f64]) {
        let (all, _) = x.as_chunks::<D>();
        let (x, _) = self.x.as_chunks_mut::<D>();
        let (own, outside) = x.split_at_mut(self.rows.len());
        own.copy_from_slice(&all[self.rows.clone()]);
        for (to, &column) in outside.iter_mut().zip(&self.outside) {
            *to = all[column as usize];
        }
        self.y.fill(0.0);
        let (y, _) = self.y.as_chunks_mut::<D>();
        let (rows, _) = self.values.as_chunks::<D>();
        let (blocks, _) = rows.as_chunks::<D>();
        for (row, ends) in self.starts.windows(2).enumerate() {
            let range = ends[0] as usize..ends[1] as usize;
            let own = x[row];
            let mut sum = [0.0; D];
            let mut of_row = self.places[range.clone()].iter().zip(&blocks[range]);
            if let Some((_, diagonal)) = of_row.next() {
                for i in 0..D {
                    for j in 0..D {
                        sum[i] += diagonal[i][j] * own[j];
                    }
                }
            }
            // wider registers than those of the baseline gain nothing: the blocks come from memory
            for (&place, block) in of_row {
                let (other, across) = (x[place as usize], &mut y[place as usize]);
                for i in 0..D {
                    for j in 0..D {
                        sum[i] += block[i][j] * other[j];
                        across[j] += block[i][j] * own[i];
                    }
                }
            }
            for i in 0..D {
                y[row][i] += sum[i];
            }
        }
    }
}
