//! What contacts and levels did, on the terminal.

use carom_output::summary::Contact;
use carom_output::{Level, Margin};
use carom_pages::plot::quantity;

use crate::terminal::out;

/// The forces of a contact.
pub fn print_contact(name: &str, contact: &Contact) {
    out!("  contact {name} ({} law)", contact.law);
    let peak = quantity(contact.peak_force, "N");
    match contact.mean_force.zip(contact.peak_mean_force) {
        Some((mean, peak_of_mean)) => out!(
            "    mean force {}, peak of the mean over {}: {}, raw peak {peak}",
            quantity(mean, "N"),
            quantity(contact.window, "s"),
            quantity(peak_of_mean, "N")
        ),
        None => out!("    largest force {peak}"),
    }
    if let Some(preload) = contact.preload {
        out!(
            "    preload {} at the start of the dynamics",
            quantity(preload, "N")
        );
    }
    let times = match (contact.first_closing, contact.last_release) {
        (Some(first), Some(last)) => format!(
            ", closed from {} to {}",
            quantity(first, "s"),
            quantity(last, "s")
        ),
        (Some(first), None) => format!(", closed from {}", quantity(first, "s")),
        (None, _) => ", never closed".to_string(),
    };
    let impulsive = match contact.impulsive == 0.0 {
        true => String::new(),
        false => format!(
            ", of which {} in separate impulses",
            quantity(contact.impulsive, "N s")
        ),
    };
    match contact.impulse {
        Some(impulse) => out!("    impulse {}{impulsive}{times}", quantity(impulse, "N s")),
        None => out!("    static: no impulse{times}"),
    }
    if let Some(peak) = contact.peak_moment {
        out!(
            "    largest moment {} at {}",
            quantity(peak.magnitude, "N m"),
            quantity(peak.time, "s")
        );
    }
    if let Some(friction) = contact.friction {
        let kinetic = friction.kinetic.map(|mu| format!(", of sliding {mu}"));
        out!(
            "    friction coefficient {}{}, largest friction force {}",
            friction.coefficient,
            kinetic.unwrap_or_default(),
            quantity(friction.peak_force, "N")
        );
    }
    if let Some(mixed) = contact.mixed_supports {
        out!(
            "    weak form: at most {mixed} nodes with partly closed supports, where the pressure depends on r"
        );
    }
}

/// The impacts of the contacts of a level, and its margins.
pub fn print_level(name: &str, level: &Level) {
    let found = &level.statistics;
    let most = match found.worst.first() {
        Some(worst) => format!(
            ", largest force {} ({} at {}), impulses {}, energy lost {}",
            quantity(worst.peak_force, "N"),
            worst.contact,
            quantity(worst.time, "s"),
            quantity(found.impulse, "N s"),
            quantity(found.energy_lost, "J")
        ),
        None => String::new(),
    };
    out!("  level {name}: {} impacts{most}", found.count);
    let margins = [
        ("force", "N", &level.force_margin),
        ("energy", "J", &level.energy_margin),
        ("stroke", "m", &level.stroke_margin),
        ("crush", "m", &level.crush_margin),
    ];
    for (of, unit, margin) in margins {
        let Some(margin) = margin else { continue };
        print_margin("    ", of, (margin, unit));
    }
}

/// What is left to an allowable, if anything was found.
pub fn print_margin(indent: &str, of: &str, (margin, unit): (&Margin, &str)) {
    if let Some(left) = margin.margin {
        let allowable = quantity(margin.allowable, unit);
        out!(
            "{indent}margin to the allowable {of} of {allowable}: {:.0} %",
            100.0 * left
        );
    }
}
