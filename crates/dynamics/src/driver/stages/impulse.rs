//! The mass alone: the stages of a step that change velocities, accelerations or a predictor by impulses of the contact
//! points. Links hold in what these change too: M⁻¹ (Nᵀ I + Cᵀ J), C M⁻¹ (Nᵀ I + Cᵀ J) = 0.

use carom_contact::Rows;
use carom_contact::law::Status;
use carom_nonsmooth::impulses_of_work;

use crate::compliance::Compliance;
use crate::driver::contacts::weak::{WeakForms, WithWeak};
use crate::driver::links::linking::{Linking, add_all_forces};
use crate::error::Error;
use crate::interface::{Candidate, Failure, Interface};
use crate::operator::Operators;
use crate::system::System;

/// Solver for `0 <= q + D ΔI ⟂ I + ΔI >= 0`, D = N M⁻¹ Nᵀ, with q a quantity of the points and I what acts on them
/// already. Then q + D ΔI is the quantity closest to the one without any I, in the norm of the mass, among those that are
/// not negative.
pub(crate) struct Impulses {
    mass: OfMass,
    /// J of the links in the last solve.
    pub(crate) links: Vec<f64>,
    with_weak: WithWeak,
    interface: Interface,
    candidates: Vec<Candidate>,
    half: Vec<f64>,
    summed: Vec<f64>,
    /// ΔI of each point of the last solve.
    pub(crate) added: Vec<f64>,
    /// Whether I + ΔI > 0 for each point of the last solve.
    pub(crate) active: Vec<bool>,
    /// M⁻¹ Nᵀ ΔI of the last solve.
    pub(crate) change: Vec<f64>,
}

/// The mass, the compliance of the points in it, and what the rows of links change; none without links.
struct OfMass {
    operators: Operators,
    compliance: Compliance,
    linking: Option<Linking>,
}

impl OfMass {
    /// D over some points (ascending) and its version.
    fn matrix(&mut self, system: &System, rows: &Rows, points: &[u32]) -> (&[f64], u64) {
        let (operators, compliance) = (&mut self.operators, &mut self.compliance);
        compliance.update((points, 1, true), rows, &system.fixed, operators);
        match &mut self.linking {
            Some(linking) => linking.compliance(system, (operators, compliance), rows),
            None => (compliance.matrix(), compliance.version),
        }
    }
}

impl Impulses {
    pub(crate) fn new(system: &System) -> Result<Impulses, Error> {
        let mut operators = Operators::new(system, 1.0, 0.0, "mass matrix")?;
        let linking = match system.links.rows.is_empty() {
            true => None,
            false => Some(Linking::of_mass(system, &mut operators)?),
        };
        Ok(Impulses {
            mass: OfMass {
                operators,
                linking,
                compliance: Compliance::new(
                    system.points() * (1 + system.tangents()),
                    system.rigid_points(),
                ),
            },
            links: vec![0.0; system.links.rows.len()],
            with_weak: WithWeak::default(),
            interface: Interface::default(),
            candidates: Vec::new(),
            half: vec![0.0; system.unknowns()],
            summed: Vec::new(),
            added: Vec::new(),
            active: Vec::new(),
            change: vec![0.0; system.unknowns()],
        })
    }

    /// `factor` D + `own.0` times the matrix `own.1` over the points (ascending), row-major; `None` for no point.
    pub(crate) fn sum(
        &mut self,
        system: &System,
        rows: &Rows,
        points: &[u32],
        own: (f64, &[f64]),
        factor: f64,
    ) -> Option<&[f64]> {
        let (d, _) = self.mass.matrix(system, rows, points);
        self.summed.clear();
        let pairs = d.iter().zip(own.1);
        self.summed
            .extend(pairs.map(|(d, other)| factor * d + own.0 * other));
        (!points.is_empty()).then_some(&self.summed[..])
    }

    /// The impulses I > 0 of the points (ascending) with `I_i (r_i + ½ (D I)_i) = w_i`. `rates`: r of each; `works`: w of
    /// each, positive.
    pub(super) fn give_work(
        &mut self,
        system: &System,
        rows: &Rows,
        points: &[u32],
        rates: &[f64],
        works: &[f64],
    ) {
        let (d, _) = self.mass.matrix(system, rows, points);
        impulses_of_work(d, rates, works, &mut self.added);
        self.spread(system, points);
    }

    /// Solves for the points (ascending). `weak`: weak forms, and impulse over force. `values`: q of each; infinite where
    /// I + ΔI must vanish. `present`: I of each.
    pub(crate) fn solve(
        &mut self,
        system: &System,
        weak: (&WeakForms, f64),
        rows: &Rows,
        points: &[u32],
        values: &[f64],
        present: &[f64],
    ) -> Result<(), Failure> {
        let n = points.len();
        let (matrix, version) = self.mass.matrix(system, rows, points);
        let of = (matrix, points, version);
        let compliance = self.with_weak.of(weak.0, system, (of, rows), [weak.1; 2]);
        let d = compliance.0;
        self.candidates.clear();
        for (i, value) in values.iter().enumerate() {
            let row = &d[i * n..(i + 1) * n];
            self.candidates.push(Candidate {
                faces_itself: system.point(points[i] as usize).0.has_both_sides(),
                ..Candidate::beside(*value, row, present)
            });
        }
        let problem = (carom_nonsmooth::Compliance::Dense(d), compliance.1);
        self.interface
            .solve(&self.candidates, problem, [1.0, 0.0])?;
        self.added.clear();
        self.active.clear();
        for (k, present) in present.iter().enumerate() {
            self.added.push(self.interface.forces[k] - present);
            self.active.push(self.interface.statuses[k] != Status::Open);
        }
        self.spread(system, points);
        Ok(())
    }

    /// Adds to nodal forces (N) those of links that keep the rows in the acceleration which they give by themselves.
    pub(crate) fn hold(&mut self, system: &System, forces: &mut [f64]) {
        if let Some(linking) = &mut self.mass.linking {
            let multipliers = (&*forces, &mut self.links[..]);
            linking.balance(system, &mut self.mass.operators, multipliers);
            add_all_forces(system, &self.links, forces);
        }
    }

    /// The change that the added impulses make.
    fn spread(&mut self, system: &System, points: &[u32]) {
        self.half.fill(0.0);
        let OfMass {
            operators,
            compliance,
            linking,
        } = &mut self.mass;
        let added = points.iter().copied().zip(self.added.iter().copied());
        for (point, added) in added.clone() {
            compliance.add(point, added, operators, &mut self.half);
        }
        if let Some(linking) = linking {
            self.links.fill(0.0);
            let begun = (&mut self.half[..], &mut self.links[..]);
            linking.answer(system, operators, added, begun);
        }
        operators.end(&mut self.half, &mut self.change);
    }
}
