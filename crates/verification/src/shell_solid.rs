//! Models of a plate that is a solid to the left and a shell to the right, glued over a width.

use carom_arlequin::{EdgeCell, Region, Rows, Weighting, edge_mean_motion, edge_rigid_motion};
use carom_bodies::{CellWeights, Kinematics, MassKind, Rotations, ShellSection};
use carom_dynamics::{ModelBody, Support};
use carom_elements::Kind;
use carom_materials::{Elastic, Law as Material, NeoHooke};
use carom_mesh::{Group, Mesh, generate, raise};
use carom_zones::{Glued, glue_thin};

use crate::Error;
use crate::beam_solid::Joint;
use crate::beams::held;
use crate::build::{body, surface};
use crate::shells::Grid;

/// Cells of the solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cells {
    Hexahedra,
    Tetrahedra,
    Wedges,
}

/// A rectangular plate along x and y about z = 0 in two models: a solid to the left, a shell to the right. Lengths in m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plate {
    pub(crate) thickness: f64,
    /// Along y, about 0.
    pub(crate) width: f64,
    /// From where to where along x the solid is.
    pub(crate) solid: [f64; 2],
    /// From where to where the shell is.
    pub(crate) shell: [f64; 2],
    /// Cells of the solid along x, y and z.
    pub(crate) cells: [usize; 3],
    pub(crate) kind: Cells,
    /// Quadratic cells; with all nodes if `complete`.
    pub(crate) quadratic: bool,
    pub(crate) complete: bool,
    /// Elements of the shell along x and y.
    pub(crate) elements: [usize; 2],
    /// Triangles.
    pub(crate) triangles: bool,
    /// Part of their size by which inner nodes of the shell are moved.
    pub(crate) distorted: f64,
    /// Material of both.
    pub(crate) material: Elastic,
    /// Weights.
    pub(crate) weighting: Weighting,
}

impl Plate {
    /// The elements of the shell.
    pub(crate) fn grid(&self) -> Grid {
        Grid {
            n: self.elements[0],
            m: self.elements[1],
            triangles: self.triangles,
        }
    }

    /// The first node of the shell.
    pub(crate) fn first(&self, mesh: &Mesh) -> u32 {
        let [n, m] = self.elements;
        (mesh.nodes.len() - (n + 1) * (m + 1)) as u32
    }

    /// Nodes of the shell in the numbers of the mesh.
    pub(crate) fn of_shell(&self, mesh: &Mesh, nodes: &[u32]) -> Vec<u32> {
        let first = self.first(mesh);
        nodes.iter().map(|node| node + first).collect()
    }

    /// Nodes of the solid at some places.
    pub(crate) fn of_solid(&self, mesh: &Mesh, at: &dyn Fn(&[f64; 3]) -> bool) -> Vec<u32> {
        let nodes = 0..self.first(mesh);
        nodes
            .filter(|&node| at(&mesh.nodes[node as usize]))
            .collect()
    }

    /// Solid and shell, groups `solid` and `shell`.
    pub(crate) fn mesh(&self) -> Result<Mesh, Error> {
        let (half, [from, to]) = (0.5 * self.width, self.solid);
        let mut mesh = generate::box_(
            "solid",
            [from, -half, -0.5 * self.thickness],
            [to - from, self.width, self.thickness],
            self.cells,
            self.kind == Cells::Tetrahedra,
        );
        if self.kind == Cells::Wedges {
            mesh = wedges(&mesh);
        }
        if self.quadratic {
            mesh = raise(&mesh, self.complete)?;
        }
        let ([from, to], [n, m]) = (self.shell, self.elements);
        let grid = self.grid();
        let mut shell = grid.mesh(&|s, t| [from + s * (to - from), (t - 0.5) * self.width, 0.0]);
        let sizes = [(to - from) / n as f64, self.width / m as f64];
        let border = grid.border();
        for (node, x) in shell.nodes.iter_mut().enumerate() {
            if border.binary_search(&(node as u32)).is_err() {
                // without order, and the same in every run
                x[0] += self.distorted * sizes[0] * (12.9 * node as f64).sin();
                x[1] += self.distorted * sizes[1] * (78.2 * node as f64).sin();
            }
        }
        mesh.merge("shell", shell)?;
        Ok(mesh)
    }

    /// The bodies, solid first, with consistent mass.
    fn bodies(&self, mesh: &Mesh) -> Result<[ModelBody; 2], Error> {
        let section = ShellSection::new(self.thickness);
        let mut bodies = [
            body(mesh, "solid", Kinematics::Solid, self.material)?,
            body(mesh, "shell", Kinematics::Shell(section), self.material)?,
        ];
        bodies
            .iter_mut()
            .for_each(|body| body.mass = MassKind::Consistent);
        Ok(bodies)
    }

    /// The bodies without an overlap, and the rows between the edge of the shell and the end of the solid.
    pub(crate) fn on_face(
        &self,
        mesh: &Mesh,
        joint: Joint,
    ) -> Result<([ModelBody; 2], Rows), Error> {
        let bodies = self.bodies(mesh)?;
        let face = surface(mesh, "solid.right", &bodies[0])?;
        let edge: Vec<EdgeCell> = self
            .of_shell(mesh, &self.grid().column(0))
            .windows(2)
            .map(|nodes| EdgeCell {
                nodes: [nodes[0], nodes[1]],
                x: [0, 1].map(|b| mesh.nodes[nodes[b] as usize]),
                directors: [[0.0, 0.0, 1.0]; 2],
                offset: 0.0,
                thickness: self.thickness,
            })
            .collect();
        let rows = match joint {
            Joint::Rigid => edge_rigid_motion(mesh, &face.faces, &edge)?,
            _ => edge_mean_motion(mesh, &face.faces, &edge)?,
        };
        Ok((bodies, rows))
    }

    /// The bodies, solid first, with consistent mass, and the overlap.
    pub(crate) fn glued(&self, mesh: &Mesh) -> Result<([ModelBody; 2], Glued), Error> {
        self.glue(mesh, self.bodies(mesh)?)
    }

    /// The same of bodies that turn by any angle: the shell with finite rotations, the solid of neo-Hooke's material.
    pub(crate) fn glued_turning(&self, mesh: &Mesh) -> Result<([ModelBody; 2], Glued), Error> {
        let [mut solid, mut shell] = self.bodies(mesh)?;
        let initial = self.material;
        solid.spec.material = Material::NeoHooke(NeoHooke { initial });
        shell.spec.kinematics = Kinematics::Shell(ShellSection {
            rotations: Rotations::Finite,
            ..ShellSection::new(self.thickness)
        });
        self.glue(mesh, [solid, shell])
    }

    fn glue(
        &self,
        mesh: &Mesh,
        mut bodies: [ModelBody; 2],
    ) -> Result<([ModelBody; 2], Glued), Error> {
        let specs = [&bodies[0].spec, &bodies[1].spec];
        let glued = glue_thin(mesh, specs, &Region::Intersection, &self.weighting)?;
        let weights = [&glued.weights.inner, &glued.weights.outer];
        for ((part, cells), weights) in bodies.iter_mut().zip(&glued.cells).zip(weights) {
            part.spec.cells = cells.clone();
            part.spec.exact_products = true;
            part.spec.weights = Some(CellWeights {
                inertia: weights.inertia.clone(),
                stiffness: weights.stiffness.clone(),
            });
        }
        Ok((bodies, glued))
    }

    /// What holds both sides, y = ± half the width, as planes of symmetry.
    pub(crate) fn symmetric(&self, mesh: &Mesh) -> Vec<Support> {
        let half = 0.5 * self.width;
        let at_side = |x: &[f64; 3]| (x[1].abs() - half).abs() < 1e-9;
        let grid = self.grid();
        let rows = [grid.row(0), grid.row(grid.m)].concat();
        let (along_y, about_x) = ([false, true, false], [true, false, true]);
        vec![
            held(self.of_solid(mesh, &at_side), along_y, [false; 3]),
            held(self.of_shell(mesh, &rows), along_y, about_x),
        ]
    }
}

/// Each hexahedron as two wedges along the third axis.
fn wedges(mesh: &Mesh) -> Mesh {
    let mut out = Mesh::new(3);
    out.nodes.clone_from(&mesh.nodes);
    let mut cells = Vec::new();
    for &cell in &mesh.groups["solid"].elements {
        let nodes = mesh.element_nodes(cell);
        for corners in [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]] {
            cells.push(out.push(Kind::Wedge6, &corners.map(|a| nodes[a])));
        }
    }
    out.groups.insert("solid".into(), Group::new(3, cells));
    out
}
