//! Forces of quadrilaterals with one point, chunk by chunk: rotations of the nodes first, then elements side by side.

use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::Vec3;
use pulp::Arch;
use rayon::prelude::*;

use super::chunk::Chunk;
use super::element::{Element, PER_NODE};
use super::kernel::Sweep;
use super::layers::Layers;
use super::one_point::Centre;
use crate::scratch::{Scratch, ShellChunk};
use crate::{Placement, Stored};

/// Elements of a chunk: its nodes stay in the nearest cache.
const CHUNK: usize = 256;

/// All elements of a body.
#[derive(Debug)]
pub(super) struct Pass {
    chunks: Vec<Chunk>,
}

impl Pass {
    /// Of elements with these centres.
    pub(super) fn new(elements: &[Element], centres: &[Centre]) -> Pass {
        let pieces = elements.chunks(CHUNK).zip(centres.chunks(CHUNK));
        Pass {
            chunks: pieces
                .map(|(own, centres)| Chunk::new(own, centres))
                .collect(),
        }
    }

    /// Adds the forces at the end of a step and returns the energies. Chunks are added in their order.
    pub(super) fn force(
        &self,
        layers: Option<&Layers>,
        at: &Placement,
        new: &mut [f64],
        (scratch, f): (&mut Scratch, &mut [f64]),
    ) -> Stored {
        let rooms = &mut scratch.shell_chunks;
        rooms.resize_with(self.chunks.len(), ShellChunk::default);
        let pieces = self.chunks.par_iter().zip(&mut rooms[..]);
        match layers {
            None => pieces.for_each(|(chunk, room)| force(chunk, None, at, &mut [], room)),
            Some(layers) => {
                let kept = CHUNK * layers.history_len();
                let histories = at.old.par_chunks(kept).zip(new.par_chunks_mut(kept));
                pieces
                    .zip(histories)
                    .for_each(|((chunk, room), (old, new))| {
                        force(chunk, Some(layers), &Placement { old, ..*at }, new, room);
                    });
            }
        }
        let mut stored = Stored::default();
        for (chunk, room) in self.chunks.iter().zip(rooms) {
            stored.include(&room.stored);
            for (&first, force) in chunk.first.iter().zip(&room.forces) {
                for (f, force) in f[first..first + PER_NODE].iter_mut().zip(force) {
                    *f += force;
                }
            }
        }
        stored
    }
}

/// Leaves the forces of a chunk and its energies in its room.
fn force(
    chunk: &Chunk,
    layers: Option<&Layers>,
    at: &Placement,
    new: &mut [f64],
    room: &mut ShellChunk,
) {
    room.states.clear();
    for ((x, &first), &frame) in chunk.x.iter().zip(&chunk.first).zip(&chunk.frames) {
        let own = &at.u[first..first + PER_NODE];
        let start = at.frames.get(frame).copied().unwrap_or_default();
        let turn = Rotation::cayley(&Vec3::new(own[3], own[4], own[5]));
        let r = start.then(&turn).matrix();
        room.states.push([
            x[0] + own[0],
            x[1] + own[1],
            x[2] + own[2],
            r[(0, 0)],
            r[(0, 1)],
            r[(0, 2)],
            r[(1, 0)],
            r[(1, 1)],
            r[(1, 2)],
            r[(2, 0)],
            r[(2, 1)],
            r[(2, 2)],
        ]);
    }
    room.forces.clear();
    room.forces.resize(chunk.x.len(), [0.0; PER_NODE]);
    room.stored = Arch::new().dispatch(Sweep {
        chunk,
        layers,
        dt: at.dt,
        old: at.old,
        new,
        states: &room.states,
        f: &mut room.forces,
    });
    for (force, state) in room.forces.iter_mut().zip(&room.states) {
        // moments in the axes of the nodes at the end
        let [x, y, z] = [force[3], force[4], force[5]];
        for i in 0..3 {
            force[3 + i] = state[3 + i] * x + state[6 + i] * y + state[9 + i] * z;
        }
    }
}
