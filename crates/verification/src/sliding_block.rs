//! A block that slides on an inclined plane under Coulomb friction.
//!
//! Problem: a block of 0.2 m by 0.05 m (in space 0.2 m by 0.2 m by 0.05 m), one element, E = 1e10 Pa, ρ = 1000 kg/m³, is
//! thrown along a rigid plane under gravity: downhill on a slope that holds it, so that it stops and sticks, and uphill on
//! one that does not, so that it stops and comes back; and in space obliquely to its sides over a level plane. Closed
//! solution and reference: a mass point, carom_exact::friction::Incline.
//!
//! Tolerance, with a the acceleration while it slides: the schemes integrate a constant acceleration exactly, but theta,
//! whose way is off by (θ - 1/2) Δt times the change of the velocity. The step in which the block stops ends at rest,
//! which moves the place by at most |a| Δt²/8. Where the block comes back it may rest a step too long: the velocity is then off
//! by |a| Δt of the way down, and the place by that for the time since. Newmark's first step begins with the acceleration
//! before there was friction, of which a share 1 - γ is in the velocity. The block is elastic, its weight comes at once, and
//! it stops at once: its vibrations, not damped by θ = 1/2, are allowed 1e-3 of the speed, and 1e-4 of the way. The
//! dissipation is μ N times the way slid, to the same 1e-4. Balances 1e-9 as the issue states.
//! In space the way is straight to 1e-10 of its length: the mean force on a square block is along the way, whatever its
//! direction, but where nodes vibrate across it, an effect of second order.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::{Law, Motion, Obstacle, Plane, Translation};
use carom_dynamics::{Driver, Model, ModelBody, ModelTarget, Scheme, State, Support};
use carom_elements::Kind;
use carom_exact::friction::Incline;
use carom_materials::Elastic;
use carom_mesh::{Group, generate};

use crate::Error;
use crate::build::{DISPLACEMENT, NOW, contact, group, newmark, surface, theta};
use crate::check::{Check, Row, Size};

pub(crate) const GRAVITY: f64 = 9.81;
const LENGTH: f64 = 0.2;
const HEIGHT: f64 = 0.05;
/// Of the block in the plane, m.
const THICKNESS: f64 = 0.1;
const DENSITY: f64 = 1000.0;
/// Young's modulus of a block, Pa: its static compression is 1e-9 m.
const YOUNG: f64 = 1e10;
/// Length of the spring, m, and its cross-section, m².
const SPRING: f64 = 1.0;
const AREA: f64 = 1e-4;
const SPEED: f64 = 2.0;

/// A block on a rough plane, the last direction upwards.
pub(crate) struct Rough {
    pub(crate) dim: usize,
    /// Gravity, m/s².
    pub(crate) gravity: [f64; 3],
    pub(crate) mu: f64,
    /// Initial velocity, m/s.
    pub(crate) velocity: [f64; 3],
    /// Stiffness of a spring along x between the foot of the block and a wall, N/m.
    pub(crate) spring: Option<f64>,
    /// Velocity of the plane along x, m/s.
    pub(crate) belt: f64,
    pub(crate) scheme: Scheme,
    pub(crate) law: Law,
    pub(crate) dt: f64,
}

impl Rough {
    /// Mass of the block, kg.
    pub(crate) fn mass(&self) -> f64 {
        match self.dim {
            2 => DENSITY * LENGTH * HEIGHT * THICKNESS,
            _ => DENSITY * LENGTH * LENGTH * HEIGHT,
        }
    }

    pub(crate) fn start(&self) -> Result<Driver, Error> {
        let mut mesh = match self.dim {
            2 => generate::rectangle("block", [0.0; 2], [LENGTH, HEIGHT], [1, 1], false),
            _ => generate::box_("block", [0.0; 3], [LENGTH, LENGTH, HEIGHT], [1; 3], false),
        };
        let kinematics = match self.dim {
            2 => Kinematics::PlaneStrain {
                thickness: THICKNESS,
            },
            _ => Kinematics::Solid,
        };
        let material = |density, young, poisson| Elastic {
            density,
            young,
            poisson,
        };
        let mut parts = vec![("block", kinematics, material(DENSITY, YOUNG, 0.3))];
        let mut supports = Vec::new();
        if let Some(stiffness) = self.spring {
            let wall = mesh.nodes.len() as u32;
            mesh.nodes.push([-SPRING, 0.0, 0.0]);
            let bar = mesh.push(Kind::Bar2, &[wall, 0]);
            mesh.groups
                .insert("spring".into(), Group::new(1, vec![bar]));
            // almost without mass
            let elastic = material(1e-6, stiffness * SPRING / AREA, 0.0);
            parts.push(("spring", Kinematics::Bar { area: AREA }, elastic));
            supports.push(Support {
                nodes: vec![wall],
                fix: [true; 3],
                fix_rotations: [false; 3],
            });
        }
        let mut bodies = Vec::new();
        for (name, kinematics, material) in parts {
            bodies.push(ModelBody {
                velocity: self.velocity,
                ..ModelBody::new(BodySpec::new(
                    name,
                    group(&mesh, name)?.elements.clone(),
                    kinematics,
                    material,
                ))
            });
        }
        let mut normal = [0.0; 3];
        normal[self.dim - 1] = 1.0;
        let plane = Plane {
            point: [0.0; 3],
            normal,
        };
        let moves = Translation::Velocity([self.belt, 0.0, 0.0]);
        let floor = Obstacle {
            motion: Motion {
                translation: (self.belt != 0.0).then_some(moves),
                turn: None,
            },
            ..plane.into()
        };
        let foot = surface(&mesh, "block.bottom", &bodies[0])?;
        let mut rubbing = contact(foot, ModelTarget::Rigid(floor), self.law);
        rubbing.friction = self.mu.into();
        let system = crate::witness::system(Model {
            contacts: vec![rubbing],
            supports,
            gravity: self.gravity,
            ..Model::new(bodies, mesh, self.scheme, self.dt)
        })?;
        Ok(Driver::new(system)?)
    }
}

/// Mean displacement in m and velocity in m/s of the block.
pub(crate) fn place(newton: &Driver, state: &State) -> [[f64; 3]; 2] {
    let mean = |f: &[f64]| newton.system().mean_velocity(0, f);
    [mean(&state.motion.u), mean(&state.motion.v)]
}

/// Rows of the balance of a run.
pub(crate) fn balances(name: &str, newton: &Driver) -> [Row; 2] {
    let ledger = &newton.state().ledger;
    let energy = ledger.largest_energy_residual / ledger.largest_energy;
    let momentum = ledger.largest_momentum_residual / ledger.largest_momentum;
    [
        Row::at_most(format!("{name}: energy residual / largest"), energy, 1e-9),
        Row::at_most(
            format!("{name}: momentum residual / largest"),
            momentum,
            1e-9,
        ),
    ]
}

/// A scheme with a law, and what is known of its errors.
#[derive(Clone, Copy)]
struct Means {
    scheme: Scheme,
    law: Law,
    /// θ - 1/2: what a step's change of the velocity adds to its way, in Δt.
    bias: f64,
    /// 1 - γ: share of the acceleration before the first step in its velocity.
    begins: f64,
}

/// A throw on a slope for 2 s.
fn slope(name: &str, exact: &Incline, means: Means, dt: f64) -> Result<Vec<Row>, Error> {
    let (sin, cos) = exact.angle.sin_cos();
    let rough = Rough {
        dim: 2,
        gravity: [GRAVITY * sin, -GRAVITY * cos, 0.0],
        mu: exact.mu,
        velocity: [exact.velocity, 0.0, 0.0],
        spring: None,
        belt: 0.0,
        scheme: means.scheme,
        law: means.law,
        dt,
    };
    let mut newton = rough.start()?;
    let (mut x_worst, mut v_worst, mut slid, mut last) = (0.0_f64, 0.0_f64, 0.0, 0.0);
    while newton.state().time < 2.0 - 0.5 * dt {
        newton.step()?;
        let state = newton.state();
        let [x, v] = place(&newton, state).map(|place| place[0]);
        let (x_exact, v_exact) = exact.at(state.time);
        x_worst = x_worst.max((x - x_exact).abs());
        v_worst = v_worst.max((v - v_exact).abs());
        slid += f64::abs(x - last);
        last = x;
    }
    let way = exact.stop_distance().abs();
    let pull = GRAVITY * exact.mu * cos;
    let once = (GRAVITY * sin + pull) * dt;
    let late = match exact.holds() {
        true => 0.0,
        false => (GRAVITY * sin - pull) * dt,
    };
    let v_bound = 1e-3 * exact.velocity.abs() + means.begins * pull * dt + late;
    let changed = exact.velocity.abs() + exact.at(2.0).1.abs();
    let x_bound = 0.125 * once * dt
        + means.bias * dt * changed
        + late * (2.0 - exact.stop_time()).max(0.0)
        + 1e-4 * way;
    let friction = rough.mass() * pull;
    let dissipated = newton.state().ledger.balance.dissipation_friction;
    let row = |what: &str| format!("{name}: {what}");
    let mut rows = vec![
        Row::at_most(row("error of the place, m"), x_worst, x_bound),
        Row::at_most(row("error of the velocity, m/s"), v_worst, v_bound),
        Row::near(
            row("dissipated / (μ N way slid)"),
            dissipated / (friction * slid),
            1.0,
            1e-4,
        ),
    ];
    if exact.holds() {
        rows.push(Row::near(row("place of rest, m"), last, way, x_bound));
    }
    rows.extend(balances(name, &newton));
    Ok(rows)
}

/// A throw obliquely to the sides of a square block over a level plane, for 1 s: it stops after 0.68 s.
fn oblique(angle: f64, dt: f64) -> Result<Vec<Row>, Error> {
    let along = [angle.cos(), angle.sin()];
    let bias = 0.25;
    let mut newton = Rough {
        dim: 3,
        gravity: [0.0, 0.0, -GRAVITY],
        mu: 0.3,
        velocity: [SPEED * along[0], SPEED * along[1], 0.0],
        spring: None,
        belt: 0.0,
        scheme: theta(0.5 + bias),
        law: NOW,
        dt,
    }
    .start()?;
    let exact = Incline {
        angle: 0.0,
        mu: 0.3,
        gravity: GRAVITY,
        velocity: SPEED,
    };
    let (mut aside, mut worst) = (0.0_f64, 0.0_f64);
    while newton.state().time < 1.0 - 0.5 * dt {
        newton.step()?;
        let state = newton.state();
        let [u, _] = place(&newton, state);
        aside = aside.max((u[1] * along[0] - u[0] * along[1]).abs());
        let way = u[0] * along[0] + u[1] * along[1];
        worst = worst.max((way - exact.at(state.time).0).abs());
    }
    let way = exact.stop_distance();
    let name = format!("space, {angle} rad to a side");
    let bound = bias * dt * SPEED + 0.3 * GRAVITY * dt * dt / 8.0 + 1e-4 * way;
    let mut rows = vec![
        Row::at_most(format!("{name}: way aside / way"), aside / way, 1e-10),
        Row::at_most(format!("{name}: error of the way, m"), worst, bound),
    ];
    rows.extend(balances(&name, &newton));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "sliding-block",
    fact: "a block under Coulomb friction slides, stops, sticks and turns back as a mass point does, straight in space",
    run: |size| {
        let dts: &[f64] = match size {
            Size::Quick => &[0.01],
            Size::Full => &[0.01, 0.0025],
        };
        let stops = Incline {
            angle: 0.3,
            mu: 0.5,
            gravity: GRAVITY,
            velocity: SPEED,
        };
        let returns = Incline {
            angle: 0.5,
            mu: 0.3,
            velocity: -1.5 * SPEED,
            ..stops
        };
        let means = |scheme, law, bias| Means {
            scheme,
            law,
            bias,
            begins: 0.0,
        };
        let newmark = Means {
            begins: 0.1,
            ..means(newmark(0.49, 0.9), DISPLACEMENT, 0.0)
        };
        let sets = [
            ("theta 0.5, velocity law", means(theta(0.5), NOW, 0.0)),
            ("theta 0.75, velocity law", means(theta(0.75), NOW, 0.25)),
            (
                "theta 0.5, displacement law",
                means(theta(0.5), DISPLACEMENT, 0.0),
            ),
            ("Newmark (0.49, 0.9), displacement law", newmark),
        ];
        let mut rows = Vec::new();
        for &dt in dts {
            for (name, set) in sets {
                for (what, exact) in [("stops", &stops), ("comes back", &returns)] {
                    let name = format!("{name}, {what}, Δt {dt}");
                    rows.extend(slope(&name, exact, set, dt)?);
                }
            }
            for angle in [0.7, 0.2] {
                rows.extend(oblique(angle, dt)?);
            }
        }
        Ok(rows)
    },
};
