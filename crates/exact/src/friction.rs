//! Motions under Coulomb friction in closed form: a block on an incline, a spring-mass on a rough floor, and one on a
//! belt.
//!
//! Static and kinetic coefficient are equal. While it slides a point feels the constant friction μ N against its sliding
//! velocity; it sticks where less than that holds it.

/// A block that slides on an inclined plane, x and v along the plane, positive downhill.
///
/// With the angle α, gravity g and the coefficient μ, while v ≠ 0
/// ```text
/// dv/dt = g (sin α - μ cos α sign v)
/// ```
/// A block that comes to rest stays there if `|tan α| <= μ`, and otherwise goes on in the direction of gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incline {
    /// α in rad, between -π/2 and π/2; positive: gravity pulls towards positive x.
    pub angle: f64,
    /// μ, zero or more.
    pub mu: f64,
    /// g in m/s².
    pub gravity: f64,
    /// Velocity at t = 0, m/s.
    pub velocity: f64,
}

impl Incline {
    /// Whether a block at rest stays at rest.
    pub fn holds(&self) -> bool {
        self.angle.tan().abs() <= self.mu
    }

    /// Acceleration while the block slides in the direction `sign`, m/s².
    fn acceleration(&self, sign: f64) -> f64 {
        self.gravity * (self.angle.sin() - self.mu * self.angle.cos() * sign)
    }

    /// Time at which the block first comes to rest, s: `-v0/a`; infinite if it never does.
    pub fn stop_time(&self) -> f64 {
        if self.velocity == 0.0 {
            return 0.0;
        }
        let a = self.acceleration(self.velocity.signum());
        if a * self.velocity < 0.0 {
            -self.velocity / a
        } else {
            f64::INFINITY
        }
    }

    /// Way from t = 0 to the first rest, m: `-v0²/(2 a)`; infinite if there is none.
    pub fn stop_distance(&self) -> f64 {
        match self.stop_time() {
            t if t.is_finite() => 0.5 * self.velocity * t,
            _ => f64::INFINITY * self.velocity.signum(),
        }
    }

    /// Position in m (zero at t = 0) and velocity in m/s at the time `t` >= 0 in s.
    pub fn at(&self, t: f64) -> (f64, f64) {
        let slide = |v: f64, sign: f64, t: f64| {
            let a = self.acceleration(sign);
            (v * t + 0.5 * a * t * t, v + a * t)
        };
        let stop = self.stop_time();
        if t < stop {
            return slide(self.velocity, self.velocity.signum(), t);
        }
        let rest = 0.5 * self.velocity * stop;
        if self.holds() {
            return (rest, 0.0);
        }
        let (x, v) = slide(0.0, self.angle.signum(), t - stop);
        (rest + x, v)
    }
}

/// A mass on a spring that was pulled to x0 and released at rest on a rough floor.
///
/// With ω² = k/m and the friction shift δ = μ m g/k, the motion of half-period n = 0, 1, … is a cosine about ±δ,
/// ```text
/// x = s_n δ + (x_n - s_n δ) cos(ω t - n π),   s_n = sign x_n,   x_{n+1} = -(x_n - 2 s_n δ)
/// ```
/// so that the amplitude falls by 2 δ = 2 μ m g/k in each half-period, until at a turning point `|x_n| <= δ`, where the
/// spring no longer overcomes the friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoughFloor {
    /// m in kg.
    pub mass: f64,
    /// k in N/m.
    pub stiffness: f64,
    /// μ m g, N: largest friction force, zero or more.
    pub friction: f64,
    /// x0 in m.
    pub start: f64,
}

impl RoughFloor {
    /// ω in rad/s.
    pub fn frequency(&self) -> f64 {
        (self.stiffness / self.mass).sqrt()
    }

    /// δ in m.
    pub fn shift(&self) -> f64 {
        self.friction / self.stiffness
    }

    /// Half-periods until the mass sticks: the smallest n with `|x0| - 2 n δ <= δ`; `None` without friction, unless it
    /// starts at zero.
    pub fn half_periods(&self) -> Option<u64> {
        let excess = self.start.abs() - self.shift();
        if excess <= 0.0 {
            return Some(0);
        }
        (self.shift() > 0.0).then(|| (excess / (2.0 * self.shift())).ceil() as u64)
    }

    /// Turning point n, at the time n π/ω, m, before the mass sticks: `(-1)^n (x0 - 2 n δ sign x0)`.
    pub fn turning_point(&self, n: u64) -> f64 {
        let alternate = if n.is_multiple_of(2) { 1.0 } else { -1.0 };
        alternate * (self.start - 2.0 * n as f64 * self.shift() * self.start.signum())
    }

    /// Position in m and velocity in m/s at the time `t` >= 0 in s.
    pub fn at(&self, t: f64) -> (f64, f64) {
        let omega = self.frequency();
        let n = (omega * t / std::f64::consts::PI).floor() as u64;
        if let Some(last) = self.half_periods().filter(|last| n >= *last) {
            return (self.turning_point(last), 0.0);
        }
        let from = self.turning_point(n);
        let centre = from.signum() * self.shift();
        let phase = omega * t - n as f64 * std::f64::consts::PI;
        (
            centre + (from - centre) * phase.cos(),
            -(from - centre) * omega * phase.sin(),
        )
    }
}

/// A mass on a spring, at rest with the spring free, that is put on a belt of the velocity V > 0.
///
/// With ω² = k/m and δ = μ N/k the belt first slides under the mass; if V < ω δ it catches it at t_1, carries it until
/// the spring takes all friction, x = δ, at t_2, and loses it for good:
/// ```text
/// t < t_1         x = δ (1 - cos ω t),                 sin ω t_1 = V/(ω δ),  ω t_1 <= π/2
/// t_1 < t < t_2   x = x_1 + V (t - t_1),               t_2 = t_1 + (δ - x_1)/V
/// t_2 < t         x = δ + (V/ω) sin ω(t - t_2)
/// ```
/// The last motion touches the velocity of the belt once per period, at x = δ, and does not stick: with equal static
/// and kinetic friction there is no further stick phase. For V >= ω δ the first motion never ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Belt {
    /// m in kg.
    pub mass: f64,
    /// k in N/m.
    pub stiffness: f64,
    /// μ N, N: largest friction force, more than zero.
    pub friction: f64,
    /// V in m/s, more than zero.
    pub velocity: f64,
}

impl Belt {
    /// ω in rad/s.
    pub fn frequency(&self) -> f64 {
        (self.stiffness / self.mass).sqrt()
    }

    /// δ in m.
    pub fn shift(&self) -> f64 {
        self.friction / self.stiffness
    }

    /// [t_1, t_2] in s, between which the mass sticks; infinite if it never does.
    pub fn sticks(&self) -> [f64; 2] {
        let (omega, delta) = (self.frequency(), self.shift());
        let sine = self.velocity / (omega * delta);
        if sine >= 1.0 {
            return [f64::INFINITY; 2];
        }
        let caught = sine.asin() / omega;
        // δ - x_1 = δ cos ω t_1
        let carried = delta * (1.0 - sine * sine).sqrt() / self.velocity;
        [caught, caught + carried]
    }

    /// Position in m and velocity in m/s at the time `t` >= 0 in s.
    pub fn at(&self, t: f64) -> (f64, f64) {
        let [caught, lost] = self.sticks();
        let (omega, delta, v) = (self.frequency(), self.shift(), self.velocity);
        if t < caught {
            let (sin, cos) = (omega * t).sin_cos();
            (delta * (1.0 - cos), delta * omega * sin)
        } else if t < lost {
            (delta - v * (lost - t), v)
        } else {
            let (sin, cos) = (omega * (t - lost)).sin_cos();
            (delta + v / omega * sin, v * cos)
        }
    }

    /// Force of the belt on the mass at the time `t` >= 0, N: k x while it sticks, since then nothing accelerates, and
    /// μ N while it slips.
    pub fn force(&self, t: f64) -> f64 {
        let [caught, lost] = self.sticks();
        if (caught..lost).contains(&t) {
            self.stiffness * self.at(t).0
        } else {
            self.friction
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Greatest difference of the rate of x to v and of that of v to the acceleration, by central differences over
    /// 2e-5 s: their error, h²/6 times the third derivative of v, ω³ v < 640 here, is below 1.1e-8.
    fn imbalance(
        at: impl Fn(f64) -> (f64, f64),
        acceleration: impl Fn(f64, f64, f64) -> f64,
        times: impl Iterator<Item = f64>,
    ) -> f64 {
        let h = 1e-5;
        times
            .map(|t| {
                let (x, v) = at(t);
                let a = (at(t + h).1 - at(t - h).1) / (2.0 * h);
                let rate = (at(t + h).0 - at(t - h).0) / (2.0 * h);
                (a - acceleration(t, x, v)).abs().max((rate - v).abs())
            })
            .fold(0.0, f64::max)
    }

    #[test]
    fn a_block_thrown_uphill_stops_and_sticks_or_slides_back() {
        let steep = Incline {
            angle: 0.5,
            mu: 0.3,
            gravity: 9.81,
            velocity: -3.0,
        };
        assert!(!steep.holds());
        let rough = Incline { mu: 0.6, ..steep };
        assert!(rough.holds());
        for block in [steep, rough] {
            let t = block.stop_time();
            let (x, v) = block.at(t);
            assert!(v.abs() < 1e-14 && (x - block.stop_distance()).abs() < 1e-14);
            // the kinetic energy goes into height and friction: v²/2 = g s (sin α + μ cos α) per mass
            let work = 9.81 * x.abs() * (block.angle.sin() + block.mu * block.angle.cos());
            assert!((work - 4.5).abs() < 1e-13);
        }
        assert_eq!(rough.at(10.0), (rough.stop_distance(), 0.0));
        let (t, (x, v)) = (steep.stop_time(), steep.at(2.0));
        let way = x - steep.stop_distance();
        let a = 9.81 * (0.5_f64.sin() - 0.3 * 0.5_f64.cos());
        assert!((v - a * (2.0 - t)).abs() < 1e-13 && (v * v - 2.0 * a * way).abs() < 1e-12);
    }

    #[test]
    fn a_block_sliding_down_a_slope_that_does_not_hold_it_never_stops() {
        let block = Incline {
            angle: 0.5,
            mu: 0.3,
            gravity: 9.81,
            velocity: 1.0,
        };
        assert_eq!(block.stop_time(), f64::INFINITY);
        assert_eq!(block.stop_distance(), f64::INFINITY);
        assert!(block.at(3.0).1 > 1.0);
    }

    const FLOOR: RoughFloor = RoughFloor {
        mass: 2.0,
        stiffness: 50.0,
        friction: 4.0,
        start: -1.1,
    };

    #[test]
    fn the_amplitude_on_a_rough_floor_falls_by_two_shifts_until_the_mass_sticks() {
        let half = std::f64::consts::PI / FLOOR.frequency();
        let last = FLOOR.half_periods().unwrap();
        // δ = 0.08: 1.1 - 0.16 n <= 0.08 from n = 7 on
        assert_eq!(last, 7);
        for n in 0..last {
            let (before, after) = (FLOOR.turning_point(n), FLOOR.turning_point(n + 1));
            // spring energy lost over a half-period is the work of the friction
            let lost = 25.0 * (before * before - after * after);
            assert!((lost - 4.0 * (before - after).abs()).abs() < 1e-12);
            let (x, v) = FLOOR.at(n as f64 * half + 1e-9);
            assert!((x - before).abs() < 1e-12 && v.abs() < 1e-6);
        }
        let (x, v) = FLOOR.at(100.0);
        assert!(v == 0.0 && x == FLOOR.turning_point(last) && x.abs() <= FLOOR.shift());
    }

    #[test]
    fn the_mass_on_a_rough_floor_obeys_newton() {
        let half = std::f64::consts::PI / FLOOR.frequency();
        let times = (0..70).map(|k| 0.1 * half * (k as f64 + 0.5));
        let worst = imbalance(
            |t| FLOOR.at(t),
            |_, x, v| -25.0 * x - 2.0 * v.signum(),
            times,
        );
        assert!(worst < 2e-8, "{worst}");
    }

    #[test]
    fn without_friction_the_mass_swings_for_ever() {
        let free = RoughFloor {
            friction: 0.0,
            ..FLOOR
        };
        assert_eq!(free.half_periods(), None);
        assert!((free.at(40.0).0 + 1.1 * 200.0_f64.cos()).abs() < 1e-12);
    }

    #[test]
    fn the_belt_catches_the_mass_once_and_loses_it_where_the_spring_takes_all_friction() {
        let belt = Belt {
            mass: 2.0,
            stiffness: 50.0,
            friction: 10.0,
            velocity: 0.3,
        };
        let [caught, lost] = belt.sticks();
        assert!(caught > 0.0 && lost > caught);
        // position and velocity are continuous
        for t in [caught, lost] {
            let (before, after) = (belt.at(t - 1e-12), belt.at(t + 1e-12));
            assert!((before.0 - after.0).abs() < 1e-11 && (before.1 - after.1).abs() < 1e-10);
        }
        assert!((belt.force(lost - 1e-12) - 10.0).abs() < 1e-9);
        let times = || (0..500).map(|k| 0.01 * k as f64 + 0.005);
        for t in times() {
            // friction within its bound drives a mass that is never faster than the belt
            assert!(belt.force(t).abs() <= 10.0 && belt.at(t).1 <= 0.3 + 1e-15);
        }
        let away = times().filter(|t| (t - caught).abs() > 1e-3 && (t - lost).abs() > 1e-3);
        let worst = imbalance(
            |t| belt.at(t),
            |t, x, _| (belt.force(t) - 50.0 * x) / 2.0,
            away,
        );
        assert!(worst < 2e-8, "{worst}");
        let fast = Belt {
            velocity: 1.1,
            ..belt
        };
        assert_eq!(fast.sticks(), [f64::INFINITY; 2]);
        assert!((fast.at(1.0).0 - 0.2 * (1.0 - 5.0_f64.cos())).abs() < 1e-15);
    }
}
