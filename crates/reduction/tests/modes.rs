//! Modes of solids in space.

use carom_bodies::{BodySpec, Kinematics, MassKind};
use carom_materials::Elastic;
use carom_mesh::generate::box_;
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
