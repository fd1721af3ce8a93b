//! Surfaces around the axes of beams and the middles of shells: cells, or nodes of cells, not sides of them.

use std::collections::BTreeMap;

use carom_elements::Kind;

use crate::{ElementId, Error, Face, Group, Mesh, Rim, Surface, face_nodes};

/// Cosine of the angle between two faces of a shell beyond which the edge between them is sharp: 40°, as for its directors.
pub(crate) const FOLD: f64 = 0.766;

impl Surface {
    /// The surface around cells at a distance: around the lines or plane cells of a group, or around its points, which may
    /// be ends of lines or nodes between them. The parent of a face is the cell that it is, or the first that has the point.
    ///
    /// `radius`: of a cell, m.
    ///
    /// # Errors
    /// [`Error::FacetOnNoCell`] for a facet that is no cell, or a point that no cell has; [`Error::FacetDimension`] for facets
    /// of three dimensions.
    pub fn of_axes(
        mesh: &Mesh,
        facets: &Group,
        cells: &[ElementId],
        radius: impl Fn(ElementId) -> f64,
    ) -> Result<Surface, Error> {
        Surface::of_cells(mesh, facets, cells, &|cell| Some(radius(cell)))
    }

    /// The middle surface of shells: the cells of a group, with the normals of the shells.
    ///
    /// # Errors
    /// As [`Surface::of_axes`].
    pub fn of_shells(mesh: &Mesh, facets: &Group, cells: &[ElementId]) -> Result<Surface, Error> {
        Surface::of_cells(mesh, facets, cells, &|_| None)
    }

    /// Edges of the faces around the middle surface of shells that belong to one of them, or at which two meet at more than 40°, as lines around which the
    /// surface is as far as around the faces.
    pub fn sharp_edges(&self, mesh: &Mesh) -> Vec<Face> {
        let mut of_edge: BTreeMap<[u32; 2], Vec<(&Face, [u32; 2])>> = BTreeMap::new();
        let flat = |face: &&Face| face.is_round() && matches!(face.kind, Kind::Tri3 | Kind::Quad4);
        for face in self.faces.iter().filter(flat) {
            let nodes = face.corners();
            for (k, &a) in nodes.iter().enumerate() {
                let b = nodes[(k + 1) % nodes.len()];
                let ends = [a.min(b), a.max(b)];
                of_edge.entry(ends).or_default().push((face, [a, b]));
            }
        }
        let sharp = of_edge.values().filter(|of| match &of[..] {
            [_] => true,
            all => all.windows(2).any(|pair| {
                let [one, other] = [0, 1].map(|i| normal(mesh, pair[i].0));
                let cosine: f64 = (0..3).map(|i| one[i] * other[i]).sum();
                cosine < FOLD
            }),
        });
        let line = |of: &Vec<(&Face, [u32; 2])>| {
            let (face, nodes) = of[0];
            let radii = of.iter().filter_map(|(face, _)| face.radius);
            Face {
                kind: Kind::Bar2,
                nodes: face_nodes(&nodes),
                parent: face.parent,
                axis: [0.0; 3],
                radius: Some(radii.fold(0.0, f64::max)),
                rim: Rim::default(),
            }
        };
        sharp.map(line).collect()
    }

    fn of_cells(
        mesh: &Mesh,
        facets: &Group,
        cells: &[ElementId],
        radius: &dyn Fn(ElementId) -> Option<f64>,
    ) -> Result<Surface, Error> {
        if facets.dim > 2 {
            return Err(Error::FacetDimension {
                facets: facets.dim,
                cells: 2,
            });
        }
        let (mut by_ends, mut by_node) = (BTreeMap::new(), BTreeMap::new());
        for &cell in cells.iter().rev() {
            let nodes = mesh.element_nodes(cell);
            by_ends.insert(sorted(nodes), cell);
            by_node.extend(nodes.iter().map(|&node| (node, cell)));
        }
        let face = |&id: &ElementId| {
            let nodes = mesh.element_nodes(id);
            let parent = match facets.dim {
                0 => nodes.first().and_then(|node| by_node.get(node)),
                _ => by_ends.get(&sorted(nodes)),
            };
            let &parent = parent.ok_or_else(|| Error::FacetOnNoCell {
                nodes: nodes.to_vec(),
                centre: mesh.nodes[nodes[0] as usize],
            })?;
            Ok(Face {
                kind: if facets.dim == 0 {
                    Kind::Point1
                } else {
                    mesh.kind(id)
                },
                nodes: match facets.dim {
                    0 => face_nodes(nodes),
                    _ => face_nodes(mesh.element_nodes(parent)),
                },
                parent,
                axis: [0.0; 3],
                radius: radius(parent),
                rim: Rim::default(),
            })
        };
        Ok(Surface {
            faces: facets
                .elements
                .iter()
                .map(face)
                .collect::<Result<_, Error>>()?,
            nodes: mesh.group_nodes(facets),
        })
    }
}

/// Unit normal of a face of three or four nodes.
pub(crate) fn normal(mesh: &Mesh, face: &Face) -> [f64; 3] {
    let x: Vec<[f64; 3]> = face
        .corners()
        .iter()
        .map(|&node| mesh.nodes[node as usize])
        .collect();
    let way = |from: usize, to: usize| [0, 1, 2].map(|i| x[to][i] - x[from][i]);
    let (a, b) = match x.len() {
        3 => (way(0, 1), way(0, 2)),
        _ => (way(0, 2), way(1, 3)),
    };
    let n = [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    });
    let length = n.iter().map(|n| n * n).sum::<f64>().sqrt();
    n.map(|n| n / length)
}

fn sorted(nodes: &[u32]) -> Vec<u32> {
    let mut nodes = nodes.to_vec();
    nodes.sort_unstable();
    nodes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{generate, project};

    #[test]
    fn the_gap_of_a_point_over_an_axis_is_its_distance_less_the_radius() {
        let mesh = generate::line("a", [0.0; 3], [2.0, 0.0, 0.0], 2, 3);
        let cells = &mesh.groups["a"].elements;
        let radius = |cell: ElementId| 0.1 + 0.1 * f64::from(cell.index);
        let surface = Surface::of_axes(&mesh, &mesh.groups["a"], cells, radius).unwrap();
        assert_eq!(surface.nodes, [0, 1, 2]);
        let second = &surface.faces[1];
        let x = [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        let beside = project(second, &x, &[1.25, 0.3, -0.4]);
        assert!((beside.gap - 0.3).abs() < 1e-15 && beside.inside);
        assert!((beside.normal[1] - 0.6).abs() < 1e-15 && (beside.normal[2] + 0.8).abs() < 1e-15);
        // beyond the end the surface is that of a ball
        let beyond = project(second, &x, &[2.3, 0.0, 0.4]);
        assert!((beyond.gap - 0.3).abs() < 1e-15 && beyond.inside);
    }

    #[test]
    fn edges_of_shells_are_sharp_where_they_are_free_or_folded() {
        let mut mesh = generate::rectangle("a", [0.0; 2], [2.0, 1.0], [2, 1], false);
        mesh.dim = 3;
        let cells = mesh.groups["a"].elements.clone();
        let around = |mesh: &Mesh| Surface::of_axes(mesh, &mesh.groups["a"], &cells, |_| 0.1);
        let flat = around(&mesh).unwrap().sharp_edges(&mesh);
        assert_eq!(flat.len(), 6);
        assert!(flat.iter().all(|edge| edge.radius == Some(0.1)));
        // the second cell is turned by 45° about the edge between both
        for node in 0..mesh.nodes.len() {
            let beyond = (mesh.nodes[node][0] - 1.0).max(0.0) * 0.5_f64.sqrt();
            if beyond > 0.0 {
                mesh.nodes[node][0] = 1.0 + beyond;
                mesh.nodes[node][2] = beyond;
            }
        }
        assert_eq!(around(&mesh).unwrap().sharp_edges(&mesh).len(), 7);
    }

    #[test]
    fn points_between_cells_are_faces_and_lines_that_are_no_cells_are_not() {
        let mut mesh = generate::line("a", [0.0; 3], [2.0, 0.0, 0.0], 2, 3);
        let point = mesh.push(Kind::Point1, &[1]);
        let line = mesh.push(Kind::Bar2, &[0, 2]);
        let cells = mesh.groups["a"].elements.clone();
        let of = |group| Surface::of_axes(&mesh, &group, &cells, |_| 0.1);
        let middle = of(Group::new(0, vec![point])).unwrap();
        assert_eq!((middle.nodes, middle.faces[0].parent), (vec![1], cells[0]));
        let error = of(Group::new(1, vec![line]));
        assert!(matches!(error, Err(Error::FacetOnNoCell { .. })));
    }
}
