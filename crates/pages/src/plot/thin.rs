//! Fewer points that look the same: the extremes of each column of pixels.

/// Thins a polyline to at most four points per column, of `columns` equal columns between its first and last
/// abscissa: the first, the lowest, the highest and the last of those that fall in it, in their order. What a pixel
/// shows is kept exactly: no spike disappears, however long the series. Abscissae never decrease.
pub fn thin(points: &[(f64, f64)], columns: usize) -> Vec<(f64, f64)> {
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return Vec::new();
    };
    let width = (last.0 - first.0) / columns as f64;
    if points.len() <= 4 * columns || width <= 0.0 {
        return points.to_vec();
    }
    let column = |point: &(f64, f64)| (((point.0 - first.0) / width) as usize).min(columns - 1);
    points
        .chunk_by(|a, b| column(a) == column(b))
        .flat_map(corners)
        .collect()
}

/// First, lowest, highest and last point, in their order, each once.
fn corners(points: &[(f64, f64)]) -> impl Iterator<Item = (f64, f64)> {
    let order = |a: &usize, b: &usize| points[*a].1.total_cmp(&points[*b].1);
    let lowest = (0..points.len()).min_by(order).unwrap_or(0);
    let highest = (0..points.len()).max_by(order).unwrap_or(0);
    let mut kept = [0, lowest, highest, points.len() - 1];
    kept.sort_unstable();
    (0..4)
        .filter(move |i| *i == 0 || kept[*i] != kept[*i - 1])
        .map(move |i| points[kept[i]])
}

/// The parts of a polyline between two ordinates, cut exactly at them.
pub fn clip(points: &[(f64, f64)], low: f64, high: f64) -> Vec<Vec<(f64, f64)>> {
    let mut parts: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut open = false;
    for pair in points.windows(2) {
        let Some((from, to)) = clip_segment(pair[0], pair[1], low, high) else {
            open = false;
            continue;
        };
        match parts.last_mut() {
            Some(part) if open => part.push(to),
            _ => parts.push(vec![from, to]),
        }
        open = to == pair[1];
    }
    parts
}

/// The part of a segment between two ordinates.
fn clip_segment(
    a: (f64, f64),
    b: (f64, f64),
    low: f64,
    high: f64,
) -> Option<((f64, f64), (f64, f64))> {
    let at = |level: f64| (a.0 + (b.0 - a.0) * (level - a.1) / (b.1 - a.1), level);
    if a.1.max(b.1) < low || a.1.min(b.1) > high {
        return None;
    }
    let inside = |p: (f64, f64)| match p.1 {
        y if y < low => at(low),
        y if y > high => at(high),
        _ => p,
    };
    Some((inside(a), inside(b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::scale::extremes;

    #[test]
    fn thinning_keeps_the_extremes_of_every_column() {
        let points: Vec<(f64, f64)> = (0..100_000)
            .map(|i| {
                (
                    f64::from(i),
                    if i == 54_321 {
                        1e9
                    } else {
                        f64::from(i % 977) - f64::from(i % 13)
                    },
                )
            })
            .collect();
        let columns = 100;
        let thinned = thin(&points, columns);
        assert!(thinned.len() <= 4 * columns);
        assert!(thinned.contains(&(54_321.0, 1e9)));
        assert_eq!(thinned.first(), points.first());
        assert_eq!(thinned.last(), points.last());
        let width = (points[points.len() - 1].0 - points[0].0) / columns as f64;
        let range = |of: &[(f64, f64)], column: usize| {
            extremes(
                of.iter()
                    .filter(|p| (p.0 / width) as usize == column)
                    .map(|p| p.1),
            )
        };
        for column in 0..columns {
            assert_eq!(
                range(&points, column),
                range(&thinned, column),
                "column {column}"
            );
        }
        assert!(thinned.windows(2).all(|pair| pair[0].0 <= pair[1].0));
    }

    #[test]
    fn short_series_and_series_at_one_instant_are_left_alone() {
        let short = [(0.0, 1.0), (1.0, 2.0), (1.0, -2.0)];
        assert_eq!(thin(&short, 10), short);
        let instant = vec![(1.0, 2.0); 100];
        assert_eq!(thin(&instant, 10), instant);
        assert_eq!(thin(&[], 10), []);
    }

    #[test]
    fn a_clipped_spike_is_cut_exactly_at_the_level() {
        let spike = [
            (0.0, 0.0),
            (1.0, 10.0),
            (2.0, 0.0),
            (3.0, -10.0),
            (3.0, 0.5),
        ];
        let parts = clip(&spike, -1.0, 1.0);
        assert_eq!(
            parts,
            [
                vec![(0.0, 0.0), (0.1, 1.0)],
                vec![(1.9, 1.0), (2.0, 0.0), (2.1, -1.0)],
                vec![(3.0, -1.0), (3.0, 0.5)]
            ]
        );
        assert!(clip(&[(0.0, 5.0), (1.0, 6.0)], -1.0, 1.0).is_empty());
    }
}
