//! Links in explicit steps with lumped mass that meet no contact.

use super::Links;
use crate::condensed::Condensed;
use crate::driver::attempt::Attempt;
use crate::system::System;

impl Links {
    /// Forces of the multipliers, and their part of the forces beside internal ones.
    pub(crate) fn spread_links(&mut self, attempt: &mut Attempt, links: &DirectLinks) {
        let system = &*attempt.system;
        let force = &mut self.force;
        force.resize(system.unknowns(), 0.0);
        for &unknown in &links.unknowns {
            force[unknown as usize] = 0.0;
        }
        for (row, l) in system.links.rows.iter().zip(&self.multipliers.now) {
            for &(dof, c) in row {
                force[dof as usize] += c * l;
            }
        }
        let (beside, end) = (
            &mut attempt.vectors.damping,
            &mut attempt.next.motion.link_force,
        );
        end.resize(system.unknowns(), 0.0);
        for &unknown in &links.unknowns {
            let i = unknown as usize;
            beside[i] -= force[i];
            end[i] = force[i];
        }
    }
}

/// What such links need.
#[derive(Default)]
pub(crate) struct DirectLinks {
    /// C M⁻¹ Cᵀ, from the first step on.
    pub(crate) condensed: Option<Condensed>,
    /// The unknowns of the rows, ascending.
    pub(crate) unknowns: Vec<u32>,
    /// Accelerations without links, m/s², of these unknowns; other entries have no meaning.
    pub(crate) free: Vec<f64>,
}

impl DirectLinks {
    /// None where links turn, or meet a contact.
    pub(crate) fn of(system: &System) -> Option<DirectLinks> {
        let mut unknowns: Vec<u32> = system
            .links
            .rows
            .iter()
            .flatten()
            .map(|(dof, _)| *dof)
            .collect();
        unknowns.sort_unstable();
        unknowns.dedup();
        let meets = |node: u32| {
            let mut own = system.unknowns.of(node);
            own.any(|unknown| unknowns.binary_search(&(unknown as u32)).is_ok())
        };
        let contacts = system.contacts.iter();
        let touched = || contacts.clone().flat_map(|contact| contact.nodes().0);
        // surfaces are renewed where elements are deleted
        let renewed = system.bodies.iter().any(|body| body.has_deletion());
        let apart = unknowns.is_empty() || !renewed && !touched().any(meets);
        (apart && system.links.turning.is_empty()).then_some(DirectLinks {
            unknowns,
            ..DirectLinks::default()
        })
    }

    /// Work on the way from `before` to `after` of forces at the start and the end with these weights, J.
    pub(crate) fn work(&self, weights: [f64; 2], forces: [&[f64]; 2], ways: [&[f64]; 2]) -> f64 {
        let of_unknown = |&unknown: &u32| {
            let i = unknown as usize;
            let force = weights[0] * forces[0][i] + weights[1] * forces[1][i];
            force * (ways[1][i] - ways[0][i])
        };
        self.unknowns.iter().map(of_unknown).sum()
    }

    /// Norm of forces on these unknowns, N.
    pub(crate) fn norm(&self, forces: &[f64]) -> f64 {
        let squares = self.unknowns.iter().map(|&i| forces[i as usize].powi(2));
        squares.sum::<f64>().sqrt()
    }
}
