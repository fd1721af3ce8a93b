//! The energy that links make or take.
//!
//! Problem: a bar of 76 h_s with free ends, its first 40 h_s in elements of h_s / 4, overlap 4 h_s, theta ½ inside, so that
//! no scheme dissipates, outer step 0.8 h_s / c; a pulse v = exp(-((x - x0)/w)²) runs ten times through the overlap, to and
//! fro. What the energy of the schemes changes is then the work of the links, summed over both sides.
//!
//! Closed solution: none is made or taken. With the trapezoid outside and one step (gc) both sides move by the mean of the
//! same velocities under the same forces: to rounding. Otherwise the two means differ, by more the shorter the waves, and
//! energy comes and goes as long as waves are in the overlap; it does not add up: 40 transits gave the same largest
//! exchange as ten. With pointwise multipliers (gc) and more than one step the free velocities of the outer side are
//! interpolated, which takes energy at each transit.
//!
//! Order: means of one velocity over different spans differ by the second order of step over period, so that the largest
//! exchange falls to a quarter when the width doubles; three quarters of the exponent are asked for, the rest is left to the
//! shortest pulse.
//!
//! Another code: the project's theory note, section 5: ph exchanges at most 0.2 %; gc with m > 1 loses 1 / 9 / 27 % at
//! w = 8 / 4 / 2 h_s. The note says neither m nor the step. Its 0.2 % holds but for the trapezoid outside and w = 2 h_s, whose
//! waves the coarse mesh hardly carries. m = 4 and the step above give 2.7, 9.4 and 26.6 %; other set-ups (m = 4 and 10,
//! steps from 0.5 to 0.9 h_s / c, bars of 76 and 100 h_s, h_s / h_c = 2 and 4) lose 1.8 to 3.1 % of the widest pulse, never the
//! note's 1 %. Since the set-up was chosen by its result, these losses are regressions, as is the work on the shortest
//! pulse where the note says nothing or does not hold: all to 1 % of the figure.

use carom_dynamics::Scheme;
use carom_dynamics::scheme::Newmark;
use carom_zones::LinkKind;

use crate::Error;
use crate::build::CENTRAL;
use crate::check::{Check, Row};
use crate::glued_bar::{GluedBar, motion, pulse};

const TRANSITS: f64 = 10.0;
const SHORTEST: f64 = 2.0;
const WIDTHS: [f64; 3] = [8.0, 4.0, SHORTEST];
const GC: LinkKind = LinkKind::GravouilCombescure;
const PH: LinkKind = LinkKind::PrakashHjelmstad;
const TRAPEZOID: Scheme = Scheme::Newmark(Newmark {
    beta: 0.25,
    gamma: 0.5,
});

pub(crate) const CHECK: Check = Check {
    name: "arlequin-energy",
    fact: "links take no energy from long waves, but with pointwise multipliers and more than one step what the note says",
    run: |_| {
        let mut rows = Vec::new();
        rows.extend(kept()?);
        for exchange in EXCHANGES {
            rows.extend(exchange.rows()?);
        }
        rows.extend(taken()?);
        Ok(rows)
    },
};

/// One step and the trapezoid on both sides: nothing is exchanged.
fn kept() -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for width in WIDTHS {
        let name = format!("gc, trapezoid, m = 1, w = {width} h");
        let run = transits(GC, 1, TRAPEZOID, width)?;
        let what = format!("{name}: largest exchange");
        rows.push(Row::at_most(what, run.largest, 1e-13));
        rows.extend(run.closed(&name));
    }
    Ok(rows)
}

/// Links that exchange energy with the waves in the overlap.
struct Exchange {
    name: &'static str,
    kind: LinkKind,
    substeps: u32,
    outer: Scheme,
    /// Whether the note's 0.2 % is about this one.
    noted: bool,
    /// The work over the initial energy that was found for the shortest pulse, where it is above 0.2 %.
    shortest: Option<f64>,
}

const EXCHANGES: [Exchange; 3] = [
    Exchange {
        name: "gc, explicit, m = 1",
        kind: GC,
        substeps: 1,
        outer: CENTRAL,
        noted: false,
        shortest: Some(0.0129204),
    },
    Exchange {
        name: "ph, explicit, m = 4",
        kind: PH,
        substeps: 4,
        outer: CENTRAL,
        noted: true,
        shortest: None,
    },
    Exchange {
        name: "ph, trapezoid, m = 4",
        kind: PH,
        substeps: 4,
        outer: TRAPEZOID,
        noted: true,
        shortest: Some(-0.0136095),
    },
];

impl Exchange {
    fn rows(&self) -> Result<Vec<Row>, Error> {
        let (mut rows, mut before) = (Vec::new(), None);
        for width in WIDTHS.into_iter().rev() {
            let run = transits(self.kind, self.substeps, self.outer, width)?;
            let name = format!("{}, w = {width} h", self.name);
            let work = format!("{name}: work");
            match self.shortest {
                Some(own) if width == SHORTEST => {
                    rows.push(Row::relative(work, run.work, own, 0.01).regression());
                }
                _ if self.noted => rows.push(Row::near(work, run.work, 0.0, 0.002).other_code()),
                _ => rows.push(Row::shown(work, run.work)),
            }
            if let Some(before) = before {
                let what = format!("{name}: largest exchange / that of half the width");
                rows.push(Row::at_most(what, run.largest / before, 0.5_f64.powf(1.5)));
            }
            before = Some(run.largest);
            rows.extend(run.closed(&name));
        }
        Ok(rows)
    }
}

/// Pointwise multipliers and four inner steps: energy is taken at each transit.
fn taken() -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for (width, own) in WIDTHS.into_iter().zip([0.0271896, 0.0935497, 0.265680]) {
        let name = format!("gc, explicit, m = 4, w = {width} h");
        let run = transits(GC, 4, CENTRAL, width)?;
        let lost = format!("{name}: lost");
        rows.push(Row::relative(lost, -run.work, own, 0.01).regression());
        rows.extend(run.closed(&name));
    }
    Ok(rows)
}

/// Figures over the initial energy.
struct Transits {
    /// Net work of the links at the end.
    work: f64,
    /// Largest net work so far.
    largest: f64,
    /// Largest residual of the ledger.
    residual: f64,
    /// Largest change of the energy that the schemes conserve, less the work of the links.
    unaccounted: f64,
}

impl Transits {
    fn closed(&self, name: &str) -> [Row; 2] {
        let what = "energy made or lost but by links";
        [
            Row::at_most(format!("{name}: ledger residual"), self.residual, 1e-11),
            Row::at_most(format!("{name}: {what}"), self.unaccounted, 1e-11),
        ]
    }
}

fn transits(kind: LinkKind, substeps: u32, outer: Scheme, width: f64) -> Result<Transits, Error> {
    let usual = GluedBar::usual(76);
    let bar = GluedBar {
        kind,
        substeps,
        courant: 0.8,
        schemes: [usual.schemes[0], outer],
        ..usual
    };
    let mut zones = crate::witness::zones(&bar.zoned()?)?;
    let start = motion(&zones, pulse(18.0, width));
    zones.restart(&start)?;
    let first = zones.balance();
    let mut run = Transits {
        work: 0.0,
        largest: 0.0,
        residual: 0.0,
        unaccounted: 0.0,
    };
    while zones.time() < TRANSITS * bar.length as f64 {
        zones.step()?;
        let now = zones.balance();
        let change = now.energy() + now.scheme_energy - first.energy() - first.scheme_energy;
        run.work = now.work_links / first.energy();
        run.largest = run.largest.max(run.work.abs());
        run.residual = run
            .residual
            .max((now.energy_residual / first.energy()).abs());
        run.unaccounted = run
            .unaccounted
            .max((change - now.work_links).abs() / first.energy());
    }
    Ok(run)
}
