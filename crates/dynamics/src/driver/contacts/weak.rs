//! The weak forms of the contacts of a step: what they add to the compliance, and their multipliers.

use carom_contact::law::Level;
use carom_contact::{Integration, Rows};
use carom_nonsmooth::Weak;
use carom_system::ContactPair;

use crate::error::Error;
use crate::system::System;

/// Part of 1 / (w r) that a Gauss point beside a held node is softer by. No force on such a node moves anything, so that the
/// multiplier there is redundant: of all that give the same motion this takes the least, to eight digits.
const SOFTENING: f64 = 1e-8;

/// The weak form of each contact that has one.
#[derive(Default)]
pub(crate) struct WeakForms {
    forms: Vec<Option<Form>>,
    /// Scratch.
    marks: Vec<[bool; 2]>,
}

struct Form {
    weak: Weak,
    level: Level,
    /// p at the nodes for the forces taken last, Pa; scratch behind.
    multiplier: Vec<f64>,
}

/// D over the candidates with the compliance of the weak forms added.
#[derive(Default)]
pub(crate) struct WithWeak {
    matrix: Vec<f64>,
    version: u64,
    /// Version of D, and the factors of D P in gap and rate.
    of: Option<(u64, [f64; 2])>,
}

impl WeakForms {
    pub(crate) fn new(system: &System) -> Result<WeakForms, Error> {
        let form = |contact: &ContactPair| {
            let Integration::Weak { r } = contact.integration else {
                return Ok(None);
            };
            let points = contact
                .points
                .iter()
                .map(|point| (point.carriers(), point.area));
            let weak = Weak::new(points, r).map_err(|cause| Error::WeakForm {
                contact: contact.name.clone(),
                cause,
            })?;
            Ok(Some(Form {
                weak,
                level: contact.law.get().level(),
                multiplier: Vec::new(),
            }))
        };
        Ok(WeakForms {
            forms: system
                .contacts
                .iter()
                .map(form)
                .collect::<Result<_, Error>>()?,
            marks: Vec::new(),
        })
    }

    /// Whether no contact has a weak form.
    pub(crate) fn none(&self) -> bool {
        self.forms.iter().all(Option::is_none)
    }

    /// Takes the multipliers of the forces of some points, in N once multiplied with `factor`.
    pub(crate) fn take(
        &mut self,
        system: &System,
        points: impl Iterator<Item = (usize, f64)> + Clone,
        factor: f64,
    ) {
        for (k, form) in self.forms.iter_mut().enumerate() {
            let Some(form) = form else { continue };
            let range = system.points_of(k);
            let of_contact = points
                .clone()
                .filter(|(point, _)| range.contains(point))
                .map(|(point, force)| (point - range.start, factor * force));
            form.weak.multiplier(of_contact, &mut form.multiplier);
        }
    }

    /// p / r at a point of the system, in m or m/s, for the multipliers taken last; 0 where there is none.
    pub(crate) fn pull(&self, system: &System, point: usize) -> f64 {
        if self.none() {
            return 0.0;
        }
        let contact = system.contact_of(point);
        self.forms[contact].as_ref().map_or(0.0, |form| {
            form.weak.pull(
                point - system.contacts[contact].range.start,
                &form.multiplier,
            )
        })
    }

    /// What the multipliers taken last, with the force of the point in N, add to the quantity that its law constrains,
    /// `(G P)_i / r`, and which of the two that is; nothing where there is no weak form.
    pub(crate) fn shift(&self, system: &System, point: usize, force: f64) -> Option<(f64, Level)> {
        let contact = system.contact_of(point);
        let form = self.forms[contact].as_ref()?;
        let place = point - system.contacts[contact].range.start;
        let own = form.weak.own_compliance(place) * force;
        Some((own - form.weak.pull(place, &form.multiplier), form.level))
    }

    /// Nodes of a contact whose supports are partly closed. `forces`: of all its points, N.
    pub(crate) fn mixed(&mut self, contact: usize, forces: &[f64]) -> usize {
        let marks = &mut self.marks;
        self.forms[contact]
            .as_ref()
            .map_or(0, |form| form.weak.mixed(forces, marks))
    }
}

impl WithWeak {
    /// The matrix D of this version over its candidates, with `G / (r s)` in the blocks of the weak forms, and a version that tells its changes.
    /// `factors`: s of laws in the gap and of laws in the rate.
    pub(crate) fn of<'a>(
        &'a mut self,
        weak: &WeakForms,
        system: &System,
        ((matrix, candidates, version), rows): ((&'a [f64], &[u32], u64), &Rows),
        factors: [f64; 2],
    ) -> (&'a [f64], u64) {
        if weak.none() {
            return (matrix, version);
        }
        let of = Some((version, factors));
        if self.of != of {
            self.of = of;
            self.version += 1;
            self.matrix.clear();
            self.matrix.extend_from_slice(matrix);
            for (contact, form) in weak.forms.iter().enumerate() {
                if let Some(form) = form {
                    self.add(contact, form, (system, rows), candidates, factors);
                }
            }
        }
        (&self.matrix, self.version)
    }

    fn add(
        &mut self,
        contact: usize,
        form: &Form,
        (system, rows): (&System, &Rows),
        candidates: &[u32],
        factors: [f64; 2],
    ) {
        let n = candidates.len();
        let factor = match form.level {
            Level::Gap => factors[0],
            Level::Rate | Level::GapAndRate => factors[1],
        };
        let range = &system.contacts[contact].range;
        let ends = [range.start, range.end]
            .map(|end| candidates.partition_point(|&point| (point as usize) < end));
        let place = |k: usize| candidates[k] as usize - range.start;
        for i in ends[0]..ends[1] {
            for j in ends[0]..=i {
                let entry = form.weak.compliance(place(i), place(j)) / factor;
                self.matrix[i * n + j] += entry;
                if i != j {
                    self.matrix[j * n + i] += entry;
                }
            }
            if beside_held(system, rows, candidates[i] as usize) {
                let own = form.weak.own_compliance(place(i)) / factor;
                self.matrix[i * n + i] += SOFTENING * own;
            }
        }
    }
}

/// Whether a point is carried by a node that supports hold along its normal.
fn beside_held(system: &System, rows: &Rows, point: usize) -> bool {
    let (contact, place) = system.point(point);
    let (dofs, _) = rows.row(point);
    contact.points[place].carriers().any(|(node, _)| {
        let mut of_node = dofs
            .iter()
            .filter(|dof| system.unknowns.node(**dof as usize) == node);
        of_node.all(|dof| system.fixed[*dof as usize])
    })
}
