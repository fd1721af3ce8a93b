//! An overlap with thousands of multipliers.
//!
//! Problem: a plate of 1 m × 1 m × 0.5 m in two halves that overlap on 0.1 m, all of it squeezed, theta ½ below, central differences above,
//! with one step for both and with four steps above in one below; meshes that do not match. Closed solution: none; facts instead: the rows join the factor
//! of the lower half, H is never made, and the rows hold. Reference: a dense H of 20 000 rows would take 3.2 GB, its factor as
//! much again; the limit is 4 GiB for all. Tolerance: two passes a step, since nothing is in contact and all is linear, and without H one more for
//! what its iterations leave; forty products with H, which give ten digits for a condition of ten with what preconditions it.
//! The work of the link with four steps is shown: the halves are thrown at each other within one element;
//! balances as for other solids. Work of the link: a regression from above, 1e-3.

use carom_arlequin::{Coupling, Models, Overlap, Region, Weighting};
use carom_bodies::{CellWeights, Kinematics};
use carom_dynamics::{Model, ModelLink};
use carom_materials::{Elastic, Plane};
use carom_mesh::generate;
use carom_zones::{LinkKind, ModelZone, Zoned};

use crate::Error;
use crate::build::{CENTRAL, body, group, theta};
use crate::check::{Check, Row, Size};

const RUBBER: Elastic = Elastic {
    density: 1000.0,
    young: 1e7,
    poisson: 0.3,
};
const GIB: f64 = (1u64 << 30) as f64;

/// Two halves with `n` cells along the sides of the upper one, one more in the lower one,
/// and `m` steps of the upper one in one of the lower.
fn zoned(n: usize, m: u32) -> Result<Zoned, Error> {
    let h = 1.0 / n as f64;
    let layers = |height: f64| (height / h).round() as usize;
    let lower = generate::box_(
        "lower",
        [0.0; 3],
        [1.0, 1.0, 0.3],
        [n + 1, n + 1, layers(0.3)],
        false,
    );
    let upper = [0.0, 0.0, 0.2];
    let mut mesh = lower;
    mesh.merge(
        "upper",
        generate::box_("upper", upper, [1.0, 1.0, 0.3], [n, n, layers(0.3)], false),
    )?;
    let [inner, outer] = ["lower", "upper"].map(|name| group(&mesh, name));
    let (inner, outer) = (inner?.elements.clone(), outer?.elements.clone());
    let models = Models {
        mesh: &mesh,
        inner: &inner,
        outer: &outer,
    };
    let overlap = Overlap::new(models, &Region::Intersection)?;
    let weights = overlap.weights(&Weighting::default())?;
    let mut bodies = Vec::new();
    for (name, weights) in [("lower", weights.inner), ("upper", weights.outer)] {
        let mut part = body(&mesh, name, Kinematics::Solid, RUBBER)?;
        part.spec.weights = Some(CellWeights {
            inertia: weights.inertia,
            stiffness: weights.stiffness,
        });
        part.velocity[2] = if name == "lower" { 1.0 } else { -1.0 };
        bodies.push(part);
    }
    let links = vec![ModelLink {
        name: "plate".to_string(),
        zones: [0, 1],
        rows: overlap.rows(&Coupling::default())?.rows,
    }];
    let zone = |name: &str, body, steps| ModelZone::new(name, vec![body], steps);
    Ok(Zoned {
        zones: vec![
            zone("below", 0, (theta(0.5), 1)),
            zone("above", 1, (CENTRAL, m)),
        ],
        model: Model::new(
            bodies,
            mesh,
            theta(0.5),
            f64::from(m) * 0.5 * h / RUBBER.wave_speed(Plane::Full),
        ),
        links,
        kind: match m {
            1 => LinkKind::GravouilCombescure,
            _ => LinkKind::PrakashHjelmstad,
        },
    })
}

pub(crate) const CHECK: Check = Check {
    name: "arlequin-large",
    fact: "thousands of multipliers, with equal and with unequal steps: no dense matrix of their number",
    run: |size| {
        let (n, rows) = match size {
            Size::Quick => (10, 300.0),
            Size::Full => (40, 20_000.0),
        };
        let mut found = Vec::new();
        for (m, passes) in [(1, 2.0), (4, 3.0)] {
            let name = |what: &str| format!("m = {m}, {what}");
            let mut zones = crate::witness::zones(&zoned(n, m)?)?;
            if size == Size::Quick {
                zones.solve_without_matrix()?;
            }
            let start = zones.balance().energy();
            let steps = 4;
            for _ in 0..steps {
                zones.step()?;
            }
            let balance = zones.balance();
            let made = zones.all_passes() as f64 / f64::from(steps);
            let products = zones.link_products() as f64 / f64::from(steps);
            let energy = balance.energy_residual.abs() / start;
            let work = balance.work_links.abs() / start;
            let bytes = zones.condensed_bytes() as f64 / GIB;
            found.extend([
                Row::at_least(name("rows"), zones.multipliers().len() as f64, rows),
                Row::at_most(name("joined factor, GiB"), bytes, 2.0),
                Row::at_most(name("passes to a step"), made, passes),
                Row::at_most(name("products with H to a step"), products, 40.0),
                Row::at_most(name("energy residual / E0"), energy, 1e-9),
                match m {
                    1 => Row::at_most(name("work of the link / E0"), work, 1e-3).regression(),
                    _ => Row::shown(name("work of the link / E0"), work),
                },
            ]);
        }
        Ok(found)
    },
};
