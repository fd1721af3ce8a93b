//! Models of a beam whose end is a solid, glued over a length.

use carom_arlequin::{Region, Weighting, mean_motion};
use carom_bodies::{
    BeamSection, BeamTheory, CellWeights, Kinematics, MassKind, Rotations, SectionShape,
};
use carom_dynamics::{ModelBody, ModelConstraint};
use carom_materials::{Elastic, Law as Material, NeoHooke};
use carom_mesh::{Mesh, generate, raise};
use carom_zones::{Glued, glue_thin};

use crate::Error;
use crate::build::{body, surface};

/// A straight bar along x in two models: a solid to the left, a beam to the right. Lengths in m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spliced {
    /// 2 or 3.
    pub(crate) dim: usize,
    /// Height (y) and width (z) of the section.
    pub(crate) section: [f64; 2],
    /// From where to where the solid is.
    pub(crate) solid: [f64; 2],
    /// From where to where the beam is.
    pub(crate) beam: [f64; 2],
    /// Cells of the solid along x, y and z.
    pub(crate) cells: [usize; 3],
    /// Elements of the beam.
    pub(crate) elements: usize,
    /// Triangles or tetrahedra.
    pub(crate) simplices: bool,
    /// Quadratic cells; with all nodes if `complete`.
    pub(crate) quadratic: bool,
    pub(crate) complete: bool,
    /// Theory of the beam.
    pub(crate) theory: BeamTheory,
    /// Material of both.
    pub(crate) material: Elastic,
    /// Weights.
    pub(crate) weighting: Weighting,
}

/// How the two models are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Joint {
    /// Where they overlap.
    Overlap,
    /// The end of the beam on the end of the solid, with the mean motion of the face.
    Distributing,
    /// The same with a rigid face.
    Rigid,
}

impl Spliced {
    /// The bodies, solid first, and the constraints between them.
    pub(crate) fn joined(
        &self,
        mesh: &Mesh,
        joint: Joint,
    ) -> Result<([ModelBody; 2], ModelConstraint), Error> {
        if joint == Joint::Overlap {
            let (bodies, glued) = self.glued(mesh)?;
            let rows = glued.rows.rows;
            return Ok((bodies, ModelConstraint::of_rows("overlap", &rows, self.dim)));
        }
        let mut bodies = self.bodies(mesh)?;
        bodies
            .iter_mut()
            .for_each(|body| body.mass = MassKind::Consistent);
        let face = surface(mesh, "solid.right", &bodies[0])?;
        // the first node of the line
        let end = (mesh.nodes.len() - self.elements - 1) as u32;
        let constraint = match joint {
            Joint::Rigid => {
                let nodes: Vec<(u32, bool)> = face.nodes.iter().map(|&n| (n, false)).collect();
                ModelConstraint::rigid_link("face", mesh, end, &nodes, true)
            }
            _ => {
                let rows = mean_motion(mesh, &face.faces, end)?;
                ModelConstraint::of_rows("face", &rows.rows, self.dim)
            }
        };
        Ok((bodies, constraint))
    }

    /// The bodies as they are without an overlap.
    fn bodies(&self, mesh: &Mesh) -> Result<[ModelBody; 2], Error> {
        let kinematics = match self.dim {
            2 => Kinematics::PlaneStress {
                thickness: self.section[1],
            },
            _ => Kinematics::Solid,
        };
        let beam = Kinematics::Beam(self.beam_section());
        Ok([
            body(mesh, "solid", kinematics, self.material)?,
            body(mesh, "beam", beam, self.material)?,
        ])
    }

    /// The section of the beam.
    pub(crate) fn beam_section(&self) -> BeamSection {
        let shape = SectionShape::Rectangle {
            height: self.section[0],
            width: self.section[1],
        };
        BeamSection {
            orientation: (self.dim == 3).then_some([0.0, 1.0, 0.0]),
            ..BeamSection::new(self.theory, shape.properties(self.material.poisson))
        }
    }

    /// Solid and beam, groups `solid` and `beam`.
    pub(crate) fn mesh(&self) -> Result<Mesh, Error> {
        let ([height, width], [from, to]) = (self.section, self.solid);
        let [nx, ny, nz] = self.cells;
        let mut mesh = match self.dim {
            2 => generate::rectangle(
                "solid",
                [from, -0.5 * height],
                [to - from, height],
                [nx, ny],
                self.simplices,
            ),
            _ => generate::box_(
                "solid",
                [from, -0.5 * height, -0.5 * width],
                [to - from, height, width],
                [nx, ny, nz],
                self.simplices,
            ),
        };
        if self.quadratic {
            mesh = raise(&mesh, self.complete)?;
        }
        let [from, to] = self.beam.map(|x| [x, 0.0, 0.0]);
        let beam = generate::line("beam", from, to, self.elements, self.dim);
        mesh.merge("beam", beam)?;
        Ok(mesh)
    }

    /// The bodies, solid first, with consistent mass (a lumped one has too much inertia in torsion where few cells are across), and the overlap.
    pub(crate) fn glued(&self, mesh: &Mesh) -> Result<([ModelBody; 2], Glued), Error> {
        self.glue(mesh, self.bodies(mesh)?)
    }

    /// The same of bodies that turn by any angle: the beam with finite rotations, the solid of neo-Hooke's material,
    /// plane ones in plane strain.
    pub(crate) fn glued_turning(&self, mesh: &Mesh) -> Result<([ModelBody; 2], Glued), Error> {
        let [mut solid, mut beam] = self.bodies(mesh)?;
        let initial = self.material;
        solid.spec.material = Material::NeoHooke(NeoHooke { initial });
        if let Kinematics::PlaneStress { thickness } = solid.spec.kinematics {
            solid.spec.kinematics = Kinematics::PlaneStrain { thickness };
        }
        beam.spec.kinematics = Kinematics::Beam(BeamSection {
            rotations: Rotations::Finite,
            ..self.beam_section()
        });
        self.glue(mesh, [solid, beam])
    }

    fn glue(
        &self,
        mesh: &Mesh,
        mut bodies: [ModelBody; 2],
    ) -> Result<([ModelBody; 2], Glued), Error> {
        let specs = [&bodies[0].spec, &bodies[1].spec];
        let glued = glue_thin(mesh, specs, &Region::Intersection, &self.weighting)?;
        let weights = [&glued.weights.inner, &glued.weights.outer];
        for ((part, cells), weights) in bodies.iter_mut().zip(&glued.cells).zip(weights) {
            part.mass = MassKind::Consistent;
            part.spec.cells = cells.clone();
            part.spec.exact_products = true;
            part.spec.weights = Some(CellWeights {
                inertia: weights.inertia.clone(),
                stiffness: weights.stiffness.clone(),
            });
        }
        Ok((bodies, glued))
    }
}
