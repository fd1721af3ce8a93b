//! Steps that have factors where iterations were chosen.

use std::mem;

use super::effective::{Effective, Matrices};
use super::part_matrix::part_matrix;
use super::renewal::retire;
use crate::choice;
use crate::costs::Work;
use crate::system::{Maps, Solver, System};

impl Effective {
    /// Lets this step have factors where iterations were chosen for it, not asked for; whether it is so. Iterations may end without
    /// having met the direction along which a tangent is not positive definite: a factor meets it, and another tangent is taken. Passes with friction
    /// may not end where those with D at hand do. `between`: whether internal forces are means over the step.
    pub(super) fn leave_iterations(&mut self, system: &System, maps: &Maps, between: bool) -> bool {
        let chosen = system.nonlinear.iteration.solver == Solver::Auto;
        let Some(now) = self
            .now
            .as_mut()
            .filter(|now| chosen && !now.left && now.solver == Some(Solver::Iterative))
        else {
            return false;
        };
        if now.first == 0 {
            now.left = true;
            now.take_tangent_solver(Solver::Direct, &mut self.retired);
            return true;
        }
        let (key, iterated) = (now.key.clone(), now.iterated.clone());
        let known = self.aside.take().filter(|kept| kept.key == key);
        let Some(factored) = known.or_else(|| {
            if system.tangents() == 0 || !fit(system, maps, between) {
                return None;
            }
            self.made += 1;
            let of = (between, self.made, &self.ranks);
            let made = Matrices::new(system, maps, iterated, of, Some(Solver::Direct)).ok()?;
            Some(Box::new(Matrices { left: true, ..made }))
        }) else {
            return false;
        };
        self.aside = self.now.replace(*factored).map(Box::new);
        true
    }

    /// Goes back to iterations after such a step.
    pub(crate) fn return_to_iterations(&mut self) {
        let Some(now) = self.now.as_mut().filter(|now| now.left) else {
            return;
        };
        if now.first > 0 {
            if let Some(aside) = &mut self.aside {
                mem::swap(now, aside);
            }
            return;
        }
        now.left = false;
        now.take_tangent_solver(Solver::Iterative, &mut self.retired);
    }
}

/// Whether the factors of all parts fit in memory.
fn fit(system: &System, maps: &Maps, between: bool) -> bool {
    system.parts.iter().all(|part| {
        let Some(matrix) = part_matrix(system, part, maps.of(part.start), between) else {
            return true;
        };
        let nodes = &system.unknowns.node_of_each()[part.clone()];
        choice::fits(system, &matrix, nodes).unwrap_or(false)
    })
}

impl Matrices {
    fn take_tangent_solver(&mut self, solver: Solver, retired: &mut Work) {
        self.solver = Some(solver);
        if self.ranks.count() > 1 {
            // a factor takes all rows, iterations some
            self.matrix = None;
        }
        let first = self.first;
        self.compliance.forget(|group| group >= first);
        for group in &mut self.operators.groups[first..] {
            if let Some(operator) = group.operator.take() {
                retire(&operator, retired);
            }
        }
    }
}
