//! Runs cut and resumed, and runs on other numbers of threads.
//!
//! Problem: two bars of the set "slow" that part and meet nothing more, and two blocks with meshes that do not match,
//! one coming down sideways on the other, paired at every step; every registered scheme with every law. Closed
//! solution: a state saved as bytes, read back and gone on with by a new driver ends in the bytes of the run that was
//! not cut, wherever the cut falls; a run on one thread ends in those of a run on two. Combinations without meaning are
//! refused: they are exactly the explicit schemes with the displacement law. Reference: the uncut run; the run on one
//! thread. Tolerance: none, bytes are equal or not. For the threads the blocks have some thousand elements, several of
//! the chunks of 256 in which forces are summed.

use std::sync::Arc;

use carom_contact::law::{Adhesion, Capture, Reading, Velocity};
use carom_contact::{Law, Sliding};
use carom_dynamics::{Driver, Model, Scheme, State, System};
use rayon::ThreadPoolBuilder;

use crate::Error;
use crate::bars::{Run, SLOW};
use crate::blocks::{self, RUBBER};
use crate::build::{DISPLACEMENT, damped, velocity};
use crate::check::{Check, Row, Size};

/// Every law with usual parameters, for these elements.
fn laws(material: &carom_materials::Elastic, size: f64) -> Vec<Law> {
    vec![
        DISPLACEMENT,
        damped(material, size, 0.5, Adhesion::Clip),
        damped(material, size, 0.5, Adhesion::AsPrinted),
        velocity(Capture::Now),
        velocity(Capture::Half),
        velocity(Capture::Full),
        Law::Velocity(Velocity {
            capture: Capture::Half,
            reading: Reading::AsPrinted,
        }),
    ]
}

/// What a battery over schemes and laws counts.
#[derive(Default)]
struct Count {
    runs: usize,
    different: usize,
    refused: usize,
    wrongly: usize,
    impacts: usize,
}

impl Count {
    fn rows(&self, name: &str, refused: usize) -> Vec<Row> {
        let row = |what: &str| format!("{name}: {what}");
        vec![
            Row::at_least(row("pairs compared"), self.runs as f64, 1.0),
            Row::count(row("pairs that differ in a byte"), self.different, 0),
            Row::count(row("combinations refused"), self.refused, refused),
            Row::count(row("wrongly refused or taken"), self.wrongly, 0),
            Row::at_least(row("pairs that were in contact"), self.impacts as f64, 1.0),
        ]
    }

    fn compare(&mut self, one: &State, other: &State) -> Result<(), Error> {
        self.runs += 1;
        self.different += usize::from(one.to_bytes()? != other.to_bytes()?);
        let touched = one.records.contacts[0].first_closing.is_some();
        self.impacts += usize::from(touched);
        Ok(())
    }

    /// The system of a scheme and a law, or none if that is refused for the law.
    fn system(
        &mut self,
        scheme: Scheme,
        law: Law,
        model: Model,
    ) -> Result<Option<Arc<System>>, Error> {
        let senseless = scheme.get().is_explicit() && law == DISPLACEMENT;
        match System::new(model) {
            Ok(system) => {
                self.wrongly += usize::from(senseless);
                Ok(Some(system))
            }
            Err(carom_dynamics::Error::DisplacementLaw { .. }) => {
                self.refused += 1;
                self.wrongly += usize::from(!senseless);
                Ok(None)
            }
            Err(error) => Err(error.into()),
        }
    }
}

fn steps(driver: &mut Driver, steps: usize) -> Result<(), Error> {
    for _ in 0..steps {
        driver.step()?;
    }
    Ok(())
}

/// The state after `total` steps, with a cut after `cut` of them if there is one.
fn run(system: &Arc<System>, total: usize, cut: Option<usize>) -> Result<State, Error> {
    let mut driver = Driver::new(system.clone())?;
    if let Some(cut) = cut {
        steps(&mut driver, cut)?;
        let bytes = driver.state().to_bytes()?;
        let state = State::from_bytes(system, &bytes)?;
        driver = Driver::resume(system.clone(), state)?;
        steps(&mut driver, total - cut)?;
    } else {
        steps(&mut driver, total)?;
    }
    Ok(driver.state().clone())
}

/// Cuts at a quarter, a half and three quarters of the run.
fn cuts(count: &mut Count, system: &Arc<System>, total: usize) -> Result<(), Error> {
    let whole = run(system, total, None)?;
    for quarter in 1..4 {
        let resumed = run(system, total, Some(quarter * total / 4))?;
        count.compare(&whole, &resumed)?;
    }
    Ok(())
}

fn resumed() -> Result<Vec<Row>, Error> {
    let (mut bars, mut solids) = (Count::default(), Count::default());
    let refused = Scheme::registered()
        .iter()
        .filter(|scheme| scheme.get().is_explicit())
        .count();
    for scheme in Scheme::registered() {
        for law in laws(&SLOW.material(), SLOW.length / 20.0) {
            let case = Run {
                scheme,
                law,
                ..Run::slow(20)
            };
            if let Some(system) = bars.system(scheme, law, case.model()?)? {
                cuts(&mut bars, &system, 120)?;
            }
        }
        for law in laws(&RUBBER, 0.2) {
            let model = blocks::model(1, scheme, law, Sliding::Finite)?;
            if let Some(system) = solids.system(scheme, law, model)? {
                cuts(&mut solids, &system, 40)?;
            }
        }
    }
    let mut rows = bars.rows("resumed bars", refused);
    rows.extend(solids.rows("resumed blocks", refused));
    Ok(rows)
}

fn threads(size: Size) -> Result<Vec<Row>, Error> {
    let pools = [
        ThreadPoolBuilder::new().num_threads(1).build()?,
        ThreadPoolBuilder::new().num_threads(2).build()?,
    ];
    let (refinement, total) = match size {
        Size::Quick => (4, 12),
        Size::Full => (5, 40),
    };
    let mut count = Count::default();
    let mut refused = 0;
    for scheme in Scheme::registered() {
        let laws = laws(&RUBBER, 0.2 / refinement as f64);
        for law in [laws[0], laws[1], laws[4]] {
            refused += usize::from(scheme.get().is_explicit() && law == DISPLACEMENT);
            let model = || blocks::model(refinement, scheme, law, Sliding::Finite);
            let run = |pool: &rayon::ThreadPool, system: &Arc<System>| {
                pool.install(|| run(system, total, None))
            };
            if let Some(system) = count.system(scheme, law, model()?)? {
                let again =
                    pools[1].install(|| -> Result<_, Error> { Ok(System::new(model()?)?) })?;
                count.compare(&run(&pools[0], &system)?, &run(&pools[1], &again)?)?;
            }
        }
    }
    Ok(count.rows("blocks on two threads", refused))
}

pub(crate) const CHECK: Check = Check {
    name: "resume",
    fact: "runs that were cut, and runs on other numbers of threads, end in the same bytes",
    run: |size| {
        let mut rows = resumed()?;
        rows.extend(threads(size)?);
        Ok(rows)
    },
};
