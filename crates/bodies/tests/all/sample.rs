//! Small distorted bodies, and the dense algebra with which they are judged.

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::unknowns::Unknowns;
use carom_bodies::{BodySpec, CellWeights, Formulation, Kinematics, Scratch, Solid};
use carom_elements::Kind;
use carom_materials::{Elastic, Law};
use carom_mesh::{ElementId, Mesh, generate, raise};
use carom_testing::Random;

/// Numbers of order one, so that tolerances are plain.
pub const MATERIAL: Elastic = Elastic {
    density: 1.7,
    young: 2.3,
    poisson: 0.31,
};

pub const THICKNESS: f64 = 0.7;
pub const AREA: f64 = 0.6;

/// A body whose nodes are numbered backwards, beside a node that belongs to nobody.
pub struct Sample {
    pub name: String,
    pub mesh: Mesh,
    pub body: Solid,
    pub formulation: Formulation,
    /// System number of each mesh node.
    pub number: Vec<u32>,
    /// Unknowns.
    pub n: usize,
    /// Coordinates by system number.
    pub x: Vec<[f64; 3]>,
}

impl Sample {
    pub fn new(name: &str, mesh: Mesh, kinematics: Kinematics) -> Sample {
        Sample::of(name, mesh, kinematics, MATERIAL.into(), Formulation::Full)
    }

    pub fn of(
        name: &str,
        mut mesh: Mesh,
        kinematics: Kinematics,
        material: Law,
        formulation: Formulation,
    ) -> Sample {
        let used = mesh.nodes.len();
        mesh.nodes.push([9.0, 0.0, 0.0]);
        let mut number: Vec<u32> = (0..used as u32).rev().collect();
        number.push(u32::MAX);
        let cells = cells(&mesh, kinematics.dim());
        let spec = BodySpec {
            formulation,
            ..BodySpec::new(name, cells, kinematics, material)
        };
        Sample {
            name: format!("{name}, {}", kinematics.name()),
            body: Solid::new(
                &mesh,
                spec,
                &number,
                &Unknowns::translations(mesh.dim, used),
            )
            .unwrap(),
            n: mesh.dim * used,
            x: mesh.nodes[..used].iter().rev().copied().collect(),
            mesh,
            number,
            formulation,
        }
    }

    /// Of the nodes of the body.
    pub fn unknowns(&self) -> Unknowns {
        Unknowns::translations(self.mesh.dim, self.x.len())
    }

    /// The same body with weights.
    pub fn weighted(self, weights: CellWeights) -> Sample {
        let kinematics = self.body.kinematics();
        let spec = BodySpec {
            formulation: self.formulation,
            weights: Some(weights),
            ..BodySpec::new(
                self.name.clone(),
                cells(&self.mesh, kinematics.dim()),
                kinematics,
                *self.body.material(),
            )
        };
        let body = Solid::new(&self.mesh, spec, &self.number, &self.unknowns()).unwrap();
        let name = format!("{}, weighted", self.name);
        Sample { name, body, ..self }
    }

    /// Values of `of(x)` at the nodes of each cell, cell after cell.
    pub fn at_cells(&self, of: impl Fn(&[f64; 3]) -> f64) -> Vec<f64> {
        let cells = cells(&self.mesh, self.body.kinematics().dim());
        let nodes = cells.iter().flat_map(|&cell| self.mesh.element_nodes(cell));
        nodes
            .map(|&node| of(&self.mesh.nodes[node as usize]))
            .collect()
    }

    /// As many weights between 0 and 1 as the cells have nodes, no two alike.
    pub fn random_weights(&self, seed: u64) -> CellWeights {
        let count = self.at_cells(|_| 0.0).len();
        let mut random = Random(seed);
        // between the nodes of a quadratic cell the weight goes beyond those at the nodes
        let mut blocks = self.mesh.blocks.iter();
        let spread = match blocks.any(|block| block.kind.table().is_quadratic()) {
            true => 0.1,
            false => 0.5,
        };
        let mut list = || {
            let list = random.vector(count).into_iter();
            list.map(|w| 0.5 + spread * w).collect::<Vec<_>>()
        };
        CellWeights {
            inertia: list(),
            stiffness: list(),
        }
    }

    pub fn dim(&self) -> usize {
        self.mesh.dim
    }

    /// f(u) and U(u).
    pub fn force(&self, u: &[f64]) -> (Vec<f64>, f64) {
        let mut f = vec![0.0; self.n];
        let energy = self.body.internal_force(u, &mut Scratch::default(), &mut f);
        (f, energy)
    }

    /// A matrix of the body, empty.
    pub fn pattern(&self) -> Csr {
        let dim = self.dim();
        let mut cliques = Cliques::new();
        self.body.each_element(&mut |nodes| {
            let unknowns = nodes
                .iter()
                .flat_map(|&node| (0..dim as u32).map(move |i| dim as u32 * node + i));
            cliques.push(&unknowns.collect::<Vec<_>>());
        });
        Csr::from_cliques(self.n, &cliques)
    }

    /// a K + b M, dense and row-major.
    pub fn matrix(&self, a: f64, b: f64) -> Vec<f64> {
        let mut matrix = self.pattern();
        self.body.assemble(a, b, &(0..self.n), &mut matrix);
        dense(&matrix, self.n)
    }

    pub fn lumped_mass(&self) -> Vec<f64> {
        let mut mass = vec![0.0; self.n];
        self.body.add_lumped_mass(&mut mass);
        mass
    }

    /// System vector of the field `of(x)`.
    pub fn field(&self, of: impl Fn(&[f64; 3]) -> [f64; 3]) -> Vec<f64> {
        let values = self.x.iter().map(of);
        values.flat_map(|v| v[..self.dim()].to_vec()).collect()
    }

    /// Translations and rotations of the space; in axisymmetry the translation along the axis alone.
    pub fn rigid_motions(&self) -> Vec<Vec<f64>> {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        if self.body.kinematics() == Kinematics::Axisymmetric {
            return vec![self.field(|_| axes[1])];
        }
        let mut motions: Vec<_> = axes[..self.dim()]
            .iter()
            .map(|axis| self.field(|_| *axis))
            .collect();
        let rotations = match self.dim() {
            1 => &axes[..0],
            2 => &axes[2..],
            _ => &axes[..],
        };
        motions.extend(rotations.iter().map(|axis| self.field(|x| cross(axis, x))));
        motions
    }
}

/// Row-major.
pub fn dense(matrix: &Csr, n: usize) -> Vec<f64> {
    (0..n * n).map(|k| matrix.get(k / n, k % n)).collect()
}

/// All cells of a dimension.
pub fn cells(mesh: &Mesh, dim: usize) -> Vec<ElementId> {
    let mut cells = Vec::new();
    for (k, block) in mesh.blocks.iter().enumerate() {
        let element = block.kind.table();
        if element.dim == dim {
            let count = (block.nodes.len() / element.nodes) as u32;
            cells.extend((0..count).map(|index| ElementId {
                block: k as u32,
                index,
            }));
        }
    }
    cells
}

/// Every kind with every kinematics that takes it, distorted.
pub fn all() -> Vec<Sample> {
    let mut samples = bars();
    samples.extend(continua());
    samples
}

/// The bodies of [`all`], plain and with random weights.
pub fn plain_and_weighted() -> Vec<Sample> {
    let weighted = all().into_iter().map(|sample| {
        let weights = sample.random_weights(41);
        sample.weighted(weights)
    });
    all().into_iter().chain(weighted).collect()
}

/// A kinked line in one, two and three dimensions.
pub fn bars() -> Vec<Sample> {
    let ends = [[1.0, 0.0, 0.0], [0.6, 1.1, 0.0], [0.6, 1.1, -0.8]];
    let sample = |dim: usize| {
        let mut mesh = generate::line("b", [0.0; 3], ends[dim - 1], 5, dim);
        let mut random = Random(7);
        for x in &mut mesh.nodes {
            x[..dim].iter_mut().for_each(|x| *x += 0.08 * random.next());
        }
        Sample::new(
            &format!("bar2 in {dim}D"),
            mesh,
            Kinematics::Bar { area: AREA },
        )
    };
    (1..=3).map(sample).collect()
}

/// Plane, axisymmetric and solid bodies; one with triangles and quadrilaterals.
pub fn continua() -> Vec<Sample> {
    let samples = shapes().into_iter();
    let sample = |(name, mesh, kinematics)| Sample::new(name, mesh, kinematics);
    samples.map(sample).collect()
}

/// The bodies of [`continua`] before they have a material.
pub fn shapes() -> Vec<(&'static str, Mesh, Kinematics)> {
    let mut samples = Vec::new();
    for kinematics in [
        Kinematics::PlaneStrain {
            thickness: THICKNESS,
        },
        Kinematics::PlaneStress {
            thickness: THICKNESS,
        },
        Kinematics::Axisymmetric,
    ] {
        for (name, mesh) in [
            ("tri3", distorted(rectangle(true))),
            ("quad4", distorted(rectangle(false))),
            ("tri3 and quad4", distorted(mixed())),
            ("tri6", raised(small_rectangle(true), false)),
            ("quad8", raised(small_rectangle(false), false)),
            ("quad9", raised(small_rectangle(false), true)),
        ] {
            samples.push((name, mesh, kinematics));
        }
    }
    for (name, tets) in [("tet4", true), ("hex8", false)] {
        let mesh = generate::box_("b", [0.5, 0.0, 0.0], [1.0, 0.9, 1.2], [2, 2, 3], tets);
        samples.push((name, distorted(mesh), Kinematics::Solid));
    }
    for (name, mesh) in [
        ("tet10", raised(small_box([2, 1, 1], true), false)),
        ("hex20", raised(small_box([2, 2, 2], false), false)),
        ("hex27", raised(small_box([2, 1, 2], false), true)),
        ("wedge6", distorted(wedges(&small_box([2, 2, 2], false)))),
        (
            "wedge15",
            raised(wedges(&small_box([2, 2, 1], false)), false),
        ),
        (
            "pyramid5",
            distorted(pyramids(&small_box([2, 1, 2], false))),
        ),
    ] {
        samples.push((name, mesh, Kinematics::Solid));
    }
    samples
}

/// A coarse mesh for elements of many nodes.
fn small_rectangle(triangles: bool) -> Mesh {
    generate::rectangle("b", [0.5, 0.0], [1.0, 1.2], [2, 2], triangles)
}

fn small_box(n: [usize; 3], tets: bool) -> Mesh {
    generate::box_("b", [0.5, 0.0, 0.0], [1.0, 0.9, 1.2], n, tets)
}

/// The mesh distorted, then with quadratic elements: straight edges, but nodes inside that are nowhere special.
fn raised(mesh: Mesh, complete: bool) -> Mesh {
    raise(&distorted(mesh), complete).unwrap()
}

/// Each hexahedron cut into two wedges.
pub fn wedges(hexes: &Mesh) -> Mesh {
    let mut mesh = Mesh::new(3);
    mesh.nodes.clone_from(&hexes.nodes);
    for cell in cells(hexes, 3) {
        let n = hexes.element_nodes(cell);
        mesh.push(Kind::Wedge6, &[0, 1, 2, 4, 5, 6].map(|a| n[a]));
        mesh.push(Kind::Wedge6, &[0, 2, 3, 4, 6, 7].map(|a| n[a]));
    }
    mesh
}

/// Each hexahedron cut into six pyramids around a node in its middle.
fn pyramids(hexes: &Mesh) -> Mesh {
    let mut mesh = Mesh::new(3);
    mesh.nodes.clone_from(&hexes.nodes);
    for cell in cells(hexes, 3) {
        let n = hexes.element_nodes(cell);
        let sum = |i: usize| n.iter().map(|&a| hexes.nodes[a as usize][i]).sum::<f64>();
        let top = mesh.nodes.len() as u32;
        mesh.nodes.push([0, 1, 2].map(|i| sum(i) / 8.0));
        for face in Kind::Hex8.table().faces {
            // seen from the middle the base turns the other way round
            let mut base: Vec<u32> = face.nodes.iter().rev().map(|&a| n[a]).collect();
            base.push(top);
            mesh.push(Kind::Pyramid5, &base);
        }
    }
    mesh
}

/// Radii from 0.5 to 1.5, height 1.2.
fn rectangle(triangles: bool) -> Mesh {
    generate::rectangle("b", [0.5, 0.0], [1.0, 1.2], [3, 4], triangles)
}

fn mixed() -> Mesh {
    let quads = rectangle(false);
    let mut mesh = Mesh::new(2);
    mesh.nodes.clone_from(&quads.nodes);
    for (k, cell) in cells(&quads, 2).into_iter().enumerate() {
        let nodes = quads.element_nodes(cell);
        if k % 3 == 0 {
            mesh.push(Kind::Tri3, &[nodes[0], nodes[1], nodes[3]]);
            mesh.push(Kind::Tri3, &[nodes[1], nodes[2], nodes[3]]);
        } else {
            mesh.push(Kind::Quad4, nodes);
        }
    }
    mesh
}

/// Moves the nodes inside the bounding box.
pub fn distorted(mut mesh: Mesh) -> Mesh {
    let inside = interior(&mesh.nodes, mesh.dim);
    let mut random = Random(3);
    for (x, inside) in mesh.nodes.iter_mut().zip(inside) {
        if inside {
            x[..mesh.dim]
                .iter_mut()
                .for_each(|x| *x += 0.07 * random.next());
        }
    }
    mesh
}

/// Whether a node lies off all sides of the bounding box.
pub fn interior(x: &[[f64; 3]], dim: usize) -> Vec<bool> {
    let bound = |i: usize, pick: fn(f64, f64) -> f64| x.iter().map(|x| x[i]).reduce(pick).unwrap();
    let sides: Vec<_> = (0..dim)
        .map(|i| (bound(i, f64::min), bound(i, f64::max)))
        .collect();
    x.iter()
        .map(|x| (0..dim).all(|i| x[i] > sides[i].0 + 1e-9 && x[i] < sides[i].1 - 1e-9))
        .collect()
}

pub fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Dense A x.
pub fn multiply(a: &[f64], x: &[f64]) -> Vec<f64> {
    a.chunks(x.len()).map(|row| dot(row, x)).collect()
}

pub fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, x| m.max(x.abs()))
}

pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

/// Dense Cholesky factor (row-major, lower); the smallest pivot says whether the matrix is positive definite.
pub fn cholesky(a: &[f64]) -> (Vec<f64>, f64) {
    let n = a.len().isqrt();
    let (mut l, mut smallest) = (a.to_vec(), f64::INFINITY);
    for j in 0..n {
        let pivot = l[j * n + j] - dot(&l[j * n..j * n + j], &l[j * n..j * n + j]);
        smallest = smallest.min(pivot);
        l[j * n + j] = pivot.max(0.0).sqrt();
        for i in j + 1..n {
            let sum = l[i * n + j] - dot(&l[i * n..i * n + j], &l[j * n..j * n + j]);
            l[i * n + j] = sum / l[j * n + j];
        }
    }
    (l, smallest)
}

/// Solves with the factor of [`cholesky`].
pub fn solve(l: &[f64], b: &[f64]) -> Vec<f64> {
    let n = b.len();
    let mut x = b.to_vec();
    for i in 0..n {
        x[i] = (x[i] - dot(&l[i * n..i * n + i], &x[..i])) / l[i * n + i];
    }
    for i in (0..n).rev() {
        let sum: f64 = (i + 1..n).map(|k| l[k * n + i] * x[k]).sum();
        x[i] = (x[i] - sum) / l[i * n + i];
    }
    x
}
