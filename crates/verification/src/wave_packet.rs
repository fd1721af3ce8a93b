//! Packets of bending waves, and how they cross a border between two zones.

use std::f64::consts::TAU;

use carom_arlequin::Row as Coupled;
use carom_dynamics::{Model, ModelBody, ModelLink, System};
use carom_exact::beam::Beam;
use carom_mesh::Mesh;
use carom_zones::{LinkKind, ModelZone, Zoned, Zones};

use crate::Error;
use crate::build::newmark;
use crate::check::Row;

/// A packet of waves of a beam that run along s: a Gauss curve of wave numbers about 2π/λ of the standard deviation 1/(1.5 λ), its middle in s = 0.
pub(crate) struct Packet {
    pub(crate) beam: Beam,
    /// λ, m.
    pub(crate) wave: f64,
}

impl Packet {
    /// Standard deviation of its extent, m.
    pub(crate) fn spread(&self) -> f64 {
        1.5 * self.wave
    }

    /// Angular frequency of λ, rad/s.
    pub(crate) fn frequency(&self) -> f64 {
        self.beam.of_wave(TAU / self.wave)[0]
    }

    /// dω/dk of λ, m/s.
    pub(crate) fn group_speed(&self) -> f64 {
        let k = TAU / self.wave;
        let at = |part: f64| self.beam.of_wave(part * k)[0];
        (at(1.001) - at(0.999)) / (0.002 * k)
    }

    /// Deflection, rotation in the sense of its slope along s, and the rates of both at the start.
    pub(crate) fn at(&self, s: f64) -> [f64; 4] {
        let middle = TAU / self.wave;
        let step = TAU / (60.0 * self.wave);
        let mut sum = [0.0; 4];
        for j in -60..=60 {
            let k = middle + f64::from(j) * step;
            if k <= 0.0 {
                continue;
            }
            let size = 1e-9 * (-0.5 * ((k - middle) * self.spread()).powi(2)).exp();
            let omega = self.beam.of_wave(k)[0];
            let ratio = self.beam.rotation_of_wave(k, omega);
            let (sin, cos) = (k * s).sin_cos();
            // v = cos(k s - ω t)
            let terms = [cos, -ratio * sin, omega * sin, omega * ratio * cos];
            sum.iter_mut()
                .zip(terms)
                .for_each(|(sum, term)| *sum += size * term);
        }
        sum
    }
}

/// What a packet leaves behind that runs out of the last of two zones.
pub(crate) struct Crossing {
    /// Root of the energy that is left in the zone over that at the start.
    pub(crate) back: f64,
    /// Largest work of the link and residual of the energy over the energy.
    pub(crate) work: f64,
    pub(crate) residual: f64,
}

impl Crossing {
    /// What the project asks of a wave that comes long: the bound of its reflection, and no work of the link.
    pub(crate) fn rows(&self, label: &str) -> [Row; 3] {
        [
            Row::at_most(
                format!("{label}: amplitude that comes back"),
                self.back,
                0.02,
            ),
            Row::at_most(format!("{label}: work of the link / E0"), self.work, 1e-10),
            Row::at_most(
                format!("{label}: energy residual / E0"),
                self.residual,
                1e-10,
            ),
        ]
    }
}

/// Two bodies in zones of their own that step by the trapezoidal rule, with the rows of a link; `substeps` of the first one to a `dt` (s) of
/// the second.
pub(crate) fn two_zones(
    (bodies, mesh): ([ModelBody; 2], Mesh),
    rows: Vec<Coupled>,
    (dt, substeps): (f64, u32),
) -> Zoned {
    let zone = |name: &str, body, substeps| ModelZone {
        name: name.to_string(),
        bodies: vec![body],
        scheme: newmark(0.25, 0.5),
        substeps,
        far: None,
    };
    Zoned {
        model: Model::new(bodies.to_vec(), mesh, newmark(0.25, 0.5), dt),
        zones: vec![zone("first", 0, substeps), zone("second", 1, 1)],
        links: vec![ModelLink {
            name: "overlap".to_string(),
            zones: [0, 1],
            rows,
        }],
        kind: match substeps {
            1 => LinkKind::GravouilCombescure,
            _ => LinkKind::PrakashHjelmstad,
        },
    }
}

/// Runs two zones for a time (s). `start`: displacements and velocities of the second one; the first is at rest.
pub(crate) fn cross(
    zoned: &Zoned,
    start: &dyn Fn(&System) -> [Vec<f64>; 2],
    time: f64,
) -> Result<Crossing, Error> {
    let mut zones = Zones::new(zoned)?;
    let rest = zones.drivers()[0].system().unknowns();
    let moving = start(zones.drivers()[1].system());
    zones.restart(&[[vec![0.0; rest], vec![0.0; rest]], moving])?;
    let before = zones.balance().energy();
    let (mut work, mut residual) = (0.0_f64, 0.0_f64);
    while zones.time() < time {
        zones.step()?;
        let balance = zones.balance();
        work = work.max(balance.work_links.abs());
        residual = residual.max(balance.energy_residual.abs());
    }
    let left = zones.drivers()[1].state().ledger.balance.energy();
    Ok(Crossing {
        back: (left / before).sqrt(),
        work: work / before,
        residual: residual / before,
    })
}
