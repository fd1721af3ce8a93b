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
