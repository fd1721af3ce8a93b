//! Why a model does not run on several ranks.

use carom_bodies::Solid;
use carom_contact::Integration;

use super::explicit::leapfrog::{Direct, is_leapfrog};
use crate::on_ranks::OnRanks;
use crate::system::{NumberedForce, System};

/// What of a model several ranks do not take; none if they take all of it.
pub fn why_not_on_ranks(system: &System) -> Option<OnRanks> {
    if system.static_steps() > 0 {
        return Some(OnRanks::StaticStage);
    }
    if !system.links.rows.is_empty() {
        return Some(OnRanks::Links);
    }
    if system.has_damping() {
        return Some(OnRanks::Damping);
    }
    for body in &system.bodies {
        let name = body.name().to_owned();
        match body.as_solid().map(Solid::not_shared) {
            None => return Some(OnRanks::Body(name)),
            Some(Some(why)) => return Some(OnRanks::Share(name, why)),
            Some(None) => {}
        }
    }
    let follows =
        |load: &carom_system::NumberedLoad| matches!(load.force, NumberedForce::Follower(..));
    if system.nonlinear.loads.iter().any(follows) {
        return Some(OnRanks::Follower);
    }
    for (number, contact) in system.contacts.iter().enumerate() {
        let weak = matches!(contact.integration, Integration::Weak { .. });
        if weak || system.has_impulses(number) {
            return Some(OnRanks::Contact(contact.name.clone()));
        }
    }
    let map = system.scheme.get().step_map(system.dt);
    let identity = system.scheme.get().energy_identity(system.dt);
    let leapfrog = identity.is_some_and(|identity| is_leapfrog(&map, &identity));
    let fits = system.schemes.len() == 1 && leapfrog && Direct::of(system).is_some();
    (!fits).then_some(OnRanks::Scheme)
}
