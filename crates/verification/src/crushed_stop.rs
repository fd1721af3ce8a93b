//! A mass on a stop whose crush stays.
//!
//! Problem: a mass m = 39 kg meets a stop at v0 = 1.2 m/s, leaves it, and meets it again at twice the speed; no other force.
//! The stop has a clearance and a curve of two pieces, 10 MN/m up to 1 mm and 2.5 MN/m beyond. The mass is the free node of one
//! bar whose stiffness is 1e-9 of the stop's, its other node held. Closed solution: arcs of two oscillations, loading along
//! the first piece (in the second blow along the line to the point of largest crush), further crush along the second piece
//! until the mass stands, unloading along a line of the initial stiffness; it leaves with F_m / sqrt(k1 m), F_m the largest
//! force. Lost is what the crush took, less F_m² / (2 k1). Reference: the formulas, for displacement, crush, speed
//! after the blow, and energy. Tolerance: schemes of second order have an error (ω dt)² / 12 of the phase in each oscillation,
//! 5e-6 at 500 steps in the first blow, and meet corners within a step, which costs as much: 2e-5; so does theta = 1/2, which
//! takes the law where it takes internal forces, at the middle of the step. Energy lost in crush against that of the crush found: a
//! formula, 1e-12. Balances: round-off.

use carom_bodies::Kinematics;
use carom_contact::Law;
use carom_contact::law::{Adhesion, Crush, Curve, Stop};
use carom_dynamics::{Driver, Model, Scheme, State, System};
use carom_materials::Elastic;
use carom_mesh::generate;

use crate::Error;
use crate::build::{CENTRAL, body, contact, newmark, plane, support, surface, theta};
use crate::check::{Check, Row};

const BAR: Elastic = Elastic {
    density: 7800.0,
    young: 1.0,
    poisson: 0.0,
};
const AREA: f64 = 1e-2;
/// Half of the bar of 1 m, kg.
const MASS: f64 = 0.5 * 7800.0 * AREA;
const SPEED: f64 = 1.2;
const CLEARANCE: f64 = 1e-5;
/// The corner of the curve, m and N, and the stiffness beyond, N/m.
const CORNER: [f64; 2] = [1e-3, 1e4];
const BEYOND: f64 = 2.5e6;
const STEPS: f64 = 500.0;

/// The exact motion of one blow.
struct Blow {
    /// Penetration at which the force begins, m.
    start: f64,
    /// Where the first piece ends, m and N.
    corner: [f64; 2],
    /// Speed of the mass, m/s.
    speed: f64,
}

impl Blow {
    /// Angular frequencies on both pieces, 1/s.
    fn frequencies() -> [f64; 2] {
        [CORNER[1] / CORNER[0], BEYOND].map(|stiffness| (stiffness / MASS).sqrt())
    }

    /// Times from the touch at which the first piece ends, the mass stands and it leaves, s, and the largest penetration, m.
    fn course(&self) -> ([f64; 3], f64) {
        let [first, second] = Self::frequencies();
        let reach = self.corner[0] - self.start;
        let one = (first * reach / self.speed).asin() / first;
        let (rest, speed) = (self.corner[1] / BEYOND, self.speed_at_corner() / second);
        let two = one + speed.atan2(rest) / second;
        let largest = self.corner[0] - rest + rest.hypot(speed);
        (
            [one, two, two + 0.5 * std::f64::consts::PI / first],
            largest,
        )
    }

    fn speed_at_corner(&self) -> f64 {
        let reach = Self::frequencies()[0] * (self.corner[0] - self.start);
        (self.speed * self.speed - reach * reach).sqrt()
    }

    /// Largest force, N.
    fn force(&self) -> f64 {
        self.corner[1] + BEYOND * (self.course().1 - self.corner[0])
    }

    /// Speed after the blow, m/s.
    fn rebound(&self) -> f64 {
        self.force() / (MASS * Self::frequencies()[0])
    }

    /// Penetration at a time after the touch, m; negative before and after the blow.
    fn penetration(&self, time: f64) -> f64 {
        let [first, second] = Self::frequencies();
        let ([one, two, three], largest) = self.course();
        let elastic = self.force() * CORNER[0] / CORNER[1];
        let rest = self.corner[1] / BEYOND;
        if time < 0.0 {
            self.start + self.speed * time
        } else if time < one {
            self.start + self.speed / first * (first * time).sin()
        } else if time < two {
            self.corner[0] - rest
                + (largest - self.corner[0] + rest) * (second * (two - time)).cos()
        } else if time < three {
            largest - elastic * (1.0 - (first * (time - two)).cos())
        } else {
            largest - elastic - self.rebound() * (time - three)
        }
    }

    /// Energy that the crush has taken for good, of this blow and those before, J.
    fn lost(&self) -> f64 {
        let (largest, force) = (self.course().1, self.force());
        let loading =
            0.5 * CORNER[0] * CORNER[1] + 0.5 * (CORNER[1] + force) * (largest - CORNER[0]);
        loading - 0.5 * force * force * CORNER[0] / CORNER[1]
    }
}

fn model(scheme: Scheme) -> Result<Model, Error> {
    let mesh = generate::line("bar", [0.0; 3], [1.0, 0.0, 0.0], 1, 1);
    let mut bar = body(&mesh, "bar", Kinematics::Bar { area: AREA }, BAR)?;
    bar.velocity[0] = -SPEED;
    let law = Law::Stop(Stop {
        clearance: CLEARANCE,
        curve: Curve::new(&[CORNER, [2.0 * CORNER[0], CORNER[1] + BEYOND * CORNER[0]]])?,
        crush: Crush::Permanent,
        damping: 0.0,
        adhesion: Adhesion::Clip,
    });
    let end = surface(&mesh, "bar.left", &bar)?;
    let first = Blow {
        start: 0.0,
        corner: CORNER,
        speed: SPEED,
    };
    Ok(Model {
        contacts: vec![contact(end, plane(0, 1.0), law)],
        supports: vec![support(&mesh, "bar.right", [true; 3])?],
        ..Model::new(vec![bar], mesh, scheme, first.course().0[2] / STEPS)
    })
}

/// Takes steps until the mass is well away; returns the largest difference of the displacement from that of the blow, m.
fn follow(driver: &mut Driver, node: usize, blow: &Blow) -> Result<f64, Error> {
    let state = driver.state();
    let place = |state: &State| -state.motion.u[node] - CLEARANCE;
    let touch = state.time + (blow.start - place(state)) / blow.speed;
    let end = touch + 1.2 * blow.course().0[2];
    let mut error = 0.0_f64;
    while driver.state().time < end {
        driver.step()?;
        let state = driver.state();
        error = error.max((place(state) - blow.penetration(state.time - touch)).abs());
    }
    Ok(error)
}

fn rows(scheme: Scheme, tolerance: f64) -> Result<Vec<Row>, Error> {
    let system = crate::witness::system(model(scheme)?)?;
    let node = (0..system.x.len())
        .find(|node| system.x[*node][0] == 0.0)
        .unwrap_or_default();
    let mut driver = Driver::new(system.clone())?;
    let mut blow = Blow {
        start: 0.0,
        corner: CORNER,
        speed: SPEED,
    };
    let mut rows = Vec::new();
    let mut lost = 0.0;
    for name in ["first blow", "second blow"] {
        let error = follow(&mut driver, node, &blow)?;
        let state = driver.state();
        let (_, largest) = blow.course();
        let (ledger, record) = (&state.ledger, &state.records.contacts[0]);
        // the second blow is given in flight: both may be one impact
        let impacts: Vec<_> = state.records.ended().collect();
        let energy_lost: f64 = impacts.iter().map(|impact| impact.energy_lost).sum();
        let crushed: f64 = impacts.iter().map(|impact| impact.energy_crushed).sum();
        let crush = state.interface.crush[0];
        let name = format!("{}, {name}", scheme.get().name());
        let row = |what: &str, value, bound| Row::at_most(format!("{name}: {what}"), value, bound);
        let near = |what: &str, value: f64, reference: f64| {
            let name = format!("{name}: {what} / exact");
            Row::near(name, value / reference, 1.0, tolerance)
        };
        let found = system.contacts[0].law.crush_energy(crush);
        rows.extend([
            row("error of the place / crush", error / largest, tolerance),
            near("crush", crush, largest),
            near("speed after the blow", state.motion.v[node], blow.rebound()),
            near("energy lost in crush", record.energy_crushed, blow.lost()),
            near(
                "energy lost in this blow",
                energy_lost - lost,
                blow.lost() - lost,
            ),
            row(
                "energy lost in crush against that of the crush found",
                (record.energy_crushed / found - 1.0).abs(),
                1e-12,
            ),
            row(
                "crush energy of the impacts against the record",
                (crushed / record.energy_crushed - 1.0).abs(),
                1e-12,
            ),
            row(
                "energy residual / largest",
                ledger.largest_energy_residual / ledger.largest_energy,
                1e-11,
            ),
        ]);
        lost = blow.lost();
        blow = Blow {
            start: largest - blow.force() * CORNER[0] / CORNER[1],
            corner: [largest, blow.force()],
            speed: 2.0 * SPEED,
        };
        driver = struck(&system, state.clone(), node)?;
    }
    Ok(rows)
}

/// A driver that goes on from a state with the mass sent back at twice the speed of the first blow; the balance begins anew.
fn struck(system: &std::sync::Arc<System>, mut state: State, node: usize) -> Result<Driver, Error> {
    let mut fresh = Driver::new(system.clone())?;
    state.motion.v[node] = -2.0 * SPEED;
    let (u, v) = (state.motion.u.clone(), state.motion.v.clone());
    fresh.restart(&u, &v)?;
    state.ledger = fresh.state().ledger.clone();
    Ok(Driver::resume(system.clone(), state)?)
}

pub(crate) const CHECK: Check = Check {
    name: "crushed-stop",
    fact: "a mass crushes a stop, leaves it along the initial stiffness, and crushes it further, as in the closed form",
    run: |_| {
        let mut all = rows(newmark(0.25, 0.5), 2e-5)?;
        all.extend(rows(CENTRAL, 2e-5)?);
        all.extend(rows(theta(0.5), 2e-5)?);
        Ok(all)
    },
};
