//! The figures of every run: what happens at the contact point, and where the energy goes.

use super::{Axis, Curve, Figure, Panel};

const TIME: Axis = Axis {
    quantity: "time",
    unit: "s",
};

/// The abscissa of a static run, in which it only says what loads and motions are.
pub const PSEUDO_TIME: Axis = Axis {
    quantity: "pseudo-time of the loads",
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

/// Curves of energy, J.
#[derive(Clone, Debug, Default)]
pub struct EnergyCurves<'a> {
    /// Kinetic, strain, total and dissipated energy.
    pub energies: Vec<Curve<'a>>,
    /// What the balance leaves over.
    pub residual: Vec<Curve<'a>>,
}

/// Two panels: the energies and the residual of their balance against time. A panel without curves is left out.
pub fn energy_figure<'a>(title: &str, energy: EnergyCurves<'a>) -> Figure<'a> {
    let panel = |title: &str, curves| Panel {
        title: title.to_owned(),
        ordinate: Axis {
            quantity: "energy",
            unit: "J",
        },
        curves,
        clip: false,
    };
    let mut panels = vec![
        panel("Energy", energy.energies),
        panel("Residual of the balance", energy.residual),
    ];
    panels.retain(|panel| !panel.curves.is_empty());
    Figure {
        title: title.to_owned(),
        abscissa: TIME,
        panels,
        columns: 2,
    }
}
