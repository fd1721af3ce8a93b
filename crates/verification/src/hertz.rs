//! What the checks of Hertz's contact share: material, static stages, the profile of the pressure.

use std::path::Path;

use carom_contact::{Basis, Integration};
use carom_dynamics::{Amplitude, Driver, Model, Preload, Prescribed};
use carom_exact::hertz::{Pair, Solid};
use carom_materials::Elastic;
use carom_mesh::Mesh;
use carom_mesh::read::gmsh;

use crate::Error;
use crate::build::group;
use crate::check::Row;
use crate::witness::{Compared, compare};

/// Material of all bodies.
pub(crate) const MATERIAL: Elastic = Elastic {
    density: 7800.0,
    young: 2e10,
    poisson: 0.3,
};

/// Radius of all bodies, m.
pub(crate) const RADIUS: f64 = 0.05;

/// One of the bodies.
pub(crate) const BODY: Solid = Solid {
    radius: RADIUS,
    young: MATERIAL.young,
    poisson: MATERIAL.poisson,
};

/// Two of the bodies.
pub(crate) fn pair() -> Pair {
    Pair::new(BODY, BODY)
}

/// Mortar contact whose multipliers are the pressures at the nodes.
pub(crate) const DUAL: Integration = Integration::Mortar { basis: Basis::Dual };

/// Mortar contact with the linear functions of the faces.
pub(crate) const STANDARD: Integration = Integration::Mortar {
    basis: Basis::Standard,
};

/// A mesh in m from a Gmsh file in mm.
pub(crate) fn mesh(name: &str, content: &[u8]) -> Result<Mesh, Error> {
    let mut mesh = gmsh::parse(Path::new(name), content)?;
    mesh.scale(1e-3);
    Ok(mesh)
}

/// The nodes of a group come down the second axis by `way` (m) within a static stage, evenly.
pub(crate) fn lowered(mesh: &Mesh, name: &str, way: f64) -> Result<Prescribed, Error> {
    let course = Amplitude::new(vec![[0.0, 0.0], [1.0, -way]])?;
    Ok(Prescribed {
        nodes: mesh.group_nodes(group(mesh, name)?),
        displacement: [None, Some(course), None],
    })
}

/// An exact profile of the pressure.
pub(crate) struct Exact<P: Fn(f64) -> f64> {
    /// Where it ends, m.
    pub(crate) edge: f64,
    /// Pressure in Pa at a distance in m from the middle.
    pub(crate) pressure: P,
}

/// How far a profile is from the exact one.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Errors {
    /// √(Σ A (p - p_exact)² / Σ A p_exact²) over the nodes.
    pub(crate) l2: f64,
    /// Largest |p - p_exact| at nodes within 0.9 of the edge, over the exact peak.
    pub(crate) inside: f64,
}

/// A static contact, half-way and at the end of a prescribed motion, or of a load that grows, in [`Pressed::STEPS`] steps.
pub(crate) struct Pressed(Driver);

impl Pressed {
    /// Steps of the static stage.
    pub(crate) const STEPS: u64 = 10;

    /// Goes half of the way.
    pub(crate) fn half(mut model: Model) -> Result<Pressed, Error> {
        model.nonlinear.preload = Some(Preload {
            end: 1.0,
            steps: Self::STEPS,
        });
        let mut newton = Driver::new(crate::witness::system(model)?)?;
        for _ in 0..Self::STEPS / 2 {
            newton.step()?;
        }
        Ok(Pressed(newton))
    }

    /// Goes to the end, and takes the root of the mean square of the errors against the exact profile of the force of each
    /// step: with one force alone the place of the edge between two nodes decides.
    pub(crate) fn on<P: Fn(f64) -> f64>(
        &mut self,
        exact: impl Fn(f64) -> Exact<P>,
    ) -> Result<Errors, Error> {
        let mut mean = Errors::default();
        let count = Self::STEPS - Self::STEPS / 2;
        for _ in 0..count {
            self.0.step()?;
            let errors = self.errors(&exact(self.force()));
            mean.l2 += errors.l2.powi(2) / count as f64;
            mean.inside += errors.inside.powi(2) / count as f64;
        }
        self.show(&exact(self.force()));
        Ok(Errors {
            l2: mean.l2.sqrt(),
            inside: mean.inside.sqrt(),
        })
    }

    /// Goes to the end.
    pub(crate) fn finish(&mut self) -> Result<(), Error> {
        for _ in Self::STEPS / 2..Self::STEPS {
            self.0.step()?;
        }
        Ok(())
    }

    /// Force on the secondary body along the second axis, N.
    pub(crate) fn force(&self) -> f64 {
        self.0.report().contacts[0].resultant[1].abs()
    }

    /// Area of the points that carry a force, m².
    pub(crate) fn area(&self) -> f64 {
        let forces = &self.0.state().interface.force;
        let points = self.0.system().contacts[0].points.iter().zip(forces);
        let closed = points.filter(|(_, force)| **force > 0.0);
        closed.map(|(point, _)| point.area).sum()
    }

    /// Distance from the middle in m, pressure (nodal force over area) in Pa and area in m² of each secondary node.
    fn samples(&self) -> impl Iterator<Item = [f64; 3]> {
        let system = self.0.system();
        let forces = &self.0.state().motion.contact_force;
        system.contacts[0].points.iter().map(|point| {
            let node = point.node() as usize;
            let force = f64::hypot(forces[2 * node], forces[2 * node + 1]);
            [system.x[node][0].abs(), force / point.area, point.area]
        })
    }

    /// Largest pressure at a node, Pa.
    pub(crate) fn peak(&self) -> f64 {
        self.samples().fold(0.0, |m, [_, p, _]| m.max(p))
    }

    /// Errors of the present profile.
    pub(crate) fn errors<P: Fn(f64) -> f64>(&self, exact: &Exact<P>) -> Errors {
        let (mut errors, mut whole) = (Errors::default(), 0.0);
        for [distance, p, area] in self.samples() {
            let reference = (exact.pressure)(distance);
            errors.l2 += area * (p - reference).powi(2);
            whole += area * reference * reference;
            if distance <= 0.9 * exact.edge {
                let error = (p - reference).abs() / (exact.pressure)(0.0);
                errors.inside = errors.inside.max(error);
            }
        }
        errors.l2 = (errors.l2 / whole).sqrt();
        errors
    }

    /// Shows the present profile over the exact one.
    fn show<P: Fn(f64) -> f64>(&self, exact: &Exact<P>) {
        compare(|| {
            let mut samples: Vec<[f64; 3]> = self.samples().collect();
            samples.retain(|[distance, _, _]| *distance <= 1.5 * exact.edge);
            samples.sort_by(|one, other| one[0].total_cmp(&other[0]));
            let of = |value: &dyn Fn(&[f64; 3]) -> f64| samples.iter().map(value).collect();
            Compared {
                title: "Pressure over the distance from the middle".to_owned(),
                abscissa: ["distance", "m"],
                ordinate: ["pressure", "Pa"],
                x: of(&|sample| sample[0]),
                computed: of(&|sample| sample[1]),
                reference: of(&|sample| (exact.pressure)(sample[0])),
            }
        });
    }
}

/// Rows of a profile: both errors 3 % at most on the finest mesh, and twice that for each doubling of the elements, since
/// they are of order one.
pub(crate) fn profile_rows(name: &str, errors: &Errors, doublings: usize) -> [Row; 2] {
    let bound = 0.03 * (1 << doublings) as f64;
    [
        Row::at_most(format!("{name}: profile, L2 error"), errors.l2, bound),
        Row::at_most(
            format!("{name}: profile within 0.9 of the edge, error / p0"),
            errors.inside,
            bound,
        ),
    ]
}

/// What errors on meshes, each of half the size of the one before, must do: fall to 0.7 at most each time within 0.9 of the
/// edge; over all of the profile to 0.5 over three meshes, 0.8 over two. Both are of order one; the edge, where the exact
/// slope is infinite, makes the second rise and fall with its place in an element.
pub(crate) fn falling(name: &str, errors: &[Errors]) -> Vec<Row> {
    let pairs = errors.windows(2).enumerate();
    let row = |(k, pair): (usize, &[Errors])| {
        let what = format!(
            "{name}: error within 0.9 of the edge, mesh {} / mesh {}",
            k + 2,
            k + 1
        );
        Row::at_most(what, pair[1].inside / pair[0].inside, 0.7)
    };
    let mut rows: Vec<Row> = pairs.map(row).collect();
    if let [first, .., last] = errors {
        let what = format!("{name}: L2 error, mesh {} / mesh 1", errors.len());
        let bound = if errors.len() > 2 { 0.5 } else { 0.8 };
        rows.push(Row::at_most(what, last.l2 / first.l2, bound));
    }
    rows
}

/// How far the edge may be from the border of the area of the points with a force, in elements: it lies between the last of
/// them and the next one; a standard multiplier is zero in one more where its mean gap is open.
pub(crate) fn reach(integration: Integration) -> f64 {
    if integration == STANDARD { 1.0 } else { 0.5 }
}
