//! Whether what is assumed small has stayed small: strain and rotation of bodies at small strain, sliding of contacts.

use carom_dynamics::{Largest, SmallSliding, SmallStrain, System};
use carom_pages::form::Form;

use crate::results::lines::{Evidence, Finding};
use crate::verdict::{Bounds, Line};

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Small strain drops half the square of a rotation beside the strain: 1.4e-3 at 3°, 1.5e-2 at 10°, which is a body that grows by
/// as much.
const ROTATION: Bounds = Bounds::Both(3.0 * DEGREE, 10.0 * DEGREE);

/// It drops half the square of a strain beside the strain: a part of 1 % of it at 2 %, of 5 % at 10 %.
const STRAIN: Bounds = Bounds::Both(0.02, 0.1);

/// Beyond half a face a force enters another face than the one that it belongs to, beyond two it is in no neighbour of it.
const SLIDE: Bounds = Bounds::Both(0.5, 2.0);

/// The part of a force that points in a wrong direction: the sine, 0.09 at 5°, 0.26 at 15°.
const TURN: Bounds = Bounds::Both(5.0 * DEGREE, 15.0 * DEGREE);

/// Gaps and depths that small sliding does not know of, in faces.
const APART: Bounds = Bounds::Both(0.1, 0.5);

/// Rotation of the elements of bodies at small strain.
pub(super) fn rotation(evidence: &Evidence) -> Finding {
    let quantity = "rotation of an element at small strain";
    of_bodies(
        evidence,
        ("small-strain-rotation", quantity, Form::Degrees),
        ROTATION,
        |found| found.rotation,
    )
}

/// Strain of the elements of bodies at small strain.
pub(super) fn strain(evidence: &Evidence) -> Finding {
    let quantity = "strain of an element at small strain";
    of_bodies(
        evidence,
        ("small-strain", quantity, Form::Percent),
        STRAIN,
        |found| found.strain,
    )
}

/// Reduced bodies: their rotations and strains are recovered for fields alone.
pub(super) fn of_reduced(evidence: &Evidence) -> Finding {
    match evidence.reduced() {
        None => Finding::Absent,
        Some((names, _)) => Finding::Unchecked(format!(
            "whether rotations and strains of {names} stay small: reduced bodies recover them for fields and pictures only"
        )),
    }
}

/// Way of points with a force along the surface that they were paired with.
pub(super) fn slide(evidence: &Evidence) -> Finding {
    let quantity = "sliding of a point with a force under small sliding, in face lengths";
    of_contacts(
        evidence,
        ("small-sliding", quantity, Form::Number),
        SLIDE,
        |found| found.slide,
    )
}

/// Turn of normals since points were paired.
pub(super) fn turn(evidence: &Evidence) -> Finding {
    let quantity = "rotation of a normal under small sliding";
    of_contacts(
        evidence,
        ("small-sliding-normal", quantity, Form::Degrees),
        TURN,
        |found| found.turn,
    )
}

/// Forces in points that are apart from what they press on.
pub(super) fn invented(evidence: &Evidence) -> Finding {
    let quantity = "open gap of a point with a force under small sliding, in face lengths (inf: nothing is opposite the point)";
    of_contacts(
        evidence,
        ("small-sliding-invented", quantity, Form::Number),
        APART,
        |found| found.invented,
    )
}

/// Points that penetrate without a force.
pub(super) fn lost(evidence: &Evidence) -> Finding {
    let quantity = "penetration of a point without a force under small sliding, in face lengths";
    of_contacts(
        evidence,
        ("small-sliding-lost", quantity, Form::Number),
        APART,
        |found| found.lost,
    )
}

/// The worst of all bodies at small strain.
fn of_bodies(
    evidence: &Evidence,
    (name, quantity, form): (&str, &str, Form),
    bounds: Bounds,
    of: fn(&SmallStrain) -> Largest,
) -> Finding {
    let found = &evidence.last.records.small.bodies;
    let system = evidence.system;
    let small = (0..found.len()).filter(|&body| is_watched(system, body));
    let worst = small.max_by(|&a, &b| of(&found[a]).value.total_cmp(&of(&found[b]).value));
    let Some(body) = worst else {
        return Finding::Absent;
    };
    let largest = of(&found[body]);
    let quantity = format!(
        "{quantity}, body `{}`{}",
        system.bodies[body].name(),
        when(&largest)
    );
    let remedy = instead(system, body);
    Finding::Line(Line::new(
        name,
        (&quantity, largest.value, form),
        bounds,
        &remedy,
    ))
}

/// Whether a body has elements at small strain that the driver looks at.
fn is_watched(system: &System, body: usize) -> bool {
    let body = &system.bodies[body];
    body.as_beam().is_some()
        || body.as_shell().is_some_and(|shell| !shell.turns())
        || body
            .as_solid()
            .is_some_and(|solid| !solid.has_finite_strain())
}

/// What to write for a body that turns or stretches.
fn instead(system: &System, body: usize) -> String {
    if let Some(beam) = system.bodies[body].as_beam() {
        return format!(
            "model `{}` with {}: rotations of beams are small here",
            beam.name(),
            match beam.fibres() {
                None => "solid cells of neo-hooke",
                Some(_) => "solid cells of the same material",
            }
        );
    }
    if let Some(shell) = system.bodies[body].as_shell() {
        let name = shell.name();
        return format!("use body.{name}.section.shell.rotations = \"finite\"");
    }
    let Some(body) = system.bodies[body].as_solid() else {
        return String::new();
    };
    let (name, elastic) = (body.name(), body.material().initial());
    match (body.takes_finite_strain(), body.kinematics().dim()) {
        (true, _) => format!(
            "use neo-hooke = {{ young = {:e}, poisson = {:?} }} in place of elastic in the material of `{name}`",
            elastic.young, elastic.poisson
        ),
        (false, 1) => format!(
            "model `{name}` with plane or solid cells of {}: bars support small strain only",
            match body.is_linear() {
                true => "neo-hooke",
                false => "the same material",
            }
        ),
        (false, _) => format!(
            "model `{name}` with section.plane-strain or solid cells, and neo-hooke: plane stress supports small strain only"
        ),
    }
}

/// The worst of all contacts of small sliding; absent where there is none, or only against planes.
fn of_contacts(
    evidence: &Evidence,
    (name, quantity, form): (&str, &str, Form),
    bounds: Bounds,
    of: fn(&SmallSliding) -> Largest,
) -> Finding {
    let found = &evidence.last.records.small.contacts;
    let contacts = evidence.system.contacts.iter().zip(found);
    let watched = contacts.filter(|(contact, _)| contact.pairs_once());
    let worst = watched.max_by(|a, b| of(a.1).value.total_cmp(&of(b.1).value));
    let Some((contact, found)) = worst else {
        return Finding::Absent;
    };
    let largest = of(found);
    let quantity = match largest.value > 0.0 {
        true => format!(
            "{quantity}, contact `{}`, node {}{}",
            contact.name,
            largest.place,
            when(&largest)
        ),
        false => format!("{quantity}, contact `{}`", contact.name),
    };
    let remedy = format!("use contact.{}.sliding = \"finite\"", contact.name);
    let line = Line::new(name, (&quantity, largest.value, form), bounds, &remedy);
    Finding::Line(line)
}

fn when(largest: &Largest) -> String {
    match largest.value > 0.0 {
        true => format!(" at {}", Form::Quantity("s").show(largest.time)),
        false => String::new(),
    }
}
