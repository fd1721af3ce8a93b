//! Where passes over an outer step end: at a tolerance, or at what rounding leaves where they gain no more.

use carom_dynamics::Driver;

/// Defect of a row at which it holds, as a part of the largest velocity.
pub(crate) const TOLERANCE: f64 = 1e-12;

/// Factor of the defect in a pass that gains.
pub(crate) const GAIN: f64 = 0.5;

/// What rounding and the iterations leave in the forces of the zones, N. Passes end there once they gain no more: stiff elements turn the
/// rounding of displacements into velocities far above that of the velocities.
pub(crate) fn rounding(drivers: &[Driver]) -> f64 {
    let left = |driver: &Driver| driver.rounding_of_forces().max(driver.left_over());
    drivers.iter().map(left).fold(0.0, f64::max)
}

/// Largest velocity of all zones, at the end of the step or at its start.
pub(crate) fn speed(drivers: &[Driver]) -> f64 {
    let of =
        |driver: &Driver| largest(&driver.ended().motion.v).max(largest(&driver.state().motion.v));
    drivers.iter().map(of).fold(0.0, f64::max)
}

/// The largest magnitude.
pub(crate) fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}
