//! Whether what is assumed small has stayed small: strain and rotation of bodies at small strain, and what contacts of small
//! sliding are paired with.
//!
//! The driver looks at each of the first steps, at every 32nd then, and whenever the strain energy has grown by a quarter
//! since the largest at which it looked: near the largest strain of a run it therefore looks at it. The looks of the last
//! kind are few, since between a thousandth of the energy and all of it there are only so many quarters: 31. They are those of
//! an assembly by itself, so that they do not depend on bodies that have nothing to do with it.

use carom_bodies::{Bending, Extreme};
use serde::{Deserialize, Serialize};

use crate::system::System;

/// Steps before which there is a look at each.
const FIRST: u64 = 8;
/// Steps from one look to the next after them.
const EVERY: u64 = 32;
/// Strain energy over the largest at a look, at which there is another.
const GROWTH: f64 = 1.25;
/// Part of the largest energy of the run below which strain energy is no reason to look: rounding grows by quarters too.
const LEAST: f64 = 1e-3;

/// The largest value of something over the looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Largest {
    /// The value.
    pub value: f64,
    /// Where.
    pub place: u32,
    /// When, s.
    pub time: f64,
}

impl Largest {
    pub(crate) fn take(&mut self, value: f64, place: u32, time: f64) {
        if value > self.value {
            *self = Largest { value, place, time };
        }
    }

    pub(crate) fn extreme(&self) -> Extreme {
        Extreme {
            value: self.value,
            cell: self.place,
        }
    }
}

/// Energies of the elements of a body that may lock in bending, at the look at which they stored most.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Locking {
    /// Strain energy, J.
    pub energy: f64,
    /// The part of it by which they lock ([`Bending`]), J.
    pub locked: f64,
    /// When, s.
    pub time: f64,
}

impl Locking {
    pub(crate) fn take(&mut self, found: Bending, time: f64) {
        if found.energy > self.energy {
            *self = Locking {
                energy: found.energy,
                locked: found.locked,
                time,
            };
        }
    }
}

/// What is found in a body. Places are those in [`Body::cells`](carom_bodies::Body::cells).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SmallStrain {
    /// Rotation of an element, rad.
    pub rotation: Largest,
    /// Principal strain of an element, in size.
    pub strain: Largest,
    /// How far its elements lock in bending; at finite strain too.
    pub locking: Locking,
    /// Way of the ends of a spring, a dashpot or a fluid gap across its axis, m.
    pub across: Largest,
    /// The largest way of the same ends along it then, m.
    pub along: f64,
}

/// A contact of small sliding, beside one that is paired anew. Places are nodes of the mesh; lengths are counted in faces: in
/// mean edges of the smallest face of the primary surface where the point was paired, or of the secondary one where there is
/// none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SmallSliding {
    /// Way along the surface, in faces, of a point with a force.
    pub slide: Largest,
    /// Turn of the normal of a point with a force, rad.
    pub turn: Largest,
    /// Gap, in faces, of a point with a force that is open where it is; infinite where nothing is opposite to it.
    pub invented: Largest,
    /// Depth, in faces, of a point without a force that penetrates where it is.
    pub lost: Largest,
}

/// What the looks have found.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Smallness {
    /// By body; rotations and strains are zeros at finite strain.
    pub bodies: Vec<SmallStrain>,
    /// By contact; zeros with finite sliding, and against rigid planes, where both kinds of sliding are the same.
    pub contacts: Vec<SmallSliding>,
    /// By assembly.
    pub(crate) looked: Vec<Looked>,
}

/// The looks at an assembly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Looked {
    /// Those so far.
    pub(crate) looks: u64,
    /// Largest strain energy at one, J.
    energy: f64,
}

impl Looked {
    /// Whether it is time to look at the end of a step. `energy`: strain energy of the assembly, and its largest energy, J.
    pub(crate) fn is_due(&self, step: u64, [energy, largest]: [f64; 2]) -> bool {
        let grown = energy > GROWTH * self.energy.max(LEAST * largest);
        step < FIRST || step.is_multiple_of(EVERY) || grown
    }
}

impl Smallness {
    pub(crate) fn of(system: &System) -> Smallness {
        Smallness {
            bodies: vec![SmallStrain::default(); system.bodies.len()],
            contacts: vec![SmallSliding::default(); system.contacts.len()],
            looked: vec![Looked::default(); system.assemblies.all.len()],
        }
    }

    /// Becomes a copy, without new memory.
    pub(crate) fn follow(&mut self, before: &Smallness) {
        self.bodies.clone_from(&before.bodies);
        self.contacts.clone_from(&before.contacts);
        self.looked.clone_from(&before.looked);
    }

    /// Takes what a zone has found; its bodies and contacts by their numbers in the whole.
    pub fn gather(&mut self, zone: &Smallness, (bodies, contacts): (&[usize], &[usize])) {
        for (found, &body) in zone.bodies.iter().zip(bodies) {
            self.bodies[body] = *found;
        }
        for (found, &contact) in zone.contacts.iter().zip(contacts) {
            self.contacts[contact] = *found;
        }
    }

    /// Looks so far at the assembly that has had the most.
    pub fn looks(&self) -> u64 {
        let looks = self.looked.iter().map(|looked| looked.looks);
        looks.max().unwrap_or(0)
    }

    /// The dynamics begin, whose energies are told by assembly.
    pub(crate) fn begin_dynamics(&mut self) {
        for looked in &mut self.looked {
            looked.energy = 0.0;
        }
    }

    /// Counts a look at an assembly with this strain energy, J.
    pub(crate) fn count(&mut self, assembly: usize, energy: f64) {
        let looked = &mut self.looked[assembly];
        looked.looks += 1;
        looked.energy = looked.energy.max(energy);
    }
}
