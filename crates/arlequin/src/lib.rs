//! Coupling of overlapping models.
//!
//! Two models of one body, each with its own mesh, have a region S in common (the Arlequin method). Three things make
//! them one:
//!
//! - **Weights.** Inertia and internal work of each model are multiplied by functions α and δ that add up to one:
//!   [`Overlap::weights`].
//! - **A mediator.** The velocities are made equal on S in the mean: <v_c - v_s, μ>_S = 0 for all functions μ of a
//!   space, with <L, w>_S = ∫_S (L·w + κ² ε(L):ε(w)). These are rows C_c v_c - C_s v_s = 0: [`Overlap::rows`].
//! - **A common refinement.** μ, the shape functions of both meshes and the weights are integrated on the cells of one
//!   mesh cut by those of the other: [`Overlap`].
//!
//! The equations of motion are then M_c a_c + f_c = C_cᵀ L and M_s a_s + f_s = -C_sᵀ L, with masses weighted by α and
//! internal forces by δ. A field of constant stress σ passes if L = -σ ∇δ_c is in the mediator space and the products are
//! integrated exactly: with linear weights on a strip, where ∇δ is constant. Where S turns a corner it is not, and no
//! continuous mediator follows: the strain errs by an amount that falls with the size of the outer cells.
//!
//! Everything is in the initial configuration, where both models occupy the same points. The crate knows meshes, not
//! bodies: it gives numbers per cell and node, which bodies and time schemes use.
//!
//! Shape functions of cells that are not affine are no polynomials of the position: pieces of such cells are integrated
//! with a rule of a degree raised by six, not exactly. Affine fields are still coupled exactly: they are the same number
//! in both models at every point, whatever the rule.
//!
//! A beam and a solid have overlaps of their own kind: [`BeamOverlap`]; a shell and a solid too: [`ShellOverlap`].
//!
//! Sources: H. Ben Dhia, C. Zammali, F. Voldoire, S. Lamarche (2003), equations (11)-(12); H. Ben Dhia, G. Rateau (2005)
//! for the method in statics. The integration on the common refinement, the weight by distances and the treatment of
//! slivers are this project's.

mod beam;
mod border;
mod cell;
mod coupling;
mod edge;
mod ends;
mod error;
mod faces;
mod model;
mod overlap;
mod polytope;
mod refine;
mod rows;
mod rule;
mod shell;
mod trace;
mod weights;

pub use beam::{BeamCell, BeamModels, BeamOverlap, SectionMotion};
pub use coupling::{Bracket, Coupling, Integration, Mediator, SliverRule};
pub use edge::{EdgeCell, edge_mean_motion, edge_rigid_motion};
pub use error::{Error, Model};
pub use faces::mean_motion;
pub use overlap::{Models, Overlap, Region};
pub use rows::{AxisProducts, Rank, Row, Rows, Sliver, Term};
pub use shell::{ShellCell, ShellModels, ShellOverlap};
pub use trace::trace;
pub use weights::{CellWeights, Profile, Warning, Weighting, Weights, means};
