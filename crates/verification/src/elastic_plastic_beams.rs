//! Beams of metal that flows, with fibres in their sections.
//!
//! Problem 1: an element whose ends turn against each other, ideal plasticity, static; with small rotations and with finite ones.
//! Closed solution with κ_y = 2σ_y/(E h) and the elastic core y_e = h/2 κ_y/κ: a rectangle has M = M_p (1 - (κ_y/κ)²/3), M_p = σ_y b h²/4; a
//! circle of radius R M = 4σ_y (R⁴/8 asin(y_e/R) - y_e/8 sqrt(R² - y_e²) (R² - 2y_e²))/y_e + 4/3 σ_y (R² - y_e²)^(3/2). Unloading is elastic:
//! M falls by E I Δκ, so that at M = 0 the curvature κ - M/E I remains.
//! Tolerance: the bound of the rule, stated in `crates/bodies/src/beam/fibres.rs`: 0.24/N² of M_p for a rectangle, and for a circle in addition
//! (π/4N)²/6 + 2.2/N³. The elastic slope is exact to rounding, 1e-10.
//!
//! Problem 2: half of a beam of Euler-Bernoulli, clamped at its end and held against turning in its middle, which is pushed aside; ideal
//! plasticity. Limit load of the whole beam: 8 M_p/L. Of the mesh it is higher, in closed form: M_p is reached at the points of Gauss nearest
//! to the ends, g h from them, g = (1 - 1/√3)/2, and between them the moment is linear: 8 M_p/(L - 4 g h). Where a section flows
//! throughout its moment is M_p exactly, so that the tolerance is that of the iterations, 1e-6 of the load.
//!
//! Problem 3: the element of problem 1 is bent to and fro by ±κ. Dissipated in a cycle: 4σ_y b κ (h/2 - y_e)². Fact: that is the area of the
//! loop, and the loop closes. Tolerances: the rule misses 0.0893 (t/2)² of the slope of the kink at y_e on both sides, t = h/N:
//! 0.18 t²/(4 (h/2 - y_e)²) of the dissipation. The work is that of forces that vary evenly over each step, where fibres begin to flow within it:
//! 2/m² with m steps in half a cycle. The loop closes to rounding, 1e-10.
//!
//! Problem 4: a cantilever is pushed by a pulse at its tip, by central differences and by Newmark's scheme with the mean acceleration at the
//! same step. Tolerance: both have errors of second order in the step: ω t (ω dt)²/8 of a phase ω t. With dt = 1 µs the lowest frequency has
//! ω dt = 1e-3, and what ten times higher ones have of the deflection, some hundredths, errs by 1e-4 of a phase of 100: less than 1e-3 of
//! the deflection. Balances hold to 1e-9.
//!
//! Problem 5: a cantilever whose tip a mass G strikes with the speed v. Rigid-plastic metal (Parkes 1955, Proc. R. Soc. A 228, 462): a hinge
//! travels from the tip to the root, then the beam turns about the root. With β = mL/2G, m its mass per length, the final deflection of
//! the tip is G² v²/(3 m M_p) (β/(1 + β) + 2 ln(1 + β)). Waves of bending run ahead of the hinge and may take its place; if the root alone flows,
//! the deflection is G v² L/2M_p, more by 3 % with β = 0.03. So it is between both: not above the latter, not below Parkes' one less
//! 2/r + g h/L: elastic energy, M_p² L/2EI at most, a part 1/r of the kinetic one, is not spent in hinges, as much goes into vibrations
//! at most, and the hinge of the mesh is g h from the root.

use carom_bodies::{
    BeamSection, BeamTheory, BodySpec, DiscreteKind, DiscreteSpec, Kinematics, MassKind, PointMass,
    Rotations, SectionShape,
};
use carom_dynamics::{
    Amplitude, Driver, Model, ModelBody, ModelDiscrete, NodalLoad, Preload, Prescribed,
    PrescribedTurn, Scheme,
};
use carom_elements::Kind;
use carom_materials::{Elastic, J2Plasticity, Law};
use carom_mesh::{Mesh, generate};

use crate::Error;
use crate::beams::held;
use crate::build::{CENTRAL, group, newmark};
use crate::check::{Check, Row, Size};

/// Ideal plasticity.
const STEEL: J2Plasticity = J2Plasticity {
    initial: Elastic {
        density: 7800.0,
        young: 210e9,
        poisson: 0.3,
    },
    yield_stress: 300e6,
    hardening: 0.0,
};
const HEIGHT: f64 = 0.05;
const WIDTH: f64 = 0.03;
const RECTANGLE: SectionShape = SectionShape::Rectangle {
    height: HEIGHT,
    width: WIDTH,
};
const CIRCLE: SectionShape = SectionShape::Circle { diameter: HEIGHT };
/// (1 - 1/√3)/2.
const GAUSS: f64 = 0.211_324_865_405_187_1;

fn yield_curvature() -> f64 {
    2.0 * STEEL.yield_stress / (STEEL.initial.young * HEIGHT)
}

fn plastic_moment() -> f64 {
    0.25 * STEEL.yield_stress * WIDTH * HEIGHT * HEIGHT
}

fn section(shape: SectionShape, layers: u32, theory: BeamTheory) -> BeamSection {
    BeamSection {
        shape: Some(shape),
        layers,
        ..BeamSection::new(theory, shape.properties(STEEL.initial.poisson))
    }
}

fn beam(mesh: &Mesh, section: BeamSection, law: J2Plasticity) -> Result<ModelBody, Error> {
    let cells = group(mesh, "beam")?.elements.clone();
    let law = Law::J2Plasticity(law);
    let spec = BodySpec::new("beam", cells, Kinematics::Beam(section), law);
    Ok(ModelBody::new(spec))
}

/// Moments of an element at the curvatures of its turning points, and the balance at each: dissipated, and the work of the supports, J.
struct Bent {
    moments: Vec<f64>,
    dissipated: Vec<f64>,
    work: Vec<f64>,
}

const ELEMENT: f64 = 0.02;

fn bent(section: BeamSection, curvatures: &[f64], steps: u64) -> Result<Bent, Error> {
    let mesh = generate::line("beam", [0.0; 3], [ELEMENT, 0.0, 0.0], 1, 2);
    let made = beam(&mesh, section, STEEL)?;
    let turn = |node: u32, sign: f64| {
        let mut points = vec![[0.0, 0.0]];
        let angle = |kappa: &f64| 0.5 * sign * kappa * ELEMENT;
        let ends = curvatures.iter().enumerate();
        points.extend(ends.map(|(k, kappa)| [k as f64 + 1.0, angle(kappa)]));
        Ok::<_, Error>(PrescribedTurn {
            node,
            axis: 2,
            angle: Amplitude::new(points)?,
        })
    };
    let fix = |node, fix| held(vec![node], fix, [false; 3]);
    let mut model = Model {
        supports: vec![fix(0, [true; 3]), fix(1, [false, true, true])],
        ..Model::new(vec![made], mesh, newmark(0.25, 0.5), 1.0)
    };
    model.nonlinear.turns = vec![turn(0, -1.0)?, turn(1, 1.0)?];
    model.nonlinear.preload = Some(Preload {
        end: curvatures.len() as f64,
        steps: steps * curvatures.len() as u64,
    });
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let (mut moments, mut dissipated, mut work) = (Vec::new(), Vec::new(), Vec::new());
    for _ in curvatures {
        for _ in 0..steps {
            driver.step()?;
        }
        let (system, state) = (driver.system(), driver.state());
        let turned = system.unknowns.first(system.number[1]) + 2;
        moments.push(state.motion.internal_force[turned]);
        dissipated.push(state.ledger.balance.dissipation_material);
        work.push(state.ledger.balance.work_supports);
    }
    Ok(Bent {
        moments,
        dissipated,
        work,
    })
}

/// M of the curvature r κ_y, r above 1.
fn exact(shape: &SectionShape, r: f64) -> f64 {
    match shape {
        SectionShape::Circle { diameter } => {
            let radius = 0.5 * diameter;
            let core = radius / r;
            let chord = (radius * radius - core * core).sqrt();
            let inside = radius.powi(4) / 8.0 * (1.0 / r).asin()
                - core / 8.0 * chord * (radius * radius - 2.0 * core * core);
            4.0 * STEEL.yield_stress * (inside / core + chord.powi(3) / 3.0)
        }
        _ => plastic_moment() * (1.0 - 1.0 / (3.0 * r * r)),
    }
}

/// Problem 1.
fn curvatures(layers: u32) -> Result<Vec<Row>, Error> {
    let n = f64::from(layers);
    let kink = 0.24 / (n * n);
    let round = kink + (std::f64::consts::PI / (4.0 * n)).powi(2) / 6.0 + 2.2 / n.powi(3);
    let mut rows = Vec::new();
    for (shape, label, bound) in [(RECTANGLE, "rectangle", kink), (CIRCLE, "circle", round)] {
        for (rotations, kind) in [(Rotations::Small, "small"), (Rotations::Finite, "finite")] {
            let section = BeamSection {
                rotations,
                ..section(shape, layers, BeamTheory::Timoshenko)
            };
            let ratios = [0.9, 1.5, 2.0, 5.0, 10.0, 8.5];
            let kappas = ratios.map(|r| r * yield_curvature());
            let found = bent(section, &kappas, 4)?.moments;
            let bending = STEEL.initial.young * section.properties.second_moments[1];
            let name = |what: &str| format!("{label}, {kind} rotations, {layers} layers: {what}");
            rows.push(Row::relative(
                name("moment before yield, N m"),
                found[0],
                bending * kappas[0],
                1e-10,
            ));
            let most = exact(&shape, 1e6);
            for k in 1..5 {
                let what = format!("moment at {} of the curvature of yield, N m", ratios[k]);
                let reference = exact(&shape, ratios[k]);
                rows.push(Row::near(name(&what), found[k], reference, bound * most));
            }
            rows.push(Row::relative(
                name("slope of the unloading, N m²"),
                (found[4] - found[5]) / (kappas[4] - kappas[5]),
                bending,
                1e-10,
            ));
        }
    }
    Ok(rows)
}

/// Problem 2.
fn limit(elements: usize) -> Result<Vec<Row>, Error> {
    const LENGTH: f64 = 1.0;
    let mesh = generate::line("beam", [0.0; 3], [0.5 * LENGTH, 0.0, 0.0], elements, 2);
    let made = beam(
        &mesh,
        section(RECTANGLE, 8, BeamTheory::EulerBernoulli),
        STEEL,
    )?;
    let middle = elements as u32;
    // both hinges flow throughout: 80 of the curvature of yield in half an element
    let push = -2.0 * 80.0 * yield_curvature() * LENGTH * LENGTH / (8.0 * elements as f64);
    let mut model = Model {
        supports: vec![
            held(vec![0], [true; 3], [true; 3]),
            held(vec![middle], [false; 3], [true; 3]),
        ],
        ..Model::new(vec![made], mesh, newmark(0.25, 0.5), 1.0)
    };
    model.nonlinear.motions = vec![Prescribed {
        nodes: vec![middle],
        displacement: [
            None,
            Some(Amplitude::new(vec![[0.0, 0.0], [1.0, push]])?),
            None,
        ],
    }];
    model.nonlinear.preload = Some(Preload {
        end: 1.0,
        steps: 40,
    });
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    for _ in 0..40 {
        driver.step()?;
    }
    let (system, state) = (driver.system(), driver.state());
    let pushed = system.unknowns.first(system.number[elements]) + 1;
    let force = -2.0 * state.motion.internal_force[pushed];
    let size = 0.5 * LENGTH / elements as f64;
    let discrete = 8.0 * plastic_moment() / (LENGTH - 4.0 * GAUSS * size);
    let exact = 8.0 * plastic_moment() / LENGTH;
    Ok(vec![
        Row::relative("limit load of the mesh, N", force, discrete, 1e-6),
        Row::at_most(
            "limit load over the exact one less 1",
            force / exact - 1.0,
            1.1 * 4.0 * GAUSS * size / LENGTH,
        ),
    ])
}

/// Problem 3.
fn cycles(layers: u32, steps: u64) -> Result<Vec<Row>, Error> {
    let kappa = 2.0 * yield_curvature();
    let way = [kappa, -kappa, kappa, -kappa, kappa];
    let section = section(RECTANGLE, layers, BeamTheory::Timoshenko);
    let found = bent(section, &way, steps)?;
    let core = 0.25 * HEIGHT;
    let rest = 0.5 * HEIGHT - core;
    let exact = 4.0 * STEEL.yield_stress * WIDTH * kappa * rest * rest * ELEMENT;
    let thickness = HEIGHT / f64::from(layers);
    let bound = 0.18 * thickness * thickness / (4.0 * rest * rest);
    let cycle = found.dissipated[4] - found.dissipated[2];
    let work = found.work[4] - found.work[2];
    Ok(vec![
        Row::relative("cycle: dissipated, J", cycle, exact, bound),
        Row::relative(
            "cycle: work of the supports, J",
            work,
            cycle,
            2.0 / (steps * steps) as f64,
        ),
        Row::relative(
            "cycle: moment after the second cycle, N m",
            found.moments[4],
            found.moments[2],
            1e-10,
        ),
        Row::relative(
            "cycle: moment on the other side, N m",
            -found.moments[3],
            found.moments[2],
            1e-10,
        ),
    ])
}

/// Deflection of the tip of a cantilever after a pulse, residual of its energy over the energy, largest plastic strain.
fn pushed(elements: usize, scheme: Scheme, dt: f64, steps: usize) -> Result<[f64; 3], Error> {
    const LENGTH: f64 = 0.5;
    let mesh = generate::line("beam", [0.0; 3], [LENGTH, 0.0, 0.0], elements, 2);
    let hard = J2Plasticity {
        hardening: 5e9,
        ..STEEL
    };
    let mut made = beam(&mesh, section(RECTANGLE, 8, BeamTheory::Timoshenko), hard)?;
    made.mass = MassKind::Lumped;
    let time = dt * steps as f64;
    let sine = |k: u32| {
        let at = f64::from(k) / 100.0;
        [at * time, (std::f64::consts::PI * at).sin()]
    };
    let mut model = Model {
        supports: vec![held(vec![0], [true; 3], [true; 3])],
        ..Model::new(vec![made], mesh, scheme, dt)
    };
    model.nonlinear.nodal = vec![NodalLoad {
        name: "tip".into(),
        nodes: vec![elements as u32],
        force: [0.0, -1.2 * plastic_moment() / LENGTH, 0.0],
        moment: [0.0; 3],
        amplitude: Amplitude::new((0..=100).map(sine).collect())?,
    }];
    model.nonlinear.iteration.tolerance = 1e-12;
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    for _ in 0..steps {
        driver.step()?;
    }
    let (system, state) = (driver.system(), driver.state());
    let tip = system.unknowns.first(system.number[elements]) + 1;
    let strains = system.bodies[0].plastic_strains(&state.motion.history);
    let ledger = &state.ledger;
    Ok([
        state.motion.u[tip],
        ledger.largest_energy_residual / ledger.largest_energy,
        strains.unwrap_or_default().into_iter().fold(0.0, f64::max),
    ])
}

/// Problem 4.
fn explicit_and_implicit(elements: usize) -> Result<Vec<Row>, Error> {
    // two periods of the lowest frequency, 3.516 sqrt(E I/ρ A L⁴) = 1050 1/s
    let of = |scheme| pushed(elements, scheme, 1e-6, 12_000);
    let ([one, residual, strain], [other, second, _]) = (of(CENTRAL)?, of(newmark(0.25, 0.5))?);
    Ok(vec![
        Row::at_least("pulse: largest plastic strain", strain, 1e-3),
        Row::at_most("pulse: energy residual, explicit", residual, 1e-9),
        Row::at_most("pulse: energy residual, implicit", second, 1e-9),
        Row::at_most(
            "pulse: difference of explicit and implicit at the end",
            (one / other - 1.0).abs(),
            1e-3,
        )
        .second_formulation(),
    ])
}

/// Problem 5.
fn struck(elements: usize) -> Result<Vec<Row>, Error> {
    const LENGTH: f64 = 0.5;
    const MASS: f64 = 100.0;
    let section = section(RECTANGLE, 16, BeamTheory::EulerBernoulli);
    let bending = STEEL.initial.young * section.properties.second_moments[1];
    let elastic = 0.5 * plastic_moment().powi(2) * LENGTH / bending;
    let ratio = 40.0;
    let speed = (2.0 * ratio * elastic / MASS).sqrt();
    let mut mesh = generate::line("beam", [0.0; 3], [LENGTH, 0.0, 0.0], elements, 2);
    let mut made = beam(&mesh, section, STEEL)?;
    made.mass = MassKind::Lumped;
    let cell = mesh.push(Kind::Point1, &[elements as u32]);
    let mut striker = ModelDiscrete::new(DiscreteSpec {
        name: "striker".into(),
        cells: vec![cell],
        kind: DiscreteKind::Mass(PointMass {
            mass: MASS,
            inertia: [0.0; 3],
        }),
    });
    striker.velocity = Some([0.0, -speed, 0.0]);
    let line = STEEL.initial.density * section.properties.area;
    let beta = line * LENGTH / (2.0 * MASS);
    let way = (MASS * speed).powi(2) / (3.0 * line * plastic_moment());
    let parkes = way * (beta / (1.0 + beta) + 2.0 * (1.0 + beta).ln());
    // the hinge stops the mass in about 2 δ/v; then it vibrates about the final place
    let stop = 2.0 * parkes / speed;
    let mut model = Model {
        supports: vec![held(vec![0], [true; 3], [true; 3])],
        discrete: vec![striker],
        ..Model::new(vec![made], mesh, CENTRAL, 1.0)
    };
    let critical = crate::witness::system(Model {
        dt: 1e-12,
        ..model.clone()
    })?
    .critical_step();
    model.dt = 0.9 * critical;
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    // a period with the mass at the tip
    let period = std::f64::consts::TAU * (MASS * LENGTH.powi(3) / (3.0 * bending)).sqrt();
    let (mut sum, mut count) = (0.0, 0.0);
    while driver.state().time < 1.2 * stop + period {
        driver.step()?;
        let (system, state) = (driver.system(), driver.state());
        if state.time > 1.2 * stop {
            let tip = system.unknowns.first(system.number[elements]) + 1;
            sum -= state.motion.u[tip];
            count += 1.0;
        }
    }
    let ledger = &driver.state().ledger;
    let size = LENGTH / elements as f64;
    Ok(vec![
        Row::at_least(
            "struck cantilever: deflection that remains over that of Parkes",
            sum / count / parkes,
            1.0 - 2.0 / ratio - GAUSS * size / LENGTH,
        ),
        Row::at_most(
            "struck cantilever: deflection that remains over that of a hinge at the root",
            sum / count / (0.5 * MASS * speed * speed * LENGTH / plastic_moment()),
            1.0,
        ),
        Row::at_most(
            "struck cantilever: energy residual / E0",
            ledger.largest_energy_residual / ledger.initial.energy(),
            1e-9,
        ),
    ])
}

pub(crate) const CHECK: Check = Check {
    name: "elastic-plastic-beams",
    fact: "beams of metal that flows have the moments, the limit load, the cycles and the final deflections of the closed forms",
    run: |size| {
        let (layers, elements) = match size {
            Size::Quick => (vec![8], 10),
            Size::Full => (vec![8, 16, 64], 40),
        };
        let mut rows = Vec::new();
        for layers in layers {
            rows.extend(curvatures(layers)?);
        }
        rows.extend(limit(elements)?);
        rows.extend(cycles(32, 50)?);
        rows.extend(explicit_and_implicit(elements)?);
        rows.extend(struck(elements)?);
        Ok(rows)
    },
};
