//! One row of a link.

/// One row of C, which couples velocities: unknowns and coefficients, with the sign of the side.
pub type LinkRow = Vec<(u32, f64)>;

/// A row applied to a vector.
pub fn on(row: &LinkRow, vector: &[f64]) -> f64 {
    row.iter().map(|&(dof, c)| c * vector[dof as usize]).sum()
}
