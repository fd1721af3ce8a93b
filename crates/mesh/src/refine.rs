//! Finer meshes from coarse ones: every element cut in halves along each direction.

use carom_elements::{Element, Kind};

use crate::{Block, ElementId, Error, Group, Mesh, raise};

/// The ways to cut the octahedron between the middles of the edges of a tetrahedron, in node numbers of tet10: its diagonal,
/// and the four nodes round it such that each two neighbours make a tetrahedron of positive volume with it.
const OCTAHEDRON: [[usize; 6]; 3] = [[4, 9, 7, 8, 5, 6], [6, 8, 4, 5, 9, 7], [7, 5, 6, 9, 8, 4]];

/// The mesh with every element cut into 2^dim of the same kind; groups hold the parts of their elements.
///
/// Old nodes keep their numbers. New ones lie where the linear shape functions put the middles of edges, quadrilaterals and
/// hexahedra, so that borders keep the shape of the coarse mesh; neighbours share them. Part `i` of element `e` is element
/// 2^dim e + i of the same block. Parts are the element shrunk to half towards each of its corners, and the rest of it:
/// of a triangle the one between the middles of its edges, of a tetrahedron four round the shortest diagonal of the
/// octahedron there, so that parts do not get flatter with every cut. Zhang (1995), Houston Journal of Mathematics 21.
///
/// # Errors
/// [`Error::NoRefinement`] for quadratic elements, wedges and pyramids.
pub fn refine(mesh: &Mesh) -> Result<Mesh, Error> {
    if let Some(kind) = without_parts(mesh) {
        return Err(Error::NoRefinement { kind });
    }
    let raised = raise(mesh, true)?;
    let blocks = raised.blocks.iter().map(|block| cut(block, &raised.nodes));
    let groups = mesh.groups.iter().map(|(name, group)| {
        let parts = 1 << group.dim;
        let elements = group
            .elements
            .iter()
            .flat_map(|&ElementId { block, index }| {
                (parts * index..parts * (index + 1)).map(move |index| ElementId { block, index })
            });
        (name.clone(), Group::new(group.dim, elements.collect()))
    });
    Ok(Mesh {
        dim: mesh.dim,
        blocks: blocks.collect(),
        groups: groups.collect(),
        nodes: raised.nodes,
    })
}

/// Whether [`refine`] takes all elements of a mesh.
pub fn is_refinable(mesh: &Mesh) -> bool {
    without_parts(mesh).is_none()
}

/// A kind of the mesh whose elements are not cut.
fn without_parts(mesh: &Mesh) -> Option<Kind> {
    use Kind::{Bar2, Hex8, Point1, Quad4, Tet4, Tri3};
    let is_cut = |kind: &Kind| matches!(kind, Point1 | Bar2 | Tri3 | Quad4 | Tet4 | Hex8);
    let mut kinds = mesh.blocks.iter().map(|block| block.kind);
    kinds.find(|kind| !is_cut(kind))
}

/// The linear parts of quadratic elements with nodes at these positions.
fn cut(block: &Block, positions: &[[f64; 3]]) -> Block {
    let table = block.kind.table();
    let kind = table.linear;
    let corners = kind.table().nodes;
    let mut parts: Vec<usize> = (0..corners)
        .flat_map(|a| (0..corners).map(move |b| between(table, a, b)))
        .collect();
    if kind == Kind::Tri3 {
        parts.extend([3, 4, 5]);
    }
    let mut nodes = Vec::new();
    for element in block.nodes.chunks_exact(table.nodes) {
        nodes.extend(parts.iter().map(|&a| element[a]));
        if kind == Kind::Tet4 {
            let [from, to, round @ ..] = shortest(element, positions);
            for i in 0..4 {
                nodes.extend([from, to, round[i], round[(i + 1) % 4]]);
            }
        }
    }
    Block { kind, nodes }
}

/// The node of a quadratic element half-way between two corners in the reference cell, or the corner if they are the same.
fn between(table: &Element, a: usize, b: usize) -> usize {
    let half = [0, 1, 2].map(|i| 0.5 * (table.reference[a][i] + table.reference[b][i]));
    let place = table.reference.iter().position(|x| *x == half);
    place.unwrap_or(a)
}

/// The octahedron in a tet10 about its shortest diagonal, of equal ones the first.
fn shortest(element: &[u32], positions: &[[f64; 3]]) -> [u32; 6] {
    let ways = OCTAHEDRON.map(|way| way.map(|a| element[a]));
    let length = |way: &[u32; 6]| {
        let [a, b] = [way[0], way[1]].map(|node| positions[node as usize]);
        (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>()
    };
    let [mut best, second, third] = ways;
    for way in [second, third] {
        if length(&way) < length(&best) {
            best = way;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::generate::{box_, line, rectangle};
    use crate::{Surface, gather};
    use carom_elements::{MAX_NODES, map};

    /// Moves nodes so that no cell is affine.
    fn bent(mut mesh: Mesh) -> Mesh {
        let amount = [0.05, 0.04, 0.03];
        for x in &mut mesh.nodes {
            let [a, b, c] = *x;
            let by = [
                (5.0 * b + c).sin(),
                (4.0 * c + a).sin(),
                (3.0 * a + b).sin(),
            ];
            for i in 0..mesh.dim {
                x[i] += amount[i] * by[i];
            }
        }
        mesh
    }

    /// The integral over each element of a group: of one over cells, of the normal over facets.
    fn integrals(mesh: &Mesh, group: &str) -> Vec<[f64; 3]> {
        let of = |&id: &ElementId| {
            let (mut x, mut dn) = ([[0.0; 3]; MAX_NODES], [[0.0; 3]; MAX_NODES]);
            let x = gather(&mesh.nodes, mesh.element_nodes(id), &mut x);
            let table = mesh.kind(id).table();
            let (dn, rule) = (&mut dn[..table.nodes], table.mass_rule);
            let mut sum = [0.0; 3];
            for (xi, w) in rule.points.iter().zip(rule.weights) {
                (table.gradient)(xi, dn);
                let at = match table.dim == mesh.dim {
                    true => [map::jacobian(x, dn, table.dim).1, 0.0, 0.0],
                    false => {
                        let (factor, normal) = map::measure(x, dn, table.dim);
                        normal.map(|n| factor * n)
                    }
                };
                sum = [0, 1, 2].map(|i| sum[i] + w * at[i]);
            }
            sum
        };
        mesh.groups[group].elements.iter().map(of).collect()
    }

    /// Parts have the integral of their element: both are polynomials that the rule takes exactly.
    fn assert_filled(mesh: &Mesh, fine: &Mesh, group: &str) {
        let (coarse, parts) = (integrals(mesh, group), integrals(fine, group));
        let parts = parts.chunks_exact(1 << mesh.groups[group].dim);
        assert_eq!(parts.len(), coarse.len());
        for (whole, parts) in coarse.iter().zip(parts) {
            for i in 0..3 {
                let sum: f64 = parts.iter().map(|part| part[i]).sum();
                assert!((whole[i] - sum).abs() < 1e-15, "{group}: {whole:?}");
            }
        }
    }

    fn samples() -> Vec<(Mesh, usize)> {
        // with the number of nodes after one cut: those of the grid of half the size
        vec![
            (line("a", [0.0; 3], [2.0, 0.0, 0.0], 3, 1), 7),
            (
                bent(rectangle("a", [0.0; 2], [2.0, 1.0], [3, 2], false)),
                35,
            ),
            (bent(rectangle("a", [0.0; 2], [2.0, 1.0], [3, 2], true)), 35),
            (
                bent(box_("a", [0.0; 3], [1.0, 2.0, 1.0], [2, 3, 1], false)),
                105,
            ),
            (
                bent(box_("a", [0.0; 3], [1.0, 2.0, 1.0], [2, 3, 1], true)),
                105,
            ),
        ]
    }

    #[test]
    fn parts_fill_their_element_and_neighbours_share_nodes() {
        for (mesh, nodes) in samples() {
            let fine = refine(&mesh).unwrap();
            // one node at each place: what neighbours do not share would be there twice
            let places = fine
                .nodes
                .iter()
                .map(|x| x.map(|x| (x * 1e9).round() as i64));
            assert_eq!(places.collect::<BTreeSet<_>>().len(), nodes);
            assert_eq!(fine.nodes.len(), nodes);
            assert_eq!(fine.nodes[..mesh.nodes.len()], mesh.nodes);
            let cells = &fine.groups["a"].elements;
            assert_eq!(fine.check(cells), []);
            assert_filled(&mesh, &fine, "a");
        }
    }

    #[test]
    fn groups_of_sides_bound_the_parts_and_nothing_else_does() {
        for (mesh, _) in samples() {
            let fine = refine(&mesh).unwrap();
            assert!(fine.groups.keys().eq(mesh.groups.keys()));
            let cells = &fine.groups["a"].elements;
            let sides: Vec<_> = fine
                .groups
                .iter()
                .filter(|(name, _)| *name != "a")
                .collect();
            let mut facets = BTreeSet::new();
            for (name, group) in &sides {
                let surface = Surface::new(&fine, group, cells);
                assert!(surface.is_ok(), "{name}: {surface:?}");
                for &id in &group.elements {
                    facets.insert(sorted(fine.element_nodes(id)));
                }
                assert_filled(&mesh, &fine, name);
            }
            assert_eq!(single_faces(&fine, cells), facets);
        }
    }

    /// The faces that only one of the cells has.
    fn single_faces(mesh: &Mesh, cells: &[ElementId]) -> BTreeSet<Vec<u32>> {
        let mut single = BTreeSet::new();
        for &cell in cells {
            let nodes = mesh.element_nodes(cell);
            for face in mesh.kind(cell).table().faces {
                let face: Vec<u32> = face.nodes.iter().map(|&a| nodes[a]).collect();
                let face = sorted(&face);
                if !single.remove(&face) {
                    single.insert(face);
                }
            }
        }
        single
    }

    fn sorted(nodes: &[u32]) -> Vec<u32> {
        let mut nodes = nodes.to_vec();
        nodes.sort_unstable();
        nodes
    }

    #[test]
    fn tetrahedra_do_not_get_flatter_with_every_cut() {
        let mut mesh = Mesh::new(3);
        mesh.nodes = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.2, 1.3, 0.0], [0.9, 0.3, 1.1]];
        let id = mesh.push(Kind::Tet4, &[0, 1, 2, 3]);
        mesh.groups.insert("a".to_owned(), Group::new(3, vec![id]));
        // least volume over the cube of the longest edge: kept here but for round-off; about the longest diagonals it falls to 3 %
        let mut flattest = Vec::new();
        for _ in 0..5 {
            let cells = mesh.groups["a"].elements.iter().zip(integrals(&mesh, "a"));
            let quality = cells.map(|(&id, [volume, ..])| {
                let x = mesh.element_nodes(id).iter();
                let x: Vec<_> = x.map(|&node| mesh.nodes[node as usize]).collect();
                let square = |a: &[f64; 3], b: &[f64; 3]| -> f64 {
                    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum()
                };
                let pairs = x.iter().flat_map(|a| x.iter().map(move |b| square(a, b)));
                volume / pairs.fold(0.0, f64::max).powf(1.5)
            });
            flattest.push(quality.fold(f64::MAX, f64::min));
            mesh = refine(&mesh).unwrap();
        }
        assert!(flattest[4] > 0.999 * flattest[0], "{flattest:?}");
    }

    #[test]
    fn quadratic_elements_wedges_and_pyramids_are_not_cut() {
        let raised = raise(&rectangle("a", [0.0; 2], [1.0; 2], [1, 1], false), true).unwrap();
        assert!(matches!(refine(&raised), Err(Error::NoRefinement { .. })));
        for kind in [Kind::Wedge6, Kind::Pyramid5] {
            let mut mesh = Mesh::new(3);
            mesh.nodes = kind.table().reference.to_vec();
            let nodes: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
            mesh.push(kind, &nodes);
            assert_eq!(refine(&mesh), Err(Error::NoRefinement { kind }));
        }
    }
}
