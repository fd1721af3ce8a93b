//! What a contact problem is told of one point, whoever states it.

use carom_laws::{Friction, Law, Local};

use crate::coulomb::Tangential;
use crate::interface::Candidate;
use crate::point_forces::PointForces;

/// A contact point before the forces of a step: its law, the start of the step, and what it carried last.
#[derive(Clone, Copy, Debug)]
pub struct ContactPoint {
    /// Its law.
    pub law: Law,
    /// Area that it stands for, m².
    pub area: f64,
    /// Its share of the contact; see [`Local::share`].
    pub share: f64,
    /// Gap that counts as none, m.
    pub tolerance: f64,
    /// Whether its surface faces itself.
    pub faces_itself: bool,
    /// Depth to which it is crushed for good, m.
    pub crush: f64,
    /// Gap where it is paired, m.
    pub gap: f64,
    /// Rate of the gap at the start of the step, m/s.
    pub rate: f64,
    /// Part of that rate that a law with restitution gives back.
    pub rebound: f64,
    /// Part of that rate that the way of the step has in it.
    pub in_way: f64,
    /// Time over which the point moves with the rate that its law constrains, s.
    pub dt: f64,
    /// Forces and statuses of the last step or iteration.
    pub last: PointForces,
}

impl ContactPoint {
    /// What its law knows. `gap_free`: g_f, the gap without forces, m.
    #[must_use]
    pub fn local(&self, gap_free: f64) -> Local {
        Local {
            area: self.area,
            share: self.share,
            gap: self.gap,
            rate: self.rebound * self.rate,
            start: self.in_way * self.rate,
            gap_free,
            dt: self.dt,
            tolerance: self.tolerance,
            crush: self.crush,
            at: [self.gap, self.rate],
        }
    }

    /// The candidate. `free`: gap (m) and rate (m/s) without forces; `instant`: see [`Candidate::instant`].
    #[must_use]
    pub fn candidate(&self, free: [f64; 2], instant: [f64; 2]) -> Candidate {
        Candidate {
            law: self.law,
            local: self.local(free[0]),
            rate_free: free[1],
            status: self.last.status,
            faces_itself: self.faces_itself,
            instant,
        }
    }

    /// What friction adds. `speed`: of sliding at the start of the step, m/s, which decides the coefficient of sliding; `free`: the
    /// sliding quantity without forces, m or m/s.
    #[must_use]
    pub fn tangential(&self, friction: &Friction, speed: f64, free: [f64; 2]) -> Tangential {
        let law = friction.get();
        let (mu, slides) = (law.sticks(), law.slides(speed));
        Tangential {
            mu,
            sliding: (slides < mu).then_some(slides),
            free,
            slip: self.last.slip,
            force: self.last.tangential,
            pressed: self.last.normal,
        }
    }
}
