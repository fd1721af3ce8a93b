//! What can be wrong with a mesh that was read or generated without fault.

use carom_elements::Kind;

use crate::ElementId;

/// Failure of an operation on a mesh. Node numbers count from 0 in the mesh; points are in the unit of its
/// coordinates.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// Two merged meshes define a group of the same name.
    #[error("mesh `{mesh}` has a group `{group}`, and so has a mesh before it")]
    GroupClash {
        /// Name of the mesh that came second.
        mesh: String,
        /// The name both use.
        group: String,
    },
    /// The facets of a surface do not have one dimension less than the cells of the body.
    #[error(
        "a surface of elements of dimension {facets} cannot bound cells of dimension {cells}: \
         the facets must have one dimension less"
    )]
    FacetDimension {
        /// Dimension of the facets.
        facets: usize,
        /// Dimension of the first cell that does not fit.
        cells: usize,
    },
    /// Plane cells in a mesh of three dimensions: their edges have no outward normal.
    #[error("plane cells in a mesh of three dimensions have no outward normal along their edges")]
    PlaneCellsInSpace {
        /// The first such cell.
        cell: ElementId,
    },
    /// Two facets of a surface without cells run along their common edge in the same sense.
    #[error(
        "two facets that share node {node} have normals to different sides: the order of their nodes disagrees"
    )]
    FacetsDisagree {
        /// The facets.
        facets: [ElementId; 2],
        /// A node that both have.
        node: u32,
    },
    /// A facet is a face of none of the cells.
    #[error("the facet at {centre:?} is not a face of any cell of the body")]
    FacetOnNoCell {
        /// Nodes of the facet.
        nodes: Vec<u32>,
        /// Mean of its nodes.
        centre: [f64; 3],
    },
    /// A facet lies between two of the cells: it is inside the body, not on its surface.
    #[error("the facet at {centre:?} lies between two cells of the body, not on its surface")]
    FacetOnTwoCells {
        /// Nodes of the facet.
        nodes: Vec<u32>,
        /// Mean of its nodes.
        centre: [f64; 3],
        /// The two cells.
        cells: [ElementId; 2],
    },
    /// An element for which there is no quadratic kind.
    #[error("there is no quadratic element on the corners of {}", kind.table().name)]
    NoQuadratic {
        /// Its kind.
        kind: Kind,
    },
    /// An element that is not cut into smaller ones.
    #[error(
        "{} is not cut into smaller elements, only bar2, tri3, quad4, tet4 and hex8 are",
        kind.table().name
    )]
    NoRefinement {
        /// Its kind.
        kind: Kind,
    },
    /// Two facets of a surface have the same nodes.
    #[error("the facet at {centre:?} is in the surface twice")]
    FacetTwice {
        /// Nodes of the facet.
        nodes: Vec<u32>,
        /// Mean of its nodes.
        centre: [f64; 3],
    },
}
