//! Modes of solids in space.

use carom_bodies::{BodySpec, Kinematics, MassKind};
use carom_materials::Elastic;
use carom_mesh::generate::box_;
use carom_reduction::{Modes, modes};
use carom_schemes::{Newmark, Scheme};
use carom_system::{Model, ModelBody, System};

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
