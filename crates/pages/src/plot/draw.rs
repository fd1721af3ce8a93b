//! Drawing of a figure with plotters.
//!
//! plotters places everything on whole pixels, so the drawing is made [`FINE`] times too large and shown smaller:
//! lines are then placed, and are as wide, as they should be.

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::scale::{Scale, Shown, extremes, quantity, shown};
use super::thin::{clip, thin};
use super::{Curve, Figure, Panel, Role};
use crate::Error;

/// Units of the drawing per displayed pixel.
const FINE: i32 = 4;

// Sizes in displayed pixels.
const WIDTH: i32 = 960;

const PANEL_HEIGHT: i32 = 310;

const TITLE_HEIGHT: i32 = 34;

const HEAD_HEIGHT: i32 = 46;

/// Height of each further line of the legend.
const LEGEND_LINE: i32 = 18;

const X_LABELS: i32 = 50;

const Y_LABELS: i32 = 66;

const RIGHT_MARGIN: i32 = 18;

const PAPER: RGBColor = RGBColor(0xff, 0xff, 0xff);

pub(super) const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);

const FAINT_INK: RGBColor = RGBColor(0x66, 0x66, 0x66);

pub(super) const GRID: RGBColor = RGBColor(0xe4, 0xe4, 0xe4);

pub(super) const EXACT: RGBColor = RGBColor(0xf4, 0xc1, 0x5d);

/// Colours of computed curves, told apart by every kind of colour vision and on dark paper too.
pub(super) const COMPUTED: [RGBColor; 12] = [
    RGBColor(0x1f, 0x6f, 0xc0),
    RGBColor(0xc8, 0x3e, 0x1d),
    RGBColor(0x1e, 0x94, 0x6c),
    RGBColor(0x9b, 0x5b, 0xb5),
    RGBColor(0x7a, 0x7a, 0x7a),
    RGBColor(0xa8, 0x7b, 0x10),
    RGBColor(0x12, 0xb5, 0xcb),
    RGBColor(0xe3, 0x77, 0xc2),
    RGBColor(0x5f, 0x3d, 0xc4),
    RGBColor(0x7c, 0xb3, 0x05),
    RGBColor(0x2b, 0x2b, 0x6f),
    RGBColor(0x5c, 0x3a, 0x2e),
];

type Area<'a, 'b> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

type Chart<'a, 'b> = ChartContext<'b, SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

pub(super) type Outcome = Result<(), Box<dyn std::error::Error>>;

impl Figure<'_> {
    /// The figure as an SVG document.
    ///
    /// A panel with `clip` set shows the range from the 1st to the 99th percentile of its computed curves (and all
    /// of the exact ones) if the full range is more than 1.6 times that; how many samples lie beyond, and the
    /// farthest of them, is then written over the panel. A panel without data is left out.
    ///
    /// # Errors
    /// [`Error::CurveLength`], [`Error::NotFinite`], [`Error::Backwards`] for a curve that cannot be drawn;
    /// [`Error::EmptyPanel`] if no panel has data; [`Error::Drawing`] if the drawing library fails.
    pub fn svg(&self) -> Result<String, Error> {
        for panel in &self.panels {
            panel.check()?;
        }
        let with_data = self.panels.iter().filter(|panel| panel.has_data());
        let panels: Vec<Panel> = with_data.cloned().collect();
        if panels.is_empty() {
            let first = self.panels.first();
            let panel = first.map_or(&self.title, |panel| &panel.title);
            return Err(Error::EmptyPanel {
                panel: panel.clone(),
            });
        }
        draw(&Figure {
            title: self.title.clone(),
            panels,
            ..*self
        })
    }
}

/// The figure as an SVG document; its curves are checked already.
pub fn draw(figure: &Figure) -> Result<String, Error> {
    let rows = figure.panels.len().div_ceil(figure.columns.max(1)) as i32;
    let width = WIDTH / figure.columns.max(1) as i32;
    let lines = figure.panels.iter().map(|panel| legend_lines(panel, width));
    let head = HEAD_HEIGHT + LEGEND_LINE * (lines.max().unwrap_or(1) - 1);
    let height = TITLE_HEIGHT + rows * (PANEL_HEIGHT - HEAD_HEIGHT + head);
    let mut svg = String::new();
    draw_on(figure, (rows, head), &mut svg, height).map_err(|cause| Error::Drawing {
        figure: figure.title.clone(),
        cause: cause.to_string(),
    })?;
    Ok(shrink(&svg, &figure.title, height))
}

/// `rows`: of panels; `head`: height of the head of each.
fn draw_on(figure: &Figure, (rows, head): (i32, i32), svg: &mut String, height: i32) -> Outcome {
    let size = (fine(WIDTH) as u32, fine(height) as u32);
    let root = SVGBackend::with_string(svg, size).into_drawing_area();
    root.fill(&PAPER)?;
    let (title, body) = root.split_vertically(fine(TITLE_HEIGHT));
    write(
        &title,
        &figure.title,
        (WIDTH / 2, TITLE_HEIGHT / 2 + 2),
        TITLE,
    )?;
    let areas = body.split_evenly((rows as usize, figure.columns.max(1)));
    let curves = figure.panels.iter().flat_map(|panel| &panel.curves);
    let (first, last) =
        extremes(curves.flat_map(|curve| curve.x.iter().copied())).unwrap_or((0.0, 1.0));
    let x = Scale::new(figure.abscissa, first, last, false);
    for (panel, area) in figure.panels.iter().zip(&areas) {
        draw_panel(panel, &x, head, area)?;
    }
    root.present()?;
    Ok(())
}

fn draw_panel(panel: &Panel, x: &Scale, head: i32, area: &Area) -> Outcome {
    let shown = shown(panel);
    let y = Scale::new(panel.ordinate, shown.low, shown.high, true);
    draw_head(panel, &shown, area)?;
    draw_names([&x.label, &y.label], head, area)?;
    let mut chart = ChartBuilder::on(area)
        .margin_top(fine(head))
        .margin_right(fine(RIGHT_MARGIN))
        .x_label_area_size(fine(X_LABELS))
        .y_label_area_size(fine(Y_LABELS))
        .build_cartesian_2d(x.low..x.high, y.low..y.high)?;
    draw_axes(&mut chart, x, &y)?;
    let columns = (area.dim_in_pixel().0 as i32 / FINE * 2) as usize;
    for (curve, colour) in coloured(panel) {
        let points: Vec<(f64, f64)> = curve
            .x
            .iter()
            .zip(curve.y)
            .map(|(t, v)| (t / x.factor, v / y.factor))
            .collect();
        let style = line(colour, curve.role);
        for part in clip(&thin(&points, columns), y.low, y.high) {
            chart.plotting_area().draw(&PathElement::new(part, style))?;
        }
        if let [point] = points[..] {
            chart
                .plotting_area()
                .draw(&Circle::new(point, fine(3), colour.filled()))?;
        }
    }
    Ok(())
}

/// Title of the panel, what was clipped, and the legend.
fn draw_head(panel: &Panel, shown: &Shown, area: &Area) -> Outcome {
    let right = area.dim_in_pixel().0 as i32 / FINE - RIGHT_MARGIN;
    write(area, &panel.title, (Y_LABELS, 12), HEAD)?;
    if let Some((count, farthest)) = shown.beyond {
        let samples = if count == 1 {
            "1 sample"
        } else {
            &format!("{count} samples")
        };
        let note = format!(
            "clipped: {samples}, to {}",
            quantity(farthest, panel.ordinate.unit)
        );
        write(area, &note, (right, 12), NOTE)?;
    }
    let width = area.dim_in_pixel().0 as i32 / FINE;
    for (curve, colour, (left, y)) in legend(panel, width) {
        let ends = vec![(fine(left), fine(y)), (fine(left + 22), fine(y))];
        area.draw(&PathElement::new(ends, line(colour, curve.role)))?;
        write(area, curve.name, (left + 28, y), LEGEND)?;
    }
    Ok(())
}

/// The first curve of each name with its colour, and where its entry begins, in displayed pixels: in as many lines as
/// it takes.
fn legend<'a, 'b>(panel: &'b Panel<'a>, width: i32) -> Vec<(&'b Curve<'a>, RGBColor, (i32, i32))> {
    let (mut left, mut y) = (Y_LABELS, 33);
    let mut entries: Vec<(&Curve, RGBColor, (i32, i32))> = Vec::new();
    // Computed curves first: the legend is read in the order of importance, the drawing is made in the reverse one.
    let (computed, exact): (Vec<_>, Vec<_>) = coloured(panel)
        .into_iter()
        .partition(|(curve, _)| curve.role == Role::Computed);
    for (curve, colour) in computed.into_iter().chain(exact) {
        if entries.iter().any(|(named, ..)| named.name == curve.name) {
            continue;
        }
        let length = 28 + 7 * curve.name.chars().count() as i32;
        if left > Y_LABELS && left + length > width - RIGHT_MARGIN {
            (left, y) = (Y_LABELS, y + LEGEND_LINE);
        }
        entries.push((curve, colour, (left, y)));
        left += length + 18;
    }
    entries
}

fn legend_lines(panel: &Panel, width: i32) -> i32 {
    let last = legend(panel, width).last().map_or(33, |(_, _, (_, y))| *y);
    1 + (last - 33) / LEGEND_LINE
}

/// Names of the axes, with their units. (plotters would put them at the very edge.)
fn draw_names([x, y]: [&str; 2], head: i32, area: &Area) -> Outcome {
    let (width, height) = area.dim_in_pixel();
    let (width, height) = (width as i32 / FINE, height as i32 / FINE);
    let middle = (Y_LABELS + width - RIGHT_MARGIN) / 2;
    write(area, x, (middle, height - X_LABELS + 33), NAME)?;
    let half_height = (head + height - X_LABELS) / 2;
    write(area, y, (14, half_height), UPRIGHT)
}

fn draw_axes(chart: &mut Chart, x: &Scale, y: &Scale) -> Outcome {
    let label = ("sans-serif", font_size(11.0)).into_font().color(&INK);
    chart
        .configure_mesh()
        .x_labels(9)
        .y_labels(7)
        .max_light_lines(0)
        .bold_line_style(GRID.stroke_width(fine(1) as u32))
        .axis_style(INK.stroke_width(fine(1) as u32))
        .label_style(label)
        .set_all_tick_mark_size(fine(4))
        .x_label_formatter(&|value| x.tick(*value))
        .y_label_formatter(&|value| y.tick(*value))
        .draw()?;
    Ok(())
}

/// The curves in the order of drawing, exact ones first, each with its colour: the same for computed curves of one name.
fn coloured<'a, 'b>(panel: &'b Panel<'a>) -> Vec<(&'b Curve<'a>, RGBColor)> {
    let of = |role| panel.curves.iter().filter(move |curve| curve.role == role);
    let mut names: Vec<&str> = Vec::new();
    let mut colour = |name: &'a str| {
        let known = names.iter().position(|known| *known == name);
        let index = known.unwrap_or_else(|| {
            names.push(name);
            names.len() - 1
        });
        COMPUTED[index % COMPUTED.len()]
    };
    let exact = of(Role::Exact).map(|curve| (curve, EXACT));
    let computed = of(Role::Computed).map(|curve| (curve, colour(curve.name)));
    exact.chain(computed).collect()
}

pub(super) fn line(colour: RGBColor, role: Role) -> ShapeStyle {
    match role {
        Role::Computed => colour.stroke_width((3 * FINE / 2) as u32),
        Role::Exact => colour.stroke_width((5 * FINE) as u32),
    }
}

/// How a text is set.
#[derive(Clone, Copy)]
pub(super) struct Font {
    size: f64,
    weight: FontStyle,
    colour: RGBColor,
    anchor: HPos,
    upright: bool,
}

/// Name of an axis, and the pattern of the other texts.
pub(super) const NAME: Font = Font {
    size: 12.0,
    weight: FontStyle::Normal,
    colour: INK,
    anchor: HPos::Center,
    upright: false,
};

/// Name of an ordinate.
pub(super) const UPRIGHT: Font = Font {
    upright: true,
    ..NAME
};

pub(super) const TITLE: Font = Font {
    size: 16.0,
    weight: FontStyle::Bold,
    ..NAME
};

const HEAD: Font = Font {
    size: 13.0,
    weight: FontStyle::Bold,
    anchor: HPos::Left,
    ..NAME
};

pub(super) const LEGEND: Font = Font {
    anchor: HPos::Left,
    ..NAME
};

const NOTE: Font = Font {
    size: 11.0,
    colour: FAINT_INK,
    anchor: HPos::Right,
    ..NAME
};

/// Writes a text with its left end, middle or right end, at half height, at a place in displayed pixels.
pub(super) fn write(area: &Area, text: &str, at: (i32, i32), font: Font) -> Outcome {
    let turn = if font.upright {
        FontTransform::Rotate270
    } else {
        FontTransform::None
    };
    let style = ("sans-serif", font_size(font.size), font.weight)
        .into_font()
        .transform(turn)
        .color(&font.colour)
        .pos(Pos::new(font.anchor, VPos::Center));
    area.draw_text(text, &style, (fine(at.0), fine(at.1)))?;
    Ok(())
}

/// The size to ask plotters for, which divides it by 1.24 in the SVG.
pub(super) fn font_size(pixels: f64) -> f64 {
    1.24 * pixels * f64::from(FINE)
}

pub(super) fn fine(pixels: i32) -> i32 {
    pixels * FINE
}

/// Shows the drawing at its size instead of [`FINE`] times that, scaling down to narrower pages, and names it.
pub(super) fn shrink(svg: &str, title: &str, height: i32) -> String {
    let body = svg.split_once('>').map_or("", |(_, body)| body);
    let (fine_width, fine_height) = (fine(WIDTH), fine(height));
    let title = crate::escape(title);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height}\" \
         viewBox=\"0 0 {fine_width} {fine_height}\" role=\"img\" aria-label=\"{title}\" stroke-linejoin=\"round\">{body}"
    )
}
