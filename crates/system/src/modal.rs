//! Damping of modes of a body: the classical damping matrix that gives each of them a ratio.

use std::f64::consts::TAU;
use std::ops::Range;

use carom_algebra::unknowns::Unknowns;

/// Damping of some modes of a body, C = Σ b bᵀ with b = √(2 ζ ω) M φ and φᵀ M φ = 1: so φᵀ C φ = 2 ζ ω, and the other modes and rigid motions
/// are not damped (Clough and Penzien 1975). C is full; b are kept, one for each mode.
#[derive(Clone, Debug)]
pub struct ModalDamping {
    /// Unknowns of the body, in numbers of its own.
    pub unknowns: Unknowns,
    /// Node of the mesh of each node of the body.
    pub mesh_node: Vec<u32>,
    /// b of each mode over these unknowns, √(kg/s).
    pub columns: Vec<Vec<f64>>,
    /// Frequency (Hz) and ratio ζ of each mode.
    pub modes: Vec<[f64; 2]>,
}

/// Damping of modes in the numbers of a system.
#[derive(Debug)]
pub struct NumberedModal {
    /// The body.
    pub body: usize,
    /// Unknowns of the system.
    unknowns: Vec<u32>,
    columns: Vec<Vec<f64>>,
    /// Frequency (Hz) and ratio ζ of each mode.
    pub modes: Vec<[f64; 2]>,
}

impl NumberedModal {
    /// `number`: system number of each node of the mesh; `unknowns`: of the system.
    pub(crate) fn new(
        body: usize,
        given: &ModalDamping,
        (number, unknowns): (&[u32], &Unknowns),
    ) -> NumberedModal {
        // a node may have rotations that this body does not know
        let of_node = |(own, &mesh_node): (usize, &u32)| {
            let first = unknowns.first(number[mesh_node as usize]);
            let count = given.unknowns.of(own as u32).len();
            first as u32..(first + count) as u32
        };
        let nodes = given.mesh_node.iter().enumerate();
        NumberedModal {
            body,
            unknowns: nodes.flat_map(of_node).collect(),
            columns: given.columns.clone(),
            modes: given.modes.clone(),
        }
    }

    /// Largest 2 ζ ω, 1/s.
    pub fn rate(&self) -> f64 {
        let rates = self.modes.iter().map(|[f, ratio]| 2.0 * ratio * TAU * f);
        rates.fold(0.0, f64::max)
    }

    /// Adds C v to `f`, N.
    pub fn add_force(&self, v: &[f64], f: &mut [f64]) {
        for column in &self.columns {
            let terms = column.iter().zip(&self.unknowns);
            let rate: f64 = terms.map(|(b, &unknown)| b * v[unknown as usize]).sum();
            for (b, &unknown) in column.iter().zip(&self.unknowns) {
                f[unknown as usize] += rate * b;
            }
        }
    }

    /// The columns b over the unknowns of a part, which has those of the body.
    pub fn columns_of(&self, part: &Range<usize>) -> impl Iterator<Item = Vec<f64>> + '_ {
        let (start, len) = (part.start, part.len());
        self.columns.iter().map(move |column| {
            let mut own = vec![0.0; len];
            for (b, &unknown) in column.iter().zip(&self.unknowns) {
                own[unknown as usize - start] = *b;
            }
            own
        })
    }
}
