//! The static stage of the whole, and the passage to the dynamics of the zones.

use carom_dynamics::Driver;
use carom_dynamics::state::State;

use super::Whole;
use super::gathered::{add_forces, forces_mut, take_motion, take_points};
use crate::error::Error;
use crate::places::Places;
use crate::stage::{Stage, StageEnd};

impl Whole {
    /// State and report from those of the static stage, which goes on.
    pub(super) fn gather_stage(&mut self, stage: Box<Stage>) {
        let state = stage.driver.state();
        (self.state.step, self.state.time) = (state.step, state.time);
        self.state.control = state.control;
        let whole = &mut self.state.motion;
        for force in forces_mut(whole) {
            force.fill(0.0);
        }
        take_motion(whole, (&state.motion, &stage.places));
        add_forces(whole, (&state.motion, &stage.places));
        take_points(&mut self.state.interface, (&state.interface, &stage.places));
        self.state
            .records
            .contacts
            .clone_from(&state.records.contacts);
        let ledger = &state.ledger;
        let left = [ledger.tolerated, ledger.rounding];
        self.state
            .ledger
            .gather(ledger.initial, ledger.balance, left);
        self.report.clone_from(stage.driver.report());
        self.stage.0 = Some(stage);
    }

    /// Begins the dynamics where the static stage has ended.
    pub(super) fn leave_stage(&mut self, mut stage: Stage) -> Result<(), Error> {
        let contacts = &self.zones.contacts;
        let zones = self.places.iter().zip(contacts).zip(&self.zones.drivers);
        let mut states = Vec::new();
        for ((places, contacts), driver) in zones {
            let mut pushed = vec![0.0; self.system.unknowns()];
            let forces = stage
                .driver
                .forces_of_contacts(|one| contacts.contains(&one));
            for &(from, to) in &stage.places.unknowns {
                pushed[to as usize] = forces[from as usize];
            }
            states.push(self.state_of_zone((driver, places), (contacts, &pushed)));
        }
        let between = self.zones.between();
        let between = between.into_iter().flat_map(|(contacts, _)| contacts);
        let between = between.flat_map(|&contact| self.system.points_of(contact));
        let end = StageEnd {
            whole: &self.state,
            between: between.collect(),
            zones: states,
        };
        self.zones.begin_dynamics(&end)?;
        self.state.records.begin_dynamics();
        self.gather_assemblies();
        self.stage.1 = stage.driver.costs();
        Ok(())
    }

    /// What a zone begins the dynamics with; `pushed`: forces of its contacts on the unknowns of the whole, N.
    fn state_of_zone(
        &self,
        (driver, places): (&Driver, &Places),
        (contacts, pushed): (&[usize], &[f64]),
    ) -> State {
        let mut state = driver.state().clone();
        (state.step, state.time) = (self.state.step, self.state.time);
        let (own, whole) = (&mut state.motion, &self.state.motion);
        for &(to, from) in &places.unknowns {
            own.u[to as usize] = whole.u[from as usize];
            own.contact_force[to as usize] = pushed[from as usize];
        }
        for &(to, from) in &places.frames {
            own.frames[to] = whole.frames[from];
        }
        for (to, from) in &places.histories {
            own.history[to.clone()].copy_from_slice(&whole.history[from.clone()]);
        }
        if !self.state.interface.friction.is_empty() && driver.system().tangents() > 0 {
            let points = driver.system().points();
            state.interface.friction.resize(points, [0.0; 2]);
        }
        for &(to, from) in &places.points {
            let point = (&self.state.interface, from as usize);
            state.interface.take_point(to as usize, point);
        }
        for (record, &contact) in state.records.contacts.iter_mut().zip(contacts) {
            record.clone_from(&self.state.records.contacts[contact]);
        }
        state
    }
}
