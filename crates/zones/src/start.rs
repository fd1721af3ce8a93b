//! The start of zones: rows, the factor of H, velocities that agree, the first multipliers.

use std::sync::Arc;
use std::time::Duration;

use carom_algebra::dense::DenseCholesky;

use crate::cross_zone::CrossZoneContacts;
use crate::error::Error;
use crate::joined::{answer, hold_empty_rows};
use crate::link_solver::OuterResponse;
use crate::model::Zoned;
use crate::moves::Moves;
use crate::stage::StageEnd;
use crate::step::changes_state;
use crate::turning::{ByZone, TurningLinks};
use crate::zones::{LinkResponse, OuterSteps, ZoneLinks, Zones};
use carom_dynamics::condensed::{Answer, Condensed, DENSE, Joined};
use carom_dynamics::linearised::Origin;
use carom_dynamics::operator::Operators;
use carom_dynamics::{Control, Driver};
use carom_system::{LinkRow, System, on};

impl Zones {
    /// Builds the zones, makes and factors H, and starts them: initial velocities become the closest ones, in the norm of the
    /// mass, that satisfy the rows, and the first multipliers those that keep the accelerations in them.
    ///
    /// # Errors
    /// A zone that cannot be built, redundant rows, schemes or steps that do not go together.
    pub fn new(zoned: &Zoned) -> Result<Zones, Error> {
        zoned.check()?;
        zoned.check_across()?;
        let systems = zoned.systems()?;
        let contacts = zoned.contacts();
        let links = zoned.row_ranges();
        let count = links.last().map_or(0, |(_, range)| range.end);
        let mut rows = zoned.rows(&systems)?;
        let mut turning = TurningLinks::new(zoned, &systems, &mut rows)?;
        let mut norms = vec![0.0; count];
        for (row, terms) in rows.iter().flatten() {
            norms[*row as usize] += terms.iter().map(|(_, c)| c.abs()).sum::<f64>();
        }
        let mut drivers = systems
            .iter()
            .map(|system| Driver::of_zone(Arc::clone(system)))
            .collect::<Result<Vec<_>, carom_dynamics::Error>>()?;
        let between = CrossZoneContacts::new(zoned, &drivers)?;
        if between.is_some() {
            make_room(&mut drivers, &systems)?;
        }
        let links_of = (&mut rows, &mut turning, count);
        let multipliers = start(&mut drivers, links_of, &mut |driver, zone, begun| {
            driver.link(&begun.force);
            driver.restart(&systems[zone].initial.displacement, begun.velocity)
        })?;
        let substeps: Vec<u32> = zoned.zones.iter().map(|zone| zone.substeps).collect();
        let far = zoned.zones.iter();
        let far = far.map(|zone| zone.far.unwrap_or(zone.substeps));
        let far: Vec<u32> = far.collect();
        let most = |(near, far): (&u32, &u32)| *near.max(far);
        let most: Vec<u32> = substeps.iter().zip(&far).map(most).collect();
        let zones = drivers.iter().enumerate();
        let saved = zones.map(|(zone, driver)| {
            changes_state((&most, &between), zone).then(|| driver.state().clone())
        });
        let saved = saved.collect();
        let (dt, zero) = (zoned.model.dt, || vec![0.0; count]);
        let mut zones = Zones {
            response: LinkResponse {
                solver: None,
                origins: drivers.iter().map(Origin::of).collect(),
                stale: false,
                outer: OuterResponse::None,
                kept: Vec::new(),
                passes: 0,
                all_passes: 0,
                products: [0; 2],
                link_time: Duration::ZERO,
            },
            clock: OuterSteps {
                choices: [substeps.clone(), far],
                substeps,
                rules: zoned.model.adaptive,
                largest: dt,
                control: Control::start(dt),
                attempts: 0,
                first_cut: f64::INFINITY,
                dt,
                next: dt,
                sizes: [dt; 2],
                step: 0,
                time: 0.0,
                forced: None,
            },
            links: ZoneLinks {
                named: links,
                kind: zoned.kind,
                rows,
                turning,
                norms,
                earlier: [multipliers.clone(), multipliers.clone()],
                multipliers: [multipliers.clone(), multipliers],
                mixes: Vec::new(),
                works: [Vec::new(), Vec::new()],
                free: [zero(), zero()],
                pointwise: [zero(), zero()],
                defect: zero(),
                worst: 0.0,
                worst_row: 0,
                moves: Moves::default(),
            },
            between,
            saved,
            drivers,
            contacts,
            samples: Vec::new(),
        };
        zones.start_works();
        zones.factorise()?;
        if let Some(between) = &mut zones.between {
            between.restart(&zones.drivers);
        }
        Ok(zones)
    }

    /// No work yet; Λ before the first step is L₀.
    fn start_works(&mut self) {
        let first = &self.links.multipliers[0];
        let force = |rows: &Vec<(u32, LinkRow)>| match self.links.turning {
            None => first.clone(),
            Some(_) => {
                let terms = |(row, terms): &(u32, LinkRow)| {
                    let l = first[*row as usize];
                    terms.iter().map(move |(_, c)| c * l).collect::<Vec<_>>()
                };
                rows.iter().flat_map(terms).collect()
            }
        };
        let mixes = |rows| [force(rows), force(rows), force(rows)];
        self.links.mixes = self.links.rows.iter().map(mixes).collect();
        self.links.works = [
            vec![0.0; self.links.named.len()],
            vec![0.0; self.links.named.len()],
        ];
    }

    /// Begins anew from other initial motions: displacement (m) and velocity (m/s) of each zone, one entry per unknown.
    ///
    /// # Errors
    /// As [`Zones::new`].
    pub fn restart(&mut self, motions: &[[Vec<f64>; 2]]) -> Result<(), Error> {
        for (driver, [u, v]) in self.drivers.iter_mut().zip(motions) {
            match self.between {
                Some(_) => driver.link(&vec![0.0; u.len()]),
                None => driver.unlink(),
            }
            driver.restart(u, v)?;
        }
        let links = (
            &mut self.links.rows,
            &mut self.links.turning,
            self.links.norms.len(),
        );
        let multipliers = start(&mut self.drivers, links, &mut |driver, zone, begun| {
            driver.link(&begun.force);
            driver.restart(&motions[zone][0], begun.velocity)
        })?;
        self.begin_at((0, 0.0), multipliers);
        if let Some(between) = &mut self.between {
            between.restart(&self.drivers);
        }
        Ok(())
    }

    /// Begins the dynamics at the end of a static stage.
    ///
    /// # Errors
    /// As [`Zones::new`].
    pub(crate) fn begin_dynamics(&mut self, end: &StageEnd) -> Result<(), Error> {
        let still = |driver: &Driver| vec![0.0; driver.system().unknowns()];
        for (driver, state) in self.drivers.iter_mut().zip(&end.zones) {
            let velocity = driver.system().initial.velocity.clone();
            driver.begin_dynamics(state, &velocity, still(driver))?;
        }
        let mut pushed: Vec<Vec<f64>> = self.drivers.iter().map(still).collect();
        if let Some(between) = &mut self.between {
            between.begin_dynamics(&self.drivers, end);
            for (zone, (driver, pushed)) in self.drivers.iter_mut().zip(&mut pushed).enumerate() {
                between.spread(zone, pushed);
                let velocity = driver.system().initial.velocity.clone();
                driver.begin_dynamics(&end.zones[zone], &velocity, pushed.clone())?;
            }
        }
        let links = (
            &mut self.links.rows,
            &mut self.links.turning,
            self.links.norms.len(),
        );
        let multipliers = start(&mut self.drivers, links, &mut |driver, zone, begun| {
            let own = begun.force.iter().zip(&pushed[zone]);
            let force = own.map(|(own, pushed)| own + pushed).collect();
            driver.begin_dynamics(&end.zones[zone], begun.velocity, force)
        })?;
        let (step, time) = (end.whole.step, end.whole.time);
        self.begin_at((step, time), multipliers);
        self.clock.control = Control::after_stage(self.clock.largest, step, time);
        Ok(())
    }

    /// Begins the steps from one at a time (s), with these multipliers.
    fn begin_at(&mut self, (step, time): (u64, f64), multipliers: Vec<f64>) {
        if let Some(links) = &mut self.links.turning {
            links.restart();
        }
        (self.clock.step, self.clock.time) = (step, time);
        self.clock.control = Control::start(self.clock.largest);
        self.clock.sizes = [self.clock.largest; 2];
        self.links.earlier = [multipliers.clone(), multipliers.clone()];
        self.links.multipliers = [multipliers.clone(), multipliers];
        self.start_works();
        let origins: Vec<Origin> = self.drivers.iter().map(Origin::of).collect();
        if origins != self.response.origins {
            self.start_from(origins);
        }
    }
}

/// Starts the drivers with room for forces from other zones.
fn make_room(drivers: &mut [Driver], systems: &[Arc<System>]) -> Result<(), Error> {
    for (driver, system) in drivers.iter_mut().zip(systems) {
        driver.link(&vec![0.0; system.unknowns()]);
        driver.restart(&system.initial.displacement, &system.initial.velocity)?;
    }
    Ok(())
}

/// With what a zone begins.
struct Begun<'a> {
    /// Velocity by unknown, m/s.
    velocity: &'a [f64],
    /// Force of the links by unknown, N.
    force: Vec<f64>,
}

/// How a driver of a zone begins.
type Begin<'a> = dyn FnMut(&mut Driver, usize, Begun) -> Result<(), carom_dynamics::Error> + 'a;

/// Starts the drivers with velocities that satisfy the rows; returns the first multipliers.
fn start(
    drivers: &mut [Driver],
    (rows, turning, count): (&mut ByZone, &mut Option<TurningLinks>, usize),
    begin: &mut Begin,
) -> Result<Vec<f64>, Error> {
    if count == 0 {
        return Ok(Vec::new());
    }
    if let Some(links) = turning {
        links.at_states(drivers, rows);
    }
    let rows = &*rows;
    let masses = drivers
        .iter()
        .map(|driver| Operators::new(driver.system(), 1.0, 0.0, "mass matrix"))
        .collect::<Result<Vec<_>, carom_dynamics::Error>>()?;
    let mut mass = MassLinks { masses, rows };
    let mut factor = mass.factor(drivers, count)?;
    // velocities
    let mut defect = vec![0.0; count];
    add(rows, drivers, &mut defect, |driver| {
        &driver.state().motion.v
    });
    factor.solve(&mut defect);
    let velocities: Vec<Vec<f64>> = (0..drivers.len())
        .map(|k| {
            let change = mass.answer(k, drivers[k].system(), &defect);
            let v = &drivers[k].state().motion.v;
            v.iter().zip(&change).map(|(v, c)| v - c).collect()
        })
        .collect();
    // accelerations
    let accelerations: Vec<Vec<f64>> = (0..drivers.len())
        .map(|k| {
            let system = drivers[k].system();
            let motion = &drivers[k].state().motion;
            let load = drivers[k].load();
            let balance: Vec<f64> = (0..load.len())
                .map(|i| match system.fixed[i] {
                    true => 0.0,
                    false => {
                        let outside = load[i] + motion.contact_force[i] + motion.link_of(i);
                        outside - motion.internal_force[i]
                    }
                })
                .collect();
            mass.solve(k, &balance)
        })
        .collect();
    let mut multipliers = vec![0.0; count];
    for (rows, a) in rows.iter().zip(&accelerations) {
        for (row, terms) in rows {
            multipliers[*row as usize] -= on(terms, a);
        }
    }
    if let Some(links) = turning {
        for (row, own) in links.centripetal(drivers, &velocities) {
            multipliers[row as usize] -= own;
        }
    }
    factor.solve(&mut multipliers);
    for (k, driver) in drivers.iter_mut().enumerate() {
        let force = forces(&rows[k], &multipliers, driver.system().unknowns());
        let velocity = &velocities[k];
        begin(driver, k, Begun { velocity, force })?;
    }
    Ok(multipliers)
}

/// Cᵀ L on the unknowns of a zone.
fn forces(rows: &[(u32, LinkRow)], multipliers: &[f64], unknowns: usize) -> Vec<f64> {
    let mut force = vec![0.0; unknowns];
    for (row, terms) in rows {
        for &(dof, c) in terms {
            force[dof as usize] += c * multipliers[*row as usize];
        }
    }
    force
}

fn add(
    rows: &[Vec<(u32, LinkRow)>],
    drivers: &[Driver],
    sums: &mut [f64],
    vector: impl Fn(&Driver) -> &Vec<f64>,
) {
    for (rows, driver) in rows.iter().zip(drivers) {
        for (row, terms) in rows {
            sums[*row as usize] += on(terms, vector(driver));
        }
    }
}

/// The mass of each zone against its rows.
struct MassLinks<'a> {
    masses: Vec<Operators>,
    rows: &'a [Vec<(u32, LinkRow)>],
}

impl MassLinks<'_> {
    /// M⁻¹ r of one zone.
    fn solve(&mut self, zone: usize, r: &[f64]) -> Vec<f64> {
        let (mut half, mut x) = (vec![0.0; r.len()], vec![0.0; r.len()]);
        self.masses[zone].begin(r, &mut half);
        self.masses[zone].end(&mut half, &mut x);
        x
    }

    /// M⁻¹ Cᵀ L of one zone.
    fn answer(&mut self, zone: usize, system: &System, multipliers: &[f64]) -> Vec<f64> {
        let mut force = forces(&self.rows[zone], multipliers, system.unknowns());
        for (f, fixed) in force.iter_mut().zip(&system.fixed) {
            if *fixed {
                *f = 0.0;
            }
        }
        self.solve(zone, &force)
    }

    /// The factor of Σ C M⁻¹ Cᵀ.
    fn factor(&mut self, drivers: &[Driver], count: usize) -> Result<Condensed, Error> {
        if count > DENSE {
            let zones = drivers.iter().zip(self.rows);
            let answers: Vec<Answer> = zones
                .map(|(driver, rows)| answer((driver.system(), rows), [1.0, 0.0], 1.0))
                .collect();
            let joined = Joined::new(&answers, count)?;
            return Ok(Condensed::Joined(Box::new(joined)));
        }
        let mut matrix = vec![0.0; count * count];
        let mut unit = vec![0.0; count];
        for zone in 0..drivers.len() {
            for (column, _) in &self.rows[zone] {
                unit[*column as usize] = 1.0;
                let x = self.answer(zone, drivers[zone].system(), &unit);
                unit[*column as usize] = 0.0;
                for (row, terms) in &self.rows[zone] {
                    matrix[*row as usize * count + *column as usize] += on(terms, &x);
                }
            }
        }
        hold_empty_rows(count, &mut matrix);
        let factor = DenseCholesky::new(count, &matrix);
        let factor =
            factor.map_err(|cause| carom_dynamics::Error::Redundant { rows: count, cause })?;
        Ok(Condensed::Dense(factor))
    }
}
