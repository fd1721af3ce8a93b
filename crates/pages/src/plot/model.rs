//! A picture of a model in zones: where the zones are, where they overlap, and how they share what they overlap.

use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::draw::{
    COMPUTED, GRID, INK, LEGEND, NAME, Outcome, TITLE, UPRIGHT, fine, font_size, line, shrink,
    write,
};
use super::scale::Scale;
use super::{Axis, Role};
use crate::Error;

const WIDTH: i32 = 960;

const TITLE_HEIGHT: i32 = 34;

const LEGEND_LINE: i32 = 20;

const LEFT: i32 = 80;

const RIGHT: i32 = 18;

const X_LABELS: i32 = 56;

/// Height of a picture in one dimension, and the bounds of the others.
const STRIP_HEIGHT: i32 = 300;

const HEIGHTS: [i32; 2] = [120, 820];

/// Squares over the width of a picture in two or three dimensions, and the width of a stripe in squares.
const SQUARES: usize = 220;

const STRIPE: usize = 2;

/// Height of the strip under the weights, which go from 0 to 1.
const STRIP: f64 = 0.3;

const AXES: [Axis; 3] = [axis("x"), axis("y"), axis("z")];

const fn axis(quantity: &'static str) -> Axis {
    Axis {
        quantity,
        unit: "m",
    }
}

/// A cell in the picture.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Its zone.
    pub zone: usize,
    /// Its nodes, m.
    pub points: Vec<[f64; 3]>,
    /// Its mean weights of inertia and internal work.
    pub weights: [f64; 2],
}

impl Shape {
    /// Whether it shares its volume with another.
    fn is_shared(&self) -> bool {
        self.weights.iter().any(|w| *w < 1.0 - 1e-9)
    }

    /// Whether nothing of the body is its own.
    fn is_empty(&self) -> bool {
        self.weights.iter().all(|w| *w < 1e-9)
    }

    /// Least and largest coordinate.
    fn range(&self, axis: usize) -> [f64; 2] {
        let values = self.points.iter().map(|x| x[axis]);
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        })
    }

    /// Where a line across the projection of its convex hull on two axes begins and ends.
    fn cut(&self, [a, b]: [usize; 2], height: f64) -> Option<[f64; 2]> {
        let mut ends: Option<[f64; 2]> = None;
        for (k, p) in self.points.iter().enumerate() {
            for q in &self.points[..k] {
                let (from, to) = (p[b] - height, q[b] - height);
                if from * to <= 0.0 && from != to {
                    let x = p[a] + from / (from - to) * (q[a] - p[a]);
                    let [low, high] = ends.unwrap_or([x, x]);
                    ends = Some([low.min(x), high.max(x)]);
                }
            }
        }
        ends
    }
}

/// The picture of a model: in one dimension the zones as strips with their weights over them, in two the
/// cells on the two axes of largest extent, in three a section, striped in the colours of all zones where they overlap.
///
/// # Errors
/// [`Error::EmptyPanel`] without cells; [`Error::Drawing`].
pub fn model_figure(dim: usize, zones: &[String], cells: &[Shape]) -> Result<String, Error> {
    let title = "Zones of the model".to_owned();
    if cells.is_empty() {
        return Err(Error::EmptyPanel { panel: title });
    }
    let ranges = [0, 1, 2].map(|axis| {
        let all = cells.iter().map(|cell| cell.range(axis));
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [low, high]| {
            [a.min(low), b.max(high)]
        })
    });
    let section = (dim == 3).then(|| section(cells, &ranges));
    let (axes, note, cut);
    let cells = match section {
        Some((normal, place)) => {
            let met = |cell: &&Shape| {
                let [low, high] = cell.range(normal);
                low < place && place < high
            };
            cut = cells.iter().filter(met).cloned().collect::<Vec<_>>();
            axes = others(normal);
            note = format!(
                "at {} = {place:.4}; striped: overlap",
                ["x", "y", "z"][normal]
            );
            &cut[..]
        }
        None => {
            axes = largest(&ranges);
            note = "striped: overlap".to_owned();
            cells
        }
    };
    let picture = Picture {
        zones,
        cells,
        ranges,
        axes,
        note,
    };
    let height = match dim {
        1 => STRIP_HEIGHT,
        _ => picture.height(),
    };
    let head = TITLE_HEIGHT + LEGEND_LINE;
    let all = height + head + X_LABELS;
    let mut svg = String::new();
    let size = (fine(WIDTH) as u32, fine(all) as u32);
    let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
    let drawn = match dim {
        1 => picture.strip(&root, &title, all),
        _ => picture.projection(&root, &title, all),
    };
    let drawn = drawn.and_then(|()| Ok(root.present()?));
    drop(root);
    drawn.map_err(|cause| Error::Drawing {
        figure: title.clone(),
        cause: cause.to_string(),
    })?;
    Ok(shrink(&svg, &title, all))
}

/// The section in which a solid is drawn, normal axis and place: through the middle of the smallest zone, across the axis
/// along which it lies nearest to the middle of the model.
fn section(cells: &[Shape], ranges: &[[f64; 2]; 3]) -> (usize, f64) {
    let count = cells.iter().map(|cell| cell.zone + 1).max().unwrap_or(1);
    let extent = |zone: usize, axis: usize| {
        let own = cells.iter().filter(|cell| cell.zone == zone);
        own.map(|cell| cell.range(axis))
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [low, high]| {
                [a.min(low), b.max(high)]
            })
    };
    let size = |zone: &usize| -> f64 {
        let lengths = [0, 1, 2].map(|axis| {
            let [low, high] = extent(*zone, axis);
            high - low
        });
        lengths.iter().product()
    };
    let smallest = (0..count).min_by(|a, b| size(a).total_cmp(&size(b)));
    let smallest = smallest.unwrap_or(0);
    let middle = |[low, high]: [f64; 2]| 0.5 * (low + high);
    let offset = |axis: &usize| {
        let length = ranges[*axis][1] - ranges[*axis][0];
        ((middle(extent(smallest, *axis)) - middle(ranges[*axis])) / length).abs()
    };
    // of equal ones the second axis, so that the third, often the height, is seen
    let normal = [1, 0, 2]
        .into_iter()
        .min_by(|a, b| offset(a).total_cmp(&offset(b)))
        .unwrap_or(1);
    let [low, high] = ranges[normal];
    // beside the faces of cells, which meet there
    (
        normal,
        middle(extent(smallest, normal)) + 1e-6 * (high - low),
    )
}

/// The other two axes, in their order.
fn others(axis: usize) -> [usize; 2] {
    match axis {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    }
}

/// The two axes of largest extent, in their order.
fn largest(ranges: &[[f64; 2]; 3]) -> [usize; 2] {
    let extent = |axis: usize| ranges[axis][1] - ranges[axis][0];
    let mut least = 2;
    for axis in [1, 0] {
        if extent(axis) < extent(least) {
            least = axis;
        }
    }
    others(least)
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

type Chart<'a, 'b> = ChartContext<'b, SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

struct Picture<'a> {
    zones: &'a [String],
    cells: &'a [Shape],
    ranges: [[f64; 2]; 3],
    axes: [usize; 2],
    note: String,
}

fn colour(zone: usize) -> RGBColor {
    COMPUTED[zone % COMPUTED.len()]
}

impl Picture<'_> {
    /// Height at which both axes have one scale, within bounds.
    fn height(&self) -> i32 {
        let [a, b] = self
            .axes
            .map(|axis| self.ranges[axis][1] - self.ranges[axis][0]);
        let height = f64::from(WIDTH - LEFT - RIGHT) * b / a.max(f64::MIN_POSITIVE);
        (height as i32).clamp(HEIGHTS[0], HEIGHTS[1])
    }

    fn head(&self, root: &Area, title: &str, note: &str) -> Outcome {
        root.fill(&WHITE)?;
        write(root, title, (WIDTH / 2, TITLE_HEIGHT / 2 + 2), TITLE)?;
        let (mut left, y) = (LEFT, TITLE_HEIGHT + LEGEND_LINE / 2);
        for (zone, name) in self.zones.iter().enumerate() {
            let corners = [(fine(left), fine(y - 5)), (fine(left + 22), fine(y + 5))];
            root.draw(&Rectangle::new(corners, colour(zone).filled()))?;
            write(root, name, (left + 28, y), LEGEND)?;
            left += 46 + 7 * name.chars().count() as i32;
        }
        write(root, note, (left, y), LEGEND)
    }

    fn chart<'a, 'b>(
        root: &'b Area<'a>,
        x: &Scale,
        [low, high]: [f64; 2],
        y_tick: &dyn Fn(f64) -> String,
    ) -> Result<Chart<'a, 'b>, Box<dyn std::error::Error>> {
        let label = ("sans-serif", font_size(11.0)).into_font().color(&INK);
        let mut chart = ChartBuilder::on(root)
            .margin_top(fine(TITLE_HEIGHT + LEGEND_LINE))
            .margin_right(fine(RIGHT))
            .margin_bottom(fine(26))
            .margin_left(fine(24))
            .x_label_area_size(fine(X_LABELS - 26))
            .y_label_area_size(fine(LEFT - 24))
            .build_cartesian_2d(x.low..x.high, low..high)?;
        chart
            .configure_mesh()
            .x_labels(9)
            .y_labels(5)
            .max_light_lines(0)
            .bold_line_style(GRID.stroke_width(fine(1) as u32))
            .axis_style(INK.stroke_width(fine(1) as u32))
            .label_style(label)
            .x_label_formatter(&|value| x.tick(*value))
            .y_label_formatter(&|value| y_tick(*value))
            .draw()?;
        Ok(chart)
    }

    fn strip(&self, root: &Area, title: &str, height: i32) -> Outcome {
        let note = "weights: inertia thin lines, internal work thick lines (cell means)";
        self.head(root, title, note)?;
        let [left, right] = self.ranges[0];
        let x = Scale::new(AXES[0], left, right, false);
        let tick = |y: f64| match y < 0.0 {
            true => String::new(),
            false => format!("{y}"),
        };
        let chart = Self::chart(root, &x, [-STRIP - 0.05, 1.05], &tick)?;
        write(root, &x.label, (WIDTH / 2, height - 12), NAME)?;
        write(root, "weight", (14, height / 2), UPRIGHT)?;
        let row = STRIP / self.zones.len().max(1) as f64;
        for cell in self.cells {
            let [from, to] = cell.range(0).map(|end| end / x.factor);
            let top = -0.02 - row * cell.zone as f64;
            let corners = [(from, top), (to, top - 0.8 * row)];
            let area = chart.plotting_area();
            area.draw(&Rectangle::new(
                corners,
                colour(cell.zone).mix(0.5).filled(),
            ))?;
            area.draw(&Rectangle::new(corners, INK.stroke_width(1)))?;
        }
        for zone in 0..self.zones.len() {
            for (kind, style) in [
                (1, colour(zone).mix(0.3).stroke_width(fine(5) as u32)),
                (0, line(colour(zone), Role::Computed)),
            ] {
                for stairs in self.stairs(zone, kind, x.factor) {
                    chart
                        .plotting_area()
                        .draw(&PathElement::new(stairs, style))?;
                }
            }
        }
        Ok(())
    }

    /// A weight of a zone over x, in pieces where the zone has gaps.
    fn stairs(&self, zone: usize, kind: usize, factor: f64) -> Vec<Vec<(f64, f64)>> {
        let own = self.cells.iter().filter(|cell| cell.zone == zone);
        let mut cells: Vec<([f64; 2], f64)> = own
            .map(|cell| (cell.range(0), cell.weights[kind]))
            .collect();
        cells.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
        let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
        let mut last = f64::NEG_INFINITY;
        for ([from, to], weight) in cells {
            if from - last > 1e-3 * (to - from) {
                pieces.push(Vec::new());
            }
            if let Some(piece) = pieces.last_mut() {
                piece.extend([(from / factor, weight), (to / factor, weight)]);
            }
            last = to;
        }
        pieces
    }

    fn projection(&self, root: &Area, title: &str, height: i32) -> Outcome {
        self.head(root, title, &self.note)?;
        let [a, b] = self.axes;
        let scale = |axis: usize| {
            let [low, high] = self.ranges[axis];
            Scale::new(AXES[axis], low, high, false)
        };
        let (x, y) = (scale(a), scale(b));
        let chart = Self::chart(root, &x, [y.low, y.high], &|value| y.tick(value))?;
        write(root, &x.label, (WIDTH / 2, height - 12), NAME)?;
        write(root, &y.label, (14, height / 2), UPRIGHT)?;
        let area = chart.plotting_area();
        let (squares, [wide, high]) = self.squares();
        let corner = |i: usize, j: usize| {
            let at = |axis: usize, part: f64| {
                let [low, high] = self.ranges[axis];
                low + part * (high - low)
            };
            let (u, v) = (i as f64 / wide as f64, j as f64 / high as f64);
            (at(a, u) / x.factor, at(b, v) / y.factor)
        };
        for (j, row) in squares.chunks_exact(wide).enumerate() {
            let mut i = 0;
            while i < wide {
                let first = i;
                let zone = row[i].colour(i + j);
                while i < wide && row[i].colour(i + j) == zone {
                    i += 1;
                }
                if let Some(zone) = zone {
                    let corners = [corner(first, j), corner(i, j + 1)];
                    area.draw(&Rectangle::new(corners, colour(zone).filled()))?;
                }
            }
        }
        Ok(())
    }

    /// The squares row by row from below, and how many there are along each axis.
    fn squares(&self) -> (Vec<Square>, [usize; 2]) {
        let ranges = self.axes.map(|axis| self.ranges[axis]);
        let lengths = ranges.map(|[low, high]| high - low);
        let high = (SQUARES as f64 * lengths[1] / lengths[0].max(f64::MIN_POSITIVE)).ceil();
        let counts = [SQUARES, (high as usize).clamp(1, SQUARES)];
        let mut squares = vec![Square::default(); counts[0] * counts[1]];
        let sizes = [0, 1].map(|k| lengths[k] / counts[k] as f64);
        // squares whose middle lies between two places
        let between = |k: usize, [from, to]: [f64; 2]| {
            let place = |x: f64| ((x - ranges[k][0]) / sizes[k] - 0.5).ceil().max(0.0) as usize;
            place(from).min(counts[k])..place(to).min(counts[k])
        };
        for cell in self.cells.iter().filter(|cell| !cell.is_empty()) {
            for j in between(1, cell.range(self.axes[1])) {
                let middle = ranges[1][0] + (j as f64 + 0.5) * sizes[1];
                let Some(ends) = cell.cut(self.axes, middle) else {
                    continue;
                };
                for i in between(0, ends) {
                    squares[j * counts[0] + i].add(cell);
                }
            }
        }
        (squares, counts)
    }
}

/// The zones in a square, a bit each: all, and those whose cells share their volume.
#[derive(Clone, Copy, Debug, Default)]
struct Square {
    all: u64,
    shared: u64,
}

impl Square {
    fn add(&mut self, cell: &Shape) {
        let bit = 1 << (cell.zone % 64);
        self.all |= bit;
        if cell.is_shared() {
            self.shared |= bit;
        }
    }

    /// The zone whose colour it has; `place`: sum of its numbers along the axes.
    fn colour(self, place: usize) -> Option<usize> {
        let zones = match self.shared {
            0 => self.all,
            shared => shared,
        };
        let stripes = zones.count_ones() as usize;
        let wanted = match self.shared {
            0 => 0,
            _ => place / STRIPE % stripes.max(1),
        };
        (0..64).filter(|zone| zones >> zone & 1 == 1).nth(wanted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(zone: usize, from: f64, weight: f64) -> Shape {
        let at = |x: f64, y: f64| [from + x, y, 0.0];
        Shape {
            zone,
            points: vec![at(0.0, 0.0), at(2.0, 0.0), at(2.0, 1.0), at(0.0, 1.0)],
            weights: [weight; 2],
        }
    }

    fn fills(svg: &str, zone: usize) -> usize {
        let RGBColor(r, g, b) = colour(zone);
        let fill = format!("fill=\"#{r:02X}{g:02X}{b:02X}\"");
        svg.matches(&fill).count()
    }

    #[test]
    fn an_overlap_is_striped_in_both_colours_and_nothing_else_is() {
        let names = ["fine".to_owned(), "rest".to_owned()];
        let beside = model_figure(2, &names, &[square(0, 0.0, 1.0), square(1, 2.0, 1.0)]);
        let beside = beside.unwrap();
        // one run of squares in each row, and the legend
        let rows = SQUARES / 4 + 1;
        assert_eq!([fills(&beside, 0), fills(&beside, 1)], [rows, rows]);
        let over = model_figure(2, &names, &[square(0, 0.0, 0.5), square(1, 0.0, 0.5)]).unwrap();
        assert!(fills(&over, 0) > 10 * rows && fills(&over, 1) > 10 * rows);
        // a cell that carries nothing hides nothing
        let hidden = [square(1, 0.0, 1.0), square(0, 0.0, 0.0)];
        assert_eq!(fills(&model_figure(2, &names, &hidden).unwrap(), 0), 1);
    }

    #[test]
    fn a_cell_is_cut_where_its_hull_is() {
        let shape = square(0, 3.0, 1.0);
        assert_eq!(shape.cut([0, 1], 0.25), Some([3.0, 5.0]));
        assert_eq!(shape.cut([0, 1], 1.5), None);
        let mut triangle = shape;
        triangle.points.truncate(3);
        // from the corner (3, 0) to (5, 1)
        assert_eq!(triangle.cut([0, 1], 0.5), Some([4.0, 5.0]));
    }
}
