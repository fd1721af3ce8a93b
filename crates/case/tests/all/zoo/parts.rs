//! Bodies of a few cells, turned and sheared in space, and the Gmsh file that has them.

use std::fmt::Write;

/// A place, or a direction in space.
pub type Vec3 = [f64; 3];

/// What cells a part has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cells {
    /// Lines of two nodes, for beams.
    Lines,
    /// Triangles of three nodes, in the plane.
    Triangles,
    /// Quadrilaterals of four nodes, in the plane.
    Squares,
    /// Quadrilaterals of four nodes in space, for shells.
    Shells,
    /// Tetrahedra of four nodes.
    Tetrahedra,
    /// Hexahedra of eight nodes.
    Bricks,
}

impl Cells {
    /// The number that Gmsh has for the type.
    fn of_gmsh(self) -> u32 {
        match self {
            Cells::Lines => 1,
            Cells::Triangles => 2,
            Cells::Squares | Cells::Shells => 3,
            Cells::Tetrahedra => 4,
            Cells::Bricks => 5,
        }
    }

    /// Dimension of a cell.
    fn dim(self) -> usize {
        match self {
            Cells::Lines => 1,
            Cells::Triangles | Cells::Squares | Cells::Shells => 2,
            Cells::Tetrahedra | Cells::Bricks => 3,
        }
    }

    /// Whether bodies of such cells lie in the plane.
    pub fn are_plane(self) -> bool {
        matches!(self, Cells::Triangles | Cells::Squares)
    }

    /// Whether its cells are a line or a surface with a section around it.
    pub fn have_section(self) -> bool {
        matches!(self, Cells::Lines | Cells::Shells)
    }

    /// The sides of a cell, each by the places of its corners in the cell; a line and a cell of a shell are their own sides.
    fn sides(self) -> &'static [&'static [usize]] {
        match self {
            Cells::Lines => &[&[0, 1]],
            Cells::Triangles => &[&[0, 1], &[1, 2], &[2, 0]],
            Cells::Squares => &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
            Cells::Shells => &[&[0, 1, 2, 3]],
            Cells::Tetrahedra => &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]],
            Cells::Bricks => &[
                &[0, 3, 2, 1],
                &[4, 5, 6, 7],
                &[0, 1, 5, 4],
                &[1, 2, 6, 5],
                &[2, 3, 7, 6],
                &[3, 0, 4, 7],
            ],
        }
    }
}

/// A part of the mesh, which is a body.
#[derive(Clone, Debug)]
pub struct Part {
    /// What cells it has.
    pub cells: Cells,
    /// Places of its nodes, m.
    pub nodes: Vec<Vec3>,
    /// Nodes of each cell.
    pub corners: Vec<Vec<usize>>,
    /// Radius of the section of a beam, half of the thickness of a shell, m; zero of all others.
    pub radius: f64,
}

impl Part {
    /// A box around the origin with sides along the axes, of `count` bricks along each.
    pub fn bricks(size: Vec3, count: [usize; 3]) -> Part {
        let [nx, ny, nz] = count;
        let node = |i: usize, j: usize, k: usize| i + (nx + 1) * (j + (ny + 1) * k);
        let mut nodes = vec![[0.0; 3]; node(nx, ny, nz) + 1];
        let mut corners = Vec::new();
        for k in 0..=nz {
            for j in 0..=ny {
                for i in 0..=nx {
                    let part = [
                        i as f64 / nx as f64,
                        j as f64 / ny as f64,
                        k as f64 / nz as f64,
                    ];
                    nodes[node(i, j, k)] = [0, 1, 2].map(|axis| (part[axis] - 0.5) * size[axis]);
                    if i < nx && j < ny && k < nz {
                        let layer = |k: usize| {
                            [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                                .map(|(i, j)| node(i, j, k))
                        };
                        corners.push([layer(k), layer(k + 1)].concat());
                    }
                }
            }
        }
        Part {
            cells: Cells::Bricks,
            nodes,
            corners,
            radius: 0.0,
        }
    }

    /// The same in the plane.
    pub fn squares(size: [f64; 2], count: [usize; 2]) -> Part {
        let flat = Part::bricks([size[0], size[1], 0.0], [count[0], count[1], 1]);
        let lower = flat.nodes.len() / 2;
        Part {
            cells: Cells::Squares,
            nodes: flat.nodes[..lower]
                .iter()
                .map(|x| [x[0], x[1], 0.0])
                .collect(),
            corners: flat.corners.iter().map(|cell| cell[..4].to_vec()).collect(),
            radius: 0.0,
        }
    }

    /// A wedge in the plane whose tip, below, is at the origin: two triangles.
    pub fn wedge(width: f64, height: f64) -> Part {
        let [left, right] = [-0.5, 0.5].map(|side| [side * width, height, 0.0]);
        Part {
            cells: Cells::Triangles,
            nodes: vec![[0.0; 3], right, [0.0, height, 0.0], left],
            corners: vec![vec![0, 1, 2], vec![0, 2, 3]],
            radius: 0.0,
        }
    }

    /// A tetrahedron whose tip, below, is at the origin, under a regular triangle with the given radius to its corners.
    pub fn tetrahedron(radius: f64, height: f64) -> Part {
        let corner = |k: usize| {
            let angle = std::f64::consts::TAU * k as f64 / 3.0;
            [radius * angle.cos(), radius * angle.sin(), height]
        };
        Part {
            cells: Cells::Tetrahedra,
            nodes: vec![corner(0), corner(2), corner(1), [0.0; 3]],
            corners: vec![vec![0, 1, 2, 3]],
            radius: 0.0,
        }
    }

    /// A beam along x with its middle at the origin.
    pub fn rod(length: f64, count: usize, radius: f64) -> Part {
        let place = |k: usize| [(k as f64 / count as f64 - 0.5) * length, 0.0, 0.0];
        Part {
            cells: Cells::Lines,
            nodes: (0..=count).map(place).collect(),
            corners: (0..count).map(|k| vec![k, k + 1]).collect(),
            radius,
        }
    }

    /// The same with its nodes mapped; the map keeps orientations.
    pub fn mapped(mut self, map: impl Fn(Vec3) -> Vec3) -> Part {
        for node in &mut self.nodes {
            *node = map(*node);
        }
        self
    }

    /// The same turned about an axis through the origin by an angle, rad.
    pub fn turned(self, axis: Vec3, angle: f64) -> Part {
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        let n = axis.map(|x| x / length);
        let (sin, cos) = angle.sin_cos();
        self.mapped(|x| {
            let along: f64 = (0..3).map(|i| n[i] * x[i]).sum();
            let across = [
                n[1] * x[2] - n[2] * x[1],
                n[2] * x[0] - n[0] * x[2],
                n[0] * x[1] - n[1] * x[0],
            ];
            [0, 1, 2].map(|i| cos * x[i] + sin * across[i] + (1.0 - cos) * along * n[i])
        })
    }

    /// The same moved.
    pub fn shifted(self, by: Vec3) -> Part {
        self.mapped(|x| [0, 1, 2].map(|i| x[i] + by[i]))
    }

    /// The axis that is up.
    pub fn up(&self) -> usize {
        match self.cells.are_plane() {
            true => 1,
            false => 2,
        }
    }

    /// Least and largest coordinate of its surface along an axis, m.
    pub fn extent(&self, axis: usize) -> [f64; 2] {
        let at = self.nodes.iter().map(|x| x[axis]);
        let least = at.clone().fold(f64::INFINITY, f64::min);
        let largest = at.fold(f64::NEG_INFINITY, f64::max);
        [least - self.radius, largest + self.radius]
    }

    /// The same moved along an axis, so that its surface begins there at `least` (m).
    pub fn starting(self, axis: usize, least: f64) -> Part {
        let mut by = [0.0; 3];
        by[axis] = least - self.extent(axis)[0];
        self.shifted(by)
    }

    /// Its outer sides: those that one cell alone has.
    pub fn sides(&self) -> Vec<Vec<usize>> {
        let mut all: Vec<Vec<usize>> = Vec::new();
        for cell in &self.corners {
            let sides = self.cells.sides().iter();
            all.extend(sides.map(|side| side.iter().map(|&k| cell[k]).collect()));
        }
        let sorted = |side: &Vec<usize>| {
            let mut side = side.clone();
            side.sort_unstable();
            side
        };
        let keys: Vec<Vec<usize>> = all.iter().map(sorted).collect();
        let outer = all.into_iter().zip(&keys);
        let outer = outer.filter(|(_, key)| keys.iter().filter(|other| other == key).count() == 1);
        outer.map(|(side, _)| side).collect()
    }
}

/// A file of Gmsh's format 2.2 with these parts: the cells of each are a group of its name, and the outer sides of plane and solid parts one of the
/// name and `-skin`. Nodes are in the order of the parts.
pub fn gmsh(parts: &[(&str, &Part)]) -> String {
    let mut names = Vec::new();
    let mut nodes = Vec::new();
    let mut elements = Vec::new();
    for (number, (name, part)) in parts.iter().enumerate() {
        let first = nodes.len() + 1;
        nodes.extend(part.nodes.iter().copied());
        let skin = match part.cells {
            Cells::Lines | Cells::Shells => None,
            Cells::Triangles | Cells::Squares => Some((1, Cells::Lines.of_gmsh())),
            Cells::Tetrahedra => Some((2, Cells::Triangles.of_gmsh())),
            Cells::Bricks => Some((2, Cells::Squares.of_gmsh())),
        };
        let of_cells = (2 * number + 1, part.cells.of_gmsh());
        names.push(format!("{} {} \"{name}\"", part.cells.dim(), of_cells.0));
        let mut push = |(group, kind): (usize, u32), corners: &[Vec<usize>]| {
            for corners in corners {
                let tags: Vec<String> = corners.iter().map(|k| (first + k).to_string()).collect();
                elements.push(format!("{kind} 2 {group} {group} {}", tags.join(" ")));
            }
        };
        push(of_cells, &part.corners);
        if let Some((dim, kind)) = skin {
            names.push(format!("{dim} {} \"{name}-skin\"", of_cells.0 + 1));
            push((of_cells.0 + 1, kind), &part.sides());
        }
    }
    let mut text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n".to_owned();
    let lines = |rows: Vec<String>| rows.join("\n");
    writeln!(
        text,
        "$PhysicalNames\n{}\n{}\n$EndPhysicalNames",
        names.len(),
        lines(names)
    )
    .unwrap();
    let numbered = |rows: Vec<String>| {
        let rows = rows.into_iter().zip(1..);
        lines(
            rows.map(|(row, number)| format!("{number} {row}"))
                .collect(),
        )
    };
    let places = nodes.iter().map(|[x, y, z]| format!("{x:?} {y:?} {z:?}"));
    writeln!(
        text,
        "$Nodes\n{}\n{}\n$EndNodes",
        nodes.len(),
        numbered(places.collect())
    )
    .unwrap();
    writeln!(
        text,
        "$Elements\n{}\n{}\n$EndElements",
        elements.len(),
        numbered(elements)
    )
    .unwrap();
    text
}
