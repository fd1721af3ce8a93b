//! The columns of the table of a comparison, each once: text, CSV and page are made from this list.

use carom_output::Absent;
use carom_output::rows::Cell;
use carom_output::summary::Contact;
use carom_output::table::Table;
use carom_pages::form::{Form, NOTHING};

use crate::compare::{Comparison, Done, Outcome, Standard, Variant};

/// A column.
#[derive(Clone, Copy, Debug)]
pub struct Column {
    /// Name in the CSV file, with the unit.
    pub name: &'static str,
    /// Head in the text and on the page; `None`: in the CSV file only.
    pub head: Option<&'static str>,
    /// How its numbers are shown.
    pub form: Form,
    /// Its value for a variant; `None` where it does not exist.
    pub value: fn(&Done) -> Option<f64>,
}

const fn column(
    name: &'static str,
    head: &'static str,
    form: Form,
    value: fn(&Done) -> Option<f64>,
) -> Column {
    Column {
        name,
        head: Some(head),
        form,
        value,
    }
}

const fn hidden(name: &'static str, unit: &'static str, value: fn(&Done) -> Option<f64>) -> Column {
    Column {
        name,
        head: None,
        form: Form::Quantity(unit),
        value,
    }
}

/// All columns between the name of the variant and the verdict. Force positive in compression, energy change and work
/// positive when the bodies gain, dissipation positive when lost, penetration positive.
pub const COLUMNS: [Column; 34] = [
    column("force_error", "force error", Form::Percent, |v| {
        v.errors.force
    }),
    column("overshoot", "overshoot", Form::Percent, |v| {
        v.errors.overshoot
    }),
    column("mean_overshoot", "of the mean", Form::Percent, |v| {
        v.errors.mean_overshoot
    }),
    column("impulse_error", "impulse error", Form::Percent, |v| {
        v.errors.impulse
    }),
    column("status_changes", "status changes", Form::Count, |v| {
        v.contact().map(|c| c.status_changes as f64)
    }),
    column("impacts", "impacts", Form::Count, |v| {
        over_contacts(v, |sum, contact| sum + contact.impacts as f64)
    }),
    column(
        "largest_force_n",
        "largest force",
        Form::Quantity("N"),
        |v| over_contacts(v, |largest, contact| largest.max(contact.peak_force)),
    ),
    column("impulses_n_s", "impulses", Form::Quantity("N s"), |v| {
        over_contacts(v, |sum, contact| sum + contact.impulse.unwrap_or(0.0))
    }),
    column("energy_change", "energy", Form::Percent, energy_change),
    column("work_contact_j", "by contact", Form::Quantity("J"), |v| {
        work(v, "contact")
    }),
    column(
        "dissipation_scheme_j",
        "lost by scheme",
        Form::Quantity("J"),
        dissipation,
    ),
    column(
        "restitution",
        "restitution",
        Form::Quantity(""),
        restitution,
    ),
    column("penetration_m", "penetration", Form::Quantity("m"), |v| {
        v.contact().map(|c| c.max_penetration)
    }),
    column(
        "persistency_defect_j",
        "persistency",
        Form::Quantity("J"),
        |v| v.contact().map(|c| c.persistency_defect),
    ),
    column("release_s", "release", Form::Quantity("s"), |v| {
        v.contact()?.last_release
    }),
    column("steps", "steps", Form::Count, |v| {
        Some(v.summary.time.steps as f64)
    }),
    column("factorisations", "factorisations", Form::Count, |v| {
        Some(v.summary.counts.factorisations as f64)
    }),
    column("element_updates", "element updates", Form::Count, |v| {
        Some(v.summary.counts.element_updates as f64)
    }),
    column("solves", "solves", Form::Count, |v| {
        Some(v.summary.counts.solves as f64)
    }),
    column("sweeps", "sweeps", Form::Count, |v| {
        Some(v.summary.counts.sweeps as f64)
    }),
    column("wall_s", "wall time", Form::Quantity("s"), |v| {
        v.summary.timings.get("total").copied()
    }),
    hidden("peak_force_n", "N", |v| v.contact().map(|c| c.peak_force)),
    hidden("peak_mean_force_n", "N", |v| {
        v.contact().and_then(|c| c.peak_mean_force)
    }),
    hidden("window_s", "s", |v| v.contact().map(|c| c.window)),
    hidden("impulse_n_s", "N s", |v| {
        v.contact().and_then(|c| c.impulse)
    }),
    hidden("energy_residual", "", |v| {
        Some(v.summary.energy.relative_residual)
    }),
    hidden("momentum_residual", "", |v| {
        Some(v.summary.momentum.relative_residual)
    }),
    hidden("angular_residual", "", |v| {
        Some(v.summary.momentum.angular.as_ref()?.relative_residual)
    }),
    hidden("dissipation_material_j", "J", |v| lost(v, "materials")),
    hidden("dissipation_damping_j", "J", |v| lost(v, "damping")),
    hidden("dissipation_friction_j", "J", |v| lost(v, "friction")),
    hidden("dissipation_viscosity_j", "J", |v| lost(v, "viscosity")),
    hidden("dissipation_deletion_j", "J", |v| lost(v, "deletion")),
    hidden("newton_iterations", "", |v| {
        v.summary.newton.map(|newton| newton.iterations as f64)
    }),
];

/// What all contacts come to; `None` without any.
fn over_contacts(done: &Done, add: fn(f64, &Contact) -> f64) -> Option<f64> {
    let contacts = &done.summary.contacts;
    (!contacts.is_empty()).then(|| contacts.values().fold(0.0, add))
}

/// Kinetic and strain energy at the end over that at the start, less one.
fn energy_change(done: &Done) -> Option<f64> {
    let energy = &done.summary.energy;
    let start = energy.kinetic_initial + energy.strain_initial;
    (start > 0.0).then(|| (energy.kinetic_final + energy.strain_final) / start - 1.0)
}

/// What the scheme lost; not told apart from the residual where no energy identity is known of it.
fn dissipation(done: &Done) -> Option<f64> {
    lost(done, "scheme").filter(|_| done.summary.energy.identity)
}

fn lost(done: &Done, name: &str) -> Option<f64> {
    done.summary.energy.dissipations.get(name).copied()
}

fn work(done: &Done, name: &str) -> Option<f64> {
    done.summary.energy.works.get(name).copied()
}

/// From the mean velocities: at the end of the run where there is an exact solution to compare it with, else of the last
/// complete impact.
fn restitution(done: &Done) -> Option<f64> {
    let exact = done.summary.exact.as_ref().and_then(|e| e.restitution);
    exact.or_else(|| done.contact()?.restitution)
}

fn show(form: Form, value: Option<f64>) -> String {
    value.map_or_else(|| NOTHING.to_owned(), |value| form.show(value))
}

/// The table for people: the columns with a head, between the names and the verdicts.
pub(crate) fn table(variants: &[Variant]) -> Table {
    let shown = || COLUMNS.iter().filter_map(|c| Some((c, c.head?)));
    let heads = shown().map(|(_, head)| head.to_owned());
    let row = |variant: &Variant| {
        let done = variant.done();
        let cells = shown().map(|(c, _)| match done {
            Some(done) => show(c.form, (c.value)(done)),
            None => String::new(),
        });
        let name = std::iter::once(variant.name.clone());
        let verdict = variant.verdict().0.to_owned();
        name.chain(cells).chain([verdict]).collect()
    };
    Table {
        heads: std::iter::once(String::new())
            .chain(heads)
            .chain(["verdict".to_owned()])
            .collect(),
        rows: variants.iter().map(row).collect(),
    }
}

/// The cells of the table that are empty, of the variants that were computed.
pub(crate) fn absent(comparison: &Comparison) -> Vec<Absent> {
    let done = comparison.variants.iter();
    let done: Vec<(&str, &Done)> = done
        .filter_map(|v| Some((v.name.as_str(), v.done()?)))
        .collect();
    let shown = COLUMNS.iter().filter_map(|c| Some((c, c.head?)));
    let cells = shown.flat_map(|(column, head)| {
        let empty = done
            .iter()
            .filter(|(_, done)| (column.value)(done).is_none());
        empty.map(move |(name, done)| (head, *name, reason(comparison, column, done)))
    });
    Absent::gather(cells, done.len())
}

/// Why a variant has no value in a column.
fn reason(comparison: &Comparison, column: &Column, done: &Done) -> String {
    let standard = match &comparison.standard {
        Standard::Run(name) => comparison.variants.iter().find(|v| v.name == *name),
        Standard::Exact | Standard::Nothing => None,
    };
    let reason = match (column.name, done.contact()) {
        ("energy_change", _) => "no energy at the start",
        ("dissipation_scheme_j", _) => {
            "no energy identity of the scheme is known: the residual has it too"
        }
        (_, None) => "no contact",
        ("force_error" | "overshoot" | "mean_overshoot" | "impulse_error", _) => {
            match (&comparison.standard, standard.map(|v| &v.outcome)) {
                (Standard::Nothing, _) => "nothing to compare with",
                (
                    Standard::Run(_),
                    None | Some(Outcome::Refused(_) | Outcome::Failed(_) | Outcome::Stopped),
                ) => "the reference was not computed",
                _ if done.summary.contacts.values().all(|c| c.impulse.is_none()) => {
                    "static steps take no time"
                }
                _ => "the reference has no force",
            }
        }
        ("restitution", Some(contact)) => {
            let told = contact.no_restitution.clone();
            return told.unwrap_or_else(|| match contact.first_closing {
                None => "no impact".to_owned(),
                Some(_) => "no complete impact".to_owned(),
            });
        }
        ("release_s", Some(contact)) => match contact.first_closing {
            None => "never closed",
            Some(_) => "closed at the end",
        },
        _ => "not known of this run",
    };
    reason.to_owned()
}

/// Names of the columns of `comparison.csv`.
pub(crate) fn names() -> Vec<&'static str> {
    let own = COLUMNS.iter().map(|column| column.name);
    ["variant", "scheme", "contact", "law"]
        .into_iter()
        .chain(own)
        .chain(["verdict", "reason"])
        .collect()
}

/// A row of `comparison.csv`; `reason`: that of the verdict.
pub(crate) fn cells<'a>(variant: &'a Variant, reason: &'a str) -> Vec<Cell<'a>> {
    let done = variant.done();
    let text = |text: Option<&'a str>| text.map_or(Cell::Empty, Cell::Text);
    let mut cells = vec![
        Cell::Text(&variant.name),
        text(done.map(|done| done.summary.scheme.as_str())),
        text(done.and_then(|done| done.history.contact.as_deref())),
        text(done.and_then(|done| Some(done.contact()?.law.as_str()))),
    ];
    cells.extend(COLUMNS.iter().map(|c| Cell::from(done.and_then(c.value))));
    cells.push(Cell::Text(variant.verdict().0));
    cells.push(text((!reason.is_empty()).then_some(reason)));
    cells
}
