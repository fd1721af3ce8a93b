//! The film strip: six of the instants at equal times.

use carom_dynamics::System;
use carom_pages::plot::{Frame, Scene, film_figure, quantity};

use crate::results::outlines::{Outlines, gap, size};
use crate::results::stills::{FILM, Still, Stills};

/// Displacement, relative to the size of the model, below which the pictures of a linear run would all look the same.
const VISIBLE: f64 = 0.01;

/// The film strip; none in one dimension, none of points and springs alone, and none of a linear run in which nothing is seen to
/// move.
pub(crate) fn film(system: &System, stills: &Stills) -> Option<Result<String, carom_pages::Error>> {
    let all = &stills.kept.equal;
    let moved = |still: &Still| {
        still
            .moved
            .iter()
            .flatten()
            .fold(0.0_f32, |m, u| m.max(u.abs()))
    };
    let largest = f64::from(all.iter().map(moved).fold(0.0, f32::max));
    let is_seen = system.is_nonlinear() || largest > VISIBLE * size(system);
    if system.dim < 2 || all.len() < 2 || !is_seen {
        return None;
    }
    let outlines = Outlines::new(system, |_, _| true);
    if outlines.is_blank() {
        return None;
    }
    let picture = |still: &&Still| match &still.deleted {
        None => frame(still, (system, stills), &outlines),
        Some(deleted) => {
            let outlines = Outlines::new(system, |_, cell| !deleted[cell]);
            frame(still, (system, stills), &outlines)
        }
    };
    let since = all.partition_point(|still| still.time < stills.begin());
    let frames: Vec<Frame> = shown(&all[since..]).iter().map(picture).collect();
    let scene = Scene {
        title: "Motion",
        dim: system.dim,
        field: ("von Mises stress", "Pa"),
        gap: &|time, place| gap(system, time, place),
    };
    Some(film_figure(&scene, &frames))
}

/// Those nearest to instants at equal distances, each once.
fn shown(all: &[Still]) -> Vec<&Still> {
    let (Some(first), Some(last)) = (all.first(), all.last()) else {
        return Vec::new();
    };
    let mut shown: Vec<&Still> = Vec::new();
    for k in 0..=FILM {
        let time = first.time + (last.time - first.time) * k as f64 / FILM as f64;
        let off = |still: &&Still| (still.time - time).abs();
        let nearest = all.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        let next = nearest.filter(|still| shown.last().is_none_or(|s| s.step < still.step));
        shown.extend(next);
    }
    shown
}

/// The picture of an instant.
fn frame(still: &Still, (system, stills): (&System, &Stills), outlines: &Outlines) -> Frame {
    let seen = &stills.seen;
    let place = |node: &u32| {
        let x = system.x[*node as usize];
        let moved = seen
            .node(*node)
            .map_or([0.0; 3], |place| still.moved[place]);
        [0, 1, 2].map(|i| x[i] + f64::from(moved[i]))
    };
    let value = |_: &[u32], cell| {
        let place = seen.cell(cell);
        place.map_or(f64::NAN, |place| f64::from(still.von_mises[place]))
    };
    let frame = Frame {
        time: still.time,
        caption: format!("t = {}", quantity(still.time, "s")),
        marks: still.marks.clone(),
        ..Frame::default()
    };
    outlines.frame(system, &place, &value, frame)
}
