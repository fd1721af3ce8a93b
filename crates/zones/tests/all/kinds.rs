//! Bodies of every kind in zones of unequal steps: beams, masses, springs, rigid bodies.

use std::sync::Arc;

use carom_algebra::rotation::Rotation;
use carom_arlequin::trace;
use carom_bodies::{
    BeamSection, BeamTheory, BodySpec, Curve, DiscreteKind, DiscreteSpec, Inertia, Kinematics,
    Link, SectionShape,
};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Law, Plane};
use carom_dynamics::scheme::{EnergyMomentum, Theta};
use carom_dynamics::{
    Driver, Model, ModelBody, ModelContact, ModelDiscrete, ModelLink, ModelRigid, ModelTarget,
    Scheme, Stepper, System,
};
use carom_elements::Kind;
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};
use carom_zones::{LinkKind, ModelZone, Whole, Zoned, Zones};

use crate::dense::error;

const STEEL: Elastic = Elastic {
    density: 7800.0,
    young: 2e11,
    poisson: 0.3,
};
const MID_POINT: Scheme = Scheme::Theta(Theta { theta: 0.5 });

fn zone(name: &str, body: usize, scheme: Scheme, substeps: u32) -> ModelZone {
    ModelZone::new(name, vec![body], (scheme, substeps))
}

/// Two beams end to end, tied in translations and rotation, that fall with the left end on a stop; a mass sits on the left one and
/// hangs on a spring. The left one takes `m` steps in one of the right one.
fn beams(m: u32) -> Zoned {
    let line = |name: &str, from: f64| {
        generate::line(name, [from, 0.0, 0.0], [from + 1.0, 0.0, 0.0], 8, 2)
    };
    let mut mesh = line("a", 0.0);
    mesh.merge("b", line("b", 1.0)).unwrap();
    let shape = SectionShape::Rectangle {
        height: 0.04,
        width: 0.02,
    };
    let section = BeamSection::new(BeamTheory::Timoshenko, shape.properties(0.3));
    let body = |name: &str| {
        let cells = mesh.groups[name].elements.clone();
        ModelBody {
            velocity: [0.1, -2.0, 0.0],
            ..ModelBody::new(BodySpec::new(name, cells, Kinematics::Beam(section), STEEL))
        }
    };
    let bodies = vec![body("a"), body("b")];
    let nodes = |group: &str| mesh.group_nodes(&mesh.groups[group]);
    let rows = trace(&mesh, &nodes("a"), &nodes("b"), 1e-9).unwrap();
    let rows = rows.with_rotations(2).rows;
    let end = Surface::new(&mesh, &mesh.groups["a.left"], &bodies[0].spec.cells).unwrap();
    let stop = Plane {
        point: [0.0, -1e-5, 0.0],
        normal: [0.0, 1.0, 0.0],
    };
    let law = Law::Velocity(Velocity {
        capture: Capture::Half,
        reading: Reading::Closed,
    });
    let at = nodes("a")[4];
    let cells = [0, 1].map(|_| mesh.push(Kind::Point1, &[at]));
    let spring = Link {
        curve: Curve::line(1e6),
        axis: Some([0.0, 1.0, 0.0]),
    };
    let kinds = [DiscreteKind::Mass(3.0.into()), DiscreteKind::Spring(spring)];
    let pairs = kinds.into_iter().zip(cells).enumerate();
    let discrete = pairs.map(|(k, (kind, cell))| {
        ModelDiscrete::new(DiscreteSpec {
            name: format!("d{k}"),
            cells: vec![cell],
            kind,
        })
    });
    Zoned {
        zones: vec![zone("a", 0, MID_POINT, m), zone("b", 1, MID_POINT, 1)],
        links: vec![ModelLink {
            name: "tie".into(),
            zones: [0, 1],
            rows,
        }],
        kind: LinkKind::PrakashHjelmstad,
        model: Model {
            contacts: vec![ModelContact::new(
                "stop",
                end,
                ModelTarget::rigid(stop),
                law,
            )],
            discrete: discrete.collect(),
            ..Model::new(bodies.clone(), mesh.clone(), MID_POINT, 2e-5)
        },
    }
}

/// The passes end at 1e-12 of the largest velocity in each of the steps; forces of elements and of the contact amplify it.
#[test]
fn passes_over_beams_are_the_one_system_of_them() {
    let zoned = beams(1);
    let mut driver = Driver::new(zoned.together().unwrap().unwrap()).unwrap();
    let whole = zoned.whole().unwrap();
    let mut run = Whole::new(&zoned, whole.clone()).unwrap();
    let mut touched = 0;
    for _ in 0..100 {
        driver.step().unwrap();
        run.step().unwrap();
        touched += usize::from(driver.report().contacts[0].force > 0.0);
    }
    assert!(touched > 5, "{touched} steps in contact");
    let system = Arc::clone(&zoned.together().unwrap().unwrap());
    for of in [
        |m: &carom_dynamics::State| m.motion.u.clone(),
        |m: &carom_dynamics::State| m.motion.v.clone(),
    ] {
        let [together, apart] = [of(driver.state()), of(run.state())];
        let place = |node: u32, s: &System| s.number[node as usize];
        let nodes = 0..zoned.model.mesh.nodes.len() as u32;
        let values = |x: &[f64], s: &System| -> Vec<f64> {
            let own = |node| {
                s.unknowns
                    .of(place(node, s))
                    .map(|i| x[i])
                    .collect::<Vec<_>>()
            };
            nodes.clone().flat_map(own).collect()
        };
        let found = error(&values(&apart, &whole), &values(&together, &system));
        assert!(found < 1e-9, "{found:e}");
    }
}

/// Rounding of a hundred steps, of sums over four inner steps each.
#[test]
fn beams_masses_and_springs_in_unequal_steps_keep_their_balances() {
    let mut zones = Zones::new(&beams(4)).unwrap();
    let (start, mut touched) = (zones.balance(), 0);
    for _ in 0..100 {
        zones.step().unwrap();
        let mut samples = zones.samples().iter();
        touched += usize::from(samples.any(|s| s.contacts.iter().any(|c| c.force > 0.0)));
    }
    assert!(touched > 5, "{touched} steps in contact");
    let balance = zones.balance();
    let (energy, momentum) = (start.energy(), start.momentum.largest());
    let left = balance.energy_residual.abs() / energy;
    assert!(left < 1e-11, "energy {left:e}");
    let left = balance.momentum_residual.largest() / momentum;
    assert!(left < 1e-11, "momentum {left:e}");
    // what the tie gives to one side it takes from the other
    let left = balance.impulse_links.largest() / momentum;
    assert!(left < 1e-11, "impulse of the link {left:e}");
    // the work of the link is of the order of what steps of different length differ by
    let work = balance.work_links.abs() / energy;
    assert!(work < 1e-2, "work of the link {work:e}");
}

/// A beam in inner steps falls on a block in outer ones. What the contact gives to one side it takes from the other, to rounding.
#[test]
fn a_beam_strikes_a_block_of_another_zone() {
    let mut zoned = beams(4);
    let block = generate::rectangle("block", [-0.2, -0.5], [1.2, 0.4], [6, 4], false);
    zoned.model.mesh.merge("block", block).unwrap();
    let mesh = &zoned.model.mesh;
    let cells = mesh.groups["block"].elements.clone();
    let kinematics = Kinematics::PlaneStrain { thickness: 0.01 };
    let spec = BodySpec::new("block", cells, kinematics, STEEL);
    let top = Surface::new(mesh, &mesh.groups["block.top"], &spec.cells).unwrap();
    zoned.model.bodies.push(ModelBody::new(spec));
    zoned.model.contacts[0].primary = ModelTarget::Surface(top);
    // falls 0.1 m to the block
    zoned.model.bodies[0].displacement = [0.0, -0.0999, 0.0];
    zoned.model.bodies[1].displacement = [0.0, -0.0999, 0.0];
    zoned.zones[1].bodies.push(2);
    let mut zones = Zones::new(&zoned).unwrap();
    let (start, mut touched) = (zones.balance(), 0);
    for _ in 0..60 {
        zones.step().unwrap();
        let report = zones.report_between(0).unwrap();
        touched += usize::from(report.force > 0.0);
    }
    assert!(touched > 5, "{touched} steps in contact");
    let (balance, momentum) = (zones.balance(), start.momentum.largest());
    let left = balance.momentum_residual.largest() / momentum;
    assert!(left < 1e-11, "momentum {left:e}");
    // the zones take forces between them for those of links
    let left = balance.impulse_links.largest() / momentum;
    assert!(left < 1e-11, "impulses between the zones {left:e}");
    let left = balance.energy_residual.abs() / start.energy();
    assert!(left < 1e-11, "energy {left:e}");
}

/// A top that turns freely in a zone of inner steps is the top by itself.
#[test]
fn a_rigid_body_turns_in_inner_steps_as_by_itself() {
    let scheme = Scheme::EnergyMomentum(EnergyMomentum {});
    let mut mesh = generate::box_("top", [-0.5; 3], [1.0; 3], [1; 3], false);
    let line = generate::line("bar", [2.0, 0.0, 0.0], [3.0, 0.0, 0.0], 4, 3);
    mesh.merge("bar", line).unwrap();
    let body = |name: &str, kinematics| {
        let cells = mesh.groups[name].elements.clone();
        ModelBody::new(BodySpec::new(name, cells, kinematics, STEEL))
    };
    let inertia = Inertia {
        mass: 1.0,
        centre: [0.0; 3],
        moments: [1.0, 2.0, 3.0],
        axes: Rotation::IDENTITY,
    };
    let top = ModelBody {
        velocity: [0.3, 0.0, -0.2],
        rigid: Some(ModelRigid {
            inertia,
            spin: [0.1, 3.0, 0.2],
        }),
        ..body("top", Kinematics::Solid)
    };
    let bar = body("bar", Kinematics::Bar { area: 1e-4 });
    let dt = 0.04;
    let alone = Model::new(vec![top.clone()], mesh.clone(), scheme, 0.25 * dt);
    let zoned = Zoned {
        zones: vec![zone("top", 0, scheme, 4), zone("bar", 1, MID_POINT, 1)],
        links: Vec::new(),
        kind: LinkKind::PrakashHjelmstad,
        model: Model::new(vec![top, bar], mesh, scheme, dt),
    };
    let mut driver = Driver::new(System::new(alone).unwrap()).unwrap();
    let whole = zoned.whole().unwrap();
    let mut run = Whole::new(&zoned, whole.clone()).unwrap();
    for _ in 0..50 {
        (0..4).for_each(|_| driver.step().unwrap());
        run.step().unwrap();
    }
    let centre = whole.unknowns.turning()[0];
    let own = whole.unknowns.of(centre);
    let [one, other] = [&driver.state().motion, &run.state().motion];
    let found = error(&other.v[own.clone()], &one.v);
    assert!(found < 1e-12, "velocities {found:e}");
    let matrices = [one.frames[0], other.frames[0]].map(|frame| frame.matrix());
    let apart = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    let apart = apart.map(|(i, j)| f64::abs(matrices[0][(i, j)] - matrices[1][(i, j)]));
    let apart = apart.fold(0.0, f64::max);
    assert!(apart < 1e-12, "rotations {apart:e}");
    let spin = driver.state().motion.v[4];
    assert!((spin - 3.0).abs() > 1e-3, "it tumbles: {spin}");
}
