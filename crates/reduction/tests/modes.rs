//! Modes of solids, beams and shells.

// Helpers of tests panic as the tests themselves do.
#![allow(clippy::unwrap_used)]

use carom_bodies::{
    BeamSection, BeamTheory, BodySpec, Kinematics, MassKind, Rotations, SectionShape, ShellSection,
};
use carom_materials::Elastic;
use carom_mesh::Mesh;
use carom_mesh::generate::{box_, line};
use carom_reduction::{Keep, Modes, modes, reduce};
use carom_schemes::{Newmark, Scheme};
use carom_system::{Model, ModelBody, Support, System};

fn cube(cells: usize, mass: MassKind, count: usize) -> Result<Vec<Modes>, carom_reduction::Error> {
    let mesh = box_("cube", [0.0; 3], [1.0; 3], [cells; 3], false);
    let material = Elastic {
        density: 1000.0,
        young: 1e9,
        poisson: 0.3,
    };
    let elements = mesh.groups["cube"].elements.clone();
    let mut body = ModelBody::new(BodySpec::new("cube", elements, Kinematics::Solid, material));
    body.mass = mass;
    let scheme = Scheme::Newmark(Newmark {
        beta: 0.25,
        gamma: 0.5,
    });
    let system = System::new(Model::new(vec![body], mesh, scheme, 1e-6))?;
    modes(&system, count, &mut |_, _| {})
}

/// Six rigid motions, then modes that come in pairs and triples by the symmetry of the cube: the sparse way, which finds one
/// vector of each at a time, against the dense one.
#[test]
fn a_free_cube_has_six_rigid_motions_and_multiple_frequencies() {
    for mass in [MassKind::Lumped, MassKind::Consistent] {
        let few = &cube(5, mass, 20).unwrap()[0];
        let all = &cube(5, mass, few.existing()).unwrap()[0];
        assert_eq!((few.len(), all.len()), (20, 3 * 216));
        assert_eq!(few.count().exist, few.count().found);
        for mode in 0..20 {
            assert_eq!(few.is_rigid(mode), mode < 6, "{mode}: {}", few.square(mode));
            assert_eq!(
                all.is_rigid(mode),
                mode < 6,
                "{mode}: {:?} {:?}",
                all.square(mode),
                (6..9).map(|k| all.square(k)).collect::<Vec<_>>()
            );
            if mode >= 6 {
                let ratio = few.frequency(mode) / all.frequency(mode);
                assert!((ratio - 1.0).abs() < 1e-9, "{mode}: {ratio}");
            }
        }
        // of a free body the rigid motions have all the mass
        for axis in 0..3 {
            let effective = |modes: &Modes| -> f64 {
                let own = modes.participation.iter().take(6);
                own.map(|p| p.effective_mass()[axis]).sum()
            };
            assert!((effective(few) / 1000.0 - 1.0).abs() < 1e-9);
        }
    }
}

/// A block on a held face, retained at a corner, with all its modes: a change of unknowns. Effective masses to the digits of the frequencies.
#[test]
fn a_reduced_body_has_the_effective_masses_of_the_full_one() {
    let mesh = box_("block", [0.0; 3], [1.0, 0.7, 2.0], [2, 1, 3], false);
    let material = Elastic {
        density: 1000.0,
        young: 1e9,
        poisson: 0.3,
    };
    let elements = mesh.groups["block"].elements.clone();
    let body = ModelBody::new(BodySpec::new(
        "block",
        elements,
        Kinematics::Solid,
        material,
    ));
    let scheme = Scheme::Newmark(Newmark {
        beta: 0.25,
        gamma: 0.5,
    });
    let foot = mesh.nodes.iter().zip(0..).filter(|(x, _)| x[2] == 0.0);
    let held = Support {
        nodes: foot.map(|(_, node)| node).collect(),
        fix: [true; 3],
        fix_rotations: [false; 3],
    };
    let corner = mesh.nodes.len() as u32 - 1;
    let mut model = Model {
        supports: vec![held],
        ..Model::new(vec![body], mesh, scheme, 1e-6)
    };
    let of = |model: &Model| {
        let system = System::new(model.clone()).unwrap();
        modes(&system, 8, &mut |_, _| {}).unwrap().remove(0)
    };
    let full = of(&model);
    let keep = Keep {
        modes: 3 * 18 - 3,
        nodes: vec![corner],
        ..Keep::default()
    };
    reduce(&mut model, 0, &keep).unwrap();
    let reduced = of(&model);
    for axis in 0..3 {
        assert!((reduced.mass[axis] / full.mass[axis] - 1.0).abs() < 1e-12);
        for (one, other) in full.participation.iter().zip(&reduced.participation) {
            let [one, other] = [one, other].map(|of| of.effective_mass()[axis] / full.mass[axis]);
            assert!((one - other).abs() < 1e-8, "{axis}: {one} {other}");
        }
    }
}

/// The frequencies of a body clamped at x = 0.
fn clamped(mesh: Mesh, group: &str, kinematics: Kinematics, count: usize) -> Vec<f64> {
    let material = Elastic {
        density: 7800.0,
        young: 2e11,
        poisson: 0.3,
    };
    let elements = mesh.groups[group].elements.clone();
    let body = ModelBody::new(BodySpec::new("b", elements, kinematics, material));
    let scheme = Scheme::Newmark(Newmark {
        beta: 0.25,
        gamma: 0.5,
    });
    let foot = mesh.nodes.iter().zip(0..).filter(|(x, _)| x[0] == 0.0);
    let held = Support {
        nodes: foot.map(|(_, node)| node).collect(),
        fix: [true; 3],
        fix_rotations: [true; 3],
    };
    let model = Model {
        supports: vec![held],
        ..Model::new(vec![body], mesh, scheme, 1e-6)
    };
    let system = System::new(model).unwrap();
    let found = modes(&system, count, &mut |_, _| {}).unwrap().remove(0);
    (0..count).map(|mode| found.frequency(mode)).collect()
}

/// Beams with finite rotations have uniform strains, and masses of rotations at their nodes: they differ from the others by the second
/// order of the length of an element.
#[test]
fn beams_with_finite_rotations_have_the_modes_of_those_with_small_ones() {
    let shape = SectionShape::Tube {
        diameter: 0.1683,
        thickness: 0.00711,
    };
    let of = |rotations, elements| {
        let section = BeamSection {
            rotations,
            ..BeamSection::new(BeamTheory::Timoshenko, shape.properties(0.3))
        };
        let mesh = line("b", [0.0; 3], [3.0, 0.0, 0.0], elements, 3);
        clamped(mesh, "b", Kinematics::Beam(section), 6)
    };
    let exact = of(Rotations::Small, 80);
    let errors = [10, 20].map(|elements| {
        let found = of(Rotations::Finite, elements);
        let errors = found.iter().zip(&exact).map(|(f, e)| (f / e - 1.0).abs());
        errors.fold(0.0, f64::max)
    });
    // (L/n)²/12 of the square of the wave number of the third bending mode, 7.85/3 m, for stiffness and mass each: 10 % and a quarter
    assert!(errors[0] < 0.1 && errors[1] < 0.3 * errors[0], "{errors:?}");
}

#[test]
fn shells_with_finite_rotations_have_the_modes_of_those_with_small_ones() {
    let of = |rotations| {
        let mut mesh = Mesh::new(3);
        for i in 0..=6 {
            for j in 0..=2 {
                let (x, y) = (f64::from(i), f64::from(j));
                mesh.nodes.push([0.1 * x, 0.1 * y, 0.02 * x * y]);
            }
        }
        let cells = (0..12).map(|k| {
            let first = 3 * (k / 2) + k % 2;
            mesh.push(
                carom_elements::Kind::Quad4,
                &[first, first + 3, first + 4, first + 1],
            )
        });
        let cells: Vec<_> = cells.collect();
        let group = carom_mesh::Group {
            dim: 2,
            elements: cells,
        };
        mesh.groups.insert("s".to_owned(), group);
        let section = ShellSection {
            rotations,
            ..ShellSection::new(0.01)
        };
        clamped(mesh, "s", Kinematics::Shell(section), 8)
    };
    let (small, finite) = (of(Rotations::Small), of(Rotations::Finite));
    for (small, finite) in small.iter().zip(&finite) {
        // the strains of Green and Lagrange are the small ones at rest: rounding
        assert!((finite / small - 1.0).abs() < 1e-8, "{small} {finite}");
    }
}
