//! A hairpin of sheet whose prongs are flung at each other: the surface around a shell faces itself.
//!
//! Problem: a strip of 0.2 m, 20 mm thick, is bent into two straight prongs of 1 m whose middles are 100 mm apart; E = 1 MPa, ν = 0.3, ρ = 1000 kg/m³. Nothing
//! holds it. Every node is a point, with half the thickness around it, and faces all of the strip but what is near along it.
//!
//! Closed facts: prongs flung with unequal velocities keep linear and angular momentum, and energy, with the energy-momentum scheme. Flung with equal ones they are
//! mirror images, and half of the hairpin between its plane of symmetry and a wall there moves as the whole does, a second formulation.
//!
//! Tolerances: momenta 1e-10 and energy 1e-8 as elsewhere for this scheme. Half and whole are compared until 20 steps after the prongs meet. Prongs are inclined
//! by α ≈ 0.05 then: the distance of middle surfaces is cos α times that across the wall, a part of α²/2 of the thickness, 1e-3 of the distance; forces
//! 1e-2, since the velocity law passes on when points meet by a part of a step in 20.
//! Sizes: quick 8 x 1 elements in a half, dt = 4 ms; full 24 x 3, dt = 2 ms.

use std::f64::consts::PI;

use carom_bodies::Rotations;
use carom_contact::{Basis, Integration};
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Driver, Model, ModelContact, ModelTarget, Scheme};
use carom_materials::Elastic;
use carom_mesh::{Mesh, Surface};

use crate::Error;
use crate::beams::held;
use crate::build::{NOW, contact, group, plane};
use crate::check::{Check, Row, Size};
use crate::kept::Kept;
use crate::shells::{Grid, shell};

const SOFT: Elastic = Elastic {
    density: 1000.0,
    young: 1e6,
    poisson: 0.3,
};
const THICKNESS: f64 = 0.02;
/// Half the distance of the middles of the prongs, m.
const RADIUS: f64 = 0.05;
/// Velocity of the ends, m/s.
const SPEED: f64 = 0.2;
/// Steps compared after the prongs meet.
const TOGETHER: usize = 20;

#[derive(Clone, Copy)]
struct Hairpin {
    /// Elements along a half and across.
    elements: [usize; 2],
    /// Only the upper half, on the plane of symmetry.
    half: bool,
    dt: f64,
    integration: Integration,
}

impl Hairpin {
    fn grid(&self) -> Grid {
        let [n, m] = self.elements;
        Grid::new(if self.half { n } else { 2 * n }, m)
    }

    fn mesh(&self) -> Mesh {
        let whole = 2.0 + PI * RADIUS;
        let range = if self.half { 0.5 } else { 1.0 };
        self.grid().mesh(&|s, t| {
            let along = range * s * whole;
            let turned = ((along - 1.0) / RADIUS).clamp(0.0, PI);
            // along a prong from its end to the bend, where x = 0
            let straight = (1.0 - along).max(0.0) + (along - 1.0 - PI * RADIUS).max(0.0);
            let x = straight - RADIUS * turned.sin();
            [x, 0.2 * t, RADIUS * turned.cos()]
        })
    }

    /// About to move, its prongs towards each other with these velocities.
    fn flung(&self, speeds: [f64; 2]) -> Result<Driver, Error> {
        let mesh = self.mesh();
        let made = shell(&mesh, THICKNESS, Rotations::Finite, SOFT)?;
        let radius = |_| 0.5 * THICKNESS;
        let around = Surface::of_axes(&mesh, group(&mesh, "shell")?, &made.spec.cells, radius)?;
        let (target, mut supports) = (ModelTarget::Surface(around.clone()), Vec::new());
        let target = match self.half {
            false => target,
            true => {
                let cut = self.grid().column(self.elements[0]);
                supports.push(held(cut, [false, false, true], [true, true, false]));
                plane(2, 1.0)
            }
        };
        let scheme = Scheme::EnergyMomentum(EnergyMomentum {});
        let mut model = Model {
            contacts: vec![ModelContact {
                integration: self.integration,
                ..contact(around, target, NOW)
            }],
            supports,
            ..Model::new(vec![made], mesh, scheme, self.dt)
        };
        model.nonlinear.iteration.tolerance = 1e-12;
        let system = crate::witness::system(model)?;
        let mut velocity = vec![0.0; system.unknowns()];
        for (node, x) in system.x.iter().enumerate() {
            let lower = usize::from(x[2] < 0.0);
            let part = -x[2].signum() * speeds[lower];
            let first = system.unknowns.first(node as u32);
            let at = x[0].max(0.0);
            velocity[first + 2] = part * at * at;
            // the normal of a prong turns with its slope
            velocity[first + 4] = -part * 2.0 * at;
        }
        let mut driver = Driver::new(system)?;
        driver.restart(&vec![0.0; velocity.len()], &velocity)?;
        Ok(driver)
    }
}

/// Sum of the contact forces on the upper half, N.
fn force(driver: &Driver) -> f64 {
    let system = driver.system();
    let upper = (0..system.x.len()).filter(|&node| system.x[node][2] > 1e-9);
    let of =
        |node: usize| driver.state().motion.contact_force[system.unknowns.first(node as u32) + 2];
    upper.map(of).sum()
}

/// Largest differences of motion, over half the distance, and of force, over the largest.
fn mirrored(pin: Hairpin) -> Result<Vec<Row>, Error> {
    let (mut whole, mut half) = (
        pin.flung([SPEED; 2])?,
        Hairpin { half: true, ..pin }.flung([SPEED; 2])?,
    );
    let (mut motion, mut apart, mut largest) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut left = None;
    while left != Some(0) {
        whole.step()?;
        half.step()?;
        for (node, x) in half.system().x.iter().enumerate() {
            let same = |y: &[f64; 3]| (0..3).all(|i| (x[i] - y[i]).abs() < 1e-9);
            let Some(other) = whole.system().x.iter().position(same) else {
                continue;
            };
            let moved = |driver: &Driver, node: usize| {
                let unknowns = &driver.system().unknowns;
                unknowns.vector(node as u32, &driver.state().motion.u)
            };
            let (one, other) = (moved(&half, node), moved(&whole, other));
            motion = (0..3).fold(motion, |most, i| most.max((one[i] - other[i]).abs()));
        }
        let [one, other] = [&half, &whole].map(force);
        apart = apart.max((one - other).abs());
        largest = largest.max(one.abs());
        left = match left {
            None if largest > 0.0 => Some(TOGETHER),
            left => left.map(|left| left - 1),
        };
    }
    Ok(vec![
        Row::at_most(
            "motion, whole - half / half the distance",
            motion / RADIUS,
            1e-3,
        )
        .second_formulation(),
        Row::at_most("force, whole - half / largest", apart / largest, 1e-2).second_formulation(),
    ])
}

/// What unequal prongs keep.
fn kept(pin: Hairpin, steps: usize) -> Result<Vec<Row>, Error> {
    let mut driver = pin.flung([3.0 * SPEED, 0.0])?;
    let mut kept = Kept::new(driver.system(), driver.state());
    let mut closed = 0;
    for _ in 0..steps {
        driver.step()?;
        kept.follow(driver.state());
        closed = closed.max(driver.report().contacts[0].closed);
    }
    let penetration = driver.state().records.contacts[0].penetration;
    Ok(vec![
        Row::at_most("change of momentum, relative", kept.linear, 1e-10),
        Row::at_most("change of angular momentum, relative", kept.angular, 1e-10),
        Row::at_most("change of energy, relative", kept.energy, 1e-8),
        Row::at_least("most points with a force", closed as f64, 1.0),
        Row::at_most(
            "penetration over a quarter of the thickness",
            penetration / (0.25 * THICKNESS),
            1.0,
        ),
    ])
}

pub(crate) const CHECK: Check = Check {
    name: "shell-self-contact",
    fact: "a hairpin of sheet whose prongs meet keeps momenta and energy, and moves as its half does against a wall",
    run: |size| {
        let (elements, dt, steps) = match size {
            Size::Quick => ([8, 1], 4e-3, 60),
            Size::Full => ([24, 3], 2e-3, 300),
        };
        let basis = Basis::Dual;
        let mut rows = Vec::new();
        for integration in [Integration::Node, Integration::Mortar { basis }] {
            let pin = Hairpin {
                elements,
                half: false,
                dt,
                integration,
            };
            // a mean over the prongs closes at another step than the mean over a half and a wall
            let (name, own) = match integration {
                Integration::Node => ("nodes", [mirrored(pin)?, kept(pin, steps)?].concat()),
                _ => ("mortar", kept(pin, steps.min(150))?),
            };
            rows.extend(own.into_iter().map(|row| Row {
                quantity: format!("{name}: {}", row.quantity),
                ..row
            }));
        }
        Ok(rows)
    },
};
