//! Plots before their curves are thinned and stand in the block.

use crate::page::block::Block;
use crate::page::schema::{Curve, Plot};
use crate::plot::thin;

/// Samples of all curves together: single precision, twice, makes some 4 bytes each in the page.
const SAMPLES: usize = 160_000;

/// Fewest and most samples of one curve.
const OF_CURVE: [usize; 2] = [256, 6000];

/// A curve before it is thinned.
pub struct Line {
    /// Its name.
    pub name: String,
    /// As of [`Curve`].
    pub role: &'static str,
    /// Abscissa and ordinate of each sample.
    pub points: Vec<(f64, f64)>,
    /// As of [`Curve`].
    pub hidden: bool,
}

/// A plot with curves before they are thinned.
pub struct Draft {
    /// The plot.
    pub plot: Plot,
    /// Its lines.
    pub lines: Vec<Line>,
}

/// A linear plot over time in a section of the page.
pub fn draft(
    id: &'static str,
    title: impl Into<String>,
    (quantity, unit): (&'static str, &'static str),
    lines: Vec<Line>,
) -> Draft {
    Draft {
        plot: Plot {
            id,
            title: title.into(),
            abscissa: "time",
            quantity,
            unit,
            scale: "linear",
            rounding: None,
            folded: false,
            curves: Vec::new(),
            note: None,
        },
        lines,
    }
}

/// A curve.
pub fn line(name: impl Into<String>, role: &'static str, points: Vec<(f64, f64)>) -> Line {
    Line {
        name: name.into(),
        role,
        points,
        hidden: false,
    }
}

/// Curves of runs, each with whether its run is graded bad: those hide the others, and are drawn only on demand unless there are no others.
pub fn of_runs(lines: Vec<(Line, bool)>) -> impl Iterator<Item = Line> {
    let has_others = lines.iter().any(|(_, is_bad)| !is_bad);
    let one = move |(line, is_bad)| Line {
        hidden: is_bad && has_others,
        ..line
    };
    lines.into_iter().map(one)
}

/// Points from abscissae and ordinates.
pub fn zipped((x, y): &(Vec<f64>, Vec<f64>)) -> Vec<(f64, f64)> {
    x.iter().copied().zip(y.iter().copied()).collect()
}

/// The plots with their curves in the block, thinned so that no extreme is lost; those without a curve are left out.
pub fn plots(mut drafts: Vec<Draft>, block: &mut Block) -> Vec<Plot> {
    for draft in &mut drafts {
        draft.lines.retain(|line| !line.points.is_empty());
    }
    drafts.retain(|draft| !draft.lines.is_empty());
    let count: usize = drafts.iter().map(|draft| draft.lines.len()).sum();
    let most = (SAMPLES / count.max(1)).clamp(OF_CURVE[0], OF_CURVE[1]);
    let finished = |draft: Draft| {
        let curves = draft.lines.iter().map(|line| {
            let points = thin(&line.points, most / 4);
            Curve {
                name: line.name.clone(),
                role: line.role,
                hidden: line.hidden,
                x: block.reals(points.iter().map(|p| p.0)),
                y: block.reals(points.iter().map(|p| p.1)),
            }
        });
        Plot {
            curves: curves.collect(),
            ..draft.plot
        }
    };
    drafts.into_iter().map(finished).collect()
}
