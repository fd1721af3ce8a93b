use super::*;

/// Unknowns in threes, of the mass 1/(1 + unknown).
fn unknown(k: u32) -> Unknown {
    Unknown {
        first: k - k % 3,
        inverse: f64::from(1 + k),
    }
}

/// Entries of D by their definition.
fn product_of(rows: &[Vec<(u32, f64)>]) -> Vec<f64> {
    let mut entries = Vec::new();
    for one in rows {
        for other in rows {
            let mut sum = 0.0;
            for (i, n) in one {
                let same = other.iter().filter(|(j, _)| i == j);
                sum += same.map(|(_, m)| n * m * unknown(*i).inverse).sum::<f64>();
            }
            entries.push(sum);
        }
    }
    entries
}

fn lumped(width: usize, rows: &[Vec<(u32, f64)>]) -> Lumped {
    let mut lumped = Lumped::default();
    lumped.clear(width);
    for candidate in rows.chunks(width) {
        let parts: Vec<(Vec<u32>, Vec<f64>)> = candidate
            .iter()
            .map(|row| row.iter().copied().unzip())
            .collect();
        lumped.push(parts.iter().map(|(k, n)| (&k[..], &n[..])), unknown);
    }
    lumped.finish();
    lumped
}

/// Products, blocks and bounds of sizes are those of the matrix, for rows with a frame and without. Small integers: exact.
#[test]
fn the_product_of_the_rows_is_the_matrix() {
    let turned = [[2.0, 1.0, 0.0], [-1.0, 2.0, 0.0]];
    let on = |node: u32, weight: f64, k: usize| {
        (0..3).map(move |a| (3 * node + a, weight * turned[k][a as usize]))
    };
    let framed = |k: usize| -> Vec<(u32, f64)> {
        on(0, 4.0, k)
            .chain(on(2, -1.0, k))
            .chain(on(1, -3.0, k))
            .collect()
    };
    let rows = [
        framed(0),
        framed(1),
        vec![(6, 3.0), (0, 1.0), (6, 1.0), (3, 2.0)],
        vec![(4, -1.0), (0, 5.0)],
    ];
    let d = lumped(2, &rows);
    let dense = product_of(&rows);
    let mut entries = Vec::new();
    d.dense(&mut entries);
    assert_eq!(entries, dense);
    for (i, k, l) in [(0, 0, 0), (0, 0, 1), (1, 0, 0), (1, 0, 1), (1, 1, 1)] {
        assert_eq!(d.block(i, k, l), dense[(2 * i + k) * 4 + 2 * i + l]);
    }
    // a frame, three weights; two rows for each of three places; two blocks
    assert_eq!(d.numbers(), 8 + 3 + 2 * 3 * 4 + 2 * 4);
    let (p, mut x, mut sizes) = ([1.0, 0.0, -2.0, 4.0], Vec::new(), Vec::new());
    d.gather(&p, &mut x);
    let of_row = |row: usize| (0..4).map(|j| dense[4 * row + j] * p[j]).sum::<f64>();
    for row in 0..4 {
        assert_eq!(d.along(row, &x), of_row(row));
        assert_eq!(d.along_all(row / 2, &x)[row % 2], of_row(row));
    }
    let mut sum = vec![0.0; x.len()];
    d.add_all(0, &[1.0, 0.0, 0.0], &mut sum);
    d.add_all(1, &[-2.0, 4.0, 0.0], &mut sum);
    assert_eq!(sum, x);
    d.sizes(&p, &mut x, &mut sizes);
    for (row, size) in sizes.iter().enumerate() {
        let own: f64 = (0..4).map(|j| (dense[4 * row + j] * p[j]).abs()).sum();
        assert!(*size >= own, "{size} {own}");
    }
}

/// What differs from a frame by more than rounding keeps its entries.
#[test]
fn rows_that_hardly_have_a_frame_are_kept_as_they_are() {
    for off in [0.0, 1e-9] {
        let row = |k: u32| vec![(k, 1.0), (3 + k, -0.3 + off * f64::from(k))];
        let rows = [row(0), row(1), row(2)];
        let d = lumped(3, &rows);
        let (places, blocks) = (2, 9);
        let entries = if off == 0.0 {
            3 * 4 + places
        } else {
            3 * 4 * places
        };
        assert_eq!(d.numbers(), entries + blocks);
        let mut dense = Vec::new();
        d.dense(&mut dense);
        let exact = product_of(&rows);
        for (d, exact) in dense.iter().zip(&exact) {
            assert!((d - exact).abs() <= 4.0 * f64::EPSILON * exact.abs());
        }
    }
}
