//! Bolts that a static stage tightens.
//!
//! A bolt has an elongation `e = Σ c u` of some unknowns and a stiffness k. Over the static stage its force is prescribed: `N = s F`, with
//! the share s of the stage, whatever e is; it has no stiffness then. At the end of a step of the stage its *slack-free force* is
//! `g = s F - k e`, the force that it would have at the places of the mesh. That is kept, and with it the length by which the bolt was
//! shortened, its lap `F/k - e`. In the dynamics `N = k e + g = F + k (e - e_end)`: k is a stiffness as any other, and g a constant force.
//!
//! Both forces, s F and g, are loads of the system on the unknowns of e; the stiffness is that of the body.

use carom_mesh::ElementId;

/// A cell of beams that is tightened.
#[derive(Clone, Debug, PartialEq)]
pub struct TightenedCell {
    /// Name of the bolt.
    pub name: String,
    /// The cell.
    pub cell: ElementId,
    /// Normal force at the end of the static stage, N, positive in tension.
    pub force: f64,
    /// Whether the body is that of the static stage: the cell has no axial stiffness.
    pub tightens: bool,
}

/// A bolt in the numbers of a system.
#[derive(Clone, Debug, PartialEq)]
pub struct Bolt {
    /// Name.
    pub name: String,
    /// F, N, positive in tension.
    pub force: f64,
    /// k, N/m.
    pub stiffness: f64,
    /// Unknowns and coefficients of the elongation.
    pub row: Vec<(usize, f64)>,
}

impl Bolt {
    /// e in m.
    pub fn elongation(&self, u: &[f64]) -> f64 {
        self.row.iter().map(|&(i, c)| c * u[i]).sum()
    }

    /// N, positive in tension; `kept`: g in N.
    pub fn tension(&self, u: &[f64], kept: f64) -> f64 {
        self.stiffness * self.elongation(u) + kept
    }

    /// g in N of a bolt with this tension (N).
    pub fn kept(&self, u: &[f64], tension: f64) -> f64 {
        tension - self.stiffness * self.elongation(u)
    }

    /// Adds the forces on the system of a tension (N) to a system vector: they pull the ends together.
    pub fn add_load(&self, tension: f64, load: &mut [f64]) {
        for &(i, c) in &self.row {
            load[i] -= c * tension;
        }
    }
}
