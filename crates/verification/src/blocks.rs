//! Two deformable blocks with meshes that do not match.
//!
//! Problem: a block of 0.6 m x 0.6 m x 0.4 m, 3 x 3 x 2 hexahedra, E = 1e9 Pa, ν = 0.3, ρ = 1000 kg/m³, comes down at 5 m/s
//! and 1 m/s sideways, off the centre, on a free block of 1 m x 1 m x 0.5 m, 2 x 2 x 2 hexahedra, at rest. Its nodes
//! are paired with the faces below, once or at every step. Closed solution: none for the motion; facts of the method:
//! forces on the two sides are opposite and act on one line, so that linear momentum never changes and neither does
//! angular momentum (about the reference places with pairing at the start; about the places where the points were
//! paired with pairing at every step); the energy identity; the law's bound on the penetration, with the fastest
//! approach of the run (1.05 v0: parts of a block that bends come down faster). Reference: zero, and
//! carom_exact::closed_forms. Tolerance: 1e-12 of the largest momentum or of its moment over 1 m, round-off; 1e-11 of the
//! energy.

use carom_bodies::Kinematics;
use carom_contact::{Law, Sliding};
use carom_dynamics::{Driver, Model, ModelTarget, Scheme, State, System};
use carom_exact::closed_forms::penetration_bound_half;
use carom_materials::{Elastic, Plane};
use carom_mesh::generate;

use crate::Error;
use crate::build::{HALF, body, contact, surface, theta};
use crate::check::{Check, Row, Size};

pub(crate) const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e9,
    poisson: 0.3,
};
const SPEED: f64 = 5.0;

/// The two blocks; `refinement` multiplies the numbers of elements. The Courant number is 0.5 on the finest edge.
pub(crate) fn model(
    refinement: usize,
    scheme: Scheme,
    law: Law,
    sliding: Sliding,
) -> Result<Model, Error> {
    let fine = [3, 3, 2].map(|n| n * refinement);
    let coarse = [2, 2, 2].map(|n| n * refinement);
    let mut mesh = generate::box_("upper", [0.1, 0.25, 0.0], [0.6, 0.6, 0.4], fine, false);
    let lower = generate::box_("lower", [0.0, 0.0, -0.5], [1.0, 1.0, 0.5], coarse, false);
    mesh.merge("lower", lower)?;
    let mut upper = body(&mesh, "upper", Kinematics::Solid, RUBBER)?;
    upper.velocity = [1.0, 0.0, -SPEED];
    let lower = body(&mesh, "lower", Kinematics::Solid, RUBBER)?;
    let secondary = surface(&mesh, "upper.bottom", &upper)?;
    let primary = surface(&mesh, "lower.top", &lower)?;
    let mut shock = contact(secondary, ModelTarget::Surface(primary), law);
    shock.sliding = sliding;
    Ok(Model {
        contacts: vec![shock],
        bodies: vec![upper, lower],
        supports: Vec::new(),
        gravity: [0.0; 3],
        scheme,
        dt: 0.5 * 0.2 / refinement as f64 / RUBBER.wave_speed(Plane::Full),
        mesh,
    })
}

/// Largest sums of the contact forces over the steps: force, and moment about the places of the nodes at
/// `ahead` times the step after the old state (negative: about the reference places).
#[derive(Default)]
struct Sums {
    force: f64,
    moment: f64,
    largest: f64,
}

impl Sums {
    fn add(&mut self, system: &System, old: &State, new: &State, finite: bool) {
        let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
        for (node, place) in system.x.iter().enumerate() {
            let mut x = *place;
            if finite {
                let motion = &old.motion;
                for i in 0..3 {
                    x[i] += motion.u[3 * node + i] + 0.5 * system.dt * motion.v[3 * node + i];
                }
            }
            let f = &new.motion.contact_force[3 * node..3 * node + 3];
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                force[i] += f[i];
                moment[i] += x[j] * f[k] - x[k] * f[j];
                self.largest = self.largest.max(f[i].abs());
            }
        }
        let largest = |v: [f64; 3]| v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        self.force = self.force.max(largest(force));
        self.moment = self.moment.max(largest(moment));
    }
}

fn rows(name: &str, refinement: usize, sliding: Sliding) -> Result<Vec<Row>, Error> {
    let system = System::new(model(refinement, theta(0.5), HALF, sliding)?)?;
    let mut driver = Driver::new(system.clone())?;
    let mut sums = Sums::default();
    for _ in 0..80 * refinement {
        let old = driver.state().clone();
        driver.step()?;
        sums.add(&system, &old, driver.state(), sliding == Sliding::Finite);
    }
    let state = driver.state();
    let (ledger, record) = (&state.ledger, &state.records.contacts[0]);
    let row = |what: &str| format!("{name}: {what}");
    let change = |i: usize| ledger.balance.momentum.linear[i] - ledger.initial.momentum.linear[i];
    let change = (0..3).map(change).fold(0.0_f64, |m, x| m.max(x.abs()));
    let energy = ledger.largest_energy_residual / ledger.initial.energy();
    let gained = ledger.largest_energy / ledger.initial.energy() - 1.0;
    let bound = penetration_bound_half(0.5, 1.05 * SPEED, system.dt);
    let moment = ledger.balance.impulse_contact.angular;
    let moment = moment.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let mut rows = vec![
        Row::at_least(
            row("impulse / momentum"),
            record.impulse() / ledger.largest_momentum,
            0.5,
        ),
        Row::at_most(
            row("change of momentum / largest"),
            change / ledger.largest_momentum,
            1e-12,
        ),
        Row::at_most(
            row("sum of contact forces / largest"),
            sums.force / sums.largest,
            1e-12,
        ),
        Row::at_most(
            row("moment of contact forces / largest x 1 m"),
            sums.moment / sums.largest,
            1e-12,
        ),
        Row::at_most(row("energy residual / E0"), energy, 1e-11),
        Row::at_most(row("largest energy / E0 - 1"), gained, 1e-11),
        Row::at_most(row("penetration, m"), record.penetration, bound),
    ];
    if sliding == Sliding::Small {
        let part = moment / ledger.largest_momentum;
        rows.push(Row::at_most(
            row("angular impulse / momentum x 1 m"),
            part,
            1e-12,
        ));
    }
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "blocks",
    fact: "two deformable blocks with other meshes exchange momentum along common lines",
    run: |size| {
        let refinement = match size {
            Size::Quick => 1,
            Size::Full => 3,
        };
        let mut rows_of_both = rows("paired once", refinement, Sliding::Small)?;
        rows_of_both.extend(rows("paired at every step", refinement, Sliding::Finite)?);
        Ok(rows_of_both)
    },
};
