//! Bodies that are more than boxes: rings, hollows, balls, folded strips and sheets.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::parts::{Cells, Part, Vec3};

/// The plane quadrilaterals of corners (x, z), drawn out along y over a length with its middle at zero, in a number of bricks.
fn drawn(places: &[[f64; 2]], cells: &[[usize; 4]], (length, count): (f64, usize)) -> Part {
    let layer = places.len();
    let mut nodes = Vec::new();
    let mut corners = Vec::new();
    for k in 0..=count {
        let y = (k as f64 / count as f64 - 0.5) * length;
        nodes.extend(places.iter().map(|[x, z]| [*x, y, *z]));
        if k < count {
            // seen against y the corners go round to the left
            let sides = cells.iter().map(|cell| {
                let [front, back] = [k, k + 1].map(|k| cell.map(|node| node + k * layer));
                [back, front].concat()
            });
            corners.extend(sides);
        }
    }
    Part {
        cells: Cells::Bricks,
        nodes,
        corners,
        radius: 0.0,
    }
}

/// A place on a circle around y, at a part of the way round.
fn on_circle(radius: f64, part: f64) -> [f64; 2] {
    let (sin, cos) = (part * TAU).sin_cos();
    [radius * cos, radius * sin]
}

/// A ring around y of straight bricks; radii to its corners.
pub fn ring(inner: f64, outer: f64, length: f64, sides: usize) -> Part {
    let round = (0..sides).map(|k| k as f64 / sides as f64 + 0.5 / sides as f64);
    let places: Vec<[f64; 2]> = round
        .flat_map(|part| [inner, outer].map(|radius| on_circle(radius, part)))
        .collect();
    let at = |k: usize| 2 * (k % sides);
    let cells: Vec<[usize; 4]> = (0..sides)
        .map(|k| [at(k), at(k) + 1, at(k + 1) + 1, at(k + 1)])
        .collect();
    drawn(&places, &cells, (length, 1))
}

/// A hexagonal prism around y, of three bricks in each of its layers; its radius to the corners.
pub fn hexagon(radius: f64, length: f64, layers: usize) -> Part {
    let mut places = vec![[0.0; 2]];
    places.extend((0..6).map(|k| on_circle(radius, f64::from(k) / 6.0)));
    drawn(
        &places,
        &[[0, 1, 2, 3], [0, 3, 4, 5], [0, 5, 6, 1]],
        (length, layers),
    )
}

/// A block with a notch along y, whose bottom is a line at the origin, and whose rims are `half` (m) beside it and `depth` (m) above it.
pub fn notched(half: f64, depth: f64, length: f64) -> Part {
    let below = -0.6 * depth;
    let places = [
        [-2.0 * half, below],
        [-half, below],
        [0.0, below],
        [half, below],
        [2.0 * half, below],
        [-2.0 * half, depth],
        [-half, depth],
        [0.0, 0.0],
        [half, depth],
        [2.0 * half, depth],
    ];
    let cells = [[0, 1, 6, 5], [1, 2, 7, 6], [2, 3, 8, 7], [3, 4, 9, 8]];
    drawn(&places, &cells, (length, 2))
}

/// A bar along y of triangular section with an edge below at the origin; half of its width and its height, m.
pub fn keel(half: f64, height: f64, length: f64) -> Part {
    let places = [
        [0.0, 0.0],
        [half, height],
        [-half, height],
        [0.5 * half, 0.5 * height],
        [0.0, height],
        [-0.5 * half, 0.5 * height],
        [0.0, height / 1.5],
    ];
    let cells = [[0, 3, 6, 5], [3, 1, 4, 6], [5, 6, 4, 2]];
    drawn(&places, &cells, (length, 2))
}

/// A block of side 2 `half` (m) whose top falls from its rim to a hollow in the middle: round as a cone, or with four slopes as a pyramid.
pub fn hollow(half: f64, depth: f64, (count, is_round): (usize, bool)) -> Part {
    let height = 1.5 * depth;
    let block = Part::bricks([2.0 * half, 2.0 * half, height], [count, count, 1]);
    block.mapped(|[x, y, z]| {
        let far = match is_round {
            true => x.hypot(y),
            false => x.abs().max(y.abs()),
        };
        let fall = depth * (1.0 - far / half).max(0.0);
        [x, y, z - (z / height + 0.5) * fall]
    })
}

/// A ball of `count` bricks along each axis, a little square so that its corners are ones.
pub fn ball(radius: f64, count: usize) -> Part {
    Part::bricks([2.0 * radius; 3], [count; 3]).mapped(|x| {
        let far = x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let length = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let round = match length > 0.0 {
            true => far / length,
            false => 1.0,
        };
        x.map(|x| x * (0.2 + 0.8 * round))
    })
}

/// A strip of bricks along a line in the plane of x and z, drawn out along y.
pub fn strip(line: &[[f64; 2]], thickness: f64, (width, count): (f64, usize)) -> Part {
    let along = |from: [f64; 2], to: [f64; 2]| {
        let way = [to[0] - from[0], to[1] - from[1]];
        let length = way[0].hypot(way[1]);
        way.map(|x| x / length)
    };
    let mut places = Vec::new();
    for (k, place) in line.iter().enumerate() {
        let before = match k {
            0 => along(line[0], line[1]),
            _ => along(line[k - 1], *place),
        };
        let after = match line.get(k + 1) {
            Some(next) => along(*place, *next),
            None => before,
        };
        // on both sides along what halves the angle, so far that the thickness stays
        let [x, z] = [-(before[1] + after[1]), before[0] + after[0]];
        let size = 2.0 / (x * x + z * z) * thickness;
        for side in [-0.5, 0.5] {
            places.push([place[0] + side * size * x, place[1] + side * size * z]);
        }
    }
    let cells: Vec<[usize; 4]> = (0..line.len() - 1)
        .map(|k| [2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1])
        .collect();
    drawn(&places, &cells, (width, count))
}

/// The line of a U that lies on its side, open to the right, with its legs `apart` (m).
pub fn line_of_u(leg: f64, apart: f64) -> Vec<[f64; 2]> {
    let half = 0.5 * apart;
    let mut line: Vec<[f64; 2]> = (0..3)
        .map(|k| [leg * (1.0 - f64::from(k) / 3.0), half])
        .collect();
    let bend = (0..=4).map(|k| {
        let (sin, cos) = (FRAC_PI_2 * (1.0 - 0.5 * f64::from(k))).sin_cos();
        [-half * cos, half * sin]
    });
    line.extend(bend);
    line.extend((1..=3).map(|k| [leg * f64::from(k) / 3.0, -half]));
    line
}

/// The line of a Z with three legs, the outer ones of which are at a height (m) above and below zero.
pub fn line_of_z(leg: f64, height: f64) -> Vec<[f64; 2]> {
    let corners = [
        [-0.5 * leg, height],
        [0.5 * leg, height],
        [-0.5 * leg, -height],
        [0.5 * leg, -height],
    ];
    let mut line = vec![corners[0]];
    for pair in corners.windows(2) {
        let between = |part: f64| [0, 1].map(|i| pair[0][i] + part * (pair[1][i] - pair[0][i]));
        line.extend((1..=3).map(|k| between(f64::from(k) / 3.0)));
    }
    line
}

/// A shell in the plane of x and y around the origin.
pub fn sheet(size: [f64; 2], count: [usize; 2], thickness: f64) -> Part {
    let plane = Part::squares(size, count);
    Part {
        cells: Cells::Shells,
        radius: 0.5 * thickness,
        ..plane
    }
}

/// A pyramid of four tetrahedra whose tip, below, is at the origin; half of its width and its height, m.
pub fn pyramid(half: f64, height: f64) -> Part {
    let top = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    let mut nodes: Vec<Vec3> = vec![[0.0; 3], [0.0, 0.0, height]];
    nodes.extend(top.map(|[x, y]| [x * half, y * half, height]));
    let corners = (0..4).map(|k| vec![1, 2 + (k + 1) % 4, 2 + k, 0]);
    Part {
        cells: Cells::Tetrahedra,
        corners: corners.collect(),
        nodes,
        radius: 0.0,
    }
    .oriented()
}

/// A chisel: a wedge of tetrahedra with a straight edge of a length (m) along y, below at the origin.
pub fn chisel(half: f64, height: f64, length: f64) -> Part {
    let mut nodes = Vec::new();
    for y in [-0.5 * length, 0.5 * length] {
        nodes.extend([[0.0, y, 0.0], [half, y, height], [-half, y, height]]);
    }
    Part {
        cells: Cells::Tetrahedra,
        nodes,
        // a prism of the triangles 0 1 2 and 3 4 5
        corners: vec![vec![0, 2, 1, 5], vec![0, 4, 3, 5], vec![0, 1, 4, 5]],
        radius: 0.0,
    }
    .oriented()
}

impl Part {
    /// Of tetrahedra: the same with two corners of those exchanged that are inside out.
    fn oriented(mut self) -> Part {
        for cell in &mut self.corners {
            let from =
                |k: usize| [0, 1, 2].map(|i| self.nodes[cell[k]][i] - self.nodes[cell[0]][i]);
            let [a, b, c] = [from(1), from(2), from(3)];
            let volume = a[0] * (b[1] * c[2] - b[2] * c[1])
                + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]);
            if volume < 0.0 {
                cell.swap(2, 3);
            }
        }
        self
    }
}
