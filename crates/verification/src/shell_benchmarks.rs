//! Shells in statics, small rotations.
//!
//! Problems, of MacNeal and Harder (1985, Finite Elem. Anal. Des. 1, 3) where nothing else is said; symmetric parts are meshed:
//! - Scordelis-Lo roof: R = 25, L = 50, h = 0.25, 80°, E = 4.32e8, ν = 0, weight 90 per area, on diaphragms: the middle of a free edge
//!   sinks by 0.3024.
//! - Cylinder pinched between diaphragms: R = 300, L = 600, h = 3, E = 3e6, ν = 0.3, two forces 1: 1.8248e-5 (Belytschko and others 1985).
//! - Hemisphere with a hole of 18°: R = 10, h = 0.04, E = 6.825e7, ν = 0.3, forces 2 at four points: 0.0940 (MacNeal and Harder), 0.093 (Simo, Fox and
//!   Rifai 1989).
//! - Beam twisted by 90°: L = 12, b = 1.1, h = 0.32 and 0.0032, E = 2.9e7, ν = 0.22, force 1 (1e-6 of the thin one) at the end in its plane and
//!   across: 5.424e-3 and 1.754e-3; 5.256e-3 and 1.294e-3 (Simo, Fox and Rifai 1989). In every element of it the nodes are out of a plane.
//! - Raasch's hook (Knight 1997, AIAA J. 35, 375): two arcs of R = 14, 60°, and R = 46, 150°, width 20, h = 2, E = 3300, ν = 0.35, force 1
//!   across at the end: 4.9352.
//!
//! Tolerance: 2 %, the spread of published values. Triangles, whose membrane strain is constant, on meshes twice as fine, those of the twisted beam, which bends in its plane, four times. Errors fall from mesh to
//! mesh, but where they are below 1 %, to which published values agree. The value of the hook is that of solids, and fine meshes of these shells go beyond it by 1 to 2 %:
//! there changes fall.

use carom_bodies::Rotations;
use carom_materials::Elastic;

use crate::Error;
use crate::beams::held;
use crate::check::{Check, Row, Size};
use crate::shells::{Grid, Held, Loaded, force, shell};

fn material(young: f64, poisson: f64, density: f64) -> Elastic {
    Elastic {
        density,
        young,
        poisson,
    }
}

fn radians(degrees: f64) -> f64 {
    degrees.to_radians()
}

/// A quarter: x across, y along, z up.
pub(crate) fn roof(grid: &Grid) -> Result<Loaded, Error> {
    let (radius, half, thickness) = (25.0, 25.0, 0.25);
    let mesh = grid.mesh(&|s, t| {
        let angle = radians(40.0) * s;
        [radius * angle.sin(), half * t, radius * angle.cos()]
    });
    let made = shell(
        &mesh,
        thickness,
        Rotations::Small,
        material(4.32e8, 0.0, 90.0 / thickness),
    )?;
    let supports = vec![
        // on the diaphragm at y = 0, symmetric about y = 25 and about x = 0
        held(grid.row(0), [true, false, true], [false; 3]),
        held(grid.row(grid.m), [false, true, false], [true, false, true]),
        held(grid.column(0), [true, false, false], [false, true, true]),
    ];
    let load = Held {
        supports,
        gravity: [0.0, 0.0, -1.0],
        ..Held::default()
    };
    let edge = grid.node(grid.n, grid.m);
    Ok(Loaded::new((mesh, made), load, edge, [0.0, 0.0, -1.0]))
}

/// An eighth: the force at x = 0, y = 0, z = R.
pub(crate) fn cylinder(grid: &Grid) -> Result<Loaded, Error> {
    let (radius, half, thickness) = (300.0, 300.0, 3.0);
    let mesh = grid.mesh(&|s, t| {
        let angle = radians(90.0) * s;
        [radius * angle.sin(), half * t, radius * angle.cos()]
    });
    let made = shell(&mesh, thickness, Rotations::Small, material(3e6, 0.3, 1.0))?;
    let supports = vec![
        held(grid.row(grid.m), [true, false, true], [false, true, false]),
        held(grid.row(0), [false, true, false], [true, false, true]),
        held(grid.column(0), [true, false, false], [false, true, true]),
        held(
            grid.column(grid.n),
            [false, false, true],
            [true, true, false],
        ),
    ];
    let point = grid.node(0, 0);
    let load = Held {
        supports,
        loads: vec![force(vec![point], [0.0, 0.0, -0.25])],
        ..Held::default()
    };
    Ok(Loaded::new((mesh, made), load, point, [0.0, 0.0, -1.0]))
}

/// A quarter: forces along x outward and along y inward.
pub(crate) fn hemisphere(grid: &Grid) -> Result<Loaded, Error> {
    let radius = 10.0;
    let mesh = grid.mesh(&|s, t| {
        let (around, up) = (radians(90.0) * s, radians(72.0) * t);
        [
            radius * up.cos() * around.cos(),
            radius * up.cos() * around.sin(),
            radius * up.sin(),
        ]
    });
    let made = shell(&mesh, 0.04, Rotations::Small, material(6.825e7, 0.3, 1.0))?;
    let (first, second) = (grid.node(0, 0), grid.node(grid.n, 0));
    let supports = vec![
        held(grid.column(0), [false, true, false], [true, false, true]),
        held(
            grid.column(grid.n),
            [true, false, false],
            [false, true, true],
        ),
        held(vec![first], [false, false, true], [false; 3]),
    ];
    let load = Held {
        supports,
        loads: vec![
            force(vec![first], [1.0, 0.0, 0.0]),
            force(vec![second], [0.0, -1.0, 0.0]),
        ],
        ..Held::default()
    };
    Ok(Loaded::new((mesh, made), load, first, [1.0, 0.0, 0.0]))
}

/// Clamped at x = 0, where its width is along y; at the end it is along z. The displacement along the force, in the plane (z) or across (y).
pub(crate) fn twisted(
    grid: &Grid,
    thickness: f64,
    load: f64,
    axis: usize,
) -> Result<Loaded, Error> {
    let mesh = grid.mesh(&|s, t| {
        let (angle, across) = (radians(90.0) * s, 1.1 * (t - 0.5));
        [12.0 * s, across * angle.cos(), across * angle.sin()]
    });
    let made = shell(
        &mesh,
        thickness,
        Rotations::Small,
        material(2.9e7, 0.22, 1.0),
    )?;
    let mut along = [0.0; 3];
    along[axis] = 1.0;
    let direction = along.map(|along| load * along);
    let end = grid.node(grid.n, grid.m / 2);
    let load = Held {
        supports: vec![held(grid.column(0), [true; 3], [true; 3])],
        loads: vec![force(vec![end], direction)],
        ..Held::default()
    };
    Ok(Loaded::new((mesh, made), load, end, along))
}

/// Clamped at the start of the smaller arc; the force across at the end of the larger.
pub(crate) fn hook(grid: &Grid) -> Result<Loaded, Error> {
    let lengths = [14.0 * radians(60.0), 46.0 * radians(150.0)];
    let mesh = grid.mesh(&|s, t| {
        let along = s * (lengths[0] + lengths[1]);
        let [x, y] = if along <= lengths[0] {
            let angle = along / 14.0;
            [14.0 * angle.sin(), 14.0 * (1.0 - angle.cos())]
        } else {
            // the centre of the second arc is on the other side of the path
            let turn = radians(60.0);
            let from = [14.0 * turn.sin(), 14.0 * (1.0 - turn.cos())];
            let angle = turn - (along - lengths[0]) / 46.0;
            let centre = [from[0] + 46.0 * turn.sin(), from[1] - 46.0 * turn.cos()];
            [
                centre[0] - 46.0 * angle.sin(),
                centre[1] + 46.0 * angle.cos(),
            ]
        };
        [x, y, 20.0 * t]
    });
    let made = shell(&mesh, 2.0, Rotations::Small, material(3300.0, 0.35, 1.0))?;
    // the force is spread over the edge: halves at its ends
    let inner = grid.column(grid.n)[1..grid.m].to_vec();
    let part = 1.0 / grid.m as f64;
    let ends = vec![grid.node(grid.n, 0), grid.node(grid.n, grid.m)];
    let load = Held {
        supports: vec![held(grid.column(0), [true; 3], [true; 3])],
        loads: vec![
            force(inner, [0.0, 0.0, part]),
            force(ends, [0.0, 0.0, 0.5 * part]),
        ],
        ..Held::default()
    };
    let end = grid.node(grid.n, grid.m / 2);
    Ok(Loaded::new((mesh, made), load, end, [0.0, 0.0, 1.0]))
}

/// To what published values are known: where the error is below, it need not fall with the mesh.
const DIGITS: f64 = 0.01;

/// What is computed on meshes of growing fineness.
struct Problem<'a> {
    name: &'a str,
    published: f64,
    meshes: &'a [[usize; 2]],
    /// How much finer those of triangles are.
    triangles: usize,
    /// Whether finer meshes tend to the published value.
    is_limit: bool,
    solve: &'a dyn Fn(&Grid) -> Result<Loaded, Error>,
}

impl Problem<'_> {
    /// The error over that of the mesh before; where the published value is no limit the change over that before.
    fn falls(&self, name: &str, before: &[f64], found: f64) -> Option<Row> {
        let error = |found: f64| (found / self.published - 1.0).abs();
        match before {
            [.., last] if self.is_limit => {
                let of = error(found) / error(*last).max(DIGITS);
                let name = format!("{name}, error over that of the mesh before");
                Some(Row::at_most(name, of, 1.0).published())
            }
            [.., first, second] if !self.is_limit => {
                let of = (found - second).abs() / (second - first).abs();
                let name = format!("{name}, change over that before");
                Some(Row::at_most(name, of, 1.0).second_formulation())
            }
            _ => None,
        }
    }

    fn rows(&self, triangles: bool, part: f64, rows: &mut Vec<Row>) -> Result<(), Error> {
        let kind = if triangles { "tri3" } else { "quad4" };
        let finer = if triangles { self.triangles } else { 1 };
        let mut before: Vec<f64> = Vec::new();
        for (k, mesh) in self.meshes.iter().enumerate() {
            let [n, m] = mesh.map(|count| finer * count);
            let grid = Grid { n, m, triangles };
            let found = (self.solve)(&grid)?.deflection()?;
            let name = format!("{}, {kind} {n} x {m}: displacement", self.name);
            rows.extend(self.falls(&name, &before, found));
            before.push(found);
            rows.push(match k + 1 == self.meshes.len() {
                true => Row::relative(name, found, self.published, part).published(),
                false => Row::shown(name, found),
            });
        }
        Ok(())
    }
}

fn run(size: Size) -> Result<Vec<Row>, Error> {
    let full = size == Size::Full;
    let meshes =
        |all: &'static [[usize; 2]], quick: usize| if full { all } else { &all[quick..=quick] };
    let problems = [
        Problem {
            name: "Scordelis-Lo roof",
            triangles: 2,
            is_limit: true,
            published: 0.3024,
            meshes: meshes(&[[4, 4], [8, 8], [16, 16]], 2),
            solve: &roof,
        },
        Problem {
            name: "pinched cylinder",
            triangles: 2,
            is_limit: true,
            published: 1.8248e-5,
            meshes: meshes(&[[8, 8], [16, 16], [32, 32]], 2),
            solve: &cylinder,
        },
        Problem {
            name: "hemisphere",
            triangles: 2,
            is_limit: true,
            published: 0.0940,
            meshes: meshes(&[[4, 4], [8, 8], [16, 16]], 2),
            solve: &hemisphere,
        },
        Problem {
            name: "twisted beam, h = 0.32, in plane",
            triangles: 4,
            is_limit: true,
            published: 5.424e-3,
            meshes: meshes(&[[12, 2], [24, 4]], 1),
            solve: &|grid| twisted(grid, 0.32, 1.0, 2),
        },
        Problem {
            name: "twisted beam, h = 0.32, across",
            triangles: 4,
            is_limit: true,
            published: 1.754e-3,
            meshes: meshes(&[[12, 2], [24, 4]], 1),
            solve: &|grid| twisted(grid, 0.32, 1.0, 1),
        },
        Problem {
            name: "twisted beam, h = 0.0032, in plane",
            triangles: 4,
            is_limit: true,
            published: 5.256e-3,
            meshes: meshes(&[[12, 2], [24, 4]], 1),
            solve: &|grid| twisted(grid, 0.0032, 1e-6, 2),
        },
        Problem {
            name: "twisted beam, h = 0.0032, across",
            triangles: 4,
            is_limit: true,
            published: 1.294e-3,
            meshes: meshes(&[[12, 2], [24, 4]], 1),
            solve: &|grid| twisted(grid, 0.0032, 1e-6, 1),
        },
        Problem {
            name: "Raasch's hook",
            triangles: 2,
            is_limit: false,
            published: 4.9352,
            meshes: meshes(&[[18, 4], [36, 8], [72, 16]], 1),
            solve: &hook,
        },
    ];
    let mut rows = Vec::new();
    for problem in &problems {
        problem.rows(false, 0.02, &mut rows)?;
    }
    if full {
        for problem in &problems {
            problem.rows(true, 0.02, &mut rows)?;
        }
    }
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "shell-benchmarks",
    fact: "shells deflect as published: roof, pinched cylinder, hemisphere, twisted beam, hook",
    run,
};
