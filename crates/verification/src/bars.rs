//! Bars in impact, made of elements of one, two or three dimensions. The numbers are in [`crate::figures`].

use carom_bodies::{Kinematics, MassKind};
use carom_contact::{Initial, Law};
use carom_dynamics::{Model, ModelBody, ModelContact, ModelTarget, Scheme};
use carom_exact::{Bar, Impact, Solution};
use carom_materials::Elastic;
use carom_mesh::{Mesh, generate};

use crate::Error;
use crate::build::{HALF, body, contact, plane, surface, theta};

/// A bar, or two equal ones.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Set {
    /// Length of each bar, m.
    pub(crate) length: f64,
    /// Section, m².
    pub(crate) area: f64,
    /// Young's modulus, Pa.
    pub(crate) young: f64,
    /// Density, kg/m³.
    pub(crate) density: f64,
    /// Speed of the striker, m/s.
    pub(crate) speed: f64,
}

/// The set "slow": the paper's dt = 1e-5 s is meaningful here.
pub(crate) const SLOW: Set = Set {
    length: 10.0,
    area: 6.45e-4,
    young: 2.1e11,
    density: 7800.0,
    speed: 10.0,
};

/// The set "classic": the family of Hughes et al. (1976).
pub(crate) const CLASSIC: Set = Set {
    length: 0.254,
    area: 6.45e-4,
    young: 2.07e11,
    density: 7844.0,
    speed: 5.1359,
};

impl Set {
    /// The material, with Poisson's ratio zero.
    pub(crate) fn material(&self) -> Elastic {
        Elastic {
            density: self.density,
            young: self.young,
            poisson: 0.0,
        }
    }

    /// Wave speed in m/s.
    pub(crate) fn wave_speed(&self) -> f64 {
        (self.young / self.density).sqrt()
    }

    /// Impedance Z in N s/m.
    pub(crate) fn impedance(&self) -> f64 {
        self.density * self.wave_speed() * self.area
    }

    /// Duration of the contact 2 L / c in s, of two equal free bars or one on a wall.
    pub(crate) fn duration(&self) -> f64 {
        2.0 * self.length / self.wave_speed()
    }
}

/// What the bars are made of; Poisson's ratio is zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Elements {
    /// One-dimensional bars.
    Bar2,
    /// Plane strain, one quadrilateral high.
    Quad4,
    /// Plane stress, two triangles high.
    Tri3,
    /// Solids, one hexahedron in the section.
    Hex8,
    /// Solids, six tetrahedra in the section.
    Tet4,
    /// An axisymmetric cylinder, two quadrilaterals along the radius.
    Cylinder,
}

/// What the striker meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Against {
    /// An equal bar at rest.
    Bar,
    /// A rigid plane.
    Wall,
}

/// A run of one or two bars, all ends free.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    /// The bars.
    pub(crate) set: Set,
    /// Elements along each bar.
    pub(crate) elements: usize,
    /// Their kind.
    pub(crate) kind: Elements,
    /// What the striker meets.
    pub(crate) against: Against,
    /// Gap at the start, m.
    pub(crate) gap: f64,
    /// Mass.
    pub(crate) mass: MassKind,
    /// Whether the nodes in contact have no mass.
    pub(crate) massless: bool,
    /// Time scheme.
    pub(crate) scheme: Scheme,
    /// Contact law.
    pub(crate) law: Law,
    /// Courant number c dt / h.
    pub(crate) courant: f64,
    /// End time as a multiple of the exact duration of the contact.
    pub(crate) end: f64,
}

impl Run {
    /// Two bars of the set "slow" in touch, lumped mass, theta ½, velocity law, CFL 0.5, to 1.5 durations of the contact.
    pub(crate) fn slow(elements: usize) -> Run {
        Run {
            set: SLOW,
            elements,
            kind: Elements::Bar2,
            against: Against::Bar,
            gap: 0.0,
            mass: MassKind::Lumped,
            massless: false,
            scheme: theta(0.5),
            law: HALF,
            courant: 0.5,
            end: 1.5,
        }
    }

    /// What it is against, its mass and its Courant number.
    pub(crate) fn name(&self) -> String {
        let Run {
            against,
            mass,
            courant,
            ..
        } = self;
        format!("{against:?}, {mass:?}, CFL {courant}")
    }

    /// Step in s.
    pub(crate) fn dt(&self) -> f64 {
        self.courant * self.set.length / self.elements as f64 / self.set.wave_speed()
    }

    /// Exact contact force in N: Z v0 / 2 between bars, Z v0 on a wall.
    pub(crate) fn force(&self) -> f64 {
        let full = self.set.impedance() * self.set.speed;
        match self.against {
            Against::Bar => 0.5 * full,
            Against::Wall => full,
        }
    }

    /// The exact solution up to a time in s.
    pub(crate) fn exact(&self, end: f64) -> Result<Solution, Error> {
        let set = &self.set;
        let bar = Bar::new(set.length, set.area, set.young, set.density);
        let striker = bar.with_velocity(-set.speed);
        let impact = match self.against {
            Against::Bar => Impact::TwoBars {
                secondary: striker,
                primary: bar,
                gap: self.gap,
            },
            Against::Wall => Impact::Wall {
                bar: striker,
                gap: self.gap,
            },
        };
        Ok(carom_exact::solve(&impact, end)?)
    }

    /// The axis along which the bars lie.
    pub(crate) fn axis(&self) -> usize {
        match self.kind {
            Elements::Cylinder => 1,
            _ => 0,
        }
    }

    fn kinematics(&self) -> Kinematics {
        let (area, thickness) = (self.set.area, self.set.area.sqrt());
        match self.kind {
            Elements::Bar2 => Kinematics::Bar { area },
            Elements::Quad4 => Kinematics::PlaneStrain { thickness },
            Elements::Tri3 => Kinematics::PlaneStress { thickness },
            Elements::Hex8 | Elements::Tet4 => Kinematics::Solid,
            Elements::Cylinder => Kinematics::Axisymmetric,
        }
    }

    /// One bar from the given place along its axis on.
    fn part(&self, name: &str, from: f64) -> Mesh {
        let (n, length, side) = (self.elements, self.set.length, self.set.area.sqrt());
        match self.kind {
            Elements::Bar2 => {
                generate::line(name, [from, 0.0, 0.0], [from + length, 0.0, 0.0], n, 1)
            }
            Elements::Quad4 | Elements::Tri3 => {
                let triangles = self.kind == Elements::Tri3;
                generate::rectangle(name, [from, 0.0], [length, side], [n, 1], triangles)
            }
            Elements::Hex8 | Elements::Tet4 => {
                let (origin, size) = ([from, 0.0, 0.0], [length, side, side]);
                generate::box_(name, origin, size, [n, 1, 1], self.kind == Elements::Tet4)
            }
            Elements::Cylinder => {
                let radius = (self.set.area / std::f64::consts::PI).sqrt();
                generate::rectangle(name, [0.0, from], [radius, length], [2, n], false)
            }
        }
    }

    /// The model of the run.
    pub(crate) fn model(&self) -> Result<Model, Error> {
        let [first, last] = match self.axis() {
            0 => ["left", "right"],
            _ => ["bottom", "top"],
        };
        let mut mesh = self.part("striker", -self.set.length - self.gap);
        if self.against == Against::Bar {
            mesh.merge("target", self.part("target", 0.0))?;
        }
        let bar = |name: &str| -> Result<ModelBody, Error> {
            Ok(ModelBody {
                mass: self.mass,
                ..body(&mesh, name, self.kinematics(), self.set.material())?
            })
        };
        let mut bodies = vec![bar("striker")?];
        bodies[0].velocity[self.axis()] = self.set.speed;
        let primary = match self.against {
            Against::Wall => plane(self.axis(), -1.0),
            Against::Bar => {
                bodies.push(bar("target")?);
                ModelTarget::Surface(surface(&mesh, &format!("target.{first}"), &bodies[1])?)
            }
        };
        let secondary = surface(&mesh, &format!("striker.{last}"), &bodies[0])?;
        Ok(Model {
            contacts: vec![ModelContact {
                massless: self.massless,
                friction: 0.0.into(),
                initial: Initial::Keep,
                depth: None,
                moment_about: None,
                near_only: false,
                both_ways: false,
                merge_within: None,
                ..contact(secondary, primary, self.law)
            }],
            ..Model::new(bodies, mesh, self.scheme, self.dt())
        })
    }
}
