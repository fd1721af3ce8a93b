//! Whether two cores met in a step, and how far apart they are at its end.

use carom_mesh::Bounds;

use super::core::{Core, Piece};
use super::pair::{self, Moving};

type Vec3 = [f64; 3];

/// Farthest that pieces are looked at, over the size of a patch of the finer core: beyond, the boxes tell.
const REACH: f64 = 0.5;

/// Rounding of distances, over the largest coordinate.
const ROUNDING: f64 = 1000.0 * f64::EPSILON;

/// A core with its vertices before and after a step, m.
#[derive(Clone, Copy, Debug)]
pub struct Moved<'a> {
    /// The core.
    pub core: &'a Core,
    /// Its vertices at the start of the step.
    pub before: &'a [Vec3],
    /// Its vertices at the end.
    pub after: &'a [Vec3],
    /// Part of the way to them from the nodes at which the vertices are ([`Core::part_against`]).
    pub part: f64,
}

impl Moved<'_> {
    fn most_kept(&self) -> f64 {
        self.part * self.core.most_kept()
    }
}

/// Where and when two cores met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// Part of the step.
    pub part: f64,
    /// Place then, m.
    pub place: Vec3,
}

/// What a look at two cores finds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Their first meeting in the step, if any.
    pub met: Option<Meeting>,
    /// What they may move towards each other from the end of the step on before they can meet, m: no more than their distance.
    pub apart: f64,
    /// Pairs of nodes, edges and triangles that were looked at.
    pub tested: u64,
}

/// Room of a look, kept from one to the next.
#[derive(Clone, Debug, Default)]
pub struct Room {
    sides: [Side; 2],
}

#[derive(Clone, Debug, Default)]
struct Side {
    /// Vertices at the end, less the drift of the second core.
    after: Vec<Vec3>,
    /// Patches in reach of the other core, with the boxes that they sweep over.
    patches: Vec<(Bounds, u32)>,
}

/// Looks at two cores in a step, in a space of `dim` dimensions.
///
/// Vertices move along straight lines. Patches whose boxes, swept over the step, are further apart than the reach cannot meet in it, and are further apart
/// than that at its end. Boxes are those in a frame that moves with the second core: bodies that fly side by side have small ones.
pub fn look([one, other]: [Moved; 2], dim: usize, room: &mut Room) -> Look {
    let drift = drift(&other);
    let [a, b] = &mut room.sides;
    let (whole_a, whole_b) = (a.take(&one, &drift), b.take(&other, &drift));
    let size = [one.core.size(), other.core.size()];
    let reach = REACH
        * match size.map(|size| size > 0.0) {
            [true, true] => size[0].min(size[1]),
            _ => size[0].max(size[1]),
        };
    let rounding = ROUNDING * whole_a.reach().max(whole_b.reach());
    let keeps = one.most_kept() + other.most_kept();
    let boxes = whole_a.apart(&whole_b) - pair::NEAR * keeps - rounding;
    let mut found = Look {
        met: None,
        apart: reach.max(boxes),
        tested: 0,
    };
    if boxes >= reach {
        return found;
    }
    let wide = reach + pair::NEAR * keeps;
    a.choose(&one, &whole_b.widened(wide));
    b.choose(&other, &whole_a.widened(wide));
    let axis = sparsest(&whole_a.union(&whole_b), [&a.patches, &b.patches]);
    for side in [&mut *a, &mut *b] {
        side.patches.sort_unstable_by(|(one, k), (other, l)| {
            one.min[axis].total_cmp(&other.min[axis]).then(k.cmp(l))
        });
    }
    let mut pairs = Pairs {
        sides: [one, other],
        after: [&a.after, &b.after],
        top: dim + 1,
        rounding,
        found: &mut found,
    };
    sweep(&a.patches, &b.patches, axis, wide, &mut |k, l| {
        pairs.test([k, l]);
    });
    found
}

/// Calls `visit` with patches whose boxes are closer than `wide`.
fn sweep(
    one: &[(Bounds, u32)],
    other: &[(Bounds, u32)],
    axis: usize,
    wide: f64,
    visit: &mut dyn FnMut(u32, u32),
) {
    let (mut i, mut j) = (0, 0);
    while i < one.len() && j < other.len() {
        let first = one[i].0.min[axis] <= other[j].0.min[axis];
        let (own, rest) = match first {
            true => (&one[i], &other[j..]),
            false => (&other[j], &one[i..]),
        };
        let end = own.0.max[axis] + wide;
        let met = rest
            .iter()
            .take_while(|(bounds, _)| bounds.min[axis] <= end);
        for (_, number) in met.filter(|(bounds, _)| bounds.apart(&own.0) <= wide) {
            match first {
                true => visit(own.1, *number),
                false => visit(*number, own.1),
            }
        }
        match first {
            true => i += 1,
            false => j += 1,
        }
    }
}

impl Side {
    /// Takes the vertices at the end in the frame of the drift; the box that the core sweeps over.
    fn take(&mut self, moved: &Moved, drift: &Vec3) -> Bounds {
        self.after.clear();
        self.patches.clear();
        let after = moved.after.iter();
        self.after
            .extend(after.map(|x| [0, 1, 2].map(|i| x[i] - drift[i])));
        Bounds::of(moved.before).union(&Bounds::of(&self.after))
    }

    /// Takes the patches that come into a box.
    fn choose(&mut self, moved: &Moved, within: &Bounds) {
        for patch in 0..moved.core.patches() {
            let before = moved.core.bounds(patch, moved.before);
            let swept = before.union(&moved.core.bounds(patch, &self.after));
            if swept.overlaps(within) {
                self.patches.push((swept, patch as u32));
            }
        }
    }
}

/// Pairs of pieces under test.
struct Pairs<'a, 'b> {
    sides: [Moved<'a>; 2],
    after: [&'b [Vec3]; 2],
    top: usize,
    rounding: f64,
    found: &'b mut Look,
}

impl Pairs<'_, '_> {
    /// Tests the pieces of two patches that can meet first: of two patches of surfaces in space a node and a triangle or two edges, in the plane a node and
    /// an edge, of ends of bars two nodes. A node or a line that is no part of a surface may meet all of a patch.
    fn test(&mut self, patches: [u32; 2]) {
        let [one, other] = [0, 1].map(|k| (self.sides[k].core, patches[k] as usize));
        let most = [one, other].map(|(core, patch)| core.most_corners(patch));
        let corners = self.top.min(most[0] + most[1]);
        for first in one.0.pieces_of(one.1) {
            let piece = one.0.piece(first);
            for second in other.0.pieces_of(other.1) {
                let partner = other.0.piece(second);
                if piece.corners().len() + partner.corners().len() == corners {
                    self.look([piece, partner]);
                }
            }
        }
    }

    fn look(&mut self, pieces: [&Piece; 2]) {
        let keeps: f64 = (0..2)
            .map(|k| self.sides[k].part * self.sides[k].core.keeps(pieces[k]))
            .sum::<f64>()
            + self.rounding;
        let places = [0, 1].map(|k| {
            let corner = |i: usize| {
                let corners = pieces[k].corners();
                let vertex = corners[i.min(corners.len() - 1)] as usize;
                Moving {
                    start: self.sides[k].before[vertex],
                    end: self.after[k][vertex],
                }
            };
            [0, 1, 2].map(corner)
        });
        let boxes = [0, 1].map(|k| {
            let of = &places[k];
            Bounds::of(&[0, 1, 2].map(|i| of[i].start))
                .union(&Bounds::of(&[0, 1, 2].map(|i| of[i].end)))
        });
        // nothing that far apart is the next to meet
        if boxes[0].apart(&boxes[1]) > self.found.apart.max(0.0) + pair::NEAR * keeps {
            return;
        }
        self.found.tested += 1;
        let [one, other] = [0, 1].map(|k| &places[k][..pieces[k].corners().len()]);
        match pair::meeting(one, other, keeps) {
            Some(part) => {
                let sooner = self.found.met.is_none_or(|met| part < met.part);
                if sooner {
                    let vertex = pieces[0].corners()[0] as usize;
                    let (from, to) = (self.sides[0].before[vertex], self.sides[0].after[vertex]);
                    let place = [0, 1, 2].map(|i| from[i] + part * (to[i] - from[i]));
                    self.found.met = Some(Meeting { part, place });
                }
                self.found.apart = 0.0;
            }
            None => {
                let apart = pair::apart_at_end(one, other) - pair::NEAR * keeps;
                self.found.apart = self.found.apart.min(apart.max(0.0));
            }
        }
    }
}

/// Whether two cores meet at the start of a step, or are no further apart than they are to keep.
pub fn overlap(moved: [Moved; 2], dim: usize, room: &mut Room) -> bool {
    let still = moved.map(|moved| Moved {
        after: moved.before,
        ..moved
    });
    look(still, dim, room).met.is_some() || pierce(still, dim, room)
}

/// Whether an edge of one of two cores that [`look`] has just taken goes through a triangle of the other, in the plane an edge.
fn pierce(still: [Moved; 2], dim: usize, room: &Room) -> bool {
    let [a, b] = &room.sides;
    let mut pierced = false;
    let axis = 0;
    let mut sorted = [a.patches.clone(), b.patches.clone()];
    for patches in &mut sorted {
        patches.sort_unstable_by(|one, other| one.0.min[axis].total_cmp(&other.0.min[axis]));
    }
    let wanted = match dim {
        3 => [[2, 3], [3, 2]],
        _ => [[2, 2]; 2],
    };
    sweep(&sorted[0], &sorted[1], axis, 0.0, &mut |k, l| {
        let of = [(0, k as usize), (1, l as usize)].map(|(side, patch)| {
            let core = still[side].core;
            core.pieces_of(patch).map(move |number| core.piece(number))
        });
        let [one, other] = of;
        for piece in one {
            for partner in other.clone() {
                let counts = [piece.corners().len(), partner.corners().len()];
                let goes = wanted.contains(&counts) && {
                    let at = |side: usize, piece: &Piece| -> [Vec3; 3] {
                        let corners = piece.corners();
                        [0, 1, 2].map(|i| {
                            let vertex = corners[i.min(corners.len() - 1)];
                            still[side].before[vertex as usize]
                        })
                    };
                    let [one, other] = [at(0, piece), at(1, partner)];
                    match (counts, dim) {
                        ([2, 3], _) => pair::pierces(&one, &other),
                        ([3, 2], _) => pair::pierces(&other, &one),
                        _ => pair::crosses(&one, &other),
                    }
                };
                pierced |= goes;
            }
        }
    });
    pierced
}

/// Mean motion of the vertices of a core, m.
fn drift(moved: &Moved) -> Vec3 {
    let mut sum = [0.0; 3];
    for (from, to) in moved.before.iter().zip(moved.after) {
        sum = [0, 1, 2].map(|i| sum[i] + (to[i] - from[i]));
    }
    sum.map(|sum| sum / moved.before.len().max(1) as f64)
}

/// The axis along which a box holds most of the boxes of patches one behind the other.
fn sparsest(whole: &Bounds, patches: [&[(Bounds, u32)]; 2]) -> usize {
    let side = |bounds: &Bounds, axis: usize| bounds.max[axis] - bounds.min[axis];
    let places = |axis: usize| {
        let all = patches.into_iter().flatten();
        let sum: f64 = all.map(|(bounds, _)| side(bounds, axis)).sum();
        side(whole, axis) / sum.max(f64::MIN_POSITIVE)
    };
    (1..3).fold(0, |best, axis| match places(axis) > places(best) {
        true => axis,
        false => best,
    })
}
