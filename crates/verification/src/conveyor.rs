//! A crate that is set down on a belt.
//!
//! Problem: `cases/conveyor`: a rubber crate of 0.4 m by 0.2 m, plane strain, neo-Hooke, E = 10 MPa, ν = 0.3, ρ = 1000 kg/m³, stands at
//! rest on a belt that runs at 2 m/s, μ = 0.4, g = 9.81 m/s². The belt is an imported surface of 32 facets that moves; the
//! same with a rigid plane that moves. Velocity law, theta = 0.6, dt = 1 ms, 0.8 s.
//! Closed solution: seen from the belt a mass point thrown backwards on a level plane, `carom_exact::friction::Incline`: it slides for
//! v/(μ g) = 0.51 s. The belt does the work m v², of which half is heat.
//!
//! Tolerances: the weight comes at once, so that the crate hops and shears as it slides, with pressure and slip of its nodes in
//! step. What impacts of nodes and the scheme take of this is in the ledger apart and belongs to what is not motion at the end:
//! with the heat it is half of the belt's work. 0.2 % of both are left to the hops. The place may be off by the way of one step, 2 mm,
//! the speed at the end by 1e-4. The facets are flat and in line, so that with a plane, a second formulation, rounding alone differs: 1e-9 m.
//! Balances as for the sliding block.

use carom_bodies::Kinematics;
use carom_contact::{Motion, Obstacle, Plane, RigidSurface, Translation};
use carom_dynamics::{Driver, Model, ModelTarget};
use carom_exact::friction::Incline;
use carom_materials::Elastic;
use carom_mesh::{Mesh, Surface};

use crate::Error;
use crate::build::{NOW, contact, group, neo_hooke, surface, theta};
use crate::check::{Check, Row};
use crate::meshes;
use crate::sliding_block::{GRAVITY, balances, place};

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e7,
    poisson: 0.3,
};
const MU: f64 = 0.4;
const BELT: f64 = 2.0;
const STEP: f64 = 1e-3;
const STEPS: usize = 800;

fn newton(mesh: Mesh, belt: Obstacle) -> Result<Driver, Error> {
    let crate_ = neo_hooke(
        &mesh,
        "crate",
        Kinematics::PlaneStrain { thickness: 1.0 },
        RUBBER,
    )?;
    let belt = Obstacle {
        motion: Motion {
            translation: Some(Translation::Velocity([BELT, 0.0, 0.0])),
            turn: None,
        },
        ..belt
    };
    let foot = surface(&mesh, "crate.bottom", &crate_)?;
    let mut rubbing = contact(foot, ModelTarget::Rigid(belt), NOW);
    rubbing.friction = MU.into();
    Ok(Driver::new(crate::witness::system(Model {
        contacts: vec![rubbing],
        gravity: [0.0, -GRAVITY, 0.0],
        ..Model::new(vec![crate_], mesh, theta(0.6), STEP)
    })?)?)
}

pub(crate) const CHECK: Check = Check {
    name: "conveyor",
    fact: "a crate that is set down on a belt slides until it has the speed of the belt, and half of the belt's work is heat",
    run: |_| {
        let mesh = meshes::mesh("conveyor/crate.msh")?;
        let facets = Surface::of_facets(&mesh, group(&mesh, "belt")?, false)?;
        let facets = RigidSurface::new(&mesh, &facets);
        let plane = Plane {
            point: [0.0; 3],
            normal: [0.0, 1.0, 0.0],
        };
        let mut runs = [
            newton(mesh.clone(), facets.into())?,
            newton(mesh, plane.into())?,
        ];
        for newton in &mut runs {
            for _ in 0..STEPS {
                newton.step()?;
            }
        }
        let [x, v] = place(&runs[0], runs[0].state()).map(|of| of[0]);
        let [on_plane, _] = place(&runs[1], runs[1].state()).map(|of| of[0]);
        let seen = Incline {
            angle: 0.0,
            mu: MU,
            gravity: GRAVITY,
            velocity: -BELT,
        };
        let time = STEPS as f64 * STEP;
        let exact = BELT * time + seen.at(time).0;
        let balance = &runs[0].state().ledger.balance;
        let work = runs[0].system().body_mass(0) * BELT * BELT;
        let taken =
            balance.dissipation_friction + balance.dissipation_scheme - balance.work_contact;
        let mut rows = vec![
            Row::near("way of the crate, m", x, exact, BELT * STEP),
            Row::relative("its speed at the end, m/s", v, BELT, 1e-4),
            Row::relative("work of the belt, J", balance.work_obstacles, work, 2e-3),
            Row::shown("heat, J", balance.dissipation_friction),
            Row::relative(
                "heat, and what impacts and the scheme take, J",
                taken,
                0.5 * work,
                2e-3,
            ),
            Row::near("way less that on a plane, m", x - on_plane, 0.0, 1e-9).second_formulation(),
        ];
        rows.extend(balances("facets", &runs[0]));
        rows.extend(balances("plane", &runs[1]));
        Ok(rows)
    },
};
