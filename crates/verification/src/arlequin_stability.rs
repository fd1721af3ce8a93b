//! The spectral radius of the linear step of two glued zones.
//!
//! Problem: a bar with ten fine elements and six coarse ones twice as long, of which three lie in the overlap, held at its
//! ends; linear weights, coarse L2 mediator. The step is linear without contact: its matrix has one column for each free
//! entry of the state (u, v, a of both zones, multipliers), which is the state one outer step after that entry alone.
//! Closed solution: none grows, ρ <= 1, for every θ >= ½, number of inner steps, and outer scheme within its own limit. The
//! radius is ||A^p||^(1/p) with p = 2^26 by repeated squaring: what grows like p would add ln p / p < 3e-7.
//!
//! A free bar has the rigid motion besides, a double root 1 that rounding splits by its own root: its columns, true to
//! 1e-12, gave ρ - 1 from 2e-7 to 2e-6. That motion is the subject of `arlequin-start`.
//!
//! Tolerance: 1e-6, of the project's theory note. A control with θ < ½ inside shows that growth is seen.

use carom_dynamics::Scheme;
use carom_zones::{LinkKind, Zones, ZonesState};

use crate::Error;
use crate::build::{CENTRAL, newmark, theta};
use crate::check::{Check, Row};
use crate::glued_bar::GluedBar;

const SQUARINGS: i32 = 26;

pub(crate) const CHECK: Check = Check {
    name: "arlequin-stability",
    fact: "the linear step of glued zones has no growing motion",
    run: |_| {
        let trapezoid = newmark(0.25, 0.5);
        let outers = [
            ("explicit", CENTRAL, &[0.3, 0.6, 0.9, 0.98][..]),
            ("trapezoid", trapezoid, &[0.5, 2.0][..]),
        ];
        let mut rows = Vec::new();
        for kind in [LinkKind::GravouilCombescure, LinkKind::PrakashHjelmstad] {
            for (name, outer, courants) in outers {
                for &courant in courants {
                    for m in [1, 4, 10] {
                        let mut worst: f64 = 0.0;
                        for inner in [0.5, 0.55, 0.75, 1.0] {
                            let bar = bar(kind, [theta(inner), outer], courant, m);
                            worst = worst.max(radius(&bar)?);
                        }
                        let name = format!("{kind:?}, {name}, CFL {courant}, m = {m}: ρ - 1");
                        rows.push(Row::at_most(name, worst - 1.0, 1e-6));
                    }
                }
            }
            let control = bar(kind, [theta(0.45), CENTRAL], 0.9, 4);
            rows.push(Row::at_least(
                format!("{kind:?}, θ = 0.45 inside: ρ - 1"),
                radius(&control)? - 1.0,
                1e-3,
            ));
        }
        Ok(rows)
    },
};

fn bar(kind: LinkKind, schemes: [Scheme; 2], courant: f64, substeps: u32) -> GluedBar {
    GluedBar {
        zone: 5,
        overlap: 3,
        ratio: 2,
        schemes,
        courant,
        substeps,
        kind,
        held: true,
        ..GluedBar::usual(8)
    }
}

/// Spectral radius of the step.
fn radius(bar: &GluedBar) -> Result<f64, Error> {
    let mut zones = crate::witness::zones(&bar.zoned()?)?;
    let rest = zones.state();
    let free = free(&zones);
    let entries = |mut state: ZonesState| -> Vec<f64> {
        let places = places(&mut state).zip(&free).filter(|(_, free)| **free);
        places.map(|(place, _)| *place).collect()
    };
    let n = entries(rest.clone()).len();
    let mut matrix = vec![0.0; n * n];
    for column in 0..n {
        let mut state = rest.clone();
        let mut places = places(&mut state).zip(&free).filter(|(_, free)| **free);
        if let Some((place, _)) = places.nth(column) {
            *place = 1.0;
        }
        drop(places);
        zones.resume(&state);
        zones.step()?;
        for (row, value) in entries(zones.state()).into_iter().enumerate() {
            matrix[row * n + column] = value;
        }
    }
    Ok(growth(matrix, n))
}

/// The numbers of a state that its next step depends on.
fn places(state: &mut ZonesState) -> impl Iterator<Item = &mut f64> {
    let zones = state.zones.iter_mut().flat_map(|zone| {
        let motion = &mut zone.motion;
        let vectors = [&mut motion.u, &mut motion.v, &mut motion.a];
        vectors.into_iter().flatten()
    });
    zones.chain(state.multipliers.iter_mut())
}

/// Whether each of the numbers of [`places`] is free.
fn free(zones: &Zones) -> Vec<bool> {
    let of_zone = |driver: &carom_dynamics::Driver| {
        let fixed = &driver.system().fixed;
        let vectors = std::iter::repeat_n(fixed, 3).flatten();
        vectors.map(|fixed| !fixed).collect::<Vec<_>>()
    };
    let mut free: Vec<bool> = zones.drivers().iter().flat_map(of_zone).collect();
    free.resize(free.len() + zones.multipliers().len(), true);
    free
}

/// ||A^p||^(1/p), p = 2^[`SQUARINGS`], in the norm of the largest entry.
fn growth(mut matrix: Vec<f64>, n: usize) -> f64 {
    let mut logarithm = 0.0;
    for k in 0..=SQUARINGS {
        let norm = matrix.iter().fold(0.0, |m: f64, a| m.max(a.abs()));
        logarithm += norm.ln() / 2.0_f64.powi(k);
        matrix.iter_mut().for_each(|a| *a /= norm);
        if k < SQUARINGS {
            matrix = square(&matrix, n);
        }
    }
    logarithm.exp()
}

fn square(matrix: &[f64], n: usize) -> Vec<f64> {
    let mut out = vec![0.0; n * n];
    for (out, row) in out.chunks_exact_mut(n).zip(matrix.chunks_exact(n)) {
        for (factor, other) in row.iter().zip(matrix.chunks_exact(n)) {
            out.iter_mut()
                .zip(other)
                .for_each(|(out, other)| *out += factor * other);
        }
    }
    out
}
