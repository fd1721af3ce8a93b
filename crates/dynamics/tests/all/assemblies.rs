//! Energies of bodies that may act on each other: what the materials of others take is not theirs.

use carom_bodies::{BodySpec, Curve, DiscreteKind, DiscreteSpec, Kinematics, Link};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Law, Plane, Sliding};
use carom_dynamics::{
    AssemblyEnergy, Driver, Model, ModelBody, ModelContact, ModelDiscrete, ModelTarget, Scheme,
    State, System, scheme,
};
use carom_elements::Kind;
use carom_materials::{Elastic, J2Plasticity, Law as Material, NeoHooke};
use carom_mesh::{Mesh, Surface, generate};

use crate::newton::SOFT;

const VELOCITY: Law = Law::Velocity(Velocity {
    capture: Capture::Half,
    reading: Reading::Closed,
});
const CENTRAL: Scheme = Scheme::CentralDifference(scheme::CentralDifference {});
const THETA: Scheme = Scheme::Theta(scheme::Theta { theta: 0.5 });

const END: f64 = 3.0;

/// To the end. Waves pass a cell in 0.14 s, of which squares that strike leave explicit steps a third.
fn steps(scheme: Scheme) -> usize {
    match scheme.get().is_explicit() {
        true => 150,
        false => 60,
    }
}

/// Two squares, one above the other, that fly towards each other.
struct Pair {
    /// Of its left side, m.
    at: f64,
    /// Between the two, m.
    gap: f64,
    /// Of each, m/s.
    speed: f64,
    material: Material,
    /// Plastic strain at which cells are deleted.
    deletion: Option<f64>,
}

impl Pair {
    /// Of rubber so many times as stiff and heavy, in which waves are as fast.
    fn new(at: f64, gap: f64, speed: f64, times: f64) -> Pair {
        Pair {
            at,
            gap,
            speed,
            material: rubber(times),
            deletion: None,
        }
    }
}

fn rubber(times: f64) -> Material {
    let initial = Elastic {
        density: times * SOFT.density,
        young: times * SOFT.young,
        ..SOFT
    };
    Material::NeoHooke(NeoHooke { initial })
}

fn square(name: &str, origin: [f64; 2], n: usize) -> Mesh {
    generate::rectangle(name, origin, [1.0; 2], [n, n], false)
}

fn body(mesh: &Mesh, name: &str, material: Material, speed: f64) -> ModelBody {
    let cells = mesh.groups[name].elements.clone();
    let plane = Kinematics::PlaneStrain { thickness: 0.5 };
    ModelBody {
        velocity: [0.0, speed, 0.0],
        ..ModelBody::new(BodySpec::new(name, cells, plane, material))
    }
}

fn contact(name: &str, side: Surface, target: ModelTarget) -> ModelContact {
    ModelContact {
        sliding: Sliding::Finite,
        ..ModelContact::new(name, side, target, VELOCITY)
    }
}

fn model(scheme: Scheme, mesh: Mesh, bodies: Vec<ModelBody>) -> Model {
    let mut model = Model::new(bodies, mesh, scheme, END / steps(scheme) as f64);
    // what the iterations leave is rounding
    model.nonlinear.iteration.tolerance = 1e-14;
    // a step in parts would be another one for all assemblies
    model.nonlinear.iteration.halvings = 0;
    model
}

fn pairs(scheme: Scheme, all: &[Pair]) -> Driver {
    let mut mesh: Option<Mesh> = None;
    let mut add = |name: &str, part: Mesh| match &mut mesh {
        None => mesh = Some(part),
        Some(mesh) => mesh.merge(name, part).unwrap(),
    };
    let names: Vec<[String; 2]> = (0..all.len())
        .map(|k| ["low", "high"].map(|side| format!("{side}{k}")))
        .collect();
    for (pair, [low, high]) in all.iter().zip(&names) {
        add(low, square(low, [pair.at, 0.0], 3));
        add(high, square(high, [pair.at + 0.1, 1.0 + pair.gap], 2));
    }
    let mesh = mesh.unwrap();
    let (mut bodies, mut contacts) = (Vec::new(), Vec::new());
    for (pair, [low, high]) in all.iter().zip(&names) {
        let side = |name: &str, side: &str| {
            let (group, cells) = (&mesh.groups[&format!("{name}.{side}")], &mesh.groups[name]);
            Surface::new(&mesh, group, &cells.elements).unwrap()
        };
        let target = ModelTarget::Surface(side(low, "top"));
        contacts.push(contact(low, side(high, "bottom"), target));
        for (name, speed) in [(low, pair.speed), (high, -pair.speed)] {
            let mut own = body(&mesh, name, pair.material, speed);
            own.spec.deletion = pair.deletion;
            bodies.push(own);
        }
    }
    let model = Model {
        contacts,
        ..model(scheme, mesh.clone(), bodies)
    };
    Driver::new(System::new(model).unwrap()).unwrap()
}

/// What is told of an assembly, J.
fn told(energy: &AssemblyEnergy) -> [f64; 6] {
    [
        energy.now,
        energy.largest,
        energy.released,
        energy.largest_gain,
        energy.largest_made,
        energy.dissipated,
    ]
}

/// A pair whose squares meet after 0.5 s at 0.2 m/s, alone and beside one a thousand times as heavy whose squares meet after 0.08 s at 0.6 m/s. What the works of its forces
/// miss was shared by all, a thousandth of the energy of the first pair. Explicit steps of that are the same to the bit. Implicit ones are solved to 1e-14 of the forces, times the
/// condition of the equations, some hundred: 1e-10 in a hundred steps. The bound is ten times that.
#[test]
fn what_others_do_far_away_is_not_in_the_energies_of_an_assembly() {
    for scheme in [CENTRAL, THETA] {
        let name = scheme.get().name();
        let first = || Pair::new(0.0, 0.2, 0.2, 1.0);
        let mut alone = pairs(scheme, &[first()]);
        let mut beside = pairs(scheme, &[first(), Pair::new(100.0, 0.1, 0.6, 1000.0)]);
        let mut most = 0.0_f64;
        for _ in 0..steps(scheme) {
            alone.step().unwrap();
            beside.step().unwrap();
            let [one, other] = [&alone, &beside].map(|driver| driver.state().assemblies.all[0]);
            for (a, b) in told(&one).into_iter().zip(told(&other)) {
                most = most.max((a - b).abs() / one.start);
            }
        }
        let records = &beside.state().records.contacts;
        assert_eq!(records.len(), 2, "{name}");
        assert!(records.iter().all(|of| of.impulse() > 0.0), "{name}");
        assert!(most < 1e-9, "{name}: {most:e}");
    }
}

/// Largest difference between what the assemblies have together and what the ledger has, over the largest energy. The frames of all rest.
fn left_over(state: &State) -> f64 {
    let all = state.assemblies.all.iter();
    let now: f64 = all.map(|energy| energy.now).sum();
    let balance = &state.ledger.balance;
    let whole = balance.kinetic + balance.internal();
    (now - whole).abs() / state.ledger.initial.kinetic
}

/// With cells that are deleted too, whose energy their assembly keeps as what it lost: rounding of a hundred steps, 1e-14.
#[test]
fn the_energies_of_assemblies_add_up_to_the_ledger() {
    let metal = J2Plasticity {
        initial: Elastic {
            density: 2.0,
            ..SOFT
        },
        yield_stress: 0.3,
        hardening: 0.5,
    };
    for scheme in [CENTRAL, THETA] {
        let name = scheme.get().name();
        let broken = Pair {
            material: Material::J2Plasticity(metal),
            deletion: Some(0.05),
            ..Pair::new(100.0, 0.1, 1.0, 1.0)
        };
        let mut driver = pairs(scheme, &[Pair::new(0.0, 0.2, 0.2, 1.0), broken]);
        let mut most = 0.0;
        for _ in 0..steps(scheme) {
            driver.step().unwrap();
            most = f64::max(most, left_over(driver.state()));
        }
        assert!(driver.state().ledger.deleted > 0, "{name}");
        assert!(most < 1e-12, "{name}: {most:e}");
    }
}

/// Two squares that fall on planes of their own, each with a spring to the ground; the springs have one name. The materials of both assemblies and the springs are told of
/// as one: each assembly has of what they took what its forces say, and both together have all of it.
#[test]
fn assemblies_with_springs_of_one_name_have_together_what_these_took() {
    for scheme in [CENTRAL, THETA] {
        let mut mesh = square("a", [0.0; 2], 3);
        mesh.merge("b", square("b", [100.0, 0.0], 3)).unwrap();
        let sides = ["a", "b"].map(|name| mesh.group_nodes(&mesh.groups[&format!("{name}.top")]));
        let cells = sides.map(|nodes| mesh.push(Kind::Point1, &nodes[..1]));
        let bodies = ["a", "b"].map(|name| body(&mesh, name, rubber(1.0), -0.5));
        let contacts = [0.1, 0.3].into_iter().zip(&bodies).map(|(below, body)| {
            let group = &mesh.groups[&format!("{}.bottom", body.spec.name)];
            let plane = ModelTarget::rigid(Plane {
                point: [0.0, -below, 0.0],
                normal: [0.0, 1.0, 0.0],
            });
            let side = Surface::new(&mesh, group, &body.spec.cells).unwrap();
            contact(&body.spec.name, side, plane)
        });
        let mut model = Model {
            contacts: contacts.collect(),
            ..model(scheme, mesh.clone(), bodies.to_vec())
        };
        model.discrete.push(ModelDiscrete::new(DiscreteSpec {
            name: "springs".to_owned(),
            cells: cells.to_vec(),
            kind: DiscreteKind::Spring(Link {
                curve: Curve::line(3.0),
                axis: Some([0.0, 1.0, 0.0]),
            }),
        }));
        let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
        let assemblies = &driver.system().assemblies.all;
        assert_eq!(assemblies.len(), 2);
        for _ in 0..steps(scheme) {
            driver.step().unwrap();
            let left = left_over(driver.state());
            // rounding of sums over a hundred steps
            assert!(left < 1e-12, "{}: {left:e}", scheme.get().name());
        }
        let contacts = &driver.state().records.contacts;
        assert!(contacts.iter().all(|of| of.impulse() > 0.0));
    }
}
