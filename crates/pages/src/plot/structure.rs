//! A structure of lines at some instants, side by side: as it was, and with its displacement magnified, with the contacts that have
//! a force.
//!
//! In space each instant is seen along two axes, with the longest direction of the structure upward. The drawing is written as
//! SVG directly: it has no axes.

use std::fmt::Write as _;

use super::scale::quantity;
use crate::Error;

/// A place and its displacement, m.
pub(crate) type Moved = ([f64; 3], [f64; 3]);

/// A structure at an instant.
#[derive(Clone, Debug)]
pub struct Lines {
    /// Line under the picture.
    pub caption: String,
    /// Ends of the lines.
    pub lines: Vec<[Moved; 2]>,
    /// Contacts with a force: place, force in N, and whether it is the one that the picture is about.
    pub marks: Vec<(Moved, f64, bool)>,
}

const WIDTH: f64 = 960.0;

/// Bound of the height of a view.
const HEIGHT: f64 = 420.0;

/// Room above the views and under each.
const HEAD: f64 = 40.0;

const CAPTION: f64 = 30.0;

const SPACE: f64 = 24.0;

/// Largest displacement drawn, as a part of the longest side of the structure.
const SHOWN: f64 = 0.06;

/// Radius of the mark of the largest force.
const MARK: f64 = 7.0;

const NAMES: [&str; 3] = ["x", "y", "z"];

/// The pictures as an SVG document.
///
/// # Errors
/// [`Error::EmptyPanel`] without a line, or with places that are not finite.
pub fn structure_figure(dim: usize, pictures: &[Lines]) -> Result<String, Error> {
    let ends = || pictures.iter().flat_map(|p| p.lines.iter().flatten());
    let [low, high] = bounds(ends().map(|(x, _)| *x));
    let sides = [0, 1, 2].map(|i| high[i] - low[i]);
    let up = (0..dim).fold(0, |best, i| if sides[i] > sides[best] { i } else { best });
    let size = sides[up];
    let most = ends()
        .flat_map(|(_, u)| u.iter())
        .fold(0.0_f64, |m, u| m.max(u.abs()));
    if !(size > 0.0 && size.is_finite() && most.is_finite()) {
        return Err(Error::EmptyPanel {
            panel: "Structure".to_owned(),
        });
    }
    let factor = if most > 0.0 { SHOWN * size / most } else { 0.0 };
    let across: Vec<usize> = (0..dim).filter(|i| *i != up).collect();
    // all views in one scale: each as wide as the structure and its magnified motion
    let room = 2.5 * SHOWN * size;
    let widths: Vec<f64> = across.iter().map(|i| sides[*i] + room).collect();
    let all: f64 = widths.iter().sum::<f64>() * pictures.len() as f64;
    let views = (across.len() * pictures.len()) as f64;
    let scale = ((WIDTH - (views + 1.0) * SPACE) / all).min(HEIGHT / (size + room));
    let height = HEAD + scale * (size + room) + 2.0 * CAPTION;
    let column = (WIDTH - SPACE) / pictures.len() as f64;
    let mut svg = String::new();
    let _ = writeln!(
        svg,
        "<text x=\"{SPACE}\" y=\"24\" font-size=\"15\">Largest forces: the structure there, displacement × {}; {} upward</text>",
        super::digits(factor, 3),
        NAMES[up]
    );
    for (k, picture) in pictures.iter().enumerate() {
        let mut left = SPACE + k as f64 * column;
        let strongest = picture.marks.iter().map(|m| m.1).fold(0.0, f64::max);
        for (&axis, width) in across.iter().zip(&widths) {
            let place = |(x, u): &Moved, factor: f64| {
                let at = |i: usize| x[i] + factor * u[i];
                [
                    left + scale * (at(axis) - low[axis] + 0.5 * room),
                    HEAD + scale * (high[up] - at(up) + 0.5 * room),
                ]
            };
            for (factor, colour, stroke) in [(0.0, "#bbbbbb", 1.0), (factor, "#2166ac", 1.8)] {
                let path: String = picture
                    .lines
                    .iter()
                    .map(|line| {
                        let [a, b] = [0, 1].map(|end| place(&line[end], factor));
                        format!("M{:.1} {:.1}L{:.1} {:.1}", a[0], a[1], b[0], b[1])
                    })
                    .collect();
                let _ = writeln!(
                    svg,
                    "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{stroke}\"/>"
                );
            }
            for (moved, force, own) in &picture.marks {
                let [x, y] = place(moved, factor);
                let radius = 1.5 + MARK * (force / strongest).sqrt();
                let fill = if *own { "#b2182b" } else { "none" };
                let _ = writeln!(
                    svg,
                    "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" fill=\"{fill}\" fill-opacity=\"0.6\" stroke=\"#b2182b\"><title>{}</title></circle>",
                    quantity(*force, "N")
                );
            }
            let bottom = height - 1.5 * CAPTION;
            let middle = left + 0.5 * scale * width;
            let _ = writeln!(
                svg,
                "<text x=\"{middle:.0}\" y=\"{bottom:.0}\" text-anchor=\"middle\" fill=\"#666666\">{} {}</text>",
                NAMES[axis], NAMES[up]
            );
            left += scale * width + SPACE;
        }
        let _ = writeln!(
            svg,
            "<text x=\"{:.0}\" y=\"{:.0}\">{}</text>",
            SPACE + k as f64 * column,
            height - 0.5 * CAPTION,
            picture.caption
        );
    }
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height:.0}\" \
         viewBox=\"0 0 {WIDTH} {height:.0}\" role=\"img\" aria-label=\"Largest forces\" font-family=\"sans-serif\" \
         font-size=\"12\" fill=\"#222222\">\n\
         <rect width=\"{WIDTH}\" height=\"{height:.0}\" fill=\"#ffffff\"/>\n{svg}</svg>\n"
    ))
}

/// The box around some places, m.
fn bounds(places: impl Iterator<Item = [f64; 3]>) -> [[f64; 3]; 2] {
    places.fold(
        [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]],
        |[low, high], x| {
            [
                [0, 1, 2].map(|i| low[i].min(x[i])),
                [0, 1, 2].map(|i| high[i].max(x[i])),
            ]
        },
    )
}
