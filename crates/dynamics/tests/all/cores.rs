//! Cores of bodies lie below their surfaces, whatever their cells, at inner corners too.

use carom_bodies::{BodySpec, Kinematics};
use carom_dynamics::scheme::Theta;
use carom_dynamics::{Model, ModelBody, Scheme, System};
use carom_materials::Elastic;
use carom_mesh::{ElementId, Mesh, generate, raise};

const SOFT: Elastic = Elastic {
    density: 1.0,
    young: 1.0,
    poisson: 0.0,
};

/// Vertices of the core of the first of two bodies of these cells.
fn vertices(mesh: &Mesh, cells: [Vec<ElementId>; 2], kinematics: Kinematics) -> Vec<[f64; 3]> {
    let body = |(name, cells): (&str, Vec<ElementId>)| {
        ModelBody::new(BodySpec::new(name, cells, kinematics, SOFT))
    };
    let bodies = ["a", "b"].into_iter().zip(cells).map(body).collect();
    let scheme = Scheme::Theta(Theta { theta: 0.5 });
    let system = System::new(Model::new(bodies, mesh.clone(), scheme, 0.1)).unwrap();
    let core = &system.cores()[0].core;
    let places: Vec<[f64; 3]> = (core.nodes().iter())
        .map(|node| system.x[*node as usize])
        .collect();
    let mut vertices = Vec::new();
    core.place(&places, &mut vertices);
    vertices
}

#[test]
fn those_of_plane_cells_of_both_orders_are_below_all_sides() {
    for triangles in [false, true] {
        for raised in [None, Some(false), Some(true)] {
            let square = |name: &str, x: f64| {
                generate::rectangle(name, [x, 0.0], [1.0; 2], [2, 2], triangles)
            };
            let mut mesh = square("a", 0.0);
            mesh.merge("b", square("b", 3.0)).unwrap();
            let mesh = match raised {
                Some(complete) => raise(&mesh, complete).unwrap(),
                None => mesh,
            };
            let cells = ["a", "b"].map(|name| mesh.groups[name].elements.clone());
            let all = vertices(&mesh, cells, Kinematics::PlaneStrain { thickness: 1.0 });
            assert!(!all.is_empty());
            // 1/20 of a cell of 0.5 m is 0.025 m; corners of triangles have less
            for x in all {
                let depth = x[..2]
                    .iter()
                    .fold(1.0, |least: f64, x| least.min(x.min(1.0 - x)));
                assert!(depth > 0.005, "{triangles} {raised:?}: {x:?}");
            }
        }
    }
}

/// Three cells of four around an upright edge: the means of the ways to their middles lead into the place of the fourth.
#[test]
fn one_with_an_inner_corner_does_not_come_out_of_it() {
    let mut mesh = generate::box_("a", [0.0; 3], [2.0, 2.0, 1.0], [2, 2, 1], false);
    mesh.merge(
        "b",
        generate::box_("b", [5.0, 0.0, 0.0], [1.0; 3], [1; 3], false),
    )
    .unwrap();
    let missing = |cell: &ElementId| {
        let nodes = mesh.element_nodes(*cell).iter();
        nodes
            .map(|node| mesh.nodes[*node as usize][..2].iter().sum::<f64>())
            .sum::<f64>()
            > 8.0 * 2.5
    };
    let mut three = mesh.groups["a"].elements.clone();
    three.retain(|cell| !missing(cell));
    assert_eq!(three.len(), 3);
    let cells = [three, mesh.groups["b"].elements.clone()];
    for x in vertices(&mesh, cells, Kinematics::Solid) {
        let within = x
            .iter()
            .zip([2.0, 2.0, 1.0])
            .all(|(x, most)| *x > 0.0 && *x < most);
        let fourth = x[0] >= 1.0 && x[1] >= 1.0;
        assert!(within && !fourth, "{x:?}");
    }
}
