//! The model as a whole from its parts: motion, forces and contact points.

use std::ops::Range;

use crate::places::Places;
use crate::zones::Zones;
use carom_dynamics::Driver;
use carom_dynamics::state::InterfaceState;
use carom_system::{Motion, System};

/// Makes the motion of the whole that of a part where it has its own unknowns.
pub(super) fn take_motion(whole: &mut Motion, (motion, places): (&Motion, &Places)) {
    for &(from, to) in &places.own {
        let (from, to) = (from as usize, to as usize);
        whole.u[to] = motion.u[from];
        whole.v[to] = motion.v[from];
        whole.a[to] = motion.a[from];
    }
    for &(from, to) in &places.frames {
        whole.frames[to] = motion.frames[from];
    }
    for (from, to) in &places.histories {
        whole.history[to.clone()].copy_from_slice(&motion.history[from.clone()]);
    }
}

/// Adds the forces of a part to those of the whole.
pub(super) fn add_forces(whole: &mut Motion, (motion, places): (&Motion, &Places)) {
    let forces = [
        &motion.internal_force,
        &motion.contact_force,
        &motion.link_force,
    ];
    for (whole, force) in forces_mut(whole).into_iter().zip(forces) {
        // a part without links has no link forces
        for &(from, to) in places.unknowns.iter().filter(|_| !force.is_empty()) {
            whole[to as usize] += force[from as usize];
        }
    }
}

/// Makes the points of the whole what they are in a part.
pub(super) fn take_points(
    whole: &mut InterfaceState,
    (interface, places): (&InterfaceState, &Places),
) {
    if !interface.friction.is_empty() {
        whole.friction.resize(whole.force.len(), [0.0; 2]);
    }
    for &(from, to) in &places.points {
        whole.take_point(to as usize, (interface, from as usize));
    }
}

pub(super) fn forces_mut(motion: &mut Motion) -> [&mut Vec<f64>; 3] {
    [
        &mut motion.internal_force,
        &mut motion.contact_force,
        &mut motion.link_force,
    ]
}

/// The assembly of the model of an unknown of a zone.
fn assembly_of(unknown: u32, (places, system): (&Places, &System)) -> usize {
    let place = places.unknowns.partition_point(|(own, _)| *own < unknown);
    let (_, whole) = places.unknowns[place];
    system.assemblies.of_part[system.part_of(whole as usize)]
}

/// The assembly of the model to which each one of each zone belongs.
pub(super) fn assemblies_of_zones(
    zones: &Zones,
    (places, system): (&[Places], &System),
) -> Vec<Vec<usize>> {
    let of_zone = |(driver, places): (&Driver, &Places)| {
        let own = driver.system();
        let assemblies = own.assemblies.all.iter();
        let first = assemblies.map(|assembly| own.parts[assembly.parts[0]].start as u32);
        first
            .map(|unknown| assembly_of(unknown, (places, system)))
            .collect()
    };
    zones.drivers().iter().zip(places).map(of_zone).collect()
}

/// That of the rows of each link and constraint.
pub(super) fn assemblies_of_links(
    zones: &Zones,
    (places, system): (&[Places], &System),
) -> Vec<usize> {
    let of_link = |(_, rows): &(String, Range<usize>)| {
        let terms = zones
            .links
            .rows
            .iter()
            .zip(places)
            .find_map(|(own, places)| {
                let mut own = own
                    .iter()
                    .filter(|(row, _)| rows.contains(&(*row as usize)));
                let (unknown, _) = own.find_map(|(_, terms)| terms.first())?;
                Some((*unknown, places))
            });
        terms.map_or(0, |(unknown, places)| {
            assembly_of(unknown, (places, system))
        })
    };
    zones.links().iter().map(of_link).collect()
}
