//! Contacts whose sides have changed sides without a force, within a step or between the points that carry forces.

use carom_contact::law::Level;
use carom_dynamics::{Crossing, Findings};
use carom_pages::form::Form;
use carom_pages::plot::quantity;

use crate::results::lines::{Evidence, Finding, worst};
use crate::verdict::{Bounds, Grade, Line};

/// Depth over the size of an element normal to the surface, as of a point that carries a force: between points that do, nothing keeps the
/// other side out.
const BETWEEN: Bounds = Bounds::Both(0.1, 1.0);

/// The contact whose primary side is deepest behind its secondary one, where that is worth a look: a little of it is what two meshes that do
/// not match leave.
pub(super) fn between(evidence: &Evidence) -> Finding {
    let contacts = evidence.system.contacts.iter().enumerate();
    let records = contacts.zip(&evidence.last.records.contacts);
    let depths = records
        .filter(|((_, contact), _)| !contact.law.get().is_of_the_whole())
        .map(|((k, contact), record)| {
            let depth = record.between.value / evidence.system.depth_of_elements(k);
            (&*contact.name, depth)
        });
    match worst(depths) {
        Some((name, value)) if BETWEEN.grade(value) != Grade::Good => Finding::Line(Line::new(
            "penetration-between",
            (
                &format!(
                    "largest depth of a node of the primary side of contact `{name}` behind its secondary side, between the points of that, relative to the smallest element size normal to its surfaces"
                ),
                value,
                Form::Percent,
            ),
            BETWEEN,
            "exchange `secondary` and `primary`, or refine the secondary surface: of two sides the one with the smaller faces is to be secondary",
        )),
        _ => Finding::Absent,
    }
}

/// One point is enough: what it met is not in the result.
const BOUNDS: Bounds = Bounds::Bad(0.5);

/// The contact of which most points passed what they face in a step, where any did.
pub(super) fn of_contacts(evidence: &Evidence) -> Finding {
    let contacts = evidence.system.contacts.iter();
    let records = contacts.zip(&evidence.last.records.contacts);
    let passed = records.filter(|(_, record)| record.passed > 0);
    let counts = passed.map(|(contact, record)| (&*contact.name, record.passed as f64));
    let Some((name, value)) = worst(counts) else {
        return Finding::Absent;
    };
    Finding::Line(Line::new(
        "crossing",
        (
            &format!(
                "points of contact `{name}` that passed what they face within a step, without a force"
            ),
            value,
            Form::Count,
        ),
        BOUNDS,
        "use a smaller step, in which bodies come closer by less than half the thickness of what they meet",
    ))
}

/// How deep surfaces go before a certificate tells.
const DEEP: &str =
    "deeper than 1/20 of their elements, or half the way to the middle of a shell or a beam";

/// Pairs of bodies, or of a body and the rigid shape that it meets, whose surfaces passed through each other although a contact is between them: no
/// force told of it.
pub(super) fn of_surfaces(evidence: &Evidence) -> Finding {
    let Some(findings) = &evidence.last.crossings else {
        return Finding::Unchecked(
            "whether surfaces pass through each other: nobody has seen whole states, as on several ranks and before a first step"
                .to_owned(),
        );
    };
    if !findings.looks(evidence.system) {
        return Finding::Absent;
    }
    let crossed = findings
        .told
        .those(|crossing| crossing.contact.is_some() && !crossing.held);
    let of = match crossed.first() {
        None => format!(
            "{} pairs of nodes, edges and faces tested, {} steps cut",
            findings.told.tested, evidence.last.control.passed
        ),
        Some(first) => format!("the first {}", when_and_where(evidence, findings, first)),
    };
    Finding::Line(Line::new(
        "surfaces",
        (
            &format!(
                "pairs of bodies whose surfaces went through each other where their contact had no force, {DEEP}; {of}"
            ),
            crossed.len() as f64,
            Form::Count,
        ),
        BOUNDS,
        "use a finer mesh where they meet, and a smaller step; take [general-contact], or sliding = \"finite\" with integration = \"node\", which look both ways, or exchange `secondary` and `primary` if the primary side has the smaller faces",
    ))
}

/// The same where the contact had a force, but not where it would have kept them apart. From there on nobody looks at the pair.
pub(super) fn under_force(evidence: &Evidence) -> Finding {
    let Some(findings) = &evidence.last.crossings else {
        return Finding::Absent;
    };
    let deep = findings.told.those(|crossing| crossing.held);
    let Some(first) = deep.first() else {
        return Finding::Absent;
    };
    let law = |crossing: &Crossing| {
        let contact = crossing
            .contact
            .map(|contact| &evidence.system.contacts[contact]);
        contact.map(|contact| contact.law.get().level())
    };
    let first = when_and_where(evidence, findings, first);
    if deep
        .iter()
        .all(|crossing| law(crossing) == Some(Level::GapAndRate))
    {
        return Finding::Unchecked(format!(
            "whether surfaces pass through each other: their contacts let them go {DEEP}, the first {first}; `penetration` says how deep"
        ));
    }
    Finding::Line(Line::new(
        "surfaces-under-force",
        (
            &format!(
                "pairs of bodies whose surfaces went into each other beside the forces of their contact, {DEEP}; the first {first}"
            ),
            deep.len() as f64,
            Form::Count,
        ),
        Bounds::Look(0.5),
        "`penetration-between` says how deep; use a finer mesh where they meet, [general-contact] or sliding = \"finite\" with integration = \"node\", which look both ways, or exchange `secondary` and `primary`",
    ))
}

/// Pairs of bodies that nobody looks at.
pub(super) fn left_open(evidence: &Evidence) -> Finding {
    let Some(findings) = &evidence.last.crossings else {
        return Finding::Absent;
    };
    let named = |of: &[u32; 2]| findings.names(evidence.system, *of);
    let overlapping = findings.overlapping().iter();
    let joined = findings.joined(evidence.system);
    let mut pairs: Vec<String> = overlapping
        .map(|of| format!("{}, which meet at the start", named(of)))
        .chain(joined.map(|of| {
            format!(
                "{}, which links join or whose gaps count from elsewhere",
                named(&of)
            )
        }))
        .collect();
    let deleting = evidence.system.bodies.iter();
    let deleting = deleting.filter(|body| body.has_deletion());
    pairs.extend(deleting.map(|body| format!("`{}`, whose elements are deleted", body.name())));
    let Some(first) = pairs.first() else {
        return Finding::Absent;
    };
    let more = match pairs.len() {
        1 => String::new(),
        count => format!(", and {} more", count - 1),
    };
    Finding::Unchecked(format!(
        "whether surfaces pass through each other: those of {first}{more}"
    ))
}

/// Who met, when and where.
pub(super) fn when_and_where(
    evidence: &Evidence,
    findings: &Findings,
    crossing: &Crossing,
) -> String {
    let names = findings.names(evidence.system, crossing.of);
    let place = &crossing.place[..evidence.system.dim];
    let place: Vec<String> = place.iter().map(|x| quantity(*x, "m")).collect();
    format!(
        "{names} at {}, at ({})",
        quantity(crossing.time, "s"),
        place.join(", ")
    )
}
