//! The study that tells whether mesh and step of a case are fine enough.

use carom_mesh::{Mesh, is_refinable};

use crate::schema::{Case, LargestStep, MeshStep, Step, StepRule};

/// The command that runs a case with a finer mesh and with half the step; `None` where the case has neither cells that can be
/// divided nor a step. `file`: that of the case; `overrides`: those that the run had.
pub(crate) fn study(
    (file, case): (&str, &Case),
    mesh: &Mesh,
    overrides: &[String],
) -> Option<String> {
    let varied: Vec<String> = [finer(case, mesh), shorter(case)]
        .into_iter()
        .flatten()
        .collect();
    if varied.is_empty() {
        return None;
    }
    let key = |text: &str| text.split('=').next().unwrap_or_default().trim().to_owned();
    let kept = overrides.iter().filter(|own| {
        let own = key(own);
        !varied.iter().any(|vary| key(vary) == own)
    });
    let kept = kept.map(|own| format!(" --set {}", quoted(own)));
    let varied = varied
        .iter()
        .map(|vary| format!(" --vary {}", quoted(vary)));
    let options: String = varied.chain(kept).collect();
    Some(format!("carom study {}{options}", quoted(file)))
}

/// One refinement more.
fn finer(case: &Case, mesh: &Mesh) -> Option<String> {
    let has_cells = mesh.blocks.iter().any(|block| block.kind.table().dim > 0);
    let refine = case.mesh.refine;
    (has_cells && is_refinable(mesh)).then(|| format!("mesh.refine={refine},{}", refine + 1))
}

/// Half the step of the dynamics.
fn shorter(case: &Case) -> Option<String> {
    if case.time.is_static() {
        return None;
    }
    let halved = |key: &str, value: f64| format!("time.step{key}={value:?},{:?}", 0.5 * value);
    Some(match case.time.step? {
        Step::Fixed(step) => halved("", step.0),
        Step::Rule(StepRule::Courant(part)) => halved(".courant", part),
        Step::Rule(StepRule::Critical(part)) => halved(".critical", part),
        Step::Rule(StepRule::Adaptive(adaptive)) => match adaptive.largest {
            LargestStep::Fixed(step) => halved(".adaptive.largest", step.0),
            LargestStep::FromMesh(MeshStep::Courant(part)) => {
                halved(".adaptive.largest.courant", part)
            }
            LargestStep::FromMesh(MeshStep::Critical(part)) => {
                halved(".adaptive.largest.critical", part)
            }
        },
    })
}

/// A word of a shell.
fn quoted(text: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "=.,-_+/".contains(c);
    match text.chars().all(is_plain) {
        true => text.to_owned(),
        false => format!("'{}'", text.replace('\'', "'\\''")),
    }
}
