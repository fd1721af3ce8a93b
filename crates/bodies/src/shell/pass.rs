//! Forces of quadrilaterals with one point, chunk by chunk: rotations of the nodes first, then elements side by side.

use carom_algebra::number::Number;
use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::Vec3;
use pulp::Arch;
use rayon::prelude::*;

use super::kernel::Sweep;
use super::layers::Layers;
use super::one_point::Centre;
use super::products::{DIRECTOR, MOST};
use super::section::STRAINS;
use super::{Element, PER_NODE};
use crate::scratch::{Scratch, ShellChunk};
use crate::{Placement, Stored};

/// Elements of a chunk: its nodes stay in the nearest cache.
const CHUNK: usize = 256;

/// Elements whose constants lie side by side, a multiple of the lanes of any register.
const SIDE: usize = 8;

/// Numbers of an element.
const FIELDS: usize = 62;

/// What is constant of several elements.
pub(super) struct Constants<T> {
    /// D and t₁ of each node at the start.
    pub director: [[T; 3]; MOST],
    pub first: [[T; 3]; MOST],
    /// Of [`Centre`]; the inverse of its lengths.
    pub to: [[T; 2]; 2],
    pub twist: [T; 2],
    pub inverse: [T; 2],
    pub area: T,
    /// Strains at the start: membrane, curvature and shear at the centre, what it does not see, and about the normal.
    pub start: [T; STRAINS - 1],
    pub unseen: [[T; 2]; 3],
    pub drilled: [T; MOST],
    /// Stiffness times area.
    pub membrane: [T; 3],
    pub bending: [T; 3],
    pub shear: T,
    pub drilling: T,
    pub hourglass: [T; 3],
}

/// Neighbouring elements.
#[derive(Debug)]
pub(super) struct Chunk {
    /// First unknowns, frames and places of the nodes.
    first: Vec<usize>,
    frames: Vec<usize>,
    x: Vec<Vec3>,
    /// Nodes of each element, as places in these lists.
    pub connectivity: Vec<[u32; MOST]>,
    /// [`FIELDS`] numbers of [`SIDE`] elements after the other, number by number.
    constants: Vec<f64>,
}

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
            None => pieces.for_each(|(chunk, room)| chunk.force(None, at, &mut [], room)),
            Some(layers) => {
                let kept = CHUNK * layers.history_len();
                let histories = at.old.par_chunks(kept).zip(new.par_chunks_mut(kept));
                pieces
                    .zip(histories)
                    .for_each(|((chunk, room), (old, new))| {
                        chunk.force(Some(layers), &Placement { old, ..*at }, new, room);
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

impl Chunk {
    fn new(elements: &[Element], centres: &[Centre]) -> Chunk {
        let mut nodes: Vec<u32> = elements.iter().flat_map(|element| element.nodes).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let mut chunk = Chunk {
            first: vec![0; nodes.len()],
            frames: vec![0; nodes.len()],
            x: vec![Vec3::zeros(); nodes.len()],
            connectivity: Vec::with_capacity(elements.len()),
            constants: vec![0.0; elements.len().div_ceil(SIDE) * SIDE * FIELDS],
        };
        for (place, (element, centre)) in elements.iter().zip(centres).enumerate() {
            let mut own = [0; MOST];
            for (a, own) in own.iter_mut().enumerate() {
                let node = nodes.partition_point(|&node| node < element.nodes[a]);
                *own = node as u32;
                chunk.first[node] = element.first[a];
                chunk.frames[node] = element.frames[a];
                chunk.x[node] = element.reference.x[a];
            }
            chunk.connectivity.push(own);
            let to = &mut chunk.constants[place / SIDE * SIDE * FIELDS..];
            for (field, value) in constants(element, centre).into_iter().enumerate() {
                to[field * SIDE + place % SIDE] = value;
            }
        }
        chunk
    }

    fn force(
        &self,
        layers: Option<&Layers>,
        at: &Placement,
        new: &mut [f64],
        room: &mut ShellChunk,
    ) {
        room.states.clear();
        for ((x, &first), &frame) in self.x.iter().zip(&self.first).zip(&self.frames) {
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
        room.forces.resize(self.x.len(), [0.0; PER_NODE]);
        room.stored = Arch::new().dispatch(Sweep {
            chunk: self,
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

    /// What is constant of the elements from one of them on.
    #[inline(always)]
    pub(super) fn constants<T: Number>(&self, first: usize, zero: T) -> Constants<T> {
        let from = first / SIDE * SIDE * FIELDS + first % SIDE;
        let of = &self.constants[from..];
        let mut place = 0;
        let mut next = || {
            let mut value = zero;
            let lanes = value.lanes_mut();
            let count = lanes.len();
            lanes.copy_from_slice(&of[place..place + count]);
            place += SIDE;
            value
        };
        macro_rules! list {
            ($($inner:tt)*) => { [$(list_item!($inner next)),*] };
        }
        macro_rules! list_item {
            (1 $next:ident) => {
                $next()
            };
            (2 $next:ident) => {
                [$next(), $next()]
            };
            (3 $next:ident) => {
                [$next(), $next(), $next()]
            };
        }
        Constants {
            director: list!(3 3 3 3),
            first: list!(3 3 3 3),
            to: list!(2 2),
            twist: list!(1 1),
            inverse: list!(1 1),
            area: next(),
            start: list!(1 1 1 1 1 1 1 1),
            unseen: list!(2 2 2),
            drilled: list!(1 1 1 1),
            membrane: list!(1 1 1),
            bending: list!(1 1 1),
            shear: next(),
            drilling: next(),
            hourglass: list!(1 1 1),
        }
    }
}

/// The numbers of an element, in the order of [`Constants`].
fn constants(element: &Element, centre: &Centre) -> Vec<f64> {
    let mut all = Vec::with_capacity(FIELDS);
    for axis in [DIRECTOR, 0] {
        for axes in &element.reference.axes {
            all.extend_from_slice(axes[axis].as_slice());
        }
    }
    all.extend(centre.to.as_flattened());
    all.extend(centre.twist);
    all.extend(centre.lengths.map(f64::recip));
    all.push(centre.area);
    let start = &element.form.start;
    all.extend(&start[0][..STRAINS - 1]);
    all.extend([0, 1, 3, 4, 6, 7].map(|k| start[1][k]));
    all.extend(start.iter().map(|list| list[STRAINS - 1]));
    let elastic = &element.elastic;
    let of_area = elastic.membrane.into_iter().chain(elastic.bending);
    let of_area = of_area.chain([elastic.shear, elastic.drilling]);
    all.extend(of_area.map(|stiffness| stiffness * centre.area));
    all.extend(element.hourglass.map_or([0.0; 3], |own| own.stiffness));
    all
}
