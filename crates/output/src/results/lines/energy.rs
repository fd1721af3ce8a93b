//! The balance of energy.

use carom_contact::Law;
use carom_pages::form::Form;

use crate::results::lines::resolution::has_waves;
use crate::results::lines::{Evidence, Finding, worst};
use crate::verdict::{Bounds, Line};

/// Bound of the residual relative to the largest energy. The balance is an identity of the linear step; what is left is
/// the rounding of the solves, some 1e-16 a step, summed over up to a million steps.
const RESIDUAL: f64 = 1e-9;

/// Most of the energy that any tolerance may leave unbalanced.
pub(super) const MOST_TOLERATED: f64 = 1e-3;

/// Most of the energy or the momentum that rounding may leave unbalanced: where it would leave more, nothing is known.
const MOST_ROUNDED: f64 = 1e-6;

/// The bound of a residual, and the quantity with what is permitted of it: what the tolerance of the iterations leaves, and what rounding leaves
/// of forces that are sums of much larger ones, relative to what the residual is relative to.
pub(super) fn permitted(quantity: &str, [tolerated, rounding]: [f64; 2]) -> (String, Bounds) {
    let rounding = rounding.min(MOST_ROUNDED);
    let quantity = match rounding > RESIDUAL {
        true => format!(
            "{quantity} (rounding permits {} in elements this stiff against some of their motions)",
            Form::Power.show(rounding)
        ),
        false => of_tolerance(quantity, tolerated),
    };
    let bound = (RESIDUAL + tolerated + rounding).min(MOST_TOLERATED);
    (quantity, Bounds::Bad(bound))
}

/// The quantity with what the tolerance of the iterations leaves of it.
pub(super) fn of_tolerance(quantity: &str, tolerated: f64) -> String {
    match tolerated > 0.0 {
        true => format!(
            "{quantity} (the tolerance of the iterations permits {})",
            Form::Power.show(tolerated)
        ),
        false => quantity.to_owned(),
    }
}

/// What puts a residual right.
pub(super) fn residual_remedy(evidence: &Evidence, tolerated: f64) -> &'static str {
    match (evidence.iterated, tolerated > 0.0) {
        (true, _) => {
            "the iterative solver left it, as in steps in which waves cross very many elements: use a smaller step or `time.solver = \"direct\"`"
        }
        (false, true) => {
            "use a smaller `time.newton.tolerance`; if that does not help, report a defect of the program"
        }
        (false, false) => {
            "report a defect of the program: a linear run leaves rounding errors only"
        }
    }
}

/// Bounds of the energy that appears without work from outside, relative to the energy put in. No law and no scheme has a
/// right to any; what the residual cannot show is a contact that makes energy with its ledger closed, as the trapezoid with the
/// displacement law does. A thousandth is beyond all rounding and all tolerances.
const GAIN: Bounds = Bounds::Both(1e-3, 0.01);

/// Bounds of the energy that mesh and step take, relative to the energy that could be lost. Energies of impacts are asked for to some
/// percent. Bodies that lose a quarter of their energy part by 1 - √(3/4) = 13 % too slowly: neither restitution nor what follows is theirs.
const LOSS: Bounds = Bounds::Both(0.05, 0.25);

/// Bounds of the scheme's own term, dt²/8 |a|²_M under central difference: it is small where the step resolves the waves. With a
/// quarter of the energy in it the balance of the scheme says little about the motion, with half of it nothing.
const EXCESS: Bounds = Bounds::Both(0.25, 0.5);

/// Energy that the scheme makes, whatever contacts, friction and damping lose.
pub(super) fn made(evidence: &Evidence) -> Finding {
    let (system, ledger) = (evidence.system, &evidence.last.ledger);
    let identity = system.scheme.get().energy_identity(system.dt);
    let lags = identity.is_some_and(|identity| identity.lag != 0.0);
    if evidence.zones.is_some() || ledger.is_static || !system.closes_energy() {
        return Finding::Absent;
    }
    if lags && system.is_nonlinear() {
        let why = "what the scheme made: the energy that it balances is that of displacements between two steps, known for linear forces only";
        return Finding::Unchecked(why.to_owned());
    }
    let (value, around) = evidence.worst_assembly(
        relative(ledger.largest_made, evidence.last.put_in()),
        |own| relative(own.largest_made, own.put_in()),
    );
    Finding::Line(Line::new(
        "scheme-made",
        (
            &format!("largest energy that the scheme made{around}, relative to the energy put in"),
            value,
            Form::Percent,
        ),
        GAIN,
        "use a smaller step, a scheme that dissipates, or energy-momentum",
    ))
}

/// How far the equations are solved: what the terms of the balance leave over.
pub(super) fn residual(evidence: &Evidence) -> Finding {
    if let Some(scheme) = without_identity(evidence) {
        return Finding::Unchecked(format!(
            "the balance of energy: no energy identity of the scheme {scheme} is known, so the residual contains the dissipation of the scheme"
        ));
    }
    let ledger = &evidence.last.ledger;
    let left = [ledger.tolerated.energy, ledger.rounding.energy];
    let left = left.map(|energy| relative(energy, evidence.last.balanced_energy()));
    let tolerated = left[0];
    let quantity = "energy residual relative to the largest energy";
    let (quantity, bounds) = permitted(quantity, left);
    Finding::Line(Line::new(
        "energy-residual",
        (&quantity, evidence.energy.relative_residual, Form::Power),
        bounds,
        residual_remedy(evidence, tolerated),
    ))
}

/// Energy from nowhere: what the scheme balances, beyond the work of loads, supports and obstacles.
pub(super) fn gain(evidence: &Evidence) -> Finding {
    let (value, around) = evidence.worst_assembly(
        relative(evidence.last.ledger.largest_gain, evidence.last.put_in()),
        |own| relative(own.largest_gain, own.put_in()),
    );
    Finding::Line(Line::new(
        "energy-gain",
        (
            &format!(
                "largest gain of energy{around} without the work of loads, supports and obstacles, relative to the energy put in"
            ),
            value,
            Form::Percent,
        ),
        GAIN,
        "use another scheme or contact law, or a smaller step",
    ))
}

/// Energy that a contact makes, whatever other contacts, friction, damping and the scheme lose.
pub(super) fn of_contact(evidence: &Evidence) -> Finding {
    if evidence.system.contacts.is_empty() {
        return Finding::Absent;
    }
    if evidence.last.ledger.is_static {
        let why = "the work of the contacts: in a static stage it is a sum over the steps, accurate for small steps only";
        return Finding::Unchecked(why.to_owned());
    }
    let contacts = evidence.system.contacts.iter().enumerate();
    let records = contacts.zip(&evidence.last.records.contacts);
    let made = records.map(|((k, contact), record)| {
        let supplied = evidence.around(k).supplied;
        (&*contact.name, relative(record.largest_work, supplied))
    });
    let Some((name, value)) = worst(made) else {
        return Finding::Absent;
    };
    Finding::Line(Line::new(
        "contact-work",
        (
            &format!(
                "largest positive work of contact `{name}` without that of a moving obstacle{OF_BODIES}"
            ),
            value,
            Form::Percent,
        ),
        GAIN,
        "use another contact law or scheme, or a smaller step",
    ))
}

/// What the works of a contact are relative to.
const OF_BODIES: &str =
    ", relative to the energy put into the bodies that it may touch, or their largest";

/// Energy that closing takes, where neither the law nor a body without waves gives a reason for it: a node that closes loses the energy of
/// its own motion, a share of the mass of the nodes at the surface, which goes with the size of the elements; in a step in which a wave passes
/// several of them, that of all these.
pub(super) fn lost(evidence: &Evidence) -> Finding {
    if evidence.last.ledger.is_static {
        return Finding::Absent;
    }
    let contacts = evidence.system.contacts.iter().enumerate();
    let records = contacts.zip(&evidence.last.records.contacts);
    let lossless = records
        .filter(|((k, contact), _)| is_lossless(&contact.law) && has_waves(evidence.system, *k));
    let lost = lossless.map(|((k, contact), record)| {
        let around = evidence.around(k);
        let lost = (-record.work()).max(0.0);
        (
            &*contact.name,
            relative(lost, around.supplied.max(around.largest)),
        )
    });
    let Some((name, value)) = worst(lost) else {
        return Finding::Absent;
    };
    Finding::Line(Line::new(
        "contact-loss",
        (
            &format!("energy lost where nodes of contact `{name}` close{OF_BODIES}"),
            value,
            Form::Percent,
        ),
        LOSS,
        "refine the mesh at the contact, and take steps in which a wave passes no more than an element: the loss goes with the size of the elements (`carom study --vary mesh.refine=0,1`), and with longer steps",
    ))
}

/// Whether a law loses no energy by itself: with restitution 0 a node that closes stays, as with the exact laws, and the body
/// behind it keeps its energy.
fn is_lossless(law: &Law) -> bool {
    match law {
        Law::Velocity(_) | Law::Displacement(_) => true,
        Law::Restitution(law) => law.coefficient == 0.0,
        _ => false,
    }
}

/// Energy that the scheme dissipates. It takes that of waves as short as a step, which are none of the bodies; what it takes beyond is.
pub(super) fn lost_to_scheme(evidence: &Evidence) -> Finding {
    let ledger = &evidence.last.ledger;
    // without an identity the number holds the residual too, and the balance is not checked
    if ledger.is_static || without_identity(evidence).is_some() {
        return Finding::Absent;
    }
    // of bodies that are driven over many periods more is put in than there ever is at once
    let whole = relative(
        ledger.balance.dissipation_scheme.max(0.0),
        evidence.last.put_in().max(evidence.last.largest_energy()),
    );
    let (value, around) = evidence.worst_assembly(whole, |own| {
        relative(own.dissipated.max(0.0), own.put_in().max(own.largest))
    });
    Finding::Line(Line::new(
        "scheme-loss",
        (
            &format!("energy that the scheme dissipated{around}{OF_LOSABLE}"),
            value,
            Form::Percent,
        ),
        LOSS,
        "use a smaller step, or a scheme that dissipates less (theta = 0.5, a spectral radius nearer to 1)",
    ))
}

/// What losses are relative to.
const OF_LOSABLE: &str =
    ", relative to the largest energy or the energy put in, whichever is larger";

/// An excess of energy over the largest energy that the rounding of sums makes by itself.
const ROUNDING: f64 = 1e-12;

/// Kinetic and strain energy that the scheme takes for none.
pub(super) fn of_scheme(evidence: &Evidence) -> Finding {
    let ledger = &evidence.last.ledger;
    if ledger.largest_excess <= ROUNDING * evidence.last.largest_energy() {
        return Finding::Absent;
    }
    Finding::Line(Line::new(
        "scheme-energy",
        (
            "largest excess of kinetic and strain energy over the energy that the scheme balances, relative to the largest energy",
            relative(ledger.largest_excess, evidence.last.largest_energy()),
            Form::Percent,
        ),
        EXCESS,
        "use a smaller step: the waves are as short as the step",
    ))
}

/// A part of an energy; nothing is no part of anything.
fn relative(part: f64, whole: f64) -> f64 {
    match part == 0.0 {
        true => 0.0,
        false => part / whole,
    }
}

/// A scheme of the run whose energy residual says nothing.
fn without_identity<'a>(evidence: &'a Evidence) -> Option<&'a str> {
    let scheme = evidence.system.scheme.get();
    match evidence.zones {
        Some(zones) => {
            let mut zones = zones.zones.iter();
            zones
                .find(|zone| !zone.has_identity)
                .map(|zone| zone.scheme.as_str())
        }
        None if evidence.system.closes_energy() => None,
        None => Some(scheme.name()),
    }
}
