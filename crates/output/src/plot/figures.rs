//! The figures of every run: what happens at the contact point, and where the energy goes.

use super::{Axis, Curve, Figure, Panel, Role};

const TIME: Axis = Axis {
    quantity: "time",
    unit: "s",
};

/// The curves of the contact figure, SI: computed and exact ones together.
#[derive(Clone, Debug, Default)]
pub struct ContactCurves<'a> {
    /// Displacement of the contact points along the normal, m.
    pub displacement: Vec<Curve<'a>>,
    /// Velocity of the contact points along the normal, m/s.
    pub velocity: Vec<Curve<'a>>,
    /// Contact force, N, positive in compression.
    pub force: Vec<Curve<'a>>,
    /// Acceleration of the contact points along the normal, m/s².
    pub acceleration: Vec<Curve<'a>>,
}

/// Four panels: displacement, velocity, contact force and acceleration at the contact point against time; the
/// acceleration is clipped to percentiles where the impact makes it a spike. A panel without curves is left out.
pub fn contact_figure<'a>(title: &str, curves: ContactCurves<'a>) -> Figure<'a> {
    let panel = |title: &str, quantity, unit, curves, clip| Panel {
        title: title.to_owned(),
        ordinate: Axis { quantity, unit },
        curves,
        clip,
    };
    let mut panels = vec![
        panel(
            "Displacement",
            "displacement",
            "m",
            curves.displacement,
            false,
        ),
        panel("Velocity", "velocity", "m/s", curves.velocity, false),
        panel("Contact force", "force", "N", curves.force, false),
        panel(
            "Acceleration",
            "acceleration",
            "m/s²",
            curves.acceleration,
            true,
        ),
    ];
    panels.retain(|panel| !panel.curves.is_empty());
    Figure {
        title: title.to_owned(),
        abscissa: TIME,
        panels,
        columns: 2,
    }
}

/// Histories of energy, J, all of the same length.
#[derive(Clone, Copy, Debug)]
pub struct EnergyCurves<'a> {
    /// Instants, s.
    pub time: &'a [f64],
    /// Kinetic energy.
    pub kinetic: &'a [f64],
    /// Strain energy.
    pub strain: &'a [f64],
    /// Kinetic plus strain energy.
    pub total: &'a [f64],
    /// Energy dissipated since the start, positive when lost.
    pub dissipated: &'a [f64],
}

/// One panel with the energies against time.
pub fn energy_figure<'a>(title: &str, energy: EnergyCurves<'a>) -> Figure<'a> {
    let curve = |name, y| Curve {
        name,
        x: energy.time,
        y,
        role: Role::Computed,
    };
    let panel = Panel {
        title: "Energy".to_owned(),
        ordinate: Axis {
            quantity: "energy",
            unit: "J",
        },
        curves: vec![
            curve("kinetic", energy.kinetic),
            curve("strain", energy.strain),
            curve("total", energy.total),
            curve("dissipated", energy.dissipated),
        ],
        clip: false,
    };
    Figure {
        title: title.to_owned(),
        abscissa: TIME,
        panels: vec![panel],
        columns: 1,
    }
}
