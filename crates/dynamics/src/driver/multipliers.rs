//! Links in a step: multipliers of the rows between velocities, from the start of a run to the record of a step.

use std::sync::Arc;

use super::Driver;

impl Driver {
    /// What contact forces give by themselves keeps the rows of links by multipliers of its own, which are among the contact forces:
    /// takes them from the change of the others.
    pub(super) fn part_links(&mut self) {
        if self.attempt.vectors.push.is_empty() || !self.attempt.has_links() {
            return;
        }
        self.stages.spread(&self.contacts, &mut self.attempt);
        // schemes in which forces give accelerations by themselves stand alone
        let part = self.attempt.maps.contact() / self.attempt.maps.link_weights(0)[1];
        if let Some(stage) = self.stages.impulses() {
            let changes = self.links.pushed_mut().iter_mut();
            changes
                .zip(&stage.links)
                .for_each(|(change, l)| *change -= part * l);
        }
    }

    /// Multipliers and works of the links in the step that was taken.
    pub(super) fn record_links(&mut self) {
        if !self.attempt.has_links() {
            return;
        }
        let system = Arc::clone(&self.attempt.system);
        let start = self.links.rows_before(&self.attempt);
        let (old, next) = (&self.attempt.state.links, &mut self.attempt.next.links);
        next.multipliers.clear();
        next.multipliers.extend_from_slice(self.links.multipliers());
        next.mixed.clone_from(&old.mixed);
        next.works.clone_from(&old.works);
        let [before, after] = [&self.attempt.state.motion.u, &self.attempt.next.motion.u];
        let rates = [&self.attempt.state.motion.v, &self.attempt.next.motion.v];
        // in stages those of the links are kept as the momentum takes them
        let carry = match self.attempt.is_plain() {
            true => self.attempt.maps.first().impulse.carry,
            false => 0.0,
        };
        for zone in 0..system.schemes.len() {
            let (weights, of_work) = (
                self.attempt.maps.link_weights(zone),
                self.attempt.link_work_weights(zone),
            );
            let next = &mut self.attempt.next.links;
            let own = |i: usize| system.zone_at(i) == zone;
            for (link, (_, rows)) in system.links.named.iter().enumerate() {
                for row in rows.clone() {
                    let [l, mixed] = [old.multipliers[row], old.mixed[zone][row]];
                    let now = weights[0] * l + weights[1] * next.multipliers[row];
                    let mean = of_work.old * mixed + of_work.new * now;
                    // those of the rows at the start of the step, and at its end
                    let earlier = of_work.old * mixed + of_work.new * weights[0] * l;
                    let later = of_work.new * weights[1] * next.multipliers[row];
                    let (terms, inner) = (&self.links.rows()[row], system.links.inner_terms[row]);
                    let sides = [0..inner, inner..terms.len()];
                    for (work, side) in next.works[link].iter_mut().zip(sides) {
                        let side = side.filter(|&k| own(terms[k].0 as usize));
                        let way = |k: usize| {
                            let i = terms[k].0 as usize;
                            let lag = of_work.lag * (rates[1][i] - rates[0][i]);
                            after[i] - before[i] - lag
                        };
                        *work += match &start {
                            None => mean * side.map(|k| terms[k].1 * way(k)).sum::<f64>(),
                            Some(start) => side
                                .map(|k| (start[row][k].1 * earlier + terms[k].1 * later) * way(k))
                                .sum(),
                        };
                    }
                    next.mixed[zone][row] = match carry == 0.0 {
                        true => now,
                        false => now - carry * mixed,
                    };
                }
            }
        }
        // a projection after the step changes the forces that the next one begins with
        let next = &mut self.attempt.next.links;
        for (row, more) in self.stages.projected().links.iter().enumerate() {
            next.multipliers[row] += more;
            next.mixed.iter_mut().for_each(|mixed| mixed[row] += more);
        }
    }

    /// Multipliers of the rows of the links at the present instant, N per unit of the row.
    pub fn multipliers(&self) -> &[f64] {
        &self.attempt.state.links.multipliers
    }

    /// Name, number of rows, and works on the inner and the outer side since the start in J of each link.
    pub fn links(&self) -> impl Iterator<Item = (&str, usize, [f64; 2])> {
        let links = self
            .attempt
            .system
            .links
            .named
            .iter()
            .zip(&self.attempt.state.links.works);
        links.map(|((name, rows), work)| (name.as_str(), rows.len(), *work))
    }
}
