//! Meshes of lines, rectangles and boxes.
//!
//! Every generator names its cells after the part (`name`) and its sides after the part and the side
//! (`name.left`). Sides are facet elements turned outward. Nodes are numbered along x first, then y, then z.
//! Subdivisions and sizes must be positive; a subdivision of zero gives a mesh without cells.

use carom_elements::Kind;

use crate::{ElementId, Group, Mesh};

/// A straight line of `n` equal two-node bars from one point to another, in a space of `dim` dimensions.
///
/// Groups: `name` the bars, `name.left` the point at `from`, `name.right` the point at `to`. Coordinates in m;
/// those beyond `dim` must be zero.
pub fn line(name: &str, from: [f64; 3], to: [f64; 3], n: usize, dim: usize) -> Mesh {
    let mut mesh = Mesh::new(dim);
    for i in 0..=n {
        let t = i as f64 / n.max(1) as f64;
        let x = [0, 1, 2].map(|c| (1.0 - t) * from[c] + t * to[c]);
        mesh.nodes.push(x);
    }
    let cells = (0..n as u32)
        .map(|i| mesh.push(Kind::Bar2, &[i, i + 1]))
        .collect();
    mesh.groups.insert(name.to_owned(), Group::new(1, cells));
    for (side, node) in [("left", 0), ("right", n as u32)] {
        let point = mesh.push(Kind::Point1, &[node]);
        let group = Group::new(0, vec![point]);
        mesh.groups.insert(format!("{name}.{side}"), group);
    }
    mesh
}

/// A rectangle with sides along the axes, cut into `n[0]` by `n[1]` quadrilaterals, or each of them into two
/// `triangles`.
///
/// `origin`: its corner of least x and y, in m; `size` in m, positive. Groups: `name` the cells, `name.left` and
/// `name.right` (least and largest x), `name.bottom` and `name.top` (least and largest y).
pub fn rectangle(
    name: &str,
    origin: [f64; 2],
    size: [f64; 2],
    n: [usize; 2],
    triangles: bool,
) -> Mesh {
    let grid = Grid {
        dim: 2,
        origin: [origin[0], origin[1], 0.0],
        size: [size[0], size[1], 0.0],
        n: [n[0], n[1], 0],
    };
    let sides = ["left", "right", "bottom", "top"];
    match triangles {
        false => grid.mesh(name, Kind::Quad4, &[&[0, 1, 2, 3]], &sides),
        true => grid.mesh(name, Kind::Tri3, &[&[0, 1, 2], &[0, 2, 3]], &sides),
    }
}

/// A box with sides along the axes, cut into `n[0]` by `n[1]` by `n[2]` hexahedra, or each of them into six
/// tetrahedra (`tets`) around its diagonal, which match across neighbours.
///
/// `origin`: its corner of least x, y and z, in m; `size` in m, positive. Groups: `name` the cells, `name.left` and
/// `name.right` (least and largest x), `name.front` and `name.back` (y), `name.bottom` and `name.top` (z).
pub fn box_(name: &str, origin: [f64; 3], size: [f64; 3], n: [usize; 3], tets: bool) -> Mesh {
    let grid = Grid {
        dim: 3,
        origin,
        size,
        n,
    };
    let sides = ["left", "right", "front", "back", "bottom", "top"];
    match tets {
        false => grid.mesh(name, Kind::Hex8, &[&[0, 1, 2, 3, 4, 5, 6, 7]], &sides),
        true => grid.mesh(name, Kind::Tet4, &KUHN, &sides),
    }
}

/// The six tetrahedra of a cube around the diagonal from node 0 to node 6, one per order in which the three axes
/// can be walked. Kuhn (1960).
const KUHN: [&[usize]; 6] = [
    &[0, 1, 2, 6],
    &[0, 3, 7, 6],
    &[0, 4, 5, 6],
    &[0, 5, 1, 6],
    &[0, 2, 3, 6],
    &[0, 7, 4, 6],
];

/// Steps along the axes from the first node of a grid cell to the others, in the order of hex8 (and of quad4).
const CORNERS: [[usize; 3]; 8] = [
    [0, 0, 0],
    [1, 0, 0],
    [1, 1, 0],
    [0, 1, 0],
    [0, 0, 1],
    [1, 0, 1],
    [1, 1, 1],
    [0, 1, 1],
];

/// A structured grid; in two dimensions it has one layer of nodes along the third axis.
struct Grid {
    dim: usize,
    origin: [f64; 3],
    size: [f64; 3],
    n: [usize; 3],
}

impl Grid {
    /// The mesh of a grid whose cells are each cut into `parts` of one kind, given by corners of the cell.
    /// `sides`: names of the ends along the first axis, then along the second, then along the third.
    fn mesh(&self, name: &str, kind: Kind, parts: &[&[usize]], sides: &[&str]) -> Mesh {
        let mut mesh = Mesh::new(self.dim);
        for place in places(self.n.map(|n| n + 1)) {
            mesh.nodes.push(self.point(place));
        }
        let mut cells = Vec::new();
        let layers = if self.dim == 2 { 1 } else { self.n[2] };
        for place in places([self.n[0], self.n[1], layers]) {
            for part in parts {
                let nodes: Vec<u32> = part
                    .iter()
                    .map(|&corner| self.node([0, 1, 2].map(|i| place[i] + CORNERS[corner][i])))
                    .collect();
                cells.push(mesh.push(kind, &nodes));
            }
        }
        for (i, side) in sides.iter().enumerate() {
            let (axis, end) = (i / 2, if i % 2 == 0 { 0 } else { self.n[i / 2] });
            let facets = self.facets(&mut mesh, &cells, axis, end);
            let group = Group::new(self.dim - 1, facets);
            mesh.groups.insert(format!("{name}.{side}"), group);
        }
        let group = Group::new(self.dim, cells);
        mesh.groups.insert(name.to_owned(), group);
        mesh
    }

    /// Adds the faces of the cells that lie wholly in one layer of nodes.
    fn facets(
        &self,
        mesh: &mut Mesh,
        cells: &[ElementId],
        axis: usize,
        layer: usize,
    ) -> Vec<ElementId> {
        let mut facets = Vec::new();
        for &cell in cells {
            for face in mesh.kind(cell).table().faces {
                let nodes = mesh.element_nodes(cell);
                let nodes: Vec<u32> = face.nodes.iter().map(|&a| nodes[a]).collect();
                if nodes.iter().all(|&node| self.place(node)[axis] == layer) {
                    facets.push(mesh.push(face.kind, &nodes));
                }
            }
        }
        facets
    }

    fn node(&self, place: [usize; 3]) -> u32 {
        let [nx, ny, _] = self.n;
        (place[0] + (nx + 1) * (place[1] + (ny + 1) * place[2])) as u32
    }

    fn place(&self, node: u32) -> [usize; 3] {
        let [nx, ny, _] = self.n;
        let row = node as usize / (nx + 1);
        [node as usize % (nx + 1), row % (ny + 1), row / (ny + 1)]
    }

    fn point(&self, place: [usize; 3]) -> [f64; 3] {
        [0, 1, 2].map(|i| {
            let t = place[i] as f64 / self.n[i].max(1) as f64;
            self.origin[i] + t * self.size[i]
        })
    }
}

/// All triples below these counts, the first running fastest.
fn places(counts: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    (0..counts[2])
        .flat_map(move |k| (0..counts[1]).map(move |j| (j, k)))
        .flat_map(move |(j, k)| (0..counts[0]).map(move |i| [i, j, k]))
}

#[cfg(test)]
mod tests {
    use carom_elements::{MAX_NODES, map};

    use super::*;
    use crate::{Surface, gather};

    /// ∫ dΩ over a group, by the rule of the cells.
    fn measure(mesh: &Mesh, group: &str) -> f64 {
        let mut sum = 0.0;
        for &id in &mesh.groups[group].elements {
            let table = mesh.kind(id).table();
            let (mut x, mut dn) = ([[0.0; 3]; MAX_NODES], [[0.0; 3]; MAX_NODES]);
            let x = gather(&mesh.nodes, mesh.element_nodes(id), &mut x);
            let rule = table.stiffness_rule;
            for (xi, weight) in rule.points.iter().zip(rule.weights) {
                (table.gradient)(xi, &mut dn[..table.nodes]);
                let dn = &dn[..table.nodes];
                sum += weight
                    * match table.dim {
                        3 => map::jacobian(x, dn, 3).1,
                        dim => map::measure(x, dn, dim).0,
                    };
            }
        }
        sum
    }

    /// The integral of the outward normal over a side.
    fn normal_area(mesh: &Mesh, name: &str, side: &str) -> [f64; 3] {
        let facets = &mesh.groups[&format!("{name}.{side}")];
        let cells = &mesh.groups[name].elements;
        let surface = Surface::new(mesh, facets, cells).unwrap();
        let mut sum = [0.0; 3];
        for face in &surface.faces {
            let table = face.kind.table();
            let (mut x, mut dn) = ([[0.0; 3]; MAX_NODES], [[0.0; 3]; MAX_NODES]);
            let x = gather(&mesh.nodes, face.corners(), &mut x);
            let rule = table.stiffness_rule;
            for (xi, weight) in rule.points.iter().zip(rule.weights) {
                (table.gradient)(xi, &mut dn[..table.nodes]);
                let (factor, normal) = map::measure(x, &dn[..table.nodes], table.dim);
                for i in 0..3 {
                    sum[i] += weight * factor * normal[i];
                }
            }
        }
        sum
    }

    fn assert_close(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-13, "{a} {b}");
    }

    fn assert_sound(mesh: &Mesh, name: &str) {
        assert_eq!(mesh.check(&mesh.groups[name].elements), []);
        let used = mesh.group_nodes(&mesh.groups[name]);
        assert_eq!(used.len(), mesh.nodes.len());
    }

    #[test]
    fn a_line_has_its_length_and_its_ends_look_outward() {
        let (from, to) = ([1.0, 2.0, -1.0], [2.0, 4.0, 1.0]);
        let mesh = line("bar", from, to, 7, 3);
        assert_sound(&mesh, "bar");
        assert_eq!(mesh.groups["bar"].elements.len(), 7);
        assert_close(measure(&mesh, "bar"), 3.0);
        assert_eq!((mesh.nodes[0], mesh.nodes[7]), (from, to));
        for (side, node, sign) in [("bar.left", 0, -1.0), ("bar.right", 7, 1.0)] {
            let facets = &mesh.groups[side];
            let surface = Surface::new(&mesh, facets, &mesh.groups["bar"].elements).unwrap();
            assert_eq!(surface.nodes, [node]);
            assert_eq!(surface.faces[0].corners(), [node]);
            for (axis, expected) in surface.faces[0].axis.iter().zip([1.0, 2.0, 2.0]) {
                assert_close(*axis, sign * expected / 3.0);
            }
            assert_eq!(surface.node_areas(&mesh, |_| 1.0), [1.0]);
        }
    }

    #[test]
    fn a_rectangle_has_its_area_and_its_sides_look_outward() {
        for triangles in [false, true] {
            let mesh = rectangle("plate", [-1.0, 2.0], [3.0, 0.5], [6, 2], triangles);
            assert_sound(&mesh, "plate");
            assert_eq!((mesh.dim, mesh.nodes.len()), (2, 21));
            assert_eq!(mesh.groups["plate"].elements.len(), 12 << triangles as u32);
            assert_close(measure(&mesh, "plate"), 1.5);
            let sides = [
                ("left", [-0.5, 0.0]),
                ("right", [0.5, 0.0]),
                ("bottom", [0.0, -3.0]),
                ("top", [0.0, 3.0]),
            ];
            for (side, expected) in sides {
                let found = normal_area(&mesh, "plate", side);
                (0..2).for_each(|i| assert_close(found[i], expected[i]));
                let length = expected[0].abs() + expected[1].abs();
                assert_close(measure(&mesh, &format!("plate.{side}")), length);
            }
        }
    }

    #[test]
    fn a_box_has_its_volume_and_its_sides_look_outward() {
        for tets in [false, true] {
            let mesh = box_("block", [1.0, 2.0, 3.0], [2.0, 1.0, 0.5], [3, 2, 4], tets);
            assert_sound(&mesh, "block");
            assert_eq!((mesh.dim, mesh.nodes.len()), (3, 60));
            let cells = if tets { 6 * 24 } else { 24 };
            assert_eq!(mesh.groups["block"].elements.len(), cells);
            assert_close(measure(&mesh, "block"), 1.0);
            let sides = [
                ("left", [-0.5, 0.0, 0.0]),
                ("right", [0.5, 0.0, 0.0]),
                ("front", [0.0, -1.0, 0.0]),
                ("back", [0.0, 1.0, 0.0]),
                ("bottom", [0.0, 0.0, -2.0]),
                ("top", [0.0, 0.0, 2.0]),
            ];
            for (side, expected) in sides {
                let found = normal_area(&mesh, "block", side);
                (0..3).for_each(|i| assert_close(found[i], expected[i]));
                let area: f64 = expected.iter().map(|x: &f64| x.abs()).sum();
                assert_close(measure(&mesh, &format!("block.{side}")), area);
            }
        }
    }

    #[test]
    fn neighbours_match_every_face_of_a_cell_is_outside_or_shared_once() {
        let boxes = [false, true].map(|tets| box_("a", [0.0; 3], [1.0; 3], [2, 3, 2], tets));
        let plates = [false, true].map(|tri| rectangle("a", [0.0; 2], [1.0; 2], [3, 2], tri));
        for mesh in boxes.iter().chain(&plates) {
            let mut seen = std::collections::BTreeMap::new();
            for &id in &mesh.groups["a"].elements {
                let nodes = mesh.element_nodes(id);
                for face in mesh.kind(id).table().faces {
                    let mut key: Vec<u32> = face.nodes.iter().map(|&a| nodes[a]).collect();
                    key.sort_unstable();
                    *seen.entry(key).or_insert(0) += 1;
                }
            }
            let sides = mesh.groups.iter().filter(|(name, _)| *name != "a");
            let outside: usize = sides.map(|(_, group)| group.elements.len()).sum();
            assert_eq!(seen.values().filter(|&&n| n == 1).count(), outside);
            assert!(seen.values().all(|&n| n == 1 || n == 2));
        }
    }
}
