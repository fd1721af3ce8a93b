//! Groups of files whose groups may have elements of several dimensions.

use std::collections::BTreeMap;

use crate::{ElementId, Group, Mesh};

/// Adds a group of elements; one of several dimensions has the name for the highest, `name.2d` and the like for others.
pub fn add(mesh: &mut Mesh, name: &str, elements: Vec<ElementId>) {
    let mut by_dim: BTreeMap<usize, Vec<ElementId>> = BTreeMap::new();
    for element in elements {
        let dim = mesh.kind(element).table().dim;
        by_dim.entry(dim).or_default().push(element);
    }
    let highest = by_dim.keys().max().copied();
    for (dim, elements) in by_dim {
        let name = match Some(dim) == highest {
            true => name.to_owned(),
            false => format!("{name}.{dim}d"),
        };
        mesh.groups.insert(name, Group::new(dim, elements));
    }
}
