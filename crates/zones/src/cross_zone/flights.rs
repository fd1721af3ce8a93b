//! Points in flight: whether any may touch, and when the first one does.

use carom_dynamics::Driver;
use carom_dynamics::landing::{arrival, flies, lead};
use carom_dynamics::paired::approaches;
use carom_system::Adaptive;

use super::CrossZoneContacts;

impl CrossZoneContacts {
    /// Whether a point carries a force or may do so within `dt` (s), at twice its present rate.
    pub(crate) fn may_touch(&self, dt: f64) -> bool {
        let interface = &self.state.interface;
        let touches = |point: usize| {
            let ahead = (interface.gap[point], interface.rate[point]);
            interface.force[point] != 0.0 || approaches(ahead, dt, self.system.tolerance_at(point))
        };
        (0..self.system.points()).any(touches)
    }

    /// When the first of the points in flight is at its lead of outer steps of size `planned`, after the start of the attempt of
    /// `dt` just made (all s); infinite where none is. `largest`: the largest outer step, s.
    pub(crate) fn first_cut(
        &self,
        drivers: &[Driver],
        (rules, largest): (&Adaptive, f64),
        [dt, planned]: [f64; 2],
    ) -> f64 {
        let (interface, rows) = (&self.state.interface, &self.geometry.pairing.rows);
        let mut first = f64::INFINITY;
        for point in 0..self.system.points() {
            let (gap, flight) = (interface.gap[point], interface.flight[point]);
            let tolerance = self.system.tolerance_at(point);
            if !flies((gap, flight), tolerance, (rules, largest)) {
                continue;
            }
            let rate = rows.product(point, &self.geometry.start[1]);
            // without forces: of a candidate its own rate at the end, of others that of the motion
            let candidate = self.candidates.points.binary_search(&(point as u32)).ok();
            let free = candidate
                .and_then(|k| self.described.normal.get(k))
                .map_or_else(
                    || self.ended(drivers, point),
                    |candidate| candidate.rate_free,
                );
            let end = gap + 0.5 * dt * (rate + free);
            let contact = self.system.contact_of(point);
            let law = self.system.contacts[contact].law.get();
            let map = self.schemes[contact].get().step_map(planned);
            let arrival = arrival([gap, rate, end], dt, tolerance);
            let cut = arrival - lead(&map, planned, law);
            if cut >= rules.smallest {
                first = first.min(cut);
            }
        }
        first
    }

    /// Rate of a point at the end of the attempt, m/s.
    fn ended(&self, drivers: &[Driver], point: usize) -> f64 {
        let (unknowns, coefficients) = self.geometry.pairing.rows.row(point);
        let terms = unknowns.iter().zip(coefficients).map(|(&unknown, n)| {
            let (zone, own) = self.geometry.homes[unknown as usize];
            n * drivers[zone].ended().motion.v[own as usize]
        });
        terms.sum()
    }
}
