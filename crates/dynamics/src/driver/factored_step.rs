//! Steps that have factors of their tangents where iterations were chosen.

use super::effective::{Effective, Matrices};
use super::renewal::retire;
use crate::costs::Work;
use crate::system::{Solver, System};

impl Effective {
    /// Lets this step have factors of its tangents where iterations were chosen for it, not asked for; whether it is so. Iterations may end without
    /// having met the direction along which a tangent is not positive definite: a factor meets it, and another tangent is taken.
    pub(super) fn leave_iterations(&mut self, system: &System) -> bool {
        let chosen = system.nonlinear.iteration.solver == Solver::Auto;
        let Some(now) = self.now.as_mut().filter(|now| {
            chosen && now.first == 0 && !now.left && now.solver == Some(Solver::Iterative)
        }) else {
            return false;
        };
        now.left = true;
        now.take_tangent_solver(Solver::Direct, &mut self.retired);
        true
    }

    /// Goes back to iterations after such a step.
    pub(super) fn return_to_iterations(&mut self) {
        if let Some(now) = self.now.as_mut().filter(|now| now.left) {
            now.left = false;
            now.take_tangent_solver(Solver::Iterative, &mut self.retired);
        }
    }
}

impl Matrices {
    fn take_tangent_solver(&mut self, solver: Solver, retired: &mut Work) {
        self.solver = Some(solver);
        let first = self.first;
        self.compliance.forget(|group| group >= first);
        for group in &mut self.operators.groups[first..] {
            if let Some(operator) = group.operator.take() {
                retire(&operator, retired);
            }
        }
    }
}
