//! Fields of beams: rotations of nodes, forces, moments and stresses in sections.

use carom_bodies::SectionStress;
use carom_dynamics::{Motion, System};

use crate::vtu::{Field, Values};

/// Small rotations of the nodes, rad; zero where a node has none.
pub(crate) fn rotations(system: &System, u: &[f64]) -> Vec<[f64; 3]> {
    let unknowns = &system.unknowns;
    let of = |node: u32| match unknowns.frame(node) {
        None => unknowns.spin(node, u),
        Some(_) => [0.0; 3],
    };
    (0..system.x.len() as u32).map(of).collect()
}

/// Names of the fields of [`section_forces`].
pub(crate) const SECTION_FORCES: [&str; 3] = [
    "section_force",
    "section_moment_first",
    "section_moment_second",
];

/// Force (N), and moments at the first and at the second node (N m), of each cell in the axes of its section; zero in other bodies
/// than beams.
pub(crate) fn section_forces(system: &System, motion: &Motion) -> [Vec<[f64; 3]>; 3] {
    let mut fields = [Vec::new(), Vec::new(), Vec::new()];
    for (k, body) in system.bodies.iter().enumerate() {
        let history = system.history(k, &motion.history);
        match body.section_forces(&motion.u, &motion.frames, history) {
            Some(forces) => {
                for own in forces {
                    fields[0].push(own.force);
                    fields[1].push(own.moment_first);
                    fields[2].push(own.moment_second);
                }
            }
            None => {
                for field in &mut fields {
                    field.resize(field.len() + body.cells().len(), [0.0; 3]);
                }
            }
        }
    }
    fields
}

/// The largest stresses in the sections of beams, over all cells; none in other cells.
pub(crate) struct SectionStresses {
    of_cells: Vec<Option<SectionStress>>,
    /// Largest and smallest normal stress and largest shear stress, Pa.
    shown: Vec<[f64; 3]>,
}

impl SectionStresses {
    /// `None` without beams.
    pub(crate) fn new(system: &System, motion: &Motion) -> Option<SectionStresses> {
        let mut of_cells = Vec::new();
        for (k, body) in system.bodies.iter().enumerate() {
            let history = system.history(k, &motion.history);
            let to = of_cells.len() + body.cells().len();
            if let Some(own) = body.section_stresses(&motion.u, &motion.frames, history) {
                of_cells.extend(own.into_iter().map(Some));
            }
            of_cells.resize(to, None);
        }
        let shown = |stress: &Option<SectionStress>| {
            stress.map_or([0.0; 3], |SectionStress { normal, shear, .. }| {
                [normal[0], normal[1], shear]
            })
        };
        let any = of_cells.iter().any(Option::is_some);
        any.then(|| SectionStresses {
            shown: of_cells.iter().map(shown).collect(),
            of_cells,
        })
    }

    /// Of each cell.
    pub(crate) fn of_cells(&self) -> &[Option<SectionStress>] {
        &self.of_cells
    }

    pub(crate) fn field(&self) -> Field<'_> {
        Field {
            name: "section_stress",
            values: Values::Vector(&self.shown),
        }
    }
}
