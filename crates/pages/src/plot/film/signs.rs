//! Signs for what acts on a model: supports, loads, springs, masses, contacts, with their names.

use std::fmt::Write as _;

use super::tone::Window;
use super::view::project;

/// Signs of one kind and name beyond which only every second, third, … is drawn.
const MOST: usize = 200;

/// Length of the arrow of a load in pixels.
const ARROW: f64 = 22.0;

/// What a sign stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// A body.
    Body,
    /// A support.
    Support,
    /// A load.
    Load,
    /// A mass.
    Mass,
    /// Places in pairs: the ends of springs, dashpots and bolts.
    Link,
    /// Points of the secondary side of a contact.
    Contact,
    /// Nodes of its primary side.
    Primary,
}

impl What {
    fn colour(self) -> &'static str {
        match self {
            What::Body => "#222222",
            What::Support => "#1b7837",
            What::Load => "#c83e1d",
            What::Mass => "#5e3c99",
            What::Link => "#8a5a00",
            What::Contact | What::Primary => "#1f6fb2",
        }
    }
}

/// Something with a name, at some places.
#[derive(Clone, Debug)]
pub struct Sign {
    /// What it stands for.
    pub what: What,
    /// Kind and name, beside the places.
    pub label: String,
    /// Numbers of the nodes at its places.
    pub nodes: Vec<u32>,
    /// Places, m.
    pub places: Vec<[f64; 3]>,
    /// Directions of loads, one for each place, of any length.
    pub ways: Vec<[f64; 3]>,
}

/// Draws the signs over a frame, each with its label beside the first of its places, labels under each other where they would meet.
pub(super) fn draw(dim: usize, signs: &[Sign], window: &Window, svg: &mut String) {
    let mut taken: Vec<[f64; 2]> = Vec::new();
    for sign in signs.iter().filter(|sign| !sign.places.is_empty()) {
        let at = |x: &[f64; 3]| window.at(project(dim, x).0);
        let colour = sign.what.colour();
        let each = sign.places.len().div_ceil(MOST);
        let mut path = String::new();
        match sign.what {
            What::Link => {
                for ends in sign.places.chunks_exact(2).step_by(each) {
                    let ([x, y], [u, v]) = (at(&ends[0]), at(&ends[1]));
                    let _ = write!(path, "M{x:.1},{y:.1}L{u:.1},{v:.1}");
                }
            }
            _ => {
                for k in (0..sign.places.len()).step_by(each) {
                    let place = at(&sign.places[k]);
                    let way = sign.ways.get(k).map(|way| project(dim, way).0);
                    symbol(sign.what, place, way, &mut path);
                }
            }
        }
        let dashes = if sign.what == What::Link {
            " stroke-dasharray=\"5 2\""
        } else {
            ""
        };
        let fill = if matches!(sign.what, What::Link | What::Load) {
            "none"
        } else {
            colour
        };
        let _ = writeln!(
            svg,
            "<path d=\"{path}\" fill=\"{fill}\" stroke=\"{colour}\" stroke-width=\"1.2\"{dashes}/>"
        );
        if !sign.label.is_empty() {
            label(sign, at(&middle(&sign.places)), &mut taken, svg);
        }
    }
}

/// A triangle under a support, an arrow that ends at a load, a square of a mass, a point of a contact.
fn symbol(what: What, [x, y]: [f64; 2], way: Option<[f64; 2]>, path: &mut String) {
    let _ = match what {
        What::Support => write!(path, "M{x:.1},{y:.1}l-3.5,6h7z"),
        What::Mass => write!(path, "M{:.1},{:.1}h8v8h-8z", x - 4.0, y - 4.0),
        What::Contact => write!(path, "M{:.1},{:.1}h3v3h-3z", x - 1.5, y - 1.5),
        What::Primary => write!(path, "M{:.1},{:.1}h1v1h-1z", x - 0.5, y - 0.5),
        What::Load => match way.map(|way| (way, way[0].hypot(way[1]))) {
            Some((way, length)) if length > 0.0 => {
                // y grows downward in a picture
                let [u, v] = [way[0] / length, -way[1] / length];
                let tail = [x - ARROW * u, y - ARROW * v];
                let side = |s: f64| [x - 6.0 * u - s * v, y - 6.0 * v + s * u];
                let ([a, b], [c, d]) = (side(3.0), side(-3.0));
                write!(
                    path,
                    "M{:.1},{:.1}L{x:.1},{y:.1}M{a:.1},{b:.1}L{x:.1},{y:.1}L{c:.1},{d:.1}",
                    tail[0], tail[1]
                )
            }
            // along the line of sight
            _ => write!(path, "M{:.1},{y:.1}h6m-3,-3v6", x - 3.0),
        },
        What::Body | What::Link => Ok(()),
    };
}

/// Mean of some places, m.
fn middle(places: &[[f64; 3]]) -> [f64; 3] {
    let sum = |i: usize| places.iter().map(|x| x[i]).sum::<f64>();
    [0, 1, 2].map(|i| sum(i) / places.len() as f64)
}

fn label(sign: &Sign, [x, mut y]: [f64; 2], taken: &mut Vec<[f64; 2]>, svg: &mut String) {
    let meets = |y: f64, taken: &[[f64; 2]]| {
        let near = |other: &&[f64; 2]| (other[0] - x).abs() < 90.0 && (other[1] - y).abs() < 12.0;
        taken.iter().any(|other| near(&other))
    };
    while meets(y, taken) {
        y += 12.0;
    }
    taken.push([x, y]);
    let text = sign.label.replace('&', "&amp;").replace('<', "&lt;");
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"11\" fill=\"{}\" stroke=\"#ffffff\" stroke-width=\"3\" paint-order=\"stroke\">{text}</text>",
        x + 6.0,
        y - 5.0,
        sign.what.colour()
    );
}
