//! Meshes, bodies and static stages of shells.

use carom_bodies::{Formulation, Kinematics, MassKind, Rotations, ShellSection};
use carom_dynamics::{Driver, Model, ModelBody, NodalLoad, Preload, Support};
use carom_elements::Kind;
use carom_materials::Elastic;
use carom_mesh::{Group, Mesh};
use carom_signals::Amplitude;

use crate::Error;
use crate::build::{body, newmark};

/// A surface over the unit square, of `n` by `m` cells.
pub(crate) struct Grid {
    pub n: usize,
    pub m: usize,
    /// Two triangles for each quadrilateral.
    pub triangles: bool,
}

impl Grid {
    pub(crate) fn new(n: usize, m: usize) -> Grid {
        let triangles = false;
        Grid { n, m, triangles }
    }

    pub(crate) fn node(&self, i: usize, j: usize) -> u32 {
        (j * (self.n + 1) + i) as u32
    }

    /// Nodes with the first parameter of a place `i`.
    pub(crate) fn column(&self, i: usize) -> Vec<u32> {
        (0..=self.m).map(|j| self.node(i, j)).collect()
    }

    /// Nodes with the second parameter of a place `j`.
    pub(crate) fn row(&self, j: usize) -> Vec<u32> {
        (0..=self.n).map(|i| self.node(i, j)).collect()
    }

    pub(crate) fn border(&self) -> Vec<u32> {
        let mut all = [
            self.column(0),
            self.column(self.n),
            self.row(0),
            self.row(self.m),
        ]
        .concat();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// The mesh; its cells are the group `shell`.
    pub(crate) fn mesh(&self, at: &dyn Fn(f64, f64) -> [f64; 3]) -> Mesh {
        let mut mesh = Mesh::new(3);
        for j in 0..=self.m {
            for i in 0..=self.n {
                let place = at(i as f64 / self.n as f64, j as f64 / self.m as f64);
                mesh.nodes.push(place);
            }
        }
        let mut cells = Vec::new();
        for j in 0..self.m {
            for i in 0..self.n {
                let [a, b, c, d] = [
                    self.node(i, j),
                    self.node(i + 1, j),
                    self.node(i + 1, j + 1),
                    self.node(i, j + 1),
                ];
                match (self.triangles, (i + j) % 2) {
                    (false, _) => cells.push(mesh.push(Kind::Quad4, &[a, b, c, d])),
                    (true, 0) => {
                        cells.push(mesh.push(Kind::Tri3, &[a, b, c]));
                        cells.push(mesh.push(Kind::Tri3, &[a, c, d]));
                    }
                    (true, _) => {
                        cells.push(mesh.push(Kind::Tri3, &[a, b, d]));
                        cells.push(mesh.push(Kind::Tri3, &[b, c, d]));
                    }
                }
            }
        }
        mesh.groups.insert("shell".into(), Group::new(2, cells));
        mesh
    }
}

/// The shell with consistent mass.
pub(crate) fn shell(
    mesh: &Mesh,
    thickness: f64,
    rotations: Rotations,
    material: Elastic,
) -> Result<ModelBody, Error> {
    let section = ShellSection {
        rotations,
        ..ShellSection::new(thickness)
    };
    let mut made = body(mesh, "shell", Kinematics::Shell(section), material)?;
    made.mass = MassKind::Consistent;
    Ok(made)
}

/// Changes the section of a shell.
pub(crate) fn section_of(made: &mut ModelBody, change: &dyn Fn(&mut ShellSection)) {
    if let Kinematics::Shell(section) = &mut made.spec.kinematics {
        change(section);
    }
}

/// The same force on each of some nodes.
pub(crate) fn force(nodes: Vec<u32>, force: [f64; 3]) -> NodalLoad {
    NodalLoad {
        name: "force".into(),
        nodes,
        force,
        moment: [0.0; 3],
        amplitude: Amplitude::constant(1.0),
    }
}

/// What holds and loads a shell.
#[derive(Default)]
pub(crate) struct Held {
    pub supports: Vec<Support>,
    pub loads: Vec<NodalLoad>,
    /// Weight per mass, m/s².
    pub gravity: [f64; 3],
}

/// The static stage of a shell in steps of its loads: calls `visit` with the part of the loads and the driver after each.
pub(crate) fn loaded(
    (mesh, made): (Mesh, ModelBody),
    held: Held,
    steps: u64,
    visit: &mut dyn FnMut(f64, &Driver),
) -> Result<(), Error> {
    let mut model = Model {
        supports: held.supports,
        gravity: held.gravity,
        ..Model::new(vec![made], mesh, newmark(0.25, 0.5), 1.0 / steps as f64)
    };
    model.nonlinear.preload = Some(Preload { end: 1.0, steps });
    model.nonlinear.nodal = held.loads;
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    for step in 0..steps {
        driver.step()?;
        visit((step + 1) as f64 / steps as f64, &driver);
    }
    Ok(())
}

/// Displacement of a node of the mesh, m.
pub(crate) fn moved(driver: &Driver, node: u32) -> [f64; 3] {
    let (system, state) = (driver.system(), driver.state());
    let own = system.number[node as usize];
    system.unknowns.vector(own, &state.motion.u)
}

/// Displacement of a node at the end of a linear static stage.
pub(crate) fn deflection(
    made: (Mesh, ModelBody),
    held: Held,
    node: u32,
) -> Result<[f64; 3], Error> {
    let mut found = [0.0; 3];
    loaded(made, held, 1, &mut |_, driver| found = moved(driver, node))?;
    Ok(found)
}

/// A shell with its loads, and the displacement that is asked for.
pub(crate) struct Loaded {
    pub mesh: Mesh,
    pub made: ModelBody,
    pub held: Held,
    pub node: u32,
    /// Direction of the displacement.
    pub along: [f64; 3],
}

impl Loaded {
    pub(crate) fn new(
        (mesh, made): (Mesh, ModelBody),
        held: Held,
        node: u32,
        along: [f64; 3],
    ) -> Loaded {
        Loaded {
            mesh,
            made,
            held,
            node,
            along,
        }
    }

    /// At the end of a static stage, m.
    pub(crate) fn deflection(self) -> Result<f64, Error> {
        let found = deflection((self.mesh, self.made), self.held, self.node)?;
        Ok(found
            .iter()
            .zip(&self.along)
            .map(|(u, along)| u * along)
            .sum())
    }

    /// The same with one point and finite rotations, under a small part of the loads.
    pub(crate) fn with_one_point(mut self, hourglass: f64, part: f64) -> Result<f64, Error> {
        section_of(&mut self.made, &|section| {
            section.rotations = Rotations::Finite
        });
        self.made.spec.formulation = Formulation::Reduced { hourglass };
        let loads = self.held.loads.iter_mut();
        loads.for_each(|load| load.force = load.force.map(|force| part * force));
        self.held.gravity = self.held.gravity.map(|gravity| part * gravity);
        Ok(self.deflection()? / part)
    }
}
