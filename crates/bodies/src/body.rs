//! What a system is made of. All that differs between the kinds of bodies is decided here.

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::unknowns::Unknowns;
use carom_mesh::{ElementId, Mesh};

use crate::beam::{Beam, LargeBeam, Rotations};
use crate::discrete::{Across, Discrete, DiscreteSpec, VisitRow};
use crate::distortion::Distortion;
use crate::locking::Bending;
use crate::reduced::Reduced;
use crate::rigid::Rigid;
use crate::scratch::Scratch;
use crate::shell::Shell;
use crate::solid::Solid;
use crate::spec::BodySpec;
use crate::{Bolt, Deleted, Error, FrequencyBound, Kinematics, Looks, Placement, Seen, Stored};

/// A body: mass, forces f(u, v), their derivatives, energies.
#[derive(Debug)]
// A system has few bodies.
#[allow(clippy::large_enum_variant)]
pub enum Body {
    /// A solid or a bar.
    Solid(Solid),
    /// Beams.
    Beam(Beam),
    /// Beams with finite rotations.
    LargeBeam(LargeBeam),
    /// Plates and shells.
    Shell(Shell),
    /// A rigid body.
    Rigid(Rigid),
    /// Point masses, springs or dashpots.
    Discrete(Discrete),
    /// A body reduced to retained nodes and modes.
    Reduced(Reduced),
}

impl Body {
    /// Builds a solid, a bar, beams or shells on a mesh. `number`: system number of each mesh node; `unknowns`: of the nodes of the
    /// system.
    ///
    /// # Errors
    /// As [`Solid::new`]; of beams cells that are no bars of two nodes, or have no axes.
    pub fn new(
        mesh: &Mesh,
        spec: BodySpec,
        number: &[u32],
        unknowns: &Unknowns,
    ) -> Result<Body, Error> {
        match spec.kinematics {
            Kinematics::Beam(section) => {
                let beam = Beam::new(mesh, spec, section, number, unknowns)?;
                match section.rotations {
                    Rotations::Small => Ok(Body::Beam(beam)),
                    Rotations::Finite => {
                        let mut x = vec![[0.0; 3]; unknowns.nodes()];
                        for (place, &own) in mesh.nodes.iter().zip(number) {
                            if let Some(x) = x.get_mut(own as usize) {
                                *x = *place;
                            }
                        }
                        let place = |node: u32| x[node as usize];
                        LargeBeam::new(beam, &place, unknowns).map(Body::LargeBeam)
                    }
                }
            }
            Kinematics::Shell(section) => {
                Shell::new(mesh, spec, section, number, unknowns).map(Body::Shell)
            }
            _ => Solid::new(mesh, spec, number, unknowns).map(Body::Solid),
        }
    }

    /// Builds discrete elements on the cells of a mesh. `number`: system number of each mesh node; `unknowns`: of the nodes of
    /// the system.
    ///
    /// # Errors
    /// As [`Discrete::new`].
    pub fn discrete(
        mesh: &Mesh,
        spec: DiscreteSpec,
        number: &[u32],
        unknowns: &Unknowns,
    ) -> Result<Body, Error> {
        Discrete::new(mesh, spec, number, unknowns).map(Body::Discrete)
    }

    /// The solid or bar that it is, if it is one.
    pub fn as_solid(&self) -> Option<&Solid> {
        match self {
            Body::Solid(solid) => Some(solid),
            _ => None,
        }
    }

    /// The beams that it is, if it is some.
    pub fn as_beam(&self) -> Option<&Beam> {
        match self {
            Body::Beam(beam) => Some(beam),
            _ => None,
        }
    }

    /// The shell that it is, if it is one.
    pub fn as_shell(&self) -> Option<&Shell> {
        match self {
            Body::Shell(shell) => Some(shell),
            _ => None,
        }
    }

    /// The rigid body that it is, if it is one.
    pub fn as_rigid(&self) -> Option<&Rigid> {
        match self {
            Body::Rigid(rigid) => Some(rigid),
            _ => None,
        }
    }

    /// The discrete elements that it is, if it is some.
    pub fn as_discrete(&self) -> Option<&Discrete> {
        match self {
            Body::Discrete(discrete) => Some(discrete),
            _ => None,
        }
    }

    /// The reduced body that it is, if it is one.
    pub fn as_reduced(&self) -> Option<&Reduced> {
        match self {
            Body::Reduced(reduced) => Some(reduced),
            _ => None,
        }
    }

    /// Adds the forces (N) at a displacement of a body whose forces may have a resultant ([`Body::balances_itself`]).
    pub fn add_unbalanced_force(&self, at: &Placement, f: &mut [f64]) {
        match self {
            Body::Discrete(discrete) => {
                discrete.add_spring_force(at, f);
            }
            Body::Beam(beam) => beam.add_foundation_force(at, f),
            Body::Reduced(reduced) if reduced.reduction().is_grounded => {
                reduced.force(at, f);
            }
            _ => {}
        }
    }

    /// Whether its forces on the system have no resultant and no moment. Those of springs, of dashpots and of an elastic foundation
    /// may have both: on the ground, and across their nodes; so may those of a reduced body that supports hold.
    pub fn balances_itself(&self) -> bool {
        match self {
            Body::Solid(_) | Body::LargeBeam(_) | Body::Shell(_) | Body::Rigid(_) => true,
            Body::Beam(beam) => !beam.has_foundation(),
            Body::Discrete(discrete) => !discrete.has_stiffness(),
            Body::Reduced(reduced) => !reduced.reduction().is_grounded,
        }
    }

    /// Whether it has dashpots ([`Body::add_damping_force`]).
    pub fn has_damping(&self) -> bool {
        match self {
            Body::Solid(_)
            | Body::Beam(_)
            | Body::LargeBeam(_)
            | Body::Shell(_)
            | Body::Rigid(_) => false,
            Body::Discrete(discrete) => discrete.has_damping(),
            Body::Reduced(reduced) => reduced.reduction().matrices.damping.is_some(),
        }
    }

    /// Name as in the case file.
    pub fn name(&self) -> &str {
        match self {
            Body::Solid(solid) => solid.name(),
            Body::Beam(beam) => beam.name(),
            Body::LargeBeam(beam) => beam.small().name(),
            Body::Shell(shell) => shell.name(),
            Body::Discrete(discrete) => discrete.name(),
            Body::Rigid(rigid) => rigid.name(),
            Body::Reduced(reduced) => reduced.name(),
        }
    }

    /// Cells of the mesh, in the order of [`Body::stresses`].
    pub fn cells(&self) -> &[ElementId] {
        match self {
            Body::Solid(solid) => solid.cells(),
            Body::Beam(beam) => beam.cells(),
            Body::LargeBeam(beam) => beam.small().cells(),
            Body::Shell(shell) => shell.cells(),
            Body::Discrete(discrete) => discrete.cells(),
            Body::Rigid(rigid) => rigid.cells(),
            Body::Reduced(reduced) => reduced.cells(),
        }
    }

    /// Whether forces are linear in displacement and velocity, so that the derivatives never change.
    pub fn is_linear(&self) -> bool {
        match self {
            Body::Solid(solid) => solid.is_linear(),
            Body::Beam(beam) => beam.is_linear(),
            Body::Discrete(discrete) => discrete.is_linear(),
            Body::Shell(shell) => shell.is_linear(),
            Body::LargeBeam(_) | Body::Rigid(_) => false,
            Body::Reduced(_) => true,
        }
    }

    /// Whether its forces depend on finite strains, rotations or elongations: the directions in which they act are not those of the
    /// undeformed body. Bars and beams with small rotations whose metal flows are not linear, and have none of these.
    pub fn has_finite_motion(&self) -> bool {
        match self {
            Body::Solid(solid) => solid.has_finite_strain(),
            Body::Beam(_) | Body::Reduced(_) => false,
            Body::Discrete(discrete) => !discrete.is_linear(),
            Body::Shell(shell) => shell.turns(),
            Body::LargeBeam(_) | Body::Rigid(_) => true,
        }
    }

    /// Whether it bends, with nodes that turn by any angle.
    pub fn bends_finitely(&self) -> bool {
        match self {
            Body::LargeBeam(_) => true,
            Body::Shell(shell) => shell.turns(),
            _ => false,
        }
    }

    /// Whether it deforms, by small displacements: its internal forces then have no moment about the undeformed places of its nodes.
    pub fn has_small_displacements(&self) -> bool {
        !self.has_finite_motion() && self.as_discrete().is_none()
    }

    /// Speed of its fastest waves, m/s: of compression, along a beam of extension. None without waves.
    pub fn wave_speed(&self) -> Option<f64> {
        match self {
            Body::Solid(solid) => Some(solid.wave_speed()),
            Body::Beam(beam) => Some(beam.wave_speed()),
            Body::LargeBeam(beam) => Some(beam.small().wave_speed()),
            Body::Shell(shell) => Some(shell.wave_speed()),
            Body::Rigid(_) | Body::Discrete(_) => None,
            Body::Reduced(reduced) => Some(reduced.reduction().full.wave_speed()),
        }
    }

    /// Smallest size of an element, m; infinite of a body that does not deform.
    pub fn smallest_size(&self) -> f64 {
        match self {
            Body::Solid(solid) => solid.smallest_size(),
            Body::Beam(beam) => beam.smallest_size(),
            Body::LargeBeam(beam) => beam.small().smallest_size(),
            Body::Shell(shell) => shell.smallest_size(),
            Body::Rigid(_) | Body::Discrete(_) => f64::INFINITY,
            Body::Reduced(reduced) => reduced.reduction().full.smallest_size(),
        }
    }

    /// Whether its lumped mass is diagonal in the axes of coordinates.
    pub fn lumps(&self) -> bool {
        match self {
            Body::Beam(beam) => beam.lumps(),
            Body::LargeBeam(beam) => beam.lumps(),
            Body::Solid(_)
            | Body::Shell(_)
            | Body::Rigid(_)
            | Body::Discrete(_)
            | Body::Reduced(_) => true,
        }
    }

    /// Time that a wave needs to pass over its smallest element, s; zero without waves.
    pub fn passage(&self) -> f64 {
        self.wave_speed()
            .map_or(0.0, |speed| self.smallest_size() / speed)
    }

    /// Numbers that it keeps from one step to the next.
    pub fn history_len(&self) -> usize {
        match self {
            Body::Solid(solid) => solid.history_len(),
            Body::Beam(beam) => beam.history_len(),
            Body::LargeBeam(beam) => beam.history_len(),
            Body::Shell(shell) => shell.history_len(),
            Body::Discrete(discrete) => discrete.bolts().len(),
            Body::Rigid(_) | Body::Reduced(_) => 0,
        }
    }

    /// Writes the history of a body that nothing has happened to, [`Body::history_len`] numbers.
    pub fn start_history(&self, out: &mut [f64]) {
        match self {
            Body::Solid(solid) => solid.start_history(out),
            _ => out.fill(0.0),
        }
    }

    /// Adds the internal forces f(u) = K u (N) of a linear body to `f` and returns its stored energy U(u) (J);
    /// [`Body::force`] serves all bodies.
    ///
    /// `u`, `f`: system vectors, m and N. `scratch`: this body's own, empty before the first call; later calls allocate
    /// nothing. The sums run in a fixed order whatever the number of threads.
    pub fn internal_force(&self, u: &[f64], scratch: &mut Scratch, f: &mut [f64]) -> f64 {
        match self {
            Body::Solid(solid) => solid.internal_force(u, scratch, f),
            Body::Beam(beam) => beam.internal_force(u, f),
            Body::Shell(shell) if shell.is_linear() => shell.internal_force(u, f),
            Body::Shell(_) | Body::LargeBeam(_) => 0.0,
            Body::Discrete(discrete) => discrete.internal_force(u, f),
            Body::Rigid(_) => 0.0,
            Body::Reduced(reduced) => reduced.internal_force(u, f),
        }
    }

    /// Adds the internal forces (N) to the system vector `f`, writes the history at the end of the step into `new` and
    /// returns the energies.
    ///
    /// `scratch`: this body's own, empty before the first call; later calls allocate nothing. Sums run in a fixed order
    /// whatever the number of threads. After an error `f` and `new` are of no use.
    ///
    /// # Errors
    /// An element whose law gives no stress; a law without stress between two displacements.
    pub fn force(
        &self,
        at: &Placement,
        new: &mut [f64],
        scratch: &mut Scratch,
        f: &mut [f64],
    ) -> Result<Stored, Error> {
        match self {
            Body::Solid(solid) => solid.force(at, new, scratch, f),
            Body::Beam(beam) => beam.force(at, new, f),
            Body::LargeBeam(beam) => beam.force(at, new, f),
            Body::Shell(shell) => shell.force(at, new, scratch, f),
            Body::Discrete(discrete) => {
                new.copy_from_slice(at.old);
                Ok(discrete.force(at, f))
            }
            Body::Reduced(reduced) => Ok(reduced.force(at, f)),
            Body::Rigid(rigid) => {
                rigid.add_force(at, f);
                Ok(Stored::default())
            }
        }
    }

    /// Adds `by_u` ∂f/∂u (N/m) + `by_v` ∂f/∂v (N s/m) to a matrix over all unknowns of the system.
    ///
    /// The derivatives are by `at.u` and `at.v`, with `at.from` held.
    ///
    /// # Errors
    /// As [`Body::force`]. The matrix is then of no use.
    pub fn add_tangent(
        &self,
        at: &Placement,
        [by_u, by_v]: [f64; 2],
        matrix: &mut Csr,
    ) -> Result<(), Error> {
        match self {
            // its forces do not depend on the velocity
            Body::Solid(solid) => solid.add_tangent(at, by_u, matrix),
            Body::Beam(beam) => {
                beam.add_tangent(at, by_u, matrix);
                Ok(())
            }
            Body::LargeBeam(beam) => {
                beam.add_tangent(at, [by_u, by_v], matrix);
                Ok(())
            }
            Body::Shell(shell) => {
                shell.add_tangent(at, by_u, matrix);
                Ok(())
            }
            Body::Rigid(rigid) => {
                rigid.add_tangent(at, by_v, matrix);
                Ok(())
            }
            Body::Reduced(reduced) => {
                reduced.add_tangent(at, [by_u, by_v], matrix);
                Ok(())
            }
            Body::Discrete(discrete) => {
                discrete.add_tangent(at, [by_u, by_v], matrix);
                Ok(())
            }
        }
    }

    /// Adds the forces of dashpots (N) at the velocity `v` (m/s) to the system vector `f`. They are no part of
    /// [`Body::force`], since all their work is dissipated; their derivative is a part of [`Body::add_tangent`].
    pub fn add_damping_force(&self, v: &[f64], f: &mut [f64]) {
        match self {
            Body::Discrete(discrete) => discrete.add_damping_force(v, f),
            Body::Reduced(reduced) => reduced.add_damping_force(v, f),
            _ => {}
        }
    }

    /// Adds the lumped mass (kg) to the entries of a system vector.
    pub fn add_lumped_mass(&self, mass: &mut [f64]) {
        match self {
            Body::Solid(solid) => solid.add_lumped_mass(mass),
            Body::Beam(beam) => beam.add_lumped_mass(mass),
            Body::LargeBeam(beam) => beam.add_lumped_mass(mass),
            Body::Shell(shell) => shell.add_lumped_mass(mass),
            Body::Discrete(discrete) => discrete.add_lumped_mass(mass),
            Body::Rigid(rigid) => rigid.add_mass(mass),
            // its mass is not diagonal
            Body::Reduced(_) => {}
        }
    }

    /// Adds `factors[0]` K + `factors[1]` C + `factors[2]` M (consistent) to the rows of one connected part: stiffness of the
    /// undeformed body, damping of dashpots at rest, mass. `part`: system numbers of the unknowns that `matrix` holds; elements
    /// outside are left out.
    pub fn assemble(&self, factors: [f64; 3], part: &Range<usize>, matrix: &mut Csr) {
        match self {
            Body::Solid(solid) => solid.assemble(factors[0], factors[2], part, matrix),
            Body::Beam(beam) => beam.assemble([factors[0], factors[2]], part, matrix),
            Body::LargeBeam(beam) if factors[2] != 0.0 => beam.add_mass(factors[2], part, matrix),
            Body::LargeBeam(_) => {}
            Body::Shell(shell) => shell.assemble([factors[0], factors[2]], part, matrix),
            Body::Discrete(discrete) => discrete.assemble(factors, part, matrix),
            Body::Rigid(_) => {}
            Body::Reduced(reduced) => reduced.assemble(factors, part, matrix),
        }
    }

    /// The beams that move a fluid along, whose mass has no weight: in a fluid at rest beside it gravity and the motion of the base
    /// act on the displaced fluid alike.
    pub fn in_fluid(&self) -> Option<&Beam> {
        self.as_beam().filter(|beam| beam.has_fluid())
    }

    /// Whether its mass couples nodes, so that it is never lumped.
    pub fn couples_mass(&self) -> bool {
        match self {
            Body::Discrete(discrete) => discrete.couples_mass(),
            _ => false,
        }
    }

    /// System numbers of the nodes of each element, in the order of [`Body::cells`].
    pub fn each_element(&self, visit: &mut dyn FnMut(&[u32])) {
        match self {
            Body::Solid(solid) => solid.each_element(visit),
            Body::Beam(beam) => beam.each_element(visit),
            Body::LargeBeam(beam) => beam.small().each_element(visit),
            Body::Shell(shell) => shell.each_element(visit),
            Body::Discrete(discrete) => discrete.each_element(visit),
            Body::Rigid(rigid) => visit(&[rigid.node()]),
            Body::Reduced(reduced) => reduced.each_element(visit),
        }
    }

    /// The same for the elements that are not deleted in this history of the body.
    pub fn each_element_left(&self, history: &[f64], visit: &mut dyn FnMut(&[u32])) {
        match self {
            Body::Solid(solid) => solid.each_element_left(history, visit),
            other => other.each_element(visit),
        }
    }

    /// System numbers of nodes whose unknowns its matrix couples: those of each element, and of each layer that is tightened.
    pub fn each_clique(&self, visit: &mut dyn FnMut(&[u32])) {
        self.each_element(visit);
        if let Body::Solid(solid) = self {
            solid.layers.each_clique(visit);
        }
    }

    /// The same for the elements that join their nodes in all directions: none of discrete elements, of beams those that are not tightened, and of solids both
    /// sides of layers that are ([`Body::each_spring`] has what these hold).
    pub fn each_joining_element(&self, visit: &mut dyn FnMut(&[u32])) {
        match self {
            Body::Discrete(_) => {}
            Body::Beam(beam) => beam.each_joining_element(visit),
            Body::Solid(solid) => solid.each_joining_element(visit),
            other => other.each_element(visit),
        }
    }

    /// Bolts that a static stage tightens. The history of the body has the force that each keeps ([`Bolt::kept`]), in their order.
    pub fn bolts(&self) -> &[Bolt] {
        match self {
            Body::Beam(beam) => beam.bolts(),
            Body::Discrete(discrete) => discrete.bolts(),
            Body::Solid(solid) => solid.layers.bolts(),
            _ => &[],
        }
    }

    /// Whether elements are deleted; see [`Solid::has_deletion`].
    pub fn has_deletion(&self) -> bool {
        self.as_solid().is_some_and(Solid::has_deletion)
    }

    /// Whether each element is deleted in this history of the body, in the order of [`Body::cells`]; none of a body without deletion.
    pub fn deleted(&self, history: &[f64]) -> Option<Vec<bool>> {
        self.as_solid()?.deleted(history)
    }

    /// Deletes elements at the end of a step; see [`Solid::delete`].
    ///
    /// # Errors
    /// As [`Solid::force`].
    pub fn delete(&self, at: &Placement, new: &mut [f64]) -> Result<Deleted, Error> {
        match self {
            Body::Solid(solid) => solid.delete(at, new),
            _ => Ok(Deleted::default()),
        }
    }

    /// Upper bound of the angular frequencies (rad/s) with its lumped mass; see [`Solid::frequency_bound`]. Zero of a body
    /// without a mass of its own: [`Body::add_row_sums`].
    pub fn frequency_bound(&self) -> f64 {
        match self {
            Body::Solid(solid) => solid.frequency_bound(),
            Body::Beam(beam) => beam.frequency_bound(),
            Body::LargeBeam(beam) => beam.small().frequency_bound(),
            Body::Shell(shell) => shell.frequency_bound(),
            Body::Rigid(_) | Body::Discrete(_) | Body::Reduced(_) => 0.0,
        }
    }

    /// The same about a displacement; see [`Solid::frequency_bound_at`].
    ///
    /// # Errors
    /// As [`Body::force`].
    pub fn frequency_bound_at(&self, at: &Placement) -> Result<FrequencyBound, Error> {
        match self {
            Body::Solid(solid) => solid.frequency_bound_at(at),
            _ => Ok(FrequencyBound::of(self.frequency_bound())),
        }
    }

    /// The same chunk by chunk as elements deform; see [`Solid::look`].
    ///
    /// # Errors
    /// As [`Body::force`].
    pub fn look(&self, at: &Placement, looks: &mut Looks, worth: f64) -> Result<Seen, Error> {
        match self {
            Body::Solid(solid) => solid.look(at, looks, worth),
            _ => Ok(looks.constant(|| self.frequency_bound())),
        }
    }

    /// Mass that mass scaling has added, kg.
    pub fn added_mass(&self) -> f64 {
        self.as_solid().map_or(0.0, Solid::added_mass)
    }

    /// Visits the rows n of springs and of foundations, as unknowns and coefficients of the elongation: motions that they hold.
    pub fn each_spring(&self, visit: &mut VisitRow) {
        match self {
            Body::Beam(beam) => beam.each_spring(visit),
            Body::Discrete(discrete) => discrete.each_spring(visit),
            Body::Solid(solid) => solid.layers.each_row(visit),
            _ => {}
        }
    }

    /// Adds the sums of the magnitudes in the rows of the stiffness (N/m) and of the damping matrix (N s/m) that stand on the
    /// masses of other bodies, at most, to system vectors: over the mass of the unknown they bound the eigenvalues
    /// (Gershgorin).
    pub fn add_row_sums(&self, stiffness: &mut [f64], damping: &mut [f64]) {
        if let Body::Discrete(discrete) = self {
            discrete.add_row_sums(stiffness, damping);
        }
    }

    /// The largest rotation and strain of elements whose rotations and strains must be small; see [`Solid::distortion`].
    pub fn distortion(&self, u: &[f64], point: usize, before: &Distortion) -> Option<Distortion> {
        match self {
            Body::Solid(solid) => solid.distortion(u, point, before),
            Body::Beam(beam) => Some(beam.distortion(u, before)),
            Body::Shell(shell) => shell.distortion(u, before),
            Body::LargeBeam(_) | Body::Rigid(_) | Body::Discrete(_) | Body::Reduced(_) => None,
        }
    }

    /// How far the ends of springs, dashpots and fluid gaps have moved across their axis; see [`Discrete::across`].
    pub fn across(&self, u: &[f64]) -> Option<Across> {
        self.as_discrete()?.across(u)
    }

    /// How far linear elements lock in bending; see [`Solid::bending`].
    pub fn bending(&self, u: &[f64]) -> Option<Bending> {
        self.as_solid()?.bending(u)
    }
}
