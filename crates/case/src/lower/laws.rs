//! Contact laws, with their defaults from the material of the two sides.

use carom_bodies::height;
use carom_contact::Law;
use carom_contact::law::{Capture, CurveError, Defaults, GivenLaw, Side};
use carom_dynamics::{ModelBody, ModelContact, ModelTarget};
use carom_mesh::{Mesh, Surface};

use super::context::Context;
use super::lookup;
use super::problems::Problems;
use crate::error::Problem;
use crate::schema::Scheme;

/// Part of the energy of an impact from which on the loss in a compliance is worth a warning.
const LOSS: f64 = 0.01;

/// The law of the contact `name`; `sides`: one for each deformable surface, the softer one first; `scheme`: that of
/// its zone.
pub(super) fn law(
    name: &str,
    given: &GivenLaw,
    (sides, scheme): (&[Side], &Scheme),
    problems: &mut Problems,
) -> Option<Law> {
    let defaults = Defaults {
        capture: default_capture(scheme),
        softer: sides[0],
    };
    let law = match given.law(&defaults) {
        Ok(law) => law,
        Err(error) => {
            return problems.refuse(no_curve(&format!("contact.{name}.law.stop"), &error));
        }
    };
    if let Law::Compliance(law) = &law {
        warn_of_loss(name, law.damping, sides, problems);
    }
    Some(law)
}

/// Warns where a compliance absorbs more than a part [`LOSS`] of an impact: 2 φ (1 - φ) between equal bars and twice
/// that on an obstacle, φ = C / (C + Z).
fn warn_of_loss(name: &str, damping: f64, sides: &[Side], problems: &mut Problems) {
    let impedance = 1.0 / sides.iter().map(|side| 1.0 / side.impedance).sum::<f64>();
    let phi = damping / (damping + impedance);
    let loss = phi * (1.0 - phi) * if sides.len() == 1 { 4.0 } else { 2.0 };
    if loss > LOSS {
        let enough = if sides.len() == 1 { 400.0 } else { 200.0 } * impedance;
        problems.warn(format!(
            "contact `{name}`: the compliance absorbs {:.2} % of the energy of an impact between bars; {enough:.3e} Pa s/m absorbs 1 %",
            100.0 * loss
        ));
    }
}

/// The problem of a curve of a stop; `path`: of the stop.
pub(super) fn no_curve(path: &str, error: &CurveError) -> Problem {
    let path = format!("{path}.curve");
    match error {
        CurveError::Count { points } => Problem::new(path, error.to_string()).found(points),
        CurveError::TooSteep {
            point,
            stiffness,
            first,
        } => Problem::new(
            format!("{path}[{}]", point - 1),
            "with crush = \"permanent\" no piece of the curve may be steeper than the first, along which the stop is unloaded",
        )
        .found(format!("{stiffness:.4e} N/m up to this point"))
        .accepted([format!("at most {first:.4e} N/m")]),
        CurveError::NotIncreasing {
            point,
            found,
            before,
        } => Problem::new(
            format!("{path}[{}]", point - 1),
            "penetrations must increase along the curve, and forces must not fall",
        )
        .found(format!("{} m, {} N", found[0], found[1]))
        .accepted([format!(
            "more than {} m, and {} {} N",
            before[0],
            if *point == 1 { "more than" } else { "at least" },
            before[1]
        )]),
    }
}

/// Half for theta = 1/2, now otherwise: what each scheme needs to close without a false start.
pub(super) fn default_capture(scheme: &Scheme) -> Capture {
    match scheme {
        Scheme::Theta(theta) if theta.theta == 0.5 => Capture::Half,
        _ => Capture::Now,
    }
}

/// The deformable sides of a contact, the softer one first.
pub(super) fn sides(
    mesh: &Mesh,
    bodies: &[ModelBody],
    secondary: &Surface,
    primary: &ModelTarget,
) -> Vec<Side> {
    let mut sides = vec![side(mesh, bodies, secondary)];
    if let ModelTarget::Surface(primary) = primary {
        sides.push(side(mesh, bodies, primary));
    }
    let softness = |side: &Side| side.size / side.young;
    sides.sort_by(|a, b| softness(b).total_cmp(&softness(a)));
    sides
}

/// The side with the thickest cells and the material of the first.
fn side(mesh: &Mesh, bodies: &[ModelBody], surface: &Surface) -> Side {
    let mut side = Side::default();
    for face in &surface.faces {
        let diameter = face.radius.map(|radius| 2.0 * radius);
        let size = match diameter.filter(|diameter| *diameter > 0.0) {
            Some(diameter) => diameter,
            None => height(mesh, face.parent, face.kind, face.corners()),
        };
        side.size = side.size.max(size);
    }
    if let Some(body) = lookup::body_behind(bodies, surface) {
        let material = body.spec.material.initial();
        side.young = material.young;
        side.wave_speed = material.wave_speed(body.spec.kinematics.plane());
        side.impedance = material.density * side.wave_speed;
    }
    side
}

/// A contact with the damped law.
pub(super) struct Spring {
    /// Name of the contact.
    pub(super) contact: String,
    /// Twice the rate of its spring against the elements behind it, 1/s.
    pub(super) rate: f64,
}

/// The springs of damped laws.
pub(super) fn springs(
    context: &Context,
    mesh: &Mesh,
    bodies: &[ModelBody],
    contacts: &[ModelContact],
) -> Vec<Spring> {
    let spring = |contact: &ModelContact| match &contact.law {
        Law::Damped(law) => {
            let sides = sides(mesh, bodies, &contact.secondary, &contact.primary);
            Some(Spring {
                contact: contact.name.clone(),
                rate: 2.0 * spring_rate(law.stiffness, &sides[0]),
            })
        }
        _ => None,
    };
    let stops = &context.case.stop;
    let contacts = contacts.iter();
    let contacts = contacts.filter(|contact| stops.get(&contact.name).is_none());
    contacts.filter_map(spring).collect()
}

/// sqrt(k h/E) c/h in 1/s, for k in Pa/m: the frequency of a spring on half an element, over sqrt 2.
fn spring_rate(stiffness: f64, side: &Side) -> f64 {
    (stiffness * side.size / side.young).sqrt() * side.wave_speed / side.size
}
