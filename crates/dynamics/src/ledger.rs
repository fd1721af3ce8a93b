//! The balance of energy and momentum.
//!
//! Two statements are kept apart. The residual is the work of the forces that the steps leave unbalanced; tests check it. The
//! dissipation of the scheme has its own formula: in a linear run the exact identity of the scheme
//! ([`EnergyIdentity`](crate::EnergyIdentity)), in a nonlinear one the works of inertia and internal forces minus the changes of
//! the energies. See `docs/src/theory/balances.md`.

use carom_bodies::{Deleted, Stored};
use serde::{Deserialize, Serialize};

use crate::resultant::Resultant;
use crate::scheme::EnergyIdentity;
use crate::step_forces::OutsideForces;
use crate::step_map::StepMap;
use crate::step_terms::{Energies, Jump, NonlinearTerms, StepTerms};
use crate::sum::Sum;
use crate::system::{Motion, System};
use crate::tolerated::Tolerated;

/// What the ledger shows at an instant; works and dissipations since the start, J.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Balance {
    /// ½ v·M v.
    pub kinetic: f64,
    /// Strain energy U(u).
    pub strain: f64,
    /// What the energy that the scheme balances has beside these two: `inertia |a|²_M + memory |m|²_K + U(u - lag v) - U(u)`.
    pub scheme_energy: f64,
    /// Work of the loads.
    pub work_loads: f64,
    /// Work of the contact forces, and of the impulses of a projection, beyond that of the obstacles; minus the energy lost in
    /// impact.
    pub work_contact: f64,
    /// Work of the obstacles that move: their forces on the bodies times their own motion.
    pub work_obstacles: f64,
    /// Work of the links to other zones.
    pub work_links: f64,
    /// Work of the supports that move.
    pub work_supports: f64,
    /// Dissipation of the scheme.
    pub dissipation_scheme: f64,
    /// Dissipation of the materials: plastic, viscous.
    pub dissipation_material: f64,
    /// Dissipation of the damping.
    pub dissipation_damping: f64,
    /// Dissipation of friction.
    pub dissipation_friction: f64,
    /// Dissipation of bulk viscosity.
    pub dissipation_viscosity: f64,
    /// Energy of deleted elements: what their strain and hardening had stored.
    pub dissipation_deletion: f64,
    /// Energy that hardening stores.
    pub hardening: f64,
    /// What of the strain energy resists the hourglass modes of elements with one point.
    pub hourglass: f64,
    /// What the terms leave over: change of the three energies - works + dissipation.
    pub energy_residual: f64,
    /// Momentum, N s and N m s.
    pub momentum: Resultant,
    /// Impulse of the loads.
    pub impulse_loads: Resultant,
    /// Impulse of the contact forces: only obstacles leave one.
    pub impulse_contact: Resultant,
    /// Impulse of the links to other zones.
    pub impulse_links: Resultant,
    /// Impulse of the supports.
    pub impulse_supports: Resultant,
    /// Change of the momentum - impulses.
    pub momentum_residual: Resultant,
}

impl Balance {
    /// The balance of two systems together.
    pub fn plus(&self, other: &Balance) -> Balance {
        let sum = |one: &Resultant, other: &Resultant| one.combine(1.0, other, 1.0);
        Balance {
            kinetic: self.kinetic + other.kinetic,
            strain: self.strain + other.strain,
            scheme_energy: self.scheme_energy + other.scheme_energy,
            work_loads: self.work_loads + other.work_loads,
            work_contact: self.work_contact + other.work_contact,
            work_obstacles: self.work_obstacles + other.work_obstacles,
            work_links: self.work_links + other.work_links,
            work_supports: self.work_supports + other.work_supports,
            dissipation_scheme: self.dissipation_scheme + other.dissipation_scheme,
            dissipation_material: self.dissipation_material + other.dissipation_material,
            dissipation_damping: self.dissipation_damping + other.dissipation_damping,
            dissipation_friction: self.dissipation_friction + other.dissipation_friction,
            dissipation_viscosity: self.dissipation_viscosity + other.dissipation_viscosity,
            dissipation_deletion: self.dissipation_deletion + other.dissipation_deletion,
            hardening: self.hardening + other.hardening,
            hourglass: self.hourglass + other.hourglass,
            energy_residual: self.energy_residual + other.energy_residual,
            momentum: sum(&self.momentum, &other.momentum),
            impulse_loads: sum(&self.impulse_loads, &other.impulse_loads),
            impulse_contact: sum(&self.impulse_contact, &other.impulse_contact),
            impulse_links: sum(&self.impulse_links, &other.impulse_links),
            impulse_supports: sum(&self.impulse_supports, &other.impulse_supports),
            momentum_residual: sum(&self.momentum_residual, &other.momentum_residual),
        }
    }

    /// Energy that the materials took, J: strain energy, hardening, what they and bulk viscosity dissipated, what deleted elements had.
    pub fn internal(&self) -> f64 {
        let stored = self.strain + self.hardening + self.dissipation_deletion;
        stored + self.dissipation_material + self.dissipation_viscosity
    }

    /// Kinetic and strain energy, J.
    pub fn energy(&self) -> f64 {
        self.kinetic + self.strain
    }

    /// The energy that the scheme balances, J: kinetic and strain energy, its own term, what hardening stores.
    pub fn balanced(&self) -> f64 {
        self.energy() + self.scheme_energy + self.hardening
    }

    /// Work from outside, J: of loads, supports and obstacles.
    pub fn work_given(&self) -> f64 {
        self.work_loads + self.work_supports + self.work_obstacles
    }
}

/// The balance with the memory that it needs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// The balance at the start.
    pub initial: Balance,
    /// The balance now.
    pub balance: Balance,
    /// Largest kinetic and strain energy so far, J, in a static stage the largest work of the loads if that is more: the size
    /// that residuals are compared with.
    pub largest_energy: f64,
    /// Largest component of the momentum, or of the impulse of loads, contacts or supports so far, N s.
    pub largest_momentum: f64,
    /// Largest component of the angular momentum, or of the moments' impulses so far, N m s.
    pub largest_angular_momentum: f64,
    /// Largest energy so far beyond that at the start and the work from outside, J: what the scheme balances has gained.
    pub largest_gain: f64,
    /// Largest work of loads, supports and obstacles so far, J.
    pub largest_given: f64,
    /// Largest energy that the scheme has made since the start so far, J: minus its dissipation.
    pub largest_made: f64,
    /// Largest work of the contacts since the start so far, J.
    pub largest_contact_work: f64,
    /// Largest kinetic and strain energy so far beyond the energy that the scheme balances, J.
    pub largest_excess: f64,
    /// Largest energy of hourglass modes so far, J.
    pub largest_hourglass: f64,
    /// Largest energy that the materials took so far, J ([`Balance::internal`]).
    pub largest_internal: f64,
    /// Whether the steps are those of a static stage, whose works are sums over the steps.
    pub is_static: bool,
    /// Number of elements deleted so far.
    pub deleted: u64,
    /// What the iterations may have left unbalanced so far.
    pub tolerated: Tolerated,
    /// What rounding may have left of linear steps so far (`driver/rounding.rs`).
    pub rounding: Tolerated,
    /// Largest absolute energy residual so far, J.
    pub largest_energy_residual: f64,
    /// Largest absolute component of the linear momentum residual so far, N s.
    pub largest_momentum_residual: f64,
    /// Largest absolute component of the angular momentum residual so far, N m s.
    pub largest_angular_residual: f64,
    work_loads: Sum,
    work_contact: Sum,
    work_links: Sum,
    dissipation: Sum,
    /// What the scheme's own energy has lost by new sizes of the step, J.
    resized: Sum,
    /// Works and dissipations of [`NonlinearTerms`], in its order.
    nonlinear: [Sum; 6],
    /// Energy of deleted elements, J.
    deletion: Sum,
    hardening: f64,
    hourglass: f64,
    impulses: OutsideForces<[Sum; 6]>,
    forces: OutsideForces<Resultant>,
}

impl Ledger {
    /// The balance at the start, with the forces there.
    pub(crate) fn start(
        energies: &Energies,
        identity: &EnergyIdentity,
        forces: OutsideForces<Resultant>,
    ) -> Ledger {
        let balance = Balance {
            kinetic: energies.kinetic,
            strain: energies.strain,
            scheme_energy: energies.of_scheme(identity),
            momentum: energies.momentum,
            ..Balance::default()
        };
        Ledger {
            initial: balance,
            balance,
            largest_energy: balance.energy(),
            largest_momentum: energies.momentum.largest(),
            largest_angular_momentum: energies.momentum.largest_moment(),
            forces,
            ..Ledger::default()
        }
    }

    /// Sets the energy that hardening stores at the start, J.
    pub(crate) fn store(&mut self, hardening: f64) {
        self.hardening = hardening;
        (self.initial.hardening, self.balance.hardening) = (hardening, hardening);
    }

    /// Moves what deleted elements had stored at the end of the step just added to its own term.
    pub(crate) fn delete(&mut self, deleted: &Deleted) {
        let Stored {
            strain,
            hardening,
            hourglass,
            ..
        } = deleted.stored;
        self.deleted += deleted.elements as u64;
        self.deletion.add(strain + hardening);
        self.hardening -= hardening;
        self.hourglass -= hourglass;
        let balance = &mut self.balance;
        balance.strain -= strain;
        balance.hardening = self.hardening;
        balance.hourglass = self.hourglass;
        balance.dissipation_deletion = self.deletion.get();
    }

    /// This balance with a step.
    pub(crate) fn after(&self, step: &StepTerms) -> Ledger {
        let mut next = self.clone();
        next.rounding.add(&step.rounding);
        if let Some(term) = step.energy_of_scheme {
            next.resize_to(term);
        }
        next.is_static = step.is_static;
        add(&mut next.impulses.supports, &step.kick);
        if let Some(nonlinear) = &step.nonlinear {
            next.add_nonlinear(nonlinear);
        }
        next.work_loads.add(step.work_loads);
        next.work_contact.add(step.work_contacts);
        next.work_links.add(step.work_links);
        next.dissipation.add(step.dissipation);
        next.push(step);
        next.close(&step.energies, step.identity);
        if step.is_static {
            // rigid motions take the work of the loads and leave no energy: it is a size that residuals are compared with
            next.largest_energy = next.largest_energy.max(next.balance.work_loads.abs());
        }
        next
    }

    /// Adds the impulses of the forces.
    fn push(&mut self, step: &StepTerms) {
        let OutsideForces {
            loads,
            contacts,
            supports,
            held,
            links,
        } = &step.forces;
        let (own, of_contacts) = (step.impulse, step.contact_impulse);
        let (before, sums) = (&mut self.forces, &mut self.impulses);
        for (force, impulse, before, sum) in [
            (loads, own, &mut before.loads, &mut sums.loads),
            (
                contacts,
                of_contacts,
                &mut before.contacts,
                &mut sums.contacts,
            ),
            (supports, own, &mut before.supports, &mut sums.supports),
            (held, of_contacts, &mut before.held, &mut sums.held),
            (links, own, &mut before.links, &mut sums.links),
        ] {
            let force = force.combine(impulse.gain, before, -impulse.carry);
            let mean = before.combine(step.dt * impulse.old, &force, step.dt * impulse.new);
            *before = force;
            add(sum, &mean);
        }
    }

    /// What only a step that is not linear has.
    fn add_nonlinear(&mut self, nonlinear: &NonlinearTerms) {
        let terms = [
            nonlinear.work_supports,
            nonlinear.dissipation_material,
            nonlinear.dissipation_damping,
            nonlinear.dissipation_friction,
            nonlinear.work_obstacles,
            nonlinear.dissipation_viscosity,
        ];
        for (sum, term) in self.nonlinear.iter_mut().zip(terms) {
            sum.add(term);
        }
        (self.hardening, self.hourglass) = (nonlinear.hardening, nonlinear.hourglass);
        self.tolerated.add(&nonlinear.tolerated);
    }

    /// The energy of the scheme has another term with the next size of the step: what it gains by that is no work. `term`: as it is at the start
    /// of the step, J.
    fn resize_to(&mut self, term: f64) {
        let lost = self.balance.scheme_energy - term;
        self.dissipation.add(lost);
        self.resized.add(lost);
    }

    /// Forces of links (N) jump by the first of these at the present instant, those of supports by the second, and with them the acceleration, which
    /// gives the energy of the scheme `term` more (J) without work.
    pub(crate) fn jump_force(&mut self, [links, supports]: [Resultant; 2], term: f64) {
        self.forces.links = self.forces.links.plus(&links);
        self.forces.supports = self.forces.supports.plus(&supports);
        self.resize_to(self.balance.scheme_energy + term);
        self.balance.scheme_energy += term;
    }

    /// What the energy that the scheme balances has gained since the start beyond the work from outside, J; not by the size of
    /// the step alone.
    pub fn free_energy(&self) -> f64 {
        let gained = self.balance.balanced() - self.initial.balanced();
        gained - self.balance.work_given() + self.resized.get()
    }

    /// Adds a projection after the step just added.
    pub(crate) fn jump(&mut self, identity: &EnergyIdentity, energies: &Energies, jump: &Jump) {
        self.work_contact.add(jump.work);
        self.nonlinear[4].add(jump.work_obstacles);
        self.dissipation.add(jump.dissipation);
        add(&mut self.impulses.contacts, &jump.impulses.contacts);
        add(&mut self.impulses.supports, &jump.impulses.supports);
        add(&mut self.impulses.links, &jump.impulses.links);
        (self.forces.contacts, self.forces.supports) = (jump.contacts, jump.supports);
        self.forces.links = self.forces.links.plus(&jump.links);
        self.close(energies, identity);
    }

    /// The balance from the sums, and its largest terms so far.
    fn close(&mut self, energies: &Energies, identity: &EnergyIdentity) {
        self.balance = self.closed(energies, identity);
        self.follow();
    }

    /// Makes this the ledger of several systems together, which have these balances at the start and now. The largest terms
    /// are those of the sums.
    pub fn gather(&mut self, initial: Balance, balance: Balance, left: [Tolerated; 2]) {
        (self.initial, self.balance) = (initial, balance);
        [self.tolerated, self.rounding] = left;
        self.follow();
    }

    /// The largest terms so far.
    fn follow(&mut self) {
        // a spring that pulls at elongation zero has a negative energy where it is shorter
        let energy = self.balance.kinetic + self.balance.strain.abs();
        self.largest_energy = self.largest_energy.max(energy);
        self.largest_hourglass = self.largest_hourglass.max(self.balance.hourglass);
        self.largest_internal = self.largest_internal.max(self.balance.internal());
        let mut gain =
            self.balance.balanced() - self.initial.balanced() - self.balance.work_given();
        if self.is_static {
            // what presses bodies into each other at the start is released by the contact forces: an interference
            gain -= self.balance.work_contact;
        }
        self.largest_gain = self.largest_gain.max(gain);
        self.largest_given = self.largest_given.max(self.balance.work_given());
        self.largest_made = self.largest_made.max(-self.balance.dissipation_scheme);
        self.largest_contact_work = self.largest_contact_work.max(self.balance.work_contact);
        self.largest_excess = self.largest_excess.max(-self.balance.scheme_energy);
        self.largest_energy_residual = self
            .largest_energy_residual
            .max(self.balance.energy_residual.abs());
        let balance = &self.balance;
        let impulses = [
            balance.momentum,
            balance.impulse_loads,
            balance.impulse_contact,
            balance.impulse_supports,
            balance.impulse_links,
        ];
        self.largest_momentum = impulses
            .iter()
            .map(Resultant::largest)
            .fold(self.largest_momentum, f64::max);
        self.largest_angular_momentum = impulses
            .iter()
            .map(Resultant::largest_moment)
            .fold(self.largest_angular_momentum, f64::max);
        self.largest_angular_residual = self
            .largest_angular_residual
            .max(balance.momentum_residual.largest_moment());
        self.largest_momentum_residual = self
            .largest_momentum_residual
            .max(balance.momentum_residual.largest());
    }

    fn closed(&self, energies: &Energies, identity: &EnergyIdentity) -> Balance {
        let (work_loads, work_contact) = (self.work_loads.get(), self.work_contact.get());
        let work_links = self.work_links.get();
        let dissipation_scheme = self.dissipation.get();
        let scheme_energy = energies.of_scheme(identity);
        let start = &self.initial;
        let change = (energies.kinetic - start.kinetic)
            + (energies.strain - start.strain)
            + (scheme_energy - start.scheme_energy)
            + (self.hardening - start.hardening);
        let [
            work_supports,
            dissipation_material,
            dissipation_damping,
            dissipation_friction,
            work_obstacles,
            dissipation_viscosity,
        ] = self.nonlinear.map(|sum| sum.get());
        let works = work_loads + work_contact + work_links + work_supports + work_obstacles;
        let dissipations = dissipation_scheme
            + dissipation_material
            + dissipation_damping
            + dissipation_friction
            + dissipation_viscosity
            + self.deletion.get();
        let impulses = &self.impulses;
        let [impulse_loads, impulse_contact] = [&impulses.loads, &impulses.contacts].map(total);
        let held = total(&impulses.held);
        let impulse_supports = total(&impulses.supports).combine(1.0, &held, 1.0);
        let impulse_links = total(&impulses.links);
        let impulses = impulse_loads
            .combine(1.0, &impulse_contact, 1.0)
            .combine(1.0, &impulse_supports, 1.0)
            .combine(1.0, &impulse_links, 1.0);
        let change_of_momentum = energies.momentum.combine(1.0, &start.momentum, -1.0);
        Balance {
            kinetic: energies.kinetic,
            strain: energies.strain,
            scheme_energy,
            work_loads,
            work_contact,
            work_obstacles,
            dissipation_scheme,
            work_links,
            impulse_links,
            work_supports,
            dissipation_material,
            dissipation_damping,
            dissipation_friction,
            dissipation_viscosity,
            dissipation_deletion: self.deletion.get(),
            hardening: self.hardening,
            hourglass: self.hourglass,
            energy_residual: change - works + dissipations,
            momentum: energies.momentum,
            impulse_loads,
            impulse_contact,
            impulse_supports,
            momentum_residual: change_of_momentum.combine(1.0, &impulses, -1.0),
        }
    }
}

/// Adds to the sums of an impulse.
fn add(sums: &mut [Sum; 6], impulse: &Resultant) {
    for i in 0..3 {
        sums[i].add(impulse.linear[i]);
        sums[3 + i].add(impulse.angular[i]);
    }
}

/// What an impulse has come to.
fn total(sums: &[Sum; 6]) -> Resultant {
    let [x, y, z, mx, my, mz] = sums.map(|sum| sum.get());
    Resultant {
        linear: [x, y, z],
        angular: [mx, my, mz],
    }
}

/// Forces of the supports, N: what the momentum balance of the step leaves at the held unknowns; zero elsewhere. Without
/// the contact forces if these have an impulse of their own. `out` holds the internal forces of the balance where the map
/// has no fraction for them.
pub(crate) fn reactions(
    system: &System,
    map: &StepMap,
    old: &Motion,
    new: &Motion,
    inertia: &[f64],
    out: &mut [f64],
) {
    let contact = if map.impulse == map.contact_impulse {
        map.contact
    } else {
        0.0
    };
    for (i, out) in out.iter_mut().enumerate() {
        *out = if system.fixed[i] {
            let internal = map.force_fraction.map_or(*out, |fraction| {
                (1.0 - fraction) * old.internal_force[i] + fraction * new.internal_force[i]
            });
            let link = new.link_force.get(i).copied().unwrap_or(0.0);
            inertia[i] + internal - system.load[i] - contact * new.contact_force[i] - link
        } else {
            0.0
        };
    }
}
