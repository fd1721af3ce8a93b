//! What zones that step apart do not take.

use std::collections::BTreeSet;

use carom_bodies::Rotations;
use carom_contact::Integration;
use carom_contact::law::Level;

use crate::error::Error;
use crate::model::{LinkKind, ModelZone, Zoned};
use carom_schemes::step_map::Impulse;
use carom_system::{self as system, ModelBody, ModelLink, Refused};

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

    /// Nodes of bodies with finite rotations.
    pub(crate) fn turning_nodes(&self) -> BTreeSet<u32> {
        self.nodes_of_bodies(|body| body.spec.kinematics.rotations() == Some(Rotations::Finite))
    }

    fn nodes_of_bodies(&self, which: impl Fn(&ModelBody) -> bool) -> BTreeSet<u32> {
        let mesh = &self.model.mesh;
        let bodies = self.model.bodies.iter().filter(|body| which(body));
        let cells = bodies.flat_map(|body| &body.spec.cells);
        let nodes = cells.flat_map(|&cell| mesh.element_nodes(cell));
        nodes.copied().collect()
    }

    /// Refuses what links whose rows turn do not take.
    fn check_turning(&self) -> Result<(), Error> {
        let turning = self.turning_nodes();
        let mut links = self.links.iter();
        let turns =
            |link: &&ModelLink| link.has_arms(self.model.mesh.dim, &|node| turning.contains(&node));
        let Some(link) = links.find(turns) else {
            return Ok(());
        };
        let refuse = |link: &ModelLink, why| {
            let what = Refused::TurningLink(link.name.clone());
            Err(system::Error::Nonlinear { what, why }.into())
        };
        let apart = |zone: &ModelZone| zone.substeps > 1 || zone.far.is_some_and(|far| far > 1);
        if self.kind == LinkKind::GravouilCombescure && self.zones.iter().any(apart) {
            return refuse(
                link,
                "rows that turn hold at the end of the outer step, where the places of both sides are known; take link = \
                 \"prakash-hjelmstad\", or equal steps",
            );
        }
        let stiff = self.nodes_of_bodies(|body| {
            let turns = body.spec.kinematics.rotations() == Some(Rotations::Finite);
            !turns && body.spec.material.finite().is_none()
        });
        let small = |link: &ModelLink| {
            let rows = link.rows.iter();
            let mut terms = rows.flat_map(|row| row.inner.iter().chain(&row.outer));
            terms.any(|term| stiff.contains(&term.node))
        };
        let mut links = self.links.iter().filter(turns);
        match links.find(|link| small(link)) {
            None => Ok(()),
            Some(link) => refuse(
                link,
                "a body at small strain does not turn; give it a material at finite strain",
            ),
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
    if of_model.friction.acts() {
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
