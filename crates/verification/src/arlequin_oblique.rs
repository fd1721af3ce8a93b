//! A plane pulse across an overlap at an angle.
//!
//! Problem: a strip in the plane with ν = 0, E = ρ = 1 and motion along x alone, so that plane waves run along x at c = 1;
//! quadrilaterals of h_s / 4 up to the overlap and of h_s beyond, theta ½ inside, central differences outside, one step of
//! 0.4 h_s / c, gc, linear weights, coarse L2 mediator. Both meshes are sheared by 30 degrees, and with them the borders of
//! the overlap. A pulse v = exp(-((x - x0)/w)²) starts 3 w before the overlap and is looked at when it has come back as
//! far. The amplitude is the root of the energy of (v + c u')/2 in the fine mesh outside the overlap over that of the pulse.
//!
//! Closed solution: nothing comes back. (1) Without the shear all is as in one dimension, number by number: the tolerance is
//! the rounding of 10² steps against amplitudes of 10⁻³. (2) What comes back vanishes as the pulse and the overlap get wider, since
//! both models are the same continuum: each doubling must make it less. (3) Free in both directions, the strip flies and
//! turns, in small rotations, without forces: rounding of displacements of 10² h in the fine elements.
//!
//! No published numbers are known for this problem, and no order in the width: the amplitudes, and what the angle adds to
//! them, are regressions, to 1 % of the figure.

use carom_bodies::Kinematics;
use carom_dynamics::{Driver, Model, ModelLink, Support};
use carom_materials::Elastic;
use carom_mesh::{Mesh, generate};
use carom_zones::{LinkKind, ModelZone, Zoned, Zones};

use crate::Error;
use crate::build::{CENTRAL, glued, plane_motion, theta};
use crate::check::{Check, Row};
use crate::glued_bar::{GluedBar, characteristics, motion, pulse};

/// Coarse elements across the strip.
const HEIGHT: usize = 3;
const RATIO: usize = 4;
const COURANT: f64 = 0.4;
/// tan 30°.
const SHEAR: f64 = 0.577_350_269_189_625_8;

pub(crate) const CHECK: Check = Check {
    name: "arlequin-oblique",
    fact: "an oblique overlap lets long plane waves through and rigid motions free",
    run: |_| {
        let mut rows = Vec::new();
        let mut before = None;
        for (width, own) in [(2.0, 1.13033), (4.0, 1.25777), (8.0, 1.31814)] {
            let straight = Strip::new(width, 4, 0.0);
            let bar = straight.in_one_dimension(width)?;
            let straight = straight.reflected(width)?;
            let oblique = Strip::new(width, 4, SHEAR).reflected(width)?;
            let name = format!("w = {width} h, overlap 4 h");
            let [one, other] = [straight, oblique].map(|amplitude| amplitude / bar);
            rows.extend([
                Row::near(format!("{name}: straight / bar"), one, 1.0, 1e-9).second_formulation(),
                Row::relative(format!("{name}: oblique / bar"), other, own, 0.01).regression(),
            ]);
            rows.extend(before.map(|before| {
                let what = format!("{name}: oblique / that of half the width");
                Row::at_most(what, oblique / before, 1.0)
            }));
            before = Some(oblique);
        }
        for (width, found) in [
            (2.0, [0.0109339, 0.00447300, 0.00208339]),
            (4.0, [0.00510890, 0.00320114, 0.00123743]),
        ] {
            let mut before = None;
            for (overlap, own) in [2, 4, 8].into_iter().zip(found) {
                let oblique = Strip::new(width, overlap, SHEAR).reflected(width)?;
                let name = format!("w = {width} h, overlap {overlap} h: oblique");
                rows.push(Row::relative(&name, oblique, own, 0.01).regression());
                rows.extend(before.map(|before| {
                    let what = format!("{name} / that of half the overlap");
                    Row::at_most(what, oblique / before, 1.0)
                }));
                before = Some(oblique);
            }
        }
        let [multiplier, force] = flight()?;
        rows.push(Row::at_most("flight: L h / (Z v)", multiplier, 1e-11));
        rows.push(Row::at_most("flight: f / (Z v)", force, 1e-11));
        Ok(rows)
    },
};

/// A strip from 0 on, sheared; lengths in h_s.
struct Strip {
    zone: usize,
    overlap: usize,
    shear: f64,
    /// Whether motion across is held.
    plane: bool,
}

impl Strip {
    /// For a pulse of this width.
    fn new(width: f64, overlap: usize, shear: f64) -> Strip {
        Strip {
            zone: (6.0 * width) as usize + 4 + overlap,
            overlap,
            shear,
            plane: true,
        }
    }

    fn border(&self) -> f64 {
        (self.zone - self.overlap) as f64
    }

    fn length(&self) -> usize {
        2 * self.zone
    }

    fn mesh(&self) -> Result<Mesh, Error> {
        let part = |name: &str, from: usize, to: usize, ratio: usize| {
            let n = [ratio * (to - from), ratio * HEIGHT];
            let size = [(to - from) as f64, HEIGHT as f64];
            generate::rectangle(name, [from as f64, 0.0], size, n, false)
        };
        let mut mesh = part("fine", 0, self.zone, RATIO);
        let rest = part("coarse", self.zone - self.overlap, self.length(), 1);
        mesh.merge("strip", rest)?;
        mesh.nodes
            .iter_mut()
            .for_each(|x| x[0] += self.shear * x[1]);
        Ok(mesh)
    }

    fn zones(&self) -> Result<Zones, Error> {
        let mesh = self.mesh()?;
        let material = Elastic {
            density: 1.0,
            young: 1.0,
            poisson: 0.0,
        };
        let kinematics = Kinematics::PlaneStrain { thickness: 1.0 };
        let (bodies, mut rows) = glued(&mesh, ["fine", "coarse"], kinematics, material)?;
        let mut supports = Vec::new();
        if self.plane {
            rows.drop(|_, component| component == 1);
            supports.push(Support {
                nodes: (0..mesh.nodes.len() as u32).collect(),
                fix: [false, true, false],
                fix_rotations: [false; 3],
            });
        }
        let zone = |name: &str, body, scheme| ModelZone::new(name, vec![body], (scheme, 1));
        Ok(crate::witness::zones(&Zoned {
            zones: vec![zone("fine", 0, theta(0.5)), zone("coarse", 1, CENTRAL)],
            links: vec![ModelLink {
                name: "strip".to_string(),
                zones: [0, 1],
                rows: rows.rows,
            }],
            kind: LinkKind::GravouilCombescure,
            model: Model {
                supports,
                ..Model::new(bodies.into(), mesh, theta(0.5), COURANT)
            },
        })?)
    }

    /// Time at which the pulse has come back to where it started.
    fn end(&self, width: f64) -> f64 {
        6.0 * width + self.overlap as f64
    }

    fn reflected(&self, width: f64) -> Result<f64, Error> {
        let mut zones = self.zones()?;
        let wave = pulse(self.border() - 3.0 * width, width);
        let start = plane_motion(&zones, |x| {
            let [u, v] = wave(x[0]);
            [[u, 0.0], [v, 0.0]]
        });
        zones.restart(&start)?;
        let [_, all] = self.energies(&zones.drivers()[0]);
        while zones.time() < self.end(width) - 1e-9 {
            zones.step()?;
        }
        let [back, _] = self.energies(&zones.drivers()[0]);
        Ok((back / all).sqrt())
    }

    /// The same pulse on the same elements along a bar.
    fn in_one_dimension(&self, width: f64) -> Result<f64, Error> {
        let bar = GluedBar {
            zone: self.zone,
            overlap: self.overlap,
            courant: COURANT,
            ratio: RATIO,
            ..GluedBar::usual(self.length())
        };
        let mut zones = crate::witness::zones(&bar.zoned()?)?;
        let start = motion(&zones, pulse(self.border() - 3.0 * width, width));
        zones.restart(&start)?;
        let [_, all] = characteristics(&zones.drivers()[0], 0.0, self.border());
        while zones.time() < self.end(width) - 1e-9 {
            zones.step()?;
        }
        let [back, _] = characteristics(&zones.drivers()[0], 0.0, self.border());
        Ok((back / all).sqrt())
    }

    /// ∫ ((v ± u')/2)² over the fine elements outside the overlap, from the values in their middles. Their first sides lie
    /// along x.
    fn energies(&self, driver: &Driver) -> [f64; 2] {
        let (x, motion) = (&driver.system().x, &driver.state().motion);
        let mut energies = [0.0; 2];
        driver.system().bodies[0].each_element(&mut |nodes| {
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| nodes[k] as usize);
            let middle = 0.25
                * [a, b, c, d]
                    .map(|k| x[k][0] - self.shear * x[k][1])
                    .iter()
                    .sum::<f64>();
            if middle < self.border() {
                let u = |k: usize| motion.u[2 * k];
                let size = x[b][0] - x[a][0];
                let strain = (u(b) - u(a) + u(c) - u(d)) / (2.0 * size);
                let v = 0.25 * [a, b, c, d].map(|k| motion.v[2 * k]).iter().sum::<f64>();
                for (energy, sign) in energies.iter_mut().zip([1.0, -1.0]) {
                    *energy += size * size * (0.5 * (v + sign * strain)).powi(2);
                }
            }
        });
        energies
    }
}

/// Largest multiplier and internal force of a strip that flies and turns over 200 steps, over those of a blow: h Z v.
fn flight() -> Result<[f64; 2], Error> {
    let strip = Strip {
        plane: false,
        ..Strip::new(2.0, 4, SHEAR)
    };
    let mut zones = strip.zones()?;
    let start = plane_motion(&zones, |x| {
        [[0.0; 2], [1.0 - 0.1 * x[1], -0.5 + 0.1 * x[0]]]
    });
    zones.restart(&start)?;
    let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let (mut multiplier, mut force) = (0.0_f64, 0.0_f64);
    for _ in 0..200 {
        zones.step()?;
        multiplier = multiplier.max(largest(zones.multipliers()));
        for driver in zones.drivers() {
            force = force.max(largest(&driver.state().motion.internal_force));
        }
    }
    Ok([multiplier, force])
}
