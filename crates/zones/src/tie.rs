//! Zones that meet in a border whose nodes do not match: rows of mortar integrals.

use carom_arlequin::{Row, Rows, Term};
use carom_contact::{Basis, Tie};
use carom_mesh::{Mesh, Surface};

/// Rows `∫ φ_A (v_c - v_s) dΓ = 0` for every multiplier and direction, over what of the surfaces lies opposite to each other
/// in the reference configuration, along the normal of the multipliers' side.
///
/// Multipliers sit at the corners of the faces of the side that has more nodes, of the inner one if they are as many, and
/// are linear between them. So on flat borders a uniform stress, and a linear displacement, pass without a trace. The rows
/// are named by the nodes of the multipliers; there is none where nothing lies opposite.
///
/// `factor`: area in m² that a unit of the measure of the faces stands for at a place (thickness, 2 π r). The coefficients
/// are areas in m², and multipliers tractions in Pa.
pub fn mortar_rows(
    mesh: &Mesh,
    inner: &Surface,
    outer: &Surface,
    factor: impl Fn(&[f64; 3]) -> f64,
) -> Rows {
    let swapped = outer.nodes.len() > inner.nodes.len();
    let (secondary, primary) = match swapped {
        true => (outer, inner),
        false => (inner, outer),
    };
    let faces = (secondary.faces.clone(), primary.faces.clone());
    let ties = Tie::all(faces, (&mesh.nodes, mesh.dim), Basis::Standard, factor);
    let terms = |terms: &[(u32, f64)], component: u32| -> Vec<Term> {
        let term = |&(node, coefficient): &(u32, f64)| Term {
            node,
            component,
            coefficient,
        };
        terms.iter().map(term).collect()
    };
    let rows = ties.iter().flat_map(|tie| {
        let (inner, outer) = match swapped {
            true => (&tie.primary, &tie.secondary),
            false => (&tie.secondary, &tie.primary),
        };
        (0..mesh.dim as u32).map(move |component| Row {
            node: tie.node,
            component,
            inner: terms(inner, component),
            outer: terms(outer, component),
            ..Row::default()
        })
    });
    Rows {
        rows: rows.collect(),
        slivers: Vec::new(),
    }
}
