//! `carom verify`.

use std::path::Path;

use carom_dynamics::System;
use carom_pages::plot::{Axis, Curve, Figure, Panel, Role};
use carom_verification::{Compared, Shown, Size};

use crate::cases::CHECKS;
use crate::exit::{BAD, BAD_INPUT, FAILED};
use crate::terminal;
use crate::terminal::{err, line, out};

/// Runs the checks whose name contains `name`, and writes their page; returns the exit code.
pub fn verify(name: Option<&str>, quick: bool, report: Option<&Path>) -> u8 {
    let size = if quick { Size::Quick } else { Size::Full };
    let wanted = (size, report.is_some());
    let found = carom_verification::verify(CHECKS, name, wanted, &mut terminal::StandardOutput);
    let (verdict, made) = match found {
        Ok(found) => found,
        Err(error) => {
            err!("error: {error}");
            return FAILED;
        }
    };
    if verdict.checks == 0 {
        let checks = carom_verification::checks();
        let all = checks.iter().chain(CHECKS);
        let names: Vec<&str> = all.map(|check| check.name).collect();
        let asked = line(name.unwrap_or_default());
        err!("error: no check has `{asked}` in its name");
        err!("  = accepted: a part of one of {}", names.join(", "));
        return BAD_INPUT;
    }
    if let Some(path) = report {
        let page = carom_verification::page(&made, &verdict, pictures);
        if let Err(error) = carom_output::atomic::write_text(path, &page) {
            err!("error: {error}");
            return FAILED;
        }
        out!("report: {}", path.display());
    }
    if verdict.holds() { 0 } else { BAD }
}

/// The model of a check, and what it has compared, as SVG. What cannot be drawn is left out: a model that its check expects to be
/// refused, or one of points alone.
fn pictures(shown: &Shown) -> Vec<String> {
    let system = shown
        .model
        .clone()
        .and_then(|model| System::new(model).ok());
    let model = system.and_then(|system| carom_output::model_picture(&system)?.ok());
    let curves = shown.curves.iter().filter_map(compared);
    model.into_iter().chain(curves).collect()
}

fn compared(curve: &Compared) -> Option<String> {
    let axis = |[quantity, unit]: [&'static str; 2]| Axis { quantity, unit };
    let of = |name, y, role| Curve {
        name,
        x: &curve.x,
        y,
        role,
    };
    let figure = Figure {
        title: curve.title.clone(),
        abscissa: axis(curve.abscissa),
        panels: vec![Panel {
            title: String::new(),
            ordinate: axis(curve.ordinate),
            curves: vec![
                of("reference", &curve.reference, Role::Exact),
                of("computed", &curve.computed, Role::Computed),
            ],
            clip: false,
        }],
        columns: 1,
    };
    figure.svg().ok()
}
