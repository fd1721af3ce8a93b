//! What can be said of a case before it runs.

use std::sync::Arc;

use carom_bodies::{
    Beam, BeamTheory, Body, Bolt, Discrete, DiscreteKind, Link, SectionProperties, Shell,
};
use carom_contact::{Contact, Integration, Rows, Search, Sliding, Target};
use carom_dynamics::{ModelLink, System, step_count};
use carom_mesh::Parts;
use carom_zones::{LinkKind, ModelZone, Zoned};

use crate::accelerations::accelerations;
use crate::lower::{Built, plural};

/// A line of `carom check`: what, and how much.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fact {
    /// What.
    pub name: String,
    /// How much, with units.
    pub value: String,
}

pub(crate) fn fact(name: impl Into<String>, value: impl Into<String>) -> Fact {
    Fact {
        name: name.into(),
        value: value.into(),
    }
}

/// Sizes, speeds and times of a case; `words`: what is said of it in words, of the approaches of its contacts.
pub(crate) fn facts_with(built: &Built, words: impl FnOnce(&[Approach]) -> Vec<Fact>) -> Vec<Fact> {
    let system = &built.system;
    let elements: usize = system.bodies.iter().map(|body| body.cells().len()).sum();
    let held = system.fixed.iter().filter(|fixed| **fixed).count();
    let cells = system.bodies.iter().flat_map(|body| body.cells());
    let parts = Parts::new(&system.mesh, cells.copied());
    let mut facts = vec![fact(
        "model",
        format!(
            "{}D, {} nodes, {elements} elements, {} unknowns ({held} held), {}, {} contact points",
            system.dim,
            system.x.len(),
            system.unknowns(),
            plural(parts.count(), "connected part"),
            system.points()
        ),
    )];
    let (accelerations, start) = (accelerations(system), &system.initial.displacement);
    let contacts = 0..system.contacts.len();
    let approaches = contacts.map(|k| approach(system, &accelerations, (k, start)));
    let approaches: Vec<Approach> = approaches.collect();
    facts.extend(words(&approaches));
    for (k, body) in system.bodies.iter().enumerate() {
        let Some(body) = body.as_solid() else {
            facts.extend(body.as_discrete().map(discrete_fact));
            facts.extend(
                body.as_reduced()
                    .map(|reduced| reduced_fact(built, k, reduced)),
            );
            if let Some(beam) = body.as_beam() {
                facts.push(beam_fact(system, k, beam));
                let bolts = body.bolts().iter();
                facts.extend(bolts.map(|bolt| bolt_fact(bolt, "a cell")));
            }
            facts.extend(body.as_shell().map(|shell| shell_fact(system, k, shell)));
            continue;
        };
        let (speed, size) = (body.wave_speed(), extent(system, k));
        let added = match body.added_mass() {
            0.0 => String::new(),
            added => format!(" ({added:.6} kg of them by mass scaling)"),
        };
        facts.push(fact(
            format!("body {}", body.name()),
            format!(
                "{}, {:.6} kg{added}, waves at {speed:.5} m/s, {:.4e} s to cross its {size:.4} m, smallest element {:.4e} m",
                body.kinematics().name(),
                system.body_mass(k),
                size / speed,
                body.smallest_size()
            ),
        ));
    }
    for (k, contact) in system.contacts.iter().enumerate() {
        facts.push(fact(
            format!("contact {}", contact.name),
            contact_facts(built, &approaches[k], k),
        ));
    }
    let begin = built.stage.map_or(0.0, |(end, _)| end);
    if let Some((end, steps)) = built.stage {
        let value = format!(
            "{steps} steps of {:.6e} s to {end:.4e} s",
            end / f64::from(steps)
        );
        facts.push(fact("static stage", value));
        if end == built.end {
            return facts;
        }
    }
    let damped = system.modal.iter();
    facts.extend(damped.map(|modal| modal_fact(system.bodies[modal.body].name(), &modal.modes)));
    let steps = format!(
        "{} steps of {:.6e} s{}",
        step_count(built.end - begin, system.dt),
        system.dt,
        match system.adaptive {
            Some(rules) => format!(" or less, down to {:.2e} s", rules.smallest),
            None if system.critical_fraction.is_some() && system.is_nonlinear() =>
                " at first".to_string(),
            None => String::new(),
        }
    );
    let scheme = system.scheme.get();
    let time = match built.zoned {
        None => format!("{}, {steps} ({})", scheme.name(), courant(system)),
        Some(_) => format!("{steps}, the outer ones,"),
    };
    facts.push(fact("time", format!("{time} to {:.4e} s", built.end)));
    if let Some(zoned) = &built.zoned {
        facts.extend(zone_facts(zoned));
        facts.extend(joint_facts(built, zoned));
    } else if scheme.is_explicit() {
        facts.push(fact(
            "critical step",
            format!("{:.6e} s, from element eigenvalues", system.critical_step()),
        ));
    }
    facts
}

/// Error of a frequency up to which it counts as that of the full body.
const BAND: f64 = 1e-3;

/// A line for a reduced body: what it is reduced to, and how far its modes go.
fn reduced_fact(built: &Built, body: usize, reduced: &carom_bodies::Reduced) -> Fact {
    let system = &built.system;
    let file = built
        .reductions
        .iter()
        .find(|(name, _)| name == reduced.name());
    let file = file.map_or_else(String::new, |(_, told)| format!("; {told}"));
    let data = reduced.reduction();
    let modes = data.frequencies.len();
    let mass = if data.is_massless {
        " without mass"
    } else {
        ""
    };
    let highest = data.frequencies.last().copied().unwrap_or(0.0);
    let band = match data.band(BAND) {
        Some((count, last)) => {
            format!("its lowest {count} frequencies, to {last:.4e} Hz, within 0.1 % by estimate")
        }
        None => "none of its frequencies within 0.1 % by estimate".to_owned(),
    };
    let unmoved = data.unmoved.map_or_else(String::new, |parts| {
        let parts = &parts[..system.dim];
        let percent: Vec<String> = parts
            .iter()
            .map(|part| format!("{:.2}", 100.0 * part))
            .collect();
        format!(", residual mass {} % along the axes", percent.join(", "))
    });
    fact(
        format!("body {}", reduced.name()),
        format!(
            "reduced from {} unknowns to {} of {} retained nodes{mass} and {modes} modes up to {highest:.4e} Hz; {band}{unmoved}; {:.6} kg{file}",
            data.unknowns.len(),
            data.len() - modes,
            data.retained.len(),
            system.body_mass(body)
        ),
    )
}

/// A line for the damping of modes.
fn modal_fact(body: &str, modes: &[[f64; 2]]) -> Fact {
    let ends = |column: usize| {
        let values = modes.iter().map(|mode| mode[column]);
        let least = values.clone().fold(f64::INFINITY, f64::min);
        (least, values.fold(0.0, f64::max))
    };
    let [(low, high), (least, most)] = [0, 1].map(ends);
    let ratio = match least == most {
        true => format!("{least}"),
        false => format!("{least} to {most}"),
    };
    fact(
        format!("damping of modes of {body}"),
        format!(
            "{} modes from {low:.4e} to {high:.4e} Hz, ratio {ratio}",
            modes.len()
        ),
    )
}

/// A line for beams: theory, section, mass, waves.
fn beam_fact(system: &System, body: usize, beam: &Beam) -> Fact {
    let (section, speed) = (beam.section(), beam.wave_speed());
    let theory = match section.theory {
        BeamTheory::Timoshenko => "timoshenko",
        BeamTheory::EulerBernoulli => "euler-bernoulli",
    };
    let SectionProperties {
        area,
        second_moments: [y, z],
        torsion,
        ..
    } = section.properties;
    let bending = match system.dim {
        2 => format!("I_z {z:.6e} m^4"),
        _ => format!("I_y {y:.6e} m^4, I_z {z:.6e} m^4, torsion {torsion:.6e} m^4"),
    };
    let fibres = beam.fibres().map_or(String::new(), |count| {
        format!("{count} fibres in a section, ")
    });
    fact(
        format!("body {}", beam.name()),
        format!(
            "{theory} beam, area {area:.6e} m^2, {bending}, {fibres}{:.6} kg, waves of extension at {speed:.5} m/s, smallest element {:.4e} m",
            system.body_mass(body),
            beam.smallest_size()
        ),
    )
}

/// A line for shells: section, mass, waves.
fn shell_fact(system: &System, body: usize, shell: &Shell) -> Fact {
    let [least, most] = shell.thickness_range();
    let thickness = match most - least > 1e-9 * most {
        true => format!("mean thickness {least:.6e} to {most:.6e} m"),
        false => format!("thickness {:.6e} m", shell.section().thickness),
    };
    let rotations = match shell.turns() {
        true => "finite",
        false => "small",
    };
    fact(
        format!("body {}", shell.name()),
        format!(
            "shell of {} elements, {thickness}, {rotations} rotations, {:.6} kg, membrane waves at {:.5} m/s, smallest element {:.4e} m",
            shell.cells().len(),
            system.body_mass(body),
            shell.wave_speed(),
            shell.smallest_size()
        ),
    )
}

/// A line for a cell of beams or a section of a solid that is tightened.
fn bolt_fact(bolt: &Bolt, what: &str) -> Fact {
    let Bolt {
        force, stiffness, ..
    } = bolt;
    fact(
        format!("pretension {}", bolt.name),
        format!("{force:.6e} N, {what} of stiffness {stiffness:.6e} N/m"),
    )
}

/// A line for discrete elements: how many, and what they are.
fn discrete_fact(discrete: &Discrete) -> Fact {
    let count = discrete.cells().len();
    let linked = |link: &Link, [what, unit]: [&str; 2]| {
        let way = match link.axis {
            Some([x, y, z]) => format!("along ({x:.4}, {y:.4}, {z:.4})"),
            None => "in all directions".to_owned(),
        };
        match link.curve.is_line() {
            true => format!("{what} {:.6e} {unit}, {way}", link.curve.slope(0.0)),
            false => format!("a curve of {} points, {way}", link.curve.points().len()),
        }
    };
    let (kind, text) = match discrete.kind() {
        DiscreteKind::Mass(point) => ("mass", format!("{:.6} kg", point.mass)),
        DiscreteKind::Spring(link) => ("spring", linked(link, ["stiffness", "N/m"])),
        DiscreteKind::Fluid(gap) => (
            "fluid",
            format!("{:.6} kg added to the inner node", gap.masses[0]),
        ),
        DiscreteKind::Bolt(bolt) => (
            "pretension",
            format!(
                "{:.6e} N, {}",
                bolt.force,
                linked(&bolt.link, ["stiffness", "N/m"])
            ),
        ),
        DiscreteKind::Dashpot(link) => ("dashpot", linked(link, ["damping", "N s/m"])),
    };
    let places = match count {
        1 => String::new(),
        count => format!("{count} times "),
    };
    fact(format!("{kind} {}", discrete.name()), places + &text)
}

/// Step over the least time in which a wave crosses an element; none without waves.
pub(crate) fn courant_number(system: &System) -> Option<f64> {
    let crossing = system
        .bodies
        .iter()
        .map(Body::passage)
        .filter(|passage| *passage > 0.0)
        .fold(f64::INFINITY, f64::min);
    crossing.is_finite().then(|| system.dt / crossing)
}

fn courant(system: &System) -> String {
    let number = courant_number(system);
    number.map_or("no waves".to_owned(), |number| {
        format!("Courant number {number:.3}")
    })
}

/// A line for each zone: bodies, scheme, steps.
fn zone_facts(zoned: &Zoned) -> Vec<Fact> {
    let systems = zoned.systems().unwrap_or_default();
    let zone = |(zone, system): (&ModelZone, &Arc<System>)| {
        let bodies: Vec<&str> = system.bodies.iter().map(|body| body.name()).collect();
        let scheme = system.scheme.get();
        let critical = match scheme.is_explicit() {
            true => format!(", critical step {:.4e} s", system.critical_step()),
            false => String::new(),
        };
        fact(
            format!("zone {}", zone.name),
            format!(
                "{}: {}, {} per outer step, of {:.4e} s ({}){critical}",
                bodies.join(", "),
                scheme.name(),
                match zone.substeps {
                    1 => "1 step".to_string(),
                    steps => format!("{steps} steps"),
                },
                system.dt,
                courant(system)
            ),
        )
    };
    zoned.zones.iter().zip(&systems).map(zone).collect()
}

/// A line for each joint: rows, link, and the sizes of overlaps.
fn joint_facts(built: &Built, zoned: &Zoned) -> Vec<Fact> {
    let kind = match zoned.kind {
        LinkKind::GravouilCombescure => "gravouil-combescure",
        LinkKind::PrakashHjelmstad => "prakash-hjelmstad",
    };
    let unit = ["m", "m", "m^2", "m^3"][built.system.dim];
    let joint = |link: &ModelLink| {
        let rows = format!("{} constraints, {kind}", link.rows.len());
        let overlap = built.overlaps.iter().find(|one| one.name == link.name);
        let Some(overlap) = overlap else {
            return fact(format!("interface {}", link.name), rows);
        };
        let [inner, outer] = overlap.sizes;
        fact(
            format!("overlap {}", link.name),
            format!(
                "{:.4e} {unit}, {:.2} outer cells wide, cells of {inner:.4e} m on {outer:.4e} m, {} outer cells removed, {rows}",
                overlap.measure, overlap.layers, overlap.removed
            ),
        )
    };
    zoned.links.iter().map(joint).collect()
}

/// Largest extent of a body along the axes, m.
fn extent(system: &System, body: usize) -> f64 {
    let mut largest: f64 = 0.0;
    for i in 0..system.dim {
        let places = system.body_masses[body]
            .iter()
            .map(|&(node, _)| system.x[node as usize][i]);
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        largest = largest.max(high - low);
    }
    largest
}

/// How the two sides of a contact come together as the run begins.
pub(crate) struct Approach {
    /// Least gap, m; infinite where nothing faces anything.
    pub(crate) gap: f64,
    /// Fastest closing, m/s; zero where nothing closes.
    pub(crate) speed: f64,
    /// When a point closes first, s, if bodies go on as they begin: rigid, with their initial velocities and the mean accelerations
    /// of the dead loads; infinite where nothing closes.
    pub(crate) impact: f64,
    points: usize,
}

/// `accelerations`: see [`accelerations`](crate::accelerations::accelerations); `u`: displacement, m.
pub(crate) fn approach(
    system: &System,
    accelerations: &[f64],
    (contact, u): (usize, &[f64]),
) -> Approach {
    let places = system.places(0.0, u, &system.initial.frames);
    let mut rows = Rows::default();
    rows.clear();
    system.contacts[contact].pair(&places, &mut Search::default(), &mut rows);
    let mut approach = Approach {
        gap: f64::INFINITY,
        speed: 0.0,
        impact: f64::INFINITY,
        points: rows.len(),
    };
    for point in 0..rows.len() {
        let gap = rows.gap(point);
        approach.gap = approach.gap.min(gap);
        if !gap.is_finite() {
            continue;
        }
        let speed = closing(&rows, point, &system.initial.velocity, rows.rate(point));
        let pull = closing(&rows, point, accelerations, 0.0);
        approach.speed = approach.speed.max(speed);
        approach.impact = approach.impact.min(first_closing(gap, speed, pull));
    }
    approach
}

/// How fast a point closes under these velocities of the unknowns and this rate of its obstacle; zero below the rounding of the
/// terms that cancel, as those of bodies that move together.
fn closing(rows: &Rows, point: usize, v: &[f64], rate: f64) -> f64 {
    const ROUNDING: f64 = 1e-12;
    let (unknowns, coefficients) = rows.row(point);
    let terms = unknowns.iter().zip(coefficients);
    let terms = terms.map(|(&unknown, n)| n * v[unknown as usize]);
    let (sum, size) = terms.fold((rate, rate.abs()), |(sum, size), term| {
        (sum + term, size + term.abs())
    });
    match sum.abs() > ROUNDING * size {
        true => -sum,
        false => 0.0,
    }
}

/// The least t of `gap = speed t + pull t²/2`, s; infinite if there is none.
fn first_closing(gap: f64, speed: f64, pull: f64) -> f64 {
    let gap = gap.max(0.0);
    let approaches = speed > 0.0 || (speed == 0.0 && pull > 0.0);
    if gap == 0.0 && approaches {
        return 0.0;
    }
    let root = (speed * speed + 2.0 * pull * gap).sqrt();
    match speed + root > 0.0 {
        true => 2.0 * gap / (speed + root),
        // no root: they part, or turn before they meet
        false => f64::INFINITY,
    }
}

fn contact_facts(built: &Built, approach: &Approach, contact: usize) -> String {
    let system = &built.system;
    let pair = &system.contacts[contact];
    let law = pair.law.get().name();
    let sliding = match pair.sliding {
        Sliding::Small => "small",
        Sliding::Finite => "finite",
    };
    let gap = match approach.gap.is_finite() {
        true => format!("least gap {:.4e} m", approach.gap),
        false => "nothing opposite at the start".to_string(),
    };
    let impact = match approach.impact {
        impact if impact <= built.end => format!("first possible impact at {impact:.4e} s"),
        impact if impact.is_finite() => {
            "no impact before the end, as bodies move at the start".to_string()
        }
        _ => "nothing approaches at the start".to_string(),
    };
    format!(
        "{law} law, {} points {}, {sliding} sliding, {gap}, {impact}{}",
        approach.points,
        where_it_holds(system, contact),
        touching(pair, approach.gap)
    )
}

/// Where the law of a contact holds, and whether its faces are quadratic, which decides the default.
fn where_it_holds(system: &System, contact: usize) -> String {
    let pair = &system.contacts[contact];
    let place = match pair.integration {
        Integration::Node => "at nodes",
        Integration::Points => "at Gauss points",
        Integration::Weak { .. } => "at Gauss points in the weak form",
        Integration::Mortar { .. } => "by mortar",
    };
    let primary = match &pair.target {
        Target::Surface(faces) => &faces[..],
        Target::Rigid(_) => &[],
    };
    let mut faces = system.contacts[contact]
        .secondary_faces
        .iter()
        .chain(primary);
    match faces.any(|face| face.kind.table().is_quadratic()) {
        true => format!("{place} (quadratic faces)"),
        false => place.to_string(),
    }
}

/// Mean gaps that count from where they are. `least`: gap at the start, m; one that is open has the offset of a clearance.
fn touching(pair: &Contact, least: f64) -> String {
    let deepest = pair.offsets.iter().copied().fold(0.0, f64::max);
    match deepest > 0.0 && least <= 1e-9 * deepest {
        true => format!(", mean gaps down to -{deepest:.4e} m at the start count as zero"),
        false => String::new(),
    }
}
