//! The residual of the parts.

use carom_algebra::unknowns::Kind;

use super::Parts;
use super::pace::Squares;
use crate::driver::attempt::Attempt;

impl Parts {
    /// Squares of what the motion at the start of the step says: of the momentum per step, and of what rounding leaves of forces.
    pub(crate) fn size_of_motion(&self, attempt: &Attempt, squares: &mut Vec<Squares>) {
        let system = &*attempt.system;
        squares.clear();
        squares.resize(system.parts.len(), Squares::default());
        if !attempt.maps.is_static() {
            let add =
                |part: usize, square: f64| squares[part].momentum += square / attempt.dt.powi(2);
            attempt.squares_of_momentum(add);
        }
        for (span, map) in attempt.maps.spans() {
            for i in span {
                let inertia = map.inertia.x * system.mass.lumped[i] * attempt.vectors.x[i];
                squares[system.part_of(i)].inertia_rounding += (f64::EPSILON * inertia).powi(2);
            }
        }
        let add = |unknown: usize, square: f64| {
            let part = system.part_of(unknown);
            squares[part].rounding += (2.0 * f64::EPSILON).powi(2) * square;
        };
        self.squares_of_places(attempt, 1.0, add);
    }

    /// Norm of what rounding of the positions leaves in the internal forces, N. Displacements cannot be told apart within
    /// ε |u|, which changes the force of each unknown by about ε K_ii |u|, at random. Places count from
    /// [`System::origin`](crate::System).
    pub(crate) fn rounding(&self, attempt: &Attempt) -> f64 {
        self.rounding_with(attempt, 1.0)
    }

    /// `places`: factor of the distances from the origin.
    pub(crate) fn rounding_with(&self, attempt: &Attempt, places: f64) -> f64 {
        let mut sum = 0.0;
        self.squares_of_places(attempt, places, |_, square| sum += square);
        2.0 * f64::EPSILON * sum.sqrt()
    }

    /// Squares of the stiffness of each unknown times its place, N². `places`: factor of the distances from the origin.
    fn squares_of_places(&self, attempt: &Attempt, places: f64, add: impl FnMut(usize, f64)) {
        let (system, u) = (&attempt.system, &attempt.state.motion.u);
        let sizes = (0..system.unknowns()).map(|unknown| match system.unknowns.kind(unknown) {
            Kind::Translation(axis) => {
                let x = &system.x[system.unknowns.node(unknown) as usize];
                places * (x[axis] - system.origin[axis]).abs() + u[unknown].abs()
            }
            Kind::Rotation(_) | Kind::Amplitude(_) => u[unknown].abs(),
        });
        self.effective
            .stiffness_squares((system, &attempt.maps), sizes, add);
    }
}
