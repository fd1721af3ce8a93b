//! Surfaces: facets matched to the cells they bound, turned outward.
//!
//! A facet of a mesh file has no reliable orientation and no parent. Here each one is found among the faces of the
//! body's cells and takes node order, parent and normal from there. Valid for cells of positive Jacobian
//! ([`Mesh::check`]).

use std::collections::BTreeMap;

use carom_elements::{Element, Kind, MAX_FACE_NODES, MAX_NODES, map};

use crate::face::{Face, face_nodes};
use crate::mesh::gather;
use crate::{ElementId, Error, Group, Mesh, Rim};

/// Part of the boundary of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Its faces, in the order of the facets of the group.
    pub faces: Vec<Face>,
    /// Its nodes, sorted, each once.
    pub nodes: Vec<u32>,
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
                        centre: mesh.middle(facets.elements[facet]),
                        cells: [first.parent, cell],
                    });
                }
                faces[facet] = Some(Face {
                    kind: face.kind,
                    nodes: nodes_of(mesh, cell, i),
                    parent: cell,
                    axis: axis(mesh, cell, i),
                    radius: None,
                    rim: Rim::default(),
                });
            }
        }
        let faces = faces.into_iter().zip(&facets.elements);
        let faces = faces.map(|(face, &id)| {
            face.ok_or_else(|| Error::FacetOnNoCell {
                nodes: mesh.element_nodes(id).to_vec(),
                centre: mesh.middle(id),
            })
        });
        Ok(Surface {
            faces: faces.collect::<Result<_, _>>()?,
            nodes: mesh.group_nodes(facets),
        })
    }

    /// The outer surface of cells: their faces that no other of them has, in the order of the cells and of their faces.
    pub fn outer(mesh: &Mesh, cells: &[ElementId]) -> Surface {
        let faces_of = |&cell: &ElementId| {
            let faces = mesh.kind(cell).table().faces.iter().enumerate();
            faces.map(move |(number, face)| Face {
                kind: face.kind,
                nodes: nodes_of(mesh, cell, number),
                parent: cell,
                axis: axis(mesh, cell, number),
                radius: None,
                rim: Rim::default(),
            })
        };
        let mut cells_of = BTreeMap::new();
        for face in cells.iter().flat_map(faces_of) {
            *cells_of.entry(key(&face.nodes)).or_insert(0) += 1;
        }
        let all = cells.iter().flat_map(faces_of);
        let faces: Vec<Face> = all
            .filter(|face| cells_of[&key(&face.nodes)] == 1)
            .collect();
        Surface::of_faces(faces)
    }

    /// The surface of these faces.
    pub fn of_faces(faces: Vec<Face>) -> Surface {
        let corners = faces.iter().flat_map(|face| face.corners());
        let mut nodes: Vec<u32> = corners.copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        Surface { faces, nodes }
    }

    /// The surface of points that stand by themselves: nodes, each with the cell that owns it. `axis`: their outward unit
    /// vector, along which a primary side measures gaps; of a secondary side it does not matter.
    pub fn of_points(points: &[(u32, ElementId)], axis: [f64; 3]) -> Surface {
        let face = |&(node, parent): &(u32, ElementId)| Face {
            kind: Kind::Point1,
            nodes: face_nodes(&[node]),
            parent,
            axis,
            radius: None,
            rim: Rim::default(),
        };
        let mut nodes: Vec<u32> = points.iter().map(|(node, _)| *node).collect();
        nodes.sort_unstable();
        nodes.dedup();
        Surface {
            faces: points.iter().map(face).collect(),
            nodes,
        }
    }

    /// Place of a node in [`Surface::nodes`]; `None` if the surface does not have it.
    pub fn index_of(&self, node: u32) -> Option<usize> {
        self.nodes.binary_search(&node).ok()
    }

    /// Share of each node in the surface, ∫ N_a dΓ, one value per entry of [`Surface::nodes`].
    ///
    /// In the reference position: a length in m in the plane, an area in m² in space, 1 for the end of a bar, each times
    /// `unit` at the place: the area that a unit of the measure stands for.
    ///
    /// Of a quadratic face these are the weights of a pressure's nodal forces, and no areas: zero at the corners of a
    /// six-node triangle, negative at those of an eight-node quadrilateral. See [`Surface::tributary_areas`].
    pub fn node_areas(&self, mesh: &Mesh, unit: impl Fn(&[f64; 3]) -> f64) -> Vec<f64> {
        self.integrate(mesh, &unit, |kind| {
            let places = (0..kind.table().nodes).collect();
            vec![Piece { kind, places }]
        })
    }

    /// Share of each node in the surface in the sense of an area, one value per entry of [`Surface::nodes`]: ∫ φ_a dΓ
    /// with φ_a linear on each of the linear faces that join the nodes of a face ([`pieces`]), taken in the reference
    /// cell. Always positive; the sum is the area. In the units of [`Surface::node_areas`], which it equals on linear
    /// faces.
    pub fn tributary_areas(&self, mesh: &Mesh, unit: impl Fn(&[f64; 3]) -> f64) -> Vec<f64> {
        self.integrate(mesh, &unit, pieces)
    }

    /// ∫ φ_a dΓ with φ_a the shape functions of the pieces into which each face is cut.
    fn integrate(
        &self,
        mesh: &Mesh,
        unit: &dyn Fn(&[f64; 3]) -> f64,
        cut: impl Fn(Kind) -> Vec<Piece>,
    ) -> Vec<f64> {
        let mut areas = vec![0.0; self.nodes.len()];
        let mut buffer = [[0.0; 3]; MAX_NODES];
        for face in &self.faces {
            let x = gather(&mesh.nodes, face.corners(), &mut buffer);
            for piece in cut(face.kind) {
                for (place, area) in piece.areas(face.kind.table(), x, unit) {
                    if let Some(a) = self.index_of(face.nodes[place]) {
                        areas[a] += area;
                    }
                }
            }
        }
        areas
    }
}

/// A part of the reference cell of a face between some of its nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Its shape.
    pub kind: Kind,
    /// Its corners, as places in the node list of the face.
    pub places: Vec<usize>,
}

/// The linear faces that join the nodes of a face: itself if it is linear; two halves of a line; four triangles of a
/// six-node triangle; a triangle at each corner of an eight-node quadrilateral and a quadrilateral between; the four
/// quadrants of a nine-node one. Turned like the face.
pub fn pieces(kind: Kind) -> Vec<Piece> {
    const TRIANGLES: [[usize; 3]; 4] = [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]];
    const CORNERS: [[usize; 3]; 4] = [[0, 4, 7], [1, 5, 4], [2, 6, 5], [3, 7, 6]];
    const QUADRANTS: [[usize; 4]; 4] = [[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]];
    let piece = |kind: Kind, places: &[usize]| Piece {
        kind,
        places: places.to_vec(),
    };
    match kind {
        Kind::Bar3 => vec![piece(Kind::Bar2, &[0, 2]), piece(Kind::Bar2, &[2, 1])],
        Kind::Tri6 => TRIANGLES.map(|t| piece(Kind::Tri3, &t)).to_vec(),
        Kind::Quad8 => {
            let middle = piece(Kind::Quad4, &[4, 5, 6, 7]);
            let corners = CORNERS.iter().map(|t| piece(Kind::Tri3, t));
            corners.chain([middle]).collect()
        }
        Kind::Quad9 => QUADRANTS.map(|q| piece(Kind::Quad4, &q)).to_vec(),
        _ => vec![piece(kind, &(0..kind.table().nodes).collect::<Vec<_>>())],
    }
}

impl Piece {
    /// ∫ φ dΓ of each of its corners over its part of a face with these node positions.
    fn areas(
        &self,
        face: &Element,
        x: &[[f64; 3]],
        unit: &dyn Fn(&[f64; 3]) -> f64,
    ) -> impl Iterator<Item = (usize, f64)> + '_ {
        let table = self.kind.table();
        let mut corners = [[0.0; 3]; MAX_FACE_NODES];
        for (corner, &place) in corners.iter_mut().zip(&self.places) {
            *corner = face.reference[place];
        }
        let corners = &corners[..table.nodes];
        let mut areas = [0.0; MAX_FACE_NODES];
        let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
        let rule = table.mass_rule;
        for (xi, weight) in rule.points.iter().zip(rule.weights) {
            (table.shape)(xi, &mut n[..table.nodes]);
            (table.gradient)(xi, &mut dn[..table.nodes]);
            // the reference cell of a whole face is its own, to the last bit
            let (part, place) = match self.kind == face.kind {
                true => (1.0, *xi),
                false => (
                    map::measure(corners, &dn[..table.nodes], table.dim).0,
                    map::point(corners, &n[..table.nodes]),
                ),
            };
            (face.gradient)(&place, &mut dn[..face.nodes]);
            let (factor, _) = map::measure(x, &dn[..face.nodes], face.dim);
            let mut shape = [0.0; MAX_NODES];
            (face.shape)(&place, &mut shape[..face.nodes]);
            let unit = unit(&map::point(x, &shape[..face.nodes]));
            for (area, n) in areas.iter_mut().zip(&n[..table.nodes]) {
                *area += n * (part * factor) * weight * unit;
            }
        }
        self.places.iter().copied().zip(areas)
    }
}

/// Nodes of a face of a cell, as in [`Face::nodes`].
pub(crate) fn nodes_of(mesh: &Mesh, cell: ElementId, face: usize) -> [u32; MAX_FACE_NODES] {
    let nodes = mesh.element_nodes(cell);
    let mut out = [u32::MAX; MAX_FACE_NODES];
    let corners = mesh.kind(cell).table().faces[face].nodes;
    for (out, &a) in out.iter_mut().zip(corners) {
        *out = nodes[a];
    }
    out
}

/// What two lists of the same nodes have in common, whatever their order.
pub(crate) fn key(nodes: &[u32; MAX_FACE_NODES]) -> [u32; MAX_FACE_NODES] {
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
                centre: mesh.middle(id),
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
pub(crate) fn axis(mesh: &Mesh, cell: ElementId, face: usize) -> [f64; 3] {
    if mesh.kind(cell).table().dim != 1 {
        return [0.0; 3];
    }
    let nodes = mesh.element_nodes(cell);
    let (end, other) = (nodes[face] as usize, nodes[1 - face] as usize);
    let along = [0, 1, 2].map(|i| mesh.nodes[end][i] - mesh.nodes[other][i]);
    let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
    along.map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{box_, line, rectangle};

    /// The outer surface of a box of 2 x 3 x 4 cells: 52 faces in all, those of its sides, and all nodes but the six inside.
    #[test]
    fn the_outer_surface_of_a_box_is_its_six_sides() {
        let mesh = box_("box", [0.0; 3], [1.0; 3], [2, 3, 4], false);
        let outer = Surface::outer(&mesh, &mesh.groups["box"].elements);
        assert_eq!(outer.faces.len(), 2 * (2 * 3 + 3 * 4 + 2 * 4));
        assert_eq!(outer.nodes.len(), 3 * 4 * 5 - 2 * 3);
        for name in ["left", "right", "front", "back", "bottom", "top"] {
            let side = surface(&mesh, "box", &format!("box.{name}")).unwrap();
            assert!(side.faces.iter().all(|face| outer.faces.contains(face)));
        }
    }

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
    fn node_areas_about_an_axis_are_those_of_the_shape_functions() {
        let mesh = rectangle("a", [0.0; 2], [1.0; 2], [4, 1], false);
        let bottom = surface(&mesh, "a", "a.bottom").unwrap();
        let turn = |x: &[f64; 3]| std::f64::consts::TAU * x[0];
        for areas in [
            bottom.node_areas(&mesh, turn),
            bottom.tributary_areas(&mesh, turn),
        ] {
            // ∫ N_a 2πr dr with h = 1/4: πh²/3 on the axis, 2πh r inside, the rest of π at the rim
            let (pi, h) = (std::f64::consts::PI, 0.25);
            for (&node, area) in bottom.nodes.iter().zip(areas) {
                let r = mesh.nodes[node as usize][0];
                let expected = match r {
                    0.0 => pi * h * h / 3.0,
                    1.0 => pi * h * (1.0 - h / 3.0),
                    r => 2.0 * pi * h * r,
                };
                assert!((area - expected).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn node_areas_of_a_grid_are_halves_at_edges_and_quarters_at_corners() {
        let mesh = box_("a", [0.0; 3], [2.0, 2.0, 1.0], [2, 2, 1], false);
        let top = surface(&mesh, "a", "a.top").unwrap();
        let expected = [0.25, 0.5, 0.25, 0.5, 1.0, 0.5, 0.25, 0.5, 0.25];
        for (area, expected) in top.node_areas(&mesh, |_| 1.0).iter().zip(expected) {
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
            let areas = surface(&mesh, "a", side)
                .unwrap()
                .node_areas(&mesh, |_| 1.0);
            assert!((areas.iter().sum::<f64>() - expected).abs() < 1e-14);
        }
    }

    /// A mesh of one face of this kind on a cell of which only that face matters, and the surface of it.
    fn one_face(kind: Kind, bend: impl Fn(&[f64; 3]) -> [f64; 3]) -> (Mesh, Surface) {
        let mut mesh = Mesh::new(3);
        let count = kind.table().nodes as u32;
        mesh.nodes = kind.table().reference.iter().map(bend).collect();
        let nodes: Vec<u32> = (0..count).collect();
        let face = Face {
            kind,
            nodes: face_nodes(&nodes),
            parent: ElementId { block: 0, index: 0 },
            axis: [0.0; 3],
            radius: None,
            rim: Rim::default(),
        };
        let faces = vec![face];
        (mesh, Surface { faces, nodes })
    }

    const QUADRATIC: [(Kind, f64); 4] = [
        (Kind::Bar3, 2.0),
        (Kind::Tri6, 0.5),
        (Kind::Quad8, 4.0),
        (Kind::Quad9, 4.0),
    ];

    #[test]
    fn forces_of_a_pressure_on_flat_quadratic_faces_are_as_in_textbooks() {
        // shares of ends or corners, of the middles of edges, of the centre
        let shares: [[f64; 3]; 4] = [
            [1.0 / 6.0, 0.0, 4.0 / 6.0],
            [0.0, 1.0 / 3.0, 0.0],
            [-1.0 / 12.0, 1.0 / 3.0, 0.0],
            [1.0 / 36.0, 1.0 / 9.0, 4.0 / 9.0],
        ];
        for ((kind, area), shares) in QUADRATIC.into_iter().zip(shares) {
            let (mesh, surface) = one_face(kind, |xi| *xi);
            let corners = kind.table().linear.table().nodes;
            for (a, found) in surface.node_areas(&mesh, |_| 1.0).into_iter().enumerate() {
                let share = match a {
                    a if a < corners => shares[0],
                    a if a < 2 * corners && kind != Kind::Bar3 => shares[1],
                    _ => shares[2],
                };
                assert!((found - share * area).abs() < 1e-14, "{kind:?} {a}");
            }
        }
    }

    #[test]
    fn tributary_areas_are_positive_and_add_up_to_the_area() {
        for (kind, area) in QUADRATIC {
            let (mesh, surface) = one_face(kind, |xi| *xi);
            let areas = surface.tributary_areas(&mesh, |_| 1.0);
            assert!((areas.iter().sum::<f64>() - area).abs() < 1e-14);
            assert!(areas.iter().all(|&a| a > 0.04 * area), "{kind:?}");
            // Curved like a parabola: both sums approach the area, with rules of different points.
            let bend = |x: &[f64; 3]| [x[0], x[1], 0.1 * (x[0] * x[0] + x[0] * x[1])];
            let (mesh, surface) = one_face(kind, bend);
            let areas = surface.tributary_areas(&mesh, |_| 1.0);
            let sum: f64 = surface.node_areas(&mesh, |_| 1.0).iter().sum();
            assert!(areas.iter().all(|&a| a > 0.0));
            assert!(
                (areas.iter().sum::<f64>() / sum - 1.0).abs() < 1e-4,
                "{kind:?}"
            );
        }
        let mesh = box_("a", [0.0; 3], [1.0, 2.0, 1.5], [3, 2, 2], true);
        let side = surface(&mesh, "a", "a.right").unwrap();
        assert_eq!(
            side.tributary_areas(&mesh, |_| 1.0),
            side.node_areas(&mesh, |_| 1.0)
        );
    }

    #[test]
    fn the_pieces_of_a_face_cover_it_once_and_keep_its_turn() {
        for (kind, area) in QUADRATIC {
            let mut sum = 0.0;
            for piece in pieces(kind) {
                let table = piece.kind.table();
                let x: Vec<_> = piece
                    .places
                    .iter()
                    .map(|&a| kind.table().reference[a])
                    .collect();
                let mut dn = vec![[0.0; 3]; table.nodes];
                for (xi, weight) in table.mass_rule.points.iter().zip(table.mass_rule.weights) {
                    (table.gradient)(xi, &mut dn);
                    let (_, det) = map::jacobian(&x, &dn, table.dim);
                    assert!(det > 0.0, "{kind:?}");
                    sum += weight * det;
                }
            }
            assert!((sum - area).abs() < 1e-14, "{kind:?}");
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
