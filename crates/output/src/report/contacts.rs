//! What contacts did: columns of a table where there are few, its rows where there are many.

use carom_pages::form::near;
use carom_pages::html::{cells, each, line, quantity, text, when, wide};

use crate::summary::{Contact, Friction, Summary};

/// Contacts that are columns of a table; more are its rows.
pub(super) const FEW: usize = 6;

/// An energy, zero where it is rounding beside the largest one of the run.
pub(super) fn joules(summary: &Summary, energy: f64) -> String {
    quantity(summary.energy.shown(energy), "J")
}

/// The table with its head; nothing without contacts.
pub(super) fn table(summary: &Summary) -> String {
    match summary.contacts.len() {
        0 => String::new(),
        count if count > FEW => rows(summary),
        _ => columns(summary),
    }
}

/// The largest displacement, beside which a penetration may be rounding, m.
fn moved(summary: &Summary) -> f64 {
    let most = summary.maxima.displacement.as_ref();
    most.map_or(0.0, |most| most.value)
}

fn rows(summary: &Summary) -> String {
    let heads = [
        "",
        "Law",
        "Peak force, single step",
        "Peak of the mean",
        "Mean force while closed",
        "Impulse",
        "Impacts",
        "First closing",
        "Last release",
        "Largest penetration",
        "Lost in crush",
        "Peak of friction",
        "Lost in friction",
        "Changes of status",
        "Chatter",
    ];
    let moved = moved(summary);
    let joules = |energy: f64| joules(summary, energy);
    let row = |(name, contact): (&String, &Contact)| {
        let friction = contact.friction.as_ref();
        let of_friction = |show: &dyn Fn(&Friction) -> String| friction.map_or(String::new(), show);
        let shown = [
            text(&contact.law),
            quantity(contact.peak_force, "N"),
            quantity(contact.peak_mean_force, "N"),
            quantity(contact.mean_force, "N"),
            quantity(contact.impulse, "N s"),
            contact.impacts.to_string(),
            quantity(contact.first_closing, "s"),
            quantity(contact.last_release, "s"),
            quantity(near(contact.max_penetration, moved), "m"),
            joules(contact.energy_crushed),
            of_friction(&|friction| quantity(friction.peak_force, "N")),
            of_friction(&|friction| joules(friction.loss)),
            contact.status_changes.to_string(),
            quantity(contact.chatter, ""),
        ];
        line(name, &cells(&shown))
    };
    let table = wide(true, &heads, &each(&summary.contacts, row));
    format!(
        "\n<h2 id=\"contacts\">Contacts</h2>\n{table}<p class=\"faint\">Force positive in compression. The peak of a single step does not converge with the mesh where the exact force jumps; the peak of the mean does. Chatter: changes of status of a point per expected closing, 2 without any.</p>\n"
    )
}

fn columns(summary: &Summary) -> String {
    let contacts = &summary.contacts;
    let moved = moved(summary);
    let across = |label: &str, cell: &dyn Fn(&Contact) -> String| {
        line(
            label,
            &each(contacts.values(), |contact| {
                format!("<td>{}</td>", cell(contact))
            }),
        )
    };
    let joules = |energy: f64| joules(summary, energy);
    let mean = |contact: &Contact| match contact.peak_mean_force {
        None => quantity(None, "N"),
        mean => format!(
            "{} over {}",
            quantity(mean, "N"),
            quantity(contact.window, "s")
        ),
    };
    let lines = [
        some(
            summary,
            "Preload at the start of the dynamics",
            |c| c.preload,
            |preload| quantity(preload, "N"),
        ),
        some(
            summary,
            "Largest moment about its point",
            |c| c.peak_moment,
            |moment| {
                format!(
                    "{} at {}",
                    quantity(moment.magnitude, "N m"),
                    quantity(moment.time, "s")
                )
            },
        ),
        across("Peak force, single step", &|c| quantity(c.peak_force, "N")),
        across("Peak of the mean force over a window", &mean),
        across("Mean force while closed", &|c| quantity(c.mean_force, "N")),
        across("Impulse", &|c| quantity(c.impulse, "N s")),
        across("of which separate impulses", &|c| {
            quantity(c.impulsive, "N s")
        }),
        across("First closing", &|c| quantity(c.first_closing, "s")),
        across("Last release", &|c| quantity(c.last_release, "s")),
        across("Restitution of the last impact", &|c| {
            quantity(c.restitution, "")
        }),
        across("Largest penetration", &|c| {
            quantity(near(c.max_penetration, moved), "m")
        }),
        across("Persistency defect", &|c| joules(c.persistency_defect)),
        across("Energy lost in crush", &|c| joules(c.energy_crushed)),
        some(
            summary,
            "Coefficient of friction",
            |c| c.friction,
            |friction| quantity(friction.coefficient, ""),
        ),
        some(
            summary,
            "Largest friction force",
            |c| c.friction,
            |friction| quantity(friction.peak_force, "N"),
        ),
        some(
            summary,
            "Energy lost in friction",
            |c| c.friction,
            |friction| joules(friction.loss),
        ),
        some(
            summary,
            "Most nodes with partly closed supports, where the pressure depends on r",
            |c| c.mixed_supports,
            |supports| supports.to_string(),
        ),
        across("Changes of status", &|c| c.status_changes.to_string()),
        across("Changes of status of a point per expected closing", &|c| {
            quantity(c.chatter, "")
        }),
    ];
    let names = contacts.keys().map(|name| text(name));
    let names: Vec<String> = [String::new()].into_iter().chain(names).collect();
    let table = wide(false, &names, &lines.concat());
    format!(
        "\n<h2 id=\"contacts\">Contact</h2>\n{table}<p class=\"faint\">Force positive in compression. The peak of a single step does not converge with the mesh where the exact force jumps; the peak of the mean does.</p>\n"
    )
}

/// A line that stands where a contact has what it shows.
fn some<T>(
    summary: &Summary,
    label: &str,
    of: impl Fn(&Contact) -> Option<T>,
    show: impl Fn(T) -> String,
) -> String {
    let contacts = || summary.contacts.values();
    when(contacts().any(|contact| of(contact).is_some()), || {
        let cell = |contact| format!("<td>{}</td>", of(contact).map_or(String::new(), &show));
        line(label, &each(contacts(), cell))
    })
}
