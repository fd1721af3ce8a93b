//! Two lines in place of one of three nodes.

use std::collections::BTreeMap;

use carom_elements::Kind;

use crate::{ElementId, Group, Mesh};

/// Replaces the lines of three nodes of some groups by two of two nodes each, in all groups that have them: bars and beams have two nodes,
/// and a mesh generator that makes quadratic cells makes all lines quadratic.
///
/// Names of groups that the mesh does not have are passed over.
pub fn halve_bars<'a>(mesh: &mut Mesh, groups: impl IntoIterator<Item = &'a str>) {
    let mut halves: BTreeMap<ElementId, [ElementId; 2]> = BTreeMap::new();
    for name in groups {
        let Some(group) = mesh.groups.get(name) else {
            continue;
        };
        for id in group.elements.clone() {
            if mesh.kind(id) == Kind::Bar3 && !halves.contains_key(&id) {
                let &[a, b, middle] = mesh.element_nodes(id) else {
                    continue;
                };
                let parts = [[a, middle], [middle, b]].map(|nodes| mesh.push(Kind::Bar2, &nodes));
                halves.insert(id, parts);
            }
        }
    }
    if halves.is_empty() {
        return;
    }
    for group in mesh.groups.values_mut() {
        if group.elements.iter().any(|id| halves.contains_key(id)) {
            let elements = group.elements.iter().flat_map(|id| match halves.get(id) {
                Some(parts) => parts.to_vec(),
                None => vec![*id],
            });
            *group = Group::new(group.dim, elements.collect());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{generate, raise};

    #[test]
    fn a_quadratic_line_is_two_bars_in_all_its_groups() {
        let line = generate::line("rod", [0.0; 3], [1.0, 0.0, 0.0], 3, 3);
        let mut mesh = raise(&line, false).unwrap();
        let first = mesh.groups["rod"].elements[0];
        mesh.groups
            .insert("glue".into(), Group::new(1, vec![first]));
        let nodes = mesh.nodes.len();
        halve_bars(&mut mesh, ["rod", "missing"]);
        assert_eq!(mesh.nodes.len(), nodes);
        assert_eq!(mesh.groups["rod"].elements.len(), 6);
        assert_eq!(mesh.groups["glue"].elements.len(), 2);
        let length: f64 = mesh.groups["rod"]
            .elements
            .iter()
            .map(|&id| {
                assert_eq!(mesh.kind(id), Kind::Bar2);
                let ends = mesh.element_nodes(id);
                mesh.nodes[ends[1] as usize][0] - mesh.nodes[ends[0] as usize][0]
            })
            .sum();
        assert!((length - 1.0).abs() < 1e-15);
    }
}
