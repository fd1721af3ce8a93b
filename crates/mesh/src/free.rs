//! Surfaces without cells: facets that bound no body, such as those of a rigid obstacle.

use std::collections::BTreeMap;

use carom_elements::Kind;

use crate::{ElementId, Error, Face, Group, Mesh, Rim, Surface, face_nodes};

impl Surface {
    /// The surface made of the facets of a group as they stand, whatever cells there are: normals follow from the order of
    /// their nodes, `turned` reverses them. The parent of a face is the facet itself.
    ///
    /// # Errors
    /// [`Error::FacetDimension`] if the facets are not lines in the plane or plane cells in space;
    /// [`Error::FacetsDisagree`] if two facets run along their common edge in the same sense: their normals point to
    /// different sides.
    pub fn of_facets(mesh: &Mesh, facets: &Group, turned: bool) -> Result<Surface, Error> {
        if facets.dim + 1 != mesh.dim || facets.dim == 0 {
            return Err(Error::FacetDimension {
                facets: facets.dim,
                cells: mesh.dim,
            });
        }
        let face = |&id: &ElementId| {
            let mut nodes = mesh.element_nodes(id).to_vec();
            if turned {
                turn(mesh.kind(id), &mut nodes);
            }
            Face {
                kind: mesh.kind(id),
                nodes: face_nodes(&nodes),
                parent: id,
                axis: [0.0; 3],
                radius: None,
                rim: Rim::default(),
            }
        };
        let faces: Vec<Face> = facets.elements.iter().map(face).collect();
        check_sense(&faces)?;
        Ok(Surface {
            faces,
            nodes: mesh.group_nodes(facets),
        })
    }
}

/// Reverses the sense of a face: node a becomes that at the mirror image of the reference place of a.
fn turn(kind: Kind, nodes: &mut [u32]) {
    let table = kind.table();
    let old = nodes.to_vec();
    for (node, xi) in nodes.iter_mut().zip(table.reference) {
        let image = match table.dim {
            1 => [-xi[0], 0.0, 0.0],
            _ => [xi[1], xi[0], 0.0],
        };
        if let Some(place) = table.reference.iter().position(|other| *other == image) {
            *node = old[place];
        }
    }
}

/// Refuses faces that run along a common edge (meet in a common node, in the plane) in the same sense.
fn check_sense(faces: &[Face]) -> Result<(), Error> {
    let mut seen: BTreeMap<[u32; 2], ElementId> = BTreeMap::new();
    for face in faces {
        let nodes = face.corners();
        for (k, side) in face.kind.table().faces.iter().enumerate() {
            let sense = match side.nodes {
                // the end of a line: which of both it is
                [a] => [nodes[*a], k as u32],
                ends => [nodes[ends[0]], nodes[ends[1]]],
            };
            if let Some(first) = seen.insert(sense, face.parent) {
                return Err(Error::FacetsDisagree {
                    facets: [first, face.parent],
                    node: sense[0],
                });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two unit squares beside each other as two facets in space, the second one's nodes given.
    fn pair(second: [u32; 4]) -> (Mesh, Group) {
        let mut mesh = Mesh::new(3);
        for i in 0..6 {
            mesh.nodes.push([f64::from(i % 3), f64::from(i / 3), 0.0]);
        }
        let a = mesh.push(Kind::Quad4, &[0, 1, 4, 3]);
        let b = mesh.push(Kind::Quad4, &second);
        (mesh, Group::new(2, vec![a, b]))
    }

    fn normal(mesh: &Mesh, face: &Face) -> [f64; 3] {
        let mut x = [[0.0; 3]; carom_elements::MAX_NODES];
        let x = crate::gather(&mesh.nodes, face.corners(), &mut x);
        crate::project(face, x, &[0.5, 0.5, 1.0]).normal
    }

    #[test]
    fn facets_keep_their_sense_or_are_turned() {
        let (mesh, group) = pair([1, 2, 5, 4]);
        for (turned, z) in [(false, 1.0), (true, -1.0)] {
            let surface = Surface::of_facets(&mesh, &group, turned).unwrap();
            assert_eq!(surface.nodes, [0, 1, 2, 3, 4, 5]);
            for face in &surface.faces {
                assert_eq!(normal(&mesh, face), [0.0, 0.0, z]);
            }
        }
    }

    #[test]
    fn facets_of_opposite_normals_and_of_a_wrong_dimension_are_refused() {
        let (mut mesh, group) = pair([1, 4, 5, 2]);
        let [first, second] = [group.elements[0], group.elements[1]];
        assert_eq!(
            Surface::of_facets(&mesh, &group, false),
            Err(Error::FacetsDisagree {
                facets: [first, second],
                node: 1
            })
        );
        mesh.dim = 2;
        let error = Surface::of_facets(&mesh, &group, false);
        assert!(matches!(error, Err(Error::FacetDimension { .. })));
        let a = mesh.push(Kind::Bar2, &[0, 1]);
        let b = mesh.push(Kind::Bar2, &[1, 2]);
        let c = mesh.push(Kind::Bar2, &[2, 1]);
        assert!(Surface::of_facets(&mesh, &Group::new(1, vec![a, b]), true).is_ok());
        let error = Surface::of_facets(&mesh, &Group::new(1, vec![a, c]), false);
        assert!(matches!(error, Err(Error::FacetsDisagree { .. })));
    }
}
