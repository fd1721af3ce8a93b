//! Names of the files of histories, and of their columns.

use std::ops::Range;

use carom_dynamics::System;

use crate::Error;
use crate::history::column;
use crate::results::Settings;
use crate::results::probed::Cells;
use crate::results::sensor::{COMPONENTS, ContactPoint, contact_point};
use crate::rows::unique;

/// What a probe of a contact tells, with its unit.
const AT_POINTS: [(&str, &str); 3] = [
    ("contact force", "N"),
    ("contact pressure", "Pa"),
    ("gap", "m"),
];

const FILE: &str = "histories.csv";
const CONTACT_FILE: &str = "contact.csv";

/// Names of the two files.
pub(super) fn files(settings: &Settings) -> [String; 2] {
    let ending = if settings.compress_histories {
        ".gz"
    } else {
        ""
    };
    [FILE, CONTACT_FILE].map(|name| name.to_owned() + ending)
}

/// Names of a motion with its unit, in the order displacement, velocity, acceleration.
const MOTIONS: [(&str, &str); 3] = [
    ("displacement", "m"),
    ("velocity", "m/s"),
    ("acceleration", "m/s²"),
];

/// The axes about which supports have moments.
pub(super) fn moments(system: &System) -> Range<usize> {
    match (system.axisymmetric, system.dim) {
        (false, 2) => 2..3,
        (false, 3) => 0..3,
        _ => 0..0,
    }
}

/// Whether elements are deleted.
pub(super) fn deletes(system: &System) -> bool {
    system.bodies.iter().any(|body| body.has_deletion())
}

/// The axes about which angular momentum is shown: of linear models none, as theirs is that of small displacements.
pub(super) fn turns(system: &System) -> Range<usize> {
    match (system.is_nonlinear() && !system.axisymmetric, system.dim) {
        (true, 2) => 2..3,
        (true, 3) => 0..3,
        _ => 0..0,
    }
}

/// Names of the columns of what a contact did.
pub(super) fn contact_columns(system: &System, k: usize) -> Vec<String> {
    let contact = &system.contacts[k].name;
    let add = |what: &str, unit| column(&["contact", contact, what], unit);
    let mut names = vec![add("force", "N")];
    let impulsive = system.has_impulses(k);
    names.extend(impulsive.then(|| add("impulsive", "N s")));
    let resultant = |i: &&str| add(&format!("resultant {i}"), "N");
    names.extend(COMPONENTS[..system.dim].iter().map(resultant));
    if system.contacts[k].moment.is_some() {
        let turns = &COMPONENTS[moments(system)];
        names.extend(turns.iter().map(|i| add(&format!("moment {i}"), "N m")));
    }
    names.extend([
        add("gap", "m"),
        add("gap rate", "m/s"),
        add("closed points", ""),
    ]);
    if system.contacts[k].friction.acts() {
        names.extend([add("friction", "N"), add("slipping points", "")]);
    }
    names
}

/// Names of the columns that a run will have.
///
/// # Errors
/// [`Error::TwinColumns`].
pub(super) fn column_names(system: &System, settings: &Settings) -> Result<Vec<String>, Error> {
    let point = contact_point(system, settings.reference.as_ref(), None);
    columns(system, settings, point.as_ref())
}

/// Names of the columns.
///
/// # Errors
/// [`Error::TwinColumns`]: two probes, say, whose names differ by a capital only.
pub(crate) fn columns(
    system: &System,
    settings: &Settings,
    point: Option<&ContactPoint>,
) -> Result<Vec<String>, Error> {
    let components = &COMPONENTS[..system.dim];
    let mut names = vec![column(&["time"], "s")];
    for (k, contact) in system.contacts.iter().enumerate() {
        names.extend(contact_columns(system, k));
        if let Some(point) = point.filter(|point| point.contact == k) {
            for side in &["secondary", "primary"][..point.sides.len()] {
                for (motion, unit) in MOTIONS {
                    names.push(column(&["contact", &contact.name, side, motion], unit));
                }
            }
        }
    }
    for discrete in system.bodies.iter().filter_map(|body| body.as_discrete()) {
        let (kind, name) = (discrete.kind_name(), discrete.name());
        let extent = match kind {
            "dashpot" => ("rate", "m/s"),
            _ => ("elongation", "m"),
        };
        for direction in 0..discrete.told_directions() {
            for (what, unit) in [("force", "N"), extent] {
                let what = match discrete.directions() {
                    1 => what.to_owned(),
                    _ => format!("{what} {}", COMPONENTS[direction]),
                };
                names.push(column(&[kind, name, &what], unit));
            }
        }
    }
    for bolt in system.bodies.iter().flat_map(|body| body.bolts()) {
        names.push(column(&["pretension", &bolt.name, "force"], "N"));
    }
    for probe in &settings.probes {
        for ((motion, unit), _) in MOTIONS.iter().zip(probe.recorded()).filter(|(_, on)| *on) {
            let of = |i| column(&["probe", &probe.name, &format!("{motion} {i}")], unit);
            names.extend(components.iter().map(of));
        }
        if probe.absolute_acceleration {
            let of = |i| {
                let what = format!("absolute acceleration {i}");
                column(&["probe", &probe.name, &what], "m/s²")
            };
            names.extend(components.iter().map(of));
        }
    }
    for probe in &settings.probes {
        names.extend(Cells::new(system, probe).columns(system, probe));
    }
    for probe in settings.probes.iter().filter(|probe| probe.contact) {
        let of = |(what, unit): &(&str, &str)| column(&["probe", &probe.name, what], unit);
        names.extend(AT_POINTS.iter().map(of));
    }
    for support in &system.supports {
        let add = |what: String, unit| column(&["support", &support.name, &what], unit);
        names.extend(components.iter().map(|i| add(format!("force {i}"), "N")));
        let turns = &COMPONENTS[moments(system)];
        names.extend(turns.iter().map(|i| add(format!("moment {i}"), "N m")));
    }
    for load in &system.nonlinear.load_names {
        let of = |i: &&str| column(&["load", load, &format!("force {i}")], "N");
        names.extend(components.iter().map(of));
    }
    let energies = [
        ["energy", "kinetic"],
        ["energy", "strain"],
        ["energy", "scheme"],
        ["work", "loads"],
        ["work", "contact"],
        ["dissipation", "scheme"],
        ["energy", "residual"],
    ];
    names.extend(energies.map(|path| column(&path, "J")));
    let links = settings
        .zoning
        .as_ref()
        .map(|_| column(&["work", "links"], "J"));
    names.extend(links);
    if system.is_nonlinear() {
        let further = [
            ["energy", "hardening"],
            ["work", "supports"],
            ["dissipation", "material"],
            ["dissipation", "damping"],
            ["dissipation", "friction"],
            ["work", "obstacles"],
            ["dissipation", "viscosity"],
            ["energy", "hourglass"],
        ];
        names.extend(further.map(|path| column(&path, "J")));
    }
    if deletes(system) {
        names.push(column(&["dissipation", "deletion"], "J"));
        names.push(column(&["status", "deleted elements"], ""));
    }
    names.extend(components.iter().map(|i| column(&["momentum", i], "N s")));
    let residual = |i: &&str| column(&["momentum", &format!("residual {i}")], "N s");
    names.extend(components.iter().map(residual));
    let turns = &COMPONENTS[turns(system)];
    names.extend(
        turns
            .iter()
            .map(|i| column(&["angular momentum", i], "N m s")),
    );
    let residual = |i: &&str| column(&["angular momentum", &format!("residual {i}")], "N m s");
    names.extend(turns.iter().map(residual));
    names.push(column(&["status", "passes"], ""));
    unique(&settings.folder.join(FILE), &names)?;
    Ok(names)
}
