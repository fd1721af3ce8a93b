//! A bar in two zones that are glued at every node, the one in contact included.
//!
//! Problem: a bar of the set "classic" flies against a rigid plane; two bars of half its section lie in each other, each a zone, tied at
//! all nodes, and the first is in contact. Their motions are one motion, with the mass, the stiffness and the contact of the
//! single bar, under every scheme with the laws in the rate and in the gap, the latter with projection too, with lumped and with
//! consistent mass. Reference: the single bar, a second formulation of the same equations. Tolerance: 1e-10 of Z v0, which leaves
//! the rounding of some hundred steps room; with adaptive steps the same sizes are taken, since they depend on gaps and rates alone.
//! The trapezoidal rule, and HHT with little damping and lumped mass, are chaotic with the law in the gap: a bar that is faster by rounding alone leaves
//! another force (bars in impact, its table). Of these the same is asserted of the single bar, and nothing of the two.
//!
//! With four steps of the half in contact in one of the other the two motions are no longer one. The facts left: the force is Z v0 over
//! 2 L/c (mean over its middle, 1 %: oscillations behind the front have a mean that falls with the elements), balances close to
//! rounding, and a multiplier that is linear over the outer step takes from one half what it gives to the other. One that holds at all
//! inner instants (Gravouil, Combescure) is none of the kind: its impulse on the outer half is that of its two ends.

use carom_arlequin::trace;
use carom_bodies::{BodySpec, Kinematics, MassKind};
use carom_dynamics::{
    Adaptive, Closing, Driver, Model, ModelBody, ModelLink, Scheme, Stepper, scheme,
};
use carom_mesh::generate;
use carom_zones::{LinkKind, ModelZone, Whole, Zoned};

use crate::Error;
use crate::bars::CLASSIC;
use crate::build::{DISPLACEMENT, NOW, PROJECTION, contact, newmark, plane, surface, theta};
use crate::check::{Check, Row};
use crate::features::{label, schemes};
use crate::reasons::reason;
use carom_contact::Law;

/// What is run both ways.
#[derive(Clone, Copy)]
struct Problem {
    scheme: Scheme,
    law: Law,
    mass: MassKind,
    adaptive: bool,
    /// Speed over that of the set.
    speed: f64,
}

pub(crate) const CHECK: Check = Check {
    name: "zones-glued-at-contact",
    fact: "a link that ends on the node in contact leaves the force of the single bar under every scheme, with fixed and adaptive steps",
    run: |_| {
        let (mut rows, mut taken) = (Vec::new(), 0);
        for (name, problem) in problems() {
            let single = match crate::witness::system(single(problem.zoned()?.model)) {
                Ok(system) => history(Driver::new(system)?)?,
                Err(error) => {
                    let error = Error::System(error);
                    match reason(&error) {
                        Some(_) => continue,
                        None => return Err(error),
                    }
                }
            };
            taken += 1;
            let name = |what: &str| format!("{name}: {what}");
            if problem.is_chaotic() {
                let faster = Problem {
                    speed: 1.0 + f64::EPSILON,
                    ..problem
                };
                let [worst, _] = differences(&single, &faster.single_history()?);
                rows.push(Row::at_least(
                    name("single bar, faster by rounding: force / (Z v0)"),
                    worst,
                    1e-10,
                ));
                continue;
            }
            let together = problem.zoned()?.together()?.ok_or(Error::Apart)?;
            let [worst, times] = differences(&single, &history(Driver::new(together)?)?);
            let touched = single.iter().filter(|[_, force]| *force > 0.0).count();
            rows.push(Row::at_most(name("force / (Z v0)"), worst, 1e-10).second_formulation());
            rows.push(Row::at_most(name("times / duration"), times, 1e-10).second_formulation());
            rows.push(Row::at_least(
                name("steps in contact"),
                touched as f64,
                20.0,
            ));
        }
        rows.push(Row::count("problems".to_string(), taken, COUNT));
        for kind in [LinkKind::GravouilCombescure, LinkKind::PrakashHjelmstad] {
            rows.extend(apart(kind)?);
        }
        Ok(rows)
    },
};

/// Problems that no scheme refuses.
const COUNT: usize = 126;

fn problems() -> Vec<(String, Problem)> {
    let mut all = schemes();
    // its velocity answers to the impulse of the contact by itself too
    all.push(Scheme::Kane(scheme::Kane {
        beta: 0.49,
        gamma: 0.9,
    }));
    let laws = [
        ("velocity", NOW),
        ("displacement", DISPLACEMENT),
        ("displacement, projection", PROJECTION),
    ];
    let mut problems = Vec::new();
    for scheme in all {
        for (law_name, law) in laws {
            let lumped = scheme.get().needs_lumped_mass();
            for (mass_name, mass) in [
                ("", MassKind::Lumped),
                (", consistent", MassKind::Consistent),
            ]
            .into_iter()
            .take(if lumped { 1 } else { 2 })
            {
                for (steps, adaptive) in [("", false), (", adaptive", true)] {
                    let problem = Problem {
                        scheme,
                        law,
                        mass,
                        adaptive,
                        speed: 1.0,
                    };
                    let name = format!("{}, {law_name}{mass_name}{steps}", label(scheme));
                    problems.push((name, problem));
                }
            }
        }
    }
    problems
}

/// Largest differences of forces over Z v0, and of times over the duration.
fn differences(one: &[[f64; 2]], other: &[[f64; 2]]) -> [f64; 2] {
    let largest = |k: usize| {
        let pairs = one.iter().zip(other);
        pairs.map(|(a, b)| (a[k] - b[k]).abs()).fold(0.0, f64::max)
    };
    let full = CLASSIC.impedance() * CLASSIC.speed;
    [largest(1) / full, largest(0) / CLASSIC.duration()]
}

impl Problem {
    fn is_chaotic(&self) -> bool {
        let lumped = self.mass == MassKind::Lumped;
        let little = matches!(self.scheme, Scheme::Hht(hht) if lumped && hht.alpha > -0.2);
        let halves = matches!(self.scheme, Scheme::Bathe(bathe) if lumped && bathe.gamma == 0.5);
        let chatters = little || halves && !self.adaptive;
        self.law == DISPLACEMENT && (chatters || self.scheme == newmark(0.25, 0.5))
    }

    fn single_history(&self) -> Result<Vec<[f64; 2]>, Error> {
        history(Driver::new(crate::witness::system(single(
            self.zoned()?.model,
        ))?)?)
    }

    /// Two bars of half the section in each other.
    fn zoned(&self) -> Result<Zoned, Error> {
        let Problem {
            scheme,
            law,
            mass,
            adaptive,
            speed,
        } = *self;
        let (from, gap) = (-CLASSIC.length, 1e-5);
        let line =
            |name: &str| generate::line(name, [from - gap, 0.0, 0.0], [-gap, 0.0, 0.0], 40, 1);
        let mut mesh = line("tip");
        mesh.merge("rest", line("rest"))?;
        let body = |name: &str| -> ModelBody {
            let cells = mesh.groups[name].elements.clone();
            let area = 0.5 * CLASSIC.area;
            ModelBody {
                velocity: [speed * CLASSIC.speed, 0.0, 0.0],
                mass,
                ..ModelBody::new(BodySpec::new(
                    name,
                    cells,
                    Kinematics::Bar { area },
                    CLASSIC.material(),
                ))
            }
        };
        let bodies = vec![body("tip"), body("rest")];
        let nodes = |name: &str| mesh.group_nodes(&mesh.groups[name]);
        let rows = trace(&mesh, &nodes("tip"), &nodes("rest"), 1e-9)?.rows;
        let courant = if scheme.get().is_explicit() { 0.9 } else { 0.5 };
        let dt = courant * CLASSIC.length / 40.0 / CLASSIC.wave_speed();
        let secondary = surface(&mesh, "tip.right", &bodies[0])?;
        let zone =
            |body: usize| ModelZone::new(bodies[body].spec.name.clone(), vec![body], (scheme, 1));
        Ok(Zoned {
            zones: vec![zone(0), zone(1)],
            links: vec![ModelLink {
                name: "glue".to_string(),
                zones: [0, 1],
                rows,
            }],
            kind: LinkKind::GravouilCombescure,
            model: Model {
                contacts: vec![contact(secondary, plane(0, -1.0), law)],
                adaptive: adaptive.then_some(Adaptive {
                    smallest: dt / 64.0,
                    closing: Closing::Cut,
                    growth: None,
                    patience: 10,
                }),
                ..Model::new(bodies.clone(), mesh.clone(), scheme, dt)
            },
        })
    }
}

/// The half in contact in four steps to one of the other.
fn apart(kind: LinkKind) -> Result<Vec<Row>, Error> {
    let problem = Problem {
        scheme: theta(0.5),
        law: NOW,
        mass: MassKind::Lumped,
        adaptive: false,
        speed: 1.0,
    };
    let mut zoned = problem.zoned()?;
    (zoned.kind, zoned.zones[0].substeps) = (kind, 4);
    let whole = zoned.whole()?;
    let mut run = Whole::new(&zoned, whole)?;
    let (dt, gap) = (zoned.model.dt, 1e-5 / CLASSIC.speed);
    let (mut forces, mut steps) = (0.0, 0);
    while run.state().time < 1.2 * CLASSIC.duration() {
        run.step()?;
        let part = (run.state().time - 0.5 * dt - gap) / CLASSIC.duration();
        if (0.1..0.9).contains(&part) {
            forces += run.report().contacts[0].force;
            steps += 1;
        }
    }
    let full = CLASSIC.impedance() * CLASSIC.speed;
    let ledger = &run.state().ledger;
    let name = |what: &str| format!("four steps to one, {kind:?}: {what}");
    let momentum = ledger.largest_momentum;
    let on_both = name("impulse of the link on both halves / largest momentum");
    let of_link = ledger.balance.impulse_links.largest() / momentum;
    Ok(vec![
        Row::near(
            name("mean force / (Z v0)"),
            forces / f64::from(steps) / full,
            1.0,
            0.01,
        ),
        Row::at_most(
            name("momentum residual / largest"),
            ledger.largest_momentum_residual / momentum,
            1e-11,
        ),
        Row::at_most(
            name("energy residual / E0"),
            ledger.largest_energy_residual / ledger.initial.energy(),
            1e-11,
        ),
        match kind {
            LinkKind::PrakashHjelmstad => Row::at_most(on_both, of_link, 1e-11),
            LinkKind::GravouilCombescure => Row::shown(on_both, of_link),
        },
        Row::shown(
            name("energy change"),
            ledger.balance.energy() / ledger.initial.energy() - 1.0,
        ),
    ])
}

/// The first of the two bars, with the whole section.
fn single(mut model: Model) -> Model {
    model.bodies.truncate(1);
    model.bodies[0].spec.kinematics = Kinematics::Bar { area: CLASSIC.area };
    model
}

/// Times and forces of the steps to 1.2 durations of the contact.
fn history(mut driver: Driver) -> Result<Vec<[f64; 2]>, Error> {
    let mut history = Vec::new();
    while driver.state().time < 1.2 * CLASSIC.duration() {
        driver.step()?;
        history.push([driver.state().time, driver.report().contacts[0].force]);
    }
    Ok(history)
}
