//! What a law at finite strain answers.

use carom_algebra::tensor::Mat3;
use thiserror::Error as ThisError;

use crate::tensor::matrix;
use crate::{Answer, Elastic};

/// Derivative ∂P/∂F of the first Piola-Kirchhoff stress, in Pa: entry `[3 i + j][3 k + l]` is ∂P_ij/∂F_kl.
pub type Tangent = [[f64; 9]; 9];

/// What is wanted of a law beside stress and energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Want {
    /// Nothing.
    Stress,
    /// The consistent tangent.
    Tangent,
    /// The tangent without further flow: that of elastic unloading, which is the stiffest. Of laws that do not flow the consistent one.
    Unloading,
}

impl Want {
    /// Whether a tangent is wanted.
    pub(crate) fn has_tangent(self) -> bool {
        self != Want::Stress
    }
}

/// Stress and energy of a law at one point.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// First Piola-Kirchhoff stress P in Pa.
    pub stress: Mat3,
    /// ∂P/∂F, where it was wanted.
    pub tangent: Option<Box<Tangent>>,
    /// Energy per reference volume that elastic strain stores, in J/m³.
    pub stored: f64,
    /// Energy per reference volume that hardening stores, in J/m³.
    pub hardening: f64,
    /// Energy per reference volume dissipated since the old history, in J/m³, not negative.
    pub dissipated: f64,
}

impl Response {
    pub(crate) fn of(answer: &Answer<f64>, tangent: Option<Box<Tangent>>) -> Response {
        Response {
            stress: matrix(&answer.stress),
            tangent,
            stored: answer.stored,
            hardening: answer.hardening,
            dissipated: answer.dissipated,
        }
    }
}

/// Algorithmic stress of a step between two strains.
#[derive(Clone, Debug, PartialEq)]
pub struct Conserving {
    /// Second Piola-Kirchhoff stress S_alg in Pa.
    pub stress: Mat3,
    /// ∂S_alg/∂E_1 at the same E_0, where it was wanted: entry `[3 i + j][3 k + l]`, in Pa, symmetric in each pair.
    pub moduli: Option<Box<Tangent>>,
    /// ψ(E_1) in J/m³.
    pub stored: f64,
}

/// Why a law gave no stress.
#[derive(Clone, Debug, PartialEq, ThisError)]
pub enum Failure {
    /// The volume is turned inside out.
    #[error("the deformation gradient has determinant {determinant:e}, which must be positive")]
    Inverted {
        /// det F.
        determinant: f64,
    },
}

/// A determinant, which must be positive.
pub(crate) fn positive(determinant: f64) -> Result<f64, Failure> {
    if determinant > 0.0 {
        Ok(determinant)
    } else {
        Err(Failure::Inverted { determinant })
    }
}

/// A law at finite strain, at one point.
///
/// F is the deformation gradient ∂x/∂X with all nine components: plane strain has F_33 = 1, axisymmetry F_33 = r/R.
pub trait Material {
    /// Numbers that the law keeps of a point from one step to the next.
    fn history_len(&self) -> usize;
    /// Writes the history of a point that nothing has happened to.
    fn start(&self, history: &mut [f64]);
    /// Stress at `f` at the end of a step of `dt` (s) that began with the history `old`; writes the history there into
    /// `new`.
    ///
    /// # Errors
    /// det F not positive.
    fn update(
        &self,
        f: &Mat3,
        dt: f64,
        history: (&[f64], &mut [f64]),
        want: Want,
    ) -> Result<Response, Failure>;
    /// Algorithmic stress of a step from `f_0` to `f_1` whose work on the step is exactly the change of the stored energy,
    /// P_alg : (F_1 - F_0) = ψ(F_1) - ψ(F_0), that turns with both, and its derivative by F_1; `None` of a law that has no
    /// stored energy alone. `stored` is ψ(F_1).
    ///
    /// # Errors
    /// As [`Material::update`].
    fn between(&self, f_0: &Mat3, f_1: &Mat3, want: Want) -> Option<Result<Response, Failure>>;
    /// [`Material::between`] in terms of strains: S_alg of a step to the Green-Lagrange strain `e_1` that changes it by `d`,
    /// both symmetric, with S_alg : D = ψ(E_1) - ψ(E_1 - D). For elements whose law does not see F itself; `d` comes apart
    /// from the strains, so that small steps keep their digits.
    ///
    /// # Errors
    /// det(I + 2E) not positive at the end or in the middle; that at the start is the caller's.
    fn between_strains(
        &self,
        e_1: &Mat3,
        d: &Mat3,
        want: Want,
    ) -> Option<Result<Conserving, Failure>>;
    /// Linear elasticity of the undeformed, unloaded material, and its density: wave speed and time step follow.
    fn initial(&self) -> Elastic;
}
