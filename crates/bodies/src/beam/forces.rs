//! Forces and moments in the sections of beams.

/// Forces and moments in the sections of an element, on the side from which its axis points outward, in the axes of the section.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SectionForces {
    /// Normal force, positive in tension, and shear forces along y and z, N.
    pub force: [f64; 3],
    /// Torque and bending moments about y and z at the first node, N m.
    pub moment_first: [f64; 3],
    /// The same at the second node.
    pub moment_second: [f64; 3],
}
