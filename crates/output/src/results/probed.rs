//! What probes tell of cells: stresses, and forces and moments in sections.

use carom_bodies::{Body, Resultants};
use carom_dynamics::{State, System};

use crate::history::column;
use crate::results::Probe;
use crate::results::cells::{in_order, von_mises};
use crate::rows::Cell;

/// Components of a symmetric tensor in the order of fields.
const TENSOR: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

/// Body of a cell and its place there.
type At = [usize; 2];

/// The cells of a probe.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cells {
    /// Cell whose stress is told.
    stress: Option<At>,
    /// Cell in whose section forces are told, and the end of a beam.
    section: Option<(At, usize)>,
}

impl Cells {
    pub(super) fn new(system: &System, probe: &Probe) -> Cells {
        let find = |cell| {
            let mut bodies = system.bodies.iter().enumerate();
            bodies.find_map(|(k, body)| {
                let place = body.cells().iter().position(|own| *own == cell)?;
                Some([k, place])
            })
        };
        let section = probe
            .section
            .and_then(|(cell, end)| Some((find(cell)?, end)));
        Cells {
            stress: probe.cell.and_then(find),
            section,
        }
    }

    /// Names of the columns.
    pub(super) fn columns(&self, system: &System, probe: &Probe) -> Vec<String> {
        let of = |what: &str, unit| column(&["probe", &probe.name, what], unit);
        let stress = probe.cell.iter().flat_map(|_| stresses(system));
        let mut names: Vec<String> = stress
            .map(|what| of(&format!("stress {what}"), "Pa"))
            .collect();
        let section = self.section.iter();
        let section = section.flat_map(|(at, _)| sections(system, *at));
        names.extend(section.map(|(what, unit)| of(&what, unit)));
        names
    }

    /// Adds the values to a row.
    pub(super) fn push(
        &self,
        (system, probe): (&System, &Probe),
        state: &State,
        row: &mut Vec<Cell>,
    ) {
        if probe.cell.is_some() {
            row.extend(stress(system, self.stress, state));
        }
        if let Some((at, end)) = self.section {
            let forces = forces(system, (at, end), state).into_iter();
            row.extend(forces.map(Cell::Number));
        }
    }
}

/// What is written of a stress, by the dimension.
fn stresses(system: &System) -> &'static [&'static str] {
    match system.dim {
        1 => &["xx", "von mises"],
        2 => &["xx", "yy", "zz", "xy", "von mises"],
        _ => &["xx", "yy", "zz", "xy", "yz", "xz", "von mises"],
    }
}

/// Mean stress of a cell and its equivalent, of shells and beams the largest, in the order of [`stresses`].
fn stress(system: &System, at: Option<At>, state: &State) -> Vec<Cell<'static>> {
    let found = at.and_then(|[k, place]| {
        let (motion, body) = (&state.motion, &system.bodies[k]);
        let history = system.history(k, &motion.history);
        let (_, stress) = body.stress(place, &motion.u, history)?;
        let stress = in_order(&stress);
        let mean = von_mises(&stress);
        let most = match body {
            Body::Shell(shell) => {
                let all = shell.resultants(&motion.frames, &motion.u, history);
                mean.max(largest(&all[place]))
            }
            _ => {
                let all = body.section_stresses(&motion.u, &motion.frames, history);
                all.map_or(mean, |all| all[place].von_mises)
            }
        };
        Some((stress, most))
    });
    let of = |name: &str| {
        let (tensor, most) = found.as_ref()?;
        let place = TENSOR.iter().position(|component| *component == name);
        // the stress of a section whose extreme fibres are not known is no number
        Some(place.map_or(*most, |place| tensor[place])).filter(|value| !value.is_nan())
    };
    let cells = stresses(system).iter().map(|name| Cell::from(of(name)));
    cells.collect()
}

/// The largest equivalent stress at the faces of a shell and between them, Pa.
fn largest(of: &Resultants) -> f64 {
    let faces = of.faces.iter().map(|face| von_mises(&in_order(face)));
    faces.fold(of.between, f64::max)
}

/// Names and units of forces and moments in the section of a cell.
fn sections(system: &System, [k, _]: At) -> Vec<(String, &'static str)> {
    let tensor = |what: &str, unit| TENSOR.map(|i| (format!("{what} {i}"), unit));
    let vector = |what: &str, unit| ["x", "y", "z"].map(|i| (format!("{what} {i}"), unit));
    let (force, moment) = (
        vector("section force", "N"),
        vector("section moment", "N m"),
    );
    match (&system.bodies[k], system.dim) {
        (Body::Shell(_), _) => {
            let mut names = tensor("membrane force", "N/m").to_vec();
            names.extend(tensor("bending moment", "N"));
            names.extend(vector("shear force", "N/m"));
            names
        }
        (_, 2) => [&force[..2], &moment[2..]].concat(),
        _ => [force, moment].concat(),
    }
}

/// Forces and moments in the order of [`sections`]; nothing known is no number.
fn forces(system: &System, ([k, place], end): (At, usize), state: &State) -> Vec<f64> {
    let (motion, body) = (&state.motion, &system.bodies[k]);
    let history = system.history(k, &motion.history);
    if let Body::Shell(shell) = body {
        let of = shell.resultants(&motion.frames, &motion.u, history)[place];
        let mut values = in_order(&of.membrane).to_vec();
        values.extend(in_order(&of.bending));
        values.extend(of.shear);
        return values;
    }
    let all = body.section_forces(&motion.u, &motion.frames, history);
    let own = all.map(|all| all[place]).unwrap_or_default();
    let moment = [own.moment_first, own.moment_second][end];
    match system.dim {
        2 => [&own.force[..2], &moment[2..]].concat(),
        _ => [own.force, moment].concat(),
    }
}
