//! Motions under Coulomb friction in closed form: a block on an incline, a spring-mass on a rough floor, and one on a belt.
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
        let alternate = if n % 2 == 0 { 1.0 } else { -1.0 };
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

/// A mass on a spring that lies on a belt of constant velocity V > 0, in its steady motion.
///
/// With equal static and kinetic friction the belt carries the mass until the spring takes all friction, x = δ = μ N/k,
/// which it leaves with velocity V. Relative to the belt it does not go back there: it would slide forward only for v > V,
/// and the cosine about δ that starts with v = V at x = δ is slower than V everywhere else,
/// ```text
/// stick   x = x0 + V t,                      until x = δ
/// slip    x = δ + (V/ω) sin ω(t - t1),       v = V cos ω(t - t1) <= V
/// ```
/// After one period 2π/ω the mass has v = V at x = δ again, where it may stick but at once slips on. So the
/// stick-slip is a transient: one stick phase, and then the largest oscillation without another. The mass touches the
/// belt's velocity once per period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Belt {
    /// m in kg.
    pub mass: f64,
    /// k in N/m.
    pub stiffness: f64,
    /// μ N, N: largest friction force.
    pub friction: f64,
    /// V in m/s, more than zero.
    pub velocity: f64,
    /// Position at t = 0, where the mass lies on the belt with its velocity; not beyond -δ or δ, m.
    pub start: f64,
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

    /// t1 in s, at which the mass begins to slip: `(δ - x0)/V`.
    pub fn slip_time(&self) -> f64 {
        (self.shift() - self.start) / self.velocity
    }

    /// Position in m and velocity in m/s at the time `t` >= 0 in s.
    pub fn at(&self, t: f64) -> (f64, f64) {
        let since = t - self.slip_time();
        if since <= 0.0 {
            return (self.start + self.velocity * t, self.velocity);
        }
        let (omega, v) = (self.frequency(), self.velocity);
        let (sin, cos) = (omega * since).sin_cos();
        (self.shift() + v / omega * sin, v * cos)
    }

    /// Friction force of the belt on the mass at the time `t` >= 0, N: `k x` while it sticks, since its acceleration is
    /// zero, and μ N while it slips.
    pub fn force(&self, t: f64) -> f64 {
        if t <= self.slip_time() {
            self.stiffness * self.at(t).0
        } else {
            self.friction
        }
    }
}
