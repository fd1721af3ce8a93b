//! Loads and motions in time, damping, a static stage before the dynamics, and how the equations of a step are solved.

use std::ops::Range;

use carom_algebra::rotation::Rotation;
use carom_algebra::unknowns::{Kind, Unknowns};
use carom_bodies::Body;
use carom_contact::law::Level;
use carom_contact::{Contact, Integration};
use carom_signals::Amplitude;

use crate::error::Error;
use crate::loads::{Load, NodalLoad, NumberedForce, NumberedLoad, numbered_loads};
use crate::mass::Mass;
use crate::model::{Model, ModelBody, ModelContact, ModelTarget};
use crate::refused::Refused;
use crate::system::System;

/// Nodes that move as prescribed.
#[derive(Clone, Debug)]
pub struct Prescribed {
    /// Nodes of the mesh.
    pub nodes: Vec<u32>,
    /// Displacement in m as a function of time, by direction; none where the direction is free.
    pub displacement: [Option<Amplitude>; 3],
}

/// A rotation that follows a function of time about one axis of the frame of a node, which no other rotation moves; where
/// rotations are small about an axis of coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct PrescribedTurn {
    /// Node of the mesh.
    pub node: u32,
    /// Axis, from 0: the third one in the plane.
    pub axis: usize,
    /// Angle in rad.
    pub angle: Amplitude,
}

/// Rayleigh damping of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Damping {
    /// Factor of the mass, 1/s. It brakes rigid motion too.
    pub mass: f64,
    /// Factor of the stiffness, s; for small strain only.
    pub stiffness: f64,
}

/// A static stage before the dynamics: loads and contacts find their equilibrium, without inertia. Contact laws in the rate
/// hold in the gap there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preload {
    /// End of the stage, s.
    pub end: f64,
    /// Equal steps to it, over which gravity and constant loads grow from nothing.
    pub steps: u64,
}

/// How the equations of a step are solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// Residual, relative to the largest of the forces that balance, at which a step is solved.
    pub tolerance: f64,
    /// Iterations after which a step has failed.
    pub passes: usize,
    /// Times that a step that failed is halved before the run ends.
    pub halvings: u32,
}

impl Default for Iteration {
    fn default() -> Iteration {
        Iteration {
            tolerance: 1e-10,
            passes: 30,
            halvings: 6,
        }
    }
}

/// Loads and motions in time, damping, a static stage, and the rules of the iterations.
#[derive(Clone, Debug, Default)]
pub struct Nonlinear {
    /// Loads on surfaces.
    pub loads: Vec<Load>,
    /// Forces and moments at nodes.
    pub nodal: Vec<NodalLoad>,
    /// Acceleration of the frame of coordinates, m/s², by direction: displacements, velocities and accelerations of the run are
    /// relative to it, and each body feels the inertia force -M r a(t), with r a unit translation of all nodes.
    pub base: [Option<Amplitude>; 3],
    /// Prescribed motions.
    pub motions: Vec<Prescribed>,
    /// Prescribed rotations.
    pub turns: Vec<PrescribedTurn>,
    /// Damping by body; empty for none.
    pub damping: Vec<Damping>,
    /// The static stage.
    pub preload: Option<Preload>,
    /// How steps are solved.
    pub iteration: Iteration,
}

impl Nonlinear {
    /// Whether the energy of the steps is balanced by works because of anything in here.
    pub(crate) fn asks(&self) -> bool {
        !self.loads.is_empty()
            || !self.nodal.is_empty()
            || self.base.iter().any(Option::is_some)
            || !self.motions.is_empty()
            || !self.turns.is_empty()
            || self.damping.iter().any(|d| *d != Damping::default())
            || self.preload.is_some()
    }
}

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

/// [`Nonlinear`] in the numbers of a system.
#[derive(Debug, Default)]
pub struct NumberedNonlinear {
    /// Loads.
    pub loads: Vec<NumberedLoad>,
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
        numbered.loads = numbered_loads(model, (number, unknowns), mass)?;
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
        let place = self.amplitudes.len();
        self.amplitudes.push(amplitude.clone());
        let (Kind::Translation(direction) | Kind::Rotation(direction)) = kind;
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
        for follows in &self.follows {
            let amplitude = &self.amplitudes[follows.amplitude];
            u[follows.unknown as usize] = match follows.turns {
                true => Rotation::increment(amplitude.at(to) - amplitude.at(from)),
                false => amplitude.at(to),
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

fn needs_newton(contact: &ModelContact) -> bool {
    let moves = matches!(&contact.primary, ModelTarget::Rigid(obstacle) if obstacle.motion.moves());
    contact.friction > 0.0 || moves || matches!(contact.integration, Integration::Mortar { .. })
}

impl Model {
    /// Whether it has a pressure or traction, a motion in time, damping, a static stage, friction, mortar, a body at finite
    /// strain, an obstacle that moves, or a scheme with forces between two states: the energy of its steps is then balanced
    /// by works, not by the identity of the scheme, and a step of fixed size that fails is taken in halves.
    pub fn is_nonlinear(&self) -> bool {
        let finite =
            |body: &ModelBody| body.rigid.is_some() || body.spec.material.finite().is_some();
        self.nonlinear.asks()
            || self.bodies.iter().any(finite)
            || self.discrete.iter().any(|some| !some.spec.is_linear())
            || self.scheme.get().is_between()
            || self.mixes_schemes()
            || self.contacts.iter().any(needs_newton)
    }
}

impl System {
    /// Acceleration of the frame of coordinates at a time in s, m/s².
    pub fn base_acceleration(&self, time: f64) -> [f64; 3] {
        let base = &self.nonlinear.base;
        [0, 1, 2].map(|i| base[i].as_ref().map_or(0.0, |a| a.at(time)))
    }

    /// Acceleration of the frame at the instant to which the accelerations of a step belong that ends at `time` and lasts `dt`
    /// (both s): the end, or of schemes whose state has no acceleration the instant of their balance. The sum of both is the
    /// absolute acceleration, m/s².
    pub fn frame_acceleration(&self, time: f64, dt: f64) -> [f64; 3] {
        let scheme = self.scheme.get();
        match scheme.keeps_acceleration() || dt == 0.0 {
            true => self.base_acceleration(time),
            false => self.base_acceleration(time - dt + scheme.step_map(dt).instant(dt)),
        }
    }

    /// As [`Model::is_nonlinear`].
    pub fn is_nonlinear(&self) -> bool {
        self.nonlinear.needed
    }

    /// Whether any force is one of damping: of dashpots or of Rayleigh's damping.
    pub fn has_damping(&self) -> bool {
        self.has_dashpots || !self.nonlinear.damping.is_empty()
    }

    /// The part of the histories of all bodies ([`Motion::history`](crate::Motion::history)) that is a body's; empty of a law
    /// without.
    pub fn history<'a>(&self, body: usize, histories: &'a [f64]) -> &'a [f64] {
        let range = self.nonlinear.histories.get(body).cloned();
        range.and_then(|range| histories.get(range)).unwrap_or(&[])
    }

    /// Histories of all materials where nothing has happened.
    pub fn start_histories(&self) -> Vec<f64> {
        let ranges = &self.nonlinear.histories;
        let mut histories = vec![0.0; ranges.last().map_or(0, |range| range.end)];
        for (body, range) in self.bodies.iter().zip(ranges) {
            body.start_history(&mut histories[range.clone()]);
        }
        histories
    }

    /// Refuses what a model whose forces are not all linear does not accept.
    pub(crate) fn check_nonlinear(&self) -> Result<(), Error> {
        if !self.nonlinear.needed {
            return Ok(());
        }
        let refuse = |what: Refused, why| Err(Error::Nonlinear { what, why });
        self.check_rigid()?;
        let weak = |contact: &Contact| matches!(contact.integration, Integration::Weak { .. });
        for (contact, friction) in self.contacts.iter().zip(&self.friction) {
            let refused = || Refused::Integration(contact.name.clone());
            if weak(contact) && *friction > 0.0 {
                return refuse(
                    refused(),
                    "the weak form with signs at Gauss points has no friction; take node or mortar",
                );
            }
            let of_rate = contact.law.get().level() == Level::Rate;
            if weak(contact) && of_rate && self.nonlinear.preload.is_some() {
                return refuse(
                    refused(),
                    "in a static stage laws in the rate hold in the gap, for which r of the weak form has another unit; \
                     take node or mortar, or the displacement law",
                );
            }
        }
        for (damping, body) in self.nonlinear.damping.iter().zip(&self.bodies) {
            if damping.stiffness != 0.0 && !body.is_linear() {
                return refuse(
                    Refused::Damping(body.name().to_string()),
                    "damping proportional to the stiffness would brake rotations at finite strain; take a viscoelastic material",
                );
            }
        }
        Ok(())
    }
}
