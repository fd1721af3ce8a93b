//! A rigid body that spins freely.
//!
//! Problem: principal moments of inertia 1, 2, 3 kg m², one revolution per second about the middle axis and a thousandth of it about
//! each of the others, about which it tumbles over again and again; 40 steps a revolution. Closed facts: the energy and the
//! angular momentum in space stay. Second problem: moments 1, 1, 2 kg m², angular velocity (1, 0, 2) rad/s: about its axes it
//! is (cos 2t, sin 2t, 2) rad/s, and the axis of the body turns about the angular momentum L by |L|/J₁.
//!
//! Tolerances: 1e-10 over the whole run, as the issue has it, since the mid-point rule with Cayley's map keeps both exactly and
//! iterations end at rounding: 4e4 steps that err by 1e-15 each, at random, are 2e-13, all of one sign 4e-11. The
//! angular velocity and the axis err by the square of the step: ratio 4 within 2 % from 200 to 400 steps.

use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::Vec3;
use carom_bodies::{Inertia, Kinematics};
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Driver, Model, ModelRigid, Scheme};
use carom_materials::Elastic;
use carom_mesh::generate;

use crate::Error;
use crate::build::{body, newmark, theta};
use crate::check::{Check, Row, Size};
use crate::kept::Kept;

/// Only the mesh that the body carries needs one.
const MATERIAL: Elastic = Elastic {
    density: 1.0,
    young: 1.0,
    poisson: 0.0,
};
/// Tolerance that no iteration reaches.
const ROUNDING: f64 = 1e-15;
const STEPS: usize = 40;

fn driver(moments: [f64; 3], spin: [f64; 3], scheme: Scheme, dt: f64) -> Result<Driver, Error> {
    let mesh = generate::box_("top", [-0.5; 3], [1.0; 3], [1, 1, 1], false);
    let mut top = body(&mesh, "top", Kinematics::Solid, MATERIAL)?;
    top.rigid = Some(ModelRigid {
        inertia: Inertia {
            mass: 1.0,
            centre: [0.0; 3],
            moments,
            axes: Rotation::IDENTITY,
        },
        spin,
    });
    let mut model = Model::new(vec![top], mesh, scheme, dt);
    model.nonlinear.iteration.tolerance = ROUNDING;
    Ok(Driver::new(crate::witness::system(model)?)?)
}

/// Largest changes over some revolutions about the middle axis, and how often the body has turned over.
fn tumble(scheme: Scheme, revolutions: usize) -> Result<(Kept, usize), Error> {
    let rate = 2.0 * std::f64::consts::PI;
    let spin = [1e-3 * rate, rate, 1e-3 * rate];
    let mut driver = driver([1.0, 2.0, 3.0], spin, scheme, 1.0 / STEPS as f64)?;
    let kept = Kept::new(driver.system(), driver.state());
    let mut kept = kept.scaled_by(2.0 * rate);
    let (mut turns, mut sign) = (0, 1.0);
    for _ in 0..STEPS * revolutions {
        driver.step()?;
        kept.follow(driver.state());
        let middle = driver.state().motion.v[4];
        if middle * sign < -0.5 * rate {
            (turns, sign) = (turns + 1, -sign);
        }
    }
    Ok((kept, turns))
}

/// Errors of the angular velocity, and of the direction of the axis, of the symmetric top after a second.
fn precession(scheme: Scheme, steps: usize) -> Result<[f64; 2], Error> {
    let mut driver = driver([1.0, 1.0, 2.0], [1.0, 0.0, 2.0], scheme, 1.0 / steps as f64)?;
    for _ in 0..steps {
        driver.step()?;
    }
    let motion = &driver.state().motion;
    let spin = Vec3::new(motion.v[3], motion.v[4], motion.v[5]);
    let exact = Vec3::new(2.0_f64.cos(), 2.0_f64.sin(), 2.0);
    let momentum = Vec3::new(1.0, 0.0, 4.0);
    let about = momentum.normalize();
    // Rodrigues' formula for the axis, which is at z first
    let (angle, axis) = (momentum.norm(), Vec3::z());
    let turned = axis * angle.cos()
        + about.cross(&axis) * angle.sin()
        + about * about.dot(&axis) * (1.0 - angle.cos());
    let found = motion.frames[0].matrix() * Vec3::z();
    Ok([(spin - exact).norm(), (found - turned).norm()])
}

pub(crate) const CHECK: Check = Check {
    name: "rigid-top",
    fact: "a free rigid body keeps energy and angular momentum over a thousand revolutions, and precesses as Euler's equations say",
    run: |size| {
        let (revolutions, few) = match size {
            Size::Quick => (30, 30),
            Size::Full => (1000, 100),
        };
        let mut rows = Vec::new();
        let kept_exactly = [
            ("energy-momentum", Scheme::EnergyMomentum(EnergyMomentum {})),
            ("theta 0.5", theta(0.5)),
        ];
        for (name, scheme) in kept_exactly {
            let (kept, turns) = tumble(scheme, revolutions)?;
            let row = |what: &str| {
                format!("{name}, {revolutions} revolutions: largest change of {what}, relative")
            };
            rows.push(Row::at_most(row("angular momentum"), kept.angular, 1e-10));
            rows.push(Row::at_most(row("energy"), kept.energy, 1e-10));
            let name = format!("{name}: times that the body has turned over");
            rows.push(Row::at_least(name, turns as f64, 1.0));
        }
        let (kept, _) = tumble(newmark(0.25, 0.5), few)?;
        let row =
            |what: &str| format!("newmark, {few} revolutions: largest change of {what}, relative");
        rows.push(Row::shown(row("angular momentum"), kept.angular));
        rows.push(Row::shown(row("energy"), kept.energy));
        let of_second_order = [("theta 0.5", theta(0.5)), ("newmark", newmark(0.25, 0.5))];
        for (name, scheme) in of_second_order {
            let [coarse, fine] = [precession(scheme, 200)?, precession(scheme, 400)?];
            for (k, what) in ["angular velocity", "axis of the body"].iter().enumerate() {
                let row = format!("{name}: error of the {what}, 200 over 400 steps");
                rows.push(Row::near(row, coarse[k] / fine[k], 4.0, 0.08));
            }
        }
        Ok(rows)
    },
};
