//! Zones as the case says them, names resolved.

use carom_zones::{LinkKind, ModelZone};

use crate::schema::{Case, Link, Scheme};

/// A zone as the case says it, names resolved.
#[derive(Clone, Debug)]
pub(super) struct Zone {
    pub(super) name: String,
    /// Its bodies, by number in the order of their names.
    pub(super) bodies: Vec<usize>,
    pub(super) scheme: Scheme,
    /// Key of the scheme.
    pub(super) scheme_path: String,
    pub(super) substeps: u32,
    /// Steps while nothing can touch.
    pub(super) far: u32,
}

/// Zones, none of them in an ordinary case, and how their joints run.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub(super) zones: Vec<Zone>,
    pub(super) kind: LinkKind,
}

impl Plan {
    /// The zone of a body.
    pub(super) fn zone_of(&self, body: usize) -> Option<usize> {
        self.zones
            .iter()
            .position(|zone| zone.bodies.contains(&body))
    }
    /// Whether a body takes the outer step.
    pub(super) fn is_outer(&self, body: usize) -> bool {
        self.zone_of(body)
            .is_none_or(|zone| self.zones[zone].substeps == 1)
    }

    pub(super) fn model_zones(&self) -> Vec<ModelZone> {
        let zone = |zone: &Zone| ModelZone {
            name: zone.name.clone(),
            bodies: zone.bodies.clone(),
            scheme: zone.scheme,
            substeps: zone.substeps,
            far: Some(zone.far).filter(|far| *far != zone.substeps),
        };
        self.zones.iter().map(zone).collect()
    }
}

/// An overlap or a border, as the case says it.
pub(super) struct Pair<'a> {
    /// Its key.
    pub(super) path: String,
    /// Names of the inner and the outer body.
    pub(super) bodies: [&'a str; 2],
    pub(super) link: Option<Link>,
}

/// Overlaps and borders, in this order.
pub(super) fn pairs(case: &Case) -> impl Iterator<Item = Pair<'_>> {
    let overlaps = case.arlequin.iter().map(|(name, joint)| Pair {
        path: format!("arlequin.{name}"),
        bodies: [&joint.inner, &joint.outer],
        link: joint.link,
    });
    let borders = case.interface.iter().map(|(name, joint)| Pair {
        path: format!("interface.{name}"),
        bodies: [&joint.inner, &joint.outer],
        link: joint.link,
    });
    overlaps.chain(borders)
}
