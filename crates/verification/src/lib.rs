//! Cases with an analytic or published answer.
//!
//! One file per case: its header states the problem, the closed solution, where the reference comes from, and why the
//! tolerance is what it is. A case is a [`Check`] that computes rows (quantity, value, what it must be, [`Kind`] of what
//! judges it) at two sizes: the tests of this crate (`tests/all`) run all quick ones, [`verify`] the size that it is asked for.
//!
//! Adding a case: one file, its `mod` line, its name in the list below.

mod bars;
mod battery;
mod breathing_tube;
mod build;
mod check;
mod collision;
mod error;
mod explicit_implicit;
mod features;
mod features_links;
mod figures;
mod glued;
mod glued_bar;
mod hairpin;
mod hertz;
mod kept;
mod kind;
mod meshes;
mod newton_order;
mod page;
mod plastic_wave;
mod plates;
mod points;
mod pounding;
mod reasons;
mod repeated;
mod side_by_side;
mod witness;
mod words;

mod adaptive;
mod adaptive_bars;
mod adaptive_features;
mod arlequin_bars;
mod arlequin_block;
mod arlequin_energy;
mod arlequin_large;
mod arlequin_oblique;
mod arlequin_pulse;
mod arlequin_stability;
mod arlequin_start;
mod assembly_row;
mod bar_dropped;
mod bar_on_stop;
mod bar_on_wall;
mod bars_central_difference;
mod bars_compliance;
mod bars_contact_stabilised;
mod bars_convergence;
mod bars_damped;
mod bars_massless;
mod bars_newmark;
mod bars_projection;
mod bars_schemes;
mod bars_stages;
mod bars_theta;
mod base_motion;
mod bathe;
mod beam_contact;
mod beam_deflections;
mod beam_frequencies;
mod beam_joints;
mod beam_on_stop;
mod beam_pulse;
mod beam_solid;
mod beam_solid_impact;
mod beam_solid_large;
mod beam_solid_patch;
mod beam_solid_waves;
mod beams;
mod block_drop;
mod blocks;
mod blocks_as_bars;
mod bouncing_mass;
mod closed_field_as_printed;
pub mod combinations;
mod connected_parts;
mod contact_patch;
mod conveyor;
mod coulomb_oscillator;
mod crushed_stop;
mod crushed_tube;
mod deletion;
mod elastic_plastic_bars;
mod elastic_plastic_beams;
mod elastic_plastic_shells;
mod energy_identity;
mod energy_identity_features;
mod first_force;
mod glued_rotating;
mod glued_substeps;
mod glued_turning;
mod hertz_cylinder;
mod hertz_impact;
mod hertz_point;
mod hertz_spheres;
mod interface_problems;
mod invariance;
mod ironing;
mod iterative_solver;
mod knocking_oscillators;
mod large_beams;
mod large_shells;
pub mod long_run;
mod mass_on_stop;
mod modal_damping;
mod modes;
mod oblique_bar;
mod one_point_shells;
mod orbiting_mass;
mod order;
mod order_features;
pub mod pairs;
mod quadrature;
mod random_field;
mod reduced_bodies;
mod rejections;
mod rejections_features;
mod restitution;
mod resume;
mod resume_features;
mod rigid_cube;
mod rigid_hammer;
mod rigid_sphere;
mod rigid_top;
mod ring_sector;
pub mod rings;
mod rod_in_grid;
mod rubbing_stops;
mod sdnl111;
mod sdnl111_bars;
mod self_contact;
mod shapes;
mod shell_benchmarks;
mod shell_edges;
mod shell_mortar;
mod shell_sections;
mod shell_self_contact;
mod shell_solid;
mod shell_solid_impact;
mod shell_solid_large;
mod shell_solid_patch;
mod shell_solid_waves;
mod shells;
mod shock_front;
mod sliding_block;
mod sliding_work;
mod spinning_bar;
mod spinning_ring;
mod static_friction;
mod static_links;
mod stick_slip;
mod supports;
mod synthetic_record;
mod taylor_bar;
mod taylor_bar_steel;
mod threads;
mod threads_features;
mod tied_surfaces;
mod tori;
mod viability;
mod wave_packet;
mod zones_glued_at_contact;
mod zones_in_contact;

use std::io::{self, Write};

pub use check::{Check, Expected, Made, Row, Size, Verdict};
pub use error::Error;
pub use kind::{Counts, Kind};
pub use witness::{Compared, Shown};

/// Gives the list of case modules to a macro.
#[doc(hidden)]
#[macro_export]
macro_rules! cases {
    ($take:ident) => {
        $take! {
            adaptive
            adaptive_bars
            adaptive_features
            arlequin_bars
            arlequin_block
            arlequin_energy
            arlequin_large
            arlequin_oblique
            arlequin_pulse
            arlequin_stability
            arlequin_start
            assembly_row
            bar_on_stop
            bar_dropped
            bar_on_wall
            bars_central_difference
            bars_compliance
            bars_contact_stabilised
            bars_convergence
            bars_damped
            bars_massless
            bars_newmark
            bars_projection
            bars_schemes
            bars_stages
            bars_theta
            base_motion
            bathe
            beam_contact
            beam_deflections
            beam_frequencies
            beam_joints
            large_beams
            large_shells
            beam_on_stop
            beam_pulse
            beam_solid_impact
            beam_solid_large
            beam_solid_patch
            beam_solid_waves
            block_drop
            blocks
            blocks_as_bars
            bouncing_mass
            breathing_tube
            closed_field_as_printed
            combinations
            contact_patch
            connected_parts
            conveyor
            coulomb_oscillator
            crushed_stop
            crushed_tube
            deletion
            elastic_plastic_bars
            elastic_plastic_beams
            elastic_plastic_shells
            energy_identity
            energy_identity_features
            explicit_implicit
            first_force
            glued_rotating
            glued_substeps
            hertz_cylinder
            hertz_impact
            hertz_point
            hertz_spheres
            interface_problems
            invariance
            ironing
            iterative_solver
            knocking_oscillators
            long_run
            mass_on_stop
            modal_damping
            modes
            oblique_bar
            one_point_shells
            orbiting_mass
            order
            order_features
            pairs
            plastic_wave
            plates
            pounding
            quadrature
            random_field
            reduced_bodies
            rejections
            rejections_features
            restitution
            resume
            resume_features
            rigid_cube
            rigid_hammer
            rigid_sphere
            rigid_top
            ring_sector
            rings
            rod_in_grid
            rubbing_stops
            sdnl111
            sdnl111_bars
            self_contact
            shell_mortar
            shell_sections
            shell_edges
            shell_self_contact
            shapes
            shell_benchmarks
            shell_solid_impact
            shell_solid_large
            shell_solid_patch
            shell_solid_waves
            shock_front
            sliding_block
            sliding_work
            spinning_bar
            spinning_ring
            static_friction
            static_links
            stick_slip
            supports
            synthetic_record
            taylor_bar
            taylor_bar_steel
            threads
            threads_features
            tied_surfaces
            tori
            viability
            zones_glued_at_contact
            zones_in_contact
        }
    };
}

/// Makes of the list of case modules the registry.
macro_rules! registry {
    ($($case:ident)*) => {
        /// All cases.
        pub fn checks() -> Vec<Check> {
            vec![$($case::CHECK),*]
        }

        /// Names of all cases with the texts of their files.
        #[doc(hidden)]
        pub fn sources() -> Vec<(&'static str, &'static str)> {
            vec![$(($case::CHECK.name, include_str!(concat!(stringify!($case), ".rs")))),*]
        }

        /// The case of a module.
        #[doc(hidden)]
        pub fn of_module(module: &str) -> Option<Check> {
            match module {
                $(stringify!($case) => Some($case::CHECK),)*
                _ => None,
            }
        }
    };
}

cases!(registry);

/// What the tests of this crate see besides. They are a program of their own: a test in this library would have all checks compiled a second time.
#[doc(hidden)]
pub mod inside {
    use carom_dynamics::Model;

    pub use crate::check::verify;
    pub use crate::page::{head, part};
    pub use crate::side_by_side::{LONGEST, longest_first, side_by_side};
    pub use crate::witness::{look, looks, system};
    pub use crate::words::words;
    pub use crate::{of_module, sources};

    /// Two bars of so many elements each.
    ///
    /// # Errors
    /// None: the bars are sound.
    pub fn slow_bars(elements: usize) -> Result<Model, crate::Error> {
        crate::bars::Run::slow(elements).model()
    }
}

/// Runs all checks and `more` of them, or those whose name contains `filter`, and writes one line per row; returns what each found too, and
/// where somebody `looks` what it has shown.
///
/// # Errors
/// Of `out`, and if no threads can be started; a case that cannot be computed is written and counted as failed.
pub fn verify(
    more: &[Check],
    filter: Option<&str>,
    (size, looks): (Size, bool),
    out: &mut dyn Write,
) -> io::Result<(Verdict, Vec<Made>)> {
    let mut all = checks();
    all.extend_from_slice(more);
    check::verify(&all, filter, (size, looks), out)
}

/// What cases found as a page of HTML, with the problem, the reference and the reason for the tolerance of each. `draw`: pictures of what a
/// case has shown, as SVG.
pub fn page(made: &[Made], verdict: &Verdict, draw: impl Fn(&Shown) -> Vec<String>) -> String {
    let sources = sources();
    let head = |name: &str| {
        let source = sources.iter().find(|(other, _)| *other == name);
        source.map_or(String::new(), |(_, source)| page::head(source))
    };
    page::page(made, verdict, head, draw)
}
