//! Surfaces: facets matched to the cells they bound, turned outward.
//!
//! A facet of a mesh file has no reliable orientation and no parent. Here each one is found among the faces of the
//! body's cells and takes node order, parent and normal from there. Valid for cells of positive Jacobian
//! ([`Mesh::check`]).

use std::collections::BTreeMap;

use carom_elements::{Kind, MAX_FACE_NODES, MAX_NODES, map};

use crate::mesh::gather;
use crate::{ElementId, Error, Group, Mesh};

/// Part of the boundary of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Its faces, in the order of the facets of the group.
    pub faces: Vec<Face>,
    /// Its nodes, sorted, each once.
    pub nodes: Vec<u32>,
}

/// A face of a surface, turned so that its normal points out of the parent cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// Kind of the face.
    pub kind: Kind,
    /// Node numbers; only as many entries as the kind has nodes are used ([`Face::corners`]).
    pub nodes: [u32; MAX_FACE_NODES],
    /// The cell that the face bounds.
    pub parent: ElementId,
    /// For a point, the end of a bar: unit vector along the bar, outward, in the reference position. Zero for
    /// other kinds, whose normal follows from their nodes.
    pub axis: [f64; 3],
}

impl Face {
    /// The nodes of the face, in its own order.
    pub fn corners(&self) -> &[u32] {
        &self.nodes[..self.kind.table().nodes]
    }
}

/// A list of nodes as in [`Face::nodes`]: entries that are not used are the largest number, so that sorted lists
/// compare.
pub fn face_nodes(nodes: &[u32]) -> [u32; MAX_FACE_NODES] {
    let mut out = [u32::MAX; MAX_FACE_NODES];
    out[..nodes.len()].copy_from_slice(nodes);
    out
}

impl Surface {
    /// The surface made of the facets of a group, seen as faces of these cells.
    ///
    /// Fails if the dimension of the facets is not one less than that of every cell, if plane cells stand in
    /// space (their edges have no normal), if a facet is a face of no cell or of two, or if two facets are the same
    /// face.
    pub fn new(mesh: &Mesh, facets: &Group, cells: &[ElementId]) -> Result<Surface, Error> {
        check_dimensions(mesh, facets, cells)?;
        let mut faces: Vec<Option<Face>> = vec![None; facets.elements.len()];
        let wanted = by_nodes(mesh, facets)?;
        for &cell in cells {
            for (i, face) in mesh.kind(cell).table().faces.iter().enumerate() {
                let Some(&facet) = wanted.get(&key(&nodes_of(mesh, cell, i))) else {
                    continue;
                };
                if let Some(first) = faces[facet] {
                    return Err(Error::FacetOnTwoCells {
                        nodes: mesh.element_nodes(facets.elements[facet]).to_vec(),
                        centre: centre(mesh, facets.elements[facet]),
                        cells: [first.parent, cell],
                    });
                }
                faces[facet] = Some(Face {
                    kind: face.kind,
                    nodes: nodes_of(mesh, cell, i),
                    parent: cell,
                    axis: axis(mesh, cell, i),
                });
            }
        }
        let faces = faces.into_iter().zip(&facets.elements);
        let faces = faces.map(|(face, &id)| {
            face.ok_or_else(|| Error::FacetOnNoCell {
                nodes: mesh.element_nodes(id).to_vec(),
                centre: centre(mesh, id),
            })
        });
        Ok(Surface {
            faces: faces.collect::<Result<_, _>>()?,
            nodes: mesh.group_nodes(facets),
        })
    }

    /// Place of a node in [`Surface::nodes`]; `None` if the surface does not have it.
    pub fn index_of(&self, node: u32) -> Option<usize> {
        self.nodes.binary_search(&node).ok()
    }

    /// Share of each node in the surface, ∫ N_a dΓ, one value per entry of [`Surface::nodes`].
    ///
    /// In the reference position: a length in m in the plane, an area in m² in space; 1 for the end of a bar, whose
    /// section is not the mesh's business.
    pub fn node_areas(&self, mesh: &Mesh) -> Vec<f64> {
        let mut areas = vec![0.0; self.nodes.len()];
        let mut buffer = [[0.0; 3]; MAX_NODES];
        for face in &self.faces {
            let table = face.kind.table();
            let x = gather(&mesh.nodes, face.corners(), &mut buffer);
            let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
            let rule = table.mass_rule;
            for (xi, weight) in rule.points.iter().zip(rule.weights) {
                (table.shape)(xi, &mut n[..table.nodes]);
                (table.gradient)(xi, &mut dn[..table.nodes]);
                let (factor, _) = map::measure(x, &dn[..table.nodes], table.dim);
                for (&node, n) in face.corners().iter().zip(n) {
                    if let Some(a) = self.index_of(node) {
                        areas[a] += n * factor * weight;
                    }
                }
            }
        }
        areas
    }
}

/// Nodes of a face of a cell, as in [`Face::nodes`].
fn nodes_of(mesh: &Mesh, cell: ElementId, face: usize) -> [u32; MAX_FACE_NODES] {
    let nodes = mesh.element_nodes(cell);
    let mut out = [u32::MAX; MAX_FACE_NODES];
    let corners = mesh.kind(cell).table().faces[face].nodes;
    for (out, &a) in out.iter_mut().zip(corners) {
        *out = nodes[a];
    }
    out
}

/// What two lists of the same nodes have in common, whatever their order.
fn key(nodes: &[u32; MAX_FACE_NODES]) -> [u32; MAX_FACE_NODES] {
    let mut sorted = *nodes;
    sorted.sort_unstable();
    sorted
}

/// Facets by their nodes.
fn by_nodes(mesh: &Mesh, facets: &Group) -> Result<BTreeMap<[u32; MAX_FACE_NODES], usize>, Error> {
    let mut map = BTreeMap::new();
    for (i, &id) in facets.elements.iter().enumerate() {
        let nodes = mesh.element_nodes(id);
        if map.insert(key(&face_nodes(nodes)), i).is_some() {
            return Err(Error::FacetTwice {
                nodes: nodes.to_vec(),
                centre: centre(mesh, id),
            });
        }
    }
    Ok(map)
}

/// Refuses facets that cannot bound the cells.
fn check_dimensions(mesh: &Mesh, facets: &Group, cells: &[ElementId]) -> Result<(), Error> {
    for &cell in cells {
        let dim = mesh.kind(cell).table().dim;
        if facets.dim + 1 != dim {
            return Err(Error::FacetDimension {
                facets: facets.dim,
                cells: dim,
            });
        }
        if dim == 2 && mesh.dim == 3 {
            return Err(Error::PlaneCellsInSpace { cell });
        }
    }
    Ok(())
}

/// Outward unit vector along a bar at one of its ends; zero for cells of other dimensions.
fn axis(mesh: &Mesh, cell: ElementId, face: usize) -> [f64; 3] {
    if mesh.kind(cell).table().dim != 1 {
        return [0.0; 3];
    }
    let nodes = mesh.element_nodes(cell);
    let (end, other) = (nodes[face] as usize, nodes[1 - face] as usize);
    let along = [0, 1, 2].map(|i| mesh.nodes[end][i] - mesh.nodes[other][i]);
    let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
    along.map(|x| x / length)
}

fn centre(mesh: &Mesh, id: ElementId) -> [f64; 3] {
    let nodes = mesh.element_nodes(id);
    [0, 1, 2].map(|i| {
        let sum: f64 = nodes.iter().map(|&node| mesh.nodes[node as usize][i]).sum();
        sum / nodes.len() as f64
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{box_, line, rectangle};

    fn surface(mesh: &Mesh, body: &str, side: &str) -> Result<Surface, Error> {
        Surface::new(mesh, &mesh.groups[side], &mesh.groups[body].elements)
    }

    #[test]
    fn facets_take_orientation_and_parent_from_their_cell() {
        let mut mesh = box_("a", [0.0; 3], [1.0; 3], [2, 2, 2], false);
        let id = mesh.groups["a.top"].elements[1];
        let sound = surface(&mesh, "a", "a.top").unwrap();
        let block = &mut mesh.blocks[id.block as usize];
        let first = 4 * id.index as usize;
        block.nodes[first..first + 4].reverse();
        assert_eq!(surface(&mesh, "a", "a.top").unwrap(), sound);
        for face in &sound.faces {
            let nodes = mesh.element_nodes(face.parent);
            assert!(face.corners().iter().all(|node| nodes.contains(node)));
        }
    }

    #[test]
    fn node_areas_of_a_grid_are_halves_at_edges_and_quarters_at_corners() {
        let mesh = box_("a", [0.0; 3], [2.0, 2.0, 1.0], [2, 2, 1], false);
        let top = surface(&mesh, "a", "a.top").unwrap();
        let expected = [0.25, 0.5, 0.25, 0.5, 1.0, 0.5, 0.25, 0.5, 0.25];
        for (area, expected) in top.node_areas(&mesh).iter().zip(expected) {
            assert!((area - expected).abs() < 1e-15);
        }
        assert_eq!(top.index_of(top.nodes[4]), Some(4));
        assert_eq!(top.index_of(0), None);
    }

    #[test]
    fn node_areas_add_up_to_the_area() {
        let meshes = [
            (box_("a", [0.0; 3], [1.0, 2.0, 1.5], [3, 2, 2], true), 3.0),
            (rectangle("a", [0.0; 2], [3.0, 1.0], [4, 2], true), 3.0),
        ];
        for (mesh, expected) in meshes {
            let side = if mesh.dim == 3 { "a.right" } else { "a.top" };
            let areas = surface(&mesh, "a", side).unwrap().node_areas(&mesh);
            assert!((areas.iter().sum::<f64>() - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn a_facet_away_from_the_body_is_on_no_cell() {
        let mut mesh = rectangle("a", [0.0; 2], [1.0; 2], [2, 2], false);
        mesh.merge("b", rectangle("b", [2.0, 0.0], [1.0; 2], [1, 1], false))
            .unwrap();
        let error = surface(&mesh, "a", "b.left").unwrap_err();
        let centre = [2.0, 0.5, 0.0];
        assert!(matches!(&error, Error::FacetOnNoCell { centre: c, .. } if *c == centre));
    }

    #[test]
    fn a_facet_inside_the_body_is_on_two_cells() {
        let mut mesh = rectangle("a", [0.0; 2], [1.0; 2], [2, 1], true);
        let cut = mesh.push(Kind::Bar2, &[1, 4]);
        mesh.groups
            .insert("cut".to_owned(), Group::new(1, vec![cut]));
        let error = surface(&mesh, "a", "cut").unwrap_err();
        assert!(matches!(error, Error::FacetOnTwoCells { nodes, cells, .. }
                if nodes == [1, 4] && cells[0] != cells[1]));
    }

    #[test]
    fn the_same_facet_twice_is_an_error() {
        let mut mesh = line("a", [0.0; 3], [1.0, 0.0, 0.0], 2, 1);
        let again = mesh.push(Kind::Point1, &[0]);
        let first = mesh.groups["a.left"].elements[0];
        mesh.groups
            .insert("twice".to_owned(), Group::new(0, vec![first, again]));
        let error = surface(&mesh, "a", "twice").unwrap_err();
        assert!(matches!(error, Error::FacetTwice { nodes, .. } if nodes == [0]));
    }

    #[test]
    fn facets_must_have_one_dimension_less_than_the_cells() {
        let mut mesh = box_("a", [0.0; 3], [1.0; 3], [1, 1, 1], false);
        let (facets, cells) = (3, 3);
        assert_eq!(
            surface(&mesh, "a", "a"),
            Err(Error::FacetDimension { facets, cells })
        );
        let plate = rectangle("plate", [0.0; 2], [1.0; 2], [1, 1], false);
        mesh.merge("plate", plate).unwrap();
        assert!(matches!(
            surface(&mesh, "plate", "plate.top"),
            Err(Error::PlaneCellsInSpace { .. })
        ));
    }
}
