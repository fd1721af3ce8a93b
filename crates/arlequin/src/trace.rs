//! Matching interfaces: zones that meet in coincident nodes, without an overlap.

use std::collections::BTreeMap;

use carom_mesh::{Bounds, BoxTree, Mesh};

use crate::error::Error;
use crate::rows::{Row, Rows, Term};

/// Rows v_c(node) - v_s(node') = 0 for every pair of coincident nodes of two zones.
///
/// `inner`, `outer`: nodes of the two zones; a node may be in both, if the zones have unknowns of their own there.
/// `tolerance`: largest distance of coincident nodes, in m. Coefficients are 1, so the multiplier is a nodal force in N.
/// The rows are named by the nodes of the outer zone.
///
/// Errors: no coincident nodes; a node that coincides with several.
pub fn trace(mesh: &Mesh, inner: &[u32], outer: &[u32], tolerance: f64) -> Result<Rows, Error> {
    let at = |node: u32| mesh.nodes[node as usize];
    let bounds: Vec<Bounds> = outer.iter().map(|&node| Bounds::of(&[at(node)])).collect();
    let tree = BoxTree::new(&bounds);
    let mut partner: BTreeMap<u32, u32> = BTreeMap::new();
    let mut found = Vec::new();
    for &node in inner {
        tree.near(&at(node), tolerance, &mut found);
        match found[..] {
            [] => {}
            [one] => {
                if partner.insert(outer[one as usize], node).is_some() {
                    let node = outer[one as usize];
                    return Err(Error::Ambiguous { node });
                }
            }
            _ => return Err(Error::Ambiguous { node }),
        }
    }
    if partner.is_empty() {
        return Err(Error::NoInterface { tolerance });
    }
    let term = |node, component| Term {
        node,
        component,
        coefficient: 1.0,
    };
    let rows = partner.iter().flat_map(|(&outer, &inner)| {
        (0..mesh.dim as u32).map(move |component| Row {
            node: outer,
            component,
            inner: vec![term(inner, component)],
            outer: vec![term(outer, component)],
            ..Row::default()
        })
    });
    Ok(Rows {
        rows: rows.collect(),
        slivers: Vec::new(),
    })
}
