//! The patch test of contact: uniform stress across meshes that do not match.
//!
//! Problem: two blocks of side 1, together [0, 1]^d, meet in y = ½ (2D) or z = ½ (3D), or in a side of slope 0.3 there, with
//! meshes that do not match; a static stage brings top and bottom together by the part ε of the height. *Squeezed*: all
//! other sides come together by ε as well, so that F = (1 - ε) I and the stress on every plane is normal: without friction
//! inclined sides carry it too. *Upright*: the other sides are free, uniaxial stress; on inclined sides friction holds it,
//! since the slope is below the coefficient. Small strain and neo-Hooke, linear and quadratic faces, standard and dual
//! multipliers, displacement law; then the blocks stay at rest under all laws.
//!
//! Closed solution: Hooke's law, or σ = (μ (s² - 1) + λ ln J)/J of the stretch s along the direction asked for, J = det F;
//! upright with a stretch l of each of m free directions, μ (l² - 1) + λ (m ln l + ln(1 - ε)) = 0. Mortar integration passes
//! since it transfers what is uniform exactly: 1e-10 of the stress is Newton's tolerance of 1e-13 of the forces times the
//! condition of the last iterate, far above rounding. Collocation at nodes does not pass: its error, the largest of all
//! elements of the smallest meshes, is shown beside it and not judged.

use carom_bodies::Kinematics;
use carom_contact::law::Adhesion;
use carom_contact::{Basis, Integration, Law};
use carom_dynamics::{
    Amplitude, Driver, Model, ModelTarget, Nonlinear, Preload, Prescribed, Support,
};
use carom_materials::{Elastic, Law as Material, NeoHooke, Plane};
use carom_mesh::raise::raise;
use carom_mesh::{Mesh, generate};

use crate::Error;
use crate::build::{DISPLACEMENT, NOW, body, contact, damped, group, newmark, support, surface};
use crate::check::{Check, Row, Size};

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e6,
    poisson: 0.3,
};
const SMALL: Material = Material::Elastic(RUBBER);
const FINITE: Material = Material::NeoHooke(NeoHooke { initial: RUBBER });
const SLOPE: f64 = 0.3;
const THICKNESS: f64 = 0.5;
/// Growth of the cells of the lower block across, in both directions: no node of the upper one lies on an edge between
/// its faces. Collocation bends them, and a node in a fold has two normals between which iterations go to and fro.
const BIAS: [f64; 2] = [0.15, 0.1];
/// End of the static stage, s, and its steps.
const STAGE: (f64, u64) = (1.0, 3);
/// Steps of the dynamics after it.
const REST: usize = 10;
/// Largest error of stresses and pressures, relative.
const ROUND_OFF: f64 = 1e-10;
/// The same at rest. Newmark's accelerations are 4/dt² times a displacement; of rounding, 1e-16 m against the 1e-3 h by which
/// an element shrinks, and with 100 times the stiffness as m/dt², each step adds 1e-10.
const AT_REST: f64 = 1e-8;
const MORTARS: [Integration; 2] = [
    Integration::Mortar {
        basis: Basis::Standard,
    },
    Integration::Mortar { basis: Basis::Dual },
];

/// What the blocks are made of.
#[derive(Clone, Copy)]
struct Cells {
    name: &'static str,
    dim: usize,
    simplices: bool,
    /// Raised to quadratic, with nodes in the middle of faces and cells or without.
    quadratic: Option<bool>,
}

const fn cells(dim: usize, name: &'static str, simplices: bool, quadratic: Option<bool>) -> Cells {
    Cells {
        name,
        dim,
        simplices,
        quadratic,
    }
}

const KINDS: [Cells; 10] = [
    cells(2, "quad4", false, None),
    cells(2, "tri3", true, None),
    cells(2, "quad8", false, Some(false)),
    cells(2, "quad9", false, Some(true)),
    cells(2, "tri6", true, Some(true)),
    cells(3, "hex8, quad4 faces", false, None),
    cells(3, "tet4, tri3 faces", true, None),
    cells(3, "hex20, quad8 faces", false, Some(false)),
    cells(3, "hex27, quad9 faces", false, Some(true)),
    cells(3, "tet10, tri6 faces", true, Some(true)),
];

/// How the blocks are loaded.
#[derive(Clone, Copy, PartialEq)]
enum Load {
    Squeezed,
    Upright,
}

/// Two blocks.
#[derive(Clone, Copy)]
struct Patch {
    cells: Cells,
    /// Cells across the upper and the lower block.
    across: [usize; 2],
    slope: f64,
    load: Load,
    material: Material,
    integration: Integration,
    friction: f64,
    law: Law,
}

impl Patch {
    fn new(cells: Cells, size: Size) -> Patch {
        Patch {
            cells,
            across: match (size, cells.dim) {
                (Size::Quick, 2) => [4, 3],
                (Size::Quick, _) => [2, 3],
                (Size::Full, 2) => [11, 7],
                (Size::Full, _) => [5, 3],
            },
            slope: 0.0,
            load: Load::Upright,
            material: SMALL,
            integration: MORTARS[0],
            friction: 0.0,
            law: DISPLACEMENT,
        }
    }

    /// Part by which the height shrinks.
    fn shrinks(&self) -> f64 {
        match self.material {
            SMALL => 1e-3,
            _ => 0.1,
        }
    }

    fn mesh(&self) -> Result<Mesh, Error> {
        let dim = self.cells.dim;
        let block = |name: &str, low: f64, n: usize| {
            let simplices = self.cells.simplices;
            match dim {
                2 => generate::rectangle(name, [0.0, low], [1.0, 0.5], [n, 2], simplices),
                _ => {
                    let origin = [0.0, 0.0, low];
                    generate::box_(name, origin, [1.0, 1.0, 0.5], [n, n, 1], simplices)
                }
            }
        };
        let [upper, lower] = self.across;
        let mut mesh = block("upper", 0.5, upper);
        let mut below = block("lower", 0.0, lower);
        for x in &mut below.nodes {
            for i in 0..dim - 1 {
                x[i] += BIAS[i] * x[i] * (1.0 - x[i]);
            }
        }
        mesh.merge("lower", below)?;
        for x in &mut mesh.nodes {
            let rise = x[0] - 0.5 + if dim == 3 { 0.5 * (x[1] - 0.5) } else { 0.0 };
            let part = 1.0 - (2.0 * x[dim - 1] - 1.0).abs();
            x[dim - 1] += self.slope * part * rise;
        }
        Ok(match self.cells.quadratic {
            Some(complete) => raise(&mesh, complete)?,
            None => mesh,
        })
    }

    /// Supports, and the motions that shrink the blocks.
    fn held(&self, mesh: &Mesh) -> Result<(Vec<Support>, Vec<Prescribed>), Error> {
        let dim = self.cells.dim;
        let (end, _) = STAGE;
        let shrink = Amplitude::new(vec![[0.0, 0.0], [end, -self.shrinks()]])?;
        let axis = |i: usize| [0, 1, 2].map(|j| j == i);
        let mut supports = vec![support(mesh, "lower.bottom", axis(dim - 1))?];
        let mut motions = Vec::new();
        let mut moves = |name: &str, i: usize| -> Result<(), Error> {
            motions.push(Prescribed {
                nodes: mesh.group_nodes(group(mesh, name)?),
                displacement: axis(i).map(|moves| moves.then(|| shrink.clone())),
            });
            Ok(())
        };
        moves("upper.top", dim - 1)?;
        for block in ["upper", "lower"] {
            let pairs = [["left", "right"], ["front", "back"]];
            for (i, [still, moving]) in pairs.iter().enumerate().take(dim - 1) {
                supports.push(support(mesh, &format!("{block}.{still}"), axis(i))?);
                if self.load == Load::Squeezed {
                    moves(&format!("{block}.{moving}"), i)?;
                }
            }
        }
        Ok((supports, motions))
    }

    fn model(&self) -> Result<Model, Error> {
        let mesh = self.mesh()?;
        let kinematics = match self.cells.dim {
            2 => Kinematics::PlaneStrain {
                thickness: THICKNESS,
            },
            _ => Kinematics::Solid,
        };
        let mut bodies = Vec::new();
        for name in ["upper", "lower"] {
            let mut body = body(&mesh, name, kinematics, RUBBER)?;
            body.spec.material = self.material;
            bodies.push(body);
        }
        let (supports, motions) = self.held(&mesh)?;
        let below = surface(&mesh, "upper.bottom", &bodies[0])?;
        let above = ModelTarget::Surface(surface(&mesh, "lower.top", &bodies[1])?);
        let mut joint = contact(below, above, self.law);
        (joint.integration, joint.friction) = (self.integration, self.friction.into());
        let (end, steps) = STAGE;
        let mut nonlinear = Nonlinear {
            motions,
            preload: Some(Preload { end, steps }),
            ..Nonlinear::default()
        };
        nonlinear.iteration.tolerance = 1e-13;
        Ok(Model {
            contacts: vec![joint],
            supports,
            nonlinear,
            ..Model::new(
                bodies,
                mesh,
                newmark(0.25, 0.5),
                0.2 / self.across[0] as f64 / RUBBER.wave_speed(Plane::Full),
            )
        })
    }

    /// The blocks at the end of the static stage.
    fn loaded(&self) -> Result<Driver, Error> {
        let mut newton = Driver::new(crate::witness::system(self.model()?)?)?;
        for _ in 0..STAGE.1 {
            newton.step()?;
        }
        Ok(newton)
    }

    /// Stress along the height in Pa, and the stretches across and along it; at small strain they are 1.
    fn exact(&self) -> (f64, [f64; 2]) {
        let (dim, part) = (self.cells.dim as f64, self.shrinks());
        let (lambda, mu) = (RUBBER.lame_1(Plane::Full), RUBBER.shear_modulus());
        let free = dim - 1.0;
        match (self.material, self.load) {
            (SMALL, Load::Squeezed) => (-part * (dim * lambda + 2.0 * mu), [1.0; 2]),
            (SMALL, Load::Upright) if self.cells.dim == 2 => (
                -part * RUBBER.young / (1.0 - RUBBER.poisson.powi(2)),
                [1.0; 2],
            ),
            (SMALL, Load::Upright) => (-part * RUBBER.young, [1.0; 2]),
            (_, Load::Squeezed) => {
                let s = 1.0 - part;
                let volume = s.powf(dim);
                let stress = mu * (s * s - 1.0) + lambda * volume.ln();
                (stress / volume, [s; 2])
            }
            (_, Load::Upright) => {
                let (s, mut l) = (1.0 - part, 1.0_f64);
                for _ in 0..20 {
                    let value = mu * (l * l - 1.0) + lambda * (free * l.ln() + s.ln());
                    l -= value / (2.0 * mu * l + lambda * free / l);
                }
                (mu * (s * s - l * l) / (s * l.powf(free)), [l, s])
            }
        }
    }

    /// Normal traction on the common side per reference area, Pa: n·P N of the normals N before and n ∥ F⁻ᵀ N after.
    fn nominal(&self) -> f64 {
        let (dim, (stress, [across, along])) = (self.cells.dim, self.exact());
        let volume = along * across.powi(dim as i32 - 1);
        let tilt = [-self.slope, -0.5 * self.slope];
        let (mut traction, mut lengths) = (0.0, [0.0; 2]);
        for i in 0..dim {
            let (normal, stretch) = match i == dim - 1 {
                true => (1.0, along),
                false => (tilt[i], across),
            };
            let turned = normal / stretch;
            if i == dim - 1 || self.load == Load::Squeezed {
                traction += turned * stress * volume / stretch * normal;
            }
            lengths[0] += normal * normal;
            lengths[1] += turned * turned;
        }
        traction / (lengths[0] * lengths[1]).sqrt()
    }

    /// Largest errors of the stresses of all elements and of the pressures of all contact points, relative.
    fn errors(&self, newton: &Driver) -> [f64; 2] {
        let (system, state, dim) = (newton.system(), newton.state(), self.cells.dim);
        let (exact, _) = self.exact();
        let mut stress = 0.0_f64;
        for body in &system.bodies {
            // an elastic law keeps no history
            for (_, found) in body.stresses(&state.motion.u, &[]) {
                for i in 0..dim {
                    for j in 0..dim {
                        let carries = i == j && (i == dim - 1 || self.load == Load::Squeezed);
                        let expected = if carries { exact } else { 0.0 };
                        stress = worse(stress, (found[(i, j)] - expected) / exact);
                    }
                }
            }
        }
        let nominal = self.nominal();
        let points = system.contacts[0].points.iter();
        let pressures = points.zip(&state.interface.force).map(|(p, f)| f / p.area);
        let pressure = pressures.fold(0.0, |m, p| worse(m, (p + nominal) / nominal));
        [stress, pressure]
    }
}

/// The larger in size; no number where one is none.
fn worse(largest: f64, value: f64) -> f64 {
    match value.is_nan() {
        true => f64::NAN,
        false => largest.max(value.abs()),
    }
}

/// Largest errors over patches, of stress and pressure.
fn largest(patches: &[Patch]) -> Result<[f64; 2], Error> {
    let mut all = [0.0; 2];
    for patch in patches {
        let errors = patch.errors(&patch.loaded()?);
        all = [0, 1].map(|i| worse(all[i], errors[i]));
    }
    Ok(all)
}

/// Errors of both kinds of multipliers, at small and at finite strain.
fn mortar(name: String, patch: Patch) -> Result<[Row; 2], Error> {
    let of = |integration, material| Patch {
        integration,
        material,
        ..patch
    };
    let patches = MORTARS.map(|basis| [SMALL, FINITE].map(|material| of(basis, material)));
    let [stress, pressure] = largest(&patches.concat())?;
    Ok([
        Row::at_most(format!("{name}: stress, error"), stress, ROUND_OFF),
        Row::at_most(format!("{name}: pressure, error"), pressure, ROUND_OFF),
    ])
}

/// The damped law is compliant, so that it has its own uniform pressure: what its points differ by.
fn damped_at_rest() -> Result<Row, Error> {
    let mut worst = 0.0;
    for material in [SMALL, FINITE] {
        let patch = Patch {
            law: damped(&RUBBER, 0.25, 0.5, Adhesion::Clip),
            material,
            ..Patch::new(KINDS[0], Size::Quick)
        };
        let mut newton = patch.loaded()?;
        for _ in 0..REST {
            newton.step()?;
            let points = newton.system().contacts[0].points.iter();
            let forces = &newton.state().interface.force;
            let pressures: Vec<f64> = points.zip(forces).map(|(p, f)| f / p.area).collect();
            let mean = pressures.iter().sum::<f64>() / pressures.len() as f64;
            let differences = pressures.iter().map(|p| (p - mean) / mean);
            worst = differences.fold(worst, worse);
        }
    }
    Ok(Row::at_most(
        format!("damped law, {REST} steps at rest: pressure, difference from its mean"),
        worst,
        AT_REST,
    ))
}

/// The blocks stay as the static stage left them, whatever the law: largest errors over the steps.
fn at_rest(name: &str, law: Law) -> Result<Row, Error> {
    let mut worst = 0.0;
    for material in [SMALL, FINITE] {
        let patch = Patch {
            law,
            material,
            ..Patch::new(KINDS[0], Size::Quick)
        };
        let mut newton = patch.loaded()?;
        for _ in 0..REST {
            newton.step()?;
            worst = patch.errors(&newton).into_iter().fold(worst, worse);
        }
    }
    Ok(Row::at_most(
        format!("{name} law, {REST} steps at rest: stress and pressure, error"),
        worst,
        AT_REST,
    ))
}

pub(crate) const CHECK: Check = Check {
    name: "contact-patch",
    fact: "uniform stress crosses meshes that do not match: mortar to round-off, nodes with their known error",
    run: |size| {
        let mut rows = Vec::new();
        for cells in KINDS {
            let flat = Patch::new(cells, size);
            let name = |what: &str| format!("{}D, {}, {what}", cells.dim, cells.name);
            rows.extend(mortar(name("flat, upright"), flat)?);
            let inclined = Patch {
                slope: SLOPE,
                load: Load::Squeezed,
                ..flat
            };
            rows.extend(mortar(name("inclined, squeezed"), inclined)?);
            // squeezed, so that the rims stay flush: beyond a rim collocated points would face nothing
            let nodes = Patch {
                integration: Integration::Node,
                load: Load::Squeezed,
                ..Patch::new(cells, Size::Quick)
            };
            let [stress, _] = largest(&[nodes])?;
            let name = name("flat, squeezed, nodes: stress, error");
            rows.push(Row::shown(name, stress));
        }
        for cells in [KINDS[0], KINDS[5]] {
            let stuck = Patch {
                slope: SLOPE,
                friction: 0.6,
                ..Patch::new(cells, size)
            };
            let name = format!(
                "{}D, {}, inclined, upright, held by friction",
                cells.dim, cells.name
            );
            // where a side holds nodes across, what the pressure of the last points is is not unique: friction turns it
            let [stress, _] = mortar(name, stuck)?;
            rows.push(stress);
        }
        rows.push(at_rest("displacement", DISPLACEMENT)?);
        rows.push(at_rest("velocity", NOW)?);
        rows.push(damped_at_rest()?);
        Ok(rows)
    },
};
