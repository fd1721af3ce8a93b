//! What makes an overlap unfit for coupling.

use carom_mesh::{Defect, ElementId};

/// One of the two models that overlap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// The finer model of the impact zone.
    Inner,
    /// The coarser model of the rest.
    Outer,
}

impl std::fmt::Display for Model {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Model::Inner => "inner",
            Model::Outer => "outer",
        })
    }
}

/// Failure to couple two models. Node numbers count from 0 in the mesh; lengths are in its unit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A model has no cells.
    #[error("the {model} model has no cells")]
    NoCells {
        /// The model.
        model: Model,
    },
    /// A cell does not have the dimension of the space.
    #[error(
        "a cell of dimension {found} in the {model} model: overlapping models need cells of dimension {expected}, \
         that of the mesh"
    )]
    Dimension {
        /// Its model.
        model: Model,
        /// The first such cell.
        cell: ElementId,
        /// Its dimension.
        found: usize,
        /// The dimension of the mesh.
        expected: usize,
    },
    /// A kind of cell whose common parts with others are not known how to cut.
    #[error(
        "{kind} cells in the {model} model: overlapping models take bar2, tri3, quad4, tet4 and hex8 cells"
    )]
    Kind {
        /// Its model.
        model: Model,
        /// The first such cell.
        cell: ElementId,
        /// Name of its kind.
        kind: &'static str,
    },
    /// A cell is not fit for computation.
    #[error("a cell of the overlapping models is {0}")]
    Defect(Defect),
    /// A node belongs to both models.
    #[error("node {node} belongs to both models: overlapping models have meshes of their own")]
    SharedNode {
        /// The node.
        node: u32,
    },
    /// The models have no volume in common in the region.
    #[error(
        "the overlap is empty: the two models have no volume in common in the region given for it"
    )]
    Empty,
    /// Cells of the group given for the overlap are not covered by the other model.
    #[error(
        "{} cells of the group given for the overlap are not covered by the other model (the least covered to {:.0} %)",
        cells.len(), 100.0 * least
    )]
    NotCovered {
        /// The cells.
        cells: Vec<ElementId>,
        /// Least fraction of their measure that the other model covers.
        least: f64,
    },
    /// The inner model ends inside the outer one at a place outside the overlap: nothing would hold its border.
    #[error(
        "the inner model ends inside the outer model, but outside the overlap, at {} cells: let the overlap \
         reach the end of the inner model",
        cells.len()
    )]
    EndsOutside {
        /// Cells of the inner model at that border.
        cells: Vec<ElementId>,
    },
    /// The overlap is thinner than one cell of the outer model.
    #[error(
        "the overlap is {layers:.2} cells of the outer model thick at its thinnest: it must hold one at least, \
         better two to four"
    )]
    Thin {
        /// Least thickness, in cells of the outer model.
        layers: f64,
        /// Cells of the outer model where it is below one.
        cells: Vec<ElementId>,
    },
    /// The axis of a beam bends or branches in the solid.
    #[error(
        "the axis of the beam is not straight in the solid that it overlaps with: {} cells meet at an angle",
        cells.len()
    )]
    Bent {
        /// Cells of the beam that meet there.
        cells: Vec<ElementId>,
    },
    /// A solid ends along a beam at a place outside the overlap.
    #[error("the solid ends along the beam, but outside the overlap: nothing would hold its end")]
    SolidEndsOutside {
        /// Cells of the beam there.
        cells: Vec<ElementId>,
    },
    /// The overlap of a beam and a solid is shorter than one cell.
    #[error(
        "the overlap is {layers:.2} cells of the coarser model long: it must hold one at least, better two to four"
    )]
    Short {
        /// Length over the larger of both sizes along the axis.
        layers: f64,
        /// Cells of the beam there.
        cells: Vec<ElementId>,
    },
    /// The section of a beam is not that of the solid around its axis.
    #[error(
        "in the overlap the {what} of the solid around the axis of the beam is {found:.4e} {unit}, that of the section of the beam \
         {expected:.4e} {unit}: the section must lie in the solid and fill it"
    )]
    Section {
        /// The quantity.
        what: &'static str,
        /// Its unit.
        unit: &'static str,
        /// Its value in the solid.
        found: f64,
        /// That of the section of the beam.
        expected: f64,
        /// Cells of the solid there.
        cells: Vec<ElementId>,
    },
    /// Of a beam and a solid one does not end in the overlap.
    #[error(
        "the {model} model does not end in the overlap: a beam and a solid continue each other, so each must end there"
    )]
    NoEnd {
        /// The model without an end there.
        model: Model,
    },
    /// A weight that varies needs a border of the overlap where each model ends.
    #[error(
        "the {model} model does not end in the overlap: a weight that goes from one border to the other needs \
         both (a constant weight does not)"
    )]
    NoBorder {
        /// The model without an end there.
        model: Model,
    },
    /// A number out of its range.
    #[error("{what} is {value}, which is not between {from} and {to}")]
    Range {
        /// What is out of range.
        what: &'static str,
        /// Its value.
        value: f64,
        /// Least value allowed.
        from: f64,
        /// Largest value allowed.
        to: f64,
    },
    /// Nearly all of the weight on the outer model: waves are reflected at the overlap.
    #[error(
        "a constant weight of {inner} for the inner model puts nearly all on the outer one, which reflects most of a \
         wave: give the inner model 0.05 at least"
    )]
    Reflects {
        /// The weight of the inner model.
        inner: f64,
    },
    /// No mediator function is left.
    #[error("the mediator has no function left in the overlap")]
    NoMediator,
    /// A cell cannot be inverted at a point that lies in it.
    #[error("the reference coordinates of a point of a distorted cell could not be found")]
    InverseMap {
        /// The cell.
        cell: ElementId,
    },
    /// Two zones have no coincident nodes.
    #[error("the two zones have no coincident nodes (tolerance {tolerance:e})")]
    NoInterface {
        /// Largest distance of coincident nodes.
        tolerance: f64,
    },
    /// A node of one zone coincides with several of the other, or two with one.
    #[error("node {node} coincides with more than one node of the other zone")]
    Ambiguous {
        /// The node.
        node: u32,
    },
    /// Faces without a mean rotation.
    #[error("the faces lie on one line through node {node}: they have no rotation about it")]
    FacesOnLine {
        /// The node that would have their motion.
        node: u32,
    },
    /// Failure of the factorisation that measures the rank.
    #[error(transparent)]
    Algebra(#[from] carom_algebra::Error),
}
