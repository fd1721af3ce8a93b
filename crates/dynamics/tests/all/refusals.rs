//! Models that are refused, and why: meshes that overlap at the start, static stages of what nothing holds.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::Displacement;
use carom_contact::{Initial, Law, Sliding};
use carom_dynamics::{
    Driver, Error, Model, ModelBody, ModelContact, ModelTarget, Preload, Scheme, Support, System,
    scheme,
};
use carom_materials::{Elastic, Law as Material, NeoHooke};
use carom_mesh::{Mesh, Surface, generate};

const SOFT: Elastic = Elastic {
    density: 2.0,
    young: 8.0,
    poisson: 0.3,
};

/// Bodies of these groups and a contact of surfaces, each given by group and body.
fn model(mesh: Mesh, bodies: &[&str], contact: [(&str, &str); 2], initial: Initial) -> Model {
    let kinematics = match mesh.dim {
        2 => Kinematics::PlaneStrain { thickness: 1.0 },
        _ => Kinematics::Solid,
    };
    let body = |name: &&str| {
        ModelBody::new(BodySpec::new(
            *name,
            mesh.groups[*name].elements.clone(),
            kinematics,
            Material::NeoHooke(NeoHooke { initial: SOFT }),
        ))
    };
    let [secondary, primary] = contact.map(|(group, body)| {
        Surface::new(&mesh, &mesh.groups[group], &mesh.groups[body].elements).unwrap()
    });
    Model {
        contacts: vec![ModelContact {
            sliding: Sliding::Finite,
            initial,
            ..ModelContact::new(
                "joint",
                secondary,
                ModelTarget::Surface(primary),
                Law::Displacement(Displacement::default()),
            )
        }],
        ..Model::new(
            bodies.iter().map(body).collect(),
            mesh,
            Scheme::Newmark(scheme::Newmark {
                beta: 0.25,
                gamma: 0.5,
            }),
            0.01,
        )
    }
}

/// Two blocks of side 1, the upper one with its lower side at the height `low`.
fn blocks(dim: usize, low: f64) -> Mesh {
    let block = |name: &str, low: f64, n: usize| match dim {
        2 => generate::rectangle(name, [0.0, low], [1.0; 2], [n; 2], false),
        _ => generate::box_(name, [0.0, 0.0, low], [1.0; 3], [n; 3], false),
    };
    let mut mesh = block("upper", low, 3);
    mesh.merge("lower", block("lower", 0.0, 2)).unwrap();
    mesh
}

const JOINT: [(&str, &str); 2] = [("upper.bottom", "upper"), ("lower.top", "lower")];

#[test]
fn blocks_that_overlap_are_refused_with_node_and_depth() {
    for (dim, inside) in [(2, 4), (3, 16)] {
        let refused = |low| {
            let model = model(
                blocks(dim, low),
                &["upper", "lower"],
                JOINT,
                Initial::Refuse,
            );
            System::new(model)
        };
        assert!(refused(1.0).is_ok(), "touching is no overlap");
        match refused(0.95) {
            Err(carom_system::Error::Penetration {
                contact,
                points,
                node,
                depth,
            }) => {
                assert_eq!((contact.as_str(), points), ("joint", inside));
                // the lower row of the upper block has the first numbers; depths are rounded
                assert!((node as usize) < inside && (depth - 0.05).abs() < 1e-14);
            }
            Err(other) => panic!("{other}"),
            Ok(_) => panic!("taken"),
        }
    }
}

#[test]
fn a_mesh_that_overlaps_itself_is_refused_where_its_surface_faces_itself() {
    for dim in [2, 3] {
        let refused = |low| {
            let mesh = blocks(dim, low);
            let mut both = mesh.groups["upper"].elements.clone();
            both.extend(&mesh.groups["lower"].elements);
            let mut facets = mesh.groups["upper.bottom"].elements.clone();
            facets.extend(&mesh.groups["lower.top"].elements);
            let mut mesh = mesh;
            let group = |elements, dim| carom_mesh::Group::new(dim, elements);
            mesh.groups.insert("whole".into(), group(both, dim));
            mesh.groups.insert("inner".into(), group(facets, dim - 1));
            let inner = [("inner", "whole"); 2];
            System::new(model(mesh, &["whole"], inner, Initial::Refuse))
        };
        assert!(refused(1.01).is_ok(), "a gap is no overlap");
        match refused(0.95) {
            Err(carom_system::Error::Overlap {
                contact, points, ..
            }) => {
                // the nodes of either side but those on the rims, which lie in no cell
                assert!(contact == "joint" && points > 0);
            }
            Err(other) => panic!("{other}"),
            Ok(_) => panic!("taken"),
        }
    }
}

#[test]
fn a_static_stage_names_the_body_that_is_free_and_its_motion() {
    let free = |dim: usize, holds: &[(&str, [bool; 3])]| {
        let mut model = model(blocks(dim, 1.0), &["upper", "lower"], JOINT, Initial::Keep);
        model.contacts.clear();
        started(model, holds)
    };
    let (all, x, y) = ([true; 3], [true, false, false], [false, true, false]);
    assert_eq!(free(2, &[]), "upper: move along x");
    let lower = ("lower.bottom", all);
    assert_eq!(free(2, &[lower]), "upper: move along x");
    assert_eq!(free(2, &[lower, ("upper.left", x)]), "upper: move along y");
    let upper = [lower, ("upper.left", x), ("upper.top", y)];
    assert_eq!(free(2, &upper), "held");
    assert_eq!(free(2, &upper[1..]), "lower: move along x");
    let solid = [lower, ("upper.left", x), ("upper.front", y)];
    assert_eq!(free(3, &solid), "upper: move along z");
    let line = [lower, ("upper.left", x), ("upper.right", x)];
    assert_eq!(free(3, &line), "upper: move along y");
}

#[test]
fn a_static_stage_refuses_only_bodies_that_no_contact_could_hold() {
    let with = |inner| {
        started(
            model(blocks(2, 1.0), &["upper", "lower"], inner, Initial::Keep),
            &[],
        )
    };
    // what becomes of the loads is seen in the step
    assert_eq!(with(JOINT), "held");
    let own = [("upper.bottom", "upper"), ("upper.top", "upper")];
    assert_eq!(
        with(own),
        "upper: move along x",
        "a body does not hold itself"
    );
}

/// How a static stage of a model starts with supports at these groups.
fn started(mut model: Model, holds: &[(&str, [bool; 3])]) -> String {
    for (group, fix) in holds {
        model.supports.push(Support {
            nodes: model.mesh.group_nodes(&model.mesh.groups[*group]),
            fix: *fix,
            fix_rotations: [false; 3],
        });
    }
    model.nonlinear.preload = Some(Preload { end: 1.0, steps: 1 });
    match Driver::new(System::new(model).unwrap()) {
        Err(Error::FreeMotion { body, motion, .. }) => format!("{body}: {motion}"),
        Err(other) => panic!("{other}"),
        Ok(_) => "held".to_string(),
    }
}
