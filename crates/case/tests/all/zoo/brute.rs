//! Whether bodies went through each other, by trying: between two accepted states nodes move along straight lines, and at instants in between every
//! piece of one surface is held against every piece of the other.
//!
//! It shares nothing with the certificate: the sides are those of the generator, and a crossing is one of surfaces at an instant, which no plane of
//! separation and no distance from an earlier step tells.
//!
//! A body is not its surface here but one a part of the way from it to the middles of the cells, of a hollow body each side by itself. A brick, whose
//! middle is half its size below a side, has the certificate's core, 1/20 of the size below, at a tenth of that way, a triangle at 0.15, a tetrahedron
//! at a fifth. So bodies that meet at 0.3 of the way have cores in each other, and since they had not at the start, these have crossed. Bodies that do
//! not even meet at 0.02 of the way, less deep than cores against thin bodies are, have cores that never did.
//!
//! A shell is its middle surface. That of two shells in contact are apart by half of both thicknesses, and that of a shell is outside of a solid by half
//! of its own: where middle surfaces go through each other, or through what is looked at of a solid, these have crossed.
//!
//! A body that folds is in itself where pieces of it meet that share no node and no cell.

use super::parts::{Cells, Part, Vec3};

/// Part of the way to the middles of the cells at which surfaces that meet are certain to have crossed.
const DEEP: f64 = 0.3;

/// The same at which those that never meet are certain not to have.
const SHALLOW: f64 = 0.02;

/// Distance of what meets, m: rounding, of bodies of some 0.1 m.
const TOUCH: f64 = 1e-9;

/// Sine, or so, of the angle of an edge with a triangle below which it lies in its plane: rounding.
const PLANE: f64 = 1e-12;

/// Part of the depth of the middle of a cell below its sides that the mean of the middles around a node must have, or a body is hollow.
const HOLLOW: f64 = 0.6;

/// Most instants that are looked at in a step.
const INSTANTS: f64 = 64.0;

/// What the states of a run show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Seen {
    /// Two bodies, or one and itself, are in each other in the step to the state of a number: this, and theirs.
    Crossed(usize, [usize; 2]),
    /// They are apart all the time, or touch.
    Clear,
    /// Neither is certain: they are a little way in each other.
    Between,
}

/// The surface of a body, or a rigid disc in the plane.
#[derive(Clone, Debug)]
pub struct Skin {
    /// Corners of triangles, lines and points.
    pieces: Vec<Vec<usize>>,
    /// Whether it may meet itself.
    folds: bool,
    /// Number of the cell that each piece is of.
    cells: Vec<usize>,
    /// Nodes of the cells around each node; none of beams and shells, whose axis and middle surface are looked at.
    around: Vec<Vec<Vec<usize>>>,
    /// Nodes of the cell of each piece.
    corners: Vec<Vec<usize>>,
    /// Whether the mean of the middles of the cells around some node is not well within the body: then each piece goes to the middle of its own cell.
    is_hollow: bool,
    /// Distance from the pieces at which others are certainly deep inside, m.
    deep: f64,
    /// Distance from the pieces at which others are certainly no crossing, m.
    clear: f64,
    /// Shortest way between two of its nodes, or across its radius, over eight: no way in a step is looked at in longer pieces.
    fine: f64,
}

impl Skin {
    /// That of a part.
    pub fn of(part: &Part) -> Skin {
        let mut pieces = Vec::new();
        for side in part.sides() {
            match side[..] {
                [a, b, c, d] => pieces.extend([vec![a, b, c], vec![a, c, d]]),
                _ => pieces.push(side),
            }
        }
        let has = |node: usize| {
            let cells = part.corners.iter().filter(|cell| cell.contains(&node));
            cells.cloned().collect()
        };
        let nodes = match part.cells.have_section() {
            true => 0,
            false => part.nodes.len(),
        };
        let pairs = pieces.iter().flat_map(|piece| piece.windows(2));
        let edges = pairs.map(|pair| distance(&part.nodes[pair[0]], &part.nodes[pair[1]]));
        let of_cell = |piece: &Vec<usize>| {
            let has_all = |cell: &Vec<usize>| piece.iter().all(|node| cell.contains(node));
            part.corners.iter().position(has_all).unwrap_or_default()
        };
        // the certificate keeps half the radius of a beam, with a tenth of that
        let (deep, clear) = match part.cells {
            Cells::Lines => (0.1 * part.radius, 0.75 * part.radius),
            Cells::Shells => (0.0, part.radius),
            _ => (0.0, 0.0),
        };
        let is_beam = part.cells == Cells::Lines;
        let cells: Vec<usize> = pieces.iter().map(of_cell).collect();
        let corners = cells.iter().map(|cell| part.corners[*cell].clone());
        let skin = Skin {
            around: (0..nodes).map(has).collect(),
            corners: corners.collect(),
            is_hollow: false,
            deep,
            clear,
            fine: match is_beam {
                true => 0.1 * part.radius,
                false => edges.fold(f64::INFINITY, f64::min) / 8.0,
            },
            cells,
            folds: false,
            pieces,
        };
        Skin {
            is_hollow: nodes > 0 && skin.is_hollow_at(&part.nodes),
            ..skin
        }
    }

    /// The same of a body that may meet itself.
    pub fn folding(self) -> Skin {
        Skin {
            folds: true,
            ..self
        }
    }

    /// That of a disc, whose only node is its centre.
    pub fn disc(radius: f64) -> Skin {
        // the certificate keeps nine tenths of the radius, with a tenth of that
        Skin {
            pieces: vec![vec![0]],
            cells: vec![0],
            corners: vec![vec![0]],
            is_hollow: false,
            folds: false,
            around: Vec::new(),
            deep: 0.1 * radius,
            clear: radius,
            fine: 0.1 * radius,
        }
    }

    /// Whether two of its pieces share a node or a cell, or the same is looked at as the other way around.
    fn are_neighbours(&self, one: usize, other: usize) -> bool {
        let shared = |node: &usize| self.pieces[other].contains(node);
        one >= other || self.cells[one] == self.cells[other] || self.pieces[one].iter().any(shared)
    }

    /// The pieces a part of the way to the middles of the cells, where the nodes are at these places.
    fn placed(&self, nodes: &[Vec3], part: f64) -> Vec<Piece> {
        let to =
            |node: &Vec3, middle: &Vec3| [0, 1, 2].map(|i| node[i] + part * (middle[i] - node[i]));
        if self.is_hollow {
            let pieces = self.pieces.iter().zip(&self.corners);
            let own = pieces.map(|(piece, cell)| {
                let middle = middle(cell, nodes);
                Piece::new(piece.iter().map(|&k| to(&nodes[k], &middle)).collect())
            });
            return own.collect();
        }
        let inner: Vec<Vec3> = match self.around.is_empty() {
            true => nodes.to_vec(),
            false => (0..nodes.len())
                .map(|k| to(&nodes[k], &self.middle_around(k, nodes)))
                .collect(),
        };
        let at = |corners: &Vec<usize>| Piece::new(corners.iter().map(|&k| inner[k]).collect());
        self.pieces.iter().map(at).collect()
    }

    /// The mean of the middles of the cells around a node.
    fn middle_around(&self, node: usize, nodes: &[Vec3]) -> Vec3 {
        mean(self.around[node].iter().map(|cell| middle(cell, nodes)))
    }

    /// Whether that is not as deep below the sides as the middles of their cells are.
    fn is_hollow_at(&self, nodes: &[Vec3]) -> bool {
        let is_near = |(piece, cell): (&Vec<usize>, &Vec<usize>)| {
            let from = nodes[piece[0]];
            let [u, v] = match piece[..] {
                [_, b, c] => [b, c].map(|k| minus(&nodes[k], &from)),
                [_, b] => [minus(&nodes[b], &from), [0.0, 0.0, 1.0]],
                _ => return false,
            };
            let normal = cross(&u, &v);
            let depth = |place: &Vec3| dot(&normal, &minus(place, &from));
            let most = depth(&middle(cell, nodes));
            piece
                .iter()
                .any(|&k| depth(&self.middle_around(k, nodes)) / most < HOLLOW)
        };
        self.pieces.iter().zip(&self.corners).any(is_near)
    }
}

/// The mean of the corners of a cell.
fn middle(cell: &[usize], nodes: &[Vec3]) -> Vec3 {
    mean(cell.iter().map(|&k| nodes[k]))
}

/// What the states show of bodies; of each state the places of the nodes of all of them, m. Each body is held against each other one, and one
/// that folds against itself.
///
/// Of steps in parts (`in_parts`, by state) the ends are looked at alone.
pub fn look(skins: &[Skin], states: &[Vec<Vec<Vec3>>], in_parts: &[bool]) -> Seen {
    let boxes: Vec<Vec<Piece>> = states
        .windows(2)
        .map(|step| swept(&step[0], &step[1]))
        .collect();
    let mut seen = Seen::Clear;
    for pair in pairs(skins) {
        let skins = pair.map(|k| &skins[k]);
        let reach = skins[0].clear + skins[1].clear;
        for (number, step) in states.windows(2).enumerate() {
            let [one, other] = pair.map(|k| &boxes[number][k]);
            // what has crossed before needs no look
            if matches!(seen, Seen::Crossed(first, _) if first <= number) {
                break;
            }
            if one.apart(other) <= reach {
                let begin = usize::from(in_parts[number + 1]);
                let ends = [begin, 1].map(|end| pair.map(|k| &step[end][k][..]));
                seen = seen.and(look_at(skins, pair[0] == pair[1], ends), (number + 1, pair));
            }
        }
    }
    seen
}

/// The pairs of bodies to look at, one that folds with itself too.
fn pairs(skins: &[Skin]) -> impl Iterator<Item = [usize; 2]> {
    let all = (0..skins.len()).flat_map(|one| (one..skins.len()).map(move |other| [one, other]));
    all.filter(|[one, other]| one != other || skins[*one].folds)
}

/// What all nodes of each body are in over a step.
fn swept(before: &[Vec<Vec3>], after: &[Vec<Vec3>]) -> Vec<Piece> {
    let bodies = before.iter().zip(after);
    bodies
        .map(|(before, after)| Piece::new([&before[..], &after[..]].concat()))
        .collect()
}

/// What two bodies do in a step, `None` where they are apart: whether they cross.
fn look_at(skins: [&Skin; 2], is_self: bool, [before, after]: [[&[Vec3]; 2]; 2]) -> Option<bool> {
    let fine = skins[0].fine.min(skins[1].fine);
    let count = (motion(before, after) / fine).ceil().clamp(1.0, INSTANTS);
    let mut met = None;
    for instant in 1..=count as usize {
        let part = instant as f64 / count;
        let nodes = [0, 1].map(|k| between(before[k], after[k], part));
        if meet(skins, is_self, &nodes, DEEP) {
            return Some(true);
        }
        if met.is_none() && meet(skins, is_self, &nodes, SHALLOW) {
            met = Some(false);
        }
    }
    met
}

impl Seen {
    /// With what two bodies do in the step to the state of a number.
    fn and(self, met: Option<bool>, (number, pair): (usize, [usize; 2])) -> Seen {
        match (self, met) {
            (_, Some(true)) => Seen::Crossed(number, pair),
            (Seen::Clear, Some(false)) => Seen::Between,
            _ => self,
        }
    }
}

/// Whether all bodies are apart, from each other and from themselves, where their nodes are at these places.
pub fn are_apart(skins: &[Skin], nodes: &[Vec<Vec3>]) -> bool {
    let boxes: Vec<Piece> = nodes
        .iter()
        .map(|nodes| Piece::new(nodes.clone()))
        .collect();
    let mut near = pairs(skins).filter(|[one, other]| {
        boxes[*one].apart(&boxes[*other]) <= skins[*one].clear + skins[*other].clear + TOUCH
    });
    near.all(|pair| {
        let places = pair.map(|k| nodes[k].clone());
        !meet(pair.map(|k| &skins[k]), pair[0] == pair[1], &places, 0.0)
    })
}

/// Whether the bodies meet that are a part of the way to the middles of their cells; those of beams and discs are the thicker the less that is.
fn meet(skins: [&Skin; 2], is_self: bool, nodes: &[Vec<Vec3>; 2], part: f64) -> bool {
    let radius = |skin: &Skin| match part < DEEP {
        true => skin.clear,
        false => skin.deep,
    };
    // between the sides of a hollow body, each by itself, something may hide: only what does not touch it is certain not to
    let part = match part < DEEP && skins.iter().any(|skin| skin.is_hollow) {
        true => 0.0,
        false => part,
    };
    // sides of a fold are nearer than a thickness where it is sharp
    let limit = match is_self {
        true => TOUCH,
        false => radius(skins[0]) + radius(skins[1]) + TOUCH,
    };
    let whole = [0, 1].map(|k| Piece::new(nodes[k].clone()));
    if whole[0].apart(&whole[1]) > limit {
        return false;
    }
    let near = |k: usize| {
        let pieces = skins[k].placed(&nodes[k], part).into_iter().enumerate();
        let near = pieces.filter(|(_, piece)| piece.apart(&whole[1 - k]) <= limit);
        near.collect::<Vec<_>>()
    };
    let [one, other] = [near(0), near(1)];
    let mut pairs = one
        .iter()
        .flat_map(|a| other.iter().map(move |b| (a, b)))
        .filter(|((i, a), (j, b))| {
            a.apart(b) <= limit && !(is_self && skins[0].are_neighbours(*i, *j))
        });
    pairs.any(|((_, a), (_, b))| pieces_apart(&a.corners, &b.corners) <= limit)
}

/// Places with the box around them.
struct Piece {
    corners: Vec<Vec3>,
    min: Vec3,
    max: Vec3,
}

impl Piece {
    fn new(corners: Vec<Vec3>) -> Piece {
        let (mut min, mut max) = (corners[0], corners[0]);
        for corner in &corners {
            for i in 0..3 {
                min[i] = min[i].min(corner[i]);
                max[i] = max[i].max(corner[i]);
            }
        }
        Piece { corners, min, max }
    }

    /// How far the boxes are apart along the axis along which they are farthest, m.
    fn apart(&self, other: &Piece) -> f64 {
        let along = |i: usize| (self.min[i] - other.max[i]).max(other.min[i] - self.max[i]);
        along(0).max(along(1)).max(along(2))
    }
}

/// Distance of two pieces of one to three corners, m; zero where an edge of one goes through the other.
fn pieces_apart(one: &[Vec3], other: &[Vec3]) -> f64 {
    let mut least = f64::INFINITY;
    for a in edges(one) {
        for b in edges(other) {
            least = least.min(edges_apart(&a, &b));
        }
    }
    for (face, points) in [(one, other), (other, one)] {
        let [a, b, c] = face else {
            continue;
        };
        for point in points {
            least = least.min(height_inside([a, b, c], point));
        }
        if edges(points).iter().any(|edge| pierces([a, b, c], edge)) {
            return 0.0;
        }
    }
    least
}

/// The edges of a piece; of a point one without length.
fn edges(piece: &[Vec3]) -> Vec<[Vec3; 2]> {
    match *piece {
        [a, b, c] => vec![[a, b], [b, c], [c, a]],
        [a, b] => vec![[a, b]],
        _ => vec![[piece[0], piece[0]]],
    }
}

/// Distance of two edges, m: that of the closest places `p + s d`, `q + t e` with s and t in [0, 1]. In the plane zero where they cross.
fn edges_apart([p, p_end]: &[Vec3; 2], [q, q_end]: &[Vec3; 2]) -> f64 {
    let (d, e, r) = (minus(p_end, p), minus(q_end, q), minus(p, q));
    let (dd, ee, de, dr, er) = (
        dot(&d, &d),
        dot(&e, &e),
        dot(&d, &e),
        dot(&d, &r),
        dot(&e, &r),
    );
    let part = |over: f64, under: f64| match under > 0.0 {
        true => (over / under).clamp(0.0, 1.0),
        false => 0.0,
    };
    let square = dd * ee - de * de;
    // along parallel edges any place is as near, unless it is beside the other edge
    let first = match square > 1e-12 * dd * ee {
        true => part(de * er - dr * ee, square),
        false => 0.0,
    };
    let second = part(de * first + er, ee);
    let first = part(de * second - dr, dd);
    let at = |s: f64, t: f64| {
        let between = [0, 1, 2].map(|i| r[i] + s * d[i] - t * e[i]);
        dot(&between, &between).sqrt()
    };
    at(first, part(de * first + er, ee))
}

/// Height of a place above a triangle, m; infinite where it is not above its inside.
fn height_inside([a, b, c]: [&Vec3; 3], point: &Vec3) -> f64 {
    let normal = cross(&minus(b, a), &minus(c, a));
    let inside =
        |from: &Vec3, to: &Vec3| dot(&cross(&minus(to, from), &minus(point, from)), &normal) >= 0.0;
    match inside(a, b) && inside(b, c) && inside(c, a) {
        true => dot(&minus(point, a), &normal).abs() / dot(&normal, &normal).sqrt(),
        false => f64::INFINITY,
    }
}

/// Whether an edge goes through a triangle: `a + u (b - a) + v (c - a) = p + t d` with u, v ≥ 0, u + v ≤ 1 and t in [0, 1].
fn pierces([a, b, c]: [&Vec3; 3], [p, end]: &[Vec3; 2]) -> bool {
    let (u_edge, v_edge, d) = (minus(b, a), minus(c, a), minus(end, p));
    let across = cross(&d, &v_edge);
    let determinant = dot(&u_edge, &across);
    // one in the plane of the triangle meets its edges, or ends above it
    let size = [&u_edge, &v_edge, &d]
        .map(|x| dot(x, x))
        .iter()
        .product::<f64>();
    if determinant * determinant <= PLANE * PLANE * size {
        return false;
    }
    let from = minus(p, a);
    let u = dot(&from, &across) / determinant;
    let turned = cross(&from, &u_edge);
    let v = dot(&d, &turned) / determinant;
    let t = dot(&v_edge, &turned) / determinant;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=1.0).contains(&t)
}

/// The most that a node of one body moves relative to one of the other in a step, m, or more.
fn motion(before: [&[Vec3]; 2], after: [&[Vec3]; 2]) -> f64 {
    let ways = |k: usize| {
        let nodes = before[k].iter().zip(after[k]);
        nodes.map(|(from, to)| minus(to, from))
    };
    let drift = mean(ways(1));
    let most = |k: usize| {
        ways(k)
            .map(|way| distance(&way, &drift))
            .fold(0.0, f64::max)
    };
    most(0) + most(1)
}

fn between(before: &[Vec3], after: &[Vec3], part: f64) -> Vec<Vec3> {
    let nodes = before.iter().zip(after);
    let moved = nodes.map(|(from, to)| [0, 1, 2].map(|i| from[i] + part * (to[i] - from[i])));
    moved.collect()
}

fn mean(places: impl Iterator<Item = Vec3>) -> Vec3 {
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    for place in places {
        sum = [0, 1, 2].map(|i| sum[i] + place[i]);
        count += 1.0;
    }
    sum.map(|sum: f64| sum / count)
}

fn minus(a: &Vec3, b: &Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: &Vec3, b: &Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &Vec3, b: &Vec3) -> Vec3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn distance(a: &Vec3, b: &Vec3) -> f64 {
    let between = minus(a, b);
    dot(&between, &between).sqrt()
}
