//! A hairpin: a strip bent into two prongs, in the plane or in space, whole or cut at its plane of symmetry.

use std::f64::consts::{FRAC_PI_2, PI};

use carom_bodies::Kinematics;
use carom_contact::{Integration, Law};
use carom_dynamics::{Driver, Model, ModelTarget, Nonlinear, Scheme, System};
use carom_materials::Elastic;
use carom_mesh::{Group, Mesh, generate};

use crate::Error;
use crate::build::{contact, neo_hooke, plane, support, surface};

pub(crate) const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e6,
    poisson: 0.3,
};
/// Length of a prong and thickness, m.
pub(crate) const LENGTH: f64 = 1.0;
pub(crate) const THICKNESS: f64 = 0.1;
/// Half the distance of the prongs, m.
pub(crate) const HALF_GAP: f64 = 0.02;
/// Width in space, m.
const WIDTH: f64 = 0.1;

/// What there is to say about a hairpin.
#[derive(Clone, Copy)]
pub(crate) struct Hairpin {
    /// Dimension of space: prongs along x, one above the other along the last axis.
    pub(crate) dim: usize,
    /// Elements along half of it, across its width, and through its thickness.
    pub(crate) elements: [usize; 3],
    /// Half of it on the plane of symmetry, in place of the whole.
    pub(crate) half: bool,
    /// Velocities at which the ends of the upper and of the lower prong approach the plane of symmetry, m/s; along a prong the
    /// velocity grows with the square of the distance from the bend.
    pub(crate) flung: [f64; 2],
    pub(crate) scheme: Scheme,
    pub(crate) law: Law,
    pub(crate) integration: Integration,
    pub(crate) dt: f64,
}

impl Hairpin {
    /// The hairpin about to move.
    ///
    /// # Errors
    /// A system that is refused.
    pub(crate) fn newton(&self) -> Result<Driver, Error> {
        let system = crate::witness::system(self.model()?)?;
        let velocity = self.fling(&system);
        let mut newton = Driver::new(system)?;
        newton.restart(&vec![0.0; velocity.len()], &velocity)?;
        Ok(newton)
    }

    /// Velocities with which the prongs are flung, m/s.
    pub(crate) fn fling(&self, system: &System) -> Vec<f64> {
        let up = self.dim - 1;
        let mut velocity = vec![0.0; system.unknowns()];
        for (node, x) in system.x.iter().enumerate() {
            let upper = usize::from(x[up] < 0.0);
            let part = (x[0] / LENGTH).max(0.0).powi(2);
            velocity[system.unknowns.first(node as u32) + up] =
                -x[up].signum() * self.flung[upper] * part;
        }
        velocity
    }

    /// The hairpin at rest.
    ///
    /// # Errors
    /// A mesh without its surfaces.
    pub(crate) fn model(&self) -> Result<Model, Error> {
        let mesh = self.mesh();
        let kinematics = match self.dim {
            2 => Kinematics::PlaneStrain { thickness: 1.0 },
            _ => Kinematics::Solid,
        };
        let strip = neo_hooke(&mesh, "strip", kinematics, RUBBER)?;
        let skin = surface(&mesh, "skin", &strip)?;
        let (up, mut supports) = (self.dim - 1, Vec::new());
        let target = match self.half {
            true => {
                let mut fix = [false; 3];
                fix[up] = true;
                supports.push(support(&mesh, "strip.right", fix)?);
                plane(up, 1.0)
            }
            false => ModelTarget::Surface(skin.clone()),
        };
        let mut touch = contact(skin, target, self.law);
        touch.integration = self.integration;
        let mut nonlinear = Nonlinear::default();
        nonlinear.iteration.tolerance = 1e-12;
        Ok(Model {
            bodies: vec![strip],
            discrete: Vec::new(),
            supports,
            named_supports: Vec::new(),
            gravity: [0.0; 3],
            contacts: vec![touch],
            scheme: self.scheme,
            dt: self.dt,
            zones: Vec::new(),
            links: Vec::new(),
            constraints: Vec::new(),
            adaptive: None,
            critical_fraction: None,
            nonlinear,
            mesh,
        })
    }

    /// The strip, with a group `skin` of its upper and lower sides, bent.
    fn mesh(&self) -> Mesh {
        let [along, width, thickness] = self.elements;
        let middle = HALF_GAP + 0.5 * THICKNESS;
        let whole = 2.0 * LENGTH + PI * middle;
        let (size, along) = match self.half {
            true => (0.5 * whole, along),
            false => (whole, 2 * along),
        };
        let mut mesh = match self.dim {
            2 => generate::rectangle(
                "strip",
                [0.0; 2],
                [size, THICKNESS],
                [along, thickness],
                false,
            ),
            _ => {
                let sides = [size, WIDTH, THICKNESS];
                generate::box_("strip", [0.0; 3], sides, [along, width, thickness], false)
            }
        };
        let up = self.dim - 1;
        for x in &mut mesh.nodes {
            let [s, radius] = [x[0], HALF_GAP + THICKNESS - x[up]];
            let turned = FRAC_PI_2 + ((s - LENGTH) / middle).clamp(0.0, PI);
            let before = (LENGTH - s).max(0.0);
            let after = (s - LENGTH - PI * middle).max(0.0);
            x[0] = before + after + radius * turned.cos();
            x[up] = radius * turned.sin();
        }
        let sides = ["strip.top", "strip.bottom"];
        let faces = sides.map(|name| mesh.groups[name].elements.clone());
        mesh.groups
            .insert("skin".to_string(), Group::new(up, faces.concat()));
        mesh
    }
}
