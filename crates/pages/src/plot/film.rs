//! The film strip: the model at some instants, side by side in one scale, its cells coloured by a field.
//!
//! Plane models are drawn as they are, with the rigid obstacles in grey; of solids the outer faces that look at the viewer,
//! the far ones first, seen along a fixed direction with z upward. Models of many faces are drawn in squares, so that the
//! picture stays small whatever the mesh. The drawing is written as SVG directly: it has no axes.

mod signs;
mod squares;
#[cfg(test)]
mod tests;
mod tone;
mod view;

use std::fmt::Write as _;

pub use self::signs::{Sign, What};
use self::tone::{Flat, LEVELS, SHADES, Tone, Window, colour};
use self::view::project;
use super::scale::quantity;
use crate::Error;

const WIDTH: f64 = 960.0;

/// Bound of the height of all frames together.
const HEIGHT: f64 = 760.0;

const HEAD: f64 = 74.0;

/// Room under a frame for its time, and between frames.
const CAPTION: f64 = 24.0;

const SPACE: f64 = 12.0;

/// Margin around the model in a frame, as a part of its longer side.
const MARGIN: f64 = 0.04;

/// Faces in a frame beyond which it is drawn in squares, and the squares along its longer side.
const FACES: usize = 2000;

/// Mean size of a face in pixels below which its edges are not drawn.
const FINE: f64 = 5.0;

/// Height in pixels of the stripes that obstacles are drawn with.
const STRIPE: f64 = 1.0;

const LIGHT: [f64; 3] = [-0.2, 0.6, 0.77];

/// A face, or a plane cell, with its value.
#[derive(Clone, Debug)]
pub struct Patch {
    /// Its nodes in turn, m; seen from outside they turn counter-clockwise.
    pub points: Vec<[f64; 3]>,
    /// Its value, not negative.
    pub value: f64,
}

/// The model at an instant, or in one shape.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// Time, s.
    pub time: f64,
    /// What is written under it.
    pub caption: String,
    /// Cells of a plane model, outer faces of a solid.
    pub patches: Vec<Patch>,
    /// Outlines of plane bodies, and beams, each a piece of line, m.
    pub rims: Vec<Vec<[f64; 3]>>,
    /// Places of plane models with a contact force, m.
    pub marks: Vec<[f64; 3]>,
    /// What acts on the model.
    pub signs: Vec<Sign>,
}

/// What a film shows beside its frames.
pub struct Scene<'a> {
    /// Title of the picture.
    pub title: &'a str,
    /// Dimension of the space.
    pub dim: usize,
    /// Name and unit of the values.
    pub field: (&'a str, &'a str),
    /// Gap of a place over the rigid obstacles at a time in s, m: negative inside. Asked in the plane only.
    pub gap: &'a dyn Fn(f64, [f64; 3]) -> f64,
}

/// The film strip of these instants as an SVG document.
///
/// # Errors
/// [`Error::EmptyPanel`] without anything to draw.
pub fn film_figure(scene: &Scene, frames: &[Frame]) -> Result<String, Error> {
    let largest = shown_largest(frames);
    let drawn: Vec<Vec<Flat>> = frames
        .iter()
        .map(|frame| flatten(scene.dim, frame, largest))
        .collect();
    let points = drawn
        .iter()
        .flatten()
        .flat_map(|flat| &flat.points)
        .copied();
    let rims = frames.iter().flat_map(|frame| frame.rims.iter().flatten());
    let rims = rims.map(|x| project(scene.dim, x).0);
    let bounds = points.chain(rims).fold(
        [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]],
        |[low, high], x| {
            [
                [0, 1].map(|i| low[i].min(x[i])),
                [0, 1].map(|i| high[i].max(x[i])),
            ]
        },
    );
    let finite = bounds.iter().flatten().all(|bound| bound.is_finite());
    if !finite {
        return Err(Error::EmptyPanel {
            panel: scene.title.to_owned(),
        });
    }
    let (windows, height) = windows(bounds, frames.len());
    let mut svg = String::new();
    draw_head(scene, &windows[0], largest, frames, &mut svg);
    for ((frame, flats), window) in frames.iter().zip(&drawn).zip(&windows) {
        draw_frame(scene, frame, flats, window, &mut svg);
    }
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height:.0}\" \
         viewBox=\"0 0 {WIDTH} {height:.0}\" role=\"img\" aria-label=\"{}\" font-family=\"sans-serif\" \
         font-size=\"12\" fill=\"#222222\" stroke-linejoin=\"round\">\n\
         <rect width=\"{WIDTH}\" height=\"{height:.0}\" fill=\"#ffffff\"/>\n{svg}</svg>\n",
        scene.title
    ))
}

/// The value that has the darkest colour: the 98th percentile, lest a single cell make all others pale.
fn shown_largest(frames: &[Frame]) -> f64 {
    let all = frames.iter().flat_map(|frame| &frame.patches);
    let mut values: Vec<f64> = all
        .map(|patch| patch.value)
        .filter(|v| v.is_finite())
        .collect();
    values.sort_unstable_by(f64::total_cmp);
    let at = (0.98 * values.len() as f64) as usize;
    values.get(at).copied().unwrap_or(0.0)
}

/// The patches that can be seen, the far ones first.
fn flatten(dim: usize, frame: &Frame, largest: f64) -> Vec<Flat> {
    let level = |value: f64| match largest > 0.0 {
        true => ((value / largest).clamp(0.0, 1.0) * (LEVELS - 1) as f64).round() as usize,
        false => 0,
    };
    let mut flats: Vec<Flat> = Vec::with_capacity(frame.patches.len());
    for patch in &frame.patches {
        let seen: Vec<([f64; 2], f64)> = patch.points.iter().map(|x| project(dim, x)).collect();
        let level = level(patch.value);
        let flat = Flat {
            points: seen.iter().map(|(x, _)| *x).collect(),
            tone: match dim {
                3 => shaded(level, &seen),
                _ => Tone::bright(level),
            },
            depth: seen.iter().map(|(_, depth)| depth).sum::<f64>() / seen.len() as f64,
        };
        if dim < 3 || area(&flat.points) > 0.0 {
            flats.push(flat);
        }
    }
    if dim == 3 {
        flats.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    }
    flats
}

/// The tone of a face by the light on it, from its places to the right, upward and towards the viewer.
fn shaded(level: usize, seen: &[([f64; 2], f64)]) -> Tone {
    let mut normal = [0.0; 3];
    let next = seen.iter().cycle().skip(1);
    for (([x, y], z), ([u, v], w)) in seen.iter().zip(next) {
        normal[0] += y * w - z * v;
        normal[1] += z * u - x * w;
        normal[2] += x * v - y * u;
    }
    let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
    let light = (0..3).map(|i| normal[i] * LIGHT[i]).sum::<f64>() / length.max(f64::MIN_POSITIVE);
    Tone {
        level,
        shade: (light.max(0.0) * (SHADES - 1) as f64).round() as usize,
    }
}

/// Area of a polygon, positive if it turns counter-clockwise.
fn area(points: &[[f64; 2]]) -> f64 {
    let next = points.iter().cycle().skip(1);
    let twice = points
        .iter()
        .zip(next)
        .map(|(a, b)| a[0] * b[1] - a[1] * b[0]);
    0.5 * twice.sum::<f64>()
}

/// The windows of the frames in the number of columns that shows them largest, and the height of the picture.
fn windows([low, high]: [[f64; 2]; 2], count: usize) -> (Vec<Window>, f64) {
    let lengths = [0, 1].map(|i| high[i] - low[i]);
    let longer = lengths[0].max(lengths[1]).max(f64::MIN_POSITIVE);
    let margin = MARGIN * longer;
    let (low, lengths) = (low.map(|x| x - margin), lengths.map(|l| l + 2.0 * margin));
    let scale = |columns: usize| {
        let rows = count.div_ceil(columns) as f64;
        let width = (WIDTH - SPACE) / columns as f64 - SPACE;
        let height = HEIGHT / rows - CAPTION - SPACE;
        (width / lengths[0]).min(height / lengths[1])
    };
    let columns = (1..=count).fold(1, |best, columns| match scale(columns) > scale(best) {
        true => columns,
        false => best,
    });
    let scale = scale(columns);
    let size = lengths.map(|length| scale * length);
    let step = [size[0] + SPACE, size[1] + CAPTION + SPACE];
    let left = 0.5 * (WIDTH - columns as f64 * step[0] + SPACE);
    let place = |k: usize| Window {
        scale,
        low,
        corner: [
            left + (k % columns) as f64 * step[0],
            HEAD + (k / columns) as f64 * step[1],
        ],
        size,
    };
    let rows = count.div_ceil(columns) as f64;
    ((0..count).map(place).collect(), HEAD + rows * step[1])
}

/// Title, bar of colours, bar of length, and what a mark is.
fn draw_head(scene: &Scene, window: &Window, largest: f64, frames: &[Frame], svg: &mut String) {
    // writing to a String cannot fail, here and below
    let _ = writeln!(
        svg,
        "<text x=\"{}\" y=\"22\" font-size=\"16\" font-weight=\"bold\" text-anchor=\"middle\">{}</text>",
        0.5 * WIDTH,
        scene.title
    );
    let (mut x, y) = (24.0, 46.0);
    // rigid bodies have no stress: nothing is coloured
    if largest > 0.0 {
        for level in 0..LEVELS {
            let _ = write!(
                svg,
                "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"6.2\" height=\"10\" fill=\"{}\"/>",
                x + 6.0 * level as f64,
                y - 5.0,
                colour(Tone::bright(level))
            );
        }
        x += 6.0 * LEVELS as f64 + 8.0;
        let (name, unit) = scene.field;
        let text = format!("{name}, 0 to {} and above", quantity(largest, unit));
        write_text(svg, [x, y], &text);
        x += 24.0 + 6.4 * text.chars().count() as f64;
    }
    let length = round_length(90.0 / window.scale);
    let pixels = window.scale * length;
    let _ = writeln!(
        svg,
        "<path d=\"M{x:.1},{:.1}v6m0,-3h{pixels:.1}m0,-3v6\" fill=\"none\" stroke=\"#222222\"/>",
        y - 3.0
    );
    x += pixels + 8.0;
    write_text(svg, [x, y], &quantity(length, "m"));
    if frames.iter().any(|frame| !frame.marks.is_empty()) {
        x += 84.0;
        let _ = writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y}\" r=\"3\" fill=\"{MARK}\"/>"
        );
        write_text(svg, [x + 8.0, y], "contact force");
    }
}

const MARK: &str = "#c83e1d";

/// Text that begins at a place, at half its height.
fn write_text(svg: &mut String, [x, y]: [f64; 2], text: &str) {
    let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{:.1}\">{text}</text>", y + 4.0);
}

/// The largest of 1, 2 and 5 times a power of ten not above a length.
fn round_length(length: f64) -> f64 {
    let power = 10f64.powf(length.log10().floor());
    let factor = [5.0, 2.0].into_iter().find(|f| f * power <= length);
    factor.unwrap_or(1.0) * power
}

fn draw_frame(scene: &Scene, frame: &Frame, flats: &[Flat], window: &Window, svg: &mut String) {
    let Window { corner, size, .. } = window;
    let _ = writeln!(
        svg,
        "<g><rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"none\" stroke=\"#e4e4e4\"/>",
        corner[0], corner[1], size[0], size[1]
    );
    if scene.dim == 2 {
        draw_obstacles(scene, frame.time, window, svg);
    }
    match flats.len() > FACES {
        true => squares::draw(flats, window, svg),
        false => draw_faces(flats, window, svg),
    }
    let mut rims = String::new();
    for rim in &frame.rims {
        trace(
            rim.iter().map(|x| window.at(project(scene.dim, x).0)),
            &mut rims,
        );
    }
    if !rims.is_empty() {
        let _ = writeln!(
            svg,
            "<path d=\"{rims}\" fill=\"none\" stroke=\"#222222\" stroke-width=\"0.9\" stroke-linecap=\"round\"/>"
        );
    }
    for mark in &frame.marks {
        let [x, y] = window.at(project(scene.dim, mark).0);
        let _ = write!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2\" fill=\"{MARK}\"/>"
        );
    }
    signs::draw(scene.dim, &frame.signs, window, svg);
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text></g>",
        corner[0] + 0.5 * size[0],
        corner[1] + size[1] + 16.0,
        frame.caption
    );
}

/// The faces one after the other, with their edges where these can be told apart.
fn draw_faces(flats: &[Flat], window: &Window, svg: &mut String) {
    let mean = flats
        .iter()
        .map(|flat| area(&flat.points).abs())
        .sum::<f64>()
        / flats.len() as f64;
    let edges = mean.sqrt() * window.scale > FINE;
    for flat in flats {
        let mut path = String::new();
        trace(flat.points.iter().map(|x| window.at(*x)), &mut path);
        let colour = colour(flat.tone);
        // without an edge of its own colour a face would leave a hair of white to its neighbours
        let stroke = if edges { "#5c6670" } else { &colour };
        let _ = writeln!(
            svg,
            "<path d=\"{path}Z\" fill=\"{colour}\" stroke=\"{stroke}\" stroke-width=\"0.4\"/>"
        );
    }
}

/// A line through these places, in tenths of a pixel.
fn trace(points: impl Iterator<Item = [f64; 2]>, path: &mut String) {
    for (k, [x, y]) in points.enumerate() {
        let letter = if k == 0 { 'M' } else { 'L' };
        let _ = write!(path, "{letter}{x:.1},{y:.1}");
    }
}

/// Stripes over the places in which a rigid obstacle is.
fn draw_obstacles(scene: &Scene, time: f64, window: &Window, svg: &mut String) {
    let Window { corner, size, .. } = window;
    let (columns, rows) = (64, (size[1] / STRIPE) as usize);
    let mut path = String::new();
    for row in 0..rows {
        let y = corner[1] + (row as f64 + 0.5) * STRIPE;
        let height = window.low[1] + (corner[1] + size[1] - y) / window.scale;
        let gap = |k: usize| {
            let x = size[0] * k as f64 / columns as f64;
            (
                x,
                (scene.gap)(time, [window.low[0] + x / window.scale, height, 0.0]),
            )
        };
        let mut from = None;
        let mut last = gap(0);
        if last.1 < 0.0 {
            from = Some(0.0);
        }
        for k in 1..=columns {
            let next = gap(k);
            // where the line crosses the boundary, as if the gap were linear between two samples
            let crossing = match (last.1 - next.1).is_finite() && last.1 != next.1 {
                true => last.0 + (next.0 - last.0) * last.1 / (last.1 - next.1),
                false => next.0,
            };
            match (from, next.1 < 0.0) {
                (None, true) => from = Some(crossing),
                (Some(start), false) => {
                    stripe(&mut path, [corner[0] + start, y], crossing - start);
                    from = None;
                }
                _ => {}
            }
            last = next;
        }
        if let Some(start) = from {
            stripe(&mut path, [corner[0] + start, y], size[0] - start);
        }
    }
    if !path.is_empty() {
        let _ = writeln!(
            svg,
            "<path d=\"{path}\" fill=\"none\" stroke=\"#d5d2cb\" stroke-width=\"{}\"/>",
            1.1 * STRIPE
        );
    }
}

fn stripe(path: &mut String, [x, y]: [f64; 2], length: f64) {
    let _ = write!(path, "M{x:.1},{y:.1}h{length:.1}");
}
