//! What the summary says of reduced bodies and of damped modes.

use std::collections::BTreeMap;

use carom_dynamics::System;

use crate::summary::ReducedBody;

/// Error of a frequency up to which it counts as that of the full body.
const BAND: f64 = 1e-3;

/// What reduced bodies have of their full ones, by body.
pub(super) fn reduced(system: &System) -> BTreeMap<String, ReducedBody> {
    let mut all = BTreeMap::new();
    for (k, body) in system.bodies.iter().enumerate() {
        let Some(body) = body.as_reduced() else {
            continue;
        };
        let (data, total) = (body.reduction(), system.body_mass(k));
        let modes = data.frequencies.len();
        let effective = |mode: usize| {
            let own = data.len() - modes + mode;
            let axes = data.inertia[..system.dim].iter();
            axes.map(|inertia| inertia[own].powi(2) / total).collect()
        };
        let reduced = ReducedBody {
            full_unknowns: data.unknowns.len(),
            retained_nodes: data.retained.len(),
            massless: data.is_massless,
            frequencies: data.frequencies.clone(),
            effective_masses: (0..modes).map(effective).collect(),
            band: data.band(BAND).map(|(_, last)| last),
            residual_mass: data.unmoved.map(|parts| parts[..system.dim].to_vec()),
        };
        all.insert(body.name().to_owned(), reduced);
    }
    all
}

/// Frequency (Hz) and damping ratio of each damped mode, by body.
pub(super) fn damped_modes(system: &System) -> BTreeMap<String, Vec<[f64; 2]>> {
    let name = |body: usize| system.bodies[body].name().to_owned();
    let modal = system.modal.iter();
    modal
        .map(|modal| (name(modal.body), modal.modes.clone()))
        .collect()
}
