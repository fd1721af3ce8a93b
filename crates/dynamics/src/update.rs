//! The end of an explicit step in one pass over the vectors: accelerations, velocities, and the sums of which its balances consist.
//!
//! A vector is read once. Sums are those of blocks of nodes that follow each other, added in their order, so that their bits are the
//! same for any number of threads. Within a block unknowns are added in eight lanes.

use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};

use crate::resultant::Resultant;
use crate::step_map::Row;
use crate::system::System;

/// Nodes of a block: what it reads and writes stays in the nearest cache.
const NODES: usize = 128;
/// Blocks that one thread takes, at least.
const PANEL: usize = 16;
/// Lanes in which the unknowns of a block are added.
const LANES: usize = 8;

/// Nodes of one connected part that follow each other.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    /// First node, and one end more.
    nodes: [usize; 2],
    /// Its part.
    pub(crate) part: usize,
    /// Whether any of their unknowns is held.
    held: bool,
}

/// The blocks of a system whose nodes have translations alone.
pub(crate) fn blocks(system: &System) -> Vec<Block> {
    let dim = system.dim;
    let of_part = |(part, unknowns): (usize, &Range<usize>)| {
        let (begin, end) = (unknowns.start / dim, unknowns.end / dim);
        (begin..end).step_by(NODES).map(move |first| {
            let last = end.min(first + NODES);
            Block {
                nodes: [first, last],
                part,
                held: system.fixed[dim * first..dim * last].contains(&true),
            }
        })
    };
    system.parts.iter().enumerate().flat_map(of_part).collect()
}

/// Sums over nodes in a step from `u` to u₊ on the way Δu = u₊ - u.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sums {
    /// |v₊|²_M.
    pub(crate) velocity: f64,
    /// |a|²_M at start and end.
    pub(crate) acceleration: [f64; 2],
    /// Works on Δu of the means of the forces: inertia, internal forces, loads, contacts; J.
    pub(crate) works: [f64; 4],
    /// |Δu|².
    pub(crate) way: f64,
    /// Squares of the forces of the end, in the order of the works, and of the momentum M v at the start.
    pub(crate) squares: [f64; 5],
    /// M v₊.
    pub(crate) momentum: Resultant,
    /// Means of loads, contact forces, and reactions of the supports.
    pub(crate) forces: [Resultant; 3],
    /// Sums of the forces of the end: loads with the reactions to all but contacts, and the reactions to contacts.
    pub(crate) outside: [[f64; 3]; 2],
}

impl Sums {
    /// Adds those of other nodes.
    pub(crate) fn add(&mut self, other: &Sums) {
        self.velocity += other.velocity;
        self.way += other.way;
        let pairs = self.acceleration.iter_mut().zip(other.acceleration);
        let pairs = pairs.chain(self.works.iter_mut().zip(other.works));
        let pairs = pairs.chain(self.squares.iter_mut().zip(other.squares));
        for (sum, term) in pairs {
            *sum += term;
        }
        self.momentum = self.momentum.plus(&other.momentum);
        for (sum, term) in self.forces.iter_mut().zip(&other.forces) {
            *sum = sum.plus(term);
        }
        let outside = self.outside.iter_mut().flatten();
        for (sum, term) in outside.zip(other.outside.iter().flatten()) {
            *sum += term;
        }
    }

    /// Leaves out what is no force in an axisymmetric system.
    pub(crate) fn of_axisymmetric(&mut self) {
        let resultants = self.forces.iter_mut().chain([&mut self.momentum]);
        for resultant in resultants {
            resultant.linear[0] = 0.0;
            resultant.angular = [0.0; 3];
        }
    }
}

/// A force at the start and at the end of the step: vectors, N, with a factor each.
pub(crate) type Ends<'a> = [(&'a [f64], f64); 2];

/// What the pass reads.
pub(crate) struct Update<'a> {
    pub(crate) system: &'a System,
    /// Displacement at the end, m.
    pub(crate) u: &'a [f64],
    /// Internal forces at start and end, N.
    pub(crate) f: [&'a [f64]; 2],
    /// Velocity, m/s, and acceleration, m/s², at the start.
    pub(crate) v: &'a [f64],
    pub(crate) a: &'a [f64],
    /// Loads and contact forces; none where there are none.
    pub(crate) load: Option<Ends<'a>>,
    pub(crate) contact: Option<Ends<'a>>,
    /// Δu by v and a.
    pub(crate) way: Row,
    /// v₊ by v, a and the acceleration a₊ of the end.
    pub(crate) velocity: Row,
    /// Weights of the forces of start and end in their means, of the works and of the resultants.
    pub(crate) weights: [[f64; 2]; 2],
    /// Whether moments are those of the places reached: of momentum at the end, of forces in the middle of the way. Otherwise in the
    /// reference configuration.
    pub(crate) moves: bool,
}

impl Update<'_> {
    /// Writes velocities and accelerations of the end, and the sums of each block.
    pub(crate) fn run(&self, blocks: &[Block], sums: &mut [Sums], out: [&mut [f64]; 2]) {
        self.panel(blocks, sums, (0, out));
    }

    /// The same for some of the blocks; the vectors begin at the unknown `origin`.
    fn panel(
        &self,
        blocks: &[Block],
        sums: &mut [Sums],
        (origin, [v, a]): (usize, [&mut [f64]; 2]),
    ) {
        if blocks.len() >= 2 * PANEL {
            let (before, after) = blocks.split_at(blocks.len() / 2);
            let (sums, rest) = sums.split_at_mut(before.len());
            let border = self.system.dim * after[0].nodes[0];
            let (v, v_rest) = v.split_at_mut(border - origin);
            let (a, a_rest) = a.split_at_mut(border - origin);
            rayon::join(
                || self.panel(before, sums, (origin, [v, a])),
                || self.panel(after, rest, (border, [v_rest, a_rest])),
            );
            return;
        }
        Arch::new().dispatch(Panel {
            update: self,
            blocks,
            sums,
            origin,
            out: [v, a],
        });
    }
}

struct Panel<'a> {
    update: &'a Update<'a>,
    blocks: &'a [Block],
    sums: &'a mut [Sums],
    origin: usize,
    out: [&'a mut [f64]; 2],
}

impl WithSimd for Panel<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let dim = self.update.system.dim;
        let [v, a] = self.out;
        for (block, sums) in self.blocks.iter().zip(self.sums) {
            let [first, last] = block.nodes.map(|node| dim * node);
            let range = first - self.origin..last - self.origin;
            let out = [&mut v[range.clone()], &mut a[range]];
            *sums = Sums::default();
            let update = self.update;
            match (&update.load, &update.contact) {
                (None, None) => update.block::<false, false>(block, sums, out),
                (Some(_), None) => update.block::<true, false>(block, sums, out),
                (None, Some(_)) => update.block::<false, true>(block, sums, out),
                (Some(_), Some(_)) => update.block::<true, true>(block, sums, out),
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
    mass: &'a [f64],
    fixed: &'a [bool],
    load: Ends<'a>,
    contact: Ends<'a>,
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

impl Update<'_> {
    #[inline(always)]
    fn block<const LOADED: bool, const TOUCHED: bool>(
        &self,
        block: &Block,
        sums: &mut Sums,
        [v1, a1]: [&mut [f64]; 2],
    ) {
        let [first, last] = block.nodes.map(|node| self.system.dim * node);
        let range = first..last;
        let within = Within {
            u: &self.u[range.clone()],
            f: self.f.map(|f| &f[range.clone()]),
            v: &self.v[range.clone()],
            a: &self.a[range.clone()],
            mass: &self.system.mass.lumped[range.clone()],
            fixed: &self.system.fixed[range.clone()],
            load: within(&self.load, &range),
            contact: within(&self.contact, &range),
        };
        self.move_on::<LOADED, TOUCHED>(&within, sums, [&mut *v1, &mut *a1]);
        self.resultants::<LOADED, TOUCHED>(block, &within, sums, [v1, a1]);
    }

    /// Accelerations and velocities of the end, works and squares.
    #[inline(always)]
    fn move_on<const LOADED: bool, const TOUCHED: bool>(
        &self,
        of: &Within,
        sums: &mut Sums,
        [v1, a1]: [&mut [f64]; 2],
    ) {
        let n = v1.len();
        let mut lanes = [[0.0; LANES]; 13];
        let whole = n - n % LANES;
        for first in (0..whole).step_by(LANES) {
            for k in 0..LANES {
                let out = [&mut v1[first + k], &mut a1[first + k]];
                self.unknown::<LOADED, TOUCHED>(of, first + k, out, (k, &mut lanes));
            }
        }
        for i in whole..n {
            let out = [&mut v1[i], &mut a1[i]];
            self.unknown::<LOADED, TOUCHED>(of, i, out, (i - whole, &mut lanes));
        }
        let sum = |number: usize| lanes[number].iter().sum::<f64>();
        sums.velocity = sum(0);
        sums.acceleration = [sum(1), sum(2)];
        sums.works = [sum(3), sum(4), sum(5), sum(6)];
        sums.way = sum(7);
        sums.squares = [sum(8), sum(9), sum(10), sum(11), sum(12)];
    }

    /// One unknown, whose terms are added in lane k: |v₊|², |a|², |a₊|², four works, |Δu|², five squares.
    #[inline(always)]
    fn unknown<const LOADED: bool, const TOUCHED: bool>(
        &self,
        of: &Within,
        i: usize,
        [v1, a1]: [&mut f64; 2],
        (k, lanes): (usize, &mut [[f64; LANES]; 13]),
    ) {
        let [old, new] = self.weights[0];
        let (m, du) = (of.mass[i], self.way.v * of.v[i] + self.way.a * of.a[i]);
        let ([f, f1], [mut load, mut touch]) = ([of.f[0][i], of.f[1][i]], [[0.0; 2]; 2]);
        let mut outside = 0.0;
        if LOADED {
            load = [
                of.load[0].1 * of.load[0].0[i],
                of.load[1].1 * of.load[1].0[i],
            ];
            outside = load[1];
        }
        if TOUCHED {
            let [start, end] = &of.contact;
            touch = [start.1 * start.0[i], end.1 * end.0[i]];
            outside += touch[1];
        }
        let x = (outside - f1) / m;
        let x = if of.fixed[i] { 0.0 } else { x };
        let speed = self.velocity.v * of.v[i] + self.velocity.a * of.a[i] + self.velocity.x * x;
        (*v1, *a1) = (speed, x);
        let inertia = [m * of.a[i], m * x];
        lanes[0][k] += m * speed * speed;
        lanes[1][k] += inertia[0] * of.a[i];
        lanes[2][k] += inertia[1] * x;
        lanes[3][k] += (old * inertia[0] + new * inertia[1]) * du;
        lanes[4][k] += (old * f + new * f1) * du;
        lanes[7][k] += du * du;
        lanes[8][k] += inertia[1] * inertia[1];
        lanes[9][k] += f1 * f1;
        lanes[12][k] += (m * of.v[i]) * (m * of.v[i]);
        if LOADED {
            lanes[5][k] += (old * load[0] + new * load[1]) * du;
            lanes[10][k] += load[1] * load[1];
        }
        if TOUCHED {
            lanes[6][k] += (old * touch[0] + new * touch[1]) * du;
            lanes[11][k] += touch[1] * touch[1];
        }
    }

    /// Resultants of momentum and forces.
    #[inline(always)]
    fn resultants<const LOADED: bool, const TOUCHED: bool>(
        &self,
        block: &Block,
        of: &Within,
        sums: &mut Sums,
        [v1, a1]: [&[f64]; 2],
    ) {
        let (dim, [old, new]) = (self.system.dim, self.weights[1]);
        let [first, last] = block.nodes;
        for (node, x) in self.system.x[first..last].iter().enumerate() {
            let own = dim * node..dim * (node + 1);
            let (mut end, mut middle) = (*x, *x);
            if self.moves {
                for (axis, i) in own.clone().enumerate() {
                    let way = self.way.v * of.v[i] + self.way.a * of.a[i];
                    end[axis] += of.u[i];
                    middle[axis] += of.u[i] - 0.5 * way;
                }
            }
            let mut momentum = [0.0; 3];
            for (axis, i) in own.clone().enumerate() {
                momentum[axis] = of.mass[i] * v1[i];
            }
            attach(&mut sums.momentum, &end, &momentum);
            if !LOADED && !TOUCHED && !block.held {
                continue;
            }
            let mut forces = [[0.0; 3]; 3];
            for (axis, i) in own.enumerate() {
                let [mut load, mut touch] = [[0.0; 2]; 2];
                if LOADED {
                    load = of.load.map(|(force, factor)| factor * force[i]);
                }
                if TOUCHED {
                    touch = of.contact.map(|(force, factor)| factor * force[i]);
                }
                forces[0][axis] = old * load[0] + new * load[1];
                forces[1][axis] = old * touch[0] + new * touch[1];
                sums.outside[0][axis] += load[1];
                if of.fixed[i] {
                    // supports hold what the balance leaves
                    let inside = [
                        of.mass[i] * of.a[i] + of.f[0][i] - load[0],
                        of.mass[i] * a1[i] + of.f[1][i] - load[1],
                    ];
                    forces[2][axis] = old * (inside[0] - touch[0]) + new * (inside[1] - touch[1]);
                    sums.outside[0][axis] += inside[1];
                    sums.outside[1][axis] -= touch[1];
                }
            }
            for (sum, force) in sums.forces.iter_mut().zip(&forces) {
                attach(sum, &middle, force);
            }
        }
    }
}

/// Adds a force at a place.
#[inline(always)]
fn attach(sum: &mut Resultant, x: &[f64; 3], force: &[f64; 3]) {
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        sum.linear[i] += force[i];
        sum.angular[i] += x[j] * force[k] - x[k] * force[j];
    }
}
