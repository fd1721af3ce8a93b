//! The interface problem of one step with Coulomb friction: normal and tangential forces, statuses of both.
//!
//! With D the condensed compliance over the normal and tangential rows of all candidates and p = (P, t) their forces,
//! ```text
//! gap and rate     g₊ = g_f + s_g (D p)_n,   ġ₊ = ġ_f + s_v (D p)_n,   the relation of the law, as without friction
//! sliding          q = q_f + s_t (D p)_t     of the secondary over the primary
//! friction         |t| <= μ max(P, 0);   q = 0 where |t| < μ P,   else q = -α t with α >= 0
//! ```
//! t is the force on the secondary. In space the cone is round. Stick or slip is a sign field beside that of the normal.
//!
//! Method: the semi-smooth Newton method on the equations of Alart and Curnier (1991), `trial.rs` and `newton.rs`; in the
//! plane it moves from one set of statuses to the next. Where its passes bring nothing, sweeps of nonsmooth Gauss-Seidel
//! (Jean and Moreau 1992), `sweep.rs`, give it a better start, and the next passes are damped, then proximal; the number
//! of sweeps doubles each time. The methods are known, the texts of both papers were not at hand; the equations are
//! derived in `trial.rs`.
//!
//! Solutions exist for positive definite D, but for large μ there may be several. Nearly all such problems are solved in
//! about ten passes; where many contacts jam a body of few freedoms (D of low rank, μ of one and more) some are not, and
//! the error names the worst candidate.
//!
//! Where D is the product of the sparse rows of a lumped mass ([`crate::Lumped`]), sweeps are all, mixed after Anderson (`anderson.rs`): D is then as well conditioned as the
//! masses of the nodes that touch are alike, and nothing grows faster than the number of points.
//! Where D is not known, forces are found with the motion (`together.rs`).
//! Laws that are not linear give their tangents, which are renewed around all of this (`renewed.rs`). Tension that laws cut off acts on no other point (`cut.rs`).
//! [`FrictionProblem::defect`] measures a solution by code that knows no solver.

mod anderson;
mod cut;
mod defect;
mod newton;
mod posed;
mod problem;
mod renewed;
mod rows;
mod solver;
mod sweep;
mod tangential;
#[cfg(test)]
mod tests;
mod together;
mod trial;

pub use posed::Posed;
pub use problem::{FrictionProblem, FrictionSolution};
pub use solver::Coulomb;
pub use tangential::{FrictionFailure, Slip, Tangential};
