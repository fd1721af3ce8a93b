//! Names and units of the numbers that a run of a model will have: of the summary, and of the columns of histories.

use carom_bodies::Body;
use carom_dynamics::System;

use crate::Error;
use crate::results::Settings;
use crate::results::columns::column_names;

/// A number of the results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// Its name: keys joined by dots, or a column.
    pub name: String,
    /// Its unit; empty of a pure number.
    pub unit: &'static str,
}

/// A key with the unit of its number.
type Key = (&'static str, &'static str);

const TIME: &[Key] = &[
    ("end", "s"),
    ("steps", ""),
    ("rejected.closing", ""),
    ("rejected.passage", ""),
    ("rejected.energy_growth", ""),
    ("rejected.failure", ""),
    ("smallest_step", "s"),
    ("largest_step", "s"),
    ("courant", ""),
];

const MODEL: &[Key] = &[("nodes", ""), ("unknowns", ""), ("contact_points", "")];

const CONTACT: &[Key] = &[
    ("preload", "N"),
    ("peak_force", "N"),
    ("peak_resultant.magnitude", "N"),
    ("peak_resultant.force.0", "N"),
    ("peak_resultant.force.1", "N"),
    ("peak_resultant.force.2", "N"),
    ("peak_resultant.time", "s"),
    ("peak_mean_force", "N"),
    ("window", "s"),
    ("mean_force", "N"),
    ("impulse", "N s"),
    ("impulsive", "N s"),
    ("first_closing", "s"),
    ("last_release", "s"),
    ("status_changes", ""),
    ("chatter", ""),
    ("max_penetration", "m"),
    ("persistency_defect", "J"),
    ("energy_crushed", "J"),
    ("mixed_supports", ""),
    ("impacts", ""),
    ("restitution", ""),
];

const MOMENT: &[Key] = &[
    ("magnitude", "N m"),
    ("moment.0", "N m"),
    ("moment.1", "N m"),
    ("moment.2", "N m"),
    ("time", "s"),
];

const FRICTION: &[Key] = &[
    ("coefficient", ""),
    ("kinetic", ""),
    ("peak_force", "N"),
    ("loss", "J"),
];

const STATISTICS: &[Key] = &[
    ("count", ""),
    ("peak_force", "N"),
    ("mean_peak_force", "N"),
    ("mean_force", "N"),
    ("impulse", "N s"),
    ("largest_impulse", "N s"),
    ("duration", "s"),
    ("longest", "s"),
    ("energy_taken", "J"),
    ("energy_taken_sum", "J"),
    ("energy_lost", "J"),
    ("friction_loss", "J"),
];

const MARGINS: &[Key] = &[
    ("force_margin", "N"),
    ("energy_margin", "J"),
    ("stroke_margin", "m"),
    ("crush_margin", "m"),
];

const BOLT: &[Key] = &[
    ("end_of_stage", "N"),
    ("largest.0", "N"),
    ("largest.1", "s"),
    ("smallest.0", "N"),
    ("smallest.1", "s"),
    ("last", "N"),
    ("loss", ""),
];

const LOAD: &[Key] = &[
    ("peak_force", "N"),
    ("force.0", "N"),
    ("force.1", "N"),
    ("force.2", "N"),
    ("time", "s"),
    ("impulse.0", "N s"),
    ("impulse.1", "N s"),
    ("impulse.2", "N s"),
];

const MAXIMA: &[Key] = &[
    ("von_mises", "Pa"),
    ("strain", ""),
    ("plastic_strain", ""),
    ("displacement", "m"),
];

const ENERGY: &[Key] = &[
    ("kinetic_initial", "J"),
    ("strain_initial", "J"),
    ("kinetic_final", "J"),
    ("strain_final", "J"),
    ("works.loads", "J"),
    ("works.contact", "J"),
    ("works.supports", "J"),
    ("works.obstacles", "J"),
    ("works.links", "J"),
    ("dissipations.scheme", "J"),
    ("dissipations.materials", "J"),
    ("dissipations.damping", "J"),
    ("dissipations.friction", "J"),
    ("dissipations.viscosity", "J"),
    ("dissipations.deletion", "J"),
    ("stored.hardening", "J"),
    ("stored.scheme", "J"),
    ("residual", "J"),
    ("largest_residual", "J"),
    ("largest", "J"),
    ("largest_hourglass", "J"),
    ("relative_residual", ""),
];

/// Momenta of which each has three components.
const MOMENTA: &[&str] = &[
    "initial",
    "final",
    "impulses.loads",
    "impulses.supports",
    "impulses.obstacles",
    "impulses.links",
    "residual",
];

const EXACT: &[Key] = &[
    ("force_error", ""),
    ("displacement_error", ""),
    ("peak_force", "N"),
    ("overshoot", ""),
    ("mean_overshoot", ""),
    ("impulse", "N s"),
    ("impulse_error", ""),
    ("restitution", ""),
    ("exact_restitution", ""),
];

const ZONES: &[Key] = &[
    ("work_of_links", "J"),
    ("relative_work_of_links", ""),
    ("passes_per_step", ""),
];

const NEWTON: &[Key] = &[
    ("iterations", ""),
    ("iterations_per_step", ""),
    ("most_iterations", ""),
    ("halvings", ""),
];

/// The names, as they are gathered.
#[derive(Default)]
struct Names(Vec<Quantity>);

impl Names {
    fn add(&mut self, table: &str, keys: &[Key]) {
        let named = keys.iter().map(|(key, unit)| Quantity {
            name: format!("{table}.{key}"),
            unit,
        });
        self.0.extend(named);
    }
}

/// The numbers of the summary of a model with their units; which of them a run has is known at its end. Counts of the work are none of them: a run
/// that goes on from a checkpoint has others.
pub fn quantities(system: &System, settings: &Settings) -> Vec<Quantity> {
    let mut names = Names::default();
    names.add("time", TIME);
    names.add("model", MODEL);
    for (k, contact) in system.contacts.iter().enumerate() {
        let table = format!("contacts.{}", contact.name);
        names.add(&table, CONTACT);
        names.add(&format!("{table}.statistics"), STATISTICS);
        if system.contacts[k].moment.is_some() {
            names.add(&format!("{table}.peak_moment"), MOMENT);
        }
        if system.contacts[k].friction.acts() {
            names.add(&format!("{table}.friction"), FRICTION);
        }
    }
    for level in &settings.levels {
        let table = format!("levels.{}", level.name);
        names.add(&format!("{table}.statistics"), STATISTICS);
        for (margin, unit) in MARGINS {
            names.add(
                &format!("{table}.{margin}"),
                &[("found", unit), ("margin", "")],
            );
        }
    }
    of_parts(system, &mut names);
    for (field, unit) in MAXIMA {
        names.add(
            &format!("maxima.{field}"),
            &[("value", unit), ("time", "s")],
        );
    }
    names.add("energy", ENERGY);
    momenta("momentum", "N s", &mut names);
    names.add("momentum", &[("size", "N s"), ("relative_residual", "")]);
    if system.is_nonlinear() && !system.axisymmetric {
        momenta("momentum.angular", "N m s", &mut names);
        names.add("momentum.angular", &[("relative_residual", "")]);
    }
    if settings.reference.is_some() {
        names.add("exact", EXACT);
    }
    if settings.zoning.is_some() {
        names.add("zones", ZONES);
    }
    if system.is_nonlinear() && settings.zoning.is_none() {
        names.add("newton", NEWTON);
    }
    names.0
}

/// Those of springs, dashpots, bolts, loads, and bodies with added mass.
fn of_parts(system: &System, names: &mut Names) {
    for body in &system.bodies {
        if let Body::Discrete(element) = body {
            let extent = match element.kind_name() {
                "dashpot" => "m/s",
                _ => "m",
            };
            let keys = [("peak_force", "N"), ("time", "s"), ("extent", extent)];
            names.add(&format!("discrete.{}", element.name()), &keys);
        }
        for bolt in body.bolts() {
            names.add(&format!("pretensions.{}", bolt.name), BOLT);
        }
        if body.added_mass() != 0.0 {
            names.0.push(Quantity {
                name: format!("model.added_mass.{}", body.name()),
                unit: "kg",
            });
        }
    }
    for load in &system.nonlinear.load_names {
        names.add(&format!("loads.{load}"), LOAD);
    }
}

fn momenta(table: &str, unit: &'static str, names: &mut Names) {
    for momentum in MOMENTA {
        let components = (0..3).map(|i| Quantity {
            name: format!("{table}.{momentum}.{i}"),
            unit,
        });
        names.0.extend(components);
    }
}

/// Units at the end of the names of columns, longer ones first.
const UNITS: [(&str, &str); 10] = [
    ("_n_m_s", "N m s"),
    ("_m_s2", "m/s²"),
    ("_n_s", "N s"),
    ("_n_m", "N m"),
    ("_m_s", "m/s"),
    ("_pa", "Pa"),
    ("_n", "N"),
    ("_j", "J"),
    ("_m", "m"),
    ("_s", "s"),
];

/// Forces per length in the section of a shell, whose columns end as moments do.
const PER_LENGTH: [&str; 2] = [".membrane_force_", ".shear_force_"];

/// The columns of `histories.csv` with their units.
///
/// # Errors
/// [`Error::TwinColumns`].
pub fn columns_with_units(system: &System, settings: &Settings) -> Result<Vec<Quantity>, Error> {
    let names = column_names(system, settings)?.into_iter();
    let named = names.map(|name| Quantity {
        unit: unit_of(&name),
        name,
    });
    Ok(named.collect())
}

fn unit_of(column: &str) -> &'static str {
    let ending = UNITS.iter().find(|(ending, _)| column.ends_with(ending));
    match ending.map_or("", |(_, unit)| unit) {
        "N m" if PER_LENGTH.iter().any(|force| column.contains(force)) => "N/m",
        unit => unit,
    }
}

#[cfg(test)]
mod tests {
    use super::unit_of;
    use crate::history::column;

    #[test]
    fn the_unit_of_a_column_is_the_one_that_its_name_was_made_with() {
        for unit in [
            "N m s", "m/s²", "N s", "N m", "m/s", "Pa", "N", "J", "m", "s", "",
        ] {
            assert_eq!(unit_of(&column(&["probe", "points", "some x"], unit)), unit);
        }
        assert_eq!(
            unit_of(&column(&["contact", "a_m", "closed points"], "")),
            ""
        );
        let force = column(&["probe", "a", "membrane force xx"], "N/m");
        assert_eq!(unit_of(&force), "N/m");
    }
}
