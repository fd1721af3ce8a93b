//! What `carom check` says of a model in the words of a workshop: how large, heavy and fast it is, what its records have, what meets first. A unit that
//! is not the one that was meant shows here.

use carom_dynamics::System;
use carom_pages::plot::{digits, quantity};

use crate::facts::{Approach, Fact, courant_number, fact, facts_with};
use crate::lower::Built;

/// Sizes, speeds and times of a case.
pub fn facts(built: &Built) -> Vec<Fact> {
    facts_with(built, |approaches| words(built, approaches))
}

/// Speed of waves, m/s, above that of any solid: beryllium has 13 km/s, diamond 18 km/s.
const FAST: f64 = 2e4;

/// One line each; `approaches`: of all contacts.
pub(crate) fn words(built: &Built, approaches: &[Approach]) -> Vec<Fact> {
    let system = &built.system;
    let mut facts = vec![fact("size", size(system)), fact("mass", mass(system))];
    facts.extend(waves(system).map(|told| fact("waves", told)));
    let signals = built.signals.iter();
    facts.extend(signals.map(|(name, told)| fact(format!("signal {name}"), told.clone())));
    if let (None, Some(number)) = (&built.zoned, courant_number(system)) {
        let told = format!(
            "a wave goes through {} of the smallest elements",
            digits(number, 3)
        );
        facts.push(fact("in a step", told));
    }
    facts.push(fact("meets first", meets_first(built, approaches)));
    facts
}

/// Lengths of the box around the model along the axes.
fn size(system: &System) -> String {
    let side = |i: usize| {
        let values = system.x.iter().map(|x| x[i]);
        let ends = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        });
        quantity((ends[1] - ends[0]).max(0.0), "m")
    };
    let sides: Vec<String> = (0..system.dim).map(side).collect();
    sides.join(" x ")
}

/// The mass of all bodies, and those of the lightest and the heaviest of several.
fn mass(system: &System) -> String {
    let bodies = system.bodies.iter().enumerate();
    let masses = bodies.map(|(number, body)| (system.body_mass(number), body.name()));
    let masses: Vec<(f64, &str)> = masses.filter(|(mass, _)| *mass > 0.0).collect();
    let by_mass = |a: &&(f64, &str), b: &&(f64, &str)| a.0.total_cmp(&b.0);
    let ends = masses
        .iter()
        .min_by(by_mass)
        .zip(masses.iter().max_by(by_mass));
    let total = of_mass(masses.iter().map(|(mass, _)| mass).sum());
    match ends {
        Some(((least, lightest), (most, heaviest))) if masses.len() > 1 => format!(
            "{total} in all, from {} (`{lightest}`) to {} (`{heaviest}`)",
            of_mass(*least),
            of_mass(*most)
        ),
        _ => total,
    }
}

/// A mass in t, kg, or parts of g.
fn of_mass(kilograms: f64) -> String {
    match kilograms {
        mass if mass >= 1e3 => format!("{} t", digits(mass / 1e3, 4)),
        mass if mass >= 1.0 => format!("{} kg", digits(mass, 4)),
        mass => quantity(1e3 * mass, "g"),
    }
}

/// The slowest and the fastest waves of bodies that have some.
fn waves(system: &System) -> Option<String> {
    let bodies = system.bodies.iter();
    let speeds = bodies.filter_map(|body| Some((body.wave_speed()?, body.name())));
    let speeds: Vec<(f64, &str)> = speeds.filter(|(speed, _)| *speed > 0.0).collect();
    let by_speed = |a: &&(f64, &str), b: &&(f64, &str)| a.0.total_cmp(&b.0);
    let (slow, fast) = speeds
        .iter()
        .min_by(by_speed)
        .zip(speeds.iter().max_by(by_speed))?;
    let told = match slow.0 == fast.0 {
        true => format!("{} m/s", digits(slow.0, 4)),
        false => format!(
            "{} m/s in `{}` to {} m/s in `{}`",
            digits(slow.0, 4),
            slow.1,
            digits(fast.0, 4),
            fast.1
        ),
    };
    let doubt = "; no solid has waves as fast as that: are the units of its density and of its stiffness the ones that are meant?";
    Some(told + if fast.0 > FAST { doubt } else { "" })
}

/// What closes first, if bodies go on as they begin.
fn meets_first(built: &Built, approaches: &[Approach]) -> String {
    let system = &built.system;
    if approaches.is_empty() {
        return "no contact is declared: bodies go through each other".to_owned();
    }
    let all = approaches.iter().enumerate();
    let near = all.filter(|(_, approach)| approach.impact <= built.end);
    let Some((number, first)) = near.min_by(|a, b| a.1.impact.total_cmp(&b.1.impact)) else {
        return "nothing before the end, as bodies move at the start".to_owned();
    };
    let name = |body: usize| format!("`{}`", system.bodies[body].name());
    let secondary = system.contacts[number].secondary_body;
    let both = match system.contacts[number].primary_body {
        Some(primary) if primary == secondary => format!("{} with itself", name(secondary)),
        Some(primary) => format!("{} and {}", name(secondary), name(primary)),
        None => name(secondary),
    };
    let when = match first.impact {
        0.0 => "at the start".to_owned(),
        time => format!("after {}", quantity(time, "s")),
    };
    let speed = match first.speed > 0.0 {
        true => format!(", which close with {}", quantity(first.speed, "m/s")),
        false => String::new(),
    };
    format!(
        "{both} (contact `{}`) {when}{speed}",
        system.contacts[number].name
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masses_are_told_in_the_unit_of_their_size() {
        let told = [17_506_265.0, 1285.08, 1.285_083, 5.146e-3, 8.16e-12].map(of_mass);
        assert_eq!(
            told,
            ["17506 t", "1.285 t", "1.285 kg", "5.15 g", "8.16·10⁻⁹ g"]
        );
    }
}
