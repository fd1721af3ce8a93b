//! Loads, motions and damping of a model in the numbers of its system.

use std::ops::Range;

use carom_algebra::rotation::Rotation;
use carom_algebra::unknowns::{Kind, Unknowns};
use carom_bodies::Body;
use carom_signals::Amplitude;

use crate::error::Error;
use crate::mass::Mass;
use crate::model::Model;
use crate::nonlinear::{Damping, Iteration, Preload};
use crate::numbered_loads::{NumberedForce, NumberedLoad, numbered_loads};
use crate::refused::Refused;

/// A prescribed displacement of one unknown: which amplitude it follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follows {
    /// The unknown.
    pub unknown: u32,
    /// Place of the function in the list of amplitudes.
    pub amplitude: usize,
    /// Whether it is a finite rotation: the function is then an angle.
    pub turns: bool,
}

/// [`Nonlinear`](crate::Nonlinear) in the numbers of a system.
#[derive(Debug, Default)]
pub struct NumberedNonlinear {
    /// Loads.
    pub loads: Vec<NumberedLoad>,
    /// Names of those on surfaces and at nodes, each once.
    pub load_names: Vec<String>,
    /// Acceleration of the frame of coordinates, m/s², by direction.
    pub base: [Option<Amplitude>; 3],
    /// Functions of time that unknowns follow.
    pub amplitudes: Vec<Amplitude>,
    /// Unknowns that follow a function of time.
    pub follows: Vec<Follows>,
    /// Damping by body; empty for none.
    pub damping: Vec<Damping>,
    /// The static stage.
    pub preload: Option<Preload>,
    /// How steps are solved.
    pub iteration: Iteration,
    /// Place of the history of each body in that of the system.
    pub histories: Vec<Range<usize>>,
    /// Whether the energy of the steps is balanced by works.
    pub needed: bool,
}

impl NumberedNonlinear {
    /// Numbers loads and motions. `mass`: of the system; `number`: system numbers of the mesh nodes; `unknowns`: of the system; `fixed`: unknowns held by supports.
    ///
    /// # Errors
    /// A motion prescribed in a direction that a support holds.
    pub fn new(
        model: &Model,
        (number, unknowns): (&[u32], &Unknowns),
        (bodies, mass): (&[Body], &Mass),
        fixed: &[bool],
    ) -> Result<NumberedNonlinear, Error> {
        let given = &model.nonlinear;
        let dim = model.mesh.dim;
        let mut numbered = NumberedNonlinear {
            base: given.base.clone(),
            damping: given.damping.clone(),
            preload: given.preload,
            iteration: given.iteration,
            ..NumberedNonlinear::default()
        };
        for motion in &given.motions {
            for (i, amplitude) in motion.displacement.iter().enumerate().take(dim) {
                let Some(amplitude) = amplitude else { continue };
                let of_bodies = |node: &&u32| number[**node as usize] != u32::MAX;
                let nodes: Vec<u32> = motion.nodes.iter().filter(of_bodies).copied().collect();
                let kind = Kind::Translation(i);
                numbered.follow((&nodes, amplitude), kind, (number, unknowns), fixed)?;
            }
        }
        for turn in &given.turns {
            let node = std::slice::from_ref(&turn.node);
            let kind = Kind::Rotation(turn.axis);
            numbered.follow((node, &turn.angle), kind, (number, unknowns), fixed)?;
        }
        let own = (number, unknowns);
        numbered.loads = numbered_loads(model, own, (bodies, mass), &mut numbered.load_names)?;
        let mut first = 0;
        for body in bodies {
            numbered.histories.push(first..first + body.history_len());
            first += body.history_len();
        }
        numbered.needed = model.is_nonlinear();
        Ok(numbered)
    }

    /// Lets the unknowns of this kind of some nodes of the mesh follow a function of time; a carried node has those of its carrier.
    fn follow(
        &mut self,
        (nodes, amplitude): (&[u32], &Amplitude),
        kind: Kind,
        (number, unknowns): (&[u32], &Unknowns),
        fixed: &[bool],
    ) -> Result<(), Error> {
        // many supports follow one record
        let known = self.amplitudes.iter().position(|known| known == amplitude);
        let place = known.unwrap_or(self.amplitudes.len());
        if known.is_none() {
            self.amplitudes.push(amplitude.clone());
        }
        let (Kind::Translation(direction) | Kind::Rotation(direction) | Kind::Amplitude(direction)) =
            kind;
        let mut own: Vec<u32> = Vec::new();
        for &node in nodes {
            let refused = |why| Error::Nonlinear {
                what: Refused::Motion { node, direction },
                why,
            };
            let moving = unknowns.moved_by(number[node as usize]);
            let Some(unknown) = unknowns.find(moving, kind) else {
                return Err(refused("the node has no such unknown"));
            };
            let unknown = unknown as u32;
            if own.contains(&unknown) {
                continue;
            }
            let taken = self.follows.iter().any(|f| f.unknown == unknown);
            if fixed[unknown as usize] || taken {
                return Err(refused("a support or another motion holds it already"));
            }
            if unknowns.carrier(number[node as usize]).is_some() {
                own.push(unknown);
            }
            let finite = unknowns.frame(moving).is_some();
            self.follows.push(Follows {
                unknown,
                amplitude: place,
                turns: finite && matches!(kind, Kind::Rotation(_)),
            });
        }
        Ok(())
    }

    /// Whether a load turns with a body.
    pub fn has_follower(&self, body: usize) -> bool {
        let turns = |load: &NumberedLoad| matches!(load.force, NumberedForce::Follower(..));
        let mut loads = self.loads.iter();
        loads.any(|load| turns(load) && load.bodies.contains(&body))
    }

    /// Displacement at `to` of the unknowns that follow a function of time, m; of rotations the increment from the time
    /// `from` on that Cayley's map makes a turn by the difference of the angles.
    pub fn prescribe(&self, [from, to]: [f64; 2], u: &mut [f64]) {
        // supports that follow one function mostly follow each other
        let mut last = None;
        for follows in &self.follows {
            let amplitude = &self.amplitudes[follows.amplitude];
            u[follows.unknown as usize] = match (follows.turns, last) {
                (true, _) => Rotation::increment(amplitude.at(to) - amplitude.at(from)),
                (false, Some((of, value))) if of == follows.amplitude => value,
                (false, _) => {
                    let value = amplitude.at(to);
                    last = Some((follows.amplitude, value));
                    value
                }
            };
        }
    }

    /// Factor of gravity and constant loads at a time: it grows over the static stage.
    pub fn ramp(&self, time: f64) -> f64 {
        match self.preload {
            Some(preload) if time < preload.end => (time / preload.end).max(0.0),
            _ => 1.0,
        }
    }
}
