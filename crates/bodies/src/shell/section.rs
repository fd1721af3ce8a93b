//! Sections of shells: thickness, and forces and moments per length from the strains of a point.

use carom_materials::Elastic;

use crate::Rotations;

/// Layers through the thickness where nothing else is said.
pub const LAYERS: u32 = 4;

/// Shear correction of a homogeneous section, after Reissner.
const SHEAR: f64 = 5.0 / 6.0;

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
    /// m.
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

/// The elastic stiffness of a section per area: forces and moments per length are linear in the strains. Each list has the factors of a strain on its own
/// force, of the strain across on it, and of the shear.
#[derive(Clone, Copy, Debug)]
pub(super) struct ElasticSection {
    /// N/m.
    pub membrane: [f64; 3],
    /// N m.
    pub bending: [f64; 3],
    /// κ G h, N/m.
    pub shear: f64,
    /// N/m.
    pub drilling: f64,
}

impl ElasticSection {
    /// E h/(1 - ν²), E h³/(12 (1 - ν²)).
    pub(super) fn new(material: &Elastic, thickness: f64) -> ElasticSection {
        let plane = material.young / (1.0 - material.poisson.powi(2));
        let of = |height: f64| {
            let own = plane * height;
            [
                own,
                own * material.poisson,
                own * 0.5 * (1.0 - material.poisson),
            ]
        };
        let shear = material.shear_modulus() * thickness;
        ElasticSection {
            membrane: of(thickness),
            bending: of(thickness.powi(3) / 12.0),
            shear: SHEAR * shear,
            drilling: DRILLING * shear,
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
        let n = plane(self.membrane, [of[0], of[1], of[2]]);
        let m = plane(self.bending, [of[3], of[4], of[5]]);
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
