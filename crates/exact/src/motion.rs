//! The motion of one bar, from the wave emitted at its contact end.
//!
//! With P the wave that runs into the bar and R = ±1 the reflection at the far end, d'Alembert's solution is
//! ```text
//! v(s, t) = P(t - s/c) + R P(t + s/c - T) + a t                 a t: only if the far end is free
//! N(s, t) = Z (P(t - s/c) - R P(t + s/c - T)) + rho A a s       rho A a s: only if it is clamped
//! ```
//! (N: compressive force; a: body acceleration; the terms in a are a particular solution without force at s = 0).
//! P on (-T, 0) carries the initial state.

use crate::wave::{Line, Wave};
use crate::{Bar, FarEnd};

/// The exact motion of one bar from time 0 to the end time of the solution.
///
/// `s` is the material distance from the contact end, m, from 0 to the length; `t` the time, s. Vectors are positive
/// away from the contact. Velocity, force and stress at a wave front are those after its passage at the contact end.
#[derive(Clone, Debug)]
pub struct Motion {
    bar: Bar,
    wave: Wave,
}

impl Motion {
    /// The motion at time 0: only the part of the wave that carries the initial state.
    pub(crate) fn new(bar: Bar) -> Motion {
        let half = 0.5 * bar.round_trip();
        let r = bar.reflection();
        let a = bar.static_acceleration();
        let ce = bar.wave_speed() * bar.strain;
        let returning = Line {
            value: 0.5 * r * (bar.velocity + ce),
            slope: 0.5 * r * a,
        };
        let outgoing = Line {
            value: 0.5 * (bar.velocity - ce - a * half),
            slope: 0.5 * a,
        };
        let mut wave = Wave::new(-2.0 * half, -half, returning);
        wave.push(0.0, outgoing, 0.0);
        Motion { bar, wave }
    }

    /// The bar and its initial state.
    pub fn bar(&self) -> &Bar {
        &self.bar
    }

    /// The wave P(t) emitted at the contact end, m/s, from -T (initial state included) to the end time.
    pub fn wave(&self) -> &Wave {
        &self.wave
    }

    /// Velocity at the material point `s` and time `t`, m/s.
    pub fn velocity(&self, s: f64, t: f64) -> f64 {
        let (into, back) = self.waves(s, t);
        into + back + self.bar.free_acceleration() * t
    }

    /// Displacement since the undeformed state at the material point `s` and time `t`, m.
    pub fn displacement(&self, s: f64, t: f64) -> f64 {
        let (into, back) = self.wave_integrals(s, t);
        let initial = self.bar.strain * (s - self.bar.length);
        initial + into + back + 0.5 * self.bar.free_acceleration() * t * t
    }

    /// Compressive force through the section `s` at time `t`, N, positive in compression.
    pub fn force(&self, s: f64, t: f64) -> f64 {
        let (into, back) = self.waves(s, t);
        self.bar.impedance() * (into - back) + self.static_force(s)
    }

    /// Integral of [`Motion::force`] from 0 to `t`, N s: at s = 0 the contact impulse, at s = L that of the support.
    pub fn impulse(&self, s: f64, t: f64) -> f64 {
        let (into, back) = self.wave_integrals(s, t);
        self.bar.impedance() * (into - back) + self.static_force(s) * t
    }

    /// Stress at the material point `s` and time `t`, Pa, positive in tension.
    pub fn stress(&self, s: f64, t: f64) -> f64 {
        -self.force(s, t) / self.bar.area
    }

    /// Strain at the material point `s` and time `t`, positive in tension.
    pub fn strain(&self, s: f64, t: f64) -> f64 {
        self.stress(s, t) / self.bar.modulus
    }

    /// Momentum ∫ rho A v ds at time `t`, N s, positive away from the contact.
    pub fn momentum(&self, t: f64) -> f64 {
        self.bar.density * self.bar.area * self.integrate(t, |s| self.velocity(s, t))
    }

    /// Kinetic energy ∫ rho A v²/2 ds at time `t`, J.
    pub fn kinetic_energy(&self, t: f64) -> f64 {
        0.5 * self.bar.density * self.bar.area * self.integrate(t, |s| self.velocity(s, t).powi(2))
    }

    /// Strain energy ∫ N²/(2 E A) ds at time `t`, J.
    pub fn strain_energy(&self, t: f64) -> f64 {
        0.5 / (self.bar.modulus * self.bar.area) * self.integrate(t, |s| self.force(s, t).powi(2))
    }

    /// Potential energy of the body force, -∫ rho A a u ds, at time `t`, J, zero in the undeformed state.
    pub fn potential_energy(&self, t: f64) -> f64 {
        let weight = self.bar.density * self.bar.area * self.bar.acceleration;
        if weight == 0.0 {
            0.0
        } else {
            -weight * self.integrate(t, |s| self.displacement(s, t))
        }
    }

    /// Kinetic + strain + potential energy at time `t`, J: constant, but for the work of the contact force.
    pub fn energy(&self, t: f64) -> f64 {
        self.kinetic_energy(t) + self.strain_energy(t) + self.potential_energy(t)
    }

    /// Material points of wave fronts inside the bar at time `t`, sorted, m: the jumps and kinks of all fields.
    pub fn fronts(&self, t: f64) -> Vec<f64> {
        let (l, c) = (self.bar.length, self.bar.wave_speed());
        let path = self.wave.breakpoints().map(|emitted| c * (t - emitted));
        let mut fronts: Vec<f64> = path.map(|x| if x > l { 2.0 * l - x } else { x }).collect();
        fronts.retain(|&s| s > 0.0 && s < l);
        fronts.sort_by(f64::total_cmp);
        fronts
    }

    /// Next time after `t` + `tolerance` at which the returning wave has a jump or a kink, s; `None` if no part of the wave
    /// that is on its way has one.
    pub(crate) fn next_arrival(&self, t: f64, tolerance: f64) -> Option<f64> {
        let delay = self.bar.round_trip();
        let emitted = self.wave.next_break(t - delay + tolerance);
        emitted.map(|emitted| emitted + delay)
    }

    /// Whether the wave that is on its way is one constant, which `line`, emitted next, continues within `tolerance`: it then
    /// returns unchanged for as long as that is emitted.
    pub(crate) fn is_steady(&self, line: Line, tolerance: f64) -> bool {
        self.wave.is_continued(line, tolerance)
    }

    /// The returning wave R P(t - T) as a line anchored at `t`, taken from the piece that holds time `inside`.
    pub(crate) fn returning(&self, t: f64, inside: f64) -> Line {
        let delay = self.bar.round_trip();
        self.wave
            .line(inside - delay, t - delay)
            .scaled(self.bar.reflection())
    }

    /// Velocity the contact end would have without contact force, m/s: 2 R P(t - T) + a t, as a line anchored at `t`.
    pub(crate) fn free_velocity(&self, t: f64, inside: f64) -> Line {
        let a = self.bar.free_acceleration();
        self.returning(t, inside).scaled(2.0).plus(Line {
            value: a * t,
            slope: a,
        })
    }

    /// Emits a piece of wave up to time `end`.
    pub(crate) fn emit(&mut self, end: f64, line: Line, tolerance: f64) {
        self.wave.push(end, line, tolerance);
    }

    fn static_force(&self, s: f64) -> f64 {
        self.bar.density * self.bar.area * self.bar.static_acceleration() * s
    }

    /// (P(t - s/c), R P(t + s/c - T)), m/s.
    fn waves(&self, s: f64, t: f64) -> (f64, f64) {
        let (into, back) = self.phases(s);
        (
            self.wave.value(t - into),
            self.bar.reflection() * self.wave.value(t - back),
        )
    }

    /// Integrals of [`Motion::waves`] from 0 to `t`, m.
    fn wave_integrals(&self, s: f64, t: f64) -> (f64, f64) {
        let since_start = |delay: f64| self.wave.integral(t - delay) - self.wave.integral(-delay);
        let (into, back) = self.phases(s);
        (since_start(into), self.bar.reflection() * since_start(back))
    }

    /// Delays (s/c, T - s/c) of the two waves at `s`, s.
    fn phases(&self, s: f64) -> (f64, f64) {
        let into = s / self.bar.wave_speed();
        (into, self.bar.round_trip() - into)
    }

    /// Integral over the bar of a function that is a cubic between fronts: two Gauss points on each interval.
    fn integrate(&self, t: f64, f: impl Fn(f64) -> f64) -> f64 {
        let mut ends = self.fronts(t);
        ends.push(self.bar.length);
        let offset = 0.5 / 3f64.sqrt();
        let mut start = 0.0;
        let mut total = 0.0;
        for end in ends {
            let (mid, h) = (0.5 * (start + end), end - start);
            total += 0.5 * h * (f(mid - offset * h) + f(mid + offset * h));
            start = end;
        }
        total
    }
}

impl Bar {
    /// Acceleration of the unstrained bar under its body force, m/s²: zero if clamped.
    fn free_acceleration(&self) -> f64 {
        if self.far_end == FarEnd::Free {
            self.acceleration
        } else {
            0.0
        }
    }

    /// Body acceleration that the clamp carries, m/s²: zero if free.
    fn static_acceleration(&self) -> f64 {
        self.acceleration - self.free_acceleration()
    }
}
