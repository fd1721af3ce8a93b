//! Straight runs of the axis of a beam, what of them lies in a solid, and where either model ends.

use std::collections::BTreeMap;

use carom_mesh::ElementId;

use super::model::{BeamModels, common};
use crate::error::Error;
use crate::overlap::Region;
use crate::polytope::{cross, dot, sub};

/// Sine of the angle of two elements of one run, and distance from its line in its lengths: rounding of positions.
const STRAIGHT: f64 = 1e-7;
/// Distance of two places that count as the same, in lengths of the run.
const SAME: f64 = 1e-9;

/// Elements of a beam on a straight line.
#[derive(Clone, Debug)]
pub(crate) struct Run {
    pub origin: [f64; 3],
    /// Unit direction.
    pub direction: [f64; 3],
    /// Each element with the places of its first and its second node.
    pub elements: Vec<(usize, [f64; 2])>,
    /// Cells of the solid around the line, by their place in the body, ascending; and the range that each takes up.
    pub solid: Vec<(usize, [f64; 2])>,
    /// What of the line both models have.
    pub spans: Vec<Span>,
}

/// A range of a line that lies in the solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Span {
    /// A connected part of S: where the solid ends, and where the beam ends.
    Shared { from: f64, to: f64 },
    /// In the solid, outside S: the beam has no weight.
    Covered([f64; 2]),
}

impl Run {
    pub fn place(&self, x: &[f64; 3]) -> f64 {
        dot(&sub(x, &self.origin), &self.direction)
    }

    /// Places of the first and the second node of an element.
    pub fn ends_of(&self, element: usize) -> [f64; 2] {
        let ends = self.elements.iter().find(|(e, _)| *e == element);
        ends.map_or([0.0; 2], |(_, ends)| *ends)
    }

    /// The range of an element.
    pub fn range_of(&self, element: usize) -> [f64; 2] {
        let [a, b] = self.ends_of(element);
        [a.min(b), a.max(b)]
    }

    /// The element at a place, with ξ along it.
    pub fn at(&self, s: f64) -> Option<(usize, f64)> {
        let distance = |[a, b]: [f64; 2]| (s - 0.5 * (a + b)).abs() / (b - a).abs();
        let nearest = self
            .elements
            .iter()
            .min_by(|one, other| distance(one.1).total_cmp(&distance(other.1)));
        nearest.map(|&(element, [a, b])| (element, (s - a) / (b - a)))
    }

    fn range(&self) -> [f64; 2] {
        let places = self.elements.iter().flat_map(|(_, ends)| ends);
        places.fold([f64::MAX, f64::MIN], |[l, u], &s| [l.min(s), u.max(s)])
    }
}

/// The straight runs of a beam, with the solid around them within a radius and the spans of the overlap.
pub(crate) fn straight(
    models: &BeamModels,
    reach: f64,
    region: &Region,
) -> Result<Vec<Run>, Error> {
    let mut runs = runs(models);
    for run in &mut runs {
        run.solid = around(models, run, reach);
    }
    let mut ends: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (element, beam) in models.beam.iter().enumerate() {
        for &node in models.mesh.element_nodes(beam.cell) {
            ends.entry(node).or_default().push(element);
        }
    }
    for run in &mut runs {
        let range = run.range();
        let near = SAME * (range[1] - range[0]);
        let filled = merged(run.solid.iter().map(|(_, range)| *range), near);
        let asked = asked(models, run, region, near);
        let mut spans = Vec::new();
        for inside in filled {
            if let Some(stretch) = common(inside, range) {
                refuse_bends(models, run, stretch, &ends)?;
                spans.extend(divided(models, run, (inside, range), &asked)?);
            }
        }
        run.spans = spans;
    }
    Ok(runs)
}

/// Elements grouped by nodes that they share and the line that they are on.
fn runs(models: &BeamModels) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    let mut left: Vec<usize> = (0..models.beam.len()).collect();
    let nodes = |e: usize| models.mesh.element_nodes(models.beam[e].cell);
    while let Some(first) = left.first().copied() {
        let [a, b] = models.beam[first].ends;
        let along = sub(&b, &a);
        let length = dot(&along, &along).sqrt();
        let mut run = Run {
            origin: a,
            direction: along.map(|x| x / length),
            elements: vec![(first, [0.0, length])],
            solid: Vec::new(),
            spans: Vec::new(),
        };
        let mut own: Vec<u32> = nodes(first).to_vec();
        left.retain(|&e| e != first);
        loop {
            let on_line = |x: &[f64; 3]| {
                let off = cross(&sub(x, &run.origin), &run.direction);
                let far = run.place(x).abs().max(length);
                dot(&off, &off).sqrt() <= STRAIGHT * far
            };
            let next = left.iter().copied().find(|&e| {
                nodes(e).iter().any(|node| own.contains(node))
                    && models.beam[e].ends.iter().all(on_line)
            });
            let Some(next) = next else { break };
            let ends = models.beam[next].ends.map(|x| run.place(&x));
            run.elements.push((next, ends));
            own.extend(nodes(next));
            left.retain(|&e| e != next);
        }
        run.elements.sort_by(|a, b| {
            let least = |ends: [f64; 2]| ends[0].min(ends[1]);
            least(a.1).total_cmp(&least(b.1))
        });
        runs.push(run);
    }
    runs
}

/// Cells of the solid whose middle is within a radius of a line, and their ranges along it.
fn around(models: &BeamModels, run: &Run, reach: f64) -> Vec<(usize, [f64; 2])> {
    let mut found = Vec::new();
    for (place, &cell) in models.solid.iter().enumerate() {
        let corners = models.mesh.kind(cell).table().linear.table().nodes;
        let nodes = models.mesh.element_nodes(cell);
        let (mut middle, mut range) = ([0.0; 3], [f64::MAX, f64::MIN]);
        for &node in &nodes[..corners] {
            let x = &models.mesh.nodes[node as usize];
            (0..3).for_each(|i| middle[i] += x[i] / corners as f64);
            let s = run.place(x);
            range = [range[0].min(s), range[1].max(s)];
        }
        let off = cross(&sub(&middle, &run.origin), &run.direction);
        if dot(&off, &off).sqrt() <= reach {
            found.push((place, range));
        }
    }
    found
}

/// Ranges put together where they touch, ascending.
fn merged(ranges: impl Iterator<Item = [f64; 2]>, near: f64) -> Vec<[f64; 2]> {
    let mut all: Vec<[f64; 2]> = ranges.collect();
    all.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut merged: Vec<[f64; 2]> = Vec::new();
    for range in all {
        match merged.last_mut() {
            Some(last) if range[0] <= last[1] + near => last[1] = last[1].max(range[1]),
            _ => merged.push(range),
        }
    }
    merged
}

/// The ranges of a line that a region selects.
fn asked(models: &BeamModels, run: &Run, region: &Region, near: f64) -> Vec<[f64; 2]> {
    match region {
        Region::Intersection => vec![[f64::MIN, f64::MAX]],
        Region::Box { min, max } => {
            let mut range = [f64::MIN, f64::MAX];
            for i in 0..models.mesh.dim {
                let (x, t) = (run.origin[i], run.direction[i]);
                if t.abs() <= STRAIGHT {
                    if x < min[i] || x > max[i] {
                        return Vec::new();
                    }
                    continue;
                }
                let (a, b) = ((min[i] - x) / t, (max[i] - x) / t);
                range = [range[0].max(a.min(b)), range[1].min(a.max(b))];
            }
            vec![range]
        }
        Region::Cells(cells) => {
            let has = |cell: &ElementId| cells.contains(cell);
            let solid = run.solid.iter().filter(|(c, _)| has(&models.solid[*c]));
            let beam = run.elements.iter();
            let beam = beam.filter(|(e, _)| has(&models.beam[*e].cell));
            let beam = beam.map(|(_, [a, b])| [a.min(*b), a.max(*b)]);
            merged(solid.map(|(_, range)| *range).chain(beam), near)
        }
    }
}

/// Refuses elements that meet at an angle inside the solid.
fn refuse_bends(
    models: &BeamModels,
    run: &Run,
    stretch: [f64; 2],
    ends: &BTreeMap<u32, Vec<usize>>,
) -> Result<(), Error> {
    let near = SAME * (stretch[1] - stretch[0]);
    let own = |element: usize| run.elements.iter().any(|(e, _)| *e == element);
    for &(element, places) in &run.elements {
        let nodes = models.mesh.element_nodes(models.beam[element].cell);
        for (node, s) in nodes.iter().zip(places) {
            let inside = s > stretch[0] + near && s < stretch[1] - near;
            let at_end = (s - stretch[0]).abs() <= near || (s - stretch[1]).abs() <= near;
            let meet = &ends[node];
            let bends = meet.iter().any(|&other| !own(other));
            let solid_goes_on = run
                .solid
                .iter()
                .any(|(_, [a, b])| *a < s - near && *b > s + near);
            if bends && (inside || at_end && solid_goes_on) {
                let cells = meet.iter().map(|&e| models.beam[e].cell).collect();
                return Err(Error::Bent { cells });
            }
        }
    }
    Ok(())
}

/// The spans of a range of a line that the solid fills. `filled`: all that the solid fills there; `range`: all of the run.
fn divided(
    models: &BeamModels,
    run: &Run,
    (filled, range): ([f64; 2], [f64; 2]),
    asked: &[[f64; 2]],
) -> Result<Vec<Span>, Error> {
    let near = SAME * (range[1] - range[0]);
    let Some(stretch) = common(filled, range) else {
        return Ok(Vec::new());
    };
    let parts: Vec<[f64; 2]> = asked.iter().filter_map(|a| common(*a, stretch)).collect();
    if parts.is_empty() {
        return Ok(Vec::new());
    }
    // the solid ends where the beam goes on
    let ends = [stretch[0] > range[0] + near, stretch[1] < range[1] - near];
    let cells = || {
        let elements = run.elements.iter().map(|&(e, _)| e);
        let inside = elements.filter(|&e| common(run.range_of(e), stretch).is_some());
        inside.map(|e| models.beam[e].cell).collect()
    };
    let mut spans = Vec::new();
    let mut reached = stretch[0];
    for (k, &[a, b]) in parts.iter().enumerate() {
        let (first, last) = (k == 0, k + 1 == parts.len());
        let at_solid_end = [
            first && ends[0] && a <= stretch[0] + near,
            last && ends[1] && b >= stretch[1] - near,
        ];
        if (first && ends[0] && !at_solid_end[0]) || (last && ends[1] && !at_solid_end[1]) {
            return Err(Error::SolidEndsOutside { cells: cells() });
        }
        if a > reached + near {
            spans.push(Span::Covered([reached, a]));
        }
        spans.push(match at_solid_end {
            [true, false] => Span::Shared { from: a, to: b },
            [false, true] => Span::Shared { from: b, to: a },
            [true, true] => {
                return Err(Error::NoEnd {
                    model: models.beam_is,
                });
            }
            [false, false] => {
                return Err(Error::NoEnd {
                    model: models.solid_is(),
                });
            }
        });
        reached = b;
    }
    if stretch[1] > reached + near {
        spans.push(Span::Covered([reached, stretch[1]]));
    }
    Ok(spans)
}
