//! Where a surface ends, and where it turns sharply: edges of faces that no other face of it has, and ridges.

use carom_elements::Kind;

/// Distance from an edge in reference units within which a foot on the boundary of a face lies on that edge: rounding of the foot.
const ON: f64 = 1e-9;

/// Which edges and corners of a face are at the rim of the surface that it belongs to, and which on sharp ridges of it; none where nobody has
/// looked ([`Rim::mark`]).
///
/// A foot at the rim is as close as the surface comes: whatever is beyond it is beside the surface. So is what is above a face and beyond a
/// sharp ridge. On another edge the surface goes on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rim {
    pub(crate) border: Marks,
    pub(crate) ridge: Marks,
    /// Bits of the corners at which the rim turns.
    pub(crate) turns: u8,
}

/// Some edges and corners of a face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Marks {
    /// Bits of the edges, in the order of the faces of the element; of a line its ends.
    pub(crate) edges: u8,
    /// Bits of the corners, in the order of its nodes.
    pub(crate) corners: u8,
}

impl Rim {
    /// Whether a foot on the boundary of a face of this kind, at ξ in the reference cell, is at the rim.
    pub fn holds(self, kind: Kind, xi: &[f64; 3]) -> bool {
        self.border.hold(kind, xi)
    }

    /// The edge of the rim on which it is, between whose ends and beyond the surface ends in one direction alone: none where the rim turns, and
    /// at a corner of the face that the rim only passes.
    pub fn edge(self, kind: Kind, xi: &[f64; 3]) -> Option<usize> {
        if kind.table().dim < 2
            || (0..edges(kind)).any(|k| has(self.turns, k) && is_at(kind, k, xi))
        {
            return None;
        }
        (0..edges(kind)).find(|k| has(self.border.edges, *k) && is_on(kind, *k, xi))
    }

    /// Whether it is on a sharp ridge.
    pub fn is_ridge(self, kind: Kind, xi: &[f64; 3]) -> bool {
        self.ridge.hold(kind, xi)
    }
}

impl Marks {
    fn hold(self, kind: Kind, xi: &[f64; 3]) -> bool {
        (0..edges(kind)).any(|k| {
            has(self.edges, k) && is_on(kind, k, xi) || has(self.corners, k) && is_at(kind, k, xi)
        })
    }
}

fn has(bits: u8, k: usize) -> bool {
    bits >> k & 1 == 1
}

/// Whether a foot on the boundary of a face of this kind lies on an edge of it.
pub fn is_on(kind: Kind, edge: usize, xi: &[f64; 3]) -> bool {
    let table = kind.table();
    if table.dim == 1 {
        return is_at(kind, edge, xi);
    }
    let [a, b] = [0, 1].map(|k| table.reference[table.faces[edge].nodes[k]]);
    let along = [b[0] - a[0], b[1] - a[1]];
    let beside = along[0] * (xi[1] - a[1]) - along[1] * (xi[0] - a[0]);
    beside.abs() <= ON * along[0].hypot(along[1])
}

fn is_at(kind: Kind, corner: usize, xi: &[f64; 3]) -> bool {
    let at = kind.table().reference[corner];
    (0..kind.table().dim).all(|i| (xi[i] - at[i]).abs() <= ON)
}

/// Edges of a face, or ends of a line; as many as it has corners.
pub(crate) fn edges(kind: Kind) -> usize {
    match kind.table().dim {
        0 => 0,
        _ => kind.table().faces.len(),
    }
}
