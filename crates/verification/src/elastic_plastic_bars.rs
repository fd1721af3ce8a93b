//! Bars of metal that flows, under uniaxial stress.
//!
//! Problem 1: a bar of four elements of unequal length is pulled, pressed and pulled again by its end, in a static stage; linear isotropic
//! hardening. Closed solution: elastic over twice the largest stress so far, then the slope E H/(E + H); the corners of the
//! loop follow from each other. The plastic work is the area of the loop: dissipated σ_y Σ Δε_p, stored in hardening H ε_p²/2.
//! Tolerance: 1e-9; the iterations leave 1e-10 of the force, and the law has no error of the step on a straight way.
//!
//! Problem 2: a bar held at one end is pulled at the other by a pulse F sin(π t/T) of 1.3 times its yield force, T = 10 L/c, by central
//! differences and by Newmark's scheme with the mean acceleration at the same step. Both have errors of second order in the step, of
//! opposite sign: ω²t dt²/24 and -ω²t dt²/12 in the phase ω t of a vibration. The lowest one, ω = πc/2L, has ω dt = 0.5 π/2n: 6.6e-5 of
//! it with n = 20 elements over a phase of 30, in the part of the motion that vibrates, some tenths of it. So: less than 2e-3 of the
//! amplitude, at each of two steps. No order is asked for: in a step in which an element begins to flow each scheme has an error of first
//! order of its own. The balances hold to the iterations, 1e-9.

use carom_bodies::{BodySpec, Kinematics};
use carom_dynamics::{
    Amplitude, Driver, Load, LoadKind, Model, ModelBody, Preload, Prescribed, Scheme,
};
use carom_materials::{Elastic, J2Plasticity, Law};
use carom_mesh::generate;

use crate::Error;
use crate::build::{CENTRAL, group, newmark, support, surface};
use crate::check::{Check, Row, Size};

const STEEL: J2Plasticity = J2Plasticity {
    initial: Elastic {
        density: 7800.0,
        young: 210e9,
        poisson: 0.3,
    },
    yield_stress: 300e6,
    hardening: 10e9,
};
const AREA: f64 = 3e-4;
const LENGTH: f64 = 2.0;

/// Slope of the stress where the bar flows, Pa.
fn slope() -> f64 {
    let (young, hardening) = (STEEL.initial.young, STEEL.hardening);
    young * hardening / (young + hardening)
}

fn bar(mesh: &carom_mesh::Mesh) -> Result<ModelBody, Error> {
    let cells = group(mesh, "bar")?.elements.clone();
    let kinematics = Kinematics::Bar { area: AREA };
    let law = Law::J2Plasticity(STEEL);
    Ok(ModelBody::new(BodySpec::new("bar", cells, kinematics, law)))
}

/// Problem 1.
fn cycle() -> Result<Vec<Row>, Error> {
    const STRAIN: f64 = 5e-3;
    const STEPS: u64 = 10;
    let turns = [STRAIN, -STRAIN, 2.0 * STRAIN, 0.0];
    let mut mesh = generate::line("bar", [0.0; 3], [LENGTH, 0.0, 0.0], 4, 1);
    // elements of unequal length
    for x in &mut mesh.nodes {
        x[0] = x[0] * x[0] / LENGTH;
    }
    let mut points = vec![[0.0, 0.0]];
    points.extend(
        turns
            .iter()
            .enumerate()
            .map(|(k, strain)| [k as f64 + 1.0, strain * LENGTH]),
    );
    let mut model = Model {
        supports: vec![support(&mesh, "bar.left", [true; 3])?],
        ..Model::new(vec![bar(&mesh)?], mesh, newmark(0.25, 0.5), 1.0)
    };
    let end = turns.len() as f64;
    model.nonlinear.motions = vec![Prescribed {
        nodes: vec![4],
        displacement: [Some(Amplitude::new(points)?), None, None],
    }];
    model.nonlinear.preload = Some(Preload {
        end,
        steps: turns.len() as u64 * STEPS,
    });
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let young = STEEL.initial.young;
    let (mut stress, mut strain, mut size, mut flowed) = (0.0, 0.0, STEEL.yield_stress, 0.0);
    let mut rows = Vec::new();
    for (k, &turn) in turns.iter().enumerate() {
        for _ in 0..STEPS {
            driver.step()?;
        }
        let way: f64 = turn - strain;
        let elastic = (size - way.signum() * stress) / young;
        stress = way.signum() * (size + slope() * (way.abs() - elastic));
        size = stress.abs();
        strain = turn;
        flowed = (size - STEEL.yield_stress) / STEEL.hardening;
        let system = driver.system();
        let unknown = system.unknowns.first(system.number[4]);
        let force = driver.state().motion.internal_force[unknown];
        let name = format!("cycle: force at corner {}, N", k + 1);
        rows.push(Row::relative(name, force, stress * AREA, 1e-9));
    }
    let state = driver.state();
    let (body, ledger) = (&driver.system().bodies[0], &state.ledger.balance);
    let strains = body
        .plastic_strains(&state.motion.history)
        .unwrap_or_default();
    let volume = AREA * LENGTH;
    let hardening = 0.5 * STEEL.hardening * flowed * flowed;
    rows.extend([
        Row::relative("cycle: plastic strain", strains[0], flowed, 1e-9),
        Row::relative(
            "cycle: dissipated, J",
            ledger.dissipation_material,
            STEEL.yield_stress * flowed * volume,
            1e-9,
        ),
        Row::relative(
            "cycle: stored in hardening, J",
            ledger.hardening,
            hardening * volume,
            1e-9,
        ),
    ]);
    Ok(rows)
}

/// Displacement of the end after the pulse, largest residual of the energy over the energy, and the plastic strain at the held end.
fn pulse(elements: usize, scheme: Scheme, part: f64) -> Result<[f64; 3], Error> {
    let mesh = generate::line("bar", [0.0; 3], [LENGTH, 0.0, 0.0], elements, 1);
    let made = bar(&mesh)?;
    let speed = (STEEL.initial.young / STEEL.initial.density).sqrt();
    let dt = part * LENGTH / elements as f64 / speed;
    let time = 10.0 * LENGTH / speed;
    let sine = |k: u32| {
        let at = f64::from(k) / 200.0;
        [at * time, (std::f64::consts::PI * at).sin()]
    };
    let load = Load {
        name: "pulse".into(),
        surface: surface(&mesh, "bar.right", &made)?,
        kind: LoadKind::Traction([1.3 * STEEL.yield_stress, 0.0, 0.0]),
        amplitude: Amplitude::new((0..=200).map(sine).collect())?,
    };
    let mut model = Model {
        supports: vec![support(&mesh, "bar.left", [true; 3])?],
        ..Model::new(vec![made], mesh, scheme, dt)
    };
    model.nonlinear.loads = vec![load];
    model.nonlinear.iteration.tolerance = 1e-12;
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let steps = (time / dt).round() as usize;
    for _ in 0..steps {
        driver.step()?;
    }
    let (system, state) = (driver.system(), driver.state());
    let end = system.unknowns.first(system.number[elements]);
    let strains = system.bodies[0].plastic_strains(&state.motion.history);
    let ledger = &state.ledger;
    Ok([
        state.motion.u[end],
        ledger.largest_energy_residual / ledger.largest_energy,
        strains.unwrap_or_default()[0],
    ])
}

/// Problem 2.
fn explicit_and_implicit(elements: usize) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for part in [0.5, 0.25] {
        let [explicit, implicit] =
            [CENTRAL, newmark(0.25, 0.5)].map(|scheme| pulse(elements, scheme, part));
        let ([one, residual, strain], [other, second, _]) = (explicit?, implicit?);
        let name = |what: &str| format!("pulse, {part} h/c: {what}");
        rows.extend([
            Row::at_least(name("plastic strain at the held end"), strain, 1e-3),
            Row::at_most(name("energy residual, explicit"), residual, 1e-9),
            Row::at_most(name("energy residual, implicit"), second, 1e-9),
            Row::at_most(
                name("difference of explicit and implicit at the end"),
                (one / other - 1.0).abs(),
                2e-3,
            )
            .second_formulation(),
        ]);
    }
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "elastic-plastic-bars",
    fact: "a bar of metal that flows follows the closed form around a loop of strains, and both kinds of schemes give it the same motion",
    run: |size| {
        let mut rows = cycle()?;
        rows.extend(explicit_and_implicit(match size {
            Size::Quick => 20,
            Size::Full => 100,
        })?);
        Ok(rows)
    },
};
