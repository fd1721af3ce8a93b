//! The figures of a run, from what was kept while it went.

use carom_dynamics::{Order, State, StepReport, System};
use carom_pages::plot::{
    Axis, ContactCurves, Curve, EnergyCurves, Figure, PSEUDO_TIME, Role, contact_figure,
    energy_figure,
};
use serde::{Deserialize, Serialize};

use crate::results::exact::{Polyline, force_curve, motion_curves};
use crate::results::sensor::{COMPONENTS, ContactPoint, Sensor};
use crate::results::trace::Trace;
use crate::results::{Reference, Settings};

/// Histories for the figures, in bounded memory.
#[derive(Debug)]
pub(crate) struct Curves {
    title: String,
    contact: Option<usize>,
    sensors: Vec<(String, Sensor)>,
    recorded: [bool; 3],
    traces: Traces,
}

/// What was seen so far.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Traces {
    /// Of each sensor: displacement, velocity, acceleration.
    motions: Vec<[Trace; 3]>,
    force: Trace,
    kinetic: Trace,
    strain: Trace,
    total: Trace,
    /// The energy that the scheme balances, where it has a term beside kinetic and strain energy.
    balanced: Trace,
    dissipated: Trace,
    /// Of runs that are not linear: what hardening stores, and what is dissipated in each way.
    further: [Trace; 7],
    residual: Trace,
}

/// Names of [`Traces::further`].
const FURTHER: [&str; 7] = [
    "hardening",
    "material",
    "damping",
    "friction",
    "viscosity",
    "deletion",
    "hourglass",
];

impl Curves {
    /// Follows the contact point, or without a contact the first probe; `probes`: the sensors of each.
    pub(crate) fn new(
        system: &System,
        settings: &Settings,
        point: Option<&ContactPoint>,
        probes: &[Vec<Sensor>],
    ) -> Curves {
        let (title, sensors, recorded) = match (point, settings.probes.first().zip(probes.first()))
        {
            (Some(point), _) => {
                let name = &system.contacts[point.contact].name;
                let title = format!("Contact '{name}', along {}", direction(point.axis));
                (title, point.sides.clone(), [true; 3])
            }
            (None, Some((probe, sensors))) => {
                let names = COMPONENTS.iter().map(ToString::to_string);
                let sensors = names.zip(sensors.iter().cloned()).collect();
                (format!("Probe '{}'", probe.name), sensors, probe.recorded())
            }
            (None, None) => (String::new(), Vec::new(), [false; 3]),
        };
        let motions = sensors.iter().map(|_| Default::default());
        Curves {
            title,
            contact: point.map(|point| point.contact),
            recorded,
            traces: Traces {
                motions: motions.collect(),
                ..Traces::default()
            },
            sensors,
        }
    }

    /// What was seen so far.
    pub(crate) fn kept(&self) -> &Traces {
        &self.traces
    }

    /// Whether this can be gone on with.
    pub(crate) fn takes(&self, kept: &Traces) -> bool {
        kept.motions.len() == self.traces.motions.len()
    }

    /// Goes on from what was seen.
    pub(crate) fn go_on(&mut self, kept: Traces) {
        self.traces = kept;
    }

    /// Displacement, velocity and acceleration of each sensor.
    pub(crate) fn motions(&self) -> &[[Trace; 3]] {
        &self.traces.motions
    }

    /// Residual of the balance of energy, J.
    pub(crate) fn residual(&self) -> &Trace {
        &self.traces.residual
    }

    /// The energies that are there, J, by name.
    pub(crate) fn energies(&self) -> Vec<(&'static str, &Trace)> {
        let traces = &self.traces;
        let own = [
            ("kinetic", &traces.kinetic),
            ("strain", &traces.strain),
            ("total", &traces.total),
            ("dissipated by scheme and contact", &traces.dissipated),
        ];
        let balanced = traces.balanced.points() != traces.total.points();
        let balanced = balanced.then_some(("balanced by the scheme", &traces.balanced));
        let there = |(_, trace): &(&str, &Trace)| trace.points().iter().any(|p| p.1 != 0.0);
        let further = FURTHER.into_iter().zip(&traces.further).filter(there);
        own.into_iter().chain(balanced).chain(further).collect()
    }

    pub(crate) fn push(&mut self, system: &System, state: &State, report: &StepReport) {
        let (t, motion, balance) = (report.time, &state.motion, &report.balance);
        let kept = &mut self.traces;
        for ((_, sensor), traces) in self.sensors.iter().zip(&mut kept.motions) {
            for (trace, order) in traces.iter_mut().zip(Order::ALL) {
                trace.push(t, sensor.of(system, motion, order));
            }
        }
        if let Some(contact) = self.contact {
            for (end, _, contacts) in report.parts() {
                kept.force.push(end, contacts[contact].force);
            }
        }
        kept.kinetic.push(t, balance.kinetic);
        kept.strain.push(t, balance.strain);
        kept.total.push(t, balance.energy());
        let balanced = balance.energy() + balance.scheme_energy;
        kept.balanced.push(t, balanced);
        let dissipated = balance.dissipation_scheme - balance.work_contact;
        kept.dissipated.push(t, dissipated);
        let further = [
            balance.hardening,
            balance.dissipation_material,
            balance.dissipation_damping,
            balance.dissipation_friction,
            balance.dissipation_viscosity,
            balance.dissipation_deletion,
            balance.hourglass,
        ];
        for (trace, value) in kept.further.iter_mut().zip(further) {
            trace.push(t, value);
        }
        kept.residual.push(t, balance.energy_residual);
    }

    /// Names of the files and figures as SVG, in the order of the report; none if no state was told.
    pub(crate) fn draw(
        &self,
        reference: Option<&Reference>,
        (end, is_static): (f64, bool),
    ) -> Vec<(&'static str, Result<String, carom_pages::Error>)> {
        let mut figures = Vec::new();
        let abscissa = is_static.then_some(PSEUDO_TIME);
        if self.traces.total.is_empty() {
            return figures;
        }
        if !self.sensors.is_empty() {
            let name = match self.contact {
                Some(_) => "plots/contact.svg",
                None => "plots/probe.svg",
            };
            figures.push((name, self.contact_svg(reference, end, abscissa)));
        }
        figures.push(("plots/energy.svg", self.energy_svg(abscissa)));
        figures
    }

    fn contact_svg(
        &self,
        reference: Option<&Reference>,
        end: f64,
        abscissa: Option<Axis>,
    ) -> Result<String, carom_pages::Error> {
        let exact: Vec<[Polyline; 3]> = reference.map_or(Vec::new(), |reference| {
            let bodies = 0..reference.solution.motions().len().min(self.sensors.len());
            bodies
                .map(|body| motion_curves(&reference.solution, body, end))
                .collect()
        });
        let motions = self.traces.motions.iter();
        let columns: Vec<[Polyline; 3]> = motions
            .map(|traces| [0, 1, 2].map(|k: usize| traces[k].columns()))
            .collect();
        let curves = |k: usize| {
            let exact = exact
                .iter()
                .map(|motion| curve("exact", &motion[k], Role::Exact));
            let names = self.sensors.iter().map(|(name, _)| name);
            let computed = names.zip(&columns);
            let computed = computed.map(|(name, motion)| curve(name, &motion[k], Role::Computed));
            match self.recorded[k] {
                true => exact.chain(computed).collect(),
                false => Vec::new(),
            }
        };
        let force = self.traces.force.columns();
        let exact_force = reference.map(|reference| force_curve(&reference.solution, end));
        let mut force_curves = Vec::new();
        if self.contact.is_some() {
            force_curves.extend(exact_force.iter().map(|c| curve("exact", c, Role::Exact)));
            force_curves.push(curve("computed", &force, Role::Computed));
        }
        let curves = ContactCurves {
            displacement: curves(0),
            velocity: curves(1),
            force: force_curves,
            acceleration: curves(2),
        };
        along(contact_figure(&self.title, curves), abscissa).svg()
    }

    fn energy_svg(&self, abscissa: Option<Axis>) -> Result<String, carom_pages::Error> {
        let columns = [
            &self.traces.kinetic,
            &self.traces.strain,
            &self.traces.total,
            &self.traces.dissipated,
            &self.traces.residual,
        ]
        .map(Trace::columns);
        let names = ["kinetic", "strain", "total", "dissipated", "residual"];
        let at = |k: usize| curve(names[k], &columns[k], Role::Computed);
        let further = self.traces.further.each_ref().map(Trace::columns);
        let there =
            |(_, (_, values)): &(&&'static str, &Polyline)| values.iter().any(|v| *v != 0.0);
        let further = FURTHER.iter().zip(&further).filter(there);
        let further = further.map(|(name, line)| curve(name, line, Role::Computed));
        let balanced = self.traces.balanced.columns();
        let own = (balanced != columns[2]).then(|| curve("balanced", &balanced, Role::Computed));
        let figure: Figure = energy_figure(
            "Energy balance",
            EnergyCurves {
                energies: (0..4).map(at).chain(own).chain(further).collect(),
                residual: vec![at(4)],
            },
        );
        along(figure, abscissa).svg()
    }
}

/// The figure over another abscissa, if there is one.
fn along(figure: Figure<'_>, abscissa: Option<Axis>) -> Figure<'_> {
    Figure {
        abscissa: abscissa.unwrap_or(figure.abscissa),
        ..figure
    }
}

fn curve<'a>(name: &'a str, (x, y): &'a Polyline, role: Role) -> Curve<'a> {
    Curve { name, x, y, role }
}

/// The name of an axis of coordinates, or the components of another one.
fn direction(axis: [f64; 3]) -> String {
    let along = |i: usize| (axis[i] - 1.0).abs() < 1e-9;
    match (0..3).find(|i| along(*i)) {
        Some(i) => COMPONENTS[i].to_owned(),
        None => format!("({:.3}, {:.3}, {:.3})", axis[0], axis[1], axis[2]),
    }
}
