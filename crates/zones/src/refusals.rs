//! What zones that step apart do not take.

use std::collections::BTreeSet;

use carom_bodies::Rotations;
use carom_contact::Integration;
use carom_contact::law::Level;

use crate::error::Error;
use crate::model::Zoned;
use carom_schemes::step_map::Impulse;
use carom_system::{self as system, Refused};

impl Zoned {
    /// Refuses contacts that zones of unequal steps cannot have between them.
    pub(crate) fn check_across(&self) -> Result<(), Error> {
        for contact in self.contacts_across() {
            if let Some(cause) = refused(self, contact) {
                let [one, other] = self.zones_of(contact);
                return Err(Error::AcrossZones {
                    contact: self.model.contacts[contact].name.clone(),
                    one: self.zones[one].name.clone(),
                    other: self.zones[other].name.clone(),
                    cause,
                });
            }
        }
        Ok(())
    }

    /// Refuses what zones that step apart do not take.
    pub(crate) fn check(&self) -> Result<(), Error> {
        if let Some(constraint) = self.model.constraints.first() {
            return Err(Error::ConstraintInZones {
                constraint: constraint.name.clone(),
            });
        }
        if self.model.nonlinear.preload.is_some() {
            return Err(system::Error::Nonlinear {
                what: Refused::StaticStage,
                why: "links between zones join velocities, which it has none of; leave out the stage or the zones",
            }
            .into());
        }
        self.check_discrete()?;
        self.check_turning()?;
        self.check_schemes()?;
        self.check_steps()
    }

    /// Refuses links whose rows turn.
    fn check_turning(&self) -> Result<(), Error> {
        let mesh = &self.model.mesh;
        let bodies = self.model.bodies.iter();
        let finite =
            bodies.filter(|body| body.spec.kinematics.rotations() == Some(Rotations::Finite));
        let cells = finite.flat_map(|body| &body.spec.cells);
        let nodes: BTreeSet<u32> = cells
            .flat_map(|&cell| mesh.element_nodes(cell))
            .copied()
            .collect();
        let turns = |node: u32| nodes.contains(&node);
        let mut links = self.links.iter();
        match links.find(|link| link.has_arms(mesh.dim, &turns)) {
            None => Ok(()),
            Some(link) => Err(system::Error::Nonlinear {
                what: Refused::TurningLink(link.name.clone()),
                why: "rows that turn join places, not velocities; take equal steps",
            }
            .into()),
        }
    }

    /// Refuses schemes whose velocities the multipliers of links between zones that step apart cannot hold.
    fn check_schemes(&self) -> Result<(), Error> {
        let linked = |zone: usize| self.links.iter().any(|link| link.zones.contains(&zone));
        for (k, zone) in self.zones.iter().enumerate() {
            let scheme = zone.scheme.get();
            let answers = scheme.step_map(self.model.dt).velocity.x != 0.0;
            if linked(k) && !answers {
                return Err(Error::LinkScheme {
                    zone: zone.name.clone(),
                    scheme: scheme.name(),
                    cause: "the velocity at the end of its step does not answer to the forces of the step; take equal steps",
                });
            }
        }
        Ok(())
    }

    /// Refuses numbers of inner steps that do not go together.
    pub(crate) fn check_steps(&self) -> Result<(), Error> {
        let mut many = None;
        for zone in &self.zones {
            let refuse = |accepted| {
                Err(Error::Substeps {
                    zone: zone.name.clone(),
                    found: zone.substeps,
                    accepted,
                })
            };
            if zone.substeps == 0 || zone.far == Some(0) {
                return refuse("at least one");
            }
            if zone.substeps > 1 && *many.get_or_insert(zone.substeps) != zone.substeps {
                return refuse("one, or as many as the other zones with more than one");
            }
        }
        Ok(())
    }
}

/// Why zones of unequal steps do not take a contact.
fn refused(zoned: &Zoned, contact: usize) -> Option<&'static str> {
    let of_model = &zoned.model.contacts[contact];
    if of_model.law.get().level() != Level::Rate {
        return Some("take a law in the rate, or equal steps");
    }
    if of_model.friction > 0.0 {
        return Some("friction needs equal steps");
    }
    if let Integration::Weak { .. } = of_model.integration {
        return Some("the weak form needs equal steps; take node or mortar");
    }
    let plain = |zone: usize| {
        let map = zoned.zones[zone].scheme.get().step_map(zoned.model.dt);
        map.contact_impulse == Impulse::weights(0.0, 1.0) && map.impulse == map.contact_impulse
    };
    match zoned.zones_of(contact).into_iter().all(plain) {
        true => None,
        false => Some(
            "with unequal steps both zones need a scheme whose contact force is a mean over the step: theta or energy-momentum",
        ),
    }
}
