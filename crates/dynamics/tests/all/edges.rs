//! A block of rubber with sharp edges, pressed on a wider one and pushed along it: mortar contact with friction in full slip.
//!
//! The leading edge digs in, and the facets of the lower surface in front of it stand up by some fifteen degrees, more than
//! the angle of friction. Forces of the order of the shear modulus turn with these facets.

use carom_bodies::{BodySpec, Formulation, Kinematics, MassKind};
use carom_contact::law::Displacement;
use carom_contact::{Basis, Initial, Integration, Law, Sliding};
use carom_dynamics::{
    Amplitude, Driver, Model, ModelBody, ModelContact, ModelTarget, Nonlinear, Preload, Prescribed,
    Scheme, Support, System, scheme,
};
use carom_materials::{Elastic, Law as Material, NeoHooke};
use carom_mesh::{Mesh, Surface, generate};

const MU: f64 = 0.2;
const STEPS: u64 = 20;

fn body(mesh: &Mesh, name: &str) -> ModelBody {
    let initial = Elastic {
        density: 1100.0,
        young: 2e6,
        poisson: 0.45,
    };
    ModelBody {
        spec: BodySpec {
            name: name.into(),
            cells: mesh.groups[name].elements.clone(),
            kinematics: Kinematics::PlaneStrain { thickness: 1.0 },
            material: Material::NeoHooke(NeoHooke { initial }),
            formulation: Formulation::BBar,
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

/// The upper block is pressed down by a tenth of its height in the first half of the steps, and pushed along by a fifth of its
/// width in the second. `secondary`: the body that carries the multipliers, 0 for the upper one.
fn sheared(secondary: usize) -> Driver {
    let mut mesh = generate::rectangle("lower", [-0.1, -0.1], [0.2, 0.1], [20, 5], false);
    let upper = generate::rectangle("upper", [-0.05, 0.0], [0.1, 0.1], [8, 4], false);
    mesh.merge("upper", upper).unwrap();
    let bodies = vec![body(&mesh, "upper"), body(&mesh, "lower")];
    let surface = |body: usize| {
        let group = ["upper.bottom", "lower.top"][body];
        Surface::new(&mesh, &mesh.groups[group], &bodies[body].spec.cells).unwrap()
    };
    let along = |table: &[[f64; 2]]| Some(Amplitude::new(table.to_vec()).unwrap());
    let model = Model {
        contacts: vec![ModelContact {
            name: "edge".into(),
            secondary: surface(secondary),
            primary: ModelTarget::Surface(surface(1 - secondary)),
            law: Law::Displacement(Displacement { projection: false }),
            sliding: Sliding::Finite,
            integration: Integration::Mortar { basis: Basis::Dual },
            massless: false,
            friction: MU.into(),
            initial: Initial::Keep,
            depth: None,
            moment_about: None,
            near_only: false,
            both_ways: false,
            merge_within: None,
            parts: None,
        }],
        discrete: Vec::new(),
        supports: vec![Support {
            nodes: mesh.group_nodes(&mesh.groups["lower.bottom"]),
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
                nodes: mesh.group_nodes(&mesh.groups["upper.top"]),
                displacement: [
                    along(&[[1.0, 0.0], [2.0, 0.02]]),
                    along(&[[0.0, 0.0], [1.0, -0.01]]),
                    None,
                ],
            }],
            preload: Some(Preload {
                end: 2.0,
                steps: STEPS,
            }),
            ..Nonlinear::default()
        },
        bodies,
        mesh,
    };
    Driver::new(System::new(model).unwrap()).unwrap()
}

#[test]
fn a_sharp_edge_slides_over_facets_that_stand_up() {
    let forces = [0, 1].map(|secondary| {
        let mut newton = sheared(secondary);
        for step in 1..=STEPS {
            newton.step().unwrap();
            let interface = &newton.state().interface;
            let largest = interface.force.iter().fold(0.0_f64, |m, p| m.max(*p));
            let mut slipping = 0;
            for (p, t) in interface.force.iter().zip(&interface.friction) {
                // Coulomb's law to the tolerance of the iterations, whatever they have mixed
                let beyond = t[0].abs() - MU * p;
                assert!(beyond <= 1e-9 * largest, "step {step}: {t:?} {p}");
                slipping += usize::from(*p > 0.0 && beyond.abs() <= 1e-9 * largest);
            }
            if step == STEPS {
                let closed = interface.force.iter().filter(|p| **p > 0.0).count();
                assert_eq!(slipping, closed, "full slip");
            }
        }
        newton.report().contacts[0].resultant
    });
    // The same bodies with the multipliers on the one or the other: two discretisations of one contact, and the force on the
    // secondary is that on the other with the sign changed. They differ by the facet in front of the edge, which is part of
    // one contact only: half a face of eight carries a sixteenth of the force, on a slope of 1/4 at most, whose cosine is
    // less than one by 1/32.
    let normal = forces[0][1].abs();
    for (i, bound) in [normal / 16.0 / 4.0, normal / 16.0 / 32.0]
        .into_iter()
        .enumerate()
    {
        let [one, other] = [forces[0][i], -forces[1][i]];
        assert!((one - other).abs() < bound, "{one} {other}");
    }
}
