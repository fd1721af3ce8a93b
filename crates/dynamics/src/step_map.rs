//! A time scheme as a table of numbers: how everything in a step depends on its one unknown x.

/// Coefficients of one vector of the step, `u` u_k + `v` v_k + `a` a_k + `x` x.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Row {
    /// Factor of the displacement at the start.
    pub u: f64,
    /// Factor of the velocity at the start.
    pub v: f64,
    /// Factor of the acceleration at the start.
    pub a: f64,
    /// Factor of the unknown.
    pub x: f64,
}

impl Row {
    /// Writes the combination of the known vectors, x left out.
    pub fn known(&self, u: &[f64], v: &[f64], a: &[f64], out: &mut [f64]) {
        for i in 0..out.len() {
            out[i] = self.u * u[i] + self.v * v[i] + self.a * a[i];
        }
    }

    /// Writes the whole combination.
    pub fn whole(&self, u: &[f64], v: &[f64], a: &[f64], x: &[f64], out: &mut [f64]) {
        for i in 0..out.len() {
            out[i] = self.u * u[i] + self.v * v[i] + self.a * a[i] + self.x * x[i];
        }
    }
}

/// One step of a scheme: momentum balance `M inertia + f(force) = p_ext + Nᵀ P`, end values and contact quantities.
///
/// The effective matrix is `A = inertia.x M + force.x K`; A and the residual are in N when x is an acceleration, and in
/// N per unit of x otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepMap {
    /// The acceleration that enters the momentum balance.
    pub inertia: Row,
    /// The displacement at which internal forces are taken.
    pub force: Row,
    /// The same displacement as a fraction of the way from u_k to u_{k+1}.
    pub force_fraction: f64,
    /// Displacement at the end of the step.
    pub displacement: Row,
    /// Velocity at the end of the step.
    pub velocity: Row,
    /// Acceleration at the end of the step.
    pub acceleration: Row,
    /// The newest displacement known before x: the configuration from which contact is looked ahead.
    pub placed: Row,
    /// The velocity that a contact law in the rate constrains.
    pub rate: Row,
}
