//! Impact of one bar on a rigid wall or of two bars on each other, by a delay recursion.
//!
//! Between two arrivals of waves at the contact everything is linear in time. With r the gap rate that the contact
//! ends would have without force (twice the returning waves, plus free fall) and 1/Z = sum of 1/Z_i,
//! ```text
//! open:   gap' = r,  F = 0            closes where the gap, a parabola, reaches 0
//! closed: gap' = 0,  F = -Z r         opens where r, a straight line, reaches 0
//! ```
//! and each bar emits P_i = (returning wave) + F/Z_i. Times, forces and displacements carry round-off only.

use crate::wave::{Line, Wave};
use crate::{Bar, Error, Motion};

/// Most pieces of time a solution may have; beyond, a run of very unequal bars would fill the memory.
const MAX_PIECES: usize = 1 << 20;

/// Relative size below which times, velocities and gaps count as round-off.
const ROUND_OFF: f64 = 1e-12;

/// An impact problem. Gaps are positive when open; velocities are positive away from the contact, for each bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Impact {
    /// One bar and a rigid wall.
    Wall {
        /// The bar.
        bar: Bar,
        /// Distance of its contact end from the wall at time 0, m.
        gap: f64,
    },
    /// Two bars on one line.
    TwoBars {
        /// Body 1, which carries the contact pressure; it lies on the negative side of the common axis.
        secondary: Bar,
        /// Body 2; it lies on the positive side of the common axis.
        primary: Bar,
        /// Distance of the contact ends at time 0, m.
        gap: f64,
    },
}

impl Impact {
    /// Distance of the contact ends at time 0, m.
    pub fn gap(&self) -> f64 {
        match *self {
            Impact::Wall { gap, .. } | Impact::TwoBars { gap, .. } => gap,
        }
    }

    /// The bars, the secondary one first.
    pub fn bars(&self) -> Vec<Bar> {
        match *self {
            Impact::Wall { bar, .. } => vec![bar],
            Impact::TwoBars {
                secondary, primary, ..
            } => vec![secondary, primary],
        }
    }
}

/// One interval of contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Time of closing, s.
    pub start: f64,
    /// Time of release, s; the end time of the solution if it is still closed there.
    pub end: f64,
    /// Largest contact force, N.
    pub peak_force: f64,
    /// Integral of the contact force, N s.
    pub impulse: f64,
}

/// The exact solution of an impact from time 0 to its end time.
#[derive(Clone, Debug)]
pub struct Solution {
    initial_gap: f64,
    motions: Vec<Motion>,
    force: Wave,
    gap_rate: Wave,
    contacts: Vec<Contact>,
}

impl Solution {
    /// Time up to which the solution holds, s.
    pub fn end_time(&self) -> f64 {
        self.force.end()
    }

    /// Motions of the bars: the secondary one first, then the primary one unless that is the wall.
    pub fn motions(&self) -> &[Motion] {
        &self.motions
    }

    /// Contact force F(t), N, positive in compression; its integral is the impulse, its mean that of a time step.
    pub fn force(&self) -> &Wave {
        &self.force
    }

    /// Impulse ∫ F from 0 to `t`, N s.
    pub fn impulse(&self, t: f64) -> f64 {
        self.force.integral(t)
    }

    /// Gap rate, m/s, positive when opening.
    pub fn gap_rate(&self) -> &Wave {
        &self.gap_rate
    }

    /// Gap at time `t`, m, positive when open; zero to round-off in contact.
    pub fn gap(&self, t: f64) -> f64 {
        self.initial_gap + self.gap_rate.integral(t)
    }

    /// Intervals of contact, in order.
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts
    }

    /// Time of the first closing, s; none before the end time: `None`.
    pub fn first_contact(&self) -> Option<f64> {
        self.contacts.first().map(|c| c.start)
    }

    /// Times of release before the end time, in order, s.
    pub fn releases(&self) -> impl Iterator<Item = f64> + '_ {
        self.contacts
            .iter()
            .map(|c| c.end)
            .filter(|&end| end < self.end_time())
    }

    /// Position of the material point `s` of bar `body` at time `t` on the common axis, m.
    ///
    /// The axis points from the secondary to the primary body; its origin is the wall, or the contact end of the
    /// primary bar at time 0. `body` is an index into [`Solution::motions`].
    pub fn position(&self, body: usize, s: f64, t: f64) -> f64 {
        let motion = &self.motions[body];
        let from_start = s + motion.displacement(s, t) - motion.displacement(0.0, 0.0);
        if body == 0 {
            -(self.initial_gap + from_start)
        } else {
            from_start
        }
    }

    /// Momentum of all bars at time `t` along the common axis (secondary to primary), N s.
    pub fn momentum(&self, t: f64) -> f64 {
        let along_axis = [-1.0, 1.0];
        self.motions
            .iter()
            .zip(along_axis)
            .map(|(m, sign)| sign * m.momentum(t))
            .sum()
    }

    /// Kinetic energy of all bars at time `t`, J.
    pub fn kinetic_energy(&self, t: f64) -> f64 {
        self.motions.iter().map(|m| m.kinetic_energy(t)).sum()
    }

    /// Strain energy of all bars at time `t`, J.
    pub fn strain_energy(&self, t: f64) -> f64 {
        self.motions.iter().map(|m| m.strain_energy(t)).sum()
    }

    /// Kinetic, strain and potential energy of all bars at time `t`, J: constant.
    pub fn energy(&self, t: f64) -> f64 {
        self.motions.iter().map(|m| m.energy(t)).sum()
    }

    /// Appends one contact piece, or none if the piece is open.
    fn record(&mut self, start: f64, end: f64, force: Option<Line>) {
        let Some(force) = force else { return };
        let peak_force = force.value.max(force.at(end - start));
        match self.contacts.last_mut().filter(|last| last.end == start) {
            Some(last) => {
                last.end = end;
                last.peak_force = last.peak_force.max(peak_force);
            }
            None => self.contacts.push(Contact {
                start,
                end,
                peak_force,
                impulse: 0.0,
            }),
        }
    }
}

/// Solves an impact exactly from time 0 to `end_time`, s.
///
/// Waves are piecewise constant, piecewise linear under gravity; the recursion jumps from one arrival, closing or
/// release to the next. Any number of bounces, unequal bars, free or clamped far ends, initial strain.
///
/// Errors: a value that is not finite, not positive where it must be, a negative gap, or a motion of more than 2^20
/// pieces.
///
/// Source: d'Alembert's solution (Graff, *Wave motion in elastic solids*, 1975, chapter 2) with Signorini's conditions.
pub fn solve(impact: &Impact, end_time: f64) -> Result<Solution, Error> {
    let recursion = Recursion::new(impact, end_time)?;
    recursion.run(end_time)
}

/// Sizes below which a number is round-off.
struct Tolerance {
    time: f64,
    velocity: f64,
    gap: f64,
}

impl Tolerance {
    fn new(bars: &[Bar], gap: f64, end_time: f64) -> Tolerance {
        let speed = |b: &Bar| {
            b.velocity.abs() + b.wave_speed() * b.strain.abs() + b.acceleration.abs() * end_time
        };
        let speed: f64 = bars.iter().map(speed).sum();
        let shortest = bars
            .iter()
            .map(Bar::round_trip)
            .fold(f64::INFINITY, f64::min);
        // Long runs: a time step must not vanish beside t, nor a gap that takes less than a time step to close.
        let time = ROUND_OFF * shortest + 4.0 * f64::EPSILON * end_time;
        Tolerance {
            time,
            velocity: ROUND_OFF * speed,
            gap: ROUND_OFF * gap + time * speed,
        }
    }
}

struct Recursion {
    solution: Solution,
    tolerance: Tolerance,
    /// Z of the contact: 1/Z = sum of 1/Z_i, N s/m.
    impedance: f64,
}

impl Recursion {
    fn new(impact: &Impact, end_time: f64) -> Result<Recursion, Error> {
        let (bars, gap) = (impact.bars(), impact.gap());
        bars.iter().try_for_each(Bar::check)?;
        if !(gap >= 0.0 && gap.is_finite()) {
            return Err(Error::Penetration { gap });
        }
        if !(end_time > 0.0 && end_time.is_finite()) {
            return Err(Error::NotPositive {
                quantity: "end time",
                value: end_time,
            });
        }
        let nothing = Wave::new(0.0, 0.0, Line::ZERO);
        Ok(Recursion {
            tolerance: Tolerance::new(&bars, gap, end_time),
            impedance: 1.0 / bars.iter().map(|b| 1.0 / b.impedance()).sum::<f64>(),
            solution: Solution {
                initial_gap: gap,
                motions: bars.into_iter().map(Motion::new).collect(),
                force: nothing.clone(),
                gap_rate: nothing,
                contacts: Vec::new(),
            },
        })
    }

    fn run(mut self, end_time: f64) -> Result<Solution, Error> {
        let (mut t, mut steps) = (0.0, 0);
        while t < end_time {
            t = self.step(t, end_time);
            steps += 1;
            if steps > MAX_PIECES {
                return Err(Error::TooManyPieces {
                    limit: MAX_PIECES,
                    time: t,
                });
            }
        }
        let Solution {
            contacts, force, ..
        } = &mut self.solution;
        for contact in contacts {
            contact.impulse = force.integral(contact.end) - force.integral(contact.start);
        }
        Ok(self.solution)
    }

    /// Adds the next piece, up to the first of: an arrival, a closing, a release, the end time. Returns its end.
    fn step(&mut self, t: f64, end_time: f64) -> f64 {
        let mut piece = self.piece(t, self.horizon(t, end_time, |_| true));
        // Bars whose waves stay what they are hear of no arrival: without this a run of very many round trips would take one
        // step for each.
        let changes = |bar: usize| !self.is_steady(bar, t, &piece);
        let far = self.horizon(t, end_time, changes);
        if far > piece.horizon {
            let longer = self.piece(t, far);
            let steady = |bar| changes(bar) || self.is_steady(bar, t, &longer);
            if (0..self.solution.motions.len()).all(steady) {
                piece = longer;
            }
        }
        let event = match piece.force {
            Some(_) => release(piece.rate),
            None => closing(piece.gap, piece.rate),
        };
        let end = event.map_or(piece.horizon, |dt| piece.horizon.min(t + dt));
        self.emit(end, &piece);
        let rate = match piece.force {
            Some(_) => Line::ZERO,
            None => piece.rate,
        };
        self.solution.gap_rate.push(end, rate, self.merge());
        self.solution.record(t, end, piece.force);
        end
    }

    /// The next arrival after `t`, or `end_time`; at bars without one on its way, that of what is emitted at `t` if it `changes`
    /// the wave of the bar.
    fn horizon(&self, t: f64, end_time: f64, changes: impl Fn(usize) -> bool) -> f64 {
        let motions = self.solution.motions.iter().enumerate();
        let arrivals = motions.filter_map(|(bar, motion)| {
            let arrival = motion.next_arrival(t, self.tolerance.time);
            arrival.or_else(|| changes(bar).then(|| t + motion.bar().round_trip()))
        });
        arrivals.fold(end_time, f64::min)
    }

    /// Whether no arrival is on its way in a bar, and none will be while it emits what the piece says.
    fn is_steady(&self, bar: usize, t: f64, piece: &Piece) -> bool {
        let motion = &self.solution.motions[bar];
        motion.next_arrival(t, self.tolerance.time).is_none()
            && motion.is_steady(piece.emitted(t, motion), self.merge())
    }

    /// What happens from `t` on, if nothing arrives before `horizon`.
    fn piece(&self, t: f64, horizon: f64) -> Piece {
        // Arrivals that differ by round-off leave slivers: the piece is the one in force at mid-step. What is on its way
        // longer than a round trip is not known yet: it is steady then, and the first round trip tells it.
        let shortest = self.solution.motions.iter().map(|m| m.bar().round_trip());
        let ahead = shortest.fold(horizon - t, f64::min);
        let inside = t + 0.5 * ahead;
        let rate = self.free_rate(t, inside, horizon);
        let gap = self.solution.gap(t);
        let touching = gap <= self.tolerance.gap;
        let closed = touching && (rate.value < 0.0 || rate.value == 0.0 && rate.slope < 0.0);
        Piece {
            horizon,
            inside,
            rate,
            gap: if touching { 0.0 } else { gap },
            force: closed.then(|| rate.scaled(-self.impedance)),
        }
    }

    /// Gap rate without contact force from `t` to `horizon`, with round-off set to zero: it must not open or close.
    fn free_rate(&self, t: f64, inside: f64, horizon: f64) -> Line {
        let rate = self
            .solution
            .motions
            .iter()
            .fold(Line::ZERO, |sum, m| sum.plus(m.free_velocity(t, inside)));
        let clean = |x: f64, change: f64| {
            if change.abs() <= self.tolerance.velocity {
                0.0
            } else {
                x
            }
        };
        Line {
            value: clean(rate.value, rate.value),
            slope: clean(rate.slope, rate.slope * (horizon - t)),
        }
    }

    fn emit(&mut self, end: f64, piece: &Piece) {
        let merge = self.merge();
        let t = self.solution.force.end();
        for motion in &mut self.solution.motions {
            let wave = piece.emitted(t, motion);
            motion.emit(end, wave, merge);
        }
        let force = piece.force.unwrap_or(Line::ZERO);
        self.solution.force.push(end, force, merge * self.impedance);
    }

    /// Jump of velocity below which two pieces are one, m/s.
    fn merge(&self) -> f64 {
        1e-2 * self.tolerance.velocity
    }
}

/// What happens between two events, as lines anchored at its start.
struct Piece {
    /// The first arrival after the start, or the end time, s.
    horizon: f64,
    /// An instant within it, s.
    inside: f64,
    /// Gap rate without contact force.
    rate: Line,
    /// Gap at the start, m.
    gap: f64,
    /// Contact force; none while open.
    force: Option<Line>,
}

impl Piece {
    /// The wave that a bar emits from `t` on.
    fn emitted(&self, t: f64, motion: &Motion) -> Line {
        let force = self.force.unwrap_or(Line::ZERO);
        let of_force = force.scaled(1.0 / motion.bar().impedance());
        motion.returning(t, self.inside).plus(of_force)
    }
}

/// Time after which a closed contact opens: the rate without force, below zero at first, reaches zero.
fn release(rate: Line) -> Option<f64> {
    (rate.value < 0.0 && rate.slope > 0.0).then(|| -rate.value / rate.slope)
}

/// Time after which an open gap closes: first positive root of gap + rate t + slope t²/2 at which it falls.
fn closing(gap: f64, rate: Line) -> Option<f64> {
    let discriminant = rate.value * rate.value - 2.0 * gap * rate.slope;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    if rate.value < 0.0 {
        Some(2.0 * gap / (root - rate.value))
    } else {
        (rate.slope < 0.0).then(|| -(rate.value + root) / rate.slope)
    }
}
