//! Waves in a Timoshenko beam.
//!
//! Problem: a free steel beam, section height h = 0.1 m, at the start a packet of waves v = e(x) cos kx, θ = -r e(x) sin kx with the
//! amplitude ratio and the velocities of one of the two waves of wave number k, k h = 1 or 2, that run to the right; e a bell of
//! 8 wave lengths. The Fourier coefficient `∫ (v m v* + θ J θ*) e^{-ikx} dx` of an infinite beam, v* and θ* the shape of that
//! wave, turns by ω t exactly, whatever the bell: waves of other numbers and of the other branch are orthogonal to it. Reference: the two
//! phase velocities ω/k (`carom_exact::beam`). The ends are 40 wave lengths apart, and the packet does not reach them.
//!
//! Tolerance: 1 %, stated beforehand. 20 elements a wave length (error of the elements, by their dispersion relation, at most 6e-4), and
//! 60 steps a period of the trapezoidal rule ((ω Δt)²/12 = 9e-4). Energy and momentum balances: round-off of 2000 steps.

use std::f64::consts::TAU;

use carom_bodies::BeamTheory;
use carom_dynamics::{Driver, Model};

use crate::Error;
use crate::beams::{exact, section, straight};
use crate::build::newmark;
use crate::check::{Check, Row, Size};
use crate::points::balances;

const HEIGHT: f64 = 0.1;
const LENGTHS: f64 = 40.0;
const STEPS: f64 = 60.0;

fn phase_velocity(
    number: f64,
    branch: usize,
    (elements, periods): (usize, f64),
) -> Result<Vec<Row>, Error> {
    let k = number / HEIGHT;
    let length = LENGTHS * TAU / k;
    let section = section(HEIGHT, BeamTheory::Timoshenko);
    let beam = exact(length, &section, 0);
    let omega = beam.of_wave(k)[branch];
    let ratio = beam.rotation_of_wave(k, omega);
    let count = (LENGTHS * elements as f64) as usize;
    let (mesh, body) = straight([[0.0; 3], [length, 0.0, 0.0]], count, 2, section)?;
    let dt = TAU / omega / STEPS;
    let system = crate::witness::system(Model::new(vec![body], mesh, newmark(0.25, 0.5), dt))?;
    let mut driver = Driver::new(system)?;
    let system = driver.system();
    let (mut u, mut v) = (vec![0.0; system.unknowns()], vec![0.0; system.unknowns()]);
    let middle = 0.4 * length;
    for (node, x) in system.x.iter().enumerate() {
        let first = system.unknowns.first(node as u32);
        let from = k * (x[0] - middle);
        let bell = 1e-6 * (-0.5 * (from / (0.5 * 8.0 * TAU / 3.0)).powi(2)).exp();
        let (sin, cos) = from.sin_cos();
        // cos(kx - ωt)
        (u[first + 1], u[first + 2]) = (bell * cos, -bell * ratio * sin);
        (v[first + 1], v[first + 2]) = (bell * omega * sin, bell * omega * ratio * cos);
    }
    driver.restart(&u, &v)?;
    let [_, rotary] = beam.shear.unwrap_or_default();
    let coefficient = |driver: &Driver| {
        let (system, u) = (driver.system(), &driver.state().motion.u);
        let mut sum = [0.0, 0.0];
        for (node, x) in system.x.iter().enumerate() {
            let first = system.unknowns.first(node as u32);
            let (sin, cos) = (k * (x[0] - middle)).sin_cos();
            let [deflection, turn] = [u[first + 1] * beam.mass, u[first + 2] * rotary * ratio];
            // conjugate of cos + i sin for v, of its derivative's shape i r (cos + i sin) for θ
            sum[0] += deflection * cos - turn * sin;
            sum[1] -= deflection * sin + turn * cos;
        }
        sum
    };
    let start = coefficient(&driver);
    let steps = (periods * STEPS) as usize;
    let mut phase = 0.0;
    let mut before = start;
    for _ in 0..steps {
        driver.step()?;
        let now = coefficient(&driver);
        let cross = before[0] * now[1] - before[1] * now[0];
        let along = before[0] * now[0] + before[1] * now[1];
        phase -= cross.atan2(along);
        before = now;
    }
    let found = phase / (driver.state().time * k);
    let name = ["bending", "shear"][branch];
    let mut rows = vec![
        Row::relative(
            format!("wave of {name}, k h = {number}: phase velocity, m/s"),
            found,
            omega / k,
            1e-2,
        ),
        Row::near(
            format!("wave of {name}, k h = {number}: amplitude at the end over that at the start"),
            before[0].hypot(before[1]) / start[0].hypot(start[1]),
            1.0,
            1e-2,
        ),
    ];
    // momentum: that of a half wave
    let scale = beam.mass * 1e-6 * omega / k;
    rows.extend(balances(
        &format!("wave of {name}, k h = {number}"),
        driver.state(),
        scale,
    ));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "beam-pulse",
    fact: "packets of waves in a Timoshenko beam run with the two exact phase velocities",
    run: |size| {
        let (numbers, resolution): (&[f64], _) = match size {
            Size::Quick => (&[1.0], (20, 2.0)),
            Size::Full => (&[1.0, 2.0], (20, 6.0)),
        };
        let mut all = Vec::new();
        for &number in numbers {
            for branch in [0, 1] {
                all.extend(phase_velocity(number, branch, resolution)?);
            }
        }
        Ok(all)
    },
};
