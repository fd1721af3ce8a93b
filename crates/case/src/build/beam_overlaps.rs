//! Overlaps of beams and solids.

use carom_bodies::{Kinematics, Rotations};
use carom_dynamics::ModelBody;
use carom_mesh::{ElementId, Mesh};
use carom_zones::{Error, GluedBeam, glue_beam};

use super::Builder;
use super::arlequin::{BuiltOverlap, FEW_LAYERS, Joints, weigh, weighting};
use super::held::Held;
use super::unfit::doubt;
use crate::error::Problem;
use crate::schema::{self, Bracket, BracketName, Mediator};

impl Builder<'_> {
    /// One overlap of a beam and a solid: its rows, with cells and weights of the two bodies changed.
    pub(super) fn beam_overlap(
        &mut self,
        (name, given): (&str, &schema::Arlequin),
        mesh: &Mesh,
        bodies: &mut [ModelBody],
        ([inner, outer], held): ([usize; 2], &Held),
        joints: &mut Joints,
    ) -> Option<carom_arlequin::Rows> {
        let path = format!("arlequin.{name}");
        let pair = [(&given.inner, inner), (&given.outer, outer)];
        let beam = usize::from(matches!(bodies[outer].spec.kinematics, Kinematics::Beam(_)));
        self.suits_a_solid(&path, given, bodies, (pair, beam))?;
        let region = self.region(mesh, &path, &given.overlap)?;
        let specs = [&bodies[inner].spec, &bodies[outer].spec];
        let glued = match glue_beam(mesh, specs, &region, &weighting(given.weights)) {
            Ok(glued) => glued,
            Err(Error::Overlap(error)) => {
                let all = specs.map(|spec| spec.cells.clone()).concat();
                let problem = self.unfit((&path, name), mesh, &error, &all);
                self.problems.push(problem);
                return None;
            }
            Err(error) => {
                self.problems.push(Problem::new(path, error.to_string()));
                return None;
            }
        };
        self.no_hinges(&path, (name, mesh), &bodies[pair[beam].1], &glued)?;
        let built = BuiltOverlap {
            name: name.to_string(),
            measure: glued.measure,
            layers: glued.layers,
            sizes: glued.sizes,
            removed: glued.removed.len(),
        };
        let all = [&glued.touched[..], &glued.removed].concat();
        self.enter(mesh, built, all, joints)?;
        for warning in &glued.weights.warnings {
            self.warnings
                .push(format!("overlap `{name}`: {}", doubt(warning)));
        }
        let solid = &bodies[pair[1 - beam].1].spec;
        let poisson = solid.material.initial().poisson;
        if matches!(solid.kinematics, Kinematics::PlaneStrain { .. }) && poisson != 0.0 {
            self.warnings.push(format!(
                "overlap `{name}`: in plane strain a body is stiffer in bending than its beam, by 1/(1 - ν²) = {:.3}",
                1.0 / (1.0 - poisson * poisson),
            ));
        }
        if glued.layers < FEW_LAYERS {
            self.warnings.push(format!(
                "overlap `{name}`: {:.2} cells of the coarser body long; two to four transmit waves better",
                glued.layers,
            ));
        }
        let weights = [&glued.weights.inner, &glued.weights.outer];
        for (k, body) in [inner, outer].into_iter().enumerate() {
            weigh(mesh, &mut bodies[body], &glued.cells[k], weights[k]);
            bodies[body].spec.exact_products = true;
        }
        let mut rows = glued.rows;
        let dropped = held.drop_rows(&mut rows);
        self.name_rows(
            name,
            mesh,
            &dropped,
            "removed: supports hold both bodies there",
        );
        Some(rows)
    }

    /// Refuses two beams, solids that no beam continues, beams that cannot share a volume, and choices that beams do not have.
    fn suits_a_solid(
        &mut self,
        path: &str,
        given: &schema::Arlequin,
        bodies: &[ModelBody],
        (pair, beam): ([(&String, usize); 2], usize),
    ) -> Option<()> {
        let keys = ["inner", "outer"];
        let (name, body) = pair[beam];
        let (other, solid) = pair[1 - beam];
        let spec = &bodies[body].spec;
        let Kinematics::Beam(section) = spec.kinematics else {
            return None;
        };
        let at = |k: usize| format!("{path}.{}", keys[k]);
        let problem = match bodies[solid].spec.kinematics {
            Kinematics::Solid | Kinematics::PlaneStrain { .. } | Kinematics::PlaneStress { .. } => {
                None
            }
            kinematics => {
                let message = format!(
                    "a beam is glued in volume to a solid, or in the plane to a plane body, not to one of {} elements",
                    kinematics.name()
                );
                let accepted = [
                    "solid, plane-stress, plane-strain",
                    "[interface.<name>] of two beams",
                ];
                Some(
                    Problem::new(at(1 - beam), message)
                        .found(other)
                        .accepted(accepted),
                )
            }
        };
        let problem = problem.or_else(|| {
            (section.rotations == Rotations::Finite).then(|| {
                let message = "beams with finite rotations cannot be glued in volume";
                Problem::new(at(beam), message)
                    .found(name)
                    .accepted(["rotations = \"small\" in the section of the beam"])
            })
        });
        let problem = problem.or_else(|| {
            spec.material.uniaxial().is_some().then(|| {
                let message = "a beam of metal that flows cannot be glued in volume";
                Problem::new(at(beam), message)
                    .found(name)
                    .accepted(["a beam of an elastic material, with the metal in the solid"])
            })
        });
        let problem = problem.or_else(|| {
            (given.mediator != Mediator::Coarser).then(|| {
                let message =
                    "between a beam and a solid the multiplier has the kinematics of the beam";
                Problem::new(format!("{path}.mediator"), message).accepted(["\"coarser\""])
            })
        });
        let problem = problem.or_else(|| {
            (given.bracket != Bracket::Named(BracketName::L2)).then(|| {
                let message = "between a beam and a solid the product with strains would hold the warping of sections";
                Problem::new(format!("{path}.bracket"), message).accepted(["\"l2\""])
            })
        });
        match problem {
            None => Some(()),
            Some(problem) => {
                self.problems.push(problem);
                None
            }
        }
    }

    /// Refuses hinges in an overlap, whose sections move otherwise than the nodes.
    fn no_hinges(
        &mut self,
        path: &str,
        (name, mesh): (&str, &Mesh),
        beam: &ModelBody,
        glued: &GluedBeam,
    ) -> Option<()> {
        let releases = beam.spec.releases.iter().map(|release| release.cell);
        let inside: Vec<ElementId> = releases
            .filter(|cell| glued.touched.binary_search(cell).is_ok())
            .collect();
        if inside.is_empty() {
            return Some(());
        }
        let problem = Problem::new(
            format!("{path}.overlap"),
            "a hinge of the beam in the overlap",
        )
        .accepted(["hinges outside the overlap"]);
        let problem = self.shown(problem, (name, mesh), &inside);
        self.problems.push(problem);
        None
    }
}
