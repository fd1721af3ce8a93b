//! A time scheme as a table of numbers: how everything in a step depends on its one unknown x.

/// The vectors at the start of a step, one entry per unknown.
#[derive(Clone, Copy, Debug)]
pub struct Known<'a> {
    /// Displacement, m.
    pub u: &'a [f64],
    /// Velocity, m/s.
    pub v: &'a [f64],
    /// Acceleration, m/s².
    pub a: &'a [f64],
    /// What the scheme remembers besides; empty for most.
    pub memory: &'a [f64],
}

/// Coefficients of one vector of the step, `u` u_k + `v` v_k + `a` a_k + `m` m_k + `x` x + `c` c, with m what the scheme
/// remembers besides and c = M⁻¹ Nᵀ P the acceleration that the contact forces of the step give by themselves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Row {
    /// Factor of the displacement at the start.
    pub u: f64,
    /// Factor of the velocity at the start.
    pub v: f64,
    /// Factor of the acceleration at the start.
    pub a: f64,
    /// Factor of the memory; zero for most schemes, which then have none.
    pub m: f64,
    /// Factor of the unknown.
    pub x: f64,
    /// Factor of the contact acceleration c; zero for most schemes, which then never compute c.
    pub c: f64,
}

impl<'a> Known<'a> {
    /// The same of a range of the unknowns.
    pub fn within(&self, range: std::ops::Range<usize>) -> Known<'a> {
        Known {
            u: &self.u[range.clone()],
            v: &self.v[range.clone()],
            a: &self.a[range.clone()],
            memory: match self.memory.is_empty() {
                true => self.memory,
                false => &self.memory[range],
            },
        }
    }
}

impl Row {
    /// The displacement at the start, alone.
    pub const START: Row = Row {
        u: 1.0,
        ..Row::NONE
    };

    /// The velocity at the start, alone.
    pub const MOVING: Row = Row {
        v: 1.0,
        ..Row::NONE
    };

    /// The unknown alone.
    pub const UNKNOWN: Row = Row {
        x: 1.0,
        ..Row::NONE
    };

    const NONE: Row = Row {
        u: 0.0,
        v: 0.0,
        a: 0.0,
        m: 0.0,
        x: 0.0,
        c: 0.0,
    };

    /// The same combination of an unknown that is this many times as large.
    fn over(self, factor: f64) -> Row {
        Row {
            x: self.x / factor,
            ..self
        }
    }

    /// The change from another combination to this one.
    pub fn since(&self, other: &Row) -> Row {
        Row {
            u: self.u - other.u,
            v: self.v - other.v,
            a: self.a - other.a,
            m: self.m - other.m,
            x: self.x - other.x,
            c: self.c - other.c,
        }
    }

    /// This combination, and a part of the change to another one.
    pub fn towards(&self, other: &Row, part: f64) -> Row {
        let change = other.since(self);
        Row {
            u: self.u + part * change.u,
            v: self.v + part * change.v,
            a: self.a + part * change.a,
            m: self.m + part * change.m,
            x: self.x + part * change.x,
            c: self.c + part * change.c,
        }
    }

    /// Writes the combination of the known vectors, x and c left out.
    pub fn known<'a>(&self, start: impl Into<Known<'a>>, out: &mut [f64]) {
        let Known { u, v, a, memory } = start.into();
        let n = out.len();
        // of equal length, so that the loop is without checks
        let (u, v, a) = (&u[..n], &v[..n], &a[..n]);
        for i in 0..n {
            out[i] = self.u * u[i] + self.v * v[i] + self.a * a[i];
        }
        Row::add(self.m, memory, out);
    }

    /// Writes the whole combination.
    pub fn whole<'a>(&self, start: impl Into<Known<'a>>, x: &[f64], c: &[f64], out: &mut [f64]) {
        let Known { u, v, a, memory } = start.into();
        let n = out.len();
        let (u, v, a, x) = (&u[..n], &v[..n], &a[..n], &x[..n]);
        for i in 0..n {
            out[i] = self.u * u[i] + self.v * v[i] + self.a * a[i] + self.x * x[i];
        }
        Row::add(self.m, memory, out);
        Row::add(self.c, c, out);
    }

    /// Adds a vector that most schemes do not have.
    fn add(factor: f64, vector: &[f64], out: &mut [f64]) {
        if factor != 0.0 {
            for i in 0..out.len() {
                out[i] += factor * vector[i];
            }
        }
    }
}

/// How the momentum changes over a step. With G the sum of the nodal forces of a kind in the balance of the step,
/// `R_{k+1} = gain G - carry R_k` and `Δ(M v) = dt (old R_k + new R_{k+1})`. Where the balance holds at one instant, R is
/// the force itself: gain 1, carry 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulse {
    /// Weight of R at the start.
    pub old: f64,
    /// Weight of R of the step.
    pub new: f64,
    /// Factor of the forces in R.
    pub gain: f64,
    /// Factor of the R before.
    pub carry: f64,
}

impl Impulse {
    /// Weights of forces that enter the balance at one instant.
    pub fn weights(old: f64, new: f64) -> Impulse {
        Impulse {
            old,
            new,
            gain: 1.0,
            carry: 0.0,
        }
    }

    /// Weight of R at the start in the change of the momentum, the forces of the step left out: `old - new carry`.
    pub fn of_start(&self) -> f64 {
        self.old - self.new * self.carry
    }

    /// What R at the start of a step gives to the momentum, in it and, by its return in the R to come, in steps of the same length
    /// after it, over dt.
    pub fn later(&self) -> f64 {
        self.of_start() / (1.0 + self.carry)
    }
}

/// One step of a scheme: momentum balance `M inertia + f(force) = p_ext + contact Nᵀ P`, end values and contact quantities.
///
/// The effective matrix is `A = inertia.x M + force.x K`; A and the residual are in N when x is an acceleration, and in
/// N per unit of x otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepMap {
    /// The acceleration that enters the momentum balance.
    pub inertia: Row,
    /// The displacement at which internal forces are taken.
    pub force: Row,
    /// The same displacement as a fraction of the way from u_k to u_{k+1}; `None` where it is not on that way: internal
    /// forces are then taken there once more for the forces of the supports.
    pub force_fraction: Option<f64>,
    /// Displacement at the end of the step.
    pub displacement: Row,
    /// Velocity at the end of the step.
    pub velocity: Row,
    /// Acceleration at the end of the step.
    pub acceleration: Row,
    /// The newest displacement known before x: the configuration from which contact is looked ahead.
    pub placed: Row,
    /// The displacement that a contact law in the gap constrains: that of the end of the step in most schemes. Without c.
    pub gap: Row,
    /// The velocity that a contact law in the rate constrains.
    pub rate: Row,
    /// Length of the step in which the points move with that rate, s: this one, or with an explicit scheme the next.
    pub moves: f64,
    /// Memory at the end of the step; all zero for most schemes, which have none.
    pub memory: Row,
    /// Factor of the contact forces in the momentum balance; 1 for most schemes.
    pub contact: f64,
    /// How loads and supports change the momentum over the step.
    pub impulse: Impulse,
    /// How contact forces change it.
    pub contact_impulse: Impulse,
}

impl StepMap {
    /// The map of a static step: the unknown is the way, internal forces are those of its end, and there is no inertia.
    pub fn equilibrium() -> StepMap {
        let (none, now) = (
            Row::default(),
            Row {
                u: 1.0,
                ..Row::default()
            },
        );
        let end = Row { x: 1.0, ..now };
        StepMap {
            inertia: none,
            force: end,
            force_fraction: Some(1.0),
            displacement: end,
            velocity: none,
            acceleration: none,
            placed: now,
            gap: end,
            rate: none,
            moves: 0.0,
            memory: none,
            contact: 1.0,
            impulse: Impulse::weights(0.0, 1.0),
            contact_impulse: Impulse::weights(0.0, 1.0),
        }
    }

    /// The same step with another unknown: what contact forces change in the rate that laws constrain, in m/s, so that the unknowns of two schemes
    /// may stand in one row. `None` where that rate does not depend on the unknown.
    pub fn by_rate(&self) -> Option<StepMap> {
        let x = self.rate.x;
        (x != 0.0).then(|| StepMap {
            inertia: self.inertia.over(x),
            force: self.force.over(x),
            displacement: self.displacement.over(x),
            velocity: self.velocity.over(x),
            acceleration: self.acceleration.over(x),
            gap: self.gap.over(x),
            rate: self.rate.over(x),
            memory: self.memory.over(x),
            ..*self
        })
    }

    /// Time after the start of a step of length `dt` at which the balance of the step holds, s: that at which a steady motion
    /// is where internal forces are taken.
    pub fn instant(&self, dt: f64) -> f64 {
        match self.force_fraction {
            Some(part) => part * dt,
            None => self.steady_force(),
        }
    }

    /// Time at which a body in steady motion, whose memories are velocities, is where internal forces are taken, s.
    fn steady_force(&self) -> f64 {
        self.force.v + self.force.m - self.force.x * self.inertia.v / self.inertia.x
    }

    /// Gap and rate that a law with a compliance holds for: those of the instant at which internal forces and dampers enter the
    /// balance, so that such a contact is a spring beside the others, and a stop that dissipates nothing gives back what it
    /// got. Exact laws bind the gap or the rate of the end instead ([`StepMap::gap`], [`StepMap::rate`]). The same where the
    /// forces at the end are what the scheme balances, and in explicit steps.
    pub fn compliant(&self) -> [Row; 2] {
        if self.force.x == 0.0 {
            return [self.gap, self.rate];
        }
        match self.force_fraction {
            Some(1.0) => [self.gap, self.rate],
            Some(part) => [
                Row::START.towards(&self.displacement, part),
                Row::MOVING.towards(&self.velocity, part),
            ],
            None => [self.force, self.rate],
        }
    }

    /// The factors of x in [`StepMap::compliant`] over those in gap and rate.
    pub fn compliant_factors(&self) -> [f64; 2] {
        let [gap, rate] = self.compliant();
        let over = |part: f64, all: f64| if all == 0.0 { 1.0 } else { part / all };
        [over(gap.x, self.gap.x), over(rate.x, self.rate.x)]
    }

    /// Whether the momentum balance holds between acceleration and forces of the end of the step, whose weights in the
    /// impulse are those of the forces themselves.
    pub fn balances_at_the_end(&self) -> bool {
        let forces_stand = |impulse: &Impulse| impulse.gain == 1.0 && impulse.carry == 0.0;
        self.inertia == self.acceleration
            && self.force == self.displacement
            && self.force.x != 0.0
            && self.acceleration.x == 1.0
            && self.contact == 1.0
            && forces_stand(&self.impulse)
            && forces_stand(&self.contact_impulse)
    }

    /// What the velocity at the start adds to the rate that laws constrain, as a factor, in the way of the step: u₊ - u is a
    /// positive multiple of `rate + start_in_way v`. Zero where it is no such sum.
    pub fn start_in_way(&self) -> f64 {
        let way = self.displacement.since(&Row::START);
        let of_velocities = |row: &Row| row.x > 0.0 && [row.u, row.a, row.m, row.c] == [0.0; 4];
        match [way, self.rate].iter().all(of_velocities) {
            true => way.v * self.rate.x / way.x - self.rate.v,
            false => 0.0,
        }
    }

    /// Whether the state has a memory.
    pub fn has_memory(&self) -> bool {
        self.memory != Row::default()
    }

    /// Whether any vector of the step needs the contact acceleration.
    pub fn uses_contact_acceleration(&self) -> bool {
        let rows = [
            self.displacement,
            self.velocity,
            self.acceleration,
            self.rate,
        ];
        rows.iter().any(|row| row.c != 0.0)
    }
}

#[cfg(test)]
mod tests {
    use crate::Scheme;

    #[test]
    fn forces_are_taken_where_a_steady_motion_is_at_their_instant() {
        let dt = 0.3;
        for scheme in Scheme::registered() {
            for (length, map) in scheme.stage_maps(dt) {
                let difference = map.instant(length) - map.steady_force();
                assert!(difference.abs() < 1e-15, "{scheme:?}: {difference}");
            }
        }
        let instant = |scheme: Scheme| scheme.get().step_map(dt).instant(dt);
        assert!((instant(Scheme::Krenk(crate::Krenk { rho_inf: 0.8 })) - 0.5 * dt).abs() < 1e-15);
        let two_step = crate::PaoliSchatzman { restitution: 0.5 };
        assert!(instant(Scheme::PaoliSchatzman(two_step)).abs() < 1e-15);
    }
}
