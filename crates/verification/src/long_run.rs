//! The clamped bar that bounces for 200 periods.
//!
//! Problem: L = E = ρ = A = 1, u(1) = 0, u(x, 0) = (1 - x)/2, at rest, a rigid wall at the place of the free end: period 3,
//! contact in [1, 2] of each, contact stress ½, energy 1/8. Reference: the exact motion (carom_exact; the problem of
//! Khenous, Laborde and Renard 2008), which never loses energy. What a scheme promises: the theta scheme (θ >= ½) and
//! central differences under a law in the rate never gain energy, each in the energy of its own identity; the schemes of Laursen
//! and Chawla and of Laursen and Love keep it. Bound: a gain of 1e-9 of the energy, for the rounding of some 1e5 steps. How late the last
//! contact begins under theta ½ has no known order, since the waves of one bounce decide the next: it is a regression, to a step.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::Capture;
use carom_contact::{Law, Plane};
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelTarget, Scheme, Support, march};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};

use crate::Error;
use crate::build::{DISPLACEMENT, NOW, PROJECTION, group, velocity};
use crate::check::{Check, Row, Size};

/// Exact energy, J.
const ENERGY: f64 = 0.125;

/// Period, s.
const PERIOD: f64 = 3.0;

pub(crate) const CHECK: Check = Check {
    name: "long-run",
    fact: "over many bounces no scheme gains energy that promises not to, and impacts keep the times that were found",
    run: |size| {
        let (elements, periods, late) = match size {
            Size::Quick => (20, 20, 0.0333333),
            Size::Full => (100, 200, 0.101667),
        };
        let mut rows = Vec::new();
        for scheme in Scheme::registered() {
            let Some(law) = promising(scheme) else {
                continue;
            };
            let Some(bounces) = bounces(scheme, law, elements, periods)? else {
                continue;
            };
            let name = title(scheme);
            rows.push(Row::at_most(
                format!("{name}: energy gained / energy"),
                bounces.gain,
                1e-9,
            ));
        }
        let half = velocity(Capture::Half);
        if let Some(bounces) = bounces(crate::build::theta(0.5), half, elements, periods)? {
            let step = 0.5 / elements as f64 / PERIOD;
            let what = "theta ½: last impact late by, periods";
            rows.push(Row::near(what, bounces.late, late, step).regression());
        }
        Ok(rows)
    },
};

/// The law under which a scheme promises not to gain energy.
fn promising(scheme: Scheme) -> Option<Law> {
    match scheme {
        Scheme::Theta(theta) if theta.theta == 0.5 => Some(velocity(Capture::Half)),
        Scheme::Theta(_) | Scheme::CentralDifference(_) | Scheme::LaursenChawla(_) => Some(NOW),
        Scheme::LaursenLove(_) => Some(DISPLACEMENT),
        _ => None,
    }
}

/// What 200 periods leave.
#[derive(Clone, Copy, Debug)]
pub struct Bounces {
    /// Energy at the end / energy - 1, kinetic and strain.
    pub drift: f64,
    /// Largest gain over the energy at the start, in the energy that the scheme balances, / energy.
    pub gain: f64,
    /// How late the last contact begins, in periods.
    pub late: f64,
    /// Intervals with a force; chatter within an impact counts each time.
    pub intervals: u64,
}

/// Runs the bar; `None` where the scheme refuses the law.
///
/// # Errors
/// A model that cannot be built or a step that fails.
pub fn bounces(
    scheme: Scheme,
    law: Law,
    elements: usize,
    periods: usize,
) -> Result<Option<Bounces>, Error> {
    let mesh = generate::line("bar", [0.0; 3], [1.0, 0.0, 0.0], elements, 1);
    let cells = group(&mesh, "bar")?.elements.clone();
    let model = Model {
        supports: vec![Support {
            nodes: mesh.group_nodes(group(&mesh, "bar.right")?),
            fix: [true, false, false],
            fix_rotations: [false; 3],
        }],
        contacts: vec![ModelContact::new(
            "wall",
            Surface::new(&mesh, group(&mesh, "bar.left")?, &cells)?,
            ModelTarget::rigid(Plane {
                point: [0.0; 3],
                normal: [1.0, 0.0, 0.0],
            }),
            law,
        )],
        ..Model::new(
            vec![ModelBody::new(BodySpec::new(
                "bar",
                cells.clone(),
                Kinematics::Bar { area: 1.0 },
                Elastic {
                    density: 1.0,
                    young: 1.0,
                    poisson: 0.0,
                },
            ))],
            mesh,
            scheme,
            0.5 / elements as f64,
        )
    };
    let Ok(system) = crate::witness::system(model) else {
        return Ok(None);
    };
    let stretched: Vec<f64> = system.x.iter().map(|x| 0.5 * (1.0 - x[0])).collect();
    let still = vec![0.0; stretched.len()];
    let mut driver = Driver::new(system)?;
    driver.restart(&stretched, &still)?;
    let mut gain = Gain::default();
    march(
        &mut driver,
        PERIOD * periods as f64,
        &mut [&mut gain],
        &|| false,
    )?;
    let state = driver.state();
    let impacts = state.impacts(driver.system());
    // chatter splits contacts: the last one begins with the first impact from the middle of the flight before it on
    let exact = PERIOD * (periods - 1) as f64 + 1.0;
    let last = impacts.iter().find(|impact| impact.start > exact - 1.0);
    Ok(Some(Bounces {
        drift: state.ledger.balance.energy() / ENERGY - 1.0,
        gain: gain.largest / ENERGY,
        late: last.map_or(f64::NAN, |impact| impact.start - exact) / PERIOD,
        intervals: impacts.iter().map(|impact| impact.intervals).sum(),
    }))
}

/// Largest energy over that at the start, in the energy that the scheme balances.
#[derive(Default)]
struct Gain {
    start: Option<f64>,
    largest: f64,
}

impl carom_dynamics::Observer for Gain {
    fn accepted(&mut self, run: &dyn carom_dynamics::Stepper) -> Result<(), carom_dynamics::Error> {
        let report = run.report();
        let energy = report.balance.energy() + report.balance.scheme_energy;
        let start = *self.start.get_or_insert(energy);
        self.largest = self.largest.max(energy - start);
        Ok(())
    }

    fn finish(&mut self, _run: &dyn carom_dynamics::Stepper) -> Result<(), carom_dynamics::Error> {
        Ok(())
    }
}

/// The table of the manual: every registered scheme under the laws that it takes, as Markdown.
///
/// # Errors
/// As [`bounces`].
pub fn table(elements: usize, periods: usize) -> Result<String, Error> {
    let laws = [
        ("displacement", DISPLACEMENT),
        ("displacement, projection", PROJECTION),
        ("velocity, now", NOW),
        ("velocity, half", velocity(Capture::Half)),
    ];
    let mut text = String::from(
        "| scheme | law | energy drift | largest gain | last contact late by (periods) | intervals with a force |\n|---|---|---|---|---|---|\n",
    );
    for scheme in Scheme::registered() {
        for (name, law) in laws {
            let result = bounces(scheme, law, elements, periods);
            let cells = match result {
                Ok(None) => continue,
                Ok(Some(b)) => format!(
                    "{:+.2e} | {:.1e} | {:+.4} | {}",
                    b.drift, b.gain, b.late, b.intervals
                ),
                Err(error) => format!("{error} | | | "),
            };
            text += &format!("| {} | {name} | {cells} |\n", title(scheme));
        }
    }
    Ok(text)
}

/// Name of a scheme with its parameters: `newmark, beta: 0.25, gamma: 0.5`.
fn title(scheme: Scheme) -> String {
    let debug = format!("{scheme:?}");
    let parameters = debug
        .split_once('{')
        .map_or("", |(_, rest)| rest.trim_end_matches(['}', ')', ' ']));
    let comma = if parameters.is_empty() { "" } else { "," };
    format!("{}{comma}{}", scheme.get().name(), parameters.trim_end())
}
