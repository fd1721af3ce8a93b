//! The mediator of a beam and a solid along the axis.

use carom_mesh::Mesh;

use super::model::{BeamCell, common};
use super::overlap::Part;
use super::runs::Run;

/// Part of the distance of two nodes of the mediator below which what is left at an end of S gets none of its own.
const REST: f64 = 0.5;

/// The nodes of the mediator in a part of S: those of the beam, at least a cell of the coarser model apart; and one for an end that is far
/// from the nearest of them.
pub(super) fn stations(
    mesh: &Mesh,
    run: &Run,
    part: &Part,
    beam: &[BeamCell],
    coarser: f64,
) -> Vec<(u32, f64)> {
    let range = part.range();
    let sign = (part.from - part.to).signum();
    // places from the end of the beam on
    let length = range[1] - range[0];
    let mut nodes: Vec<(u32, f64)> = Vec::new();
    for &(element, ends) in &run.elements {
        if common(run.range_of(element), range).is_none() {
            continue;
        }
        for (&node, s) in mesh.element_nodes(beam[element].cell).iter().zip(ends) {
            let near = (node, sign * (s - part.to));
            if !nodes.iter().any(|known| known.0 == node) {
                nodes.push(near);
            }
        }
    }
    nodes.sort_by(|a, b| a.1.total_cmp(&b.1));
    let near = 1e-9 * length;
    let mut taken: Vec<(u32, f64)> = Vec::new();
    let mut rest: Vec<(u32, f64)> = Vec::new();
    for (node, d) in nodes {
        let inside = d >= -near && d <= length + near;
        let apart = taken
            .last()
            .is_none_or(|last| d - last.1 >= (1.0 - 1e-6) * coarser);
        match inside && apart {
            true => taken.push((node, d)),
            false => rest.push((node, d)),
        }
    }
    for end in [0.0, length] {
        let far = taken.iter().all(|t| (t.1 - end).abs() > REST * coarser);
        let nearest = rest.iter().enumerate();
        let nearest = nearest.min_by(|a, b| (a.1.1 - end).abs().total_cmp(&(b.1.1 - end).abs()));
        if let (true, Some((place, _))) = (far, nearest) {
            taken.push((rest.swap_remove(place).0, end));
        }
    }
    let mut stations: Vec<(u32, f64)> = taken
        .into_iter()
        .map(|(node, d)| (node, part.to + sign * d))
        .collect();
    stations.sort_by(|a, b| a.1.total_cmp(&b.1));
    stations
}

/// The functions of the mediator that are not zero at a place, at most two, with their values.
pub(super) fn hats(stations: &[(u32, f64)], s: f64) -> [(usize, f64); 2] {
    let last = stations.len() - 1;
    let after = stations.partition_point(|station| station.1 <= s);
    if after == 0 || after > last {
        return [(after.min(last), 1.0), (0, 0.0)];
    }
    let (a, b) = (stations[after - 1].1, stations[after].1);
    let t = (s - a) / (b - a);
    [(after - 1, 1.0 - t), (after, t)]
}
