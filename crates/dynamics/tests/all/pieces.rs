//! A body of several pieces that share no node: each of them is what it is as a body of its own.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::Law;
use carom_contact::law::Displacement;
use carom_dynamics::scheme::Newmark;
use carom_dynamics::{Model, ModelBody, ModelContact, ModelTarget, Scheme, System};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};

/// A small block above a large one, as one body or as two, in contact with nodes without mass.
fn blocks(together: bool) -> Model {
    let mut mesh = generate::box_("low", [0.0; 3], [2.0; 3], [3, 3, 3], false);
    let high = generate::box_("high", [0.5, 0.5, 2.0], [1.0; 3], [3, 3, 4], false);
    mesh.merge("high", high).unwrap();
    let of = |name: &str| mesh.groups[name].elements.clone();
    let body = |name: &str, cells| {
        let material = Elastic {
            density: 1000.0,
            young: 1e8,
            poisson: 0.0,
        };
        ModelBody::new(BodySpec::new(name, cells, Kinematics::Solid, material))
    };
    let bodies = match together {
        true => vec![body("all", [of("low"), of("high")].concat())],
        false => vec![body("low", of("low")), body("high", of("high"))],
    };
    let surface =
        |group: &str, cells: &str| Surface::new(&mesh, &mesh.groups[group], &of(cells)).unwrap();
    let contact = ModelContact {
        massless: true,
        ..ModelContact::new(
            "c",
            surface("high.bottom", "high"),
            ModelTarget::Surface(surface("low.top", "low")),
            Law::Displacement(Displacement { projection: false }),
        )
    };
    Model {
        contacts: vec![contact],
        ..Model::new(
            bodies,
            mesh,
            Scheme::Newmark(Newmark {
                beta: 0.25,
                gamma: 0.5,
            }),
            1e-5,
        )
    }
}

#[test]
fn mass_of_contact_nodes_stays_in_their_piece() {
    let masses = |together: bool| -> Vec<f64> {
        let system = System::new(blocks(together)).unwrap();
        let nodes = 0..system.mesh.nodes.len();
        nodes
            .map(|node| system.mass.lumped[system.unknowns.first(system.number[node])])
            .collect()
    };
    let (one, two) = (masses(true), masses(false));
    // the same numbers in the same order; that of the sums over the nodes of a piece may differ
    for (one, two) in one.iter().zip(&two) {
        assert!((one - two).abs() < 1e-10 * two.max(1.0), "{one} {two}");
    }
    let low: f64 = one[..64].iter().sum();
    assert!((low / 8000.0 - 1.0).abs() < 1e-12, "{low}");
}
