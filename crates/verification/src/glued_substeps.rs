//! Overlaps of thin bodies with finite rotations and solids at finite strain, in zones of unequal steps.

use carom_algebra::tensor::Vec3;
use carom_dynamics::scheme::CentralDifference;
use carom_dynamics::{Driver, Model, Order, Scheme};
use carom_zones::Zones;

use crate::Error;
use crate::build::{newmark, theta};
use crate::check::{Check, Row, Size};
use crate::glued_turning::{CONSERVING, Joined, apart, spin};
use crate::{beam_solid_large as beam, shell_solid_large as shell};

/// Schemes of the solid, and their steps in one of the thin body.
const SOLIDS: [(&str, Scheme, u32); 4] = [
    ("energy-momentum", CONSERVING, 4),
    ("theta 0.5", Scheme::Theta(carom_dynamics::scheme::Theta { theta: 0.5 }), 4),
    ("newmark", Scheme::Newmark(carom_dynamics::scheme::Newmark { beta: 0.25, gamma: 0.5 }), 4),
    (
        "central differences",
        Scheme::CentralDifference(CentralDifference {}),
        40,
    ),
];

fn tumble(model: Model, (dt, m): (f64, u32), end: u32, time: f64) -> Result<(), Error> {
    let mut zoned = apart(model, (CONSERVING, m));
    zoned.model.dt = dt;
    let mut zones = Zones::new(&zoned)?;
    let centre = Vec3::x() * 0.5;
    let start: Vec<_> = zones.drivers().iter().map(|d| {
        let v = spin(d.system(), centre);
        [vec![0.0; v.len()], v]
    }).collect();
    zones.restart(&start)?;
    // the same in one system
    let mut single = zoned.clone();
    single.zones.iter_mut().for_each(|z| z.substeps = 1);
    single.model.dt = dt / m as f64;
    let mut driver = Driver::new(single.together()?.unwrap())?;
    let v = spin(driver.system(), centre);
    driver.restart(&vec![0.0; v.len()], &v)?;
    let begin = zones.balance();
    let place = |d: &Driver| -> Vec3 {
        let s = d.system();
        Vec3::from(s.of_node(s.number[end as usize], &d.state().motion, Order::Displacement))
    };
    let (mut work, mut most, mut miss) = (0.0_f64, 0, 0.0_f64);
    let steps = (time / dt).round() as usize;
    let mut at = Vec::new();
    for k in 0..steps {
        zones.step()?;
        (0..m).try_for_each(|_| driver.step())?;
        most = most.max(zones.passes());
        work = work.max(zones.link_works()[0].abs());
        miss = miss.max((place(&zones.drivers()[1]) - place(&driver)).norm());
        if (k + 1) % (steps / 8).max(1) == 0 { at.push(format!("{:.2e}", miss)); }
    }
    let now = zones.balance();
    let p = |b: &carom_dynamics::Balance| (b.momentum.linear, b.momentum.angular);
    let n = |a: [f64;3], b: [f64;3]| Vec3::from([a[0]-b[0],a[1]-b[1],a[2]-b[2]]).norm()/Vec3::from(b).norm();
    let ((l0,a0),(l1,a1)) = (p(&begin), p(&now));
    println!("dt {dt} m {m}: work/E {:.3e}, energy change {:.3e}, miss {:?}, passes max {most} mean {}, linear {:.2e}, angular {:.2e} single angular", work/begin.energy(), now.energy()/begin.energy()-1.0, at, zones.all_passes() as f64 / steps as f64, n(l1,l0), n(a1,a0));
    Ok(())
}

fn rows(_size: Size) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for (name, scheme, m) in SOLIDS {
        for dim in [2, 3] {
            let bar = beam::patch_bar(dim);
            let patch = beam::patch_of(&bar);
            let model = beam::model(&bar, (newmark(0.25, 0.5), patch.step()), Joined::Turning)?;
            let end = [(model.mesh.nodes.len() as u32 - 1, 1.0)];
            let speed = patch.run_apart(apart(model, (scheme, m)), &end);
            println!("{name} {dim} {speed:?}");
        }
        let plate = shell::patch_plate();
        let patch = shell::patch_of(&plate);
        let model = shell::model(&plate, (newmark(0.25, 0.5), patch.step()), Joined::Turning)?;
        let end = shell::end_of(&plate, &model.mesh);
        let speed = patch.run_apart(apart(model, (scheme, m)), &end);
        println!("{name} plate {speed:?}");
    }
    for dt in [4e-3, 2e-3, 1e-3, 5e-4] {
        let model = beam::model(&beam::soft_bar(), (newmark(0.25, 0.5), dt), Joined::Turning)?;
        let end = model.mesh.nodes.len() as u32 - 1;
        if let Err(e) = tumble(model, (dt, 4), end, 0.4) { println!("bar {dt} {e}"); }
    }
    for dt in [4e-3, 2e-3, 1e-3] {
        let model = shell::model(&shell::soft_plate(), (newmark(0.25, 0.5), dt), Joined::Turning)?;
        let end = shell::end_of(&shell::soft_plate(), &model.mesh)[0].0;
        if let Err(e) = tumble(model, (dt, 4), end, 0.2) { println!("plate {dt} {e}"); }
    }
    let _ = theta(0.5);
    rows.push(Row::at_most("x", 0.0, 1.0));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "glued-substeps",
    fact: "an overlap of a thin body with finite rotations and a solid at finite strain turns in unequal steps, keeps its momentum, and comes where it comes in one system",
    run: rows,
};
