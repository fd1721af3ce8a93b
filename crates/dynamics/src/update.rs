//! The end of an explicit step in one pass over the vectors: accelerations, velocities, and the sums of which its balances consist.
//!
//! A vector is read once. Sums are those of blocks of nodes that follow each other, added in their order, so that their bits are the
//! same for any number of threads. Within a block unknowns are added in eight lanes.

mod sums;

use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};

use crate::blocks::{self, Block, Buffer, NODES, Nodes, Runs, pattern};
use crate::step_map::Row;
use crate::system::System;
pub(crate) use sums::Sums;

/// Blocks that one thread takes, at least.
const PANEL: usize = 16;
/// Lanes in which the unknowns of a block are added.
const LANES: usize = 8;

/// A force at the start and at the end of the step: vectors, N, with a factor each.
pub(crate) type Ends<'a> = [(&'a [f64], f64); 2];

/// What the pass reads.
pub(crate) struct Update<'a> {
    pub(crate) system: &'a System,
    /// Displacement at the end, m.
    pub(crate) u: &'a [f64],
    /// Internal forces at start and end, N.
    pub(crate) f: [&'a [f64]; 2],
    /// Mass of each node, kg.
    pub(crate) mass: &'a [f64],
    /// Velocity, m/s, and acceleration, m/s², at the start.
    pub(crate) v: &'a [f64],
    pub(crate) a: &'a [f64],
    /// Loads; none where there are none.
    pub(crate) load: Option<Ends<'a>>,
    /// Forces of damping at start and end; none where there are none. Where there are, there are loads too.
    pub(crate) damping: Option<Ends<'a>>,
    /// Contact forces at start and end, N; read in the blocks that they touch.
    pub(crate) contact: [&'a [f64]; 2],
    /// Δu by v and a.
    pub(crate) way: Row,
    /// v₊ by v, a and the acceleration a₊ of the end.
    pub(crate) velocity: Row,
    /// The displacement after the next step by u₊, v₊ and a₊, if that is as long as this one.
    pub(crate) ahead: Row,
    /// w of each part, m/s.
    pub(crate) reference: &'a [[f64; 3]],
    /// Weights of the forces of start and end in their means, of the works and of the resultants.
    pub(crate) weights: [[f64; 2]; 2],
    /// Whether moments are those of the places reached: of momentum at the end, of forces in the middle of the way. Otherwise, and in parts of small
    /// displacements ([`System::undeformed`]), in the reference configuration.
    pub(crate) moves: bool,
}

/// The vectors of the end that are written: displacement after the next step, velocity, acceleration.
type End<'a> = [&'a mut [f64]; 3];

impl Update<'_> {
    /// Writes velocities and accelerations of the end and the displacement ahead, and the sums of each block.
    pub(crate) fn run(&self, blocks: &[Block], sums: &mut [Sums], out: End) {
        let counted = blocks.partition_point(|block| block.counts);
        let (own, others) = blocks.split_at(counted);
        let (of_own, of_others) = sums.split_at_mut(counted);
        let [ahead, v, a] = out;
        self.panel(own, of_own, (0, [&mut *ahead, &mut *v, &mut *a]));
        if !others.is_empty() {
            self.panel(others, of_others, (0, [ahead, v, a]));
        }
    }

    /// The same for some of the blocks, ascending; the vectors begin at the node `origin`.
    fn panel(&self, blocks: &[Block], sums: &mut [Sums], (origin, out): (usize, End)) {
        if blocks.len() >= 2 * PANEL {
            let (before, after) = blocks.split_at(blocks.len() / 2);
            let (sums, rest) = sums.split_at_mut(before.len());
            let (dim, border) = (self.system.dim, after[0].nodes.first());
            let [one, two, three] = out.map(|vector| vector.split_at_mut(dim * (border - origin)));
            rayon::join(
                || self.panel(before, sums, (origin, [one.0, two.0, three.0])),
                || self.panel(after, rest, (border, [one.1, two.1, three.1])),
            );
            return;
        }
        Arch::new().dispatch(Panel {
            update: self,
            blocks,
            sums,
            origin,
            out,
        });
    }
}

struct Panel<'a> {
    update: &'a Update<'a>,
    blocks: &'a [Block],
    sums: &'a mut [Sums],
    origin: usize,
    out: End<'a>,
}

impl WithSimd for Panel<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (dim, origin) = (self.update.system.dim, self.origin);
        let [ahead, v, a] = self.out;
        let mut buffers = Buffers::default();
        // a process alone has no runs, and does not fill it
        let mut room: Option<Room> = None;
        for (block, sums) in self.blocks.iter().zip(self.sums) {
            *sums = Sums::default();
            let of = (block, &mut buffers);
            match &block.nodes {
                Nodes::Run(nodes) => {
                    let [first, last] = nodes.map(|node| dim * (node - origin));
                    let out = [&mut *ahead, &mut *v, &mut *a].map(|all| &mut all[first..last]);
                    self.update.any(of, &self.update.run_of(*nodes), sums, out);
                }
                Nodes::Runs(nodes) => {
                    let (room, written) = room.get_or_insert_with(empty);
                    let out = written.each_mut().map(|all| &mut all[..nodes.fixed.len()]);
                    let touched = block.touched != [false; 2];
                    let within = self.update.runs_of((nodes, touched), room);
                    self.update.any(of, &within, sums, out);
                    for (all, own) in [&mut *ahead, &mut *v, &mut *a].into_iter().zip(&*written) {
                        nodes.place((dim, origin), own, all);
                    }
                }
            }
        }
    }
}

/// The vectors of a block.
struct Within<'a> {
    u: &'a [f64],
    f: [&'a [f64]; 2],
    v: &'a [f64],
    a: &'a [f64],
    fixed: &'a [bool],
    load: Ends<'a>,
    damping: Ends<'a>,
    contact: Ends<'a>,
    /// Mass and place of each node.
    mass: &'a [f64],
    x: &'a [[f64; 3]],
}

/// Room for the vectors of nodes that do not all follow each other: what is read, and what is written.
type Room = ([Entries; 11], [Entries; 3]);

/// Entries of one vector.
type Entries = [f64; 3 * NODES];

#[inline(always)]
fn empty() -> Room {
    ([[0.0; 3 * NODES]; 11], [[0.0; 3 * NODES]; 3])
}

/// What a block keeps between its loops.
#[derive(Default)]
struct Buffers {
    mass: Buffer,
    /// Places for the moments of momentum and of forces.
    place: Buffer,
    middle: Buffer,
    momentum: Buffer,
    /// Means of loads, contact forces and damping, and the loads less damping of the end.
    load: Buffer,
    touch: Buffer,
    damping: Buffer,
    outside: Buffer,
    /// v₊ - w.
    relative: Buffer,
}

impl Buffers {
    /// Leaves nothing of a longer block behind `n` entries.
    #[inline(always)]
    fn end(&mut self, n: usize) {
        let all = [
            &mut self.mass,
            &mut self.place,
            &mut self.middle,
            &mut self.momentum,
            &mut self.load,
            &mut self.touch,
            &mut self.damping,
            &mut self.outside,
            &mut self.relative,
        ];
        all.into_iter().for_each(|buffer| buffer.end(n));
    }
}

/// A force on some of the unknowns.
#[inline(always)]
fn within<'a>(ends: &Option<Ends<'a>>, range: &Range<usize>) -> Ends<'a> {
    match ends {
        Some([(old, by_old), (new, by_new)]) => [
            (&old[range.clone()], *by_old),
            (&new[range.clone()], *by_new),
        ],
        None => [(&[], 0.0); 2],
    }
}

/// Entries from one of them on; `other` where there are none.
#[inline(always)]
fn take<T: Copy>(vector: &[T], first: usize, other: T) -> [T; LANES] {
    let mut out = [other; LANES];
    match vector.get(first..first + LANES) {
        Some(entries) => out.copy_from_slice(entries),
        None => out
            .iter_mut()
            .zip(&vector[first..])
            .for_each(|(out, entry)| *out = *entry),
    }
    out
}

/// The same of a force at both ends.
#[inline(always)]
fn ends(of: &Ends, first: usize) -> [[f64; LANES]; 2] {
    let mut out = [[0.0; LANES]; 2];
    for (out, (force, factor)) in out.iter_mut().zip(of) {
        *out = take(force, first, 0.0);
        out.iter_mut().for_each(|value| *value *= factor);
    }
    out
}

#[inline(always)]
fn sum_of(weights: [f64; 2], [one, other]: &[[f64; LANES]; 2]) -> [f64; LANES] {
    let mut out = [0.0; LANES];
    for k in 0..LANES {
        out[k] = weights[0] * one[k] + weights[1] * other[k];
    }
    out
}

/// Writes entries from one of them on, those that there are.
#[inline(always)]
fn put(vector: &mut [f64], first: usize, values: &[f64; LANES]) {
    match vector.get_mut(first..first + LANES) {
        Some(entries) => entries.copy_from_slice(values),
        None => vector[first..]
            .iter_mut()
            .zip(values)
            .for_each(|(entry, value)| *entry = *value),
    }
}

impl Update<'_> {
    /// What nodes that follow each other read.
    #[inline(always)]
    fn run_of(&self, [first, last]: [usize; 2]) -> Within<'_> {
        let dim = self.system.dim;
        let range = dim * first..dim * last;
        Within {
            u: &self.u[range.clone()],
            f: self.f.map(|f| &f[range.clone()]),
            v: &self.v[range.clone()],
            a: &self.a[range.clone()],
            fixed: &self.system.fixed[range.clone()],
            load: within(&self.load, &range),
            damping: within(&self.damping, &range),
            contact: self.contact.map(|forces| (&forces[range.clone()], 1.0)),
            mass: &self.mass[first..last],
            x: &self.system.x[first..last],
        }
    }

    /// What others read.
    #[inline(always)]
    fn runs_of<'a>(
        &self,
        (nodes, touched): (&'a Runs, bool),
        room: &'a mut [Entries; 11],
    ) -> Within<'a> {
        let (dim, n) = (self.system.dim, nodes.fixed.len());
        let mut rooms = room.iter_mut();
        let mut pick = |vector: &[f64]| -> &'a [f64] {
            let Some(room) = rooms.next() else {
                return &[];
            };
            nodes.pick(dim, vector, room);
            &room[..n]
        };
        let mut ends = |ends: &Option<Ends>| match ends {
            Some(ends) => ends.map(|(force, factor)| (pick(force), factor)),
            None => [(&[][..], 0.0); 2],
        };
        let (load, damping) = (ends(&self.load), ends(&self.damping));
        Within {
            u: pick(self.u),
            f: self.f.map(&mut pick),
            v: pick(self.v),
            a: pick(self.a),
            fixed: &nodes.fixed,
            load,
            damping,
            contact: match touched {
                true => self.contact.map(|forces| (pick(forces), 1.0)),
                false => [(&[], 0.0); 2],
            },
            mass: &nodes.mass,
            x: &nodes.x,
        }
    }

    /// A block with what there is on it.
    #[inline(always)]
    fn any(&self, of: (&Block, &mut Buffers), within: &Within, sums: &mut Sums, out: End) {
        let touched = of.0.touched != [false; 2];
        match (self.load.is_some(), self.damping.is_some(), touched) {
            (false, _, false) => self.block::<false, false, false>(of, within, sums, out),
            (false, _, true) => self.block::<false, false, true>(of, within, sums, out),
            (true, false, false) => self.block::<true, false, false>(of, within, sums, out),
            (true, false, true) => self.block::<true, false, true>(of, within, sums, out),
            (true, true, false) => self.block::<true, true, false>(of, within, sums, out),
            (true, true, true) => self.block::<true, true, true>(of, within, sums, out),
        }
    }

    #[inline(always)]
    fn block<const LOADED: bool, const DAMPED: bool, const TOUCHED: bool>(
        &self,
        (block, buffers): (&Block, &mut Buffers),
        within: &Within,
        sums: &mut Sums,
        out: End,
    ) {
        let (dim, n) = (self.system.dim, within.u.len());
        buffers.end(n);
        buffers.mass.spread(dim, within.mass);
        buffers.place.fill(dim, within.x);
        if self.system.about != [0.0; 3] {
            buffers.place.take_off(n, &pattern(dim, &self.system.about));
        }
        let w = pattern(dim, &self.reference[block.part]);
        let moves = self.moves && !self.system.undeformed[block.part];
        let [ahead, v1, a1] = out;
        let out = [ahead, v1, &mut *a1];
        self.move_on::<LOADED, DAMPED, TOUCHED>((within, &w, moves), (buffers, sums), out);
        self.resultants::<LOADED, DAMPED, TOUCHED>(n, buffers, sums);
        if block.held {
            self.reactions::<LOADED, DAMPED, TOUCHED>((within, moves), (buffers, sums), a1);
        }
    }

    /// Accelerations and velocities of the end, the displacement ahead, works and squares.
    #[inline(always)]
    fn move_on<const LOADED: bool, const DAMPED: bool, const TOUCHED: bool>(
        &self,
        (of, w, moves): (&Within, &[f64; blocks::LANES], bool),
        (buffers, sums): (&mut Buffers, &mut Sums),
        [ahead, v1, a1]: End,
    ) {
        let [old, new] = self.weights[0];
        let means = self.weights[1];
        // |v₊|², |a|², |a₊|², four works, |Δu|², five squares, the work of damping
        let mut lanes = [[0.0; LANES]; 14];
        let moved = f64::from(u8::from(moves));
        for first in (0..v1.len()).step_by(LANES) {
            let (u, v, a) = (
                take(of.u, first, 0.0),
                take(of.v, first, 0.0),
                take(of.a, first, 0.0),
            );
            let f = [take(of.f[0], first, 0.0), take(of.f[1], first, 0.0)];
            let fixed = take(of.fixed, first, true);
            let [mut load, mut damping, mut touch] = [[[0.0; LANES]; 2]; 3];
            if LOADED {
                load = ends(&of.load, first);
            }
            if DAMPED {
                damping = ends(&of.damping, first);
            }
            if TOUCHED {
                touch = ends(&of.contact, first);
            }
            let m: [f64; LANES] = buffers.mass.lanes(first);
            let place: [f64; LANES] = buffers.place.lanes(first);
            let w: [f64; LANES] = take(w, first % w.len(), 0.0);
            let [
                mut x,
                mut speed,
                mut far,
                mut end,
                mut middle,
                mut momentum,
                mut relative,
                mut still,
            ] = [[0.0; LANES]; 8];
            for k in 0..LANES {
                let du = self.way.v * v[k] + self.way.a * a[k];
                let mut outside = 0.0;
                if LOADED {
                    outside = load[1][k];
                }
                if DAMPED {
                    outside -= damping[1][k];
                }
                still[k] = outside;
                if TOUCHED {
                    outside += touch[1][k];
                }
                let free = (outside - f[1][k]) / m[k];
                x[k] = if fixed[k] { 0.0 } else { free };
                speed[k] = self.velocity.v * v[k] + self.velocity.a * a[k] + self.velocity.x * x[k];
                far[k] = self.ahead.u * u[k] + self.ahead.v * speed[k] + self.ahead.a * x[k];
                end[k] = place[k] + moved * u[k];
                middle[k] = end[k] - moved * (0.5 * du);
                momentum[k] = m[k] * speed[k];
                relative[k] = speed[k] - w[k];
                let inertia = [m[k] * a[k], m[k] * x[k]];
                lanes[0][k] += momentum[k] * speed[k];
                lanes[1][k] += inertia[0] * a[k];
                lanes[2][k] += inertia[1] * x[k];
                lanes[3][k] += (old * inertia[0] + new * inertia[1]) * du;
                lanes[4][k] += (old * f[0][k] + new * f[1][k]) * du;
                lanes[7][k] += du * du;
                lanes[8][k] += inertia[1] * inertia[1];
                lanes[9][k] += f[1][k] * f[1][k];
                lanes[12][k] += (m[k] * v[k]) * (m[k] * v[k]);
                if LOADED {
                    lanes[5][k] += (old * load[0][k] + new * load[1][k]) * du;
                    lanes[10][k] += load[1][k] * load[1][k];
                }
                if DAMPED {
                    lanes[13][k] += (old * damping[0][k] + new * damping[1][k]) * du;
                }
                if TOUCHED {
                    lanes[6][k] += (old * touch[0][k] + new * touch[1][k]) * du;
                    lanes[11][k] += touch[1][k] * touch[1][k];
                }
            }
            // sums stay in vector registers or in memory: without it their lanes are taken apart
            std::hint::black_box(&mut lanes);
            put(ahead, first, &far);
            put(v1, first, &speed);
            put(a1, first, &x);
            buffers.place.put(first, &end);
            buffers.momentum.put(first, &momentum);
            buffers.relative.put(first, &relative);
            if LOADED || TOUCHED {
                buffers.middle.put(first, &middle);
            }
            if LOADED {
                buffers.load.put(first, &sum_of(means, &load));
                buffers.outside.put(first, &still);
            }
            if DAMPED {
                buffers.damping.put(first, &sum_of(means, &damping));
            }
            if TOUCHED {
                buffers.touch.put(first, &sum_of(means, &touch));
            }
        }
        buffers.relative.end(v1.len());
        let sum = |number: usize| lanes[number].iter().sum::<f64>();
        sums.velocity = sum(0);
        sums.acceleration = [sum(1), sum(2)];
        sums.works = [sum(3), sum(4), sum(5), sum(6), sum(13)];
        sums.way = sum(7);
        sums.squares = [sum(8), sum(9), sum(10), sum(11), sum(12)];
    }

    /// Resultants of momentum, loads, damping and contact forces of a block of `n` unknowns.
    #[inline(always)]
    fn resultants<const LOADED: bool, const DAMPED: bool, const TOUCHED: bool>(
        &self,
        n: usize,
        buffers: &Buffers,
        sums: &mut Sums,
    ) {
        let dim = self.system.dim;
        sums.momentum = buffers.momentum.resultant(&buffers.place, dim, n);
        sums.fastest = buffers.relative.largest_square(dim, n);
        if LOADED {
            sums.forces[0] = buffers.load.resultant(&buffers.middle, dim, n);
            sums.outside[0] = buffers.outside.total(dim, n);
        }
        if DAMPED {
            sums.forces[3] = buffers.damping.resultant(&buffers.middle, dim, n);
        }
        if TOUCHED {
            sums.forces[1] = buffers.touch.resultant(&buffers.middle, dim, n);
        }
    }

    /// What supports give: they hold what the balance leaves.
    #[inline(always)]
    fn reactions<const LOADED: bool, const DAMPED: bool, const TOUCHED: bool>(
        &self,
        (of, moves): (&Within, bool),
        (buffers, sums): (&mut Buffers, &mut Sums),
        a1: &[f64],
    ) {
        let (dim, [old, new]) = (self.system.dim, self.weights[1]);
        let Buffers {
            mass,
            place,
            middle,
            load: reaction,
            ..
        } = buffers;
        for i in 0..a1.len() {
            let mut held = 0.0;
            if of.fixed[i] {
                let [mut load, mut touch] = [[0.0; 2]; 2];
                if LOADED {
                    load = of.load.map(|(force, factor)| factor * force[i]);
                }
                if DAMPED {
                    for (load, (force, factor)) in load.iter_mut().zip(&of.damping) {
                        *load -= factor * force[i];
                    }
                }
                if TOUCHED {
                    touch = of.contact.map(|(force, factor)| factor * force[i]);
                }
                let inside = [
                    mass.get(i) * of.a[i] + of.f[0][i] - load[0],
                    mass.get(i) * a1[i] + of.f[1][i] - load[1],
                ];
                held = old * (inside[0] - touch[0]) + new * (inside[1] - touch[1]);
                sums.outside[0][i % dim] += inside[1];
                sums.outside[1][i % dim] -= touch[1];
            }
            reaction.set(i, held);
            let way = self.way.v * of.v[i] + self.way.a * of.a[i];
            let back = if moves { 0.5 * way } else { 0.0 };
            middle.set(i, place.get(i) - back);
        }
        sums.forces[2] = reaction.resultant(middle, dim, a1.len());
    }
}
