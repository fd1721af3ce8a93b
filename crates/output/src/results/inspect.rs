//! A look at a model before it runs: its picture.

use carom_dynamics::System;
use carom_pages::plot::{Axis, Curve, Figure, Frame, Panel, Role, Scene, film_figure};

use crate::results::outlines::{Outlines, gap};
use crate::results::page::quality::qualities;
use crate::results::signs::signs;

/// Height of the tick at a node, over the distance of two bodies under each other.
const TICK: f64 = 0.4;

/// The picture of a model, with its obstacles, and with the names of its bodies, supports, loads, masses, springs and contacts: in two and three dimensions cells are the darker the farther their shape is from that of
/// the regular element, in one each body has a line of its own, with a tick at each node. `None` where nothing can be drawn: of points
/// and springs alone.
///
/// # Errors
/// [`carom_pages::Error::Drawing`].
pub fn model_picture(system: &System) -> Option<Result<String, carom_pages::Error>> {
    if system.dim < 2 {
        return lines(system);
    }
    let outlines = Outlines::new(system, |_, _| true);
    if outlines.is_blank() {
        return None;
    }
    let (values, _) = qualities(system);
    let value = |_: &[u32], cell: usize| 1.0 - values[cell];
    let place = |node: &u32| system.x[*node as usize];
    let frame = Frame {
        caption: format!("{} cells", values.len()),
        signs: signs(system),
        ..Frame::default()
    };
    let scene = Scene {
        title: "Model",
        dim: system.dim,
        field: ("1 - scaled Jacobian", ""),
        gap: &|time, place| gap(system, time, place),
    };
    let frame = outlines.frame(system, &place, &value, frame);
    Some(film_figure(&scene, &[frame]))
}

/// The bodies of a model in one dimension under each other, the first one on top.
fn lines(system: &System) -> Option<Result<String, carom_pages::Error>> {
    let bodies = system.bodies.iter().enumerate().map(|(number, body)| {
        let mut nodes = Vec::new();
        body.each_element(&mut |element| {
            nodes.extend(element.iter().map(|&node| system.x[node as usize][0]));
        });
        nodes.sort_unstable_by(f64::total_cmp);
        nodes.dedup();
        let row = -(number as f64);
        let x: Vec<f64> = nodes.iter().flat_map(|&x| [x; 3]).collect();
        let y: Vec<f64> = nodes.iter().flat_map(|_| [row, row + TICK, row]).collect();
        (body.name(), x, y)
    });
    let bodies: Vec<(&str, Vec<f64>, Vec<f64>)> =
        bodies.filter(|(_, x, _)| !x.is_empty()).collect();
    if bodies.is_empty() {
        return None;
    }
    let curves = bodies.iter().map(|(name, x, y)| Curve {
        name,
        x,
        y,
        role: Role::Computed,
    });
    let figure = Figure {
        title: "Model".to_owned(),
        abscissa: Axis {
            quantity: "position",
            unit: "m",
        },
        panels: vec![Panel {
            title: "Bodies under each other, a tick at each node".to_owned(),
            ordinate: Axis {
                quantity: "",
                unit: "",
            },
            curves: curves.collect(),
            clip: false,
        }],
        columns: 1,
    };
    Some(figure.svg())
}
