//! Models of beams.

use carom_algebra::dense_eigen::eigenvalues;
use carom_bodies::{BeamSection, BeamTheory, Kinematics, MassKind, Scratch, SectionShape};
use carom_dynamics::{Model, ModelBody, Scheme, Support};
use carom_exact::beam;
use carom_materials::Elastic;
use carom_mesh::{Mesh, generate};

use crate::Error;
use crate::build::body;

/// Steel.
pub(crate) const STEEL: Elastic = Elastic {
    density: 7800.0,
    young: 2.1e11,
    poisson: 0.3,
};

/// A rectangular section, 1 high along y and 0.6 wide; times `size`, m.
pub(crate) fn section(size: f64, theory: BeamTheory) -> BeamSection {
    let shape = SectionShape::Rectangle {
        height: size,
        width: 0.6 * size,
    };
    BeamSection::new(theory, shape.properties(STEEL.poisson))
}

/// A straight beam with consistent mass.
pub(crate) fn straight(
    [from, to]: [[f64; 3]; 2],
    elements: usize,
    dim: usize,
    section: BeamSection,
) -> Result<(Mesh, ModelBody), Error> {
    let mesh = generate::line("beam", from, to, elements, dim);
    let mut made = body(&mesh, "beam", Kinematics::Beam(section), STEEL)?;
    made.mass = MassKind::Consistent;
    Ok((mesh, made))
}

/// The exact beam of a section, for deflections along y (0) or z (1).
pub(crate) fn exact(length: f64, section: &BeamSection, along: usize) -> beam::Beam {
    let properties = &section.properties;
    let second = properties.second_moments[1 - along];
    let shear = STEEL.shear_modulus() * properties.shear_areas[along];
    beam::Beam {
        length,
        bending: STEEL.young * second,
        mass: STEEL.density * properties.area,
        shear: match section.theory {
            BeamTheory::EulerBernoulli => None,
            BeamTheory::Timoshenko => Some([shear, STEEL.density * second]),
        },
    }
}

/// Holds nodes in these translations and rotations.
pub(crate) fn held(nodes: Vec<u32>, fix: [bool; 3], fix_rotations: [bool; 3]) -> Support {
    Support {
        nodes,
        fix,
        fix_rotations,
    }
}

/// All angular frequencies (rad/s) of the free unknowns of a model, ascending, from its assembled K and M.
pub(crate) fn frequencies(
    (mesh, body): (Mesh, ModelBody),
    supports: Vec<Support>,
    scheme: Scheme,
) -> Result<Vec<f64>, Error> {
    frequencies_of(Model {
        supports,
        ..Model::new(vec![body], mesh, scheme, 1e-6)
    })
}

/// The same of a model.
pub(crate) fn frequencies_of(model: Model) -> Result<Vec<f64>, Error> {
    let system = crate::witness::system(model)?;
    let free: Vec<usize> = (0..system.unknowns())
        .filter(|&i| !system.fixed[i])
        .collect();
    let n = free.len();
    let (mut k, mut m) = (vec![0.0; n * n], vec![0.0; n * n]);
    let mut unit = vec![0.0; system.unknowns()];
    let mut image = unit.clone();
    for (column, &j) in free.iter().enumerate() {
        unit[j] = 1.0;
        image.fill(0.0);
        for body in &system.bodies {
            body.internal_force(&unit, &mut Scratch::default(), &mut image);
        }
        for (row, &i) in free.iter().enumerate() {
            k[row * n + column] = image[i];
        }
        system.mass.multiply(&unit, &mut image);
        for (row, &i) in free.iter().enumerate() {
            m[row * n + column] = image[i];
        }
        unit[j] = 0.0;
    }
    let squares = eigenvalues(n, &k, &m)?;
    Ok(squares
        .into_iter()
        .map(|square| square.max(0.0).sqrt())
        .collect())
}
