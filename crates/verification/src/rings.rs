//! Two elastic rings that collide.

use carom_bodies::Kinematics;
use carom_contact::{Integration, Law};
use carom_dynamics::scheme::EnergyMomentum;
use carom_dynamics::{Newton, Scheme, System};
use carom_materials::Elastic;

use crate::Error;
use crate::build::{DISPLACEMENT, HALF, NOW, damped, newmark, theta};
use crate::check::{Check, Row, Size};
use crate::collision::Collision;
use crate::kept::Kept;

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e6,
    poisson: 0.3,
};

fn env<T: std::str::FromStr>(name: &str, default: T) -> T { std::env::var(name).ok().and_then(|s| s.parse().ok()).unwrap_or(default) }

pub(crate) const CHECK: Check = Check {
    name: "rings",
    fact: "",
    run: |size| {
        let collision = Collision {
            mesh: match size { Size::Quick => "rings/rings-coarse.msh", Size::Full => "rings/rings.msh" },
            bodies: ["ring1", "ring2"],
            kinematics: Kinematics::PlaneStrain { thickness: 1.0 },
            material: RUBBER,
            velocity: [env("V", 1.5), 0.0, 0.0],
            integration: if env("MORTAR", 1) == 1 { Integration::Mortar { basis: carom_contact::Basis::Standard } } else { Integration::Node },
            depth: 0.1,
        };
        let dt = env("DT", 0.01);
        let steps = env("STEPS", 300usize);
        let size_h = 0.1;
        let law2 = damped(&RUBBER, size_h, 0.5, carom_contact::law::Adhesion::Clip);
        let all = [
            ("em velocity now", Scheme::EnergyMomentum(EnergyMomentum), NOW),
            ("em velocity half", Scheme::EnergyMomentum(EnergyMomentum), HALF),
            ("newmark d", newmark(0.25, 0.5), DISPLACEMENT),
            ("newmark damped", newmark(0.25, 0.5), law2),
            ("newmark v", newmark(0.25, 0.5), NOW),
            ("theta d", theta(0.5), DISPLACEMENT),
            ("theta damped", theta(0.5), law2),
            ("theta v", theta(0.5), HALF),
        ];
        for (name, scheme, law) in all {
            if !name.contains(&env("ONLY", String::new())) { continue; }
            let begin = std::time::Instant::now();
            let system = System::new(collision.model(scheme, law, dt, env("TOL", 1e-11))?)?;
            let mut newton = Newton::new(system)?;
            let mut kept = Kept::new(newton.system(), newton.state());
            let (mut passes, mut halved, mut most) = (0, 0, 0);
            let mut result = Ok(());
            for _ in 0..steps {
                result = newton.step();
                if result.is_err() { break; }
                kept.follow(newton.state());
                passes += newton.residuals().len();
                most = most.max(newton.residuals().len());
                halved += (newton.report().attempts > 1) as usize;
                if env("SHOW", 0) == 1 {
                    let r = &newton.report().contacts[0];
                    println!("{} t {:.4} f {:.4e} gap {:.3e} closed {} changes {} passes {:?} kin {:.6} E {:.10}", newton.state().step, newton.state().time, r.force, r.gap, r.closed, r.status_changes, newton.residuals().iter().map(|r| format!("{r:.0e}")).collect::<Vec<_>>(), newton.report().balance.kinetic, newton.report().balance.energy());
                }
            }
            let state = newton.state();
            let rec = &state.records.contacts[0];
            println!("{name}: steps {} lin {:.1e} ang {:.1e} energy {:.1e} ledger {:.1e} | passes {passes} most {most} halved {halved} | peak {:.4e} impulse {:.5e} pen {:.3e} changes {} strain {:.3} {:?} {:?}", state.step, kept.linear, kept.angular, kept.energy, state.ledger.largest_energy_residual / state.ledger.initial.energy(), rec.peak_force, rec.impulse(), rec.penetration, rec.status_changes, state.ledger.balance.strain / state.ledger.initial.energy(), begin.elapsed(), result.map_err(|e| e.to_string()));
            println!("   {:?}", newton.costs().phases);
        }
        Ok(vec![])
    },
};
