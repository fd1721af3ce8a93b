//! A core that moves in a step.

use carom_contact::Target;
use carom_contact::certificate::{Core, Moved};
use carom_mesh::Bounds;

use crate::state::State;
use crate::system::{CoreOf, CoreOwner, Motion, System};

type Vec3 = [f64; 3];

/// A core that moves.
#[derive(Debug)]
pub(super) struct Mover {
    pub(super) of: CoreOf,
    /// Places of its nodes at the end of the step, m.
    pub(super) nodes: Vec<Vec3>,
    /// Vertices at the start and at the end of the step, m.
    before: Vec<Vec3>,
    after: Vec<Vec3>,
    /// Places of the nodes at the start of the step.
    pub(super) earlier: Vec<Vec3>,
    /// Box of the motions of its nodes in the step.
    pub(super) motion: Bounds,
    /// Whether the vertices are those of this step.
    is_placed: bool,
    /// Whether frames carry nodes of it.
    pub(super) is_carried: bool,
}

impl Mover {
    pub(super) fn new(system: &System, of: CoreOf) -> Mover {
        let mut nodes = of.core.nodes().iter();
        Mover {
            is_carried: nodes.any(|&node| system.unknowns.carrier(node).is_some()),
            of,
            nodes: Vec::new(),
            before: Vec::new(),
            after: Vec::new(),
            earlier: Vec::new(),
            motion: Bounds::EMPTY,
            is_placed: false,
        }
    }

    /// Takes the places in a state after the last one that was taken.
    pub(super) fn take(&mut self, system: &System, (time, motion): (f64, &Motion)) {
        self.nodes.clear();
        match &self.of.owner {
            CoreOwner::Body(_) => {
                let places = system.places(time, &motion.u, &motion.frames);
                let nodes = self.of.core.nodes().iter();
                self.nodes.extend(nodes.map(|&node| places.of(node)));
            }
            CoreOwner::Shape(contact, places) => {
                if let Target::Rigid(obstacle) = &system.contacts[*contact].target {
                    let moved = places.iter().map(|place| obstacle.moved(place, time));
                    self.nodes.extend(moved);
                }
            }
        }
        let (mut min, mut max) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for (now, before) in self.nodes.iter().zip(&self.earlier) {
            for i in 0..3 {
                let moved = now[i] - before[i];
                min[i] = if moved < min[i] { moved } else { min[i] };
                max[i] = if moved > max[i] { moved } else { max[i] };
            }
        }
        self.motion = Bounds { min, max };
        self.is_placed = false;
    }

    /// The state that it has taken is that at the start of the next step.
    pub(super) fn accept(&mut self) {
        std::mem::swap(&mut self.nodes, &mut self.earlier);
    }

    /// A state is that at the start of the next step.
    pub(super) fn start_from(&mut self, system: &System, state: &State) {
        self.take(system, (state.time, &state.motion));
        self.accept();
    }

    /// Places the vertices, if they are not.
    pub(super) fn place(&mut self) {
        if std::mem::replace(&mut self.is_placed, true) {
            return;
        }
        match self.of.owner {
            CoreOwner::Body(_) => {
                self.of.core.place(&self.earlier, &mut self.before);
                self.of.core.place(&self.nodes, &mut self.after);
            }
            CoreOwner::Shape(..) => {
                self.before.clone_from(&self.earlier);
                self.after.clone_from(&self.nodes);
            }
        }
    }

    /// Against another; `room`: for the vertices where these are nearer to the surface than against a body like itself.
    pub(super) fn against<'a>(&'a self, other: &Core, room: &'a mut [Vec<Vec3>; 2]) -> Moved<'a> {
        let core = &self.of.core;
        let part = core.part_against(other);
        if part < 1.0 {
            let [before, after] = &mut *room;
            before.clone_from(&self.before);
            after.clone_from(&self.after);
            core.shrink(&self.earlier, part, before);
            core.shrink(&self.nodes, part, after);
        }
        let [before, after] = match part < 1.0 {
            true => [&room[0][..], &room[1][..]],
            false => [&self.before[..], &self.after[..]],
        };
        Moved {
            core,
            before,
            after,
            part,
        }
    }

    /// The box around its places at the start of the step, and what others are to keep from it.
    pub(super) fn reach(&self) -> Bounds {
        Bounds::of(&self.earlier).widened(1.1 * self.of.core.most_kept())
    }

    /// Diagonal of the box around it in the reference configuration, m.
    pub(super) fn size_at_rest(&self, system: &System) -> f64 {
        let nodes = self.of.core.nodes().iter();
        let places = nodes.map(|&node| system.x[node as usize]);
        let bounds = places.fold(Bounds::EMPTY, |all, x| all.union(&Bounds::of(&[x])));
        match bounds.min[0].is_finite() {
            true => bounds.diagonal(),
            false => 0.0,
        }
    }
}

/// The most that two move relative to each other, m, whose motions are in these boxes.
pub(super) fn relative(one: &Bounds, other: &Bounds) -> f64 {
    let most = |i: usize| {
        let (up, down) = (one.max[i] - other.min[i], other.max[i] - one.min[i]);
        if up > down { up } else { down }
    };
    (0..3).map(|i| most(i).powi(2)).sum::<f64>().sqrt()
}
