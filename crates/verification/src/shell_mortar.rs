//! The patch test of contact with shells: uniform pressure across meshes that do not match.
//!
//! Problem: two plates of 1 m by 1 m and 20 mm lie on a block of 1 m by 1 m by 0.5 m whose sides slide on smooth walls and whose ground is held; a pressure p acts on the
//! upper plate. E = 1 MPa, ν = 0.3. Block, lower and upper plate have 3 x 3, 4 x 4 and 5 x 5 cells, those of the block unequal. The lower plate touches the block and the
//! upper plate the lower one, each with half its thickness beside its middle. Small strain, displacement law, without friction and with μ = 0.3.
//!
//! Closed solution: all pressures are p, plates move without bending by p h/(λ + 2μ), and the stress along the height is -p in all of the block, -p λ/(λ + 2μ) across it. Mortar
//! integration transfers what is uniform exactly. Forces are known to 1e-11, the tolerance of the iterations; the shortest bends of the plates are 1e-5 as stiff as the block,
//! and multipliers of neighbours work against each other by ten times that: 1e-5. Collocation at nodes bends plates; its error is shown and not judged.
//! Sizes: full, the plates of triangles as well.

use carom_bodies::{Kinematics, ShellSection};
use carom_contact::{Basis, Integration};
use carom_dynamics::{Driver, Model, ModelTarget, NodalLoad, Preload, Support};
use carom_materials::{Elastic, Plane};
use carom_mesh::{Mesh, Surface, generate};
use carom_signals::Amplitude;

use crate::Error;
use crate::build::{DISPLACEMENT, body, contact, group, newmark, support, surface};
use crate::check::{Check, Row, Size};
use crate::shells::{Grid, moved};

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e6,
    poisson: 0.3,
};
/// Height of the block and thickness of the plates, m.
const HEIGHT: f64 = 0.5;
const THICKNESS: f64 = 0.02;
/// Pressure on the upper plate, Pa.
const PRESSURE: f64 = 2e3;
/// Largest error, relative.
const SLACK: f64 = 1e-5;
/// Cells along a side of the block and of the plates, from below.
const CELLS: [usize; 3] = [3, 4, 5];
/// Names of the plates, from below.
const PLATES: [&str; 2] = ["lower", "upper"];
/// Growth of the cells of the block, as in `contact-patch`.
const BIAS: [f64; 2] = [0.15, 0.1];

/// Plates on a block.
#[derive(Clone, Copy)]
struct Stack {
    triangles: bool,
    integration: Integration,
    friction: f64,
}

impl Stack {
    fn plate(&self, plate: usize) -> Grid {
        let n = CELLS[plate + 1];
        Grid {
            triangles: self.triangles,
            ..Grid::new(n, n)
        }
    }

    /// Height of the middle of a plate, m.
    fn level(plate: usize) -> f64 {
        HEIGHT + (plate as f64 + 0.5) * THICKNESS
    }

    fn mesh(&self) -> Result<Mesh, Error> {
        let n = CELLS[0];
        let size = [1.0, 1.0, HEIGHT];
        let mut mesh = generate::box_("block", [0.0; 3], size, [n, n, 1], false);
        for x in &mut mesh.nodes {
            (0..2).for_each(|i| x[i] += BIAS[i] * x[i] * (1.0 - x[i]));
        }
        for (plate, name) in PLATES.into_iter().enumerate() {
            let level = Stack::level(plate);
            let mut made = self.plate(plate).mesh(&|s, t| [s, t, level]);
            let cells = made.groups.remove("shell");
            made.groups.extend(cells.map(|cells| (name.into(), cells)));
            mesh.merge(name, made)?;
        }
        Ok(mesh)
    }

    /// The pressure on the upper plate, at its nodes by their areas.
    fn loads(&self, mesh: &Mesh, plate: &Surface) -> Vec<NodalLoad> {
        let areas = plate.tributary_areas(mesh, |_| 1.0);
        let load = |(&node, area): (&u32, f64)| NodalLoad {
            name: "pressure".into(),
            nodes: vec![node],
            force: [0.0, 0.0, -PRESSURE * area],
            moment: [0.0; 3],
            amplitude: Amplitude::constant(1.0),
        };
        plate.nodes.iter().zip(areas).map(load).collect()
    }

    fn model(&self) -> Result<Model, Error> {
        let mesh = self.mesh()?;
        let mut bodies = vec![body(&mesh, "block", Kinematics::Solid, RUBBER)?];
        let axis = |i: usize| [0, 1, 2].map(|j| j == i);
        let mut supports = vec![support(&mesh, "block.bottom", axis(2))?];
        for (i, walls) in [["left", "right"], ["front", "back"]].iter().enumerate() {
            for wall in walls {
                supports.push(support(&mesh, &format!("block.{wall}"), axis(i))?);
            }
        }
        let mut around = Vec::new();
        for name in PLATES {
            let section = ShellSection::new(THICKNESS);
            let made = body(&mesh, name, Kinematics::Shell(section), RUBBER)?;
            let radius = |_| 0.5 * THICKNESS;
            let cells = &made.spec.cells;
            around.push(Surface::of_axes(&mesh, group(&mesh, name)?, cells, radius)?);
            bodies.push(made);
            // free to sink and to bend
            supports.push(Support {
                nodes: mesh.group_nodes(group(&mesh, name)?),
                fix: [true, true, false],
                fix_rotations: [false, false, true],
            });
        }
        let top = surface(&mesh, "block.top", &bodies[0])?;
        let below = [top, around[0].clone()];
        let joint = |(above, below): (Surface, Surface)| {
            let mut joint = contact(above, ModelTarget::Surface(below), DISPLACEMENT);
            (joint.integration, joint.friction) = (self.integration, self.friction.into());
            joint
        };
        let loads = self.loads(&mesh, &around[1]);
        let mut model = Model {
            contacts: around.into_iter().zip(below).map(joint).collect(),
            supports,
            ..Model::new(bodies, mesh, newmark(0.25, 0.5), 1.0)
        };
        for (joint, name) in model.contacts.iter_mut().zip(PLATES) {
            joint.name = name.into();
        }
        model.nonlinear.nodal = loads;
        model.nonlinear.preload = Some(Preload { end: 1.0, steps: 1 });
        model.nonlinear.iteration.tolerance = 1e-11;
        Ok(model)
    }

    /// Largest errors of the stress, of the pressures, and of the motion of the plates, each relative to its size.
    fn errors(&self) -> Result<[f64; 3], Error> {
        let mut driver = Driver::new(crate::witness::system(self.model()?)?)?;
        driver.step()?;
        let (system, state) = (driver.system(), driver.state());
        let along = RUBBER.lame_1(Plane::Full) + 2.0 * RUBBER.shear_modulus();
        let across = RUBBER.lame_1(Plane::Full) / along;
        let mut stress = 0.0_f64;
        for (_, found) in system.bodies[0].stresses(&state.motion.u, &[]) {
            for i in 0..3 {
                for j in 0..3 {
                    let part = match (i == j, i) {
                        (false, _) => 0.0,
                        (true, 2) => 1.0,
                        (true, _) => across,
                    };
                    stress = stress.max((found[(i, j)] / PRESSURE + part).abs());
                }
            }
        }
        let points = system.contacts.iter().flat_map(|contact| &contact.points);
        let pressures = points.zip(&state.interface.force).map(|(p, f)| f / p.area);
        let pressure = pressures.fold(0.0_f64, |most, p| most.max((p / PRESSURE - 1.0).abs()));
        let sinks = -PRESSURE * HEIGHT / along;
        let mut motion = 0.0_f64;
        for plate in PLATES {
            for node in system.mesh.group_nodes(group(&system.mesh, plate)?) {
                motion = motion.max((moved(&driver, node)[2] / sinks - 1.0).abs());
            }
        }
        Ok([stress, pressure, motion])
    }
}

pub(crate) const CHECK: Check = Check {
    name: "shell-mortar",
    fact: "plates on each other and on a block pass a uniform pressure on between meshes that do not match, with mortar",
    run: |size| {
        let shapes: &[bool] = match size {
            Size::Quick => &[false],
            Size::Full => &[false, true],
        };
        let bases = [Basis::Standard, Basis::Dual].map(|basis| Integration::Mortar { basis });
        let mut rows = Vec::new();
        for &triangles in shapes {
            let shape = if triangles {
                "triangles"
            } else {
                "quadrilaterals"
            };
            let mut most = [0.0_f64; 3];
            for integration in bases {
                for friction in [0.0, 0.3] {
                    let stack = Stack {
                        triangles,
                        integration,
                        friction,
                    };
                    let errors = stack.errors()?;

                    (0..3).for_each(|k| most[k] = most[k].max(errors[k]));
                }
            }
            for (what, error) in ["stress of the block", "pressure", "motion"]
                .iter()
                .zip(most)
            {
                let name = format!("{shape}: error of the {what}, relative");
                rows.push(Row::at_most(name, error, SLACK));
            }
            let nodes = Stack {
                triangles,
                integration: Integration::Node,
                friction: 0.0,
            };
            let [_, pressure, _] = nodes.errors()?;
            let name = format!("{shape}: error of the pressure with nodes, relative");
            rows.push(Row::shown(name, pressure));
        }
        Ok(rows)
    },
};
