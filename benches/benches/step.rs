//! A whole step of an elastic block that drops on a rigid plane, beside what memory allows.
//!
//! `cargo bench -p carom-benches --bench step`; `CAROM_BENCH_N=32` sets the cells along an edge (16 unless given; n = 32 takes
//! about a minute and 1.5 GB). Theta scheme, velocity law, n³ hexahedra, n²-many contact points. Twenty steps of flight,
//! then the closing step, which computes the columns of its contact points, then forty steps in contact. Medians, since
//! other processes may be running; the shares are those of all steps of a phase. A step takes one forward and one
//! backward sweep, which read 8 bytes per entry of the factor each: `read` reads as many bytes and does nothing else.
//! Not a criterion benchmark: no two steps are alike.

use std::error::Error;
use std::hint::black_box;
use std::time::{Duration, Instant};

use carom_algebra::reduce;
use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Law, Plane, Sliding};
use carom_dynamics::scheme::Theta;
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelTarget, Phases, Scheme, System};
use carom_materials::{self as materials, Elastic};
use carom_mesh::{Surface, generate};

const FLIGHT: usize = 20;
const CONTACT: usize = 40;
const SPEED: f64 = 5.0;
const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e9,
    poisson: 0.3,
};

fn main() -> Result<(), Box<dyn Error>> {
    let n = std::env::var("CAROM_BENCH_N").ok();
    let n = n.and_then(|n| n.parse().ok()).unwrap_or(16);
    let begin = Instant::now();
    let system = System::new(model(n)?)?;
    let unknowns = system.unknowns();
    println!(
        "n = {n}: {unknowns} unknowns, {} contact points",
        system.points()
    );
    println!(
        "system             {:9.1} ms",
        milliseconds(begin.elapsed())
    );
    let begin = Instant::now();
    let mut driver = Driver::new(system)?;
    println!(
        "driver             {:9.1} ms",
        milliseconds(begin.elapsed())
    );
    let costs = driver.costs();
    println!(
        "  its factorisation{:9.1} ms",
        milliseconds(costs.phases.factorisation)
    );
    let entries: usize = costs.factors.iter().map(|factor| factor.nnz_factor).sum();
    let bytes: usize = costs.factors.iter().map(|factor| factor.bytes).sum();
    println!(
        "factor             {:9.1} million entries, {:.0} MB",
        entries as f64 / 1e6,
        bytes as f64 / 1e6
    );

    let read = read(entries);
    report(&mut driver, "flight", FLIGHT, read)?;
    let mut closing = Duration::ZERO;
    while driver.costs().work.columns == 0 {
        closing = steps(&mut driver, 1)?[0];
    }
    println!("closing step       {:9.1} ms", milliseconds(closing));
    let columns = driver.costs();
    println!(
        "columns            {:9} of {:.0} MB",
        columns.work.columns,
        columns.compliance_bytes as f64 / 1e6
    );
    report(&mut driver, "contact", CONTACT, read)?;
    let closed = driver.report().contacts[0].closed;
    println!("points closed      {closed:9}");
    Ok(())
}

/// A cube of 1 m whose bottom reaches the plane after the steps of flight.
fn model(n: usize) -> Result<Model, Box<dyn Error>> {
    let dt = 0.5 / n as f64 / RUBBER.wave_speed(materials::Plane::Full);
    let height = SPEED * dt * (FLIGHT as f64 + 0.2);
    let mesh = generate::box_("block", [0.0, 0.0, height], [1.0; 3], [n; 3], false);
    let cells = mesh.groups["block"].elements.clone();
    let bottom = Surface::new(&mesh, &mesh.groups["block.bottom"], &cells)?;
    let block = ModelBody {
        velocity: [0.0, 0.0, -SPEED],
        ..ModelBody::new(BodySpec::new("block", cells, Kinematics::Solid, RUBBER))
    };
    let ground = ModelContact {
        sliding: Sliding::Finite,
        integration: carom_contact::Integration::Node,
        ..ModelContact::new(
            "ground",
            bottom,
            ModelTarget::rigid(Plane {
                point: [0.0; 3],
                normal: [0.0, 0.0, 1.0],
            }),
            Law::Velocity(Velocity {
                capture: Capture::Now,
                reading: Reading::Closed,
            }),
        )
    };
    Ok(Model {
        contacts: vec![ground],
        ..Model::new(vec![block], mesh, Scheme::Theta(Theta { theta: 0.5 }), dt)
    })
}

/// Best time of reading as many numbers as the factor holds.
fn read(entries: usize) -> Duration {
    let memory = vec![1.0; entries];
    let times = (0..10).map(|_| {
        let begin = Instant::now();
        black_box(reduce::sum(black_box(&memory)));
        begin.elapsed()
    });
    times.min().unwrap_or_default()
}

/// Times of single steps.
fn steps(driver: &mut Driver, count: usize) -> Result<Vec<Duration>, carom_dynamics::Error> {
    let step = |_| {
        let begin = Instant::now();
        driver.step()?;
        Ok(begin.elapsed())
    };
    (0..count).map(step).collect()
}

/// Time of one phase.
type Share = fn(&Phases) -> Duration;

/// Takes steps and prints their median and the shares of their phases.
fn report(
    driver: &mut Driver,
    name: &str,
    count: usize,
    read: Duration,
) -> Result<(), carom_dynamics::Error> {
    let before = driver.costs();
    let mut times = steps(driver, count)?;
    times.sort();
    let after = driver.costs();
    println!("step, {name:13}{:9.2} ms", milliseconds(times[count / 2]));
    let shares: [(&str, Share); 4] = [
        ("forces", |phases| phases.forces),
        ("sweeps", |phases| phases.sweeps),
        ("contact", |phases| phases.contact),
        ("balance", |phases| phases.balance),
    ];
    let spent = |of: Share| of(&after.phases) - of(&before.phases);
    let total: Duration = shares.iter().map(|share| spent(share.1)).sum();
    for (share, of) in shares {
        let part = spent(of).as_secs_f64();
        let each = 1e3 * part / count as f64;
        let percent = 100.0 * part / total.as_secs_f64();
        println!("  {share:16} {each:9.2} ms {percent:5.1} %");
    }
    let sweeps = |costs: &carom_dynamics::Costs| -> usize {
        costs.factors.iter().map(|factor| factor.sweeps).sum()
    };
    let swept = sweeps(&after) - sweeps(&before);
    let sweep = spent(|phases| phases.sweeps).as_secs_f64() / swept as f64;
    let entries: usize = after.factors.iter().map(|factor| factor.nnz_factor).sum();
    let rate = |time: f64| 8e-9 * entries as f64 / time;
    let read = read.as_secs_f64();
    println!(
        "  {} sweeps a step, {:.1} GB/s, {:.2} of a plain read at {:.1} GB/s",
        swept / count,
        rate(sweep),
        read / sweep,
        rate(read)
    );
    Ok(())
}

fn milliseconds(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}
