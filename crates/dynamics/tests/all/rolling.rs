//! Static equilibria of discs that only contact holds.
//!
//! A disc of straight edges rolls from node to node: a stiffness of any sign, a millionth of that of the elements. Without
//! friction its place along a plane is not held at all.

use carom_contact::Sliding;
use carom_dynamics::{Driver, Error, ModelBody, ModelTarget, Preload, System};
use carom_dynamics::{Model, Support};
use carom_materials::{Elastic, Law as Material, NeoHooke};
use carom_mesh::{Mesh, Surface, generate};

use crate::floating::{TRAPEZOID, VELOCITY};
use crate::newton::square;

/// A few nodes of the disc are in contact under its weight.
const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e6,
    poisson: 0.3,
};
/// Radius, m.
const R: f64 = 0.1;
const GRAVITY: f64 = 9.81;
const STEPS: u64 = 5;

/// A disc about (0, R), with nodes at equal angles on its edge; one of them at the bottom.
fn disc(edges: usize) -> Mesh {
    let n = edges / 4;
    let mut mesh = generate::rectangle("a", [-1.0; 2], [2.0; 2], [n, n], false);
    for x in &mut mesh.nodes {
        // squares about the centre become circles
        let radius = x[0].abs().max(x[1].abs());
        let across = if radius == 0.0 {
            0.0
        } else {
            x[0].abs().min(x[1].abs()) / radius
        };
        let angle = std::f64::consts::FRAC_PI_4 * across;
        let (long, short) = (radius * angle.cos(), radius * angle.sin());
        let flat = x[0].abs() >= x[1].abs();
        let round = match flat {
            true => [long, short],
            false => [short, long],
        };
        let round = [0, 1].map(|i| round[i].copysign(x[i]));
        x[0] = R * round[0];
        x[1] = R + R * round[1];
    }
    mesh
}

fn edge(model: &Model) -> Surface {
    let sides = ["a.bottom", "a.right", "a.top", "a.left"];
    let elements = sides
        .iter()
        .flat_map(|side| &model.mesh.groups[*side].elements);
    let group = carom_mesh::Group::new(1, elements.copied().collect());
    Surface::new(&model.mesh, &group, &model.bodies[0].spec.cells).unwrap()
}

/// A disc of rubber that just touches a plane, and is given its weight in static steps.
fn on_a_plane(edges: usize, friction: f64) -> Model {
    let material = Material::NeoHooke(NeoHooke { initial: RUBBER });
    let mut model = square(TRAPEZOID, VELOCITY, material, 1);
    model.mesh = disc(edges);
    model.bodies[0].spec.cells = model.mesh.groups["a"].elements.clone();
    model.bodies[0].velocity = [0.0; 3];
    model.gravity = [0.0, -GRAVITY, 0.0];
    model.nonlinear.preload = Some(Preload {
        end: 1.0,
        steps: STEPS,
    });
    let contact = &mut model.contacts[0];
    contact.primary = ModelTarget::rigid(carom_contact::Plane {
        point: [0.0; 3],
        normal: [0.0, 1.0, 0.0],
    });
    contact.friction = friction.into();
    contact.sliding = Sliding::Finite;
    model.contacts[0].secondary = edge(&model);
    model
}

/// The same disc on a soft block, whose middle is a quarter of an element off.
fn on_a_block(edges: usize, friction: f64) -> Model {
    let mut model = on_a_plane(edges, friction);
    let block = generate::rectangle("b", [-0.1925, -0.1], [0.4, 0.1], [20, 5], false);
    model.mesh.merge("b", block).unwrap();
    let mut body: ModelBody = model.bodies[0].clone();
    body.spec.name = "b".into();
    body.spec.cells = model.mesh.groups["b"].elements.clone();
    let top = Surface::new(&model.mesh, &model.mesh.groups["b.top"], &body.spec.cells).unwrap();
    model.contacts[0].primary = ModelTarget::Surface(top);
    model.bodies.push(body);
    model.supports.push(Support {
        nodes: model.mesh.group_nodes(&model.mesh.groups["b.bottom"]),
        fix: [true, true, false],
        fix_rotations: [false; 3],
    });
    model
}

/// Takes the steps of the stage; iterations and factorisations of all.
fn pressed(model: Model) -> Result<(Driver, usize, usize), Error> {
    let mut newton = Driver::new(System::new(model).unwrap())?;
    let mut iterations = 0;
    for _ in 0..STEPS {
        newton.step()?;
        assert_eq!(newton.report().attempts, 1, "step in halves");
        iterations += newton.residuals().len();
    }
    let factorisations = newton.costs().work.factorisations;
    Ok((newton, iterations, factorisations))
}

/// Asserts that contact carries the disc: force = weight, below its centre of mass.
fn assert_carried(newton: &Driver) {
    let (system, state) = (newton.system(), newton.state());
    let masses = &system.body_masses[0];
    let place = |node: u32| {
        let node = node as usize;
        [0, 1].map(|i| system.x[node][i] + state.motion.u[2 * node + i])
    };
    let mut force = [0.0; 2];
    let (mut moment, mut mass, mut middle) = (0.0, 0.0, 0.0);
    for &(node, m) in masses {
        mass += m;
        middle += m * place(node)[0];
    }
    middle /= mass;
    for &(node, _) in masses {
        let at = place(node);
        let f = [0, 1].map(|i| state.motion.contact_force[2 * node as usize + i]);
        force[0] += f[0];
        force[1] += f[1];
        // friction acts at the height of the nodes, against nothing: it has no resultant
        moment += f[1] * (at[0] - middle) - f[0] * at[1];
    }
    let weight = mass * GRAVITY;
    // iterations end at 1e-10 of the norm of all nodal forces, a few times the weight; lengths are of the size of R
    assert!(
        (force[1] / weight - 1.0).abs() < 1e-9,
        "{force:?} of {weight}"
    );
    assert!(force[0].abs() < 1e-9 * weight, "{force:?} of {weight}");
    assert!(
        moment.abs() < 1e-9 * weight * R,
        "{moment:e} of {}",
        weight * R
    );
    let ledger = &state.ledger;
    assert!(
        ledger.largest_energy_residual < 1e-9 * ledger.largest_energy,
        "{:e} of {:e}",
        ledger.largest_energy_residual,
        ledger.largest_energy
    );
}

#[test]
fn a_disc_finds_its_rest_on_a_plane() {
    for (edges, friction) in [(24, 0.0), (32, 0.0), (32, 0.3)] {
        let (newton, iterations, factorisations) = pressed(on_a_plane(edges, friction)).unwrap();
        assert_carried(&newton);
        // on the node on which it stood, not an edge further
        let x = &newton.system().x;
        let bottom = (0..x.len()).find(|&k| x[k][0].abs() < 1e-12 && x[k][1].abs() < 1e-12);
        let moved = newton.state().motion.u[2 * bottom.unwrap()];
        assert!(moved.abs() < 1e-6 * R, "{moved:e}");
        // as a body that is held: two or three iterations beyond those of the first Newton steps
        assert!(iterations <= 8 * STEPS as usize, "{iterations}");
        assert!(factorisations <= 2 * STEPS as usize, "{factorisations}");
    }
}

#[test]
fn a_disc_finds_its_rest_on_a_soft_block() {
    for (edges, friction, most) in [(16, 0.0, 20), (24, 0.0, 20), (24, 0.3, 8), (32, 0.3, 8)] {
        let (newton, iterations, _) = pressed(on_a_block(edges, friction)).unwrap();
        assert_carried(&newton);
        assert!(
            iterations <= most * STEPS as usize,
            "{edges} {friction}: {iterations}"
        );
    }
}

#[test]
fn a_disc_slides_along_facets_to_its_rest() {
    // the node at the bottom is not where a facet is level under its weight: that is further than iterations may go at once
    for (edges, steps) in [(32, 1), (32, STEPS), (48, STEPS)] {
        let mut model = on_a_block(edges, 0.0);
        model.nonlinear.preload = Some(Preload { end: 1.0, steps });
        let mut newton = Driver::new(System::new(model).unwrap()).unwrap();
        for _ in 0..steps {
            newton.step().unwrap();
        }
        assert_carried(&newton);
    }
}
