//! Fields of beams: rotations of nodes, forces and moments in sections.

use carom_dynamics::{Motion, System};

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
