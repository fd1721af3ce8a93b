//! What runs over every registered scheme and every law.

use std::sync::Arc;

use carom_contact::Law;
use carom_contact::law::{
    Adhesion, Capture, Crush, Curve, Damped, Hertz, HuntCrossley, Level, Penalty, Restitution, Stop,
};
use carom_dynamics::{Model, Scheme, State, System};
use carom_materials::Elastic;

use crate::Error;
use crate::build::{DISPLACEMENT, PROJECTION, compliance, damped, velocity};
use crate::check::Row;

/// Every law with usual parameters, for elements of the given size in m under a contact of the given area in m²;
/// without the closed field as printed, which is a negative control with a case of its own.
pub(crate) fn laws(
    material: &Elastic,
    size: f64,
    area: f64,
) -> Result<Vec<(&'static str, Law)>, Error> {
    // where the damper may pull, a strong one leaves two statuses possible and the last one decides
    let damped = |part, adhesion| damped(material, size, part, adhesion);
    let penalty = Penalty(Damped {
        stiffness: 0.5 * material.young / size,
        damping: 0.0,
        adhesion: Adhesion::Clip,
    });
    // slopes of 0.5, 0.8 and 1 times E A / h, the two corners below the penetration of usual speeds
    let curve = [[2e-4, 1e-4], [5e-4, 3.4e-4], [1e-3, 8.4e-4]];
    let stop = Stop {
        clearance: 1e-4 * size,
        curve: Curve::new(&curve.map(|[x, f]| [x * size, f * material.young * area]))?,
        crush: Crush::Recovered,
        damping: 0.1 * material.density * (material.young / material.density).sqrt() * area,
        adhesion: Adhesion::Clip,
    };
    // slopes of 1, 0.5 and 0.1 times E A / h
    let crushed = [[1e-4, 1e-4], [3e-4, 2e-4], [1e-3, 2.7e-4]];
    let crushed = Stop {
        curve: Curve::new(&crushed.map(|[x, f]| [x * size, f * material.young * area]))?,
        crush: Crush::Permanent,
        ..stop
    };
    let restitution = Restitution {
        coefficient: 0.5,
        capture: Capture::Half,
    };
    // as stiff as the penalty at a penetration of h/36; at 5 m/s the damper has half the force of the spring
    let hertz = Hertz {
        stiffness: 2.0 * material.young * area / size.powf(1.5),
        exponent: 1.5,
    };
    let hunt_crossley = HuntCrossley {
        spring: hertz,
        damping: 0.1,
    };
    Ok(vec![
        ("displacement", DISPLACEMENT),
        ("displacement, projection", PROJECTION),
        ("damped, clip", damped(0.5, Adhesion::Clip)),
        ("damped, as printed", damped(50.0, Adhesion::AsPrinted)),
        ("velocity, now", velocity(Capture::Now)),
        ("velocity, half", velocity(Capture::Half)),
        ("velocity, full", velocity(Capture::Full)),
        ("velocity, free", velocity(Capture::Free)),
        ("velocity, gap-target", velocity(Capture::GapTarget)),
        ("compliance", compliance(material, 10.0, Capture::Half)),
        ("restitution", Law::Restitution(restitution)),
        ("penalty", Law::Penalty(penalty)),
        ("hertz", Law::Hertz(hertz)),
        ("hunt-crossley", Law::HuntCrossley(hunt_crossley)),
        ("stop", Law::Stop(stop)),
        ("stop, crushed", Law::Stop(crushed)),
    ])
}

/// Whether a scheme cannot take a law: with an explicit one the end displacement does not depend on the force, some know
/// the displacement or the rate alone, and the projection at closure belongs to Newmark's scheme.
pub(crate) fn is_senseless(scheme: Scheme, law: Law) -> bool {
    scheme.get().is_explicit() && law == DISPLACEMENT
        || of_displacement(scheme) && law != DISPLACEMENT
        || matches!(scheme, Scheme::NonsmoothAlpha(_)) && law.get().level() != Level::Rate
        || law.projects() && !matches!(scheme, Scheme::Newmark(_))
}

/// Whether a scheme is made of the displacement law.
fn of_displacement(scheme: Scheme) -> bool {
    match scheme {
        Scheme::Kane(_) | Scheme::ContactStabilised(_) | Scheme::LaursenLove(_) => true,
        Scheme::PaoliSchatzman(scheme) => scheme.restitution > 0.0,
        _ => false,
    }
}

/// Pairs of runs that must end in the same bytes.
#[derive(Default)]
pub(crate) struct Battery {
    pairs: usize,
    different: usize,
    steps: usize,
    different_steps: usize,
    without_contact: usize,
    refused: usize,
    senseless: usize,
}

impl Battery {
    /// The system of a combination, or none where it is refused for its law.
    ///
    /// # Errors
    /// A refusal for another reason.
    pub(crate) fn system(&mut self, model: Model) -> Result<Option<Arc<System>>, Error> {
        let senseless = is_senseless(model.scheme, model.contacts[0].law);
        self.senseless += usize::from(senseless);
        match crate::witness::system(model) {
            Ok(system) => Ok(Some(system)),
            Err(
                carom_system::Error::DisplacementLaw { .. }
                | carom_system::Error::GapLaw { .. }
                | carom_system::Error::RateLaw { .. }
                | carom_system::Error::Projection { .. },
            ) if senseless => {
                self.refused += 1;
                Ok(None)
            }
            Err(error) => Err(error.into()),
        }
    }

    /// Compares two end states byte by byte.
    pub(crate) fn compare(&mut self, one: &State, other: &State) -> Result<(), Error> {
        self.pairs += 1;
        self.different += usize::from(one.to_bytes()? != other.to_bytes()?);
        let mut contacts = one.records.contacts.iter();
        let touched = contacts.any(|contact| contact.first_closing.is_some());
        self.without_contact += usize::from(!touched);
        Ok(())
    }

    /// Compares the ends of one step byte by byte.
    pub(crate) fn compare_step(&mut self, one: &State, other: &State) -> Result<(), Error> {
        self.steps += 1;
        self.different_steps += usize::from(one.to_bytes()? != other.to_bytes()?);
        Ok(())
    }

    /// Rows of the counts; `pairs`: how many had to be compared.
    pub(crate) fn rows(&self, name: &str, pairs: usize) -> Vec<Row> {
        let row =
            |what: &str, value, reference| Row::count(format!("{name}: {what}"), value, reference);
        let mut rows = vec![
            row("pairs compared", self.pairs, pairs),
            row("pairs that differ in a byte", self.different, 0).second_formulation(),
            row("pairs that never touched", self.without_contact, 0),
            row("combinations refused", self.refused, self.senseless),
        ];
        if self.steps > 0 {
            let name = format!("{} single steps that differ in a byte", self.steps);
            rows.push(row(&name, self.different_steps, 0).second_formulation());
        }
        rows
    }
}
