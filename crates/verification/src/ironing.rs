//! Ironing: an indenter with a round foot is pressed into a block and moved along it.
//!
//! Problem: the meshes of cases/ironing, plane strain, neo-Hooke, ν = 0.32, indenter E = 68.96e8 Pa, block 68.96e7 Pa; a
//! static stage with the indenter's top prescribed, 1 mm down in 10 steps, then 10 mm along the block in 500; the block is
//! the secondary side, dual mortar, displacement law; frictionless, and with μ = 0.3. After Puso and Laursen (2004), whose
//! forces depend on their mesh. Closed solution: none; facts that the issue states, and two of mechanics.
//!
//! Jump: the largest change of the force on the indenter from one step of the sliding to the next, as a vector, over the
//! mean force. With friction it includes the first 2 mm, in which friction turns into the direction of the sliding, whatever the
//! mesh: a regression, to 1 % of the figure. Wave: what the force differs from the polynomial of the way, of degree 5, that fits
//! it best, after these 2 mm: the passage of the facets. (The ends of the block add 0.15 % that a cubic leaves over, whatever
//! the mesh; higher degrees change no wave by a tenth.) The wave, and the jump after these 2 mm, a step on its slope, must
//! fall to half when the mesh is halved, the least for an error of first order.
//! Node-to-face: its jump after the 2 mm, or in the second half of a shorter way, is shown. Without friction nothing dissipates
//! and the block is long, so the mean drag vanishes but for the wave. With friction the dissipation is μ times normal force times
//! the way of the indenter but for the stretch of the surfaces along it: a regression, to 1 %. Energy balance: a step leaves at most the tolerance times force times way, over all steps 1e-6 · 900 N · 11 mm, that is 3e-5 of the
//! largest energy.
//! Sizes: quick 40 steps of the sliding on the coarse mesh; full all 500, on the coarse and the middle one. The finest takes
//! two to six minutes a run, too long for either; run once, in % of the mean force, coarse, middle and finest mesh:
//!
//! | | jump | jump after 2 mm | wave |
//! |---|---|---|---|
//! | mortar | 0.22, 0.092, 0.055 | 0.22, 0.092, 0.055 | 0.68, 0.17, 0.050 |
//! | mortar, μ = 0.3 | 1.11, 1.09, 1.10 | 0.28, 0.12, 0.070 | 0.94, 0.24, 0.061 |
//! | node-to-face | 1.41, 0.40, 0.11 | 1.41, 0.40, 0.11 | 1.26, 0.34, 0.10 |

use carom_bodies::Kinematics;
use carom_contact::{Basis, Integration};
use carom_dynamics::{
    Amplitude, Driver, Iteration, Model, ModelBody, ModelTarget, Nonlinear, Preload, Prescribed,
};
use carom_materials::Elastic;
use carom_mesh::Mesh;

use crate::Error;
use crate::build::{DISPLACEMENT, contact, group, neo_hooke, newmark, support, surface};
use crate::check::{Check, Row, Size};
use crate::meshes;
use crate::newton_order::{Iterations, OUT_OF_REACH};

const MM: f64 = 1e-3;
const DOWN: u64 = 10;
const ALONG: u64 = 500;
/// Steps of the sliding after which friction has turned everywhere.
const TURNED: usize = 100;
const MU: f64 = 0.3;
const TOLERANCE: f64 = 1e-6;
/// Σ of force times way over the largest energy.
const WORK: f64 = 30.0;
const MORTAR: Integration = Integration::Mortar { basis: Basis::Dual };

/// What is left of a run.
struct Run {
    /// Force on the indenter in the steps of the sliding, N.
    forces: Vec<[f64; 2]>,
    /// Σ of the normal forces times the way of the indenter in the sliding, J.
    pressed: f64,
    dissipated: f64,
    residual: f64,
}

fn elastic(mesh: &Mesh, name: &str, young: f64) -> Result<ModelBody, Error> {
    let elastic = Elastic {
        density: 1000.0,
        young,
        poisson: 0.32,
    };
    let kinematics = Kinematics::PlaneStrain { thickness: MM };
    neo_hooke(mesh, name, kinematics, elastic)
}

/// The model, one second to a step.
fn model(file: &str, friction: f64, integration: Integration, slides: u64) -> Result<Model, Error> {
    let mut mesh = meshes::mesh(file)?;
    mesh.scale(MM);
    let bodies = vec![
        elastic(&mesh, "block", 68.96e7)?,
        elastic(&mesh, "indenter", 68.96e8)?,
    ];
    let foot = surface(&mesh, "indenter.contact", &bodies[1])?;
    let mut iron = contact(
        surface(&mesh, "block.contact", &bodies[0])?,
        ModelTarget::Surface(foot),
        DISPLACEMENT,
    );
    (iron.integration, iron.friction) = (integration, friction.into());
    let steps = DOWN + slides;
    let (pressed, end) = (DOWN as f64, steps as f64);
    let way = 10.0 * MM * slides as f64 / ALONG as f64;
    let along = Amplitude::new(vec![[pressed, 0.0], [end, way]])?;
    let down = Amplitude::new(vec![[0.0, 0.0], [pressed, -MM]])?;
    Ok(Model {
        supports: vec![support(&mesh, "block.bottom", [true, true, false])?],
        contacts: vec![iron],
        nonlinear: Nonlinear {
            motions: vec![Prescribed {
                nodes: mesh.group_nodes(group(&mesh, "indenter.top")?),
                displacement: [Some(along), Some(down), None],
            }],
            preload: Some(Preload { end, steps }),
            iteration: Iteration {
                tolerance: TOLERANCE,
                ..Iteration::default()
            },
            ..Nonlinear::default()
        },
        ..Model::new(bodies, mesh, newmark(0.25, 0.5), 1.0)
    })
}

fn iron(file: &str, friction: f64, integration: Integration, slides: u64) -> Result<Run, Error> {
    let model = model(file, friction, integration, slides)?;
    let top = model.nonlinear.motions[0].nodes.clone();
    let mut newton = Driver::new(crate::witness::system(model)?)?;
    let (mut forces, mut pressed) = (Vec::new(), 0.0);
    for step in 0..DOWN + slides {
        newton.step()?;
        if step < DOWN {
            continue;
        }
        pressed += newton.report().contacts[0].force * 10.0 * MM / ALONG as f64;
        let (system, inside) = (newton.system(), &newton.state().motion.internal_force);
        let mut force = [0.0; 2];
        for &node in &top {
            let first = 2 * system.number[node as usize] as usize;
            for (sum, f) in force.iter_mut().zip(&inside[first..]) {
                *sum += f;
            }
        }
        forces.push(force);
    }
    let ledger = &newton.state().ledger;
    Ok(Run {
        forces,
        pressed,
        dissipated: ledger.balance.dissipation_friction,
        residual: ledger.largest_energy_residual / ledger.largest_energy,
    })
}

/// Iterations of the first steps, pressed and slid, to another tolerance.
fn iterations(file: &str, friction: f64, tolerance: f64) -> Result<Iterations, Error> {
    let mut model = model(file, friction, MORTAR, ALONG)?;
    model.nonlinear.iteration.tolerance = tolerance;
    let mut newton = Driver::new(crate::witness::system(model)?)?;
    let mut iterations = Iterations::default();
    for _ in 0..2 * DOWN {
        newton.step()?;
        iterations.follow(&newton);
    }
    Ok(iterations)
}

impl Run {
    /// Mean of the force from a step on, N.
    fn mean(&self, from: usize) -> [f64; 2] {
        let forces = &self.forces[from..];
        [0, 1].map(|i| forces.iter().map(|f| f[i]).sum::<f64>() / forces.len() as f64)
    }

    /// Size of the mean force, N.
    fn size(&self) -> f64 {
        let [x, y] = self.mean(0);
        x.hypot(y)
    }

    /// Largest step-to-step change from a step on, over the mean.
    fn jump(&self, from: usize) -> f64 {
        let change = |pair: &[[f64; 2]]| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
        let changes = self.forces[from..].windows(2).map(change);
        changes.fold(0.0, f64::max) / self.size()
    }

    /// Largest distance from the best polynomial of degree 5, over the mean.
    fn wave(&self) -> f64 {
        let [x, y] = [0, 1].map(|i| {
            let values: Vec<f64> = self.forces[TURNED..].iter().map(|f| f[i]).collect();
            without_smooth(&values)
        });
        let sizes = x.iter().zip(&y).map(|(x, y)| x.hypot(*y));
        sizes.fold(0.0, f64::max) / self.size()
    }
}

/// Values at equal distances less the polynomial of degree 5 of least squares: less their parts along orthogonal polynomials,
/// which Gram and Schmidt's method makes of the powers.
fn without_smooth(values: &[f64]) -> Vec<f64> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let remove = |from: &mut [f64], along: &[f64]| {
        let part = dot(from, along) / dot(along, along);
        from.iter_mut().zip(along).for_each(|(f, a)| *f -= part * a);
    };
    let mut rest = values.to_vec();
    let mut polynomials: Vec<Vec<f64>> = Vec::new();
    for power in 0..=5 {
        let place = |k: usize| 2.0 * k as f64 / values.len() as f64 - 1.0;
        let mut polynomial: Vec<f64> = (0..values.len()).map(|k| place(k).powi(power)).collect();
        for before in &polynomials {
            remove(&mut polynomial, before);
        }
        remove(&mut rest, &polynomial);
        polynomials.push(polynomial);
    }
    rest
}

/// Figures that were found with mortar.
#[derive(Clone, Copy)]
struct Own {
    jump: f64,
    /// Over μ Σ P Δx; none without friction or in part of the way.
    dissipated: f64,
}

/// On the coarse mesh in part of the way, there and on the middle one in all of it; without friction and with it.
const OWN: [[Own; 3]; 2] = [
    [
        own(0.00211887, NONE),
        own(0.00217834, NONE),
        own(9.15312e-4, NONE),
    ],
    [
        own(0.0113731, NONE),
        own(0.0111416, 0.969302),
        own(0.0108612, 0.964088),
    ],
];
const NONE: f64 = f64::NAN;

const fn own(jump: f64, dissipated: f64) -> Own {
    Own { jump, dissipated }
}

/// Mortar and node-to-face on one mesh: rows; jump after the turn of friction and wave of mortar, wave of node-to-face.
fn beside(
    name: &str,
    file: &str,
    mu: f64,
    slides: u64,
    own: Own,
) -> Result<(Vec<Row>, [f64; 3]), Error> {
    let (mortar, node) = rayon::join(
        || iron(file, mu, MORTAR, slides),
        || iron(file, mu, Integration::Node, slides),
    );
    let (mortar, node) = (mortar?, node?);
    let row = |what: &str| format!("{name}: {what}");
    let later = TURNED.min(slides as usize / 2);
    let mut rows = vec![
        Row::relative(row("jump / mean force"), mortar.jump(0), own.jump, 0.01).regression(),
        Row::shown(
            row("jump after the turn of friction / mean force, node-to-face"),
            node.jump(later),
        ),
        Row::at_most(
            row("energy residual / largest"),
            mortar.residual,
            WORK * TOLERANCE,
        ),
    ];
    rows.extend(iterations(file, mu, 1e-10)?.rows(name, 6.0));
    rows.push(iterations(file, mu, OUT_OF_REACH)?.quadratic(name));
    if slides < ALONG {
        return Ok((rows, [0.0; 3]));
    }
    let waves = [mortar.jump(later), mortar.wave(), node.wave()];
    if mu == 0.0 {
        let [drag, press] = mortar.mean(0);
        rows.push(Row::at_most(
            row("mean drag / mean force"),
            (drag / press).abs(),
            mortar.wave(),
        ));
    } else {
        let ratio = mortar.dissipated / (mu * mortar.pressed);
        let what = row("dissipated / (μ Σ P Δx)");
        rows.push(Row::relative(what, ratio, own.dissipated, 0.01).regression());
    }
    Ok((rows, waves))
}

pub(crate) const CHECK: Check = Check {
    name: "ironing",
    fact: "the force of an indenter that slides over facets does not jump with mortar, and its wave falls with the mesh",
    run: |size| {
        let mut rows = Vec::new();
        for (mu, [part, coarse, middle]) in [0.0, MU].into_iter().zip(OWN) {
            let name = |mesh: &str| format!("{mesh} mesh, μ = {mu}");
            let file = "ironing/ironing-coarse.msh";
            if size == Size::Quick {
                rows.extend(beside(&name("coarse"), file, mu, 40, part)?.0);
                continue;
            }
            let (found, wide) = beside(&name("coarse"), file, mu, ALONG, coarse)?;
            rows.extend(found);
            let (found, narrow) =
                beside(&name("middle"), "ironing/ironing.msh", mu, ALONG, middle)?;
            rows.extend(found);
            let falling = [
                "mortar: jump after the turn of friction",
                "mortar: wave",
                "node-to-face: wave",
            ];
            for (k, what) in falling.into_iter().enumerate() {
                let what = format!(
                    "μ = {mu}, {what}, {:.2e} on the coarse mesh, middle / coarse",
                    wide[k]
                );
                rows.push(Row::at_most(what, narrow[k] / wide[k], 0.5));
            }
        }
        Ok(rows)
    },
};
