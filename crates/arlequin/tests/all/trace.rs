//! Matching interfaces.

use carom_arlequin::{Error, Row, trace};

use crate::support::{Pair, plate};

#[test]
fn coincident_nodes_are_paired_and_rows_say_that_they_move_alike() {
    let pair = Pair::new(
        plate([0.0, 0.0], [1.0, 1.0], [3, 4], true),
        plate([1.0, 0.0], [2.0, 1.0], [5, 4], false),
    );
    let nodes = |cells: &[carom_mesh::ElementId]| {
        let group = carom_mesh::Group::new(2, cells.to_vec());
        pair.mesh.group_nodes(&group)
    };
    let (inner, outer) = (nodes(&pair.inner), nodes(&pair.outer));
    let rows = trace(&pair.mesh, &inner, &outer, 1e-9).unwrap();
    assert_eq!(rows.rows.len(), 2 * 5);
    for row in &rows.rows {
        let at = |node: u32| pair.mesh.nodes[node as usize];
        assert_eq!(at(row.inner[0].node), at(row.outer[0].node));
        assert_eq!(at(row.node)[0], 1.0);
        let field = |node: u32, k: usize| {
            if k == row.component as usize {
                f64::from(node)
            } else {
                0.0
            }
        };
        assert_eq!(Row::apply(&row.outer, field), f64::from(row.node));
    }
    assert!(rows.rank(|_, _| false).unwrap().smallest > 0.99);

    let tolerance = 1e-9;
    let apart = trace(&pair.mesh, &inner[..1], &outer, tolerance);
    assert_eq!(apart.unwrap_err(), Error::NoInterface { tolerance });
    let wide = trace(&pair.mesh, &inner, &outer, 0.5);
    assert!(matches!(wide, Err(Error::Ambiguous { .. })));
    // Zones of one mesh share their nodes; each has its own unknowns there.
    let shared = trace(&pair.mesh, &inner[..2], &inner[1..], tolerance).unwrap();
    assert_eq!((shared.rows.len(), shared.rows[0].node), (2, inner[1]));
}
