//! Zones as one: the whole state against the zones' own, and runs that are cut.

use std::sync::Arc;

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Law, Plane};
use carom_dynamics::scheme::{CentralDifference, Theta};
use carom_dynamics::{Model, ModelBody, ModelContact, ModelLink, ModelTarget, Scheme, Stepper};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};
use carom_zones::{LinkKind, ModelZone, Whole, Zoned};

const INNER: u32 = 4;

/// A bar of steel that meets a wall after a short flight: a fine tip in velocity theta, the rest explicit, joined in one
/// node; four inner steps.
pub fn bar() -> Zoned {
    let steel = Elastic {
        density: 7844.0,
        young: 2.07e11,
        poisson: 0.0,
    };
    let line = |name: &str, from: f64, to: f64, n| {
        generate::line(name, [from, 0.0, 0.0], [to, 0.0, 0.0], n, 1)
    };
    let mut mesh = line("rest", -1.0, -0.2, 40);
    mesh.merge("tip", line("tip", -0.2, 0.0, 40)).unwrap();
    let body = |name: &str| ModelBody {
        velocity: [1.0, 0.0, 0.0],
        displacement: [-1e-5, 0.0, 0.0],
        ..ModelBody::new(BodySpec::new(
            name,
            mesh.groups[name].elements.clone(),
            Kinematics::Bar { area: 1e-4 },
            steel,
        ))
    };
    let bodies = vec![body("rest"), body("tip")];
    let nodes = |group: &str| mesh.group_nodes(&mesh.groups[group]);
    let rows = carom_arlequin::trace(&mesh, &nodes("tip"), &nodes("rest"), 1e-9).unwrap();
    let contacts = vec![ModelContact::new(
        "wall",
        Surface::new(&mesh, &mesh.groups["tip.right"], &bodies[1].spec.cells).unwrap(),
        ModelTarget::rigid(Plane {
            point: [0.0; 3],
            normal: [-1.0, 0.0, 0.0],
        }),
        Law::Velocity(Velocity {
            capture: Capture::Half,
            reading: Reading::Closed,
        }),
    )];
    let zone =
        |name: &str, body, scheme, substeps| ModelZone::new(name, vec![body], (scheme, substeps));
    Zoned {
        zones: vec![
            zone("tip", 1, Scheme::Theta(Theta { theta: 0.5 }), INNER),
            zone(
                "rest",
                0,
                Scheme::CentralDifference(CentralDifference {}),
                1,
            ),
        ],
        links: vec![ModelLink {
            name: "joint".into(),
            zones: [0, 1],
            rows: rows.rows,
        }],
        kind: LinkKind::PrakashHjelmstad,
        model: Model {
            contacts,
            ..Model::new(
                bodies,
                mesh,
                Scheme::CentralDifference(CentralDifference {}),
                0.5 * 0.02 / (steel.young / steel.density).sqrt(),
            )
        },
    }
}

pub fn whole(zoned: &Zoned) -> Whole {
    Whole::new(zoned, zoned.whole().unwrap()).unwrap()
}

#[test]
fn the_whole_is_the_zones_node_by_node_and_contact_by_contact() {
    let zoned = bar();
    let mut whole = whole(&zoned);
    let (mut impulse, mut closed) = (0.0, 0.0);
    let mut largest: f64 = 0.0;
    for _ in 0..300 {
        whole.step().unwrap();
        let report = whole.report();
        assert_eq!(report.samples.len(), INNER as usize);
        let ends: Vec<f64> = report.parts().map(|(end, ..)| end).collect();
        assert!((ends[3] - report.time).abs() < 1e-12 * report.time);
        let of_parts: f64 = report.parts().map(|(_, dt, c)| dt * c[0].force).sum();
        impulse += of_parts;
        closed += report
            .parts()
            .map(|(.., c)| c[0].closed as f64)
            .sum::<f64>();
        // a mean of four
        let mean = report.dt * report.contacts[0].force;
        assert!((of_parts - mean).abs() <= 1e-14 * mean.abs());
        largest = largest.max(report.balance.energy_residual.abs());
    }
    let (state, system) = (whole.state(), whole.system());
    for driver in whole.zones().drivers() {
        let (zone, motion) = (driver.system(), &driver.state().motion);
        for (own, node) in zone.mesh_node.iter().enumerate() {
            let number = system.number[*node as usize] as usize;
            assert_eq!(state.motion.u[number], motion.u[own]);
            assert_eq!(state.motion.v[number], motion.v[own]);
        }
    }
    // the forces of the joint are on its two nodes, and opposite but for the instants they are taken at
    let forces: Vec<f64> = (state.motion.link_force.iter().copied())
        .filter(|f| *f != 0.0)
        .collect();
    assert_eq!(forces.len(), 2);
    assert!(forces[0] * forces[1] < 0.0);
    // sums over the zones, to rounding of four hundred steps
    let tip = &whole.zones().drivers()[0].state().records;
    let records = &state.records;
    let of_contacts = (&records.contacts, &records.impacts, &records.small.contacts);
    let of_tip = (&tip.contacts, &tip.impacts, &tip.small.contacts);
    assert_eq!(of_contacts, of_tip, "the one contact is the first of both");
    // the tip is the second body
    for (body, driver) in [1, 0].into_iter().zip(whole.zones().drivers()) {
        let own = &driver.state().records.small.bodies[0];
        assert!(own.strain.value > 0.0 && records.small.bodies[body] == *own);
    }
    let record = &state.records.contacts[0];
    assert!(closed > 0.0 && (record.impulse() / impulse - 1.0).abs() < 1e-12);
    assert_eq!(state.records.ended().count(), 1);
    let ledger = &state.ledger;
    assert_eq!(ledger.balance, whole.zones().balance());
    assert_eq!(ledger.largest_energy_residual, largest);
    assert!(largest < 1e-11 * ledger.largest_energy, "{largest}");
    assert!(ledger.largest_momentum_residual < 1e-11 * ledger.largest_momentum);
    // what the contact reports is what the tip has got of it, links counted
    assert!(state.exchange.relative().unwrap() < 1e-11);
    // elements of each zone by its sweeps, four times as many where steps are inner ones
    let costs = whole.costs();
    let updates = whole.zones().drivers().iter().map(|d| {
        let sweeps = d.costs().force_sweeps;
        assert!(sweeps as u64 > 300);
        40 * sweeps as u64
    });
    assert_eq!(costs.element_updates, updates.sum::<u64>());
}

#[test]
fn a_run_in_zones_that_was_cut_ends_in_the_same_bytes() {
    let zoned = bar();
    let system = zoned.whole().unwrap();
    let mut whole = Whole::new(&zoned, Arc::clone(&system)).unwrap();
    let mut resumed = Vec::new();
    // before, in and after the contact of some 215 steps
    for step in 0..300 {
        if [0, 1, 100, 250].contains(&step) {
            let bytes = whole.saved().unwrap();
            resumed.push(Whole::resume(&zoned, Arc::clone(&system), &bytes).unwrap());
        }
        whole.step().unwrap();
    }
    for mut other in resumed {
        while other.state().step < 300 {
            other.step().unwrap();
        }
        assert_eq!(other.saved().unwrap(), whole.saved().unwrap());
        assert_eq!(other.state(), whole.state());
        assert_eq!(other.report(), whole.report());
    }
}

#[test]
fn bytes_of_another_model_are_refused() {
    let zoned = bar();
    let bytes = whole(&zoned).saved().unwrap();
    let mut other = bar();
    other.links[0].rows.clear();
    let refused = |zoned: &Zoned, bytes: &[u8]| {
        let system = zoned.whole().unwrap();
        match Whole::resume(zoned, system, bytes) {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        }
    };
    assert!(refused(&other, &bytes).contains("1 rows of links"));
    let mut other = bar();
    other.model.contacts.clear();
    assert!(refused(&other, &bytes).contains("another model"));
    assert!(refused(&zoned, &bytes[..50]).contains("state"));
}

#[test]
fn a_step_has_parts_only_where_it_takes_inner_steps() {
    let mut zoned = bar();
    zoned.zones[0].far = Some(1);
    // ten outer steps away from the wall
    let gap = 10.0 * zoned.model.dt;
    for body in &mut zoned.model.bodies {
        body.displacement[0] = -gap;
    }
    let mut whole = whole(&zoned);
    let (mut counts, mut impulse) = ([0; 2], 0.0);
    for _ in 0..500 {
        whole.step().unwrap();
        let report = whole.report();
        let parts = report.parts().count();
        assert!(parts == 1 || parts == INNER as usize);
        let last = report.parts().last().map_or(0.0, |(end, ..)| end);
        // parts of an earlier step would end there
        assert!((last / report.time - 1.0).abs() < 1e-12);
        let length: f64 = report.parts().map(|(_, dt, _)| dt).sum();
        assert!((length / report.dt - 1.0).abs() < 1e-12);
        counts[usize::from(parts > 1)] += 1;
        impulse += report
            .parts()
            .map(|(_, dt, c)| dt * c[0].force)
            .sum::<f64>();
    }
    assert!(counts[0] > 5 && counts[1] > 100, "{counts:?}");
    let record = &whole.state().records.contacts[0];
    assert!((record.impulse() / impulse - 1.0).abs() < 1e-12);
}
