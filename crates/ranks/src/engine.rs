//! What an engine of the ranks, which solves linear equations and shares out elements, is given and tells.

/// Rows of a symmetric positive definite matrix that ranks share.
pub struct OwnRows<'a> {
    /// Where the rows of each rank begin, and their end.
    pub starts: &'a [usize],
    /// Where each own row begins in the entries, and their end.
    pub offsets: Vec<i32>,
    /// Column of each entry.
    pub columns: Vec<i32>,
    /// Entries, N/m.
    pub values: &'a [f64],
    /// Unknowns of a node; 1 where nodes have different numbers of them.
    pub block: usize,
    /// Places of the own nodes, as many coordinates as unknowns, m; empty where unknowns are not displacements alone. Rigid motions follow
    /// from them.
    pub places: Vec<f64>,
}

/// Solves with a matrix whose rows ranks share.
pub trait Engine: Send + Sync {
    /// Whether a factor of the matrix is its preconditioner, so that a solve costs two sweeps or so.
    fn is_factor(&self) -> bool;

    /// Replaces the own rows of `count` loads, one load after the other, by those of their motions, as the factor gives them.
    ///
    /// # Errors
    /// What the engine says.
    fn sweep(&mut self, loads: &mut [f64], count: usize) -> Result<(), String>;

    /// x of A x = b, whole on all ranks, and the iterations taken. They end where the residual falls below `tolerance` times that of x = 0,
    /// in the norm of the preconditioner.
    ///
    /// # Errors
    /// Iterations that do not end, with what the engine says.
    fn solve(&mut self, b: &[f64], x: &mut [f64], tolerance: f64) -> Result<usize, Unsolved>;
}

/// Why a solve did not end.
#[derive(Clone, Debug, PartialEq)]
pub struct Unsolved {
    /// Iterations taken.
    pub iterations: usize,
    /// Residual in the norm of the preconditioner over that of the load.
    pub residual: f64,
    /// What the engine says.
    pub cause: String,
}

/// Elements that are to be shared out, which of them have a face in common, and what each costs.
pub struct Graph {
    /// Where the neighbours of each element begin, and their end.
    pub offsets: Vec<i32>,
    /// Neighbours of the elements, ascending for each.
    pub neighbours: Vec<i32>,
    /// Cost of each element.
    pub weights: Vec<i32>,
}
