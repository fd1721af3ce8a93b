//! What contacts add to an explicit step: two plates of two layers of hexahedra, one above the other, with 1e5 faces between them.
//!
//! `cargo bench -p carom-benches --bench contact`; `CAROM_BENCH_N=100` sets the cells along an edge (224 unless given),
//! `CAROM_BENCH_THREADS=2` the threads (1 unless given), `CAROM_BENCH_ONLY=self` takes only what has this in its name beside the run
//! without contact. Waves run through both plates. "far": four elements lie between them; "near": half an element; "tenth": they
//! touch on a tenth of their faces, pressed together by gravity, with friction, and are far elsewhere; they are compared with the run
//! without contact under the same gravity, whose work and resultants a step without loads does not sum. Best of groups of four
//! steps, since other processes may be running; the first steps, in which all points are looked at, are not among them. "processor" is
//! the mean by the time that threads have had a processor, where the system tells it: other processes move it less than the clock's.

use std::error::Error;
use std::time::{Duration, Instant};

use carom_bodies::{BodySpec, Formulation, Kinematics};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Basis, Integration, Law as ContactLaw, Plane, Sliding};
use carom_dynamics::scheme::CentralDifference;
use carom_dynamics::{
    Driver, Model, ModelBody, ModelContact, ModelTarget, Phases, Scheme, Support, System,
};
use carom_materials::{Elastic, Law, Plane as Stress, StVenantKirchhoff};
use carom_mesh::{Mesh, Surface, generate};

const GROUPS: usize = 30;
const STEPS: usize = 4;
const WARM: usize = 4;
const MATERIAL: Elastic = Elastic {
    density: 1000.0,
    young: 1e9,
    poisson: 0.3,
};
const MORTAR: Integration = Integration::Mortar { basis: Basis::Dual };

/// What the contact is between.
#[derive(Clone, Copy, PartialEq)]
enum Sides {
    None,
    /// The faces of one plate and those of the other.
    Plates,
    /// All faces between the plates, against themselves.
    Itself,
    /// The lower faces of the upper plate, and a rigid plane where the other plate is.
    Wall,
}

/// How far the plates are from each other.
#[derive(Clone, Copy, PartialEq)]
enum Gap {
    Far,
    Near,
    /// They touch on a tenth of their faces.
    Tenth,
}

/// What is timed.
type Run = (&'static str, Sides, Integration, Gap);

fn main() -> Result<(), Box<dyn Error>> {
    let number = |name: &str, default: usize| {
        let given = std::env::var(name).ok().and_then(|n| n.parse().ok());
        given.unwrap_or(default)
    };
    let (n, threads) = (
        number("CAROM_BENCH_N", 224),
        number("CAROM_BENCH_THREADS", 1),
    );
    let only = std::env::var("CAROM_BENCH_ONLY").unwrap_or_default();
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build_global()?;
    println!(
        "{} hexahedra, {} faces between them, {threads} threads",
        4 * n * n,
        2 * n * n
    );
    println!(
        "{:24} {:>10} {:>10} {:>10} {:>8} {:>8} {:>8} {:>10} {:>8}",
        "", "step", "contact", "balance", "closed", "mean", "best", "processor", "mean"
    );
    let node = Integration::Node;
    let runs: [Run; 10] = [
        ("no contact", Sides::None, node, Gap::Far),
        ("no contact, gravity", Sides::None, node, Gap::Tenth),
        ("plates, far", Sides::Plates, node, Gap::Far),
        ("plates, near", Sides::Plates, node, Gap::Near),
        ("plates, tenth", Sides::Plates, node, Gap::Tenth),
        ("self, far", Sides::Itself, node, Gap::Far),
        ("self, tenth", Sides::Itself, node, Gap::Tenth),
        ("wall, far", Sides::Wall, node, Gap::Far),
        ("wall, tenth", Sides::Wall, node, Gap::Tenth),
        ("mortar, far", Sides::Plates, MORTAR, Gap::Far),
    ];
    let mut undisturbed = [None; 2];
    for run in &runs {
        if run.1 == Sides::None || run.0.contains(&only) {
            time(run, n, &mut undisturbed[usize::from(run.3 == Gap::Tenth)])?;
        }
    }
    Ok(())
}

/// Times one run and prints its line; ratios are those to the run without contact.
fn time(
    run: &Run,
    n: usize,
    undisturbed: &mut Option<[Duration; 3]>,
) -> Result<(), Box<dyn Error>> {
    let system = System::new(model(run, n)?)?;
    let velocity = system.x.iter().flat_map(|x| {
        let wave = |axis: usize| (5.0 * x[axis]).sin();
        [0, 1, 2].map(|i| wave((i + 1) % 3))
    });
    let velocity: Vec<f64> = velocity.collect();
    let mut driver = Driver::new(system)?;
    driver.restart(&vec![0.0; velocity.len()], &velocity)?;
    let mut best: Option<(Duration, Phases)> = None;
    let (mut all, mut processor) = (Duration::ZERO, Duration::ZERO);
    for group in 0..GROUPS + WARM {
        let (begin, before) = (Instant::now(), driver.costs().phases);
        let had = on_processor();
        for _ in 0..STEPS {
            driver.step()?;
        }
        let (took, after) = (begin.elapsed(), driver.costs().phases);
        let spent = Phases {
            contact: after.contact - before.contact,
            balance: after.balance - before.balance,
            ..Phases::default()
        };
        if group < WARM {
            continue;
        }
        all += took;
        processor += on_processor().saturating_sub(had);
        if best.as_ref().is_none_or(|(least, _)| took < *least) {
            best = Some((took, spent));
        }
    }
    let Some((took, spent)) = best else {
        return Ok(());
    };
    let each = |time: Duration| 1e3 * time.as_secs_f64() / STEPS as f64;
    let mean = all / GROUPS as u32;
    let processor = processor / GROUPS as u32;
    let [first_mean, first, first_processor] = *undisturbed.get_or_insert([mean, took, processor]);
    let closed: usize = driver.report().contacts.iter().map(|c| c.closed).sum();
    println!(
        "{:24} {:7.2} ms {:7.2} ms {:7.2} ms {closed:8} {:7.2}x {:7.2}x {:7.2} ms {:7.2}x",
        run.0,
        each(took),
        each(spent.contact),
        each(spent.balance),
        mean.as_secs_f64() / first_mean.as_secs_f64(),
        took.as_secs_f64() / first.as_secs_f64(),
        each(processor),
        processor.as_secs_f64() / first_processor.as_secs_f64(),
    );
    Ok(())
}

/// Time that the threads of this process have had a processor; zero where the system does not tell it as Linux does.
fn on_processor() -> Duration {
    let threads = std::fs::read_dir("/proc/self/task").into_iter().flatten();
    let of_thread = |thread: std::io::Result<std::fs::DirEntry>| {
        let told = std::fs::read_to_string(thread.ok()?.path().join("schedstat")).ok()?;
        told.split_whitespace().next()?.parse::<u64>().ok()
    };
    Duration::from_nanos(threads.filter_map(of_thread).sum())
}

/// Two plates of 1 m.
fn model(run: &Run, n: usize) -> Result<Model, Box<dyn Error>> {
    let &(_, sides, integration, gap) = run;
    let h = 1.0 / n as f64;
    let dt = 0.3 * h / MATERIAL.wave_speed(Stress::Full);
    let size = [1.0, 1.0, 2.0 * h];
    let mut mesh = generate::box_("lower", [0.0, 0.0, -2.0 * h], size, [n, n, 2], false);
    let mut upper = generate::box_("upper", [0.3 * h, 0.4 * h, 0.0], size, [n, n, 2], false);
    for x in &mut upper.nodes {
        x[2] += h * match gap {
            Gap::Far => 4.0,
            Gap::Near => 0.5,
            Gap::Tenth => 4.0 * ((x[0] - 0.1) / 0.02).clamp(0.0, 1.0),
        };
    }
    mesh.merge("upper", upper)?;
    let cells = |name: &str| mesh.groups[name].elements.clone();
    let body = |name: &str| {
        let law = Law::StVenantKirchhoff(StVenantKirchhoff { initial: MATERIAL });
        let mut spec = BodySpec::new(name, cells(name), Kinematics::Solid, law);
        spec.formulation = Formulation::Reduced { hourglass: 0.1 };
        ModelBody::new(spec)
    };
    let both = [cells("lower"), cells("upper")].concat();
    let bodies = vec![body("lower"), body("upper")];
    let top = Surface::new(&mesh, &mesh.groups["lower.top"], &both)?;
    let bottom = Surface::new(&mesh, &mesh.groups["upper.bottom"], &both)?;
    let between = between(&mesh, &both)?;
    let (secondary, target) = match sides {
        Sides::Itself => (between.clone(), ModelTarget::Surface(between)),
        Sides::None | Sides::Plates => (bottom, ModelTarget::Surface(top)),
        Sides::Wall => {
            let plane = Plane {
                point: [0.0; 3],
                normal: [0.0, 0.0, 1.0],
            };
            (bottom, ModelTarget::rigid(plane))
        }
    };
    let law = ContactLaw::Velocity(Velocity {
        capture: Capture::Now,
        reading: Reading::Closed,
    });
    let contact = ModelContact {
        sliding: Sliding::Finite,
        integration,
        friction: 0.3.into(),
        ..ModelContact::new("between", secondary, target, law)
    };
    let held = Support {
        nodes: mesh.group_nodes(&mesh.groups["lower.bottom"]),
        fix: [true; 3],
        fix_rotations: [false; 3],
    };
    let scheme = Scheme::CentralDifference(CentralDifference {});
    Ok(Model {
        contacts: match sides {
            Sides::None => Vec::new(),
            Sides::Plates | Sides::Itself | Sides::Wall => vec![contact],
        },
        gravity: [0.0, 0.0, if gap == Gap::Tenth { -1e4 } else { 0.0 }],
        supports: vec![held],
        ..Model::new(bodies, mesh, scheme, dt)
    })
}

/// All faces between the plates.
fn between(mesh: &Mesh, cells: &[carom_mesh::ElementId]) -> Result<Surface, Box<dyn Error>> {
    let faces = ["lower.top", "upper.bottom"].map(|name| mesh.groups[name].elements.clone());
    let group = carom_mesh::Group::new(2, faces.concat());
    Ok(Surface::new(mesh, &group, cells)?)
}
