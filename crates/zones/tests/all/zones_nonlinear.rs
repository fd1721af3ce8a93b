//! Zones at finite strain, and the links between them.

use carom_arlequin::{Row, trace};
use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Law as ContactLaw, Plane, Sliding};
use carom_dynamics::scheme::{CentralDifference, EnergyMomentum, Newmark, Theta};
use carom_dynamics::{
    Amplitude, Driver, Load, LoadKind, Model, ModelBody, ModelContact, ModelLink, ModelTarget,
    Nonlinear, Scheme, Support, System,
};
use carom_materials::{Elastic, J2Plasticity, Law, NeoHooke, StVenantKirchhoff};
use carom_mesh::{ElementId, Group, Mesh, Surface, generate};
use carom_zones::{LinkKind, ModelZone, Zoned, Zones, mortar_rows};

const SOFT: Elastic = Elastic {
    density: 2.0,
    young: 8.0,
    poisson: 0.3,
};

const HALF: Scheme = Scheme::Theta(Theta { theta: 0.5 });
const TRAPEZOID: Scheme = Scheme::Newmark(Newmark {
    beta: 0.25,
    gamma: 0.5,
});
const BETWEEN: Scheme = Scheme::EnergyMomentum(EnergyMomentum {});
const EXPLICIT: Scheme = Scheme::CentralDifference(CentralDifference {});
const NEO_HOOKE: Law = Law::NeoHooke(NeoHooke { initial: SOFT });

fn body(name: &str, cells: Vec<ElementId>, material: Law) -> ModelBody {
    ModelBody::new(BodySpec::new(
        name,
        cells,
        Kinematics::PlaneStrain { thickness: 1.0 },
        material,
    ))
}

fn model(mesh: Mesh, bodies: Vec<ModelBody>, scheme: Scheme) -> Model {
    let mut nonlinear = Nonlinear::default();
    nonlinear.iteration.tolerance = 1e-12;
    Model {
        nonlinear,
        ..Model::new(bodies, mesh, scheme, 0.08)
    }
}

/// A zone for each of two bodies.
fn zoned(model: Model, rows: Vec<Row>, schemes: [Scheme; 2], substeps: u32) -> Zoned {
    let zone = |body: usize, substeps| {
        ModelZone::new(
            model.bodies[body].spec.name.clone(),
            vec![body],
            (schemes[body], substeps),
        )
    };
    Zoned {
        zones: vec![zone(0, substeps), zone(1, 1)],
        links: vec![ModelLink {
            name: "joint".into(),
            zones: [0, 1],
            rows,
        }],
        kind: match substeps {
            1 => LinkKind::GravouilCombescure,
            _ => LinkKind::PrakashHjelmstad,
        },
        model,
    }
}

/// A strip of 2 by 0.5 in one mesh, and its cells on either side of x = 1.
fn strip() -> (Mesh, [Vec<ElementId>; 2]) {
    let mesh = generate::rectangle("strip", [0.0; 2], [2.0, 0.5], [8, 2], false);
    let is_left = |cell: &ElementId| {
        let nodes = mesh.element_nodes(*cell);
        nodes
            .iter()
            .map(|n| mesh.nodes[*n as usize][0])
            .sum::<f64>()
            < 4.0
    };
    let (left, right) = mesh.groups["strip"]
        .elements
        .iter()
        .partition(|c| is_left(c));
    (mesh, [left, right])
}

/// The strip in two zones, tied at the nodes that they share.
fn halves(materials: [Law; 2], schemes: [Scheme; 2], substeps: u32) -> Zoned {
    let (mesh, [left, right]) = strip();
    let nodes = |cells: &[ElementId]| {
        let mut nodes: Vec<u32> = cells
            .iter()
            .flat_map(|cell| mesh.element_nodes(*cell).to_vec())
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    };
    let rows = trace(&mesh, &nodes(&left), &nodes(&right), 1e-9).unwrap();
    let bodies = vec![
        body("left", left, materials[0]),
        body("right", right, materials[1]),
    ];
    zoned(model(mesh, bodies, HALF), rows.rows, schemes, substeps)
}

/// Nodal values of a field in the plane.
fn nodal(system: &System, field: impl Fn(&[f64; 3]) -> [f64; 2]) -> Vec<f64> {
    system.x.iter().flat_map(field).collect()
}

/// Begins at u = 0 with the velocities of a field.
fn start(zones: &mut Zones, field: impl Fn(&[f64; 3]) -> [f64; 2]) {
    let motions: Vec<[Vec<f64>; 2]> = zones
        .drivers()
        .iter()
        .map(|driver| {
            let system = driver.system();
            [vec![0.0; system.unknowns()], nodal(system, &field)]
        })
        .collect();
    zones.restart(&motions).unwrap();
}

/// Turns, stretches and bends the strip.
fn tumble(x: &[f64; 3]) -> [f64; 2] {
    let (x, y) = (x[0] - 1.0, x[1] - 0.25);
    [0.5 * x * x - 0.8 * y, 0.8 * x + 0.6 * x * y]
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}

#[test]
fn matching_zones_of_one_scheme_are_the_single_mesh() {
    for scheme in [HALF, TRAPEZOID, BETWEEN] {
        let mut zones = Zones::new(&halves([NEO_HOOKE; 2], [scheme; 2], 1)).unwrap();
        start(&mut zones, tumble);
        let (mesh, [left, right]) = strip();
        let cells = [left, right].concat();
        let one = model(mesh, vec![body("strip", cells, NEO_HOOKE)], scheme);
        let mut one = Driver::new(System::new(one).unwrap()).unwrap();
        let v = nodal(one.system(), tumble);
        one.restart(&vec![0.0; v.len()], &v).unwrap();
        for _ in 0..40 {
            zones.step().unwrap();
            one.step().unwrap();
        }
        let u = &one.state().motion.u;
        assert!(largest(u) > 1.0, "the rotation is large");
        for driver in zones.drivers() {
            let (system, motion) = (driver.system(), &driver.state().motion);
            for (own, node) in system.mesh_node.iter().enumerate() {
                let number = one.system().number[*node as usize] as usize;
                for i in 0..2 {
                    let (a, b) = (motion.u[2 * own + i], u[2 * number + i]);
                    // both solve to 1e-12, and errors of the steps grow little in three periods
                    let name = scheme.get().name();
                    assert!((a - b).abs() < 1e-9, "{name}: {a} {b}");
                }
            }
        }
        let passes = zones.all_passes() as f64 / zones.outer_step() as f64;
        assert!(passes < 8.0, "{}: {passes} passes", scheme.get().name());
    }
}

/// The strip that strikes a rigid plane, one of its nodes on it tied to the other half, as one system of two zones and as a single mesh.
/// Each step is solved to 1e-12 of the forces, and sixty of them enlarge that some hundred times.
#[test]
fn linked_implicit_zones_at_finite_strain_are_the_single_mesh_in_contact_too() {
    for scheme in [HALF, TRAPEZOID, BETWEEN] {
        let struck = |mut model: Model| {
            // the half whose nodes on the border are tied
            let (_, [left, _]) = strip();
            let bottom = &model.mesh.groups["strip.bottom"];
            let (x, nodes) = (&model.mesh.nodes, |facet: &ElementId| {
                model.mesh.element_nodes(*facet)
            });
            let is_left = |facet: &ElementId| nodes(facet).iter().all(|n| x[*n as usize][0] < 1.01);
            let elements = bottom.elements.iter().copied();
            let group = Group {
                dim: 1,
                elements: elements.filter(is_left).collect(),
            };
            let secondary = Surface::new(&model.mesh, &group, &left).unwrap();
            let target = ModelTarget::rigid(Plane {
                point: [0.0; 3],
                normal: [0.0, 1.0, 0.0],
            });
            let law = ContactLaw::Velocity(Velocity {
                capture: Capture::Now,
                reading: Reading::Closed,
            });
            model.contacts = vec![ModelContact {
                sliding: Sliding::Finite,
                ..ModelContact::new("floor", secondary, target, law)
            }];
            model
        };
        let zoned = halves([NEO_HOOKE; 2], [scheme; 2], 1);
        let zoned = Zoned {
            model: struck(zoned.model),
            ..zoned
        };
        let system = zoned.together().unwrap().expect("one system");
        let fall = |x: &[f64; 3]| {
            let [vx, vy] = tumble(x);
            [0.3 * vx, 0.3 * vy - 0.4]
        };
        let run = |system: std::sync::Arc<System>| {
            let mut driver = Driver::new(system.clone()).unwrap();
            let v = nodal(&system, fall);
            driver.restart(&vec![0.0; v.len()], &v).unwrap();
            let (mut forces, mut tied) = (Vec::new(), 0);
            for _ in 0..60 {
                driver.step().unwrap();
                forces.push(driver.report().contacts[0].force);
                // points in the order of their nodes, which is that of x
                tied += usize::from(driver.state().interface.force.last() > Some(&0.0));
            }
            (driver, forces, tied)
        };
        let (together, forces, _) = run(system.clone());
        let (mesh, [left, right]) = strip();
        let cells = [left, right].concat();
        let single = struck(model(mesh, vec![body("strip", cells, NEO_HOOKE)], scheme));
        let single = System::new(single).unwrap();
        let (one, expected, tied) = run(single.clone());
        let name = scheme.get().name();
        assert!(tied > 0, "{name}: the tied node is in contact");
        let most = largest(&expected);
        for (force, expected) in forces.iter().zip(&expected) {
            assert!(
                (force - expected).abs() < 1e-9 * most,
                "{name}: {force} {expected}"
            );
        }
        let u = &one.state().motion.u;
        for (node, x) in system.x.iter().enumerate() {
            let own = single.x.iter().position(|other| other == x).unwrap();
            for k in 0..2 {
                let [a, b] = [together.state().motion.u[2 * node + k], u[2 * own + k]];
                assert!((a - b).abs() < 1e-10 * largest(u), "{name}, {x:?}: {a} {b}");
            }
        }
    }
}

/// Explicit zones of rubber: the mass alone is factored, so contacts and links of equal steps are one problem at finite strain too.
/// One system gives the motion of the single mesh to rounding, which two hundred steps enlarge a little. With four inner
/// steps in one half each ledger closes, and the other half moves as before up to what the steps of both schemes differ by: some
/// (ω dt)² of the displacements of the modes that the start excites, ω dt < 0.1.
#[test]
fn explicit_zones_at_finite_strain_are_the_single_mesh() {
    let zoned = halves([NEO_HOOKE; 2], [EXPLICIT; 2], 1);
    let mut zoned = Zoned {
        model: Model {
            dt: 0.01,
            ..zoned.model
        },
        ..zoned
    };
    let system = zoned.together().unwrap().expect("one system");
    assert!(system.is_nonlinear());
    let mut together = Driver::new(system.clone()).unwrap();
    let v = nodal(&system, tumble);
    together.restart(&vec![0.0; v.len()], &v).unwrap();
    let (mesh, [left, right]) = strip();
    let single = Model {
        dt: 0.01,
        ..model(
            mesh,
            vec![body("strip", [left, right].concat(), NEO_HOOKE)],
            EXPLICIT,
        )
    };
    let single = System::new(single).unwrap();
    let mut one = Driver::new(single.clone()).unwrap();
    let v = nodal(&single, tumble);
    one.restart(&vec![0.0; v.len()], &v).unwrap();
    for _ in 0..200 {
        together.step().unwrap();
        one.step().unwrap();
    }
    let u = &one.state().motion.u;
    for (node, x) in system.x.iter().enumerate() {
        let own = single.x.iter().position(|other| other == x).unwrap();
        for k in 0..2 {
            let [a, b] = [together.state().motion.u[2 * node + k], u[2 * own + k]];
            assert!((a - b).abs() < 1e-10 * largest(u), "{x:?}: {a} {b}");
        }
    }
    let ledger = &together.state().ledger;
    assert!(ledger.largest_energy_residual < 1e-11 * ledger.largest_energy);
    zoned.zones[0].substeps = 4;
    zoned.kind = LinkKind::PrakashHjelmstad;
    let mut zones = Zones::new(&zoned).unwrap();
    start(&mut zones, tumble);
    for _ in 0..200 {
        zones.step().unwrap();
    }
    for driver in zones.drivers() {
        let ledger = &driver.state().ledger;
        assert!(ledger.largest_energy_residual < 1e-10 * ledger.largest_energy);
    }
    let (system, motion) = (
        zones.drivers()[1].system(),
        &zones.drivers()[1].state().motion,
    );
    for (node, x) in system.x.iter().enumerate() {
        let own = single.x.iter().position(|other| other == x).unwrap();
        for k in 0..2 {
            let apart = (motion.u[2 * node + k] - u[2 * own + k]).abs();
            assert!(apart < 0.05 * largest(u), "{x:?}: {apart}");
        }
    }
}

#[test]
fn zones_at_finite_strain_tend_to_linear_ones_with_the_amplitude() {
    let finite = Law::StVenantKirchhoff(StVenantKirchhoff { initial: SOFT });
    for schemes in [[HALF, EXPLICIT], [HALF, TRAPEZOID], [BETWEEN, HALF]] {
        let substeps = if schemes[1] == EXPLICIT { 4 } else { 1 };
        let run = |material: Law, amplitude: f64| {
            let mut zones = Zones::new(&halves([material; 2], schemes, substeps)).unwrap();
            assert_eq!(
                !zones.drivers()[1].system().is_nonlinear(),
                material.finite().is_none()
            );
            start(&mut zones, |x| tumble(x).map(|v| amplitude * v));
            for _ in 0..20 {
                zones.step().unwrap();
            }
            let u = zones.drivers().iter().map(|d| d.state().motion.u.clone());
            u.collect::<Vec<_>>().concat()
        };
        let difference = |amplitude: f64| {
            let [one, other] = [finite, SOFT.into()].map(|law| run(law, amplitude));
            let gap: Vec<f64> = one.iter().zip(&other).map(|(a, b)| a - b).collect();
            largest(&gap) / largest(&other)
        };
        let [coarse, fine] = [1e-4, 1e-5].map(difference);
        // of the order of the strain, 1e-4 times some ten
        assert!(coarse < 2e-3 && (8.0..12.0).contains(&(coarse / fine)));
    }
}

#[test]
fn a_uniform_stress_rests_on_a_border_whose_nodes_do_not_match() {
    let material = carom_materials::Elastic {
        poisson: 0.0,
        ..SOFT
    };
    let law = Law::StVenantKirchhoff(StVenantKirchhoff { initial: material });
    let mut mesh = generate::rectangle("left", [0.0; 2], [1.0, 1.0], [3, 3], false);
    let other = generate::rectangle("right", [1.0, 0.0], [1.0, 1.0], [2, 4], false);
    mesh.merge("two", other).unwrap();
    let bodies: Vec<ModelBody> = ["left", "right"]
        .map(|name| body(name, mesh.groups[name].elements.clone(), law))
        .into();
    let surface = |body: usize, group: &str| {
        Surface::new(&mesh, &mesh.groups[group], &bodies[body].spec.cells).unwrap()
    };
    let rows = mortar_rows(
        &mesh,
        &surface(0, "left.right"),
        &surface(1, "right.left"),
        |_| 1.0,
    );
    assert_eq!(rows.rows.len(), 2 * 5);
    let stretch = 1.3;
    let load = Load {
        name: "pull".into(),
        surface: surface(1, "right.right"),
        // P = F S with S = E (stretch² - 1)/2
        kind: LoadKind::Traction([
            stretch * material.young * (stretch * stretch - 1.0) / 2.0,
            0.0,
            0.0,
        ]),
        amplitude: Amplitude::constant(1.0),
    };
    let held = mesh.group_nodes(&mesh.groups["left.left"]);
    let mut model = model(mesh, bodies, HALF);
    model.supports = vec![Support {
        nodes: held,
        fix: [true, false, false],
        fix_rotations: [false; 3],
    }];
    model.nonlinear.loads = vec![load];
    for scheme in [HALF, TRAPEZOID, BETWEEN] {
        let mut zones =
            Zones::new(&zoned(model.clone(), rows.rows.clone(), [scheme; 2], 1)).unwrap();
        let motions: Vec<[Vec<f64>; 2]> = zones
            .drivers()
            .iter()
            .map(|driver| {
                let u = nodal(driver.system(), |x| [(stretch - 1.0) * x[0], 0.0]);
                [u.clone(), vec![0.0; u.len()]]
            })
            .collect();
        zones.restart(&motions).unwrap();
        for _ in 0..20 {
            zones.step().unwrap();
        }
        for (driver, [u, _]) in zones.drivers().iter().zip(&motions) {
            let motion = &driver.state().motion;
            // equilibrium to the tolerance of the iterations
            let moved: Vec<f64> = motion.u.iter().zip(u).map(|(a, b)| a - b).collect();
            assert!(largest(&moved) < 1e-10 && largest(&motion.v) < 1e-10);
        }
    }
}

#[test]
fn plastic_strain_stays_in_its_zone_and_all_energy_is_found() {
    let plastic = Law::J2Plasticity(J2Plasticity {
        initial: SOFT,
        yield_stress: 0.5,
        hardening: 0.4,
    });
    for (substeps, scheme) in [(1, HALF), (4, EXPLICIT)] {
        let mut zones =
            Zones::new(&halves([plastic, NEO_HOOKE], [HALF, scheme], substeps)).unwrap();
        start(&mut zones, |x| [-0.8 * (x[0] - 1.0), 0.4 * (x[0] - 1.0)]);
        let start = zones.balance();
        for _ in 0..40 {
            zones.step().unwrap();
            let balance = zones.balance();
            // rounding and what the iterations leave, over forty steps
            assert!(
                balance.energy_residual.abs() < 1e-9 * start.energy(),
                "{:e}",
                balance.energy_residual / start.energy()
            );
        }
        let [left, right] = [0, 1].map(|zone| zones.drivers()[zone].state());
        assert!(left.ledger.balance.dissipation_material > 0.02 * start.energy());
        assert_eq!(right.ledger.balance.dissipation_material, 0.0);
        assert!(right.motion.history.is_empty());
    }
}

#[test]
fn zones_that_have_turned_go_on_from_their_state() {
    let model = halves([NEO_HOOKE; 2], [HALF, TRAPEZOID], 1);
    let mut zones = Zones::new(&model).unwrap();
    start(&mut zones, |x| tumble(x).map(|v| 2.0 * v));
    for _ in 0..30 {
        zones.step().unwrap();
    }
    let state = zones.state();
    let mut other = Zones::new(&model).unwrap();
    other.resume(&state);
    for _ in 0..5 {
        zones.step().unwrap();
        other.step().unwrap();
    }
    assert_eq!(zones.state(), other.state());
}
