//! Whole explicit steps of an undisturbed block, balances in every step, as a user runs it: elements per second beside those of
//! the forces alone.
//!
//! `cargo bench -p carom-benches --bench explicit`; `CAROM_BENCH_N=48` sets the cells along an edge (24 unless given),
//! `CAROM_BENCH_THREADS=2` the threads (1 unless given), `CAROM_BENCH_ONLY=J2` takes only what has this in its name. A block flies and
//! spins while waves run through it; with `wall` its lower face is a contact with a rigid plane that it never reaches. Best of
//! groups of four steps, since other processes may be running. Not a criterion benchmark: no two steps are alike.
//!
//! `memory` is the rate of a plain copy of a vector that no cache holds; the step outside of the forces is told in `passes` of that
//! kind, which read and write 48 bytes a node.

use std::error::Error;
use std::hint::black_box;
use std::time::{Duration, Instant};

use carom_bodies::{BodySpec, Formulation, Kinematics};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Integration, Law as ContactLaw, Plane, Sliding};
use carom_dynamics::scheme::CentralDifference;
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelTarget, Phases, Scheme, System};
use carom_materials::{Elastic, J2Plasticity, Law, Plane as Stress, StVenantKirchhoff};
use carom_mesh::{Surface, generate};

const GROUPS: usize = 40;
const STEPS: usize = 4;
/// Numbers of a vector that no cache holds.
const LARGE: usize = 24_000_000;
const MATERIAL: Elastic = Elastic {
    density: 1000.0,
    young: 1e9,
    poisson: 0.3,
};

/// What is timed: law, formulation, whether there is a wall.
type Run = (&'static str, Law, Formulation, bool);

fn main() -> Result<(), Box<dyn Error>> {
    let number = |name: &str, default: usize| {
        let given = std::env::var(name).ok().and_then(|n| n.parse().ok());
        given.unwrap_or(default)
    };
    let (n, threads) = (
        number("CAROM_BENCH_N", 24),
        number("CAROM_BENCH_THREADS", 1),
    );
    let only = std::env::var("CAROM_BENCH_ONLY").unwrap_or_default();
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()?;
    let copy = copy(LARGE) * (n + 1).pow(3) as u32 / (LARGE / 3) as u32;
    println!(
        "{n}^3 hexahedra, {threads} threads; memory: {:.1} GB/s in a copy of a vector",
        48e-9 * (n + 1).pow(3) as f64 / copy.as_secs_f64()
    );
    println!(
        "{:28} {:>8} {:>8} {:>9} {:>9} {:>9} {:>8}",
        "", "M/s", "forces", "contact", "balance", "rest", "passes"
    );
    let svk = Law::StVenantKirchhoff(StVenantKirchhoff { initial: MATERIAL });
    let plastic = Law::J2Plasticity(J2Plasticity {
        initial: MATERIAL,
        yield_stress: 1e6,
        hardening: 1e8,
    });
    let small = Law::Elastic(MATERIAL);
    let one = Formulation::Reduced { hourglass: 0.1 };
    let runs: [Run; 6] = [
        ("small strain", small, Formulation::Full, false),
        ("StVK", svk, Formulation::Full, false),
        ("StVK, one point", svk, one, false),
        ("J2, one point", plastic, one, false),
        ("small strain, wall", small, Formulation::Full, true),
        ("StVK, one point, wall", svk, one, true),
    ];
    for run in runs.iter().filter(|run| run.0.contains(&only)) {
        time(run, n, copy)?;
    }
    Ok(())
}

/// Times one run and prints its line.
fn time(run: &Run, n: usize, copy: Duration) -> Result<(), Box<dyn Error>> {
    let system = System::new(model(run, n)?)?;
    let velocity = system.x.iter().flat_map(|x| {
        let wave = |axis: usize| (5.0 * x[axis]).sin();
        [0, 1, 2]
            .map(|i| [1.0, 0.0, -5.0][i] + [-20.0 * x[1], 20.0 * x[0], 0.0][i] + wave((i + 1) % 3))
    });
    let velocity: Vec<f64> = velocity.collect();
    let mut driver = Driver::new(system)?;
    driver.restart(&vec![0.0; velocity.len()], &velocity)?;
    let mut best: Option<(Duration, Phases)> = None;
    for _ in 0..GROUPS {
        let (begin, before) = (Instant::now(), driver.costs().phases);
        for _ in 0..STEPS {
            driver.step()?;
        }
        let (took, after) = (begin.elapsed(), driver.costs().phases);
        let spent = Phases {
            forces: after.forces - before.forces,
            contact: after.contact - before.contact,
            balance: after.balance - before.balance,
            sweeps: after.sweeps - before.sweeps,
            ..Phases::default()
        };
        if best.as_ref().is_none_or(|(least, _)| took < *least) {
            best = Some((took, spent));
        }
    }
    let Some((took, spent)) = best else {
        return Ok(());
    };
    let each = |time: Duration| 1e3 * time.as_secs_f64() / STEPS as f64;
    let rest = took - spent.forces - spent.contact - spent.balance;
    let rate = |time: Duration| 1e-6 * (STEPS * n.pow(3)) as f64 / time.as_secs_f64();
    let passes = (took - spent.forces).as_secs_f64() / STEPS as f64 / copy.as_secs_f64();
    println!(
        "{:28} {:8.2} {:8.2} {:6.2} ms {:6.2} ms {:6.2} ms {passes:8.1}",
        run.0,
        rate(took),
        rate(spent.forces),
        each(spent.contact),
        each(spent.balance),
        each(rest),
    );
    Ok(())
}

/// A cube of 1 m far above the plane.
fn model(run: &Run, n: usize) -> Result<Model, Box<dyn Error>> {
    let &(_, law, formulation, wall) = run;
    let dt = 0.3 / n as f64 / MATERIAL.wave_speed(Stress::Full);
    let mesh = generate::box_("block", [-0.5, -0.5, 10.0], [1.0; 3], [n; 3], false);
    let cells = mesh.groups["block"].elements.clone();
    let bottom = Surface::new(&mesh, &mesh.groups["block.bottom"], &cells)?;
    let mut spec = BodySpec::new("block", cells, Kinematics::Solid, law);
    spec.formulation = formulation;
    let block = ModelBody::new(spec);
    let plane = ModelContact {
        sliding: Sliding::Finite,
        integration: Integration::Node,
        ..ModelContact::new(
            "ground",
            bottom,
            ModelTarget::rigid(Plane {
                point: [0.0; 3],
                normal: [0.0, 0.0, 1.0],
            }),
            ContactLaw::Velocity(Velocity {
                capture: Capture::Now,
                reading: Reading::Closed,
            }),
        )
    };
    let scheme = Scheme::CentralDifference(CentralDifference {});
    Ok(Model {
        contacts: if wall { vec![plane] } else { Vec::new() },
        ..Model::new(vec![block], mesh, scheme, dt)
    })
}

/// Best time of copying as many numbers.
fn copy(numbers: usize) -> Duration {
    let (from, mut to) = (vec![1.0; numbers], vec![0.0; numbers]);
    let times = (0..20).map(|_| {
        let begin = Instant::now();
        to.copy_from_slice(black_box(&from));
        black_box(&mut to);
        begin.elapsed()
    });
    times.min().unwrap_or_default()
}
