//! Blocks that slide over what curves, under every law in the rate.
//!
//! Problem: a soft block (1 m by 0.3 m, plane strain, E = 10 MPa, ν = 0.3, ρ = 1000 kg/m³) with a round bottom of radius 1 m slides
//! under gravity over the round top of another one whose bottom is held, or over a rigid cylinder: a hill of radius 1 m and a
//! trough of 1.5 m, in elements of 0.1 m, and in facets of 0.3 m, at whose corners the normal turns by 17°. Courant number 6, so
//! that short waves swing from step to step. Laws: velocity under every capture, compliance, restitution 0.4; at nodes, at Gauss
//! points, mortar with both bases; θ = 0.5, 0.55, 0.6, 1 and energy-momentum (restitution up to θ = 1/(1 + e) = 0.71).
//!
//! Facts, for any rows (docs/src/theory/laws.md): contact does no positive work in any step; in full slip each point carries μ times
//! its force in each step. With rows of their own step and ġ₊ >= 0 alone contact made up to 6 % of the energy in one step here.
//!
//! Tolerances: work of a step 1e-12 of the largest energy: the bound is exact, and rounding leaves 1e-17. With energy-momentum 1e-8, as
//! for the tolerance of its iterations elsewhere. The gap as target has no such bound: it pushes out what has penetrated, and does
//! the work of that. Friction: 1e-6 of μ P, as the issue has it; the friction solver is asked for less. Friction takes energy in every
//! step, to the same tolerances. The block falls by millimetres between two facets: the largest force is a regression.
//! Sizes: quick 12 steps, θ = 0.5, 0.55 and energy-momentum, facets; full 40 steps, all.

use carom_bodies::Kinematics;
use carom_contact::law::{Capture, Restitution};
use carom_contact::{Cylinder, Integration, Law, Side};
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Driver, Model, ModelTarget, Scheme, Stepper};
use carom_materials::Elastic;
use carom_mesh::{Mesh, generate};

use crate::Error;
use crate::build::{body, compliance, contact, support, surface, theta, velocity};
use crate::check::{Check, Row, Size};
use crate::hertz::{DUAL, STANDARD};

const SOFT: Elastic = Elastic {
    density: 1000.0,
    young: 1e7,
    poisson: 0.3,
};
const GRAVITY: f64 = 10.0;
const HEIGHT: f64 = 0.3;
const RADIUS: f64 = 1.0;
const MU: f64 = 0.3;
const STEP: f64 = 5e-3;

/// What the block slides over.
#[derive(Clone, Copy)]
struct Ground {
    /// Curvature of its top, 1/m, positive for a hill.
    curvature: f64,
    /// Elements along it; none for a rigid cylinder.
    elements: Option<usize>,
}

const GROUNDS: [Ground; 6] = [
    Ground {
        curvature: 1.0,
        elements: Some(4),
    },
    Ground {
        curvature: -1.0 / 1.5,
        elements: Some(4),
    },
    Ground {
        curvature: 1.0,
        elements: Some(12),
    },
    Ground {
        curvature: -1.0 / 1.5,
        elements: Some(12),
    },
    Ground {
        curvature: 1.0,
        elements: None,
    },
    Ground {
        curvature: -1.0 / 1.5,
        elements: None,
    },
];

/// The integrations and what a law is held in.
#[derive(Clone, Copy, PartialEq)]
enum Held {
    Node,
    Points,
    Dual,
    Standard,
}

const HELD: [(&str, Held); 4] = [
    ("node", Held::Node),
    ("quadrature", Held::Points),
    ("mortar, dual", Held::Dual),
    ("mortar, standard", Held::Standard),
];

impl Held {
    /// None where the law does not take it.
    fn integration(self, law: &Law) -> Option<Integration> {
        match self {
            Held::Node => Some(Integration::Node),
            Held::Points if law.is_function() => Some(Integration::Points),
            // r = ρ c
            Held::Points if law.has_weak_form() => Some(Integration::Weak {
                r: (SOFT.density * SOFT.young).sqrt(),
            }),
            Held::Points => None,
            Held::Dual => Some(DUAL),
            Held::Standard => Some(STANDARD),
        }
    }
}

fn laws() -> [Law; 7] {
    let restitution = Restitution {
        coefficient: 0.4,
        capture: Capture::Half,
    };
    [
        velocity(Capture::Now),
        velocity(Capture::Half),
        velocity(Capture::Full),
        velocity(Capture::Free),
        velocity(Capture::GapTarget),
        compliance(&SOFT, 10.0, Capture::Half),
        Law::Restitution(restitution),
    ]
}

fn schemes(size: Size) -> Vec<Scheme> {
    let thetas: &[f64] = match size {
        Size::Quick => &[0.5, 0.55],
        Size::Full => &[0.5, 0.55, 0.6, 1.0],
    };
    let thetas = thetas.iter().map(|value| theta(*value));
    thetas
        .chain([Scheme::EnergyMomentum(EnergyMomentum {})])
        .collect()
}

/// One slide.
struct Slide {
    ground: Ground,
    integration: Integration,
    law: Law,
    scheme: Scheme,
    mu: f64,
}

/// What a slide, or all of some, found at worst.
#[derive(Clone, Copy, Default)]
struct Found {
    /// Largest work that contact did in a step beyond what it may, over the largest energy.
    work: f64,
    /// Least dissipation of friction in a step, over the largest energy, the sign turned.
    friction: f64,
    /// Largest | |t| / (μ P) - 1 | of a point.
    ratio: f64,
    /// Largest force over the weight.
    force: f64,
    /// Points with a force, over all steps.
    pressed: usize,
    runs: usize,
}

impl Found {
    fn worse(&mut self, other: &Found) {
        self.work = self.work.max(other.work);
        self.friction = self.friction.max(other.friction);
        self.ratio = self.ratio.max(other.ratio);
        self.force = self.force.max(other.force);
        self.pressed = match self.runs {
            0 => other.pressed,
            _ => self.pressed.min(other.pressed),
        };
        self.runs += 1;
    }
}

/// A block whose bottom or top is bent to a parabola of this curvature, 1/m.
fn bent(name: &str, origin: [f64; 2], size: [f64; 2], n: [usize; 2], curvature: f64) -> Mesh {
    let mut mesh = generate::rectangle(name, origin, size, n, false);
    for [x, y, _] in &mut mesh.nodes {
        // all of it at y = 0, nothing on the other side
        let share = 1.0 - y.abs() / HEIGHT;
        *y += share * 0.5 * curvature * *x * *x;
    }
    mesh
}

impl Slide {
    fn model(&self) -> Result<Model, Error> {
        let strain = Kinematics::PlaneStrain { thickness: 1.0 };
        let mut mesh = bent("block", [-0.5, 0.0], [1.0, HEIGHT], [10, 3], 1.0 / RADIUS);
        if let Some(n) = self.ground.elements {
            let size = [1.2, HEIGHT];
            let ground = bent(
                "ground",
                [-0.6, -HEIGHT],
                size,
                [n, 3],
                -self.ground.curvature,
            );
            mesh.merge("", ground)?;
        }
        let mut block = body(&mesh, "block", strain, SOFT)?;
        block.velocity = [if self.mu > 0.0 { 1.5 } else { 1.0 }, 0.0, 0.0];
        let foot = surface(&mesh, "block.bottom", &block)?;
        let mut bodies = vec![block];
        let mut supports = Vec::new();
        let target = match self.ground.elements {
            Some(_) => {
                let ground = body(&mesh, "ground", strain, SOFT)?;
                supports.push(support(&mesh, "ground.bottom", [true, true, false])?);
                let top = surface(&mesh, "ground.top", &ground)?;
                bodies.push(ground);
                ModelTarget::Surface(top)
            }
            None => {
                let radius = 1.0 / self.ground.curvature;
                ModelTarget::rigid(Cylinder {
                    point: [0.0, -radius, 0.0],
                    axis: [0.0, 0.0, 1.0],
                    radius: radius.abs(),
                    side: if radius > 0.0 {
                        Side::Outside
                    } else {
                        Side::Inside
                    },
                })
            }
        };
        let mut touch = contact(foot, target, self.law);
        touch.integration = self.integration;
        touch.friction = self.mu.into();
        Ok(Model {
            contacts: vec![touch],
            supports,
            gravity: [0.0, -GRAVITY, 0.0],
            ..Model::new(bodies, mesh, self.scheme, STEP)
        })
    }

    fn find(&self, steps: usize) -> Result<Found, Error> {
        let system = crate::witness::system(self.model()?)?;
        let weight = SOFT.density * HEIGHT * GRAVITY;
        let linear = self.mu == 0.0 && !self.scheme.get().is_between();
        let mut run: Box<dyn Stepper> = match linear {
            true => Box::new(Driver::new(system)?),
            false => Box::new(Driver::new(system)?),
        };
        let mut found = Found {
            runs: 1,
            ..Found::default()
        };
        let pushes = matches!(self.law, Law::Velocity(law) if law.capture == Capture::GapTarget);
        for _ in 0..steps {
            let before = run.state().ledger.balance;
            run.step()?;
            let (ledger, interface) = (&run.state().ledger, &run.state().interface);
            let balance = &ledger.balance;
            let force = run.report().contacts[0].force;
            let work = balance.work_contact - before.work_contact;
            let heat = balance.dissipation_friction - before.dissipation_friction;
            if !pushes {
                found.work = found.work.max(work / ledger.largest_energy);
            }
            found.friction = found.friction.max(-heat / ledger.largest_energy);
            found.force = found.force.max(force / weight);
            for (point, &force) in interface.force.iter().enumerate() {
                // a force of rounding has no ratio
                if force < 1e-9 * weight {
                    continue;
                }
                found.pressed += 1;
                if self.mu > 0.0 {
                    let [x, y] = interface.friction[point];
                    let ratio = x.hypot(y) / (self.mu * force);
                    found.ratio = found.ratio.max((ratio - 1.0).abs());
                }
            }
        }
        Ok(found)
    }
}

/// All slides of one integration with this friction, θ and energy-momentum apart.
fn slides(held: Held, mu: f64, size: Size) -> Result<[Found; 2], Error> {
    let (grounds, steps) = match size {
        Size::Quick => (2, 12),
        Size::Full => (GROUNDS.len(), 40),
    };
    let mut found = [Found::default(); 2];
    for &ground in &GROUNDS[..grounds] {
        for law in laws() {
            let Some(integration) = held.integration(&law) else {
                continue;
            };
            for scheme in schemes(size) {
                let between = scheme.get().is_between();
                let rebounds = matches!(law, Law::Restitution(_));
                let damped = matches!(scheme, Scheme::Theta(scheme) if scheme.theta > 0.7);
                if rebounds && (damped || between) {
                    continue;
                }
                let slide = Slide {
                    ground,
                    integration,
                    law,
                    scheme,
                    mu,
                };
                found[usize::from(between)].worse(&slide.find(steps)?);
            }
        }
    }
    Ok(found)
}

pub(crate) const CHECK: Check = Check {
    name: "sliding-work",
    fact: "contact without friction does no work, and in full slip friction is μ times the force, over curves and facets under every law in the rate",
    run: |size| {
        let (mut rows, mut largest) = (Vec::new(), 0.0_f64);
        for (name, held) in HELD {
            for mu in [0.0, MU] {
                // friction is not for Gauss points
                if mu > 0.0 && held == Held::Points {
                    continue;
                }
                for (found, scheme) in slides(held, mu, size)?
                    .iter()
                    .zip(["theta", "energy-momentum"])
                {
                    let row = |what: &str| format!("{name}, μ = {mu}, {scheme}: {what}");
                    let bound = if scheme == "theta" { 1e-12 } else { 1e-8 };
                    rows.push(Row::at_most(
                        row("work of contact in a step / energy"),
                        found.work,
                        bound,
                    ));
                    rows.push(Row::at_least(
                        row("points pressed, of every run"),
                        found.pressed as f64,
                        1.0,
                    ));
                    largest = largest.max(found.force);
                    if mu > 0.0 {
                        rows.push(Row::at_most(row("| |t| / (μ P) - 1 |"), found.ratio, 1e-6));
                        rows.push(Row::at_most(
                            row("energy from friction in a step / energy"),
                            found.friction,
                            bound,
                        ));
                    }
                }
            }
        }
        let own = match size {
            Size::Quick => 7.32309,
            Size::Full => 7.92515,
        };
        rows.push(Row::relative("largest force / weight", largest, own, 0.01).regression());
        Ok(rows)
    },
};
