//! Packets of bending waves, and how they cross a border between two zones.

use std::f64::consts::TAU;

use carom_arlequin::Row as Coupled;
use carom_dynamics::{Model, ModelBody, ModelLink, Scheme, System};
use carom_exact::beam::Beam;
use carom_mesh::Mesh;
use carom_zones::{LinkKind, ModelZone, Zoned};

use crate::Error;
use crate::build::newmark;
use crate::check::Row;

/// A packet of waves of a beam that run along s: a Gauss curve of wave numbers about 2π/λ of the standard deviation 1/(1.5 λ), its middle in s = 0.
pub(crate) struct Packet {
    pub(crate) beam: Beam,
    /// λ, m.
    pub(crate) wave: f64,
    /// Length of the linear elements that it starts in, m: its waves are then those of the mesh. None of elements whose waves are those of the beam.
    pub(crate) element: Option<f64>,
}

impl Packet {
    /// Standard deviation of its extent, m.
    pub(crate) fn spread(&self) -> f64 {
        1.5 * self.wave
    }

    /// Angular frequency of λ, rad/s.
    pub(crate) fn frequency(&self) -> f64 {
        self.of_wave(TAU / self.wave)[0]
    }

    /// dω/dk of λ, m/s.
    pub(crate) fn group_speed(&self) -> f64 {
        let k = TAU / self.wave;
        let at = |part: f64| self.of_wave(part * k)[0];
        (at(1.001) - at(0.999)) / (0.002 * k)
    }

    /// Angular frequency (rad/s) of a wave number, and rotation over deflection.
    ///
    /// Linear elements of a beam with one point for shear and consistent mass, or of a shell in cylindrical bending, have the shear strain `a w - c θ` and the curvature `a θ`,
    /// `a = 2 sin(k L/2)/L`, `c = cos(k L/2)`, and the mass of both times `(2 + cos k L)/3`. Waves of the continuum on that mesh would be waves of both directions: of a frequency that is too
    /// high by (k L)²/8 in the limit of thin beams half of that goes back at the start.
    fn of_wave(&self, k: f64) -> [f64; 2] {
        let beam = &self.beam;
        let (Some(element), Some([shear, inertia])) = (self.element, beam.shear) else {
            let omega = beam.of_wave(k)[0];
            return [omega, beam.rotation_of_wave(k, omega)];
        };
        let half = 0.5 * k * element;
        let (a, c) = (2.0 * half.sin() / element, half.cos());
        let m = (2.0 + (2.0 * half).cos()) / 3.0;
        let stiffness = [shear * a * a, beam.bending * a * a + shear * c * c];
        let mass = [beam.mass * m, inertia * m];
        let both = stiffness[0] * mass[1] + stiffness[1] * mass[0];
        let determinant = stiffness[0] * stiffness[1] - (shear * a * c).powi(2);
        let root = (both * both - 4.0 * mass[0] * mass[1] * determinant).sqrt();
        // the lower root, without a difference
        let square = 2.0 * determinant / (both + root);
        let ratio = (stiffness[0] - square * mass[0]) / (shear * a * c);
        [square.sqrt(), ratio]
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
            let [omega, ratio] = self.of_wave(k);
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
    zones_of((bodies, mesh), rows, (dt, substeps), newmark(0.25, 0.5))
}

/// The same with another scheme.
pub(crate) fn zones_of(
    (bodies, mesh): ([ModelBody; 2], Mesh),
    rows: Vec<Coupled>,
    (dt, substeps): (f64, u32),
    scheme: Scheme,
) -> Zoned {
    let zone = |name: &str, body, substeps| ModelZone::new(name, vec![body], (scheme, substeps));
    Zoned {
        model: Model::new(bodies.to_vec(), mesh, scheme, dt),
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
    let mut zones = crate::witness::zones(zoned)?;
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
