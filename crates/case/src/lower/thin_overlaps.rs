//! Overlaps of beams or shells and solids.

use carom_bodies::{Formulation, Kinematics, Rotations};
use carom_dynamics::ModelBody;
use carom_mesh::{ElementId, Mesh};
use carom_zones::{Error, Glued, glue_thin};

use super::context::Context;
use super::held::Held;
use super::joints::{self, BuiltOverlap, FEW_LAYERS, Joints, is_thin, weigh, weighting};
use super::problems::Problems;
use super::unfit::{self, doubt};
use crate::error::Problem;
use crate::schema::{self, Bracket, BracketName, Mediator};

/// One overlap of a beam or shell and a solid: its rows, with cells and weights of the two bodies changed.
pub(super) fn thin_overlap(
    context: &Context,
    (name, given): (&str, &schema::Arlequin),
    mesh: &Mesh,
    bodies: &mut [ModelBody],
    ([inner, outer], held): ([usize; 2], &Held),
    joints: &mut Joints,
    problems: &mut Problems,
) -> Option<carom_arlequin::Rows> {
    let path = format!("arlequin.{name}");
    let pair = [(&given.inner, inner), (&given.outer, outer)];
    let thin = usize::from(is_thin(&bodies[outer]));
    suits_a_solid(&path, given, bodies, (pair, thin), problems)?;
    let region = joints::region(mesh, &path, &given.overlap, problems)?;
    let specs = [&bodies[inner].spec, &bodies[outer].spec];
    let glued = match glue_thin(mesh, specs, &region, &weighting(given.weights)) {
        Ok(glued) => glued,
        Err(Error::Overlap(error)) => {
            let all = specs.map(|spec| spec.cells.clone()).concat();
            let problem = unfit::unfit(context, (&path, name), mesh, &error, &all);
            problems.push(problem);
            return None;
        }
        Err(error) => {
            problems.push(Problem::new(path, error.to_string()));
            return None;
        }
    };
    no_hinges(
        context,
        &path,
        (name, mesh),
        &bodies[pair[thin].1],
        &glued,
        problems,
    )?;
    let built = BuiltOverlap {
        name: name.to_string(),
        measure: glued.measure,
        layers: glued.layers,
        sizes: glued.sizes,
        removed: glued.removed.len(),
    };
    let all = [&glued.touched[..], &glued.removed].concat();
    joints::enter(context, mesh, built, all, joints, problems)?;
    for warning in &glued.weights.warnings {
        problems.warn(format!("overlap `{name}`: {}", doubt(warning)));
    }
    let solid = &bodies[pair[1 - thin].1].spec;
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
    let dropped = held.drop_rows(&mut rows);
    unfit::name_rows(
        name,
        mesh,
        &dropped,
        "removed: supports hold both bodies there",
        problems,
    );
    Some(rows)
}

/// Refuses two thin bodies, solids that they do not continue, thin bodies that cannot share a volume, and choices that they do not have.
fn suits_a_solid(
    path: &str,
    given: &schema::Arlequin,
    bodies: &[ModelBody],
    (pair, thin): ([(&String, usize); 2], usize),
    problems: &mut Problems,
) -> Option<()> {
    let (name, body) = pair[thin];
    let (other, solid) = pair[1 - thin];
    let keys = ["inner", "outer"].map(|key| format!("{path}.{key}"));
    let thin_body = Thin::of(&bodies[body])?;
    let refused = thin_body
        .refuse_other((&keys[1 - thin], other), &bodies[solid])
        .or_else(|| thin_body.refuse_own((&keys[thin], name), &bodies[body]))
        .or_else(|| refuse_turns((&keys[1 - thin], other), [&bodies[body], &bodies[solid]]))
        .or_else(|| thin_body.refuse_choice(path, given));
    match refused {
        None => Some(()),
        Some(problem) => {
            problems.push(problem);
            None
        }
    }
}

/// Refuses hinges in an overlap, whose sections move otherwise than the nodes.
fn no_hinges(
    context: &Context,
    path: &str,
    (name, mesh): (&str, &Mesh),
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
    let problem = Problem::new(
        format!("{path}.overlap"),
        "a hinge of the beam in the overlap",
    )
    .accepted(["hinges outside the overlap"]);
    let problem = unfit::shown(context, problem, (name, mesh), &inside);
    problems.push(problem);
    None
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

    /// Refuses mediators and brackets that the kinematics of the thin body exclude.
    fn refuse_choice(self, path: &str, given: &schema::Arlequin) -> Option<Problem> {
        let thin = self.name();
        if given.mediator != Mediator::Coarser {
            let message = format!(
                "between a {thin} and a solid the multiplier has the kinematics of the {thin}"
            );
            let problem = Problem::new(format!("{path}.mediator"), message);
            return Some(problem.accepted(["\"coarser\""]));
        }
        if given.bracket != Bracket::Named(BracketName::L2) {
            let message = format!(
                "between a {thin} and a solid the product with strains would hold the warping of sections"
            );
            let problem = Problem::new(format!("{path}.bracket"), message);
            return Some(problem.accepted(["\"l2\""]));
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
