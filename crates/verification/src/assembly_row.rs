//! A row of assemblies that knock against each other: balances, threads and cuts.
//!
//! Problem: beams of 4 m that are soft in shear, clamped between two plates, five in a row between two rigid walls, reduced to their
//! eight grids and eight modes; stops with gaps of 1.5 mm, dashpots and a curve of crush between them at the grids, a fluid that opposes the
//! motion of neighbours relative to each other, the frame and one plate moved. Closed solution: the balances of energy and momentum over
//! the record; and as sums have a fixed order and a state holds all that the next step needs, the same bytes on any number of
//! threads, cut or not, also of a rod in its grids with friction. Reference: none is needed, and the run on one thread that was not cut.
//!
//! Equal bodies store their reduced matrices once, wherever they stand.
//!
//! Tolerance: 1e-9 of the input work, the bound for linear bodies, as in `rod-in-grid`. Bytes are equal or not. Impacts and
//! crush must be there, or nothing is checked.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use carom_bodies::{
    BeamSection, BeamTheory, BodySpec, DiscreteKind, DiscreteSpec, FluidGap, Kinematics, MassKind,
    SectionProperties,
};
use carom_contact::law::{Adhesion, Crush, Curve, Stop};
use carom_contact::{Initial, Law, Plane};
use carom_dynamics::{
    Driver, Model, ModelBody, ModelContact, ModelDiscrete, ModelTarget, Prescribed, System,
};
use carom_elements::Kind;
use carom_materials::Elastic;
use carom_mesh::{ElementId, Mesh, Surface};
use carom_reduction::{Keep, reduce};
use carom_signals::Amplitude;
use carom_system::Damping;

use crate::Error;
use crate::battery::Battery;
use crate::beams::held;
use crate::build::newmark;
use crate::check::{Check, Row, Size};
use crate::resume::cuts;
use crate::rod_in_grid;
use crate::threads::{pool, run};

const BUNDLE: Elastic = Elastic {
    density: 4000.0,
    young: 50e9,
    poisson: 0.3,
};
const HEIGHT: f64 = 4.0;
/// Elements of a beam; a grid at every fourth node.
const ELEMENTS: u32 = 36;
const GRIDS: u32 = 8;
const GAP: f64 = 1.5e-3;
const STEP: f64 = 5e-4;

/// The row, with a record of `end` s.
fn model(assemblies: u32, end: f64) -> Result<Model, Error> {
    let properties = SectionProperties {
        area: 0.04,
        second_moments: [1.2e-6; 2],
        shear_areas: [4e-6; 2],
        torsion: 1e-6,
    };
    let section = BeamSection::new(BeamTheory::Timoshenko, properties);
    let mut mesh = Mesh::new(2);
    let mut bodies = Vec::new();
    let mut cells: Vec<Vec<ElementId>> = Vec::new();
    let per = ELEMENTS + 1;
    for beam in 0..assemblies {
        for node in 0..per {
            let y = HEIGHT * f64::from(node) / f64::from(ELEMENTS);
            mesh.nodes.push([0.2 * f64::from(beam), y, 0.0]);
        }
        let first = beam * per;
        let own = (0..ELEMENTS).map(|k| mesh.push(Kind::Bar2, &[first + k, first + k + 1]));
        cells.push(own.collect());
    }
    for own in &cells {
        let name = format!("a{}", bodies.len());
        let spec = BodySpec::new(&name, own.clone(), Kinematics::Beam(section), BUNDLE);
        bodies.push(ModelBody {
            mass: MassKind::Consistent,
            ..ModelBody::new(spec)
        });
    }
    let grid = |beam: u32, grid: u32| beam * per + 4 * (grid + 1);
    let at = |beam: u32, k: u32| (grid(beam, k), cells[beam as usize][4 * k as usize + 3]);
    let curve = Curve::new(&[[1.5e-3, 3e3], [1e-2, 3.5e3]])?;
    let law = Law::Stop(Stop {
        clearance: 0.0,
        curve,
        crush: Crush::Permanent,
        damping: 2e3,
        adhesion: Adhesion::Clip,
    });
    let axis = [1.0, 0.0, 0.0];
    let back = [-1.0, 0.0, 0.0];
    let (mut contacts, mut discrete) = (Vec::new(), Vec::new());
    // those in the middle knock first
    for k in (0..GRIDS).map(|k| (k + 3) % GRIDS) {
        for gap in 0..=assemblies {
            let (points, target) = match gap {
                0 => (
                    Surface::of_points(&[at(0, k)], back),
                    wall(&mesh, grid(0, k), axis),
                ),
                gap if gap == assemblies => (
                    Surface::of_points(&[at(gap - 1, k)], axis),
                    wall(&mesh, grid(gap - 1, k), back),
                ),
                gap => (
                    Surface::of_points(&[at(gap - 1, k)], axis),
                    ModelTarget::Surface(Surface::of_points(&[at(gap, k)], back)),
                ),
            };
            contacts.push(ModelContact {
                initial: Initial::Gap(GAP),
                ..ModelContact::new(format!("g{k}-{gap}"), points, target, law)
            });
        }
        for gap in 1..assemblies {
            let cell = mesh.push(Kind::Bar2, &[grid(gap - 1, k), grid(gap, k)]);
            discrete.push(ModelDiscrete::new(DiscreteSpec {
                name: format!("w{k}-{gap}"),
                cells: vec![cell],
                kind: DiscreteKind::Fluid(FluidGap {
                    masses: [8.0, -8.0, 8.0],
                    axis: Some([0.0, 1.0, 0.0]),
                    width: None,
                }),
            }));
        }
    }
    let ends = |place: u32| {
        (0..assemblies)
            .map(|beam| beam * per + place)
            .collect::<Vec<u32>>()
    };
    let mut model = Model {
        contacts,
        discrete,
        supports: vec![
            held(ends(0), [true, true, false], [false, false, true]),
            held(ends(ELEMENTS), [false; 3], [false, false, true]),
        ],
        ..Model::new(bodies, mesh, newmark(0.25, 0.5), STEP)
    };
    model.nonlinear.base[0] = Some(shaken(end, 2.4, 20.0)?);
    model.nonlinear.motions.push(Prescribed {
        nodes: ends(ELEMENTS),
        displacement: [Some(shaken(end, 5.0, 2e-3)?), None, None],
    });
    for body in 0..assemblies as usize {
        reduce(
            &mut model,
            body,
            &Keep {
                modes: 8,
                rayleigh: Damping {
                    mass: 1.5,
                    stiffness: 1e-3,
                },
                ..Keep::default()
            },
        )?;
    }
    Ok(model)
}

fn wall(mesh: &Mesh, node: u32, normal: [f64; 3]) -> ModelTarget {
    ModelTarget::rigid(Plane {
        point: mesh.nodes[node as usize],
        normal,
    })
}

/// A swing of a frequency (Hz) that rises and decays over `end` s.
fn shaken(end: f64, frequency: f64, size: f64) -> Result<Amplitude, Error> {
    let count = (1000.0 * end) as usize;
    let at = |k: usize| {
        let t = end * k as f64 / count as f64;
        [
            t,
            size * (TAU * frequency * t).sin() * (PI * t / end).sin().powi(2),
        ]
    };
    Ok(Amplitude::new((0..=count).map(at).collect())?)
}

/// Number of different sets of matrices that the reduced bodies of a model store.
fn sets(model: &Model) -> usize {
    let reduced = model.bodies.iter().filter_map(|body| body.reduced.as_ref());
    let mut sets: Vec<_> = reduced.map(|one| Arc::as_ptr(&one.matrices)).collect();
    sets.sort_unstable();
    sets.dedup();
    sets.len()
}

/// Rows of the balances of a run of so many steps.
fn balances(assemblies: u32, steps: u64) -> Result<Vec<Row>, Error> {
    let end = steps as f64 * STEP;
    let model = model(assemblies, end)?;
    let sets = sets(&model);
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let (mut input, mut before) = (0.0_f64, 0.0);
    for _ in 0..steps {
        driver.step()?;
        let balance = &driver.report().balance;
        let work = balance.work_loads + balance.work_supports;
        input += (work - before).abs();
        before = work;
    }
    let state = driver.state();
    let ledger = &state.ledger;
    let crushed: f64 = state
        .records
        .contacts
        .iter()
        .map(|c| c.energy_crushed)
        .sum();
    let impacts = state.records.ended().count() as f64;
    Ok(vec![
        Row::count("sets of matrices of equal assemblies", sets, 1),
        Row::at_least("impacts of the row", impacts, 20.0 * end),
        Row::at_least("energy of crush / input work", crushed / input, 1e-3),
        Row::at_most(
            "largest energy residual / input work",
            ledger.largest_energy_residual / input,
            1e-9,
        ),
        Row::at_most(
            "largest momentum residual / largest momentum",
            ledger.largest_momentum_residual / ledger.largest_momentum,
            1e-9,
        ),
    ])
}

pub(crate) const CHECK: Check = Check {
    name: "assembly-row",
    fact: "a row of reduced assemblies knocks through a record: balances; the same bytes on any number of threads, cut or not",
    run: |size| {
        let (assemblies, steps, whole) = match size {
            Size::Quick => (3, 500, 1000),
            Size::Full => (5, 1000, 20_000),
        };
        let mut rows = balances(assemblies, whole)?;
        let mut battery = Battery::default();
        let [one, two] = [pool(1)?, pool(2)?];
        let end = steps as f64 * STEP;
        let rod = rod_in_grid::model(newmark(0.25, 0.5), None, 2e-4, 0.3)?;
        for model in [model(assemblies, end)?, rod] {
            let again = model.clone();
            let system: Arc<System> = one.install(|| crate::witness::system(model))?;
            let second = two.install(|| crate::witness::system(again))?;
            battery.compare(&run(&one, &system, steps)?, &run(&two, &second, steps)?)?;
            let quarters = [1, 2, 3].map(|part| part * steps / 4);
            cuts(
                &mut battery,
                &system,
                (steps, [1, quarters[0], quarters[1], quarters[2]]),
            )?;
        }
        rows.extend(battery.rows("threads and cuts", 2 * 5));
        Ok(rows)
    },
};
