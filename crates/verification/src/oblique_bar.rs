//! A bar meets a frictionless wall with a corner.
//!
//! Problem: a bar of 100 mm by 20 mm in plane strain, 1 m thick, turned by 60° against the wall y = 0 that its lower corner
//! touches, comes with 1.2 m/s along the wall and 2 m/s towards it; neo-Hooke, E = 1e7 Pa, ν = 0.3, ρ = 1000 kg/m³ (bar waves
//! of 100 m/s); it leaves the wall turning. Meshes of Gmsh in `cases/oblique-bar`; Courant number 0.8.
//!
//! Closed solution: none for the motion; facts instead. The wall pushes along its normal only, so the momentum along it
//! stays, and the ledgers of energy and momentum close: 1e-9, Newton's tolerance of 1e-11 over the steps. The angular
//! momentum about a point of the wall changes by the moment of the wall's impulse: to 1e-9 with the energy-momentum scheme
//! and with theta ½, whose internal forces are those of the configuration that gives their lever arms; Newmark takes means
//! of the forces of both ends, and what that leaves is shown. A rigid bar with the wall's impulse J in its lowest corner, at
//! r = 16.34 mm along the wall from the centre of mass, turns by ΔL = -r J about it and has the ratio of restitution
//! e = J (1/m + r²/I)/v_n - 1, 0 < e < 1, since vibration keeps energy. The contact spreads from the corner over the elements that
//! meet in it, h cos 30° along the wall: r within that. Nodes and mortar see the same wall, a second formulation; but the multiplier
//! of the corner looks at the mean of the gap over these elements, so that its lever differs by as much and the impulse by
//! dJ/J = 2 k/(1 + k) dr/r with k = m r²/I: 0.12 on the coarse mesh, 0.05 on the fine one. The trapezoid with the displacement
//! law gains energy without bound (its ledger closes: contact works), which is shown on the coarse mesh.
//! Sizes: quick 20 x 4 elements, full 50 x 10.

use carom_bodies::Kinematics;
use carom_contact::{Basis, Integration, Law};
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Driver, Model, Nonlinear, Scheme};
use carom_materials::Elastic;

use crate::Error;
use crate::build::{DISPLACEMENT, NOW, contact, neo_hooke, newmark, plane, surface, theta};
use crate::check::{Check, Row, Size};
use crate::meshes;

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e7,
    poisson: 0.3,
};
/// Length and height, m.
const SIDES: [f64; 2] = [0.1, 0.02];
/// Along the wall and towards it, m/s.
const VELOCITY: [f64; 2] = [1.2, 2.0];
/// Four times the way of a wave along the bar.
const END: f64 = 4e-3;
const BALANCE: f64 = 1e-9;

/// Elements along the bar and its mesh.
fn mesh_of(size: Size) -> (f64, &'static str) {
    match size {
        Size::Quick => (20.0, "oblique-bar/bar-coarse.msh"),
        Size::Full => (50.0, "oblique-bar/bar.msh"),
    }
}

fn model(size: Size, scheme: Scheme, law: Law, integration: Integration) -> Result<Model, Error> {
    let (along, file) = mesh_of(size);
    let mut mesh = meshes::mesh(file)?;
    mesh.scale(1e-3);
    let kinematics = Kinematics::PlaneStrain { thickness: 1.0 };
    let mut bar = neo_hooke(&mesh, "bar", kinematics, RUBBER)?;
    bar.velocity = [VELOCITY[0], -VELOCITY[1], 0.0];
    let mut wall = contact(surface(&mesh, "bar.surface", &bar)?, plane(1, 1.0), law);
    wall.integration = integration;
    let mut nonlinear = Nonlinear::default();
    nonlinear.iteration.tolerance = 1e-11;
    let speed = (RUBBER.young / RUBBER.density).sqrt();
    Ok(Model {
        contacts: vec![wall],
        nonlinear,
        ..Model::new(vec![bar], mesh, scheme, 0.8 * SIDES[0] / along / speed)
    })
}

/// I/m of the bar, m².
fn gyration() -> f64 {
    (SIDES[0].powi(2) + SIDES[1].powi(2)) / 12.0
}

/// Distance of the lowest corner from the centre of mass along the wall, m.
fn lever() -> f64 {
    let (sin, cos) = 60f64.to_radians().sin_cos();
    0.5 * (SIDES[0] * cos - SIDES[1] * sin)
}

/// What an impact left.
struct Impact {
    /// Impulse of the wall, N s, along it and along its normal, and its moment about the origin, N m s.
    impulse: [f64; 3],
    /// Change of the momentum along the wall / initial.
    along: f64,
    /// Residuals of energy, momentum and angular momentum, relative.
    residuals: [f64; 3],
    /// Energy at the end / initial - 1.
    gain: f64,
    /// -ΔL / J about the centre of mass / its distance from the corner along the wall.
    lever: f64,
    restitution: f64,
    /// Gap at the end, m.
    gap: f64,
}

fn strike(size: Size, scheme: Scheme, law: Law, integration: Integration) -> Result<Impact, Error> {
    let mut newton = Driver::new(crate::witness::system(model(
        size,
        scheme,
        law,
        integration,
    )?)?)?;
    while newton.state().time < END {
        newton.step()?;
    }
    let ledger = &newton.state().ledger;
    let (start, end) = (&ledger.initial, &ledger.balance);
    let wall = end.impulse_contact;
    let [tangential, normal] = [wall.linear[0], wall.linear[1]];
    let turned = end.momentum_residual.angular[2].abs();
    let mass = RUBBER.density * SIDES[0] * SIDES[1];
    let inertia = mass * gyration();
    let corner = -lever();
    let spin = spin(&newton);
    Ok(Impact {
        impulse: [tangential, normal, wall.angular[2]],
        along: (end.momentum.linear[0] - start.momentum.linear[0]) / start.momentum.linear[0],
        residuals: [
            ledger.largest_energy_residual / ledger.largest_energy,
            ledger.largest_momentum_residual / ledger.largest_momentum,
            turned / wall.angular[2].abs(),
        ],
        gain: end.energy() / start.energy() - 1.0,
        lever: spin / normal / corner,
        restitution: normal * (1.0 / mass + corner * corner / inertia) / VELOCITY[1] - 1.0,
        gap: newton.report().contacts[0].gap,
    })
}

/// Angular momentum about the centre of mass, N m s.
fn spin(newton: &Driver) -> f64 {
    let (system, motion) = (newton.system(), &newton.state().motion);
    let (mut mass, mut centre) = (0.0, [0.0; 2]);
    for &(node, m) in &system.body_masses[0] {
        let node = node as usize;
        mass += m;
        for i in 0..2 {
            centre[i] += m * (system.x[node][i] + motion.u[2 * node + i]);
        }
    }
    let masses = system.body_masses[0].iter();
    let terms = masses.map(|&(node, m)| {
        let node = node as usize;
        let r = [0, 1].map(|i| system.x[node][i] + motion.u[2 * node + i] - centre[i] / mass);
        m * (r[0] * motion.v[2 * node + 1] - r[1] * motion.v[2 * node])
    });
    terms.sum()
}

impl Impact {
    /// `keeps`: whether the scheme keeps the angular momentum; `element`: size of an element along the wall over the lever of the
    /// corner.
    fn rows(&self, name: &str, keeps: bool, element: f64) -> Vec<Row> {
        let row = |what: &str| format!("{name}: {what}");
        let [energy, momentum, turned] = self.residuals;
        let [tangential, normal, _] = self.impulse;
        let mut rows = vec![
            Row::at_most(row("energy residual / largest"), energy, BALANCE),
            Row::at_most(row("momentum residual / largest"), momentum, BALANCE),
            Row::near(
                row("change of momentum along the wall / initial"),
                self.along,
                0.0,
                BALANCE,
            ),
            Row::near(
                row("impulse of the wall, along / normal"),
                tangential / normal,
                0.0,
                1e-14,
            ),
            Row::near(
                row("turn per impulse / lever of the corner"),
                self.lever,
                1.0,
                element,
            ),
            Row::near(row("restitution"), self.restitution, 0.5, 0.5),
            Row::at_least(row("gap at the end, m"), self.gap, 1e-3),
        ];
        let what = row("angular momentum residual / moment of the impulse");
        rows.push(match keeps {
            true => Row::at_most(what, turned, BALANCE),
            false => Row::shown(what, turned),
        });
        rows
    }
}

/// Rows of one scheme and law. `keeps`: whether the scheme keeps the angular momentum.
fn rows(
    size: Size,
    name: &str,
    (scheme, law): (Scheme, Law),
    keeps: bool,
) -> Result<Vec<Row>, Error> {
    let nodes = strike(size, scheme, law, Integration::Node)?;
    let basis = Basis::Standard;
    let mortar = strike(size, scheme, law, Integration::Mortar { basis })?;
    // the farthest that a node of a neighbouring element of the foot is from the corner along the wall
    let lever = lever();
    let element = SIDES[0] / mesh_of(size).0 * 30f64.to_radians().cos() / lever;
    let mut rows = Vec::new();
    for (points, impact) in [("nodes", &nodes), ("mortar", &mortar)] {
        rows.extend(impact.rows(&format!("{name}, {points}"), keeps, element));
        rows.push(Row::at_most(
            format!("{name}, {points}: energy at the end / initial - 1"),
            impact.gain,
            BALANCE,
        ));
    }
    // J = (1 + e) v / (1/m + r²/I): what a lever longer by an element takes
    let turning = lever * lever / gyration();
    rows.push(
        Row::near(
            format!("{name}: impulse, mortar / nodes"),
            mortar.impulse[1] / nodes.impulse[1],
            1.0,
            2.0 * turning / (1.0 + turning) * element,
        )
        .second_formulation(),
    );
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "oblique-bar",
    fact: "a frictionless wall takes no momentum along it from a bar that meets it with a corner, and all ledgers close",
    run: |size| {
        let mut all = Vec::new();
        for (name, scheme, law, keeps) in [
            (
                "energy-momentum, velocity law",
                Scheme::EnergyMomentum(EnergyMomentum {}),
                NOW,
                true,
            ),
            ("theta 0.5, velocity law", theta(0.5), NOW, true),
            (
                "Newmark (0.49, 0.9), displacement law",
                newmark(0.49, 0.9),
                DISPLACEMENT,
                false,
            ),
        ] {
            all.extend(rows(size, name, (scheme, law), keeps)?);
        }
        let set = newmark(0.25, 0.5);
        let trapezoid = strike(Size::Quick, set, DISPLACEMENT, Integration::Node)?;
        let name = "Newmark (0.25, 0.5), displacement law, nodes";
        let [energy, ..] = trapezoid.residuals;
        all.push(Row::at_most(
            format!("{name}: energy residual / largest"),
            energy,
            BALANCE,
        ));
        all.push(Row::near(
            format!("{name}: change of momentum along the wall / initial"),
            trapezoid.along,
            0.0,
            BALANCE,
        ));
        all.push(Row::shown(
            format!("{name}: energy at the end / initial - 1"),
            trapezoid.gain,
        ));
        Ok(all)
    },
};
