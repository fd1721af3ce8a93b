//! Figures as SVG: curves over time in one or more panels.
//!
//! A figure is plain data ([`Figure`]); [`Figure::svg`] checks it and draws it. Nothing in a curve is lost to its
//! length (samples are thinned to the extremes of each column of pixels) and nothing is hidden by a spike
//! (a panel may clip to percentiles, and then says so). Text is drawn by the viewer: no font is needed here.

mod draw;
mod figure;
mod figures;
mod film;
mod logarithmic;
mod model;
mod scale;
mod structure;
mod thin;

use crate::Error;
pub use figure::{Axis, Curve, Figure, Panel, Role};
pub use figures::{ContactCurves, EnergyCurves, PSEUDO_TIME, contact_figure, energy_figure};
pub use film::{Frame, Patch, Scene, Sign, What, film_figure};
pub use logarithmic::{Logarithmic, Series};
pub use model::{Shape, model_figure};
pub use scale::{digits, quantity, rounded, scientific};
pub use structure::{Lines, structure_figure};
pub use thin::thin;

/// A figure that was drawn; none without anything to draw, which is left out and ends no run.
///
/// # Errors
/// Another one of the figure.
pub fn unless_empty(figure: Result<String, Error>) -> Result<Option<String>, Error> {
    match figure {
        Err(Error::EmptyPanel { .. }) => Ok(None),
        other => other.map(Some),
    }
}
