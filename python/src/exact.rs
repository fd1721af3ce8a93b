//! Exact solutions.

use carom_exact::beam_on_stop::BeamOnStop;
use carom_exact::hertz::{Pair, Solid, reduced_mass};
use carom_exact::mass_on_bar::MassOnBar;
use carom_exact::{Bar, Solution, solve};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Length (m), area (m²), modulus (Pa), density (kg/m³), velocity (m/s), strain and gravity (m/s²) of a bar, velocities away from the
/// contact, and whether its far end is clamped.
type GivenBar = ([f64; 7], bool);

fn bar((numbers, clamped): GivenBar) -> Bar {
    let [length, area, modulus, density, velocity, strain, gravity] = numbers;
    let bar = Bar::new(length, area, modulus, density)
        .with_velocity(velocity)
        .with_strain(strain)
        .with_gravity(gravity);
    if clamped { bar.clamped() } else { bar }
}

/// The exact impact of a bar on a wall or of two bars.
#[pyclass(frozen, module = "carom")]
pub(crate) struct Impact(Solution);

#[pymethods]
impl Impact {
    #[new]
    fn new(bars: Vec<GivenBar>, gap: f64, end: f64) -> PyResult<Impact> {
        let bars: Vec<Bar> = bars.into_iter().map(bar).collect();
        let impact = match bars[..] {
            [bar] => carom_exact::Impact::Wall { bar, gap },
            [secondary, primary] => carom_exact::Impact::TwoBars {
                secondary,
                primary,
                gap,
            },
            _ => return Err(PyValueError::new_err("one bar or two bars are needed")),
        };
        let solution = solve(&impact, end);
        solution
            .map(Impact)
            .map_err(|e| PyValueError::new_err(e.to_string()))
    }

    fn force(&self, times: Vec<f64>) -> Vec<f64> {
        times.iter().map(|t| self.0.force().value(*t)).collect()
    }

    fn impulse(&self, times: Vec<f64>) -> Vec<f64> {
        times.iter().map(|t| self.0.impulse(*t)).collect()
    }

    fn gap(&self, times: Vec<f64>) -> Vec<f64> {
        times.iter().map(|t| self.0.gap(*t)).collect()
    }

    fn energy(&self, times: Vec<f64>) -> Vec<f64> {
        times.iter().map(|t| self.0.energy(*t)).collect()
    }

    /// Velocity of the place `s` (m from the contact end) of a bar, m/s, away from the contact.
    fn velocity(&self, body: usize, s: f64, times: Vec<f64>) -> PyResult<Vec<f64>> {
        let motion = self.0.motions().get(body);
        let motion = motion.ok_or_else(|| PyValueError::new_err("no bar of this number"))?;
        Ok(times.iter().map(|t| motion.velocity(s, *t)).collect())
    }

    /// Displacement as [`Impact::velocity`], m.
    fn displacement(&self, body: usize, s: f64, times: Vec<f64>) -> PyResult<Vec<f64>> {
        let motion = self.0.motions().get(body);
        let motion = motion.ok_or_else(|| PyValueError::new_err("no bar of this number"))?;
        Ok(times.iter().map(|t| motion.displacement(s, *t)).collect())
    }

    /// Start and end (s), largest force (N) and impulse (N s) of each contact.
    #[getter]
    fn contacts(&self) -> Vec<[f64; 4]> {
        let contacts = self.0.contacts().iter();
        contacts
            .map(|c| [c.start, c.end, c.peak_force, c.impulse])
            .collect()
    }
}

/// Duration (s), largest force (N), approach (m), radius (m) and pressure (Pa) of the collision of two spheres, each with its radius (m),
/// Young's modulus (Pa), Poisson's ratio and mass (kg).
#[pyfunction]
pub(crate) fn hertz_collision(spheres: [[f64; 4]; 2], speed: f64) -> [f64; 5] {
    let solid = |[radius, young, poisson, _]: [f64; 4]| Solid {
        radius,
        young,
        poisson,
    };
    let pair = Pair::new(solid(spheres[0]), solid(spheres[1]));
    let collision = pair.collision(reduced_mass(spheres.map(|sphere| sphere[3])), speed);
    let largest = collision.largest;
    [
        collision.duration,
        largest.force,
        largest.approach,
        largest.radius,
        largest.peak,
    ]
}

/// Duration of the contact (s) and forces (N) at times (s) of a mass that strikes a bar: mass (kg), impedance (N s/m), speed (m/s),
/// transit 2L/c (s).
#[pyfunction]
pub(crate) fn mass_on_bar(
    numbers: [f64; 4],
    fixed: bool,
    transits: usize,
    times: Vec<f64>,
) -> (f64, Vec<f64>) {
    let exact = MassOnBar::new(numbers, fixed, transits);
    let forces = times.iter().map(|t| exact.force(*t)).collect();
    (exact.duration(), forces)
}

/// Forces on the stop (N) at the ends of steps of `dt` (s): E I (N m²), mass per length (kg/m), length (m); a (m/s²); stiffness (N/m) and
/// gap (m) of the stop.
#[pyfunction]
pub(crate) fn beam_on_stop(
    cantilever: bool,
    problem: ([f64; 3], f64, [f64; 2], usize),
    steps: (f64, usize),
) -> Vec<f64> {
    let ((beam, load, stop, modes), (dt, steps)) = (problem, steps);
    let exact = match cantilever {
        true => BeamOnStop::cantilever(beam, load, stop, modes),
        false => BeamOnStop::simply_supported(beam, load, stop, modes),
    };
    exact.forces(dt, steps)
}
