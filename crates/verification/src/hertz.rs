//! What the checks of Hertz's contact share: meshes, static models, the profile of the pressure.

use std::path::Path;

use carom_bodies::Kinematics;
use carom_contact::{Basis, Integration};
use carom_dynamics::{
    Amplitude, Model, Newton, Nonlinear, Preload, Prescribed, System,
};
use carom_exact::hertz::{Pair, Solid};
use carom_materials::Elastic;
use carom_mesh::Mesh;
use carom_mesh::read::gmsh;

use crate::Error;
use crate::build::group;

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

/// Segment-to-segment contact with the linear functions as multipliers.
pub(crate) const MORTAR: Integration = Integration::Mortar {
    basis: Basis::Standard,
};

/// Segment-to-segment contact with the dual functions as multipliers.
pub(crate) const DUAL: Integration = Integration::Mortar { basis: Basis::Dual };

/// A mesh in m from a Gmsh file in mm.
pub(crate) fn mesh(name: &str, content: &[u8]) -> Result<Mesh, Error> {
    let mut mesh = gmsh::parse(Path::new(name), content)?;
    mesh.scale(1e-3);
    Ok(mesh)
}

/// The equator of a body comes down the second axis by `way` (m) within a static stage.
pub(crate) fn lowered(mesh: &Mesh, equator: &str, way: f64) -> Result<Prescribed, Error> {
    let course = Amplitude::new(vec![[0.0, 0.0], [1.0, -way]])?;
    Ok(Prescribed {
        nodes: mesh.group_nodes(group(mesh, equator)?),
        displacement: [None, Some(course), None],
    })
}

/// A static contact under a prescribed motion, as far as the way that it is given.
pub(crate) struct Pressed {
    pub(crate) newton: Newton,
    kinematics: Kinematics,
}

/// Pressure at a distance from the middle.
pub(crate) struct Sample {
    /// m.
    pub(crate) distance: f64,
    /// Pa.
    pub(crate) pressure: f64,
    /// What it stands for, m².
    area: f64,
}

/// How far a profile is from the exact one of the same force.
pub(crate) struct Profile {
    /// Square root of ∫(p - p_exact)² dΓ / ∫p_exact² dΓ, by the areas of the nodes.
    pub(crate) l2: f64,
    /// Largest |p - p_exact|/p0 at nodes within 0.9 a.
    pub(crate) inside: f64,
    /// Largest pressure at a node, Pa.
    pub(crate) peak: f64,
}

impl Pressed {
    /// Solves the static stage, whose mesh, bodies and contact are given.
    pub(crate) fn new(mut model: Model, motion: Prescribed, steps: u64) -> Result<Pressed, Error> {
        let kinematics = model.bodies[0].spec.kinematics;
        model.nonlinear = Nonlinear {
            motions: vec![motion],
            preload: Some(Preload { end: 1.0, steps }),
            ..Nonlinear::default()
        };
        let mut newton = Newton::new(System::new(model)?)?;
        for _ in 0..steps {
            newton.step()?;
        }
        Ok(Pressed { newton, kinematics })
    }

    /// Force on the secondary body along the second axis, N.
    pub(crate) fn force(&self) -> f64 {
        self.newton.report().contacts[0].resultant[1].abs()
    }

    /// Pressures at the points of the contact that carry one.
    pub(crate) fn samples(&self) -> Vec<Sample> {
        let system = self.newton.system();
        let forces = &self.newton.state().interface.force;
        let contact = &system.contacts[0];
        let sample = |(point, force): (&carom_contact::Point, &f64)| Sample {
            distance: system.x[point.node() as usize][0].abs(),
            pressure: force / point.area,
            area: point.area,
        };
        contact.points.iter().zip(forces).map(sample).collect()
    }

    /// Compares the pressures with an exact profile that is zero from `edge` (m) on.
    pub(crate) fn profile(&self, edge: f64, exact: impl Fn(f64) -> f64) -> Profile {
        let mut profile = Profile {
            l2: 0.0,
            inside: 0.0,
            peak: 0.0,
        };
        let mut whole = 0.0;
        if std::env::var("SHOW").is_ok() { let mut all = self.samples(); all.sort_by(|a,b| a.distance.total_cmp(&b.distance)); for s in all { println!("{:.4} {:.4} {:.4} {:e}", s.distance/edge, s.pressure/exact(0.0), exact(s.distance)/exact(0.0), s.area); } }
        for sample in self.samples() {
            let (p, reference) = (sample.pressure, exact(sample.distance));
            profile.l2 += sample.area * (p - reference).powi(2);
            whole += sample.area * reference * reference;
            profile.peak = profile.peak.max(p);
            if sample.distance <= 0.9 * edge {
                profile.inside = profile.inside.max((p - reference).abs() / exact(0.0));
            }
        }
        profile.l2 = (profile.l2 / whole).sqrt();
        profile
    }
}
