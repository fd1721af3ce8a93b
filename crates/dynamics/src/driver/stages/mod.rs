//! Stages of a step with the mass alone: impulses of contact points, what a predictor and a projection change.

pub(crate) mod impulse;
mod predictor;
mod projection;
mod restoring;

use carom_system::ContactPair;

use crate::driver::attempt::Attempt;
use crate::driver::contacts::Contacts;
use crate::driver::paired::sums_compliances;
use crate::error::Error;
use crate::system::System;
use impulse::Impulses;

/// Stages of a step with the mass alone: impulses of contact points, what a predictor and a projection change.
pub(crate) struct Stages {
    /// Solver of the stages with the mass alone; none where there is no such stage.
    impulses: Option<Impulses>,
    projected: Projected,
    predictor: Predictor,
    restoring: Restoring,
}

impl Stages {
    /// Those of a system, which is `released` in the dynamics.
    ///
    /// # Errors
    /// A mass that is not positive definite.
    pub(crate) fn of(system: &System, released: &System) -> Result<Stages, Error> {
        let (scheme, points) = (system.scheme.get(), system.points());
        let map = scheme.step_map(system.dt);
        let projects = |contact: &ContactPair| contact.law.projects();
        let stages = scheme.projects_predictor()
            || scheme.restores_contact_work()
            || sums_compliances(system, &map)
            || map.uses_contact_acceleration() && !system.links.rows.is_empty();
        let staged = stages && points > 0 || system.contacts.iter().any(projects);
        Ok(Stages {
            impulses: match staged {
                true => Some(Impulses::new(released)?),
                false => None,
            },
            projected: Projected::new(points),
            predictor: Predictor::default(),
            restoring: Restoring::default(),
        })
    }

    /// Whether there is a stage with the mass alone.
    pub(crate) fn are_any(&self) -> bool {
        self.impulses.is_some()
    }

    /// Solver of the stages; none where there is no such stage.
    pub(crate) fn impulses(&self) -> Option<&Impulses> {
        self.impulses.as_ref()
    }

    /// The same, to solve with.
    pub(crate) fn impulses_mut(&mut self) -> Option<&mut Impulses> {
        self.impulses.as_mut()
    }

    /// What the impulses after the step did.
    pub(crate) fn projected(&self) -> &Projected {
        &self.projected
    }

    /// Begins a step after which no impulse was given yet.
    pub(crate) fn forget_projected(&mut self) {
        self.projected.clear();
    }

    /// Whether all candidates are one problem, whatever they share: where links, weak forms or the mass couple them besides.
    pub(crate) fn is_one_group(&self, contacts: &Contacts, attempt: &Attempt) -> bool {
        let sums =
            self.impulses.is_some() && sums_compliances(&attempt.system, attempt.maps.first());
        sums || attempt.has_links() || !contacts.weak().none()
    }

    /// Nᵀ P + Tᵀ t of the forces as they stand, into `contact`, and the acceleration that they give by themselves where the scheme
    /// uses it.
    pub(crate) fn spread(&mut self, contacts: &Contacts, attempt: &mut Attempt) {
        let f = &mut attempt.vectors.contact;
        f.fill(0.0);
        for point in contacts.active().within(0..attempt.system.points()) {
            let force = attempt.next.interface.force[point];
            if force != 0.0 {
                contacts.normal_rows().add_force(point, force, f);
            }
        }
        contacts.spread_friction(attempt);
        let (system, vectors) = (&*attempt.system, &mut attempt.vectors);
        let pushes = !vectors.push.is_empty();
        if let Some(stage) = self.impulses.as_mut().filter(|_| pushes) {
            stage.hold(system, &mut vectors.contact);
        }
        for (i, push) in vectors.push.iter_mut().enumerate() {
            *push = match system.fixed[i] {
                true => 0.0,
                false => vectors.contact[i] / system.mass.lumped[i],
            };
        }
    }

    /// Gap of a point at the end of the step without its forces, m.
    pub(crate) fn free_gap(&self, contacts: &Contacts, attempt: &Attempt, point: usize) -> f64 {
        if let Some(gap) = self.predictor.gap(point) {
            return gap;
        }
        contacts
            .free_gap(point)
            .unwrap_or(attempt.next.interface.gap[point])
    }
}

/// Points and forces of the stage.
#[derive(Default)]
struct Predictor {
    pub(crate) points: Vec<u32>,
    /// R of each point, kg m.
    pub(crate) forces: Vec<f64>,
    /// Gap of each contact point at u + dt v, m.
    pub(crate) gaps: Vec<f64>,
    pub(crate) values: Vec<f64>,
    pub(crate) present: Vec<f64>,
    /// The acceleration of the state before the step.
    pub(crate) kept: Vec<f64>,
}

impl Predictor {
    /// Gap of a contact point at u + dt v, m; `None` without this stage.
    pub(crate) fn gap(&self, point: usize) -> Option<f64> {
        self.gaps.get(point).copied()
    }
}

/// What the impulses after a step did, those of a projection or of another stage; one entry per contact point.
#[derive(Default)]
pub(crate) struct Projected {
    /// Impulse, N s.
    pub(crate) impulse: Vec<f64>,
    /// Work of the impulse, J.
    pub(crate) work: Vec<f64>,
    pub(crate) points: Vec<u32>,
    /// Quantity of each of the points that the impulses change.
    pub(crate) values: Vec<f64>,
    pub(crate) present: Vec<f64>,
    /// What the projection of the acceleration adds to the multipliers of links, N per unit of the rows; empty without.
    pub(crate) links: Vec<f64>,
}

impl Projected {
    pub(crate) fn new(points: usize) -> Projected {
        Projected {
            impulse: vec![0.0; points],
            work: vec![0.0; points],
            ..Projected::default()
        }
    }

    /// Forgets the step before.
    pub(crate) fn clear(&mut self) {
        self.points.clear();
        self.links.clear();
        self.impulse.fill(0.0);
        self.work.fill(0.0);
    }

    /// Impulse of a point, N s.
    pub(crate) fn impulse(&self, point: usize) -> f64 {
        self.impulse.get(point).copied().unwrap_or(0.0)
    }

    /// Work of that impulse, J.
    pub(crate) fn work(&self, point: usize) -> f64 {
        self.work.get(point).copied().unwrap_or(0.0)
    }
}

/// Work that the points which close take in the step.
#[derive(Default)]
struct Restoring {
    /// w of each point with an impulse, J.
    pub(crate) works: Vec<f64>,
}
