//! Stages before and after a step, with the mass alone: those of the driver of the crates, of linear rows.

use carom_laws::Status;
use pyo3::prelude::*;

use super::MatrixRun;
use crate::errors::failed;

impl MatrixRun {
    fn normals(&self, points: &[usize]) -> Vec<u32> {
        let normal = |point: &usize| self.rows.normal(*point) as u32;
        points.iter().map(normal).collect()
    }

    /// Projects the predictor on the admissible displacements: `u* = u + dt v + w`, w = M⁻¹ Nᵀ R, `0 <= g(u*) ⟂ R >= 0`. The step finds 2 w/dt² where
    /// other schemes have the acceleration at its start.
    pub(super) fn project_predictor(&mut self) -> PyResult<()> {
        if !self.scheme.get().projects_predictor() {
            return Ok(());
        }
        let motion = &mut self.motion;
        motion.a.fill(0.0);
        let gaps = self.points.iter().enumerate().map(|(k, point)| {
            let way = self.dt * self.rows.along_normal(k, &motion.v);
            point.gap + self.rows.along_normal(k, &motion.u) + way
        });
        let gaps: Vec<f64> = gaps.collect();
        let mut points: Vec<usize> = Vec::new();
        loop {
            // what the projection so far leaves behind the surface
            let behind = |k: &usize| {
                gaps[*k] + self.rows.along_normal(*k, &self.motion.a) < 0.0 && !points.contains(k)
            };
            let more: Vec<usize> = (0..gaps.len()).filter(behind).collect();
            if more.is_empty() {
                break;
            }
            points.extend(more);
            points.sort_unstable();
            let rows = self.normals(&points);
            let values: Vec<f64> = points.iter().map(|point| gaps[*point]).collect();
            let Some(of_mass) = &mut self.of_mass else {
                break;
            };
            let solved = of_mass.complement(&rows, &values, &vec![0.0; rows.len()]);
            solved.map_err(|error| failed(&error))?;
            self.motion.a.fill(0.0);
            of_mass.spread_added(&rows, &mut self.motion.a);
        }
        let factor = 2.0 / (self.dt * self.dt);
        self.motion.a.iter_mut().for_each(|a| *a *= factor);
        Ok(())
    }

    /// Gives the velocity back, at the points that closed in the step, the work that their forces took. `before`: statuses at its start.
    pub(super) fn restore(&mut self, before: &[Status]) {
        if !self.scheme.get().restores_contact_work() {
            return;
        }
        let (mut points, mut rates, mut works) = (Vec::new(), Vec::new(), Vec::new());
        let [old, new] = [&self.motion, &self.room.next];
        for (k, point) in self.points.iter().enumerate() {
            if before[k] != Status::Open || point.last.status == Status::Open {
                continue;
            }
            let on = |vector: &[f64]| self.rows.along_normal(k, vector);
            let taken = -point.last.normal * (on(&new.u) - on(&old.u));
            if taken > 0.0 {
                points.push(k);
                rates.push(on(&new.v));
                works.push(taken);
            }
        }
        let rows = self.normals(&points);
        if let (Some(of_mass), false) = (&mut self.of_mass, rows.is_empty()) {
            of_mass.give_work(&rows, &rates, &works);
            of_mass.spread_added(&rows, &mut self.room.next.v);
        }
    }

    /// Projects velocity and acceleration on those that do not enter the surfaces, at the closed points of laws with projection, if one of them has
    /// closed in the step. `before`: statuses at its start.
    pub(super) fn project(&mut self, before: &[Status]) -> PyResult<()> {
        let started: Vec<f64> = self.points.iter().map(|point| point.carried).collect();
        for point in &mut self.points {
            point.carried = point.last.normal;
        }
        let given = self.points.iter().enumerate();
        let closed = given.filter(|(_, p)| p.law.projects() && p.last.status != Status::Open);
        let points: Vec<usize> = closed.map(|(k, _)| k).collect();
        if points.iter().all(|&k| before[k] != Status::Open) {
            return Ok(());
        }
        let rows = self.normals(&points);
        let Some(of_mass) = &mut self.of_mass else {
            return Ok(());
        };
        let next = &mut self.room.next;
        let weights = self.map.contact_impulse;
        let present = points.iter().map(|&k| {
            self.dt * (weights.old * started[k] + weights.new * self.points[k].last.normal)
        });
        let present: Vec<f64> = present.collect();
        let on = |vector: &[f64]| -> Vec<f64> {
            let along = |row: &u32| self.rows.along(*row as usize, vector);
            rows.iter().map(along).collect()
        };
        let solved = of_mass.complement(&rows, &on(&next.v), &present);
        solved.map_err(|error| failed(&error))?;
        of_mass.spread_added(&rows, &mut next.v);
        // points that the projection lets go have no acceleration to lose: their force ends with the step
        let mut values = on(&next.a);
        for (value, active) in values.iter_mut().zip(&of_mass.active) {
            if !active {
                *value = f64::INFINITY;
            }
        }
        let present: Vec<f64> = points.iter().map(|&k| self.points[k].last.normal).collect();
        let solved = of_mass.complement(&rows, &values, &present);
        solved.map_err(|error| failed(&error))?;
        of_mass.spread_added(&rows, &mut next.a);
        for (&k, added) in points.iter().zip(&of_mass.added) {
            self.points[k].carried += added;
        }
        Ok(())
    }
}
