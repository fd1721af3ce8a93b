//! What a body can refuse, and how it fails.

use carom_materials::Failure;
use carom_mesh::ElementId;
use thiserror::Error as ThisError;

/// Why a body could not be built, or has no force.
#[derive(Debug, ThisError)]
pub enum Error {
    /// The body has no element.
    #[error("body '{body}' has no element")]
    Empty {
        /// Name of the body.
        body: String,
    },
    /// Cells that are no discrete elements of the kind asked for.
    #[error(
        "body '{body}': {found} elements among its discrete elements: masses are points, springs and dashpots points or lines of two nodes, all alike"
    )]
    NotDiscrete {
        /// Name of the body.
        body: String,
        /// Name of the element kind found.
        found: &'static str,
    },
    /// Moments of inertia of a point mass at a node without rotations.
    #[error(
        "point mass '{body}': its moments of inertia need a node with rotations: the node of a beam"
    )]
    NoRotation {
        /// Name of the point mass.
        body: String,
    },
    /// Elements of another dimension than the kinematics asks for.
    #[error(
        "body '{body}': {found} elements cannot be {kinematics}, which takes elements of dimension {dim}"
    )]
    WrongElement {
        /// Name of the body.
        body: String,
        /// Name of the element kind found.
        found: &'static str,
        /// Name of the kinematics.
        kinematics: &'static str,
        /// Dimension of the elements that it takes.
        dim: usize,
    },
    /// Lines of three nodes as bars.
    #[error("body '{body}': bars are bar2 elements, bar3 elements are the edges of plane cells")]
    QuadraticBar {
        /// Name of the body.
        body: String,
    },
    /// Beams in a mesh of one dimension.
    #[error("body '{body}': beams bend in a plane or in space; a mesh on a line has bars only")]
    BeamOnLine {
        /// Name of the body.
        body: String,
    },
    /// A beam element that its releases leave without stiffness.
    #[error("body '{body}': the hinges of element {} make a mechanism of it", cell.index)]
    Mechanism {
        /// Name of the body.
        body: String,
        /// The element.
        cell: ElementId,
    },
    /// Beams with finite rotations that have what only linear ones have.
    #[error("body '{body}': beams with finite rotations do not have {what}")]
    LargeBeam {
        /// Name of the body.
        body: String,
        /// What it is.
        what: &'static str,
    },
    /// Beams of metal that flows in a section of which only properties are known.
    #[error(
        "body '{body}': a section that flows is divided into fibres, for which its shape is needed: circle, tube, rectangle or i"
    )]
    NoShape {
        /// Name of the body.
        body: String,
    },
    /// A cell of beams that cannot be tightened.
    #[error("body '{body}': element {} cannot be tightened, since {why}", cell.index)]
    Tightened {
        /// Name of the body.
        body: String,
        /// The cell.
        cell: ElementId,
        /// Why.
        why: &'static str,
    },
    /// Beams of metal that flows with hinges.
    #[error(
        "body '{body}': hinges are those of elastic elements, and this material flows; take a body of its own for the elastic end"
    )]
    FlowingHinges {
        /// Name of the body.
        body: String,
    },
    /// A beam element that has no axes.
    #[error("body '{body}': element {} {why}", cell.index)]
    BeamAxes {
        /// Name of the body.
        body: String,
        /// The cell.
        cell: ElementId,
        /// What is wrong with it.
        why: &'static str,
    },
    /// Beams of metal that share their volume with another model.
    #[error("body '{body}': beams of metal that flows cannot be glued to another model in volume")]
    BeamWeights {
        /// Name of the body.
        body: String,
    },
    /// A cell that no shell can be on.
    #[error("body '{body}': cell {} about ({:.6}, {:.6}, {:.6}) m {why}", cell.index, centre[0], centre[1], centre[2])]
    ShellCell {
        /// Name of the body.
        body: String,
        /// The cell.
        cell: ElementId,
        /// Mean place of its nodes, m.
        centre: [f64; 3],
        /// What is wrong with it.
        why: &'static str,
    },
    /// What shells do not have.
    #[error("body '{body}': shells do not have {what}")]
    ShellRefused {
        /// Name of the body.
        body: String,
        /// What it is.
        what: &'static str,
    },
    /// Kinematics without solid cells.
    #[error("body '{body}': {kinematics} elements are no cells of a solid or a rigid body")]
    NotSolid {
        /// Name of the body.
        body: String,
        /// Name of the kinematics.
        kinematics: &'static str,
    },
    /// An axisymmetric model lies partly at negative radius.
    #[error(
        "body '{body}': node {node} has the radius {radius:e} m, negative in an axisymmetric model"
    )]
    NegativeRadius {
        /// Name of the body.
        body: String,
        /// Number of the node in the mesh, from 0.
        node: u32,
        /// Its first coordinate in m.
        radius: f64,
    },
    /// Weights that do not fit the cells.
    #[error("body '{body}': {found} weights of {quantity} for cells with {expected} nodes in all")]
    WeightCount {
        /// Name of the body.
        body: String,
        /// Which weights: inertia or stiffness.
        quantity: &'static str,
        /// Values given.
        found: usize,
        /// Sum of the numbers of nodes of the cells.
        expected: usize,
    },
    /// Weights of inertia that give a negative row sum of the mass of an element, or none that is a number.
    #[error(
        "body '{body}': the weights of inertia of a cell give its node {node} the mass {mass:e} kg, which must not be negative"
    )]
    NegativeMass {
        /// Name of the body.
        body: String,
        /// The cell.
        cell: ElementId,
        /// Number of the node in the mesh, from 0.
        node: u32,
        /// Row sum ∫ ρ α N_a dV in kg.
        mass: f64,
    },
    /// A weight of stiffness that is negative at an integration point, or no number.
    #[error(
        "body '{body}': the weight of stiffness is {weight:e} at an integration point, which must not be negative"
    )]
    NegativeStiffness {
        /// Name of the body.
        body: String,
        /// The cell.
        cell: ElementId,
        /// δ at the point.
        weight: f64,
    },
    /// Finite strain where a stress outside the model's dimensions would have to vanish.
    #[error(
        "body '{body}': a law at finite strain cannot be {kinematics}; take plane-strain, axisymmetric or solid{}",
        one_stress(kinematics)
    )]
    FiniteKinematics {
        /// Name of the body.
        body: String,
        /// Name of the kinematics.
        kinematics: &'static str,
    },
    /// A formulation that asks for a law at finite strain.
    #[error(
        "body '{body}': at small strain elements are fully integrated; mean dilatation and reduced integration need a law at finite strain"
    )]
    LinearFormulation {
        /// Name of the body.
        body: String,
    },
    /// Reduced integration of elements whose hourglass modes are not controlled.
    #[error("body '{body}': {found} elements have no reduced integration; quad4 and hex8 have")]
    NotReduced {
        /// Name of the body.
        body: String,
        /// Name of the element kind found.
        found: &'static str,
    },
    /// A law that gives no stress at an integration point.
    #[error(
        "body '{body}': cell {} of block {}, whose middle was at ({:.4e}, {:.4e}, {:.4e}) m, integration point {point}: {failure}",
        cell.index, cell.block, middle[0], middle[1], middle[2]
    )]
    NoStress {
        /// Name of the body.
        body: String,
        /// The cell.
        cell: ElementId,
        /// Its middle in the mesh, m.
        middle: [f64; 3],
        /// Number of the point in the rule of the cell, from 0.
        point: usize,
        /// Why.
        failure: Failure,
    },
    /// An algorithmic stress between two displacements where there is none.
    #[error(
        "body '{body}': there is no stress between two displacements that conserves energy for this law; it needs a hyperelastic one"
    )]
    NoBetween {
        /// Name of the body.
        body: String,
    },
}

/// What else goes with one stress along an axis.
fn one_stress(kinematics: &str) -> &'static str {
    match kinematics {
        "bar" | "beam" => ", or elastic, j2, j2-table or johnson-cook for the material",
        _ => "",
    }
}

impl Error {
    /// Name of the body.
    pub fn body(&self) -> &str {
        match self {
            Error::Empty { body }
            | Error::NotDiscrete { body, .. }
            | Error::NoRotation { body }
            | Error::WrongElement { body, .. }
            | Error::QuadraticBar { body, .. }
            | Error::BeamOnLine { body }
            | Error::BeamAxes { body, .. }
            | Error::Mechanism { body, .. }
            | Error::LargeBeam { body, .. }
            | Error::NoShape { body }
            | Error::Tightened { body, .. }
            | Error::FlowingHinges { body }
            | Error::BeamWeights { body }
            | Error::ShellCell { body, .. }
            | Error::ShellRefused { body, .. }
            | Error::NotSolid { body, .. }
            | Error::NegativeRadius { body, .. }
            | Error::WeightCount { body, .. }
            | Error::NegativeMass { body, .. }
            | Error::NegativeStiffness { body, .. }
            | Error::FiniteKinematics { body, .. }
            | Error::LinearFormulation { body }
            | Error::NotReduced { body, .. }
            | Error::NoStress { body, .. }
            | Error::NoBetween { body } => body,
        }
    }
}
