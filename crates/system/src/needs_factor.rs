//! Models that iterations do not take.

use carom_contact::Integration;
use carom_contact::law::Law;

use crate::error::Error;
use crate::refused::Refused;
use crate::solver::Solver;
use crate::system::System;

impl System {
    /// Why implicit steps of this model need a factor; none if iterations do too.
    pub fn needs_factor(&self) -> Option<&'static str> {
        let law = |of: fn(&Law) -> bool| self.contacts.iter().any(|contact| of(&contact.law));
        let impulses = (0..self.contacts.len()).any(|contact| self.has_impulses(contact));
        let reasons = [
            (!self.links.rows.is_empty(), "links, ties and constraints"),
            (!self.modal.is_empty(), "damping of modes"),
            (self.nonlinear.preload.is_some(), "a static stage"),
            (self.schemes.len() > 1, "zones"),
            (
                impulses,
                "contacts with impulses beside the forces of the step",
            ),
            (law(|law| matches!(law, Law::Damped(_))), "the damped law"),
            (
                self.contacts
                    .iter()
                    .any(|contact| matches!(contact.integration, Integration::Weak { .. })),
                "the weak form of a law",
            ),
        ];
        let mut given = reasons.into_iter().filter(|(given, _)| *given);
        given.next().map(|(_, reason)| reason)
    }

    /// Refuses iterations where a factor is needed.
    pub(crate) fn check_solver(&self) -> Result<(), Error> {
        if self.nonlinear.iteration.solver != Solver::Iterative {
            return Ok(());
        }
        let explicit = self.schemes.iter().all(|scheme| scheme.get().is_explicit());
        let why = match (explicit, self.needs_factor()) {
            (true, _) => "an explicit scheme has no equations to solve",
            (_, Some(why)) => why,
            (_, None) => return Ok(()),
        };
        Err(Error::Nonlinear {
            what: Refused::Iterative,
            why,
        })
    }
}
