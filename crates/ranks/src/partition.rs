//! The elements of a model shared out to ranks.

/// Shares points with weights out to `ranks`: the part of each. Recursive coordinate bisection (Berger and Bokhari, 1987): the points are
/// cut across the longest side of their box so that weights are as the ranks on the two sides, and each side is cut again. The
/// same points give the same parts in every process.
pub fn partition(points: &[[f64; 3]], weights: &[f64], ranks: usize) -> Vec<u32> {
    let mut parts = vec![0; points.len()];
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    let cut = Cut { points, weights };
    cut.share(&mut order, [0, ranks.max(1)], &mut parts);
    parts
}

struct Cut<'a> {
    points: &'a [[f64; 3]],
    weights: &'a [f64],
}

impl Cut<'_> {
    fn share(&self, own: &mut [u32], [first, end]: [usize; 2], parts: &mut [u32]) {
        if end - first == 1 {
            for &point in own.iter() {
                parts[point as usize] = first as u32;
            }
            return;
        }
        let middle = first + (end - first) / 2;
        let axis = self.longest(own);
        let place = |point: &u32| self.points[*point as usize][axis];
        own.sort_unstable_by(|a, b| place(a).total_cmp(&place(b)).then(a.cmp(b)));
        let total: f64 = own.iter().map(|&point| self.weights[point as usize]).sum();
        let wanted = total * (middle - first) as f64 / (end - first) as f64;
        let (mut sum, mut border) = (0.0, own.len());
        for (k, &point) in own.iter().enumerate() {
            let weight = self.weights[point as usize];
            if sum + 0.5 * weight > wanted {
                border = k;
                break;
            }
            sum += weight;
        }
        let (before, after) = own.split_at_mut(border);
        self.share(before, [first, middle], parts);
        self.share(after, [middle, end], parts);
    }

    /// The axis of the longest side of the box of some points.
    fn longest(&self, own: &[u32]) -> usize {
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for &point in own {
            for (i, x) in self.points[point as usize].iter().enumerate() {
                bounds[0][i] = bounds[0][i].min(*x);
                bounds[1][i] = bounds[1][i].max(*x);
            }
        }
        let side = |i: usize| bounds[1][i] - bounds[0][i];
        let mut axis = 0;
        for i in 1..3 {
            // rounding of equal sides does not choose
            if side(i) > side(axis) * (1.0 + 1e-9) {
                axis = i;
            }
        }
        axis
    }
}

#[cfg(test)]
mod tests {
    use super::partition;

    fn grid(n: usize) -> Vec<[f64; 3]> {
        let of = |k: usize| [k % n, k / n % n, k / n / n].map(|i| i as f64 + 0.5);
        (0..n * n * n).map(of).collect()
    }

    #[test]
    fn a_cube_in_eight_parts_has_eight_cubes() {
        let n = 8;
        let points = grid(n);
        let parts = partition(&points, &vec![1.0; points.len()], 8);
        for part in 0..8 {
            let own: Vec<_> = (0..points.len()).filter(|&k| parts[k] == part).collect();
            assert_eq!(own.len(), 64);
            for axis in 0..3 {
                let along = own.iter().map(|&k| points[k][axis]);
                let (least, most) =
                    along.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
                assert_eq!(most - least, 3.0, "part {part}");
            }
        }
    }

    #[test]
    fn parts_have_equal_weights_to_one_element() {
        let points = grid(9);
        let weights: Vec<f64> = (0..points.len()).map(|k| 1.0 + (k % 5) as f64).collect();
        for ranks in [1, 2, 3, 5, 7] {
            let parts = partition(&points, &weights, ranks);
            let mut sums = vec![0.0; ranks];
            parts
                .iter()
                .zip(&weights)
                .for_each(|(part, w)| sums[*part as usize] += w);
            let mean = weights.iter().sum::<f64>() / ranks as f64;
            // each cut is right to half the largest weight, and halves of halves add up to less than two
            for sum in &sums {
                assert!((sum - mean).abs() <= 2.0 * 5.0, "{ranks}: {sums:?}");
            }
        }
    }

    #[test]
    fn more_ranks_than_elements_leave_ranks_without() {
        let parts = partition(&grid(1), &[1.0], 4);
        assert_eq!(parts.len(), 1);
        assert!(partition(&[], &[], 3).is_empty());
    }
}
