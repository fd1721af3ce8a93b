//! Moments of contact forces about a point: the rate of the angular momentum of a body that nothing else acts on.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Basis, Integration, Law, Plane, Sliding};
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelTarget, Scheme, System, scheme};
use carom_materials::{Elastic, Law as Material, NeoHooke};
use carom_mesh::{Mesh, Surface, generate};

const SOFT: Elastic = Elastic {
    density: 1000.0,
    young: 1e7,
    poisson: 0.3,
};
const CENTRE: [f64; 3] = [0.5, 0.5, 0.0];
const STEPS: usize = 60;

/// Resultant (N) and moment out of the plane (N m) of each step.
type Moments = Vec<([f64; 3], f64)>;
/// A model whose moments are about this place, m.
type OfPlace = fn([f64; 3]) -> Model;

fn law(capture: Capture) -> Law {
    Law::Velocity(Velocity {
        capture,
        reading: Reading::Closed,
    })
}

fn body(mesh: &Mesh, name: &str, material: Material, velocity: [f64; 3]) -> ModelBody {
    let cells = mesh.groups[name].elements.clone();
    let plane = Kinematics::PlaneStrain { thickness: 1.0 };
    ModelBody {
        velocity,
        ..ModelBody::new(BodySpec::new(name, cells, plane, material))
    }
}

/// A unit square that falls on a slope, which a corner hits first, away from the mass centre.
fn on_slope(about: [f64; 3]) -> Model {
    let mesh = generate::rectangle("block", [0.0; 2], [1.0; 2], [6, 6], false);
    let block = body(&mesh, "block", SOFT.into(), [0.0, -2.0, 0.0]);
    let ground = ModelTarget::rigid(Plane {
        point: [0.0; 3],
        normal: [0.6, 0.8, 0.0],
    });
    let bottom = &mesh.groups["block.bottom"];
    let contact = ModelContact {
        moment_about: Some(about),
        ..ModelContact::new(
            "ground",
            Surface::new(&mesh, bottom, &block.spec.cells).unwrap(),
            ground,
            law(Capture::Half),
        )
    };
    Model {
        contacts: vec![contact],
        ..Model::new(
            vec![block],
            mesh,
            Scheme::Theta(scheme::Theta { theta: 0.5 }),
            2e-4,
        )
    }
}

/// The same square at finite strain that falls with friction on one end of another, wider one, by mortar.
fn on_block(about: [f64; 3]) -> Model {
    let mut mesh = generate::rectangle("block", [0.0; 2], [1.0; 2], [4, 4], false);
    let low = generate::rectangle("low", [-1.5, -1.001], [2.0, 1.0], [7, 3], false);
    mesh.merge("low", low).unwrap();
    let soft = || Material::NeoHooke(NeoHooke { initial: SOFT });
    let bodies = vec![
        body(&mesh, "block", soft(), [1.0, -2.0, 0.0]),
        body(&mesh, "low", soft(), [0.0; 3]),
    ];
    let surface = |body: usize, group: &str| {
        Surface::new(&mesh, &mesh.groups[group], &bodies[body].spec.cells).unwrap()
    };
    let contact = ModelContact {
        sliding: Sliding::Finite,
        integration: Integration::Mortar { basis: Basis::Dual },
        friction: 0.3.into(),
        moment_about: Some(about),
        ..ModelContact::new(
            "touch",
            surface(0, "block.bottom"),
            ModelTarget::Surface(surface(1, "low.top")),
            law(Capture::Now),
        )
    };
    Model {
        contacts: vec![contact],
        ..Model::new(
            bodies,
            mesh,
            Scheme::EnergyMomentum(scheme::EnergyMomentum::default()),
            2e-4,
        )
    }
}

/// Angular momentum of the first body about a point fixed in space, of its lumped masses, N m s. `moved`: whether at current places.
fn angular(driver: &Driver, about: [f64; 3], moved: bool) -> f64 {
    let (system, motion) = (driver.system(), &driver.state().motion);
    let of = |&(node, mass): &(u32, f64)| {
        let first = system.unknowns.first(node);
        let place = |i: usize| {
            let u = if moved { motion.u[first + i] } else { 0.0 };
            system.x[node as usize][i] + u - about[i]
        };
        mass * (place(0) * motion.v[first + 1] - place(1) * motion.v[first])
    };
    system.body_masses[0].iter().map(of).sum()
}

/// The driver after some steps; angular momentum that the moments have given, and the largest so far; resultants and moments.
fn run(model: Model, about: [f64; 3]) -> (Driver, [f64; 2], Moments) {
    let dt = model.dt;
    let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
    let (mut given, mut largest, mut steps) = (0.0, 0.0_f64, Vec::new());
    for _ in 0..STEPS {
        driver.step().unwrap();
        let contact = &driver.report().contacts[0];
        assert_eq!(contact.moment[..2], [0.0; 2], "a moment out of the plane");
        given += dt * contact.moment[2];
        largest = largest.max(angular(&driver, about, true).abs());
        steps.push((contact.resultant, contact.moment[2]));
    }
    (driver, [given, largest], steps)
}

#[test]
fn the_moment_about_the_mass_centre_is_the_rate_of_the_angular_momentum() {
    // linear steps leave rounding, iterations their tolerance of 1e-10 of the largest force in each of the steps
    let cases: [(OfPlace, bool, f64); 2] = [(on_slope, false, 1e-12), (on_block, true, 1e-8)];
    for (model, moved, bound) in cases {
        let begin = Driver::new(System::new(model(CENTRE)).unwrap()).unwrap();
        let (end, [given, largest], steps) = run(model(CENTRE), CENTRE);
        let change = angular(&end, CENTRE, moved) - angular(&begin, CENTRE, moved);
        assert!(
            (change - given).abs() < bound * largest,
            "{change} {given} {largest}"
        );
        assert!(change.abs() > 0.1 * largest, "the body turns: {change}");
        assert!(steps.iter().any(|(force, _)| force[0].abs() > 0.0));
    }
}

#[test]
fn the_moment_about_another_point_differs_by_the_moment_of_the_resultant() {
    let way = [0.3, -0.7, 0.0];
    let other = [0, 1, 2].map(|i| CENTRE[i] + way[i]);
    for model in [on_slope, on_block] {
        let (.., here) = run(model(CENTRE), CENTRE);
        let (.., there) = run(model(other), other);
        let size = here
            .iter()
            .fold(0.0_f64, |m, (_, moment)| m.max(moment.abs()));
        for ((force, one), (same, two)) in here.into_iter().zip(there) {
            assert_eq!(force, same);
            let turned = way[0] * force[1] - way[1] * force[0];
            assert!((two - (one - turned)).abs() < 1e-12 * size, "{one} {two}");
        }
    }
}

#[test]
fn sides_that_share_nodes_have_no_moment() {
    let mut model = on_slope(CENTRE);
    let secondary = model.contacts[0].secondary.clone();
    model.contacts[0].primary = ModelTarget::Surface(secondary);
    let error = System::new(model).unwrap_err().to_string();
    assert!(error.contains("share nodes"), "{error}");
}

#[test]
fn moments_touch_the_nodes_of_the_secondary_surface_alone() {
    for model in [on_slope, on_block] {
        let system = System::new(model(CENTRE)).unwrap();
        let about = system.contacts[0].moment.as_ref().unwrap();
        let mut nodes: Vec<u32> = about.arms.nodes.iter().map(|lever| lever.node).collect();
        nodes.sort_unstable();
        let faces = system.contacts[0].secondary_faces.iter();
        let mut own: Vec<u32> = faces.flat_map(|face| face.corners()).copied().collect();
        own.sort_unstable();
        own.dedup();
        assert_eq!(nodes, own);
        assert!(own.len() < system.x.len() / 4);
    }
}
