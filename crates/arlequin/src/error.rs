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
    /// A solid ends along a beam or a shell at a place outside the overlap.
    #[error(
        "the solid ends along the thin model, but outside the overlap: nothing would hold its end"
    )]
    SolidEndsOutside {
        /// Cells of either there.
        cells: Vec<ElementId>,
    },
    /// The overlap of a beam or shell and a solid is shorter than one cell.
    #[error(
        "the overlap is {layers:.2} cells of the coarser model long: it must hold one at least, better two to four"
    )]
    Short {
        /// Length over the larger of both sizes along the axis or the middle surface.
        layers: f64,
        /// Cells of the beam or shell there.
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
    /// The solid is not from one face of a shell to the other.
    #[error(
        "in the overlap the solid lies from {:.4e} m to {:.4e} m about the middle surface of the shell, the section of the shell from \
         {:.4e} m to {:.4e} m: both must be the same",
        found[0], found[1], -expected, expected
    )]
    Thickness {
        /// Where its faces are along the director, m; no numbers where it is not found.
        found: [f64; 2],
        /// Half the thickness of the shell, m.
        expected: f64,
        /// Cells of the shell there.
        cells: Vec<ElementId>,
    },
    /// Elements of a shell meet at an angle in the overlap, or with opposite normals.
    #[error("the shell has a fold in the overlap: its middle surface must be smooth there")]
    Fold {
        /// Cells of the shell that meet there.
        cells: Vec<ElementId>,
    },
    /// An element of a shell that is too thick for its curvature.
    #[error(
        "an element of the shell folds over within its thickness: it is too thick for its curvature, or warped"
    )]
    FoldsOver {
        /// The cell.
        cell: ElementId,
    },
    /// Of a beam or shell and a solid one does not end in the overlap.
    #[error(
        "the {model} model does not end in the overlap: a thin model and a solid continue each other, so each must end there"
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
    /// Faces that are no section of the shell whose edge stands on them.
    #[error(
        "the faces are {height:.4e} m high along the edge and their middle is {:.0} % of that beside it; the shell is {thickness:.4e} m thick",
        100.0 * (beside / height).abs()
    )]
    FaceOfEdge {
        /// Area of the faces over the length of the edge, m.
        height: f64,
        /// Distance of their middle from the edge along the director, m.
        beside: f64,
        /// Thickness of the shell, m.
        thickness: f64,
    },
    /// A node of an edge of a shell with no face beside it.
    #[error(
        "node {node} of the edge has no face beside it: the faces must reach along all of the edge"
    )]
    EdgeWithoutFace {
        /// The node.
        node: u32,
    },
    /// Failure of the factorisation that measures the rank.
    #[error(transparent)]
    Algebra(#[from] carom_algebra::Error),
}
