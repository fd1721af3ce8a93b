//! Overlaps of beams or shells and solids.

use carom_arlequin::Rows;
use carom_bodies::{Formulation, Kinematics, Rotations};
use carom_dynamics::ModelBody;
use carom_mesh::ElementId;
use carom_zones::{Error, Glued, glue_thin};

use super::joints::{self, BuiltOverlap, FEW_LAYERS, Joint, Joints, is_thin, weigh, weighting};
use super::problems::{Problems, Refusal};
use super::unfit::{self, doubt};
use crate::error::Problem;
use crate::schema::{self, Bracket, BracketName, Mediator};

/// One overlap of a beam or shell and a solid: its rows, with cells and weights of the two bodies changed.
pub(super) fn thin_overlap(
    joint: &Joint,
    given: &schema::Arlequin,
    bodies: &mut [ModelBody],
    joints: &mut Joints,
    problems: &mut Problems,
) -> Option<Rows> {
    let (mesh, name, path) = (joint.mesh, joint.name, &joint.path);
    let [inner, outer] = joint.bodies;
    // which of both is thin
    let k = usize::from(is_thin(&bodies[outer]));
    let [thin, solid] = [k, 1 - k].map(|k| joint.bodies[k]);
    suits_a_solid(path, given, k, [&bodies[thin], &bodies[solid]], problems)?;
    let region = joints::region(mesh, path, &given.overlap, problems)?;
    let specs = [&bodies[inner].spec, &bodies[outer].spec];
    let glued = match glue_thin(mesh, specs, &region, &weighting(given.weights)) {
        Ok(glued) => glued,
        Err(Error::Overlap(error)) => {
            let all = specs.map(|spec| spec.cells.clone()).concat();
            return problems.refuse(unfit::problem(joint, &error, &all));
        }
        Err(error) => {
            return problems.refuse(Problem::new(path, error.to_string()));
        }
    };
    no_hinges(joint, &bodies[thin], &glued, problems)?;
    let built = BuiltOverlap {
        name: name.to_string(),
        measure: glued.measure,
        layers: glued.layers,
        sizes: glued.sizes,
        removed: glued.removed.len(),
    };
    let all = [&glued.touched[..], &glued.removed].concat();
    joints::enter(joint, built, all, joints, problems)?;
    for warning in &glued.weights.warnings {
        problems.warn(format!("overlap `{name}`: {}", doubt(warning)));
    }
    let solid = &bodies[solid].spec;
    let poisson = solid.material.initial().poisson;
    if matches!(solid.kinematics, Kinematics::PlaneStrain { .. }) && poisson != 0.0 {
        problems.warn(format!(
            "overlap `{name}`: in plane strain a body is stiffer in bending than its beam, by 1/(1 - ν²) = {:.3}",
            1.0 / (1.0 - poisson * poisson),
        ));
    }
    if glued.layers < FEW_LAYERS {
        problems.warn(format!(
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
    unfit::drop_held(joint, &mut rows, problems);
    Some(rows)
}

/// Refuses two thin bodies, solids that they do not continue, thin bodies that cannot share a volume, and choices that they do not have.
fn suits_a_solid(
    path: &str,
    given: &schema::Arlequin,
    k: usize,
    [thin, solid]: [&ModelBody; 2],
    problems: &mut Problems,
) -> Option<()> {
    let sides = [("inner", &given.inner), ("outer", &given.outer)];
    let [own, other] = [k, 1 - k].map(|k| (format!("{path}.{}", sides[k].0), sides[k].1));
    let kind = Thin::of(thin)?;
    let refused = kind
        .refuse_other((&other.0, other.1), solid)
        .or_else(|| kind.refuse_own((&own.0, own.1), thin))
        .or_else(|| refuse_turns((&other.0, other.1), [thin, solid]));
    if let Some(problem) = refused {
        return problems.refuse(problem);
    }
    let thin = kind.name();
    let table = [
        Refusal {
            is: given.mediator != Mediator::Coarser,
            key: "mediator",
            message: &format!(
                "between a {thin} and a solid the multiplier has the kinematics of the {thin}"
            ),
            accepted: &["\"coarser\""],
        },
        Refusal {
            is: given.bracket != Bracket::Named(BracketName::L2),
            key: "bracket",
            message: &format!(
                "between a {thin} and a solid the product with strains would hold the warping of sections"
            ),
            accepted: &["\"l2\""],
        },
    ];
    problems.refuse_first((path, None), &table)
}

/// Refuses hinges in an overlap, whose sections move otherwise than the nodes.
fn no_hinges(
    joint: &Joint,
    beam: &ModelBody,
    glued: &Glued,
    problems: &mut Problems,
) -> Option<()> {
    let releases = beam.spec.releases.iter().map(|release| release.cell);
    let inside: Vec<ElementId> = releases
        .filter(|cell| glued.touched.binary_search(cell).is_ok())
        .collect();
    if inside.is_empty() {
        return Some(());
    }
    let message = "a hinge of the beam in the overlap";
    let problem = Problem::new(format!("{}.overlap", joint.path), message);
    let problem = problem.accepted(["hinges outside the overlap"]);
    problems.refuse(joint.shown(problem, &inside))
}

/// Kinds of thin bodies.
#[derive(Clone, Copy)]
enum Thin {
    Beam,
    Shell,
}

impl Thin {
    fn of(body: &ModelBody) -> Option<Thin> {
        match body.spec.kinematics {
            Kinematics::Beam(_) => Some(Thin::Beam),
            Kinematics::Shell(_) => Some(Thin::Shell),
            _ => None,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Thin::Beam => "beam",
            Thin::Shell => "shell",
        }
    }

    /// Refuses another body that is no solid.
    fn refuse_other(self, (path, name): (&str, &str), other: &ModelBody) -> Option<Problem> {
        let fits = match (self, other.spec.kinematics) {
            (_, Kinematics::Solid) => true,
            (Thin::Beam, kinematics) => matches!(
                kinematics,
                Kinematics::PlaneStrain { .. } | Kinematics::PlaneStress { .. }
            ),
            (Thin::Shell, _) => false,
        };
        if fits {
            return None;
        }
        let kinematics = other.spec.kinematics.name();
        let (message, accepted) = match self {
            Thin::Beam => (
                format!(
                    "a beam is glued in volume to a solid, or in the plane to a plane body, not to one of {kinematics} elements"
                ),
                [
                    "solid, plane-stress, plane-strain",
                    "[interface.<name>] of two beams",
                ],
            ),
            Thin::Shell => (
                format!(
                    "a shell is glued in volume to a solid, not to a body of {kinematics} elements"
                ),
                ["solid", "one body of shells"],
            ),
        };
        Some(Problem::new(path, message).found(name).accepted(accepted))
    }

    /// Refuses shells with one point, and thin bodies that flow.
    fn refuse_own(self, (path, name): (&str, &str), body: &ModelBody) -> Option<Problem> {
        let thin = self.name();
        let problem = |message| Problem::new(path, message).found(name);
        if body.spec.formulation != Formulation::Full {
            let message = format!("a {thin} with one point cannot be glued in volume");
            let accepted = format!("a {thin} without `formulation`");
            return Some(problem(message).accepted([accepted]));
        }
        let material = &body.spec.material;
        if material.uniaxial().is_some() || material.plane_stress().is_some() {
            let message = format!("a {thin} of metal that flows cannot be glued in volume");
            let accepted = format!("a {thin} of an elastic material, with the metal in the solid");
            return Some(problem(message).accepted([accepted]));
        }
        None
    }
}

/// Refuses solids at small strain beside thin bodies that turn by any angle.
fn refuse_turns((path, name): (&str, &str), [thin, solid]: [&ModelBody; 2]) -> Option<Problem> {
    let turns = thin.spec.kinematics.rotations() == Some(Rotations::Finite);
    if !turns || solid.spec.material.finite().is_some() {
        return None;
    }
    let thin = Thin::of(thin)?.name();
    let message =
        format!("a solid at small strain does not turn with a {thin} of finite rotations");
    let problem = Problem::new(path, message).found(name);
    Some(problem.accepted([
        "a body of a material at finite strain, such as neo-hooke".to_owned(),
        format!("rotations = \"small\" in the section of the {thin}"),
    ]))
}
