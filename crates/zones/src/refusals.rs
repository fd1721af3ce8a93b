//! What zones that step apart do not take.

use std::collections::BTreeSet;

use carom_bodies::Rotations;
use carom_contact::Integration;

use crate::error::Error;
use crate::model::{LinkKind, ModelZone, Zoned};
use carom_system::{self as system, ModelBody, ModelLink, Refused};

/// What numbers of inner steps links with multipliers at every inner instant take.
const POINTWISE: &str = "one, or as many as the other zones with more than one: with link = \"gravouil-combescure\" rows Σ C v_j = 0 hold at \
                         every inner instant t_j, which zones with other numbers of steps do not have; link = \"prakash-hjelmstad\" takes any";

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

    /// Refuses schemes of several stages, and those whose velocities the multipliers of links between zones that step apart cannot hold.
    fn check_schemes(&self) -> Result<(), Error> {
        let joined = self.zones_of_rows();
        let linked = |zone: usize| joined.iter().any(|zones| zones.contains(&zone));
        for (k, zone) in self.zones.iter().enumerate() {
            let scheme = zone.scheme.get();
            if scheme.stages().len() > 1 {
                return Err(Error::LinkScheme {
                    zone: zone.name.clone(),
                    scheme: scheme.name(),
                    cause: "its step has stages, each with a balance of its own, and links and contacts between such zones hold at the ends of steps; take equal \
                            steps and one scheme for all zones",
                });
            }
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
        let pointwise = self.kind == LinkKind::GravouilCombescure && !self.links.is_empty();
        let mut many = [None; 2];
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
            let far = zone.far.unwrap_or(zone.substeps);
            for (many, own) in many.iter_mut().zip([zone.substeps, far]) {
                if pointwise && own > 1 && *many.get_or_insert(own) != own {
                    return refuse(POINTWISE);
                }
            }
        }
        Ok(())
    }
}

/// Why zones of unequal steps do not take a contact.
fn refused(zoned: &Zoned, contact: usize) -> Option<&'static str> {
    let of_model = &zoned.model.contacts[contact];
    if let Integration::Weak { .. } = of_model.integration {
        return Some(
            "its multipliers ask for M⁻¹ of both sides at the end of one step, and the steps of the zones end apart; take node or mortar",
        );
    }
    let apart = |zone: &ModelZone| zone.substeps > 1 || zone.far.is_some_and(|far| far > 1);
    let joined = !zoned.links.is_empty() || !zoned.model.constraints.is_empty();
    if zoned.kind == LinkKind::GravouilCombescure && joined && zoned.zones.iter().any(apart) {
        return Some(
            "with link = \"gravouil-combescure\" the step of the outer zones is over before the inner ones begin, Σ C v_j = 0 at each t_j, and a force \
             that stands over the outer step is known at its end; take link = \"prakash-hjelmstad\"",
        );
    }
    if of_model.massless {
        return Some(
            "nodes without mass stay in contact by a law in the gap at the end of each step of their zone, and this contact has one at the end of the \
             outer step alone; take nodes with mass",
        );
    }
    of_model.law.get().projects().then_some(
        "the projection at closure makes the velocity at the end of a step of the zone agree with the contact, and this contact begins at the start of \
         the outer step, whose steps end apart; take projection = false",
    )
}
