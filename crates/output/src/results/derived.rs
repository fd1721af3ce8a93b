//! Fields that follow from the displacement and from the mean stress of the cells: strains, principal values, stresses at nodes.
//!
//! Strains are those of solids and bars, at the middle of a cell: at small strain ε = sym ∂u/∂X, at finite strain and of rigid bodies the logarithmic
//! strain ½ ln F Fᵀ, which goes with Cauchy's stress. In axisymmetry the third normal strain is that of the circumference; the strain
//! across a plate under plane stress is not known here and zero, as are all strains of beams and shells.
//!
//! Principal stresses of shells and beams are those where bending makes the stress largest. The equivalent stress at nodes is that of the stress there,
//! around which shells and beams have at least the mean of theirs.

use carom_algebra::tensor::Mat3;
use carom_bodies::Body;
use carom_dynamics::{Motion, System};
use carom_elements::{Element, MAX_NODES, map};

use crate::results::Fields;
use crate::results::cells::{Bent, Bodies, in_order, von_mises};
use crate::results::principal::principal;
use crate::vtu::{Field, Values};

/// Those that are asked for; empty otherwise.
#[derive(Default)]
pub(crate) struct Derived {
    strain: Vec<[f64; 6]>,
    principal_strain: Vec<[f64; 3]>,
    principal_stress: Vec<[f64; 3]>,
    nodal_stress: Vec<[f64; 6]>,
    nodal_von_mises: Vec<f64>,
}

impl Derived {
    pub(crate) fn new(
        (system, bodies): (&System, &Bodies),
        motion: &Motion,
        asked: &Fields,
    ) -> Derived {
        let mut derived = Derived::default();
        if asked.strain {
            let mut strains = Vec::new();
            each_deformation((system, bodies), motion, |of| strains.push(of.strain()));
            derived.principal_strain = strains.iter().map(principal).collect();
            derived.strain = strains.iter().map(in_order).collect();
        }
        if asked.principal_stress || asked.nodal_stress {
            let stresses = stresses(bodies, motion);
            let all = stresses.iter().flatten();
            let means: Vec<[f64; 6]> = all.map(|(_, stress)| in_order(stress)).collect();
            let bent = Bent::new(system, motion, &means);
            if asked.principal_stress {
                derived.principal_stress = bent.principal(&means);
            }
            if asked.nodal_stress {
                derived.nodal_stress = at_nodes((system, bodies), &stresses, &means);
                let nodes = derived.nodal_stress.iter();
                derived.nodal_von_mises = nodes.map(von_mises).collect();
                let thin = at_nodes((system, bodies), &stresses, &bent.of_thin(&means));
                for (mises, [beyond]) in derived.nodal_von_mises.iter_mut().zip(thin) {
                    *mises = mises.max(beyond);
                }
            }
        }
        derived
    }

    pub(crate) fn cell_fields(&self) -> impl Iterator<Item = Field<'_>> {
        let vectors = [
            ("principal_strain", &self.principal_strain),
            ("principal_stress", &self.principal_stress),
        ];
        let vectors = vectors.into_iter().map(|(name, values)| Field {
            name,
            values: Values::Vector(values),
        });
        let strain = (!self.strain.is_empty()).then_some(Field {
            name: "strain",
            values: Values::SymmetricTensor(&self.strain),
        });
        let given = |field: &Field| !matches!(field.values, Values::Vector([]));
        strain.into_iter().chain(vectors.filter(given))
    }

    pub(crate) fn point_fields(&self) -> impl Iterator<Item = Field<'_>> {
        let fields = [
            Field {
                name: "nodal_stress",
                values: Values::SymmetricTensor(&self.nodal_stress),
            },
            Field {
                name: "nodal_von_mises",
                values: Values::Scalar(&self.nodal_von_mises),
            },
        ];
        let count = if self.nodal_stress.is_empty() { 0 } else { 2 };
        fields.into_iter().take(count)
    }
}

/// Volume (m³) and mean stress (Pa) of the cells of each body.
fn stresses(bodies: &Bodies, motion: &Motion) -> Vec<Vec<(f64, Mat3)>> {
    let bodies = bodies.iter();
    bodies
        .map(|(body, history)| body.stresses(&motion.u, history))
        .collect()
}

/// Values at each node of the system: the mean of those of the cells that have it, weighted by their volumes; zero where there is none.
fn at_nodes<const N: usize>(
    (system, bodies): (&System, &Bodies),
    stresses: &[Vec<(f64, Mat3)>],
    values: &[[f64; N]],
) -> Vec<[f64; N]> {
    let mut sums = vec![(0.0, [0.0; N]); system.x.len()];
    let mut values = values.iter();
    for ((body, _), own) in bodies.iter().zip(stresses) {
        for ((cell, (volume, _)), stress) in body.cells().iter().zip(own).zip(&mut values) {
            if !stress.iter().all(|component| component.is_finite()) {
                continue;
            }
            for &node in system.mesh.element_nodes(*cell) {
                let (sum, of_stress) = &mut sums[system.number[node as usize] as usize];
                *sum += volume;
                for (sum, component) in of_stress.iter_mut().zip(stress) {
                    *sum += volume * component;
                }
            }
        }
    }
    let mean = |(volume, sum): (f64, [f64; N])| match volume > 0.0 {
        true => sum.map(|component| component / volume),
        false => [0.0; N],
    };
    sums.into_iter().map(mean).collect()
}

/// The largest magnitude of a principal strain at the middle of the cells of bodies that are there, and its cell; the first of equals.
pub(crate) fn largest_principal_strain(
    of: (&System, &Bodies),
    motion: &Motion,
    is_there: impl Fn(usize) -> bool,
) -> Option<(f64, u32)> {
    let mut best = (f64::NEG_INFINITY, 0);
    let mut cell = 0;
    each_deformation(of, motion, |deformation| {
        // principal values are sought where there may be a larger one, in few cells
        if deformation.bound() * (1.0 + 1e-9) > best.0 && is_there(cell) {
            let [first, _, last] = principal(&deformation.strain());
            let value = first.max(-last);
            if value.is_finite() && value > best.0 {
                best = (value, cell as u32);
            }
        }
        cell += 1;
    });
    best.0.is_finite().then_some(best)
}

/// What the strain at the middle of a cell follows from.
enum Deformation {
    /// ε itself.
    Strain(Mat3),
    /// F Fᵀ, of which it is half the logarithm.
    LeftCauchyGreen(Mat3),
}

impl Deformation {
    fn of(f: &Mat3, turns: bool) -> Deformation {
        match turns {
            true => Deformation::LeftCauchyGreen(f * f.transpose()),
            false => Deformation::Strain(0.5 * (f + f.transpose()) - Mat3::identity()),
        }
    }

    fn strain(&self) -> Mat3 {
        match self {
            Deformation::Strain(strain) => *strain,
            Deformation::LeftCauchyGreen(b) if !b.iter().all(|entry| entry.is_finite()) => {
                Mat3::from_element(f64::NAN)
            }
            Deformation::LeftCauchyGreen(b) => {
                let mut eigen = b.symmetric_eigen();
                eigen.eigenvalues = eigen.eigenvalues.map(|stretch| 0.5 * stretch.ln());
                eigen.recompose()
            }
        }
    }

    /// No principal strain is larger: eigenvalues of ε are at most |ε|, those of F Fᵀ at least 1 - |F Fᵀ - I|, below which ½ ln is larger than above.
    fn bound(&self) -> f64 {
        match self {
            Deformation::Strain(strain) => strain.norm(),
            Deformation::LeftCauchyGreen(b) => match (b - Mat3::identity()).norm() {
                apart if apart < 1.0 => -0.5 * (-apart).ln_1p(),
                _ => f64::INFINITY,
            },
        }
    }
}

/// Deformation at the middle of each cell of bodies.
fn each_deformation(
    (system, bodies): (&System, &Bodies),
    motion: &Motion,
    mut each: impl FnMut(&Deformation),
) {
    let places = system.places(0.0, &motion.u, &motion.frames);
    for (body, _) in bodies {
        let turns = body.has_finite_motion() || matches!(body, Body::Rigid(_));
        let is_solid = matches!(body, Body::Solid(_) | Body::Rigid(_) | Body::Reduced(_));
        for &cell in body.cells() {
            let element = system.mesh.kind(cell).table();
            let nodes = system.mesh.element_nodes(cell);
            let (mut x, mut y) = ([[0.0; 3]; MAX_NODES], [[0.0; 3]; MAX_NODES]);
            for (k, node) in nodes.iter().enumerate() {
                let number = system.number[*node as usize];
                (x[k], y[k]) = (system.x[number as usize], places.of(number));
            }
            let cell = (element, &x[..nodes.len()], &y[..nodes.len()]);
            each(&match is_solid {
                true if element.dim == system.dim => {
                    Deformation::of(&gradient(cell, system.axisymmetric), turns)
                }
                true if element.dim == 1 => Deformation::Strain(along(cell, turns)),
                _ => Deformation::Strain(Mat3::zeros()),
            });
        }
    }
}

/// Reference and current places of the nodes of a cell, m.
type Cell<'a> = (&'static Element, &'a [[f64; 3]], &'a [[f64; 3]]);

/// F at the middle of a cell.
fn gradient((element, x, y): Cell, axisymmetric: bool) -> Mat3 {
    let count = element.nodes as f64;
    let sum = element
        .reference
        .iter()
        .fold([0.0; 3], |sum: [f64; 3], xi| {
            [0, 1, 2].map(|i| sum[i] + xi[i] / count)
        });
    let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
    (element.shape)(&sum, &mut n[..element.nodes]);
    (element.gradient)(&sum, &mut dn[..element.nodes]);
    let (jacobian, det) = map::jacobian(x, &dn[..element.nodes], element.dim);
    let mut of_x = [[0.0; 3]; MAX_NODES];
    map::physical_gradient(
        &jacobian,
        det,
        &dn[..element.nodes],
        &mut of_x[..element.nodes],
    );
    let mut f = Mat3::identity();
    for i in 0..element.dim {
        for j in 0..element.dim {
            f[(i, j)] = y.iter().zip(&of_x).map(|(y, d)| y[i] * d[j]).sum();
        }
    }
    if axisymmetric {
        let radius = |x: &[[f64; 3]]| map::point(x, &n[..element.nodes])[0];
        f[(2, 2)] = radius(y) / radius(x);
    }
    f
}

/// Of a bar in the plane or in space.
fn along((_, x, y): Cell, turns: bool) -> Mat3 {
    let way = |x: &[[f64; 3]]| [0, 1, 2].map(|i| x[1][i] - x[0][i]);
    let dot = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (before, now) = (way(x), way(y));
    let (length, after) = (dot(&before, &before).sqrt(), dot(&now, &now).sqrt());
    let (axis, value) = match turns {
        true => (now.map(|i| i / after), (after / length).ln()),
        false => (
            before.map(|i| i / length),
            dot(&before, &now) / (length * length) - 1.0,
        ),
    };
    Mat3::from_fn(|i, j| value * axis[i] * axis[j])
}

#[cfg(test)]
mod tests {
    use carom_elements::Kind;
    use carom_testing::Random;

    use super::*;

    /// F of a cell whose nodes move by an affine map, which is that map.
    fn moved(kind: Kind, by: impl Fn(&[f64; 3]) -> [f64; 3]) -> Mat3 {
        let element = kind.table();
        // any straight cell: the reference one, sheared
        let place = |xi: &[f64; 3]| [2.0 * xi[0] + 0.3 * xi[1] + 3.0, xi[1], xi[2] + 0.1 * xi[0]];
        let flat = |x: [f64; 3]| {
            if element.dim == 2 {
                [x[0], x[1], 0.0]
            } else {
                x
            }
        };
        let x: Vec<[f64; 3]> = element.reference.iter().map(place).map(flat).collect();
        let y: Vec<[f64; 3]> = x.iter().map(by).map(flat).collect();
        gradient((element, &x, &y), false)
    }

    #[test]
    fn the_gradient_of_an_affine_motion_is_its_matrix() {
        for kind in [
            Kind::Tri3,
            Kind::Quad8,
            Kind::Tet4,
            Kind::Hex8,
            Kind::Wedge6,
        ] {
            let dim = kind.table().dim;
            let f = moved(kind, |x| {
                [1.1 * x[0] + 0.2 * x[1], x[1] - 0.1 * x[0], 0.9 * x[2]]
            });
            let mut expected = Mat3::new(1.1, 0.2, 0.0, -0.1, 1.0, 0.0, 0.0, 0.0, 0.9);
            if dim == 2 {
                expected[(2, 2)] = 1.0;
            }
            assert!((f - expected).norm() < 1e-14, "{kind:?}: {f}");
        }
    }

    #[test]
    fn a_turned_stretch_has_the_logarithms_of_its_stretches() {
        let (sine, cosine) = 0.7_f64.sin_cos();
        let turn = Mat3::new(cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0);
        let stretch = Mat3::from_diagonal(&[1.2, 0.8, 1.0].into());
        let strain = |f: &Mat3, turns: bool| Deformation::of(f, turns).strain();
        let logarithmic = strain(&(turn * stretch), true);
        let expected = [1.2_f64.ln(), 0.0, 0.8_f64.ln()];
        for (found, expected) in principal(&logarithmic).iter().zip(expected) {
            assert!((found - expected).abs() < 1e-14);
        }
        // a rotation alone has none
        assert!(strain(&turn, true).norm() < 1e-15);
        // to first order both are the same
        let small =
            Mat3::identity() + 1e-8 * Mat3::new(1.0, 2.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 3.0);
        assert!((strain(&small, true) - strain(&small, false)).norm() < 1e-15);
    }

    #[test]
    fn no_principal_strain_is_above_its_bound() {
        let mut random = Random(5);
        let mut sharp = 0;
        for _ in 0..2000 {
            let size = 2.0 * random.next();
            let f = Mat3::identity() + size * Mat3::from_fn(|_, _| random.next());
            for turns in [false, true] {
                let deformation = Deformation::of(&f, turns);
                let [first, _, last] = principal(&deformation.strain());
                let (value, bound) = (first.max(-last), deformation.bound());
                // what is pressed flat has none
                if !value.is_finite() {
                    continue;
                }
                assert!(value <= bound * (1.0 + 1e-9), "{value} {bound}");
                sharp += usize::from(bound < 1.5 * value);
            }
        }
        assert!(sharp > 500, "{sharp}");
    }

    #[test]
    fn a_bar_that_turns_by_right_angles_and_grows_has_its_strain_along_itself() {
        let element = Kind::Bar2.table();
        let (x, y) = ([[0.0; 3], [1.0, 0.0, 0.0]], [[0.0; 3], [0.0, 1.1, 0.0]]);
        let found = along((element, &x, &y), true);
        let mut expected = Mat3::zeros();
        expected[(1, 1)] = 1.1_f64.ln();
        assert!((found - expected).norm() < 1e-15);
    }
}
