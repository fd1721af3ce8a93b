//! Fields with one value per cell, over the cells of all bodies in their order.

use carom_algebra::tensor::Mat3;
use carom_bodies::{Body, Resultants, SectionStress};
use carom_dynamics::{Motion, System};

use crate::results::Fields;
use crate::results::beams::SectionStresses;
use crate::results::principal::principal;
use crate::vtu::{Field, Values};

/// Bodies of whose cells there are fields, each with the history of its materials.
pub(crate) type Bodies<'a> = [(&'a Body, &'a [f64])];

/// All bodies; `histories`: of all materials.
pub(crate) fn all_bodies<'a>(
    system: &'a System,
    histories: &'a [f64],
) -> Vec<(&'a Body, &'a [f64])> {
    let bodies = system.bodies.iter().enumerate();
    bodies
        .map(|(k, body)| (body, system.history(k, histories)))
        .collect()
}

/// Mean stress of each cell in VTK's order xx, yy, zz, xy, yz, xz, Pa: of Cauchy at finite strain.
pub(crate) fn cell_stresses(bodies: &Bodies, u: &[f64]) -> Vec<[f64; 6]> {
    let of_bodies = bodies
        .iter()
        .flat_map(|(body, history)| body.stresses(u, history));
    of_bodies.map(|(_, stress)| in_order(&stress)).collect()
}

/// A symmetric tensor in VTK's order.
pub(crate) fn in_order(s: &Mat3) -> [f64; 6] {
    [
        s[(0, 0)],
        s[(1, 1)],
        s[(2, 2)],
        s[(0, 1)],
        s[(1, 2)],
        s[(0, 2)],
    ]
}

/// A symmetric tensor of VTK's order.
fn from_order([xx, yy, zz, xy, yz, xz]: &[f64; 6]) -> Mat3 {
    Mat3::new(*xx, *xy, *xz, *xy, *yy, *yz, *xz, *yz, *zz)
}

/// Fields of shells, zero in other cells but for the stresses.
#[derive(Default)]
pub(crate) struct ShellFields {
    /// Stress at the face to which the normal points and at the other, Pa; of other cells their own.
    pub faces: [Vec<[f64; 6]>; 2],
    /// N/m.
    pub membrane: Vec<[f64; 6]>,
    /// N.
    pub bending: Vec<[f64; 6]>,
    /// N/m.
    pub shear: Vec<[f64; 3]>,
    /// Largest equivalent stress between the faces, Pa.
    pub between: Vec<f64>,
    /// Whether each cell is one of a shell.
    pub is_shell: Vec<bool>,
}

impl ShellFields {
    /// `None` without shells. `stress`: of each cell, or nothing where it is not asked for.
    pub(crate) fn new(
        system: &System,
        motion: &Motion,
        stress: &[[f64; 6]],
    ) -> Option<ShellFields> {
        let is_shell = |body: &Body| matches!(body, Body::Shell(_));
        if !system.bodies.iter().any(is_shell) {
            return None;
        }
        let mut fields = ShellFields::default();
        for (k, body) in system.bodies.iter().enumerate() {
            let history = system.history(k, &motion.history);
            let from = fields.shear.len();
            match body {
                Body::Shell(shell) => {
                    let all = shell.resultants(&motion.frames, &motion.u, history);
                    all.iter().for_each(|own| fields.push(own));
                }
                _ => {
                    let to = from + body.cells().len();
                    for face in &mut fields.faces {
                        let own = stress.get(from..to);
                        face.extend_from_slice(own.unwrap_or(&vec![[0.0; 6]; to - from]));
                    }
                    fields.membrane.resize(to, [0.0; 6]);
                    fields.bending.resize(to, [0.0; 6]);
                    fields.shear.resize(to, [0.0; 3]);
                    fields.between.resize(to, 0.0);
                }
            }
            fields.is_shell.resize(fields.shear.len(), is_shell(body));
        }
        Some(fields)
    }

    /// Those that are asked for.
    pub(crate) fn fields(&self, asked: &Fields) -> Vec<Field<'_>> {
        let tensor = |name, values| Field {
            name,
            values: Values::SymmetricTensor(values),
        };
        let mut fields = Vec::new();
        if asked.stress {
            fields.push(tensor("stress_top", &self.faces[0]));
            fields.push(tensor("stress_bottom", &self.faces[1]));
        }
        if asked.section_forces {
            fields.push(tensor("membrane_force", &self.membrane));
            fields.push(tensor("bending_moment", &self.bending));
            fields.push(Field {
                name: "shear_force",
                values: Values::Vector(&self.shear),
            });
        }
        fields
    }

    fn push(&mut self, own: &Resultants) {
        for (face, stress) in self.faces.iter_mut().zip(&own.faces) {
            face.push(in_order(stress));
        }
        self.membrane.push(in_order(&own.membrane));
        self.bending.push(in_order(&own.bending));
        self.shear.push(own.shear);
        self.between.push(own.between);
    }
}

/// Stresses that bending varies over the thickness of shells and over the sections of beams.
pub(crate) struct Bent {
    pub(crate) shells: Option<ShellFields>,
    pub(crate) beams: Option<SectionStresses>,
}

impl Bent {
    /// `stress`: of each cell, or nothing where it is not asked for.
    pub(crate) fn new(system: &System, motion: &Motion, stress: &[[f64; 6]]) -> Bent {
        Bent {
            shells: ShellFields::new(system, motion, stress),
            beams: SectionStresses::new(system, motion),
        }
    }

    /// Equivalent stress of von Mises of each cell, Pa: of a shell the largest through its thickness, of a beam the largest of its
    /// sections. `stress`: mean of each cell.
    pub(crate) fn von_mises(&self, stress: &[[f64; 6]]) -> Vec<f64> {
        let mut mises: Vec<f64> = stress.iter().map(von_mises).collect();
        for face in self.faces() {
            for (mises, stress) in mises.iter_mut().zip(face) {
                *mises = mises.max(von_mises(stress));
            }
        }
        let between = self.shells.iter().flat_map(|shells| &shells.between);
        for (mises, between) in mises.iter_mut().zip(between) {
            *mises = mises.max(*between);
        }
        for (mises, section) in mises.iter_mut().zip(self.sections()) {
            *mises = section.map_or(*mises, |section| section.von_mises);
        }
        mises
    }

    /// Principal stresses of each cell, the largest first, Pa: of a shell those of the face or the middle with the largest equivalent stress, of
    /// a beam the largest and the smallest of its sections. `stress`: mean of each cell.
    pub(crate) fn principal(&self, stress: &[[f64; 6]]) -> Vec<[f64; 3]> {
        let mut most = stress.to_vec();
        for face in self.faces() {
            for (most, stress) in most.iter_mut().zip(face) {
                if von_mises(stress) > von_mises(most) {
                    *most = *stress;
                }
            }
        }
        let mut all: Vec<[f64; 3]> = most.iter().map(|s| principal(&from_order(s))).collect();
        for (all, section) in all.iter_mut().zip(self.sections()) {
            if let Some([largest, smallest]) = section.map(|section| section.principal) {
                *all = [largest, 0.0, smallest];
            }
        }
        all
    }

    /// [`Bent::von_mises`] of the cells of shells and beams; no number in others, whose mean stress says all.
    pub(crate) fn of_thin(&self, stress: &[[f64; 6]]) -> Vec<[f64; 1]> {
        let mises = self.von_mises(stress);
        let thin = |cell: usize| {
            let shells = self.shells.as_ref();
            shells.is_some_and(|shells| shells.is_shell[cell])
                || self.sections().get(cell).is_some_and(Option::is_some)
        };
        let all = mises.into_iter().enumerate();
        all.map(|(cell, mises)| [if thin(cell) { mises } else { f64::NAN }])
            .collect()
    }

    fn faces(&self) -> impl Iterator<Item = &[[f64; 6]]> {
        let shells = self.shells.iter();
        shells.flat_map(|shells| shells.faces.iter().map(Vec::as_slice))
    }

    fn sections(&self) -> &[Option<SectionStress>] {
        self.beams.as_ref().map_or(&[], SectionStresses::of_cells)
    }
}

/// Equivalent plastic strain of each cell, zero in bodies without; `None` if no body has any.
pub(crate) fn plastic_strains(bodies: &Bodies) -> Option<Vec<f64>> {
    let strains = bodies
        .iter()
        .map(|(body, history)| body.plastic_strains(history));
    let strains: Vec<Option<Vec<f64>>> = strains.collect();
    if strains.iter().all(Option::is_none) {
        return None;
    }
    let bodies = bodies.iter().zip(strains);
    let filled = bodies.flat_map(|((body, _), own)| own.unwrap_or(vec![0.0; body.cells().len()]));
    Some(filled.collect())
}

/// Equivalent stress of von Mises, sqrt(3/2 s : s) with s the deviator, Pa.
pub(crate) fn von_mises(stress: &[f64; 6]) -> f64 {
    let [xx, yy, zz, xy, yz, xz] = *stress;
    let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    let shear = xy * xy + yz * yz + xz * xz;
    (0.5 * normal + 3.0 * shear).sqrt()
}

/// Whether each cell is deleted; `None` if no body has deletion.
pub(crate) fn deleted(system: &System, histories: &[f64]) -> Option<Vec<bool>> {
    let has_deletion = system.bodies.iter().any(|body| body.has_deletion());
    let bodies = system.bodies.iter().enumerate();
    let of_bodies = bodies.flat_map(|(k, body)| {
        let own = body.deleted(system.history(k, histories));
        own.unwrap_or(vec![false; body.cells().len()])
    });
    has_deletion.then(|| of_bodies.collect())
}

/// Where the middle of a cell is in the reference configuration, m.
pub(crate) fn middle(system: &System, cell: u32) -> Option<[f64; 3]> {
    let mut elements = system.bodies.iter().flat_map(|body| body.cells());
    let element = elements.nth(cell as usize)?;
    Some(system.mesh.middle(*element))
}
