//! What a system refuses: surfaces that overlap, schemes that cannot take a mass, a step or a law, and what forces that are
//! not linear exclude.

use carom_bodies::MassKind;
use carom_contact::law::Level;
use carom_contact::{Contact, Initial, Integration};

use crate::contact_pair::ContactPair;
use crate::error::Error;
use crate::modal::NumberedModal;
use crate::model::{ModelBody, ModelContact};
use crate::refused::Refused;
use crate::system::System;

impl System {
    /// Refuses meshes that overlap themselves where a contact with [`Initial::Refuse`] faces itself.
    pub(crate) fn check_overlaps(&self, contacts: &[ModelContact]) -> Result<(), Error> {
        for (k, contact) in contacts.iter().enumerate() {
            if contact.initial != Initial::Refuse {
                continue;
            }
            let inside = self.self_penetrations(k);
            if let Some(&node) = inside.first() {
                return Err(Error::Overlap {
                    contact: contact.name.clone(),
                    points: inside.len(),
                    node,
                });
            }
        }
        Ok(())
    }

    pub(crate) fn check_massless(&self, contacts: &[ModelContact]) -> Result<(), Error> {
        let scheme = self.scheme.get();
        let cause = |contact: &ModelContact| {
            if scheme.is_explicit() {
                Some("an explicit scheme divides by the mass of each node")
            } else if scheme.projects_predictor() {
                Some("the scheme projects its predictor with the mass of the nodes in contact")
            } else if scheme.restores_contact_work() {
                Some("the scheme changes the velocity with the mass of the nodes in contact")
            } else if scheme.needs_lumped_mass() {
                Some("the scheme divides the contact forces by the mass of their nodes")
            } else if contact.law.get().level() != Level::Gap {
                Some(
                    "the rate of a node without mass is no unknown: only the displacement law can hold",
                )
            } else if contact.law.projects() {
                Some("there is no mass on which velocities could be projected, and no need to")
            } else {
                None
            }
        };
        let mut refused = contacts.iter().filter(|contact| contact.massless);
        match refused.find_map(|contact| Some((contact, cause(contact)?))) {
            None => Ok(()),
            Some((contact, cause)) => Err(Error::MasslessContact {
                contact: contact.name.clone(),
                cause,
            }),
        }
    }

    pub(crate) fn check_scheme(&self, zone: usize, bodies: &[ModelBody]) -> Result<(), Error> {
        let scheme = self.schemes[zone].get();
        let of_zone = |body: usize| self.zone_of_body[body] == zone;
        let own = || bodies.iter().enumerate().filter(|(k, _)| of_zone(*k));
        let mut own = own().map(|(_, body)| body).collect::<Vec<_>>().into_iter();
        let mut of_system = self.bodies.iter().enumerate();
        let coupled = of_system.find(|(k, body)| of_zone(*k) && body.couples_mass());
        if scheme.needs_lumped_mass()
            && let Some((_, body)) = coupled
        {
            return Err(Error::ConsistentMass {
                scheme: scheme.name(),
                body: body.name().to_owned(),
            });
        }
        if scheme.needs_lumped_mass()
            && let Some(body) = own.clone().find(|body| body.mass == MassKind::Consistent)
        {
            return Err(Error::ConsistentMass {
                scheme: scheme.name(),
                body: body.spec.name.clone(),
            });
        }
        let lumped = |body: &ModelBody| body.mass == MassKind::Lumped;
        let mut pairs = self.bodies.iter().zip(bodies);
        if let Some((body, _)) = pairs.find(|(body, spec)| lumped(spec) && !body.lumps()) {
            return Err(Error::LumpedBeam {
                body: body.name().to_owned(),
            });
        }
        let dissipates = |body: &&ModelBody| body.spec.material.dissipates();
        if scheme.is_between()
            // a run may end with its static stage, which asks for no stress between two states
            && self.static_steps() == 0
            && let Some(body) = own.find(dissipates)
        {
            let body = body.spec.name.clone();
            return Err(carom_bodies::Error::NoBetween { body }.into());
        }
        let touches = |pair: &&ContactPair| pair.bodies.iter().any(|&body| of_zone(body));
        let mut contacts = self.contacts.iter().filter(touches);
        let refused = |contact: &&ContactPair| !scheme.takes(contact.law.get().level());
        if let Some(contact) = contacts.clone().find(refused) {
            let of_rates = scheme.takes(Level::Rate) && !scheme.is_explicit();
            return Err(match contact.law.get().level() {
                Level::Gap | Level::GapAndRate if of_rates => Error::GapLaw {
                    contact: contact.name.clone(),
                    scheme: scheme.name(),
                },
                Level::Gap => Error::DisplacementLaw {
                    contact: contact.name.clone(),
                },
                Level::Rate | Level::GapAndRate => Error::RateLaw {
                    contact: contact.name.clone(),
                    scheme: scheme.name(),
                },
            });
        }
        let projects = |contact: &&ContactPair| contact.law.projects();
        if let Some(contact) = contacts.find(projects)
            && (scheme.stages().len() > 1 || !scheme.step_map(self.dt).balances_at_the_end())
        {
            return Err(Error::Projection {
                contact: contact.name.clone(),
            });
        }
        if !scheme.is_explicit() {
            return Ok(());
        }
        match self.critical_step() {
            critical if self.dt > critical => Err(Error::Unstable {
                dt: self.dt,
                critical,
            }),
            _ => Ok(()),
        }
    }

    /// Refuses what a model whose forces are not all linear does not accept.
    pub(crate) fn check_nonlinear(&self) -> Result<(), Error> {
        if !self.nonlinear.needed {
            return Ok(());
        }
        let refuse = |what: Refused, why| Err(Error::Nonlinear { what, why });
        self.check_rotations()?;
        let weak = |contact: &Contact| matches!(contact.integration, Integration::Weak { .. });
        for contact in &self.contacts {
            let refused = || Refused::Integration(contact.name.clone());
            if weak(contact) && contact.friction.acts() {
                return refuse(
                    refused(),
                    "the weak form with signs at Gauss points has no friction; take node or mortar",
                );
            }
            let of_rate = contact.law.get().level() == Level::Rate;
            if weak(contact) && of_rate && self.nonlinear.preload.is_some() {
                return refuse(
                    refused(),
                    "in a static stage laws in the rate hold in the gap, for which r of the weak form has another unit; \
                     take node or mortar, or the displacement law",
                );
            }
        }
        for modal in &self.modal {
            if let Some(why) = self.refuses_modal(modal) {
                let name = self.bodies[modal.body].name().to_owned();
                return refuse(Refused::ModalDamping(name), why);
            }
        }
        for (damping, body) in self.nonlinear.damping.iter().zip(&self.bodies) {
            if damping.stiffness != 0.0 && !body.is_linear() {
                let why = match body.has_finite_motion() {
                    true => {
                        "damping proportional to the stiffness would brake rotations at finite strain; take a viscoelastic material"
                    }
                    false => {
                        "damping proportional to the elastic stiffness would resist the flow of the metal; take `damping.mass`"
                    }
                };
                return refuse(Refused::Damping(body.name().to_string()), why);
            }
        }
        Ok(())
    }

    /// Why a body may not have damping of modes, whose matrix is in the factor of its part only where that is made once.
    fn refuses_modal(&self, modal: &NumberedModal) -> Option<&'static str> {
        let part = self.part_of_body[modal.body];
        let same = |body: usize| self.part_of_body[body] == part;
        let nonlinear =
            |&body: &usize| !self.bodies[body].is_linear() || self.nonlinear.has_follower(body);
        let range = &self.parts[part];
        let mut follows = self.nonlinear.follows.iter();
        if (0..self.bodies.len())
            .filter(|&body| same(body))
            .any(|body| nonlinear(&body))
        {
            return Some(
                "it flows, or shares nodes with a body that flows or is at finite strain, a spring with a curve or a pressure that turns with it, whose \
                 matrix is made anew in each iteration; take `damping.mass` and `damping.stiffness`",
            );
        }
        follows.any(|f| range.contains(&(f.unknown as usize))).then_some(
            "a support moves it, and the modes are those about supports at rest; take `base-acceleration`, or `damping.stiffness`",
        )
    }
}
