//! One contact surface over several bodies: apart, they are no two bodies that meet; with common nodes they are one.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Integration, Law, Plane};
use carom_dynamics::scheme::Theta;
use carom_dynamics::{
    Driver, Impact, Model, ModelBody, ModelContact, ModelTarget, NoRestitution, Scheme, System,
};
use carom_materials::Elastic;
use carom_mesh::{ElementId, Mesh, Surface, generate};

const DENSITIES: [f64; 2] = [1.0, 3.0];

/// Two squares that fall on a plane with these speeds (m/s), their lower sides one surface.
fn squares(mesh: Mesh, cells: [Vec<ElementId>; 2], speeds: [f64; 2]) -> Model {
    let body = |k: usize| {
        let material = Elastic {
            density: DENSITIES[k],
            young: 1.0,
            poisson: 0.0,
        };
        let plane = Kinematics::PlaneStrain { thickness: 1.0 };
        ModelBody {
            velocity: [0.0, -speeds[k], 0.0],
            ..ModelBody::new(BodySpec::new(
                format!("b{k}"),
                cells[k].clone(),
                plane,
                material,
            ))
        }
    };
    let bodies = vec![body(0), body(1)];
    let mut below = Surface::outer(&mesh, &cells.concat());
    let low = |node: &u32| mesh.nodes[*node as usize][1] == 0.0;
    below.faces.retain(|face| face.corners().iter().all(low));
    assert_eq!(below.faces.len(), 8);
    let plane = ModelTarget::rigid(Plane {
        point: [0.0, -0.1, 0.0],
        normal: [0.0, 1.0, 0.0],
    });
    let law = Law::Velocity(Velocity {
        capture: Capture::Half,
        reading: Reading::Closed,
    });
    let contact = ModelContact {
        integration: Integration::Node,
        ..ModelContact::new("floor", below, plane, law)
    };
    Model {
        contacts: vec![contact],
        ..Model::new(bodies, mesh, Scheme::Theta(Theta { theta: 0.5 }), 0.05)
    }
}

/// The impacts until 6 s, and the largest difference between the impulse of the contacts and the momenta, relative.
fn run(model: Model) -> (Vec<Impact>, f64) {
    let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
    while driver.state().time < 6.0 {
        driver.step().unwrap();
    }
    let state = driver.state();
    let residual = state.exchange.relative().unwrap();
    (state.impacts(driver.system()), residual)
}

/// The second square stands apart from the first one.
fn apart() -> (Mesh, [Vec<ElementId>; 2]) {
    let square = |name, x| generate::rectangle(name, [x, 0.0], [1.0; 2], [4, 4], false);
    let mut mesh = square("a", 0.0);
    mesh.merge("b", square("b", 2.0)).unwrap();
    let cells = ["a", "b"].map(|name| mesh.groups[name].elements.clone());
    (mesh, cells)
}

/// The second square shares nodes with the first one.
fn joined() -> (Mesh, [Vec<ElementId>; 2]) {
    let mesh = generate::rectangle("a", [0.0; 2], [2.0, 1.0], [8, 4], false);
    let all = mesh.groups["a"].elements.clone();
    let left = |cell: &ElementId| {
        let nodes = mesh.element_nodes(*cell);
        nodes
            .iter()
            .all(|&node| mesh.nodes[node as usize][0] <= 1.0)
    };
    let cells = all.into_iter().partition(left);
    (mesh, cells.into())
}

#[test]
fn bodies_apart_that_share_a_surface_get_their_impulses_and_have_no_common_restitution() {
    let (mesh, cells) = apart();
    let (impacts, residual) = run(squares(mesh, cells, [0.1, 0.1]));
    assert!(residual < 1e-12, "{residual}");
    assert_eq!(impacts.len(), 1);
    assert_eq!(impacts[0].no_restitution, Some(NoRestitution::ManyBodies));
    // both have turned: more than the momentum of either
    assert!(impacts[0].impulse > 1.5 * 0.1 * DENSITIES[1]);
}

#[test]
fn bodies_with_common_nodes_are_one_body_of_their_whole_mass() {
    let (mesh, cells) = joined();
    let (impacts, residual) = run(squares(mesh, cells, [0.1, 0.1]));
    assert!(residual < 1e-12, "{residual}");
    let [impact] = &impacts[..] else {
        panic!("{} impacts", impacts.len());
    };
    let mass = DENSITIES[0] + DENSITIES[1];
    assert!((impact.approach - 0.1).abs() < 1e-12);
    let restitution = impact.restitution.unwrap();
    assert!((impact.impulse - mass * 0.1 * (1.0 + restitution)).abs() < 1e-10);
}
