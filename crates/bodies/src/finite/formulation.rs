//! How the elements of a body integrate the internal work.

/// How the elements of a body integrate the internal work.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Formulation {
    /// All points of the stiffness rule.
    #[default]
    Full,
    /// Mean dilatation, against volumetric locking: the volume ratio of an element is that of the whole element.
    BBar,
    /// One point, and a stiffness against the hourglass modes that it does not see: 4-node quadrilaterals and 8-node
    /// hexahedra.
    Reduced {
        /// Factor of the hourglass stiffness, without unit; 0.05 to 0.1 as a rule.
        hourglass: f64,
    },
}
