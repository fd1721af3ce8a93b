//! Which schemes may be in one model, and which contacts such a model takes.
//!
//! A contact force acts on both sides over the whole step. It keeps the momentum where both schemes make the same impulse of
//! it, and one matrix answers for it where the quantity that its law constrains depends on the unknowns of both sides alike.

use carom_contact::law::Level;
use carom_contact::{Contact, Integration};

use crate::error::Error;
use crate::link_row::LinkRow;
use crate::maps::Maps;
use crate::refused::Refused;
use crate::system::System;
use carom_schemes::Scheme;
use carom_schemes::step_map::{Impulse, StepMap};

impl System {
    /// Refuses schemes and contacts that do not go with several schemes.
    pub(crate) fn check_zones(&self) -> Result<(), Error> {
        let maps = Maps::new(self, self.dt, self.dt);
        self.check_links(&maps)?;
        if self.schemes.len() == 1 {
            return Ok(());
        }
        for (scheme, map) in self.schemes.iter().zip(maps.all()) {
            if let Some(cause) = alone(scheme, map) {
                let scheme = scheme.get().name();
                return Err(Error::SchemeAlone { scheme, cause });
            }
        }
        for (k, contact) in self.contacts.iter().enumerate() {
            if let Some(cause) = self.refused_between(k, contact, &maps) {
                let names = self.schemes.iter().map(|scheme| scheme.get().name());
                return Err(Error::BetweenSchemes {
                    contact: contact.name.clone(),
                    schemes: names.collect(),
                    cause,
                });
            }
        }
        Ok(())
    }

    /// Refuses links that the step cannot solve together with the contacts.
    fn check_links(&self, maps: &Maps) -> Result<(), Error> {
        let mut linked = vec![false; self.parts.len()];
        for &(dof, _) in self.links.rows.iter().flatten() {
            linked[self.part_of(dof as usize)] = true;
        }
        let one = |row: &LinkRow| {
            let mut parts = row.iter().map(|(dof, _)| self.part_of(*dof as usize));
            let first = parts.next();
            parts.all(|part| Some(part) == first)
        };
        if self.nonlinear.preload.is_some() && !self.links.rows.iter().all(one) {
            return Err(Error::Nonlinear {
                what: Refused::StaticStage,
                why: "it joins bodies of one scheme only, by constraints; leave out the stage or the links",
            });
        }
        // one matrix answers for contacts and links where multipliers act on all zones in contact alike
        let mut ratio: Option<f64> = None;
        for contact in &self.contacts {
            for &body in &contact.bodies {
                if !linked[self.part_of_body[body]] {
                    continue;
                }
                let zone = self.zone_of_body[body];
                let [_, weight] = maps.link_weights(zone);
                let own = weight / maps.link_row(&maps.all()[zone]).x;
                if (*ratio.get_or_insert(own) / own - 1.0).abs() > 1e-12 {
                    let names = self.schemes.iter().map(|scheme| scheme.get().name());
                    return Err(Error::BetweenSchemes {
                        contact: contact.name.clone(),
                        schemes: names.collect(),
                        cause: "links join bodies of several schemes that have contacts; give the bodies in contact one scheme",
                    });
                }
            }
        }
        Ok(())
    }

    fn refused_between(
        &self,
        number: usize,
        contact: &Contact,
        maps: &Maps,
    ) -> Option<&'static str> {
        let ways = || maps.all().iter().map(|map| map.displacement.x);
        let level = contact.law.get().level();
        if contact.law.projects() {
            return Some("the projection at closure needs one scheme for all bodies");
        }
        if let Integration::Weak { .. } = contact.integration {
            return Some("the weak form needs one scheme for all bodies; take node or mortar");
        }
        let slides_alike = ways().all(|x| Some(x) == ways().next());
        if self.contacts[number].friction.acts() && level != Level::Rate && !slides_alike {
            return Some("friction needs a law in the rate here");
        }
        let contact = &self.contacts[number];
        let zones =
            [contact.secondary_body, contact.primary_body?].map(|body| self.zone_of_body[body]);
        let [one, other] = zones.map(|zone| &maps.all()[zone]);
        if one.contact_impulse != other.contact_impulse {
            return Some(
                "its force would give its two sides different impulses; take schemes that weigh forces in time alike",
            );
        }
        let quantities = [one, other].map(|map| match level {
            Level::Rate => 0.0,
            Level::Gap => map.gap.x,
            Level::GapAndRate => map.compliant()[0].x,
        });
        let alike = quantities[0] == quantities[1];
        (!alike).then_some(
            "the gap answers to forces in another way on each side; take a law in the rate",
        )
    }
}

/// Why a scheme stands by itself.
fn alone(scheme: &Scheme, map: &StepMap) -> Option<&'static str> {
    let plain = |impulse: &Impulse| impulse.gain == 1.0 && impulse.carry == 0.0;
    let scheme = scheme.get();
    if scheme.stages().len() > 1 {
        Some(
            "its step has stages, each with a balance of its own, at whose ends other schemes have none",
        )
    } else if scheme.projects_predictor() || scheme.restores_contact_work() {
        Some("it has a stage of its own with the mass of all bodies")
    } else if scheme.is_between() {
        Some("its forces belong to the way of the step, those of others to an instant")
    } else if map.uses_contact_acceleration() || map.has_memory() || map.contact != 1.0 {
        Some("its contact forces enter the motion in a way of their own")
    } else if !plain(&map.impulse) || !plain(&map.contact_impulse) {
        Some("its forces change the momentum with a memory")
    } else if map.rate.x == 0.0 {
        Some("its rate does not answer to the forces of the step")
    } else {
        None
    }
}
