//! Baseline correction: a record whose ground comes back to rest where it was.

use crate::error::Error;
use crate::record::Record;

/// Fewest points of a record for which two corrections are independent.
const LEAST: usize = 5;

/// The record minus c₁ b₁(τ) + c₂ b₂(τ), with τ from 0 to 1 over its duration and b₁ = τ (1 - τ), b₂ = τ (1 - τ) (1 - 2 τ) taken
/// at the points, such that velocity and displacement at the end are zero. The first and the last acceleration do not
/// change. The final values are those of [`Record::integrals`], so the correction is exact but for rounding.
///
/// # Errors
/// Fewer than five points.
pub fn corrected(record: &Record) -> Result<Record, Error> {
    let points = record.points();
    if points.len() < LEAST {
        return Err(Error::TooShort {
            points: points.len(),
            least: LEAST,
        });
    }
    let (start, duration) = (points[0][0], record.duration());
    let base = |which: usize| -> Vec<f64> {
        let value = |point: &[f64; 2]| {
            let tau = (point[0] - start) / duration;
            tau * (1.0 - tau) * [1.0, 1.0 - 2.0 * tau][which]
        };
        points.iter().map(value).collect()
    };
    let bases = [base(0), base(1)];
    let with = |values: &dyn Fn(usize) -> f64| {
        let point = |(k, point): (usize, &[f64; 2])| [point[0], values(k)];
        Record::new(points.iter().enumerate().map(point).collect())
    };
    let drifts = [
        with(&|k| bases[0][k])?.drift(),
        with(&|k| bases[1][k])?.drift(),
    ];
    let [[v0, u0], [v1, u1]] = drifts;
    let determinant = v0 * u1 - v1 * u0;
    let mut values: Vec<f64> = points.iter().map(|point| point[1]).collect();
    // the second time takes away what rounding has left
    for _ in 0..2 {
        let [v, u] = with(&|k| values[k])?.drift();
        let c = [
            (v * u1 - v1 * u) / determinant,
            (v0 * u - v * u0) / determinant,
        ];
        for (k, value) in values.iter_mut().enumerate() {
            *value -= c[0] * bases[0][k] + c[1] * bases[1][k];
        }
    }
    with(&|k| values[k])
}

#[cfg(test)]
mod tests {
    use carom_testing::Random;

    use super::*;

    #[test]
    fn a_corrected_record_ends_at_rest_where_it_began() {
        let mut random = Random(7);
        let step = 0.01;
        let noise = (0..2001).map(|k| [step * f64::from(k), random.between(-3.0, 3.0)]);
        let record = Record::new(noise.collect()).unwrap();
        let corrected = corrected(&record).unwrap();
        let integrals = corrected.integrals();
        let peak = |which: usize| {
            integrals
                .iter()
                .fold(0.0, |m: f64, i| m.max(i[which].abs()))
        };
        let [v, u] = corrected.drift();
        // rounding of sums of two thousand terms
        assert!(v.abs() < 1e-13 * peak(0), "{v} of {}", peak(0));
        assert!(u.abs() < 1e-13 * peak(1), "{u} of {}", peak(1));
        assert_eq!(corrected.points()[0], record.points()[0]);
        assert_eq!(corrected.points()[2000], record.points()[2000]);
    }

    #[test]
    fn too_few_points_are_refused() {
        let record = Record::new(vec![[0.0, 1.0], [1.0, 2.0]]).unwrap();
        assert_eq!(
            corrected(&record),
            Err(Error::TooShort {
                points: 2,
                least: 5
            })
        );
    }
}
