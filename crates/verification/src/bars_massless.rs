//! Two equal bars, and two blocks, whose contact nodes have no mass.
//!
//! Problem: set "slow", all ends free, n = 200, CFL 0.5, trapezoid with the displacement law; the mass m of each contact
//! node goes to the two next nodes, +2m and -m. The same bar of hexahedra, and two blocks with meshes that do not match,
//! where all other nodes take the mass. The balances under every registered scheme that takes such nodes. Closed solution: F = Z v0 / 2 for 2 L / c; without mass in contact the impact
//! takes no energy. Reference: the project's table of bars in impact, from an independent implementation. Tolerance: a
//! unit of the last digit printed; 1e-11 for the balances. The table has no hexahedra and no blocks: their energy, which
//! contact changes by P Δg / 2 in steps where a point closes or opens, and the force error are regressions, to 1 %.

use carom_contact::Sliding;
use carom_dynamics::{Driver, Scheme};
use carom_system::Error as Refusal;

use crate::Error;
use crate::bars::{Elements, Run};
use crate::blocks::FINER;
use crate::build::{DISPLACEMENT, newmark};
use crate::check::{Check, Row};
use crate::figures::run;

fn blocks(sliding: Sliding, own: f64) -> Result<Vec<Row>, Error> {
    let mut model = FINER.model(newmark(0.25, 0.5), DISPLACEMENT, sliding)?;
    model.contacts[0].massless = true;
    let system = crate::witness::system(model)?;
    let mut driver = Driver::new(system.clone())?;
    let mass = |k: usize| system.body_mass(k);
    let exact = [0.6 * 0.6 * 0.4 * 1000.0, 0.5 * 1000.0];
    while driver.state().step < 60 {
        driver.step()?;
    }
    let ledger = &driver.state().ledger;
    let (start, now) = (&ledger.initial, &ledger.balance);
    let name = |what: &str| format!("blocks, sliding {sliding:?}: {what}");
    let change = now.momentum.linear[2] - start.momentum.linear[2];
    Ok(vec![
        Row::relative(name("mass of the upper, kg"), mass(0), exact[0], 1e-12),
        Row::relative(name("mass of the lower, kg"), mass(1), exact[1], 1e-12),
        Row::at_most(
            name("change of momentum / largest"),
            change.abs() / ledger.largest_momentum,
            1e-12,
        ),
        Row::at_most(
            name("energy residual / E0"),
            ledger.largest_energy_residual / start.energy(),
            1e-11,
        ),
        Row::relative(
            name("energy change"),
            now.energy() / start.energy() - 1.0,
            own,
            0.01,
        )
        .regression(),
    ])
}

pub(crate) const CHECK: Check = Check {
    name: "bars-massless",
    fact: "contact nodes without mass keep the energy and the force under the trapezoid and the displacement law",
    run: |_| {
        let case = Run {
            scheme: newmark(0.25, 0.5),
            law: DISPLACEMENT,
            massless: true,
            ..Run::slow(200)
        };
        let mut rows = Vec::new();
        let (_, figures) = run(&case)?;
        let printed = ["0.067", "0.52", "", "", "0.991", "0.000", ""];
        rows.extend(figures.against("bars", printed));
        rows.extend(figures.balances("bars"));
        rows.push(Row::near("bars: energy change", figures.energy_change, 8e-6, 1e-6).other_code());
        let (_, figures) = run(&Run {
            kind: Elements::Hex8,
            ..case
        })?;
        rows.extend(figures.balances("hexahedra"));
        rows.push(
            Row::near(
                "hexahedra: energy change",
                figures.energy_change,
                7.24985e-6,
                1e-7,
            )
            .regression(),
        );
        rows.push(
            Row::relative(
                "hexahedra: force error",
                figures.force_error,
                0.0464631,
                0.01,
            )
            .regression(),
        );
        for scheme in Scheme::registered() {
            let case = Run {
                scheme,
                elements: 50,
                ..case
            };
            match run(&case) {
                Ok((_, figures)) => rows.extend(figures.balances(&format!("{scheme:?}"))),
                Err(Error::System(
                    Refusal::MasslessContact { .. }
                    | Refusal::DisplacementLaw { .. }
                    | Refusal::GapLaw { .. },
                )) => {}
                Err(error) => return Err(error),
            }
        }
        rows.extend(blocks(Sliding::Small, 6.73068e-4)?);
        rows.extend(blocks(Sliding::Finite, 8.38583e-4)?);
        Ok(rows)
    },
};
