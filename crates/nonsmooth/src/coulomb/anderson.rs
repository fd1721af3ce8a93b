//! Sweeps alone creep along forces that D hardly sees; Anderson's mixing takes several sweeps together.
//!
//! A sweep takes the forces x to g(x), and f = g - x is what it changes. With the differences Δf_j and Δg_j of the last sweeps, the forces go
//! on from g - Σ γ_j Δg_j, where γ makes |f - Σ γ_j Δf_j| smallest (Anderson 1965; Walker and Ni 2011): on a linear problem the
//! method of generalised minimal residuals with sweeps as preconditioner, begun anew with a window. What the laws do not allow of such
//! forces the next sweep takes back, and a point where sweeps change nothing stays.

/// Differences that are kept.
const DEPTH: usize = 5;
/// What is left of |Δf|² beside the differences before, relative, from which on a difference says something new.
const NEW: f64 = 1e-8;
/// Growth of |f| from one sweep to the next with which all differences are forgotten.
const GROWTH: f64 = 2.0;

/// The last sweeps.
#[derive(Default)]
pub(super) struct Anderson {
    /// Forces before the sweep, N.
    start: Vec<f64>,
    /// f, g and what is kept of g, after the last sweep; nothing before the first.
    last: [Vec<f64>; 3],
    /// Their differences, of each sweep that is kept, the oldest overwritten.
    differences: [[Vec<f64>; 3]; DEPTH],
    /// Products Δf_i Δf_j, N².
    products: [[f64; DEPTH]; DEPTH],
    /// Differences so far.
    count: usize,
    /// |f|² of the last sweep, N²; infinite before the first.
    square: f64,
}

impl Anderson {
    /// Forgets all sweeps, and takes note of the forces.
    pub fn begin(&mut self, forces: &[f64]) {
        self.count = 0;
        self.square = f64::INFINITY;
        self.note(forces);
    }

    /// Takes note of the forces before a sweep.
    pub fn note(&mut self, forces: &[f64]) {
        self.start.clear();
        self.start.extend_from_slice(forces);
    }

    /// Goes on from the forces after the sweep and from what is kept of them, which is linear in the forces, and takes note of those that it ends with.
    pub fn go_on(&mut self, forces: &mut [f64], kept: &mut [f64]) {
        let mut change = std::mem::take(&mut self.start);
        for (before, now) in change.iter_mut().zip(&*forces) {
            *before = now - *before;
        }
        let square = dot(&change, &change);
        if square > GROWTH * GROWTH * self.square {
            self.count = 0;
        } else if self.square.is_finite() {
            self.keep([&change, forces, kept]);
        }
        self.square = square;
        for (last, now) in self.last.iter_mut().zip([&change, &*forces, &*kept]) {
            last.clear();
            last.extend_from_slice(now);
        }
        self.start = change;
        let held = self.count.min(DEPTH);
        let mut along = [0.0; DEPTH];
        for (along, of) in along.iter_mut().zip(&self.differences[..held]) {
            *along = dot(&of[0], &self.last[0]);
        }
        let shares = least_squares(self.products, along, held);
        for (share, of) in shares.iter().zip(&self.differences[..held]) {
            subtract(*share, &of[1], forces);
            subtract(*share, &of[2], kept);
        }
        self.note(forces);
    }

    /// Keeps what f, g and what is kept of g differ by from those of the last sweep.
    fn keep(&mut self, now: [&[f64]; 3]) {
        let place = self.count % DEPTH;
        self.count += 1;
        let kept = self.differences[place].iter_mut().zip(&self.last);
        for ((difference, last), now) in kept.zip(now) {
            difference.clear();
            difference.extend(now.iter().zip(last).map(|(now, last)| now - last));
        }
        for other in 0..self.count.min(DEPTH) {
            let product = dot(&self.differences[place][0], &self.differences[other][0]);
            self.products[place][other] = product;
            self.products[other][place] = product;
        }
    }
}

/// The γ of the first `n` differences, by elimination in the order of what is left of them; zero of those that say nothing new.
fn least_squares(mut a: [[f64; DEPTH]; DEPTH], mut b: [f64; DEPTH], n: usize) -> [f64; DEPTH] {
    let sizes: [f64; DEPTH] = std::array::from_fn(|i| a[i][i]);
    let mut order = [0; DEPTH];
    let mut rank = 0;
    while rank < n {
        let left = (0..n).filter(|i| !order[..rank].contains(i));
        let left = left.filter(|&i| a[i][i] > NEW * sizes[i]);
        let Some(pivot) =
            left.max_by(|&i, &j| (a[i][i] / sizes[i]).total_cmp(&(a[j][j] / sizes[j])))
        else {
            break;
        };
        order[rank] = pivot;
        rank += 1;
        for row in (0..n).filter(|row| !order[..rank].contains(row)) {
            let share = a[row][pivot] / a[pivot][pivot];
            for column in 0..n {
                a[row][column] -= share * a[pivot][column];
            }
            b[row] -= share * b[pivot];
        }
    }
    let mut x = [0.0; DEPTH];
    for (place, &row) in order[..rank].iter().enumerate().rev() {
        let known: f64 = order[place + 1..rank]
            .iter()
            .map(|&j| a[row][j] * x[j])
            .sum();
        x[row] = (b[row] - known) / a[row][row];
    }
    x
}

/// Σ a_i b_i, in lanes.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    const LANES: usize = 8;
    let ((a, rest_a), (b, rest_b)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let mut sums = [0.0; LANES];
    for (a, b) in a.iter().zip(b) {
        for i in 0..LANES {
            sums[i] += a[i] * b[i];
        }
    }
    let rest: f64 = rest_a.iter().zip(rest_b).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

fn subtract(share: f64, of: &[f64], from: &mut [f64]) {
    for (from, of) in from.iter_mut().zip(of) {
        *from -= share * of;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Σ_j a_ij x_j = b_i of three unknowns by sweeps that change each x_i by its own equation.
    fn sweep(x: &mut [f64; 3]) {
        let (a, b) = (
            [[2.0, -0.9, 0.3], [-0.9, 1.0, 0.2], [0.3, 0.2, 0.5]],
            [1.0, 2.0, 3.0],
        );
        for i in 0..3 {
            let others: f64 = (0..3).filter(|&j| j != i).map(|j| a[i][j] * x[j]).sum();
            x[i] = (b[i] - others) / a[i][i];
        }
    }

    /// The residual of a linear problem of n unknowns is zero once n differences are known (Walker and Ni 2011, theorem 2.2): four sweeps to know
    /// three differences, and one more that shows it.
    #[test]
    fn a_linear_problem_ends_with_as_many_differences_as_unknowns() {
        let (mut x, mut kept) = ([0.0; 3], [0.0; 3]);
        let mut anderson = Anderson::default();
        anderson.begin(&x);
        for _ in 0..4 {
            sweep(&mut x);
            kept = x.map(|x| 2.0 * x);
            anderson.go_on(&mut x, &mut kept);
        }
        for (x, kept) in x.iter().zip(kept) {
            assert!((2.0 * x - kept).abs() < 1e-12, "what is kept is linear");
        }
        let before = x;
        sweep(&mut x);
        for (now, before) in x.iter().zip(before) {
            assert!((now - before).abs() < 1e-10, "{now} {before}");
        }
    }

    /// Of two equal differences one is enough.
    #[test]
    fn a_difference_that_says_nothing_new_has_no_share() {
        let mut products = [[0.0; DEPTH]; DEPTH];
        for row in &mut products[..2] {
            row[..2].fill(4.0);
        }
        let shares = least_squares(products, [2.0, 2.0, 0.0, 0.0, 0.0], 2);
        assert_eq!(shares.iter().sum::<f64>(), 0.5);
        assert!(shares.contains(&0.5));
    }
}
