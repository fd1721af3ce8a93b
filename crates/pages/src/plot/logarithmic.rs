//! A figure with two logarithmic axes: errors over a step, a size, a number of elements.

use plotters::prelude::*;

use super::draw::{
    COMPUTED, EXACT, GRID, INK, LEGEND, NAME, Outcome, TITLE, UPRIGHT, fine, font_size, line,
    shrink, write,
};
use super::{Role, scientific};
use crate::Error;

const WIDTH: i32 = 960;

const HEIGHT: i32 = 520;

const TITLE_HEIGHT: i32 = 34;

const LEGEND_WIDTH: i32 = 330;

/// Points and straight lines over logarithmic axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Logarithmic {
    /// Title.
    pub title: String,
    /// Name of the abscissa, with its unit.
    pub abscissa: String,
    /// Name of the ordinate.
    pub ordinate: String,
    /// The series.
    pub series: Vec<Series>,
}

/// One series of points.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Points; those that are not positive cannot be shown and are left out.
    pub points: Vec<(f64, f64)>,
    /// A power law drawn pale under them: exponent and factor of y = factor x^exponent.
    pub law: Option<(f64, f64)>,
}

impl Logarithmic {
    /// The figure as an SVG document.
    ///
    /// # Errors
    /// [`Error::EmptyPanel`] if no point can be shown; [`Error::Drawing`].
    pub fn svg(&self) -> Result<String, Error> {
        let points = self.series.iter().flat_map(Series::shown);
        let bounds = points.fold(None, |bounds: Option<[f64; 4]>, (x, y)| {
            let [left, right, low, high] = bounds.unwrap_or([x, x, y, y]);
            Some([left.min(x), right.max(x), low.min(y), high.max(y)])
        });
        let Some(bounds) = bounds else {
            return Err(Error::EmptyPanel {
                panel: self.title.clone(),
            });
        };
        let mut svg = String::new();
        self.draw(bounds, &mut svg)
            .map_err(|cause| Error::Drawing {
                figure: self.title.clone(),
                cause: cause.to_string(),
            })?;
        Ok(shrink(&svg, &self.title, HEIGHT))
    }

    fn draw(&self, [left, right, low, high]: [f64; 4], svg: &mut String) -> Outcome {
        let size = (fine(WIDTH) as u32, fine(HEIGHT) as u32);
        let root = SVGBackend::with_string(svg, size).into_drawing_area();
        root.fill(&WHITE)?;
        write(&root, &self.title, (WIDTH / 2, TITLE_HEIGHT / 2 + 2), TITLE)?;
        let middle = (70 + WIDTH - LEGEND_WIDTH) / 2;
        write(&root, &self.abscissa, (middle, HEIGHT - 16), NAME)?;
        write(&root, &self.ordinate, (14, HEIGHT / 2), UPRIGHT)?;
        let label = ("sans-serif", font_size(11.0)).into_font().color(&INK);
        let mut chart = ChartBuilder::on(&root)
            .margin_top(fine(TITLE_HEIGHT + 10))
            .margin_right(fine(LEGEND_WIDTH))
            .margin_bottom(fine(26))
            .margin_left(fine(24))
            .x_label_area_size(fine(28))
            .y_label_area_size(fine(60))
            .build_cartesian_2d(
                (left / 1.2..right * 1.2).log_scale(),
                (low / 2.0..high * 2.0).log_scale(),
            )?;
        chart
            .configure_mesh()
            .max_light_lines(0)
            .bold_line_style(GRID.stroke_width(fine(1) as u32))
            .axis_style(INK.stroke_width(fine(1) as u32))
            .label_style(label)
            .set_all_tick_mark_size(fine(4))
            .x_label_formatter(&|value| tick(*value))
            .y_label_formatter(&|value| tick(*value))
            .draw()?;
        let colours = COMPUTED.into_iter().cycle();
        let drawn = self.series.iter().filter(|series| series.is_shown());
        for (k, (series, colour)) in drawn.zip(colours).enumerate() {
            let plot = chart.plotting_area();
            if let Some((exponent, factor)) = series.law {
                let ends = [left, right].map(|x| (x, factor * x.powf(exponent)));
                plot.draw(&PathElement::new(ends, line(EXACT, Role::Exact)))?;
            }
            let points: Vec<(f64, f64)> = series.shown().collect();
            for point in &points {
                plot.draw(&Circle::new(*point, fine(4), colour.filled()))?;
            }
            plot.draw(&PathElement::new(points, line(colour, Role::Computed)))?;
            let at = (WIDTH - LEGEND_WIDTH + 14, 60 + 20 * k as i32);
            let ends = [(fine(at.0), fine(at.1)), (fine(at.0 + 22), fine(at.1))];
            root.draw(&PathElement::new(ends, line(colour, Role::Computed)))?;
            write(&root, &series.name, (at.0 + 28, at.1), LEGEND)?;
        }
        root.present()?;
        Ok(())
    }
}

impl Series {
    /// Whether it has a point that can be shown.
    pub fn is_shown(&self) -> bool {
        self.shown().next().is_some()
    }

    fn shown(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let positive = |v: f64| v > 0.0 && v.is_finite();
        let points = self.points.iter().copied();
        points.filter(move |(x, y)| positive(*x) && positive(*y))
    }
}

/// A power of ten beside a tick, or a plain number where that is shorter.
fn tick(value: f64) -> String {
    match value {
        value if (0.01..1e5).contains(&value) => format!("{value}"),
        value => scientific(value, 0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(points: Vec<(f64, f64)>) -> Logarithmic {
        Logarithmic {
            title: "Errors".to_owned(),
            abscissa: "Time step (s)".to_owned(),
            ordinate: "Error".to_owned(),
            series: vec![Series {
                name: "impulse, order 1.00".to_owned(),
                points,
                law: Some((1.0, 2.0)),
            }],
        }
    }

    #[test]
    fn what_has_no_logarithm_is_left_out_and_nothing_at_all_is_an_error() {
        let svg = figure(vec![
            (1e-6, 1e-3),
            (1e-5, 0.0),
            (1e-4, f64::NAN),
            (1e-3, 1.0),
        ]);
        let svg = svg.svg().unwrap();
        assert_eq!(svg.matches("<circle").count(), 2);
        assert!(svg.contains("impulse, order 1.00"));
        // a series of which nothing is shown has no name in the legend
        let mut beside = figure(vec![(1.0, 1.0)]);
        beside.series.push(Series {
            name: "at rest".to_owned(),
            points: vec![(1.0, 0.0)],
            law: None,
        });
        assert!(!beside.svg().unwrap().contains("at rest"));
        let nothing = figure(vec![(1.0, -1.0)]).svg();
        assert!(matches!(nothing, Err(Error::EmptyPanel { .. })));
    }
}
