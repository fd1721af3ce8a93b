//! A node that is pressed into the fold between two faces.

use carom_bodies::{BodySpec, Formulation, Kinematics, MassKind};
use carom_contact::law::Displacement;
use carom_contact::{Initial, Integration, Law, Sliding};
use carom_dynamics::{
    Amplitude, Driver, Error, Model, ModelBody, ModelContact, ModelTarget, Nonlinear, Preload,
    Prescribed, Scheme, Support, System, scheme,
};
use carom_mesh::{Mesh, Surface, generate};

use crate::newton::SOFT;

/// Where the tip begins beside the bottom of the fold, m.
const BESIDE: f64 = 5e-5;

fn body(mesh: &Mesh, name: &str) -> ModelBody {
    ModelBody {
        spec: BodySpec {
            name: name.into(),
            cells: mesh.groups[name].elements.clone(),
            kinematics: Kinematics::PlaneStrain { thickness: 1.0 },
            material: SOFT.into(),
            formulation: Formulation::Full,
            weights: None,
            exact_products: false,
            viscosity: None,
            scaling: None,
            deletion: None,
            releases: Vec::new(),
            plies: Vec::new(),
            nodal_thickness: None,
            tightened: Vec::new(),
            layers: Vec::new(),
        },
        mass: MassKind::Lumped,
        velocity: [0.0; 3],
        displacement: [0.0; 3],
        spin: [0.0; 3],
        rigid: None,
        reduced: None,
        modal: None,
    }
}

/// A block whose lower side has a tip, over one whose upper side has a fold of this depth 1 m away from either end; the top of
/// the first comes down by `way` in a static step. `sight`: depth of penetrations that count, m, and whether near points alone are looked for.
fn pressed([depth, way]: [f64; 2], sight: (Option<f64>, bool)) -> Driver {
    let mut mesh = generate::rectangle("b", [-1.0, -1.0], [2.0, 1.0], [2, 1], false);
    let upper = generate::rectangle("a", [BESIDE - 0.5, 0.0], [1.0; 2], [2, 1], false);
    mesh.merge("a", upper).unwrap();
    for x in &mut mesh.nodes {
        let middle = x[0] == 0.0 || (x[0] - BESIDE).abs() < 1e-9;
        if middle && x[1] == 0.0 {
            // the tip is on the face to the right
            x[1] = if x[0] == 0.0 {
                -depth
            } else {
                depth * (BESIDE - 1.0)
            };
        }
    }
    let bodies = vec![body(&mesh, "a"), body(&mesh, "b")];
    let surface = |group: &str, body: usize| {
        Surface::new(&mesh, &mesh.groups[group], &bodies[body].spec.cells).unwrap()
    };
    let along = |end: f64| Some(Amplitude::new(vec![[0.0, 0.0], [1.0, end]]).unwrap());
    let model = Model {
        contacts: vec![ModelContact {
            name: "fold".into(),
            secondary: surface("a.bottom", 0),
            primary: ModelTarget::Surface(surface("b.top", 1)),
            law: Law::Displacement(Displacement { projection: false }),
            sliding: Sliding::Finite,
            integration: Integration::Node,
            massless: false,
            friction: 0.0.into(),
            initial: Initial::Keep,
            depth: sight.0,
            moment_about: None,
            near_only: sight.1,
            both_ways: false,
            merge_within: None,
            parts: None,
        }],
        discrete: Vec::new(),
        supports: vec![Support {
            nodes: mesh.group_nodes(&mesh.groups["b.bottom"]),
            fix: [true, true, false],
            fix_rotations: [false; 3],
        }],
        named_supports: Vec::new(),
        gravity: [0.0; 3],
        scheme: Scheme::Newmark(scheme::Newmark {
            beta: 0.25,
            gamma: 0.5,
        }),
        dt: 1.0,
        zones: Vec::new(),
        links: Vec::new(),
        constraints: Vec::new(),
        adaptive: None,
        critical_fraction: None,
        nonlinear: Nonlinear {
            motions: vec![Prescribed {
                nodes: mesh.group_nodes(&mesh.groups["a.top"]),
                displacement: [along(0.0), along(-way), None],
            }],
            preload: Some(Preload { end: 1.0, steps: 1 }),
            ..Nonlinear::default()
        },
        bodies,
        mesh,
    };
    Driver::new(System::new(model).unwrap()).unwrap()
}

#[test]
fn a_node_in_a_flat_fold_stays_with_one_face() {
    // as in a contact between two surfaces, and in the general contact, where points have a sight and far ones are left out
    for sight in [(None, false), (Some(0.5), false), (Some(0.5), true)] {
        stays_with_one_face(sight);
    }
}

fn stays_with_one_face(sight: (Option<f64>, bool)) {
    let (depth, way) = (0.02, 0.01);
    let mut newton = pressed([depth, way], sight);
    newton.step().unwrap();
    let (system, state) = (newton.system(), newton.state());
    assert_eq!(newton.report().attempts, 1, "no part of the step is needed");
    let place = |node: usize| {
        let u = &state.motion.u[2 * node..2 * node + 2];
        [system.x[node][0] + u[0], system.x[node][1] + u[1]]
    };
    let points = system.contacts[0].points.iter();
    let closed = points
        .zip(&state.interface.force)
        .filter(|(_, f)| **f > 0.0);
    let tips: Vec<usize> = closed.map(|(point, _)| point.node() as usize).collect();
    let bottom = |node: &usize| system.x[*node] == [0.0, -depth, 0.0];
    let fold = (0..system.x.len()).find(bottom).unwrap();
    assert_eq!(tips.len(), 1);
    let [tip, fold] = [tips[0], fold].map(place);
    // a face pushes the tip aside, by the slope times the way times the stiffness over that of shear, less than 10; it then
    // is on the line of the face beyond the bottom, whose slope the load changes little
    let [aside, below] = [(tip[0] - fold[0]).abs(), fold[1] - tip[1]];
    assert!(aside < 10.0 * depth * way, "{aside:e}");
    assert!(below > 0.0 && below < 2.0 * depth * aside, "{below:e}");
}

#[test]
fn a_node_that_slides_through_a_steep_fold_is_told() {
    for sight in [(None, false), (Some(0.5), false), (Some(0.5), true)] {
        let error = pressed([0.5, 0.2], sight).step().unwrap_err();
        assert!(matches!(error, Error::Equilibrium { .. }));
        assert!(
            error.to_string().contains("slides through the fold"),
            "{error}"
        );
    }
}
