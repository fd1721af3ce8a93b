//! What a body refuses.

use carom_bodies::{Body, BodySpec, Error, Kinematics};
use carom_mesh::{ElementId, Mesh, generate};

use crate::sample::{MATERIAL, cells};

fn refusal(mesh: &Mesh, cells: Vec<ElementId>, kinematics: Kinematics) -> Error {
    let spec = BodySpec {
        name: "arm".to_owned(),
        cells,
        kinematics,
        material: MATERIAL,
    };
    let number: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
    Body::new(mesh, spec, &number).unwrap_err()
}

#[test]
fn a_body_without_elements_is_refused() {
    let error = refusal(&Mesh::new(3), Vec::new(), Kinematics::Solid);
    assert!(matches!(&error, Error::Empty { body } if body == "arm"));
    assert_eq!(error.to_string(), "body 'arm' has no element");
}

#[test]
fn elements_of_another_dimension_are_refused() {
    let solid = generate::box_("b", [0.0; 3], [1.0; 3], [1; 3], false);
    let plane = Kinematics::PlaneStrain { thickness: 1.0 };
    for (dim, kinematics, found) in [
        (3, plane, "hex8"),
        (3, Kinematics::Bar { area: 1.0 }, "hex8"),
        (2, Kinematics::Solid, "quad4"),
        // plane elements lying in space
        (2, Kinematics::Axisymmetric, "quad4"),
    ] {
        let error = refusal(&solid, cells(&solid, dim), kinematics);
        assert!(
            matches!(&error, Error::WrongElement { found: name, .. } if *name == found),
            "{error}"
        );
    }
}

#[test]
fn negative_radii_are_refused_with_their_node() {
    let mesh = generate::rectangle("b", [-0.5, 0.0], [1.0; 2], [2, 1], false);
    let error = refusal(&mesh, cells(&mesh, 2), Kinematics::Axisymmetric);
    assert!(
        matches!(error, Error::NegativeRadius { node: 0, radius, .. } if radius == -0.5),
        "{error}"
    );
}
