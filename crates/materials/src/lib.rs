//! Constitutive laws at one point: numbers in, numbers out. A law sees a strain, never a shape function.
//!
//! Adding a material: one file, and its lines here.

/// The list of materials: each with what the case file says of it, and its key there. Calls the macro `use` with the tokens
/// behind its name and with the list.
#[macro_export]
macro_rules! materials {
    ($use:ident $($with:tt)*) => {
        $use! {
            [$($with)*]
            /// Linear isotropic elasticity, small strain.
            Elastic "elastic",
            /// St Venant-Kirchhoff elasticity: linear between second Piola-Kirchhoff stress and Green-Lagrange strain. Large rotations,
            /// moderate strains; it softens in compression.
            StVenantKirchhoff "st-venant-kirchhoff",
            /// Compressible neo-Hookean elasticity.
            NeoHooke "neo-hooke",
            /// Compressible Mooney-Rivlin elasticity.
            MooneyRivlin "mooney-rivlin",
            /// Von Mises plasticity in logarithmic strain, with linear isotropic hardening.
            J2Plasticity "j2",
            /// Linear viscoelasticity: a spring beside branches of spring and dashpot in shear. Moderate strains. The moduli are
            /// the instantaneous ones, before relaxation.
            Maxwell "maxwell",
            /// Von Mises plasticity in logarithmic strain, with isotropic hardening by a table.
            J2Table "j2-table",
            /// Von Mises plasticity of Johnson and Cook: hardening by a power of the plastic strain, by its rate, and softening by the
            /// heat of the flow.
            JohnsonCook "johnson-cook",
        }
    };
}

mod conserving;
mod elastic;
mod flow;
mod hardening;
mod hyperelastic;
mod j2_plasticity;
mod j2_table;
mod johnson_cook;
mod lagrange;
mod list;
mod material;
mod maxwell;
mod mooney_rivlin;
mod neo_hooke;
mod no_flow;
mod parameters;
mod plane_points;
mod plane_stress;
mod pointwise;
mod range;
mod side_by_side;
mod spectral;
mod st_venant_kirchhoff;
pub mod tensor;
mod uniaxial;

pub use elastic::{Elastic, Plane};
pub use j2_plasticity::J2Plasticity;
pub use j2_table::{HardeningPoint, J2Table, MAX_HARDENING_POINTS};
pub use johnson_cook::{JohnsonCook, Thermal};
pub use lagrange::Derivative;
pub use list::Law;
pub use material::{Conserving, Failure, Material, Response, Tangent, Want};
pub use maxwell::{Branch, MAX_BRANCHES, Maxwell};
pub use mooney_rivlin::MooneyRivlin;
pub use neo_hooke::NeoHooke;
pub use no_flow::elastic_in_plane;
pub use parameters::Parameters;
pub use plane_points::{EachPoint, MAX_KEPT_IN_PLANE, PlaneStressPoints, SIDE};
pub use plane_stress::{PlaneStress, PlaneStressResponse};
pub use pointwise::{Answer, MAX_KEPT, Pointwise};
pub use range::OutOfRange;
pub use st_venant_kirchhoff::StVenantKirchhoff;
pub use tensor::Tensor;
pub use uniaxial::{Uniaxial, UniaxialResponse};
