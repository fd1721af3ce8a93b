//! Zones of unequal steps under every scheme that links take there.

use carom_bodies::{BodySpec, Kinematics};
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Driver, Model, ModelBody, ModelLink, Scheme};
use carom_materials::Elastic;
use carom_mesh::{Mesh, generate};
use carom_zones::{LinkKind, ModelZone, Zoned, Zones};

const SOFT: Elastic = Elastic {
    density: 1.0,
    young: 1.0,
    poisson: 0.0,
};

/// A bar of a group, of unit impedance.
pub(crate) fn soft_bar(mesh: &Mesh, group: &str) -> ModelBody {
    let cells = mesh.groups[group].elements.clone();
    let kinematics = Kinematics::Bar { area: 1.0 };
    ModelBody::new(BodySpec::new(group, cells, kinematics, SOFT))
}

/// Two bars end to end, tied in one node; the first takes `m` steps in one of the second, with elements as much smaller.
fn bars(scheme: Scheme, m: u32, n: usize) -> Zoned {
    let line = |name: &str, from: f64, n| {
        generate::line(name, [from, 0.0, 0.0], [from + 1.0, 0.0, 0.0], n, 1)
    };
    let mut mesh = line("fine", -1.0, n * m as usize);
    mesh.merge("coarse", line("coarse", 0.0, n)).unwrap();
    let bodies = vec![soft_bar(&mesh, "fine"), soft_bar(&mesh, "coarse")];
    let nodes = |group: &str| mesh.group_nodes(&mesh.groups[group]);
    let rows = carom_arlequin::trace(&mesh, &nodes("fine"), &nodes("coarse"), 1e-9)
        .unwrap()
        .rows;
    let zone = |name: &str, body, substeps| ModelZone::new(name, vec![body], (scheme, substeps));
    Zoned {
        zones: vec![zone("fine", 0, m), zone("coarse", 1, 1)],
        links: vec![ModelLink {
            name: "tie".into(),
            zones: [0, 1],
            rows,
        }],
        kind: LinkKind::PrakashHjelmstad,
        model: Model::new(bodies, mesh, scheme, 0.8 / n as f64),
    }
}

/// Largest error of the velocity of a pulse that has passed from the fine into the coarse bar, against the exact one.
fn error_of_pulse(scheme: Scheme, m: u32, n: usize) -> f64 {
    let pulse = |x: f64| f64::exp(-((x + 0.5) / 0.15).powi(2));
    let mut zones = Zones::new(&bars(scheme, m, n)).unwrap();
    let motion = |driver: &Driver| {
        let x = &driver.system().x;
        let v = x.iter().map(|x| pulse(x[0])).collect();
        [vec![0.0; x.len()], v]
    };
    let motions: Vec<_> = zones.drivers().iter().map(motion).collect();
    zones.restart(&motions).unwrap();
    while zones.time() < 0.7 {
        zones.step().unwrap();
    }
    let t = zones.time();
    // one half goes to each side, and comes back from the end at -1
    let exact =
        |x: f64| 0.5 * (pulse(x - t) + pulse(x + t) + pulse(-2.0 - x - t) + pulse(-2.0 - x + t));
    let drivers = zones.drivers().iter();
    let errors = drivers.flat_map(|driver| {
        let pairs = driver.system().x.iter().zip(&driver.state().motion.v);
        pairs.map(|(x, v)| (v - exact(x[0])).abs())
    });
    errors.fold(0.0, f64::max)
}

/// A quarter is left for terms of higher order.
#[test]
fn zones_of_unequal_steps_keep_the_order_of_their_scheme() {
    let mut schemes = Scheme::registered();
    schemes.push(Scheme::EnergyMomentum(EnergyMomentum {}));
    for scheme in schemes {
        let staged = scheme.get().stages().len() > 1;
        if staged || matches!(scheme, Scheme::TchamwaWielgosz(_)) {
            let error = Zones::new(&bars(scheme, 4, 40)).map(|_| ()).unwrap_err();
            assert!(error.to_string().contains("take equal steps"), "{error}");
            continue;
        }
        let errors = [40, 80].map(|n| error_of_pulse(scheme, 4, n));
        let order = f64::log2(errors[0] / errors[1]);
        assert!(
            order > f64::from(scheme.get().order()) - 0.25 && errors[0] < 0.1,
            "{scheme:?}: {errors:?}, order {order}"
        );
    }
}
