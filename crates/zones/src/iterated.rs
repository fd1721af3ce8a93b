//! `H ΔL = r` of zones with several steps, without H: conjugate gradients.
//!
//! H times multipliers is what the linearised zones make of them: their steps from rest under forces that grow to these multipliers over
//! the outer step, and the velocities at its end. H is symmetric, as the motion of one row under the force of another is that of
//! the other under that of the one, in each step. What preconditions is H of zones that take the outer step in one: by the trapezoidal
//! rule, `v = (DT/2) (M + DT²/4 K)⁻¹ Cᵀ ΔL`, whose forces grow linearly over the step, and an explicit zone as if it had no stiffness,
//! so that its rows need no factor. Its rows join the matrices of the implicit zones ([`Joined`]).

use crate::error::Error;
use crate::joined::answer;
use crate::turning::ByZone;
use carom_dynamics::Driver;
use carom_dynamics::condensed::{Answer, Joined};
use carom_dynamics::linearised::{Answered, Growth, LinearZone, Origin, Steps};
use carom_system::LinkRow;

/// Most iterations of a solve. A pass makes up for what they leave.
const MOST: usize = 60;

/// H of zones of unequal steps, by the products with it.
pub(crate) struct IteratedLinks {
    zones: Vec<LinearZone>,
    steps: Vec<Steps>,
    preconditioner: Joined,
    direction: Vec<f64>,
    preconditioned: Vec<f64>,
    image: Vec<f64>,
    change: Vec<f64>,
    /// Velocities and ways of the rows of a zone.
    of_zone: [Vec<f64>; 2],
}

impl IteratedLinks {
    /// # Errors
    /// Redundant rows, an effective matrix that is not positive definite.
    pub(crate) fn new(
        (drivers, origins): (&mut [Driver], &[Origin]),
        (rows, count): (&ByZone, usize),
        (substeps, dt): (&[u32], f64),
    ) -> Result<IteratedLinks, Error> {
        let zones = drivers.iter_mut().zip(origins);
        let zones = zones.map(|(driver, origin)| driver.linearised(origin));
        let zones = zones.collect::<Result<Vec<_>, _>>()?;
        let all = drivers.iter().zip(rows).zip(substeps);
        let answers: Vec<Answer> = all
            .map(|((driver, rows), m)| in_one_step((driver, rows), (*m, dt)))
            .collect();
        let preconditioner = Joined::new(&answers, count)?;
        drop(answers);
        let growth = Growth::Linear;
        let steps = substeps.iter().map(|&count| Steps { count, growth });
        let vector = || vec![0.0; count];
        Ok(IteratedLinks {
            zones,
            steps: steps.collect(),
            preconditioner,
            direction: vector(),
            preconditioned: vector(),
            image: vector(),
            change: vector(),
            of_zone: [vector(), vector()],
        })
    }

    /// Bytes held, without those of the zones. `rows`: their number.
    pub(crate) fn bytes(&self, rows: usize) -> usize {
        self.preconditioner.bytes() + 6 * 8 * rows
    }

    /// ΔL of what the rows miss, in place, until no row misses more than `goal` (m/s) times its norm; returns the products with H that this took.
    ///
    /// # Errors
    /// An effective matrix that is not positive definite.
    pub(crate) fn solve(
        &mut self,
        (drivers, rows): (&mut [Driver], &ByZone),
        (r, norms): (&mut [f64], &[f64]),
        goal: f64,
    ) -> Result<u64, Error> {
        let holds = |r: &[f64]| r.iter().zip(norms).all(|(r, norm)| r.abs() <= goal * norm);
        self.change.fill(0.0);
        let (mut before, mut products) = (0.0, 0);
        for iteration in 0..MOST {
            if holds(r) {
                break;
            }
            self.preconditioned.copy_from_slice(r);
            self.preconditioner.solve(&mut self.preconditioned);
            let now = dot(r, &self.preconditioned);
            let share = if iteration == 0 { 0.0 } else { now / before };
            for (p, z) in self.direction.iter_mut().zip(&self.preconditioned) {
                *p = z + share * *p;
            }
            before = now;
            self.multiply(drivers, rows)?;
            products += 1;
            let curvature = dot(&self.direction, &self.image);
            if curvature <= 0.0 || curvature.is_nan() {
                break;
            }
            let step = now / curvature;
            for i in 0..r.len() {
                self.change[i] += step * self.direction[i];
                r[i] -= step * self.image[i];
            }
        }
        r.copy_from_slice(&self.change);
        Ok(products)
    }

    /// H times the direction.
    fn multiply(&mut self, drivers: &mut [Driver], rows: &ByZone) -> Result<(), Error> {
        self.image.fill(0.0);
        for (k, driver) in drivers.iter_mut().enumerate() {
            let [ends, ways] = &mut self.of_zone;
            let count = rows[k].len();
            let out = Answered {
                ends: &mut ends[..count],
                ways: &mut ways[..count],
            };
            let of = (&rows[k][..], &self.direction[..]);
            driver.answer(&mut self.zones[k], of, self.steps[k], out)?;
            for ((row, _), end) in rows[k].iter().zip(&*ends) {
                self.image[*row as usize] += end;
            }
        }
        Ok(())
    }
}

/// A zone that takes the outer step of `dt` (s) in one, whatever its number of steps.
fn in_one_step<'a>(
    (driver, rows): (&'a Driver, &[(u32, LinkRow)]),
    (steps, dt): (u32, f64),
) -> Answer<'a> {
    let (mass, stiffness, velocity) = driver.effective();
    let of = (driver.system(), rows);
    match (steps, stiffness == 0.0) {
        (1, _) => answer(of, [mass, stiffness], velocity * driver.link_weights()[1]),
        (_, true) => answer(of, [1.0, 0.0], 0.5 * dt),
        (_, false) => answer(of, [1.0, 0.25 * dt * dt], 0.5 * dt),
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
