//! Sections of shells: thickness, and forces and moments per length from the strains of a point.

use carom_materials::{Elastic, Law};

use crate::Rotations;

/// Layers through the thickness where nothing else is said.
pub const LAYERS: u32 = 4;

/// Stiffness against the rotation of a node about the normal, relative to that of the skew part of the gradient in the formulation of
/// Hughes and Brezzi (1989), where it is one. What it weighs against, the difference between both, vanishes as elements shrink.
const DRILLING: f64 = 1e-2;

/// Strains of a point of the middle surface in its axes: membrane ε₁₁, ε₂₂, 2ε₁₂, curvature κ₁₁, κ₂₂, 2κ₁₂, shear γ₁, γ₂, drilling.
pub(super) const STRAINS: usize = 9;

/// These numbers at a point: strains, or the forces and moments per length that do work on them.
pub(super) type AtPoint = [f64; STRAINS];

/// A plate or shell: its thickness, and how it stands to the surface of its nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShellSection {
    /// m; of one that changes from node to node the largest, of plies their sum.
    pub thickness: f64,
    /// From the nodes to the middle surface along the normal, m.
    pub offset: f64,
    /// Layers through the thickness of a metal that flows, an even number; each has two points.
    pub layers: u32,
    /// How far its nodes turn.
    pub rotations: Rotations,
}

impl ShellSection {
    /// A section in its nodes, with small rotations.
    pub fn new(thickness: f64) -> ShellSection {
        ShellSection {
            thickness,
            offset: 0.0,
            layers: LAYERS,
            rotations: Rotations::Small,
        }
    }
}

/// A layer of one material in a section of several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ply {
    /// Elastic, or a metal that flows.
    pub material: Law,
    /// m.
    pub thickness: f64,
}

/// Plies from the side against which the normal points: the undeformed material of each, and its lower and upper height above the middle, m.
pub(super) fn heights(plies: &[Ply]) -> Vec<(Elastic, [f64; 2])> {
    let whole: f64 = plies.iter().map(|ply| ply.thickness).sum();
    let mut below = -0.5 * whole;
    let of = |ply: &Ply| {
        let own = [below, below + ply.thickness];
        below = own[1];
        (ply.material.initial(), own)
    };
    plies.iter().map(of).collect()
}

/// Mass of a section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Inertia {
    /// kg/m².
    pub density: f64,
    /// Height of the centre above the middle, m.
    pub centre: f64,
    /// Square of the radius of gyration about the centre, m².
    pub gyration: f64,
}

impl Inertia {
    pub(super) fn new(plies: &[Ply]) -> Inertia {
        let mut moments = [0.0; 3];
        for (material, [from, to]) in heights(plies) {
            for (power, moment) in (1..).zip(&mut moments) {
                *moment +=
                    material.density * (to.powi(power) - from.powi(power)) / f64::from(power);
            }
        }
        let [density, first, second] = moments;
        // one ply has its centre in the middle, without rounding
        let centre = if plies.len() == 1 {
            0.0
        } else {
            first / density
        };
        Inertia {
            density,
            centre,
            gyration: second / density - centre * centre,
        }
    }
}

/// The elastic stiffness of a section per area: forces and moments per length are linear in the strains. Each list has the factors of a strain on its own
/// force, of the strain across on it, and of the shear.
#[derive(Clone, Copy, Debug)]
pub(super) struct ElasticSection {
    /// N/m.
    pub membrane: [f64; 3],
    /// Of membrane forces against curvature, and of moments against membrane strains, N.
    pub coupling: [f64; 3],
    /// N m.
    pub bending: [f64; 3],
    /// κ G h, N/m.
    pub shear: f64,
    /// N/m.
    pub drilling: f64,
}

impl ElasticSection {
    /// A = ∫ C dz, B = ∫ z C dz, D = ∫ z² C dz, with C of plane stress, and the [shear](resistance_to_shear). Of one ply E h/(1 - ν²), none, and E h³/(12 (1 - ν²)).
    pub(super) fn new(plies: &[Ply]) -> ElasticSection {
        let mut lists = [[0.0; 3]; 3];
        let mut twist = 0.0;
        for (material, [from, to]) in heights(plies) {
            let plane = material.young / (1.0 - material.poisson.powi(2));
            let factors = [1.0, material.poisson, 0.5 * (1.0 - material.poisson)];
            for (power, list) in (1..).zip(&mut lists) {
                let moment = plane * (to.powi(power) - from.powi(power)) / f64::from(power);
                for (sum, factor) in list.iter_mut().zip(factors) {
                    *sum += moment * factor;
                }
            }
            twist += material.shear_modulus() * (to - from);
        }
        if plies.len() == 1 {
            // without rounding
            lists[1] = [0.0; 3];
        }
        let [membrane, coupling, bending] = lists;
        ElasticSection {
            membrane,
            coupling,
            bending,
            shear: resistance_to_shear(plies),
            drilling: DRILLING * twist,
        }
    }

    /// The same with another resistance to shear.
    pub(super) fn with_shear(self, factor: f64) -> ElasticSection {
        ElasticSection {
            shear: self.shear * factor,
            ..self
        }
    }

    /// Stiffness without stress across, per length: E h, E h³/12 and κ G h.
    pub(super) fn uniaxial(&self) -> [f64; 3] {
        let free = |[own, across, _]: [f64; 3]| own - across * across / own;
        [free(self.membrane), free(self.bending), self.shear]
    }

    /// Forces and moments per length.
    pub(super) fn forces(&self, of: &AtPoint) -> AtPoint {
        let plane = |[own, across, shear]: [f64; 3], [x, y, xy]: [f64; 3]| {
            [own * x + across * y, own * y + across * x, shear * xy]
        };
        let (strain, curvature) = ([of[0], of[1], of[2]], [of[3], of[4], of[5]]);
        let sum = |[a, b, c]: [f64; 3], [x, y, z]: [f64; 3]| [a + x, b + y, c + z];
        let n = sum(
            plane(self.membrane, strain),
            plane(self.coupling, curvature),
        );
        let m = sum(plane(self.coupling, strain), plane(self.bending, curvature));
        let q = [self.shear * of[6], self.shear * of[7]];
        [
            n[0],
            n[1],
            n[2],
            m[0],
            m[1],
            m[2],
            q[0],
            q[1],
            self.drilling * of[8],
        ]
    }

    /// ∂(forces and moments)/∂strains, symmetric.
    pub(super) fn tangent(&self) -> [AtPoint; STRAINS] {
        std::array::from_fn(|k| {
            let mut unit = [0.0; STRAINS];
            unit[k] = 1.0;
            self.forces(&unit)
        })
    }

    /// Energy per area, J/m².
    pub(super) fn energy(&self, of: &AtPoint) -> f64 {
        let forces = self.forces(of);
        0.5 * of.iter().zip(&forces).map(|(e, s)| e * s).sum::<f64>()
    }
}

/// Stiffness against shear across, N/m, with the energy of the stresses that are in balance with those of cylindrical bending: about the neutral height z_n, with
/// g(z) = ∫ E/(1 - ν²) (z - z_n) dz from the lower face, it is (∫ E/(1 - ν²) (z - z_n)² dz)² / ∫ g²/G dz (Whitney 1973, J. Appl. Mech. 40, 302). Of one ply 5/6 G h, after Reissner.
fn resistance_to_shear(plies: &[Ply]) -> f64 {
    let plies = heights(plies);
    let plane = |material: &Elastic| material.young / (1.0 - material.poisson.powi(2));
    let moment = |power: i32, about: f64| -> f64 {
        let of = plies.iter().map(|(material, own)| {
            let [from, to] = own.map(|z| (z - about).powi(power));
            plane(material) * (to - from) / f64::from(power)
        });
        of.sum()
    };
    let neutral = moment(2, 0.0) / moment(1, 0.0);
    let bending = moment(3, neutral);
    let (mut flow, mut energy) = (0.0, 0.0);
    for (material, [from, to]) in &plies {
        let rising =
            |z: f64| 0.5 * plane(material) * ((z - neutral).powi(2) - (from - neutral).powi(2));
        // squares of parabolas: exact with three points
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let far = 0.6_f64.sqrt();
        for (place, weight) in [(-far, 5.0 / 9.0), (0.0, 8.0 / 9.0), (far, 5.0 / 9.0)] {
            let flow = flow + rising(middle + half * place);
            energy += weight * half * flow * flow / material.shear_modulus();
        }
        flow += rising(*to);
    }
    bending * bending / energy
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ply(young: f64, poisson: f64, thickness: f64) -> Ply {
        let material = Elastic {
            density: 1000.0,
            young,
            poisson,
        };
        Ply {
            material: material.into(),
            thickness,
        }
    }

    #[test]
    fn plies_of_one_material_are_one() {
        let one = ElasticSection::new(&[ply(2e11, 0.3, 0.01)]);
        let parts = [0.002, 0.005, 0.003].map(|thickness| ply(2e11, 0.3, thickness));
        let several = ElasticSection::new(&parts);
        let strain = [1e-3, 2e-3, -1e-3, 0.1, 0.3, 0.2, 1e-3, 2e-3, 1e-3];
        let (f, g) = (one.forces(&strain), several.forces(&strain));
        for (f, g) in f.iter().zip(&g) {
            // rounding of heights
            assert!((f / g - 1.0).abs() < 1e-12, "{f} {g}");
        }
        let shear = 5.0 / 6.0 * 2e11 / 2.6 * 0.01;
        assert!((one.shear / shear - 1.0).abs() < 1e-12);
        let plane = 2e11 / 0.91;
        assert!((one.bending[0] / (plane * 1e-6 / 12.0) - 1.0).abs() < 1e-12);
        let whole = Inertia::new(&parts);
        assert!(whole.centre.abs() < 1e-15);
        assert!((whole.gyration / (1e-4 / 12.0) - 1.0).abs() < 1e-12);
    }

    /// Thin faces take the moment, a soft core the shear: G d²/c, d between the middles of the faces, c of the core.
    #[test]
    fn a_sandwich_shears_in_its_core() {
        let (face, core) = (1e-4, 0.02);
        let plies = [
            ply(7e10, 0.3, face),
            ply(7e7, 0.3, core),
            ply(7e10, 0.3, face),
        ];
        let found = ElasticSection::new(&plies).shear;
        let exact = 7e7 / 2.6 * (core + face).powi(2) / core;
        // stiffness of the core against bending, E_c c³/(6 E_f t d²): 3 %, and a part of it
        assert!((found / exact - 1.0).abs() < 0.03, "{found} {exact}");
    }
}
