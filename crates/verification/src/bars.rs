//! Elastic bars in impact, computed in one, two or three dimensions, with the figures of merit against the exact
//! solution.

use carom_bodies::{BodySpec, Kinematics, MassKind};
use carom_contact::{Law, Sliding};
use carom_dynamics::{
    Driver, Error, Model, ModelBody, ModelContact, ModelTarget, Observer, Scheme, State,
    StepReport, System, march,
};
use carom_exact::{Bar, Impact, Solution};
use carom_materials::Elastic;
use carom_mesh::{Mesh, Surface, generate};

/// Two equal bars, the first of which strikes the second at rest; both free at their far ends.
#[derive(Clone, Copy, Debug)]
pub struct Set {
    /// Length of each bar, m.
    pub length: f64,
    /// Section, m².
    pub area: f64,
    /// Young's modulus, Pa.
    pub young: f64,
    /// Density, kg/m³.
    pub density: f64,
    /// Speed of the striker, m/s.
    pub speed: f64,
}

/// The set "slow": the paper's dt = 1e-5 s is meaningful here.
pub const SLOW: Set = Set {
    length: 10.0,
    area: 6.45e-4,
    young: 2.1e11,
    density: 7800.0,
    speed: 10.0,
};

/// The set "classic": the family of Hughes et al. (1976).
pub const CLASSIC: Set = Set {
    length: 0.254,
    area: 6.45e-4,
    young: 2.07e11,
    density: 7844.0,
    speed: 5.1359,
};

impl Set {
    /// Wave speed in m/s.
    pub fn wave_speed(&self) -> f64 {
        (self.young / self.density).sqrt()
    }

    /// Exact contact force Z v0 / 2 in N.
    pub fn force(&self) -> f64 {
        0.5 * self.density * self.wave_speed() * self.area * self.speed
    }

    /// Exact duration of the contact 2 L / c in s.
    pub fn duration(&self) -> f64 {
        2.0 * self.length / self.wave_speed()
    }

    /// Kinetic energy of the striker in J.
    pub fn energy(&self) -> f64 {
        0.5 * self.density * self.area * self.length * self.speed * self.speed
    }

    /// Mass of one bar in kg.
    pub fn mass(&self) -> f64 {
        self.density * self.area * self.length
    }

    /// The exact solution up to a time.
    ///
    /// # Errors
    /// None for the sets of this module.
    pub fn exact(&self, end: f64) -> Result<Solution, carom_exact::Error> {
        let bar = Bar::new(self.length, self.area, self.young, self.density);
        let impact = Impact::TwoBars {
            secondary: bar.with_velocity(-self.speed),
            primary: bar,
            gap: 0.0,
        };
        carom_exact::solve(&impact, end)
    }
}

/// What the bars are made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Elements {
    /// One-dimensional bars.
    Bar2,
    /// Plane strain, one square-ish quadrilateral high.
    Quad4,
    /// Solids, one hexahedron in the section.
    Hex8,
}

/// A run of two bars.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// The bars.
    pub set: Set,
    /// Elements along each bar.
    pub elements: usize,
    /// Their kind; Poisson's ratio is zero.
    pub kind: Elements,
    /// Mass.
    pub mass: MassKind,
    /// Time scheme.
    pub scheme: Scheme,
    /// Contact law.
    pub law: Law,
    /// Courant number c dt / h.
    pub courant: f64,
    /// End time as a multiple of the exact duration of the contact.
    pub end: f64,
}

impl Run {
    /// Step in s.
    pub fn dt(&self) -> f64 {
        self.courant * self.set.length / self.elements as f64 / self.set.wave_speed()
    }

    /// The model of the run.
    ///
    /// # Errors
    /// None for a run with at least one element.
    pub fn model(&self) -> Result<Model, carom_mesh::Error> {
        let (set, n) = (&self.set, self.elements);
        let side = set.area.sqrt();
        let part = |name: &str, from: f64| match self.kind {
            Elements::Bar2 => {
                generate::line(name, [from, 0.0, 0.0], [from + set.length, 0.0, 0.0], n, 1)
            }
            Elements::Quad4 => {
                generate::rectangle(name, [from, 0.0], [set.length, side], [n, 1], false)
            }
            Elements::Hex8 => generate::box_(
                name,
                [from, 0.0, 0.0],
                [set.length, side, side],
                [n, 1, 1],
                false,
            ),
        };
        let mut mesh: Mesh = part("striker", -set.length);
        mesh.merge("target", part("target", 0.0))?;
        let kinematics = match self.kind {
            Elements::Bar2 => Kinematics::Bar { area: set.area },
            Elements::Quad4 => Kinematics::PlaneStrain { thickness: side },
            Elements::Hex8 => Kinematics::Solid,
        };
        let body = |name: &str, speed: f64| ModelBody {
            spec: BodySpec {
                name: name.to_string(),
                cells: mesh.groups[name].elements.clone(),
                kinematics,
                material: Elastic {
                    density: set.density,
                    young: set.young,
                    poisson: 0.0,
                },
            },
            mass: self.mass,
            velocity: [speed, 0.0, 0.0],
            displacement: [0.0; 3],
        };
        let bodies = vec![body("striker", set.speed), body("target", 0.0)];
        let surface = |group: &str, body: &ModelBody| {
            Surface::new(&mesh, &mesh.groups[group], &body.spec.cells)
        };
        let contacts = vec![ModelContact {
            name: "shock".to_string(),
            secondary: surface("striker.right", &bodies[0])?,
            primary: ModelTarget::Surface(surface("target.left", &bodies[1])?),
            law: self.law,
            sliding: Sliding::Finite,
        }];
        Ok(Model {
            bodies,
            supports: Vec::new(),
            gravity: [0.0; 3],
            contacts,
            scheme: self.scheme,
            dt: self.dt(),
            mesh,
        })
    }
}

/// History of one contact and of the balance, one entry per step.
#[derive(Clone, Debug, Default)]
pub struct History {
    /// Time at the end of each step, s.
    pub time: Vec<f64>,
    /// Contact force, N.
    pub force: Vec<f64>,
    /// Least gap, m.
    pub gap: Vec<f64>,
    /// Gap rate there, m/s.
    pub rate: Vec<f64>,
    /// Kinetic and strain energy, J.
    pub energy: Vec<f64>,
    /// Energy residual of the ledger, J.
    pub residual: Vec<f64>,
}

impl Observer for History {
    fn accepted(
        &mut self,
        _system: &System,
        _state: &State,
        report: &StepReport,
    ) -> Result<(), Error> {
        if report.step > 0 {
            self.time.push(report.time);
            self.force.push(report.contacts[0].force);
            self.gap.push(report.contacts[0].gap);
            self.rate.push(report.contacts[0].rate);
            self.energy.push(report.balance.energy());
            self.residual.push(report.balance.energy_residual);
        }
        Ok(())
    }

    fn finish(&mut self, _system: &System, _state: &State) -> Result<(), Error> {
        Ok(())
    }
}

/// Figures of merit of a run of two bars.
#[derive(Clone, Copy, Debug)]
pub struct Figures {
    /// Relative L2 error of the contact force, step by step against the mean of the exact force over the step, on all
    /// steps that meet the exact contact.
    pub force_error: f64,
    /// (max F - F0) / F0.
    pub overshoot: f64,
    /// Energy at the end / initial - 1.
    pub energy_change: f64,
    /// Changes of "F > 1e-4 F0", the closing at the first step not counted.
    pub switches: usize,
    /// Separation of the mean velocities / v0.
    pub restitution: f64,
    /// Largest penetration / (v0 dt).
    pub penetration: f64,
    /// Largest |F ġ₊| / (F0 v0) after the impact step and before 0.98 of the contact.
    pub defect: f64,
    /// Largest absolute energy residual / initial energy.
    pub residual: f64,
}

/// Runs the bars: history, figures and the final state.
///
/// # Errors
/// What the system or a step refuses.
pub fn run(run: &Run) -> Result<(History, Figures, State), Box<dyn std::error::Error>> {
    let system = System::new(run.model()?)?;
    let mut driver = Driver::new(system)?;
    let mut history = History::default();
    march(
        &mut driver,
        run.end * run.set.duration(),
        &mut [&mut history],
        &|| false,
    )?;
    let figures = figures(run, &driver, &history)?;
    Ok((history, figures, driver.state().clone()))
}

fn figures(
    run: &Run,
    driver: &Driver,
    history: &History,
) -> Result<Figures, Box<dyn std::error::Error>> {
    let (set, system) = (&run.set, driver.system());
    let (f0, duration) = (set.force(), set.duration());
    let dt = run.dt();
    let exact = set.exact(run.end.max(1.0) * duration + dt)?;
    let (mut error, mut norm) = (0.0, 0.0);
    for (end, force) in history
        .time
        .iter()
        .zip(&history.force)
        .filter(|(end, _)| *end - dt < duration * (1.0 - 1e-12))
    {
        let mean = exact.force().mean(end - dt, *end);
        error += (force - mean).powi(2);
        norm += mean.powi(2);
    }
    let active: Vec<bool> = history
        .force
        .iter()
        .map(|force| *force > 1e-4 * f0)
        .collect();
    let v = &driver.state().motion.v;
    let separation = system.mean_velocity(1, v)[0] - system.mean_velocity(0, v)[0];
    let first = active.iter().position(|active| *active).unwrap_or(0);
    let persistent = (first + 1..history.time.len()).filter(|&k| history.time[k] < 0.98 * duration);
    let records = &driver.state().records.contacts[0];
    Ok(Figures {
        force_error: (error / norm).sqrt(),
        overshoot: history.force.iter().fold(0.0_f64, |m, f| m.max(*f)) / f0 - 1.0,
        energy_change: driver.state().ledger.balance.energy() / set.energy() - 1.0,
        switches: active.windows(2).filter(|pair| pair[0] != pair[1]).count(),
        restitution: separation / set.speed,
        penetration: records.penetration / (set.speed * run.dt()),
        defect: persistent
            .map(|k| (history.force[k] * history.rate[k]).abs() / (f0 * set.speed))
            .fold(0.0, f64::max),
        residual: driver.state().ledger.largest_energy_residual / set.energy(),
    })
}

#[cfg(test)]
mod tests {
    use carom_contact::law::*;
    use carom_dynamics::scheme::*;

    use super::*;

    fn base() -> Run {
        Run {
            set: SLOW,
            elements: 200,
            kind: Elements::Bar2,
            mass: MassKind::Lumped,
            scheme: Scheme::Theta(Theta { theta: 0.5 }),
            law: Law::Velocity(Velocity {
                capture: Capture::Half,
                reading: Reading::Closed,
            }),
            courant: 0.5,
            end: 1.5,
        }
    }

    #[test]
    fn table() {
        let now = Law::Velocity(Velocity {
            capture: Capture::Now,
            reading: Reading::Closed,
        });
        let disp = Law::Displacement(Displacement);
        let z = 0.5f64; // fraction
        let rho_c = SLOW.density * SLOW.wave_speed();
        let kp = SLOW.young / (SLOW.length / 200.0);
        let damped = |c: f64, adhesion| {
            Law::Damped(Damped {
                stiffness: kp,
                damping: c * rho_c,
                adhesion,
            })
        };
        let trap = Scheme::Newmark(Newmark {
            beta: 0.25,
            gamma: 0.5,
        });
        let mut rows: Vec<(&str, Run)> = vec![
            ("theta .5 cfl .5", base()),
            (
                "theta .5 cfl 1",
                Run {
                    courant: 1.0,
                    ..base()
                },
            ),
            (
                "theta .75",
                Run {
                    scheme: Scheme::Theta(Theta { theta: 0.75 }),
                    law: now,
                    ..base()
                },
            ),
            (
                "theta 1",
                Run {
                    scheme: Scheme::Theta(Theta { theta: 1.0 }),
                    law: now,
                    ..base()
                },
            ),
            (
                "damped .5",
                Run {
                    scheme: trap,
                    law: damped(z, Adhesion::Clip),
                    ..base()
                },
            ),
            (
                "damped 0 ap",
                Run {
                    scheme: trap,
                    law: damped(0.0, Adhesion::AsPrinted),
                    ..base()
                },
            ),
            (
                "damped .1 ap",
                Run {
                    scheme: trap,
                    law: damped(0.1, Adhesion::AsPrinted),
                    ..base()
                },
            ),
            (
                "damped 5 ap",
                Run {
                    scheme: trap,
                    law: damped(5.0, Adhesion::AsPrinted),
                    ..base()
                },
            ),
            (
                "damped 50 ap",
                Run {
                    scheme: trap,
                    law: damped(50.0, Adhesion::AsPrinted),
                    ..base()
                },
            ),
            (
                "damped 5 clip",
                Run {
                    scheme: trap,
                    law: damped(5.0, Adhesion::Clip),
                    ..base()
                },
            ),
            (
                "damped 50 clip",
                Run {
                    scheme: trap,
                    law: damped(50.0, Adhesion::Clip),
                    ..base()
                },
            ),
            (
                "cd",
                Run {
                    scheme: Scheme::CentralDifference(CentralDifference),
                    law: now,
                    courant: 0.9,
                    ..base()
                },
            ),
            (
                "7d",
                Run {
                    law: Law::Velocity(Velocity {
                        capture: Capture::Now,
                        reading: Reading::AsPrinted,
                    }),
                    ..base()
                },
            ),
            (
                "hex",
                Run {
                    kind: Elements::Hex8,
                    ..base()
                },
            ),
            (
                "quad",
                Run {
                    kind: Elements::Quad4,
                    ..base()
                },
            ),
        ];
        for (b, g) in [(0.25, 0.5), (0.5, 0.5), (0.49, 0.9)] {
            for courant in [1.0, 2.0, 4.0] {
                rows.push((
                    "newmark",
                    Run {
                        elements: 100,
                        scheme: Scheme::Newmark(Newmark { beta: b, gamma: g }),
                        law: disp,
                        courant,
                        ..base()
                    },
                ));
            }
        }
        for (name, r) in rows {
            let t = std::time::Instant::now();
            match run(&r) {
                Ok((_, f, _)) => println!(
                    "{name:15} {:.4} {:.4} {:+.6} {} {:.4} {:.3} {:.1e} res {:.1e} t {:.2?}",
                    f.force_error,
                    f.overshoot,
                    f.energy_change,
                    f.switches,
                    f.restitution,
                    f.penetration,
                    f.defect,
                    f.residual,
                    t.elapsed()
                ),
                Err(e) => println!("{name:15} {e}"),
            }
        }
    }
}
