//! Two bars whose tips are zones of their own, glued to the rest over a volume.

use carom_arlequin::{Coupling, Model as Side, Models, Overlap, Region, Weighting};
use carom_bodies::{CellWeights, Kinematics};
use carom_contact::Law;
use carom_dynamics::{Balance, Costs, Model, ModelBody, ModelLink, ModelTarget, Scheme};
use carom_mesh::{Mesh, generate};
use carom_zones::{LinkKind, ModelZone, Zoned};

use crate::Error;
use crate::bars::{SLOW, Set};
use crate::build::{HALF, NOW, body, contact, group, surface, theta};

/// Bars with glued tips. Lengths in m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Glued {
    /// The bars.
    pub(crate) set: Set,
    /// Length of each tip, the overlap included.
    pub(crate) tip: f64,
    /// Length of the overlap.
    pub(crate) overlap: f64,
    /// Element sizes of the tips and of the rest.
    pub(crate) sizes: [f64; 2],
    /// Schemes of the tips and of the rest.
    pub(crate) schemes: [Scheme; 2],
    /// Outer step, s.
    pub(crate) dt: f64,
    /// Inner steps to an outer one.
    pub(crate) substeps: u32,
    /// The same while the bars cannot touch; `None` for as many.
    pub(crate) far: Option<u32>,
    /// How multipliers run.
    pub(crate) kind: LinkKind,
    /// Weights.
    pub(crate) weighting: Weighting,
    /// Mediator and bracket.
    pub(crate) coupling: Coupling,
    /// Contact law.
    pub(crate) law: Law,
    /// Gap at the start.
    pub(crate) gap: f64,
    /// Whether the rows join the factor of the tips.
    pub(crate) joined: bool,
}

impl Glued {
    /// The bars of the set "slow" as in the tables: impact zone 2 m, overlap 0.8 m, elements of 0.05 m and 0.2 m, linear
    /// weights, coarse L2 mediator. `outer`: scheme of the rest; `courant`: c DT / h of the rest.
    pub(crate) fn slow(theta_of_tips: f64, outer: Scheme, courant: f64, substeps: u32) -> Glued {
        Glued {
            set: SLOW,
            tip: 2.0,
            overlap: 0.8,
            sizes: [0.05, 0.2],
            schemes: [theta(theta_of_tips), outer],
            dt: courant * 0.2 / SLOW.wave_speed(),
            substeps,
            far: None,
            kind: match substeps {
                1 => LinkKind::GravouilCombescure,
                _ => LinkKind::PrakashHjelmstad,
            },
            weighting: Weighting::default(),
            coupling: Coupling::default(),
            law: if theta_of_tips > 0.5 { NOW } else { HALF },
            gap: 0.0,
            joined: false,
        }
    }

    fn part(&self, name: &str, from: f64, to: f64, size: f64) -> Mesh {
        let n = ((to - from) / size).round() as usize;
        generate::line(name, [from, 0.0, 0.0], [to, 0.0, 0.0], n, 1)
    }

    fn mesh(&self) -> Result<Mesh, Error> {
        let (length, tip, border) = (self.set.length, self.tip, self.tip - self.overlap);
        let [fine, coarse] = self.sizes;
        let mut mesh = self.part("striker.tip", -tip - self.gap, -self.gap, fine);
        let rest = self.part(
            "striker.rest",
            -length - self.gap,
            -border - self.gap,
            coarse,
        );
        mesh.merge("striker", rest)?;
        mesh.merge("target tip", self.part("target.tip", 0.0, tip, fine))?;
        mesh.merge("target", self.part("target.rest", border, length, coarse))?;
        Ok(mesh)
    }

    /// The model in zones: tips, then the rest.
    pub(crate) fn zoned(&self) -> Result<Zoned, Error> {
        let mesh = self.mesh()?;
        let kinematics = Kinematics::Bar {
            area: self.set.area,
        };
        let (mut bodies, mut links) = (Vec::new(), Vec::new());
        for (k, bar) in ["striker", "target"].into_iter().enumerate() {
            let [tip, rest] = ["tip", "rest"].map(|part| format!("{bar}.{part}"));
            let cells = |name: &str| Ok::<_, Error>(group(&mesh, name)?.elements.clone());
            let (inner, outer) = (cells(&tip)?, cells(&rest)?);
            let models = Models {
                mesh: &mesh,
                inner: &inner,
                outer: &outer,
            };
            let overlap = Overlap::new(models, &Region::Intersection)?;
            let weights = overlap.weights(&self.weighting)?;
            for (name, side, weights) in [
                (&tip, Side::Inner, weights.inner),
                (&rest, Side::Outer, weights.outer),
            ] {
                let mut part = body(&mesh, name, kinematics, self.set.material())?;
                part.spec.cells = overlap.cells(side).to_vec();
                part.spec.weights = Some(CellWeights {
                    inertia: weights.inertia,
                    stiffness: weights.stiffness,
                });
                part.velocity[0] = if k == 0 { self.set.speed } else { 0.0 };
                bodies.push(part);
            }
            links.push(ModelLink {
                name: bar.to_string(),
                zones: [0, 1],
                rows: overlap.rows(&self.coupling)?.rows,
            });
        }
        let secondary = surface(&mesh, "striker.tip.right", &bodies[0])?;
        let primary = ModelTarget::Surface(surface(&mesh, "target.tip.left", &bodies[2])?);
        let zone = |name: &str, bodies: Vec<usize>, scheme, substeps| ModelZone {
            name: name.to_string(),
            bodies,
            scheme,
            substeps,
            far: (substeps > 1).then_some(self.far).flatten(),
        };
        Ok(Zoned {
            zones: vec![
                zone("tips", vec![0, 2], self.schemes[0], self.substeps),
                zone("rest", vec![1, 3], self.schemes[1], 1),
            ],
            model: model(mesh, bodies, contact(secondary, primary, self.law), self.dt),
            links,
            kind: self.kind,
        })
    }

    /// Runs to `end` (s): figures of merit.
    pub(crate) fn run_to(&self, end: f64) -> Result<Figures, Error> {
        let mut zones = crate::witness::zones(&self.zoned()?)?;
        if self.joined {
            zones.solve_without_matrix()?;
        }
        let (f0, duration) = (
            0.5 * self.set.impedance() * self.set.speed,
            self.set.duration(),
        );
        let start = zones.balance();
        let mut figures = Figures::default();
        let (mut error, mut norm) = (0.0, 0.0);
        while zones.time() < end * (1.0 - 1e-9) {
            zones.step()?;
            for sample in zones.samples().iter().filter(|s| !s.contacts.is_empty()) {
                let force = sample.contacts[0].force;
                figures.force.push((sample.time, force));
                figures.overshoot = figures.overshoot.max(force / f0 - 1.0);
                let begin = sample.time - sample.dt;
                if begin < duration * (1.0 - 1e-12) {
                    let mean = f0 * ((duration - begin) / sample.dt).min(1.0);
                    error += (force - mean).powi(2);
                    norm += mean * mean;
                }
            }
            let balance = zones.balance();
            figures.residual = figures.residual.max(balance.energy_residual.abs());
            figures.momentum = figures.momentum.max(balance.momentum_residual.largest());
        }
        for driver in zones.drivers() {
            let costs = driver.costs();
            figures.element_updates += costs.element_updates as f64;
            figures.swept += swept(&costs);
        }
        figures.inner_steps = zones.drivers()[0].state().step;
        let end = zones.balance();
        figures.force_error = f64::sqrt(error / norm);
        let energy = |balance: &Balance| balance.energy() + balance.scheme_energy;
        figures.energy_change = energy(&end) / energy(&start) - 1.0;
        figures.link_work = end.work_links / start.energy();
        figures.residual /= start.energy();
        figures.momentum /= start.momentum.largest();
        figures.passes = zones.all_passes() as f64 / zones.outer_step() as f64;
        Ok(figures)
    }
}

/// Entries of factors that the sweeps of a run have read.
pub(crate) fn swept(costs: &Costs) -> f64 {
    let factors = costs.factors.iter();
    factors.map(|f| (f.sweeps * f.nnz_factor) as f64).sum()
}

/// A model with one contact, everything else free.
pub(crate) fn model(
    mesh: Mesh,
    bodies: Vec<ModelBody>,
    contact: carom_dynamics::ModelContact,
    dt: f64,
) -> Model {
    Model {
        contacts: vec![contact],
        ..Model::new(bodies, mesh, theta(0.5), dt)
    }
}

/// Figures of merit of glued bars.
#[derive(Clone, Debug, Default)]
pub(crate) struct Figures {
    /// Time at the end of each step of the tips, s, and force, N.
    pub(crate) force: Vec<(f64, f64)>,
    /// Relative L2 error of the contact force against the mean of the exact one over each step.
    pub(crate) force_error: f64,
    /// (max F - F0) / F0.
    pub(crate) overshoot: f64,
    /// Energy that the schemes balance, with their terms in |a|², at the end / initial - 1.
    pub(crate) energy_change: f64,
    /// Net work of the links / initial energy.
    pub(crate) link_work: f64,
    /// Largest energy residual of the zones together / initial energy.
    pub(crate) residual: f64,
    /// Largest momentum residual / momentum.
    pub(crate) momentum: f64,
    /// Elements whose internal forces were computed.
    pub(crate) element_updates: f64,
    /// Entries of factors swept.
    pub(crate) swept: f64,
    /// Steps of the tips.
    pub(crate) inner_steps: u64,
    /// Mean passes to an outer step.
    pub(crate) passes: f64,
}
