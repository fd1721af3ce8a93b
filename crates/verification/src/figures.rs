//! Histories of a contact, and the figures of merit of bars against the exact solution.

use carom_dynamics::{Driver, Observer, Stepper, march};

use crate::Error;
use crate::bars::Run;
use crate::check::Row;
use crate::kind::Kind;
use crate::witness::{Compared, compare};

/// History of the first contact and of the balance, one entry per step.
#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    /// Time at the end of each step, s.
    pub(crate) time: Vec<f64>,
    /// Contact force, N.
    pub(crate) force: Vec<f64>,
    /// Least gap at the end of each step, m.
    pub(crate) gap: Vec<f64>,
    /// Gap rate at the point of least gap, m/s.
    pub(crate) rate: Vec<f64>,
    /// Kinetic and strain energy, J.
    pub(crate) energy: Vec<f64>,
}

impl Observer for History {
    fn accepted(&mut self, run: &dyn Stepper) -> Result<(), carom_dynamics::Error> {
        let report = run.report();
        if report.step > 0 {
            self.time.push(report.time);
            self.force.push(report.contacts[0].force);
            self.gap.push(report.contacts[0].gap);
            self.rate.push(report.contacts[0].rate);
            self.energy.push(report.balance.energy());
        }
        Ok(())
    }

    fn finish(&mut self, _run: &dyn carom_dynamics::Stepper) -> Result<(), carom_dynamics::Error> {
        Ok(())
    }
}

/// Figures of merit of a run of bars.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Figures {
    /// Relative L2 error of the contact force, step by step against the mean of the exact force over the step, on all
    /// steps that meet the exact contact.
    pub(crate) force_error: f64,
    /// (max F - F0) / F0.
    pub(crate) overshoot: f64,
    /// Energy at the end / initial - 1.
    pub(crate) energy_change: f64,
    /// The same for the energy that the scheme balances: with its term in |a|².
    pub(crate) balanced_change: f64,
    /// Changes of "F > 1e-4 F0", the closing at the first step not counted.
    pub(crate) switches: usize,
    /// Separation of the mean velocities along the axis / v0.
    pub(crate) restitution: f64,
    /// End of the last step with a force / exact duration.
    pub(crate) release: f64,
    /// Largest penetration / (v0 dt).
    pub(crate) penetration: f64,
    /// Largest |F ġ₊| / (F0 v0) after the impact step and before 0.98 of the contact.
    pub(crate) defect: f64,
    /// Largest absolute energy residual / initial energy.
    pub(crate) residual: f64,
    /// Largest component of the momentum residual / largest momentum or impulse.
    pub(crate) momentum_residual: f64,
}

/// Runs the bars: history and figures.
///
/// # Errors
/// What the system or a step refuses.
pub(crate) fn run(run: &Run) -> Result<(History, Figures), Error> {
    let (driver, history) = drive(run)?;
    let figures = figures(run, &driver, &history)?;
    Ok((history, figures))
}

/// Rows of a run and of one with twice the elements. `of`: the rows of one, and what it leaves: error of the force, loss of speed, loss of energy. The
/// front of two bars is spread so that these go as n^-1/3, n^-2/3 and 1/n; three quarters of each exponent are asked for.
pub(crate) fn converging(
    case: &Run,
    of: impl Fn(&Run, &mut Vec<Row>) -> Result<[f64; 3], Error>,
) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    let coarse = of(case, &mut rows)?;
    let n = case.elements;
    let finer = Run {
        elements: 2 * n,
        ..*case
    };
    let fine = of(&finer, &mut rows)?;
    let exponents = [
        ("force error", 1.0 / 3.0),
        ("1 - restitution", 2.0 / 3.0),
        ("energy lost", 1.0),
    ];
    for (k, (what, exponent)) in exponents.into_iter().enumerate() {
        let name = format!("{}: {what}, n = {} / n = {n}", case.name(), 2 * n);
        let bound = 0.5_f64.powf(0.75 * exponent);
        rows.push(Row::at_most(name, fine[k] / coarse[k], bound));
    }
    Ok(rows)
}

/// The same, of another model of the same bars.
pub(crate) fn run_stepper(
    run: &Run,
    stepper: &mut dyn Stepper,
) -> Result<(History, Figures), Error> {
    let mut history = History::default();
    let end = run.end * run.set.duration();
    march(stepper, end, &mut [&mut history], &|| false)?;
    let figures = figures(run, stepper, &history)?;
    Ok((history, figures))
}

/// Runs the bars to the end of the run.
pub(crate) fn drive(run: &Run) -> Result<(Driver, History), Error> {
    let mut driver = Driver::new(crate::witness::system(run.model()?)?)?;
    let mut history = History::default();
    let end = run.end * run.set.duration();
    march(&mut driver, end, &mut [&mut history], &|| false)?;
    Ok((driver, history))
}

fn figures(run: &Run, driver: &dyn Stepper, history: &History) -> Result<Figures, Error> {
    let (f0, v0, duration) = (run.force(), run.set.speed, run.set.duration());
    let force = &history.force;
    let active: Vec<bool> = force.iter().map(|force| *force > 1e-4 * f0).collect();
    let first = active.iter().position(|active| *active).unwrap_or(0);
    let persistent = (first + 1..force.len()).filter(|&k| history.time[k] < 0.98 * duration);
    let state = driver.state();
    let (ledger, records) = (&state.ledger, &state.records.contacts[0]);
    let (start, end) = (&ledger.initial, &ledger.balance);
    Ok(Figures {
        force_error: force_error(run, history)?,
        overshoot: force.iter().fold(0.0_f64, |m, f| m.max(*f)) / f0 - 1.0,
        energy_change: end.energy() / start.energy() - 1.0,
        balanced_change: (end.energy() + end.scheme_energy)
            / (start.energy() + start.scheme_energy)
            - 1.0,
        switches: active.windows(2).filter(|pair| pair[0] != pair[1]).count(),
        restitution: separation(run, driver) / v0,
        release: records.last_force.unwrap_or(f64::NAN) / duration,
        penetration: records.penetration / (v0 * run.dt()),
        defect: persistent
            .map(|k| (force[k] * history.rate[k]).abs() / (f0 * v0))
            .fold(0.0, f64::max),
        residual: ledger.largest_energy_residual / start.energy(),
        momentum_residual: ledger.largest_momentum_residual / ledger.largest_momentum,
    })
}

/// Mean velocity of the target, or zero, less that of the striker, m/s.
fn separation(run: &Run, driver: &dyn Stepper) -> f64 {
    let (system, v) = (driver.system(), &driver.state().motion.v);
    let mean = |body| system.mean_velocity(body, v)[run.axis()];
    match system.bodies.len() {
        1 => -mean(0),
        _ => mean(1) - mean(0),
    }
}

fn force_error(run: &Run, history: &History) -> Result<f64, Error> {
    let (duration, dt) = (run.set.duration(), run.dt());
    let exact = run.exact(run.end.max(1.0) * duration + dt)?;
    compare(|| Compared {
        title: format!(
            "Contact force: {}, {} law, {} elements",
            run.scheme.get().name(),
            run.law.get().name(),
            run.elements
        ),
        abscissa: ["time", "s"],
        ordinate: ["contact force", "N"],
        x: history.time.clone(),
        computed: history.force.clone(),
        reference: {
            let means = history.time.iter();
            means
                .map(|&end| exact.force().mean(end - dt, end))
                .collect()
        },
    });
    let (mut error, mut norm) = (0.0, 0.0);
    for (&end, force) in history.time.iter().zip(&history.force) {
        if end - dt < duration * (1.0 - 1e-12) {
            let mean = exact.force().mean(end - dt, end);
            error += (force - mean).powi(2);
            norm += mean.powi(2);
        }
    }
    Ok((error / norm).sqrt())
}

/// Names of the columns of a printed table, in its order.
const COLUMNS: [&str; 7] = [
    "force error",
    "overshoot",
    "energy change",
    "changes after the closing",
    "restitution",
    "penetration / (v0 dt)",
    "largest |F rate| / (F0 v0)",
];

impl Figures {
    /// Rows against a line of a printed table: force error, overshoot, energy change, changes, restitution,
    /// penetration, defect. An empty text leaves a column out.
    pub(crate) fn against(&self, name: &str, printed: [&str; 7]) -> Vec<Row> {
        let values = [
            self.force_error,
            self.overshoot,
            self.energy_change,
            self.switches as f64,
            self.restitution,
            self.penetration,
            self.defect,
        ];
        let columns = COLUMNS.iter().zip(values).zip(printed);
        columns
            .filter(|(_, printed)| !printed.is_empty())
            .map(|((column, value), printed)| {
                Row::printed(Kind::OtherCode, format!("{name}: {column}"), value, printed)
            })
            .collect()
    }

    /// Rows for the balances of energy and momentum, which hold to round-off.
    pub(crate) fn balances(&self, name: &str) -> [Row; 2] {
        [
            Row::at_most(
                format!("{name}: energy residual / E0"),
                self.residual,
                ROUND_OFF,
            ),
            Row::at_most(
                format!("{name}: momentum residual / largest"),
                self.momentum_residual,
                ROUND_OFF,
            ),
        ]
    }
}

/// Bound of the relative residuals of balances: a thousand steps of sums over a thousand numbers leave about 1e-13.
const ROUND_OFF: f64 = 1e-11;
