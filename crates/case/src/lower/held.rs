//! What supports hold.

use std::collections::BTreeSet;

use carom_arlequin::{Rows, Term};
use carom_dynamics::Support;
use carom_mesh::Mesh;

/// Translations and, after them, rotations that supports hold at each node of the mesh.
pub(super) struct Held(Vec<[bool; 6]>);

impl Held {
    pub(super) fn new(mesh: &Mesh, supports: &[Support]) -> Held {
        let mut held = vec![[false; 6]; mesh.nodes.len()];
        let turns = if mesh.dim == 2 { 2..3 } else { 0..3 };
        for support in supports {
            let turned = &support.fix_rotations[turns.clone()];
            for &node in &support.nodes {
                let fixed = support.fix[..mesh.dim].iter().chain(turned);
                for (held, fix) in held[node as usize].iter_mut().zip(fixed) {
                    *held |= fix;
                }
            }
        }
        Held(held)
    }

    pub(super) fn has(&self, node: u32, component: u32) -> bool {
        self.0[node as usize][component as usize]
    }

    /// Drops the rows whose node supports hold in both bodies; the multiplier there has nothing to do.
    pub(super) fn drop_rows(&self, rows: &mut Rows) -> Vec<(u32, u32)> {
        let held = |terms: &[Term], component| {
            let mut terms = terms.iter();
            terms.any(|t| t.component == component && self.has(t.node, component))
        };
        let both = rows.rows.iter().filter(|row| {
            self.has(row.node, row.component)
                && held(&row.inner, row.component)
                && held(&row.outer, row.component)
        });
        let both: BTreeSet<(u32, u32)> = both.map(|row| (row.node, row.component)).collect();
        rows.drop(|node, component| both.contains(&(node, component)))
    }
}
