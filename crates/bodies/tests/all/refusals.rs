//! What a body refuses.

use carom_algebra::unknowns::Unknowns;
use carom_bodies::{BodySpec, CellWeights, Error, Kinematics, Solid};
use carom_mesh::{ElementId, Mesh, generate};

use crate::sample::{MATERIAL, cells};

fn refusal(mesh: &Mesh, cells: Vec<ElementId>, kinematics: Kinematics) -> Error {
    refusal_of(mesh, cells, kinematics, None)
}

fn refusal_of(
    mesh: &Mesh,
    cells: Vec<ElementId>,
    kinematics: Kinematics,
    weights: Option<CellWeights>,
) -> Error {
    let spec = BodySpec {
        weights,
        ..BodySpec::new("arm", cells, kinematics, MATERIAL)
    };
    let number: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
    let unknowns = Unknowns::translations(mesh.dim, mesh.nodes.len());
    Solid::new(mesh, spec, &number, &unknowns).unwrap_err()
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

/// Eight weights on two quadrilaterals, or an error that names the wrong list.
#[test]
fn too_few_or_too_many_weights_are_refused() {
    let mesh = generate::rectangle("b", [0.0; 2], [2.0, 1.0], [2, 1], false);
    let plane = Kinematics::PlaneStrain { thickness: 1.0 };
    for (counts, wrong) in [
        ([7, 8], "inertia"),
        ([8, 9], "stiffness"),
        ([8, 0], "stiffness"),
    ] {
        let [inertia, stiffness] = counts.map(|count| vec![1.0; count]);
        let weights = CellWeights { inertia, stiffness };
        let error = refusal_of(&mesh, cells(&mesh, 2), plane, Some(weights));
        assert!(
            matches!(error, Error::WeightCount { quantity, expected: 8, found, .. }
                if quantity == wrong && counts.contains(&found) && found != 8),
            "{error}"
        );
    }
}

/// Cells given backwards, so that the weights of the second cell of the mesh come first.
#[test]
fn weights_that_make_mass_or_stiffness_negative_are_refused_with_their_cell() {
    let mesh = generate::line("b", [0.0; 3], [2.0, 0.0, 0.0], 2, 1);
    let backwards: Vec<_> = cells(&mesh, 1).into_iter().rev().collect();
    let refuse = |inertia: [f64; 4], stiffness: [f64; 4]| {
        let weights = CellWeights {
            inertia: inertia.to_vec(),
            stiffness: stiffness.to_vec(),
        };
        let bar = Kinematics::Bar { area: 6.0 };
        refusal_of(&mesh, backwards.clone(), bar, Some(weights))
    };
    // row sums ρ A L / 6 (2 w_1 + w_2): 0.2 is no reason to refuse, -0.5 is
    let error = refuse([-0.4, 1.0, 0.5, -1.5], [1.0; 4]);
    assert!(
        matches!(error, Error::NegativeMass { cell, node: 0, mass, .. }
            if cell == backwards[1] && (mass + 0.5 * MATERIAL.density).abs() < 1e-14),
        "{error}"
    );
    let error = refuse([1.0; 4], [0.5, -1.5, 1.0, 1.0]);
    assert!(
        matches!(error, Error::NegativeStiffness { cell, weight: -0.5, .. } if cell == backwards[0]),
        "{error}"
    );
    let error = refuse([1.0; 4], [1.0, 1.0, f64::NAN, 1.0]);
    assert!(
        matches!(error, Error::NegativeStiffness { cell, .. } if cell == backwards[1]),
        "{error}"
    );
}
