//! The shift, the runs of Lanczos' method, the count of what they found, and the pairs.

use super::free::Free;
use super::lanczos;
use super::operator::Operator;
use super::problem::{Count, Eigenpairs};
use crate::Error;
use crate::csr::Csr;
use crate::dense_eigen::{eigenpairs, symmetric};
use crate::pattern::Cliques;
use crate::reduce::{dot, norm_squared};
use crate::solver::{QuasiDefinite, SparseRow};

/// Number of unknowns up to which all vectors are computed from a dense matrix.
const DENSE: usize = 240;

/// The same where eigenvectors of a sparse matrix do not converge.
const LARGEST_DENSE: usize = 4000;

/// First shift, over the largest quotient of the diagonals of K and M: K - σ M has a condition of its inverse.
const FIRST_SHIFT: f64 = 1e-9;

/// Eigenvalues below this part of the first shift are rounding.
const RIGID: f64 = 1e-3;

/// Vectors that tell the scale of the lowest frequencies: one more than a body has rigid motions.
const PROBE: usize = 7;

/// Vectors sought beyond those asked for: the count is taken in a gap.
const BEYOND: usize = 4;

/// Relative gap between two eigenvalues in which they can be counted.
const GAP: f64 = 1e-5;

/// Part of the largest eigenvalue below which pairs are refined.
const LOW: f64 = 1e-4;

/// Searches for what the count tells to be missing.
const SEARCHES: usize = 6;

/// Dimension of the space of a search: a number, and a multiple of all pairs sought, however few are missing. Those that are missing lie
/// closest together.
const SPACE: [usize; 2] = [240, 5];

/// Eigenvalues and vectors.
type Pairs = (Vec<f64>, Vec<Vec<f64>>);

pub(super) struct Search<'a> {
    free: &'a Free,
    operator: Operator<'a>,
    shift: f64,
    /// Vectors found, L⁻ᵀ y, and after [`Search::ritz`] the pairs.
    vectors: Vec<Vec<f64>>,
    values: Vec<f64>,
    /// Constraints that are independent.
    independent: Vec<&'a SparseRow>,
    existing: usize,
}

impl<'a> Search<'a> {
    pub(super) fn new(free: &'a Free) -> Result<Self, Error> {
        let scale = free.scale();
        let shift = -FIRST_SHIFT
            * if scale > 0.0 {
                scale
            } else {
                1.0 / FIRST_SHIFT
            };
        let operator = Operator::new(&free.combined(-shift), &free.mass, &free.groups)?;
        let heavy = (0..free.len())
            .filter(|&i| free.mass.get(i, i) > 0.0)
            .count();
        let mut search = Search {
            free,
            operator,
            shift,
            vectors: Vec::new(),
            values: Vec::new(),
            independent: Vec::new(),
            existing: 0,
        };
        for row in &free.constraints {
            if search.take_out(row) {
                search.independent.push(row);
            }
        }
        search.existing = heavy.saturating_sub(search.independent.len());
        Ok(search)
    }

    /// Forgets what was found.
    fn restart(&mut self) -> Result<(), Error> {
        if !self.vectors.is_empty() {
            self.vectors.clear();
            self.values.clear();
            self.operator.refactor(&self.free.combined(-self.shift))?;
            for row in self.independent.clone() {
                self.take_out(row);
            }
        }
        Ok(())
    }

    fn take_out(&mut self, row: &SparseRow) -> bool {
        let mut dense = vec![0.0; self.free.len()];
        for (&i, c) in row.dofs.iter().zip(&row.coefficients) {
            dense[i as usize] += c;
        }
        let y = self.operator.forward(&dense);
        self.operator.take_out(y)
    }

    pub(super) fn run(mut self, count: usize) -> Result<Eigenpairs, Error> {
        let (n, count) = (self.free.len(), count.min(self.existing));
        let sought = count + BEYOND;
        if n <= DENSE || 4 * sought >= n || sought >= self.existing {
            return self.all(count);
        }
        self.find(PROBE)?;
        self.ritz()?;
        if self.choose_shift()? {
            // so far from the first shift they have lost digits
            self.vectors.clear();
            self.values.clear();
        }
        self.find(sought.saturating_sub(self.vectors.len()))?;
        let mut counted = self.counted(count)?;
        let mut searches = 0;
        // each search finds some, or is the last
        while self.vectors.len() < count || counted.exist > counted.found && searches < SEARCHES {
            searches += 1;
            let missing = counted.exist.saturating_sub(counted.found);
            let short = sought.saturating_sub(self.vectors.len());
            if self.find(missing.max(short).max(1))? == 0 {
                break;
            }
            counted = self.counted(count)?;
        }
        match self.vectors.len() < count {
            // those that are missing do not converge
            true if n <= LARGEST_DENSE => self.all(count),
            true => Err(Error::Analysis {
                unknowns: n,
                reason: format!(
                    "{} of {count} eigenvectors have converged; ask for fewer",
                    self.vectors.len()
                ),
            }),
            false => self.conclude(count, counted),
        }
    }

    /// All pairs, from a dense matrix.
    fn all(mut self, count: usize) -> Result<Eigenpairs, Error> {
        let n = self.free.len();
        self.restart()?;
        let (_, vectors) = symmetric(n, &self.operator.dense())?;
        // ascending: the largest 1/(ω² - σ) are the last
        let finite: Vec<&[f64]> = vectors
            .chunks_exact(n.max(1))
            .rev()
            .take(self.existing)
            .collect();
        for y in finite {
            let x = self.operator.backward(y);
            self.vectors.push(x);
        }
        self.ritz()?;
        self.refine()?;
        self.choose_shift()?;
        let counted = Count {
            below: f64::INFINITY,
            exist: self.existing,
            found: self.vectors.len(),
        };
        self.conclude(count, counted)
    }

    /// Takes the rounding of the highest frequencies out of the lowest pairs, by an inverse iteration.
    fn refine(&mut self) -> Result<(), Error> {
        let largest = self.values.last().copied().unwrap_or(0.0);
        let low = self.values.partition_point(|value| *value < LOW * largest);
        let rest = self.vectors.split_off(low);
        for k in 0..low {
            let mut image = vec![0.0; self.free.len()];
            self.free.mass.multiply(&self.vectors[k], &mut image);
            let mut y = self.operator.forward(&image);
            self.operator.project(self.independent.len(), &mut y);
            self.vectors[k] = self.operator.backward(&y);
        }
        let high = self.values.split_off(low);
        self.ritz()?;
        self.values.extend(high);
        self.vectors.extend(rest);
        Ok(())
    }

    /// Seeks vectors beyond those known; how many were found.
    fn find(&mut self, count: usize) -> Result<usize, Error> {
        let count = count.min(self.existing - self.vectors.len());
        if count == 0 {
            return Ok(0);
        }
        let space = SPACE[0].max(SPACE[1] * (self.vectors.len() + count));
        let found = lanczos::largest(&mut self.operator, count, space)?;
        let number = found.len();
        for y in found {
            self.vectors.push(self.operator.backward(&y));
            self.operator.take_out(y);
        }
        Ok(number)
    }

    /// Replaces the vectors by the pairs in their span.
    fn ritz(&mut self) -> Result<(), Error> {
        let vectors = std::mem::take(&mut self.vectors);
        (self.values, self.vectors) = self.pairs_within(vectors)?;
        Ok(())
    }

    /// The pairs of K and M in the span of vectors.
    fn pairs_within(&self, mut vectors: Vec<Vec<f64>>) -> Result<Pairs, Error> {
        let (n, k) = (self.free.len(), vectors.len());
        for x in &mut vectors {
            let mut image = vec![0.0; n];
            self.free.mass.multiply(x, &mut image);
            let norm = dot(x, &image).sqrt();
            x.iter_mut().for_each(|x| *x /= norm);
        }
        let project = |matrix: &Csr| {
            let mut projected = vec![0.0; k * k];
            let mut image = vec![0.0; n];
            for (i, x) in vectors.iter().enumerate() {
                matrix.multiply(x, &mut image);
                for (j, y) in vectors.iter().enumerate().take(i + 1) {
                    let entry = dot(y, &image);
                    (projected[i * k + j], projected[j * k + i]) = (entry, entry);
                }
            }
            projected
        };
        let (stiffness, mass) = (project(&self.free.stiffness), project(&self.free.mass));
        let (values, combinations) = eigenpairs(k, &stiffness, &mass)?;
        let combined = |z: &[f64]| {
            let mut sum = vec![0.0; n];
            for (x, z) in vectors.iter().zip(z) {
                for (sum, x) in sum.iter_mut().zip(x) {
                    *sum += z * x;
                }
            }
            sum
        };
        let vectors = combinations.chunks_exact(k.max(1)).map(combined).collect();
        Ok((values, vectors))
    }

    /// Takes the first frequency that is not zero as the distance of the shift from zero, where the first shift is far closer;
    /// whether it did.
    fn choose_shift(&mut self) -> Result<bool, Error> {
        let deformed = self
            .values
            .iter()
            .find(|value| **value > -RIGID * self.shift);
        let Some(&first) = deformed.filter(|value| **value > -100.0 * self.shift) else {
            return Ok(false);
        };
        self.shift = -first;
        self.operator.refactor(&self.free.combined(first))?;
        for row in self.independent.clone() {
            self.take_out(row);
        }
        Ok(true)
    }

    /// The pairs, and their number up to a gap that is not below number `count`.
    fn counted(&mut self, count: usize) -> Result<Count, Error> {
        self.ritz()?;
        let distance = |value: f64| value - self.shift;
        let values = &self.values;
        let all = values.len();
        let apart = |k: &usize| {
            *k == all || distance(values[*k]) - distance(values[k - 1]) > GAP * distance(values[*k])
        };
        let found = (count.min(all).max(1)..=all).find(apart).unwrap_or(all);
        let last = values[found - 1];
        let mut below = match values.get(found) {
            Some(next) => 0.5 * (last + next),
            None => last + 1e-3 * distance(last),
        };
        let mut inertia = self.inertia(below);
        for _ in 0..2 {
            if inertia.is_ok() {
                break;
            }
            // the value may have met a pivot of zero
            below -= 0.1 * (below - last);
            inertia = self.inertia(below);
        }
        Ok(Count {
            below,
            exist: inertia?,
            found,
        })
    }

    /// Number of eigenvalues below a value.
    fn inertia(&self, below: f64) -> Result<usize, Error> {
        let matrix = self.free.combined(-below);
        let rows = &self.independent;
        if rows.is_empty() {
            return QuasiDefinite::negative_eigenvalues(&matrix, &self.free.groups);
        }
        let n = matrix.n;
        let mut cliques = Cliques::new();
        for i in 0..n {
            let columns = matrix.row(i).0.iter().filter(|&&j| (j as usize) < i);
            columns.for_each(|&j| cliques.push(&[i as u32, j]));
        }
        for (k, row) in rows.iter().enumerate() {
            row.dofs
                .iter()
                .for_each(|&i| cliques.push(&[i, (n + k) as u32]));
        }
        let mut bordered = Csr::from_cliques(n + rows.len(), &cliques);
        let mut groups = self.free.groups.clone();
        for i in 0..n {
            let (columns, values) = matrix.row(i);
            for (&j, value) in columns.iter().zip(values) {
                bordered.add(i, j as usize, *value);
            }
        }
        for (k, row) in rows.iter().enumerate() {
            groups.push(self.free.groups[row.dofs[0] as usize]);
            for (&i, c) in row.dofs.iter().zip(&row.coefficients) {
                bordered.add(i as usize, n + k, -c);
                bordered.add(n + k, i as usize, -c);
            }
        }
        let negative = QuasiDefinite::negative_eigenvalues(&bordered, &groups)?;
        Ok(negative.saturating_sub(rows.len()))
    }

    fn conclude(mut self, count: usize, counted: Count) -> Result<Eigenpairs, Error> {
        self.values.truncate(count);
        self.vectors.truncate(count);
        let bounds = (0..self.values.len()).map(|k| self.bound(k)).collect();
        let mut vectors = self.vectors;
        for x in &mut vectors {
            let largest = x.iter().fold(
                0.0_f64,
                |most, x| {
                    if x.abs() > most.abs() { *x } else { most }
                },
            );
            if largest < 0.0 {
                x.iter_mut().for_each(|x| *x = -*x);
            }
        }
        Ok(Eigenpairs {
            values: self.values,
            vectors,
            bounds,
            shift: self.shift,
            count: counted,
            existing: self.existing,
        })
    }

    /// |P L⁻¹ (K φ - ω² M φ)| over |L⁻¹ (K - σ M) φ|, which is the root of ω² - σ.
    fn bound(&mut self, number: usize) -> f64 {
        let (value, x) = (self.values[number], &self.vectors[number]);
        let [mut residual, mut inertia] = [0, 1].map(|_| vec![0.0; x.len()]);
        self.free.stiffness.multiply(x, &mut residual);
        self.free.mass.multiply(x, &mut inertia);
        for (r, m) in residual.iter_mut().zip(&inertia) {
            *r -= value * m;
        }
        let mut y = self.operator.forward(&residual);
        self.operator.project(self.independent.len(), &mut y);
        (norm_squared(&y) / (value - self.shift)).sqrt()
    }
}
