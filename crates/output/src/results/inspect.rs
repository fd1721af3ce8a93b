//! A look at a model before it runs: its picture.

use carom_dynamics::System;

use crate::Error;
use crate::plot::{Frame, Scene, film_figure};
use crate::results::outlines::{Outlines, gap};
use crate::results::page::quality::qualities;

/// The picture of a model in two or three dimensions, with its obstacles: cells are the darker the farther their shape is from that of
/// the regular element. `None` where nothing can be drawn: in one dimension, and of points and springs alone.
///
/// # Errors
/// [`Error::Drawing`].
pub fn model_picture(system: &System) -> Option<Result<String, Error>> {
    let outlines = Outlines::new(system, |_, _| true);
    if system.dim < 2 || outlines.is_blank() {
        return None;
    }
    let (values, _) = qualities(system);
    let value = |_: &[u32], cell: usize| 1.0 - values[cell];
    let place = |node: &u32| system.x[*node as usize];
    let frame = Frame {
        caption: format!("{} cells", values.len()),
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
