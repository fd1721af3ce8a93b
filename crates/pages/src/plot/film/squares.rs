//! Many faces in a grid of squares: what lies behind is painted over before anything is written.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::tone::{Flat, SQUARES, Tone, Window, colour};

/// Writes the faces of a frame, the far ones first, as one path for each colour.
pub(super) fn draw(flats: &[Flat], window: &Window, svg: &mut String) {
    let side = window.size[0].max(window.size[1]) / SQUARES;
    let [wide, high] = window.size.map(|length| (length / side).ceil() as usize);
    let mut grid: Vec<Option<Tone>> = vec![None; wide * high];
    for flat in flats {
        let points: Vec<[f64; 2]> = flat
            .points
            .iter()
            .map(|x| window.at(*x))
            .map(|[x, y]| [(x - window.corner[0]) / side, (y - window.corner[1]) / side])
            .collect();
        fill(&points, flat.tone, &mut grid, [wide, high]);
    }
    let mut paths: BTreeMap<Tone, String> = BTreeMap::new();
    for (j, row) in grid.chunks_exact(wide).enumerate() {
        let mut i = 0;
        while i < wide {
            let (first, tone) = (i, row[i]);
            while i < wide && row[i] == tone {
                i += 1;
            }
            if let Some(tone) = tone {
                // writing to a String cannot fail
                let path = paths.entry(tone).or_default();
                let _ = write!(path, "M{first},{j}.5h{}", i - first);
            }
        }
    }
    // in squares, whose borders are then the same numbers from both sides
    let [x, y] = window.corner;
    let _ = writeln!(
        svg,
        "<g transform=\"translate({x:.1},{y:.1}) scale({side:.4})\" fill=\"none\" stroke-width=\"1.1\" \
         shape-rendering=\"crispEdges\">"
    );
    for (tone, path) in paths {
        let _ = writeln!(svg, "<path d=\"{path}\" stroke=\"{}\"/>", colour(tone));
    }
    svg.push_str("</g>\n");
}

/// Sets the squares whose middles lie in a polygon (in squares, downward).
fn fill(points: &[[f64; 2]], tone: Tone, grid: &mut [Option<Tone>], [wide, high]: [usize; 2]) {
    let range = |i: usize| {
        let values = points.iter().map(|x| x[i]);
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        })
    };
    let first = |x: f64, count: usize| ((x - 0.5).ceil().max(0.0) as usize).min(count);
    let [low, top] = range(1);
    for j in first(low, high)..first(top, high) {
        let middle = j as f64 + 0.5;
        let next = points.iter().cycle().skip(1);
        let mut crossings: Vec<f64> = points
            .iter()
            .zip(next)
            .filter(|(a, b)| (a[1] <= middle) != (b[1] <= middle))
            .map(|(a, b)| a[0] + (middle - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
            .collect();
        crossings.sort_unstable_by(f64::total_cmp);
        for pair in crossings.chunks_exact(2) {
            for i in first(pair[0], wide)..first(pair[1], wide) {
                grid[j * wide + i] = Some(tone);
            }
        }
    }
}
