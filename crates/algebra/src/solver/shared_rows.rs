//! Which rows of a symmetric matrix each of several ranks has.

use std::ops::Range;

use carom_ranks::Ranks;

/// Block rows of a chunk: a sixteenth of all, within these limits.
const ROWS: Range<usize> = 1024..4096;

/// The rows of a symmetric matrix that each rank has, for products and for an engine. Products go by chunks of block rows, whose number the
/// matrix decides on, so that their bits do not depend on the number of ranks.
#[derive(Clone, Debug)]
pub struct SharedRows {
    ranks: Ranks,
    /// Number of rows.
    pub(super) n: usize,
    /// Rows of a block.
    pub(super) size: usize,
    /// Block rows of all chunks but the last.
    pub(super) length: usize,
    /// First chunk of each rank, and an end.
    pub(super) starts: Vec<usize>,
    /// Chunks that this rank multiplies: its own, and those before that have columns among its rows.
    pub(super) chunks: Range<usize>,
    /// First row of each rank for an engine, and an end.
    pub(super) engine: Vec<usize>,
}

impl SharedRows {
    /// The rows of one process. `group_of[i]`: node of unknown i; those of a node follow each other. Blocks are those of nodes where all have as
    /// many unknowns, else parts of them: of six unknowns displacement and rotation.
    pub fn alone(group_of: &[u32]) -> SharedRows {
        SharedRows::new(group_of, &Ranks::alone(), |own| own.start)
    }

    /// The rows of ranks that share them in their order. `first_beside`: the least unknown that any unknown of a range is coupled with.
    pub fn new(
        group_of: &[u32],
        ranks: &Ranks,
        first_beside: impl FnOnce(Range<usize>) -> usize,
    ) -> SharedRows {
        let size = common_size(group_of);
        let n = group_of.len();
        let length = (n / size / 16).clamp(ROWS.start, ROWS.end);
        let starts = ranks.starts((n / size).div_ceil(length));
        let engine = ranks.starts(n / size).into_iter();
        let engine = engine.map(|block| block * size).collect();
        let own = starts[ranks.rank()]..starts[ranks.rank() + 1];
        let mut rows = SharedRows {
            ranks: ranks.clone(),
            n,
            size,
            length,
            starts,
            chunks: own.clone(),
            engine,
        };
        if !own.is_empty() {
            let before = first_beside(rows.unknowns(&own)) / (size * length);
            rows.chunks.start = before.min(own.start);
        }
        rows
    }

    /// The unknowns whose rows this rank needs.
    pub fn needed(&self) -> Range<usize> {
        let products = self.unknowns(&self.chunks);
        if !self.ranks.has_engine() {
            return products;
        }
        let engine = self.engine_rows();
        match [products.is_empty(), engine.is_empty()] {
            [true, _] => engine,
            [_, true] => products,
            _ => products.start.min(engine.start)..products.end.max(engine.end),
        }
    }

    /// Whether several ranks share the rows.
    pub fn are_shared(&self) -> bool {
        self.ranks.count() > 1
    }

    /// Who shares them.
    pub fn ranks(&self) -> &Ranks {
        &self.ranks
    }

    /// The first unknown of each rank for products, and an end.
    pub fn unknown_starts(&self) -> Vec<usize> {
        let starts = self.starts.iter();
        starts.map(|&chunk| self.first_unknown(chunk)).collect()
    }

    /// Number of chunks.
    pub(super) fn chunk_count(&self) -> usize {
        (self.n / self.size).div_ceil(self.length)
    }

    /// The chunks that are this rank's own.
    pub(super) fn own(&self) -> Range<usize> {
        let rank = self.ranks.rank();
        self.starts[rank]..self.starts[rank + 1]
    }

    /// The rows of this rank for an engine.
    pub(super) fn engine_rows(&self) -> Range<usize> {
        let rank = self.ranks.rank();
        self.engine[rank]..self.engine[rank + 1]
    }

    /// The unknowns of some chunks.
    pub(super) fn unknowns(&self, chunks: &Range<usize>) -> Range<usize> {
        self.first_unknown(chunks.start)..self.first_unknown(chunks.end)
    }

    fn first_unknown(&self, chunk: usize) -> usize {
        (chunk * self.length * self.size).min(self.n)
    }
}

/// Unknowns of a block: those of a node where all nodes have as many, else what divides all.
fn common_size(group_of: &[u32]) -> usize {
    let nodes = || group_of.chunk_by(|a, b| a == b).map(<[u32]>::len);
    let divides = |size: &usize| nodes().all(|unknowns| unknowns % size == 0);
    let alike = |size: &usize| *size < 6 || nodes().all(|unknowns| unknowns == 6);
    [6, 3, 2]
        .into_iter()
        .find(|size| divides(size) && alike(size))
        .unwrap_or(1)
}
