//! The points of contacts between zones that may carry a force in an outer step: their rows by zone, and their mean rates.

use carom_dynamics::Driver;
use carom_dynamics::paired::{approaches, told};
use carom_dynamics::state::InterfaceState;
use carom_system::{LinkRow, System};

use super::geometry::{Geometry, RigidUnknowns};

/// Candidates with their rows, of each the normal and with friction its tangents after it.
#[derive(Default)]
pub(crate) struct Candidates {
    /// Their points, ascending.
    pub(crate) points: Vec<u32>,
    /// Tangents of a point; none without friction.
    pub(crate) tangents: usize,
    /// Whether they carried a force in the step before.
    pub(crate) lasting: Vec<bool>,
    /// Forces of the rows in this pass, N.
    pub(crate) forces: Vec<f64>,
    /// By row, the mean rate over the step that the forces of this pass leave, m/s.
    pub(crate) rates: Vec<f64>,
    /// Rows by zone: number and terms.
    pub(crate) rows: Vec<Vec<(u32, LinkRow)>>,
}

impl Candidates {
    pub(super) fn new(zones: usize) -> Candidates {
        Candidates {
            rows: vec![Vec::new(); zones],
            ..Candidates::default()
        }
    }

    /// Rows of a candidate.
    pub(crate) fn width(&self) -> usize {
        1 + self.tangents
    }

    /// Point and tangent of a row; none is the normal.
    pub(crate) fn of_row(&self, row: usize) -> (usize, Option<usize>) {
        let point = self.points[row / self.width()] as usize;
        (point, (row % self.width()).checked_sub(1))
    }

    /// Lists the candidates of an outer step of `dt` (s), with the forces of the state.
    pub(super) fn choose(
        &mut self,
        (system, geometry, rigid): (&System, &Geometry, &RigidUnknowns),
        state: &InterfaceState,
        dt: f64,
    ) {
        self.tangents = system.tangents();
        self.points.clear();
        let rows = &geometry.pairing.rows;
        for point in 0..system.points() {
            let law = &system.point(point).0.law;
            let captured = (rows.gap(point), rows.product(point, &geometry.start[1]));
            let tolerance = system.tolerance_at(point);
            let chosen = told(law, captured, dt, tolerance).unwrap_or_else(|| {
                let near = approaches(captured, dt, tolerance);
                near || state.force[point] != 0.0
            });
            if chosen {
                self.points.push(point as u32);
            }
        }
        self.lasting.clear();
        let carried = self.points.iter();
        let carried = carried.map(|&point| state.force[point as usize] != 0.0);
        self.lasting.extend(carried);
        self.let_rigid_begin(geometry, rigid);
        self.begin_rows(state);
        self.list_rows(geometry);
    }

    /// Lets all points of rigid bodies begin anew where one does: their rows depend on each other, and some that last and some that
    /// begin would contradict each other.
    fn let_rigid_begin(&mut self, geometry: &Geometry, rigid: &RigidUnknowns) {
        let points = self.points.iter();
        let own: Vec<bool> = points.map(|point| rigid.have(geometry, *point)).collect();
        let mut pairs = own.iter().zip(&self.lasting);
        if pairs.any(|(own, lasts)| *own && !lasts) {
            for (lasts, own) in self.lasting.iter_mut().zip(own) {
                *lasts &= !own;
            }
        }
    }

    /// Forces of the rows as they were.
    fn begin_rows(&mut self, state: &InterfaceState) {
        self.forces.clear();
        for &point in &self.points {
            let at = point as usize;
            self.forces.push(state.force[at]);
            let friction = state.friction.get(at).copied().unwrap_or_default();
            self.forces.extend(friction.iter().take(self.tangents));
        }
        self.rates.clear();
        self.rates.resize(self.forces.len(), 0.0);
    }

    /// The terms of the rows by zone.
    fn list_rows(&mut self, geometry: &Geometry) {
        self.rows.iter_mut().for_each(Vec::clear);
        let (width, tangents) = (self.width(), &geometry.pairing.tangents);
        for (k, &point) in self.points.iter().enumerate() {
            let normal = std::iter::once(&geometry.pairing.rows);
            let all = normal.chain(tangents.iter().take(self.tangents));
            for (number, rows) in (k * width..).zip(all) {
                let (unknowns, coefficients) = rows.row(point as usize);
                for (&unknown, &n) in unknowns.iter().zip(coefficients) {
                    let (zone, own) = geometry.homes[unknown as usize];
                    match self.rows[zone].last_mut() {
                        Some((row, terms)) if *row == number as u32 => terms.push((own, n)),
                        _ => self.rows[zone].push((number as u32, vec![(own, n)])),
                    }
                }
            }
        }
    }

    /// Adds what a step of a zone just completed has in the mean rates over the outer step of `dt` (s).
    pub(crate) fn look(&mut self, zone: usize, driver: &Driver, dt: f64) {
        for (row, terms) in &self.rows[zone] {
            self.rates[*row as usize] += driver.row_way(terms) / dt;
        }
    }
}
