//! The force histories of a study in one figure: those of the runs, or of the nearest one over the history that a fit wants.

use carom_output::results::exact::Polyline;
use carom_pages::page::block::Block;
use carom_pages::page::draft::{self, draft, line, of_runs, zipped};
use carom_pages::page::schema::{Page, SCHEMA};
use carom_pages::page::{self, Data};
use carom_pages::plot::{Axis, Curve, Figure, Panel, Role};

use crate::compare::{Done, StepForce};
use crate::study::{Run, Study};

/// Most runs whose curves one can tell apart.
const MOST: usize = 8;

impl Study {
    /// The figure as SVG; `None` where there is no contact, more runs than can be told apart, or a curve that cannot be drawn.
    pub(crate) fn force_figure(&self) -> Option<String> {
        let done = |run: &Run| Some((run.variant.name.clone(), drawn(run.variant.done()?)?));
        let curves: Vec<(String, Polyline)> = match self.wanted() {
            Some(wanted) => vec![done(self.nearest(wanted)?)?],
            None => self.runs.iter().filter_map(done).collect(),
        };
        if curves.is_empty() || curves.len() > MOST {
            return None;
        }
        let wanted = self.wanted().map(StepForce::curve);
        let wanted = wanted.iter().map(|(x, y)| Curve {
            name: "wanted",
            x,
            y,
            role: Role::Exact,
        });
        let computed = curves.iter().map(|(name, (x, y))| Curve {
            name,
            x,
            y,
            role: Role::Computed,
        });
        let panel = Panel {
            title: self.contact().map(|name| format!("Contact {name}"))?,
            ordinate: Axis {
                quantity: "contact force",
                unit: "N",
            },
            curves: wanted.chain(computed).collect(),
            clip: false,
        };
        let figure = Figure {
            title: format!("{}: force", self.title),
            abscissa: Axis {
                quantity: "time",
                unit: "s",
            },
            panels: vec![panel],
            columns: 1,
        };
        figure.svg().ok()
    }

    /// The plot of the page: the forces of all runs, that which a fit wants under them.
    pub(crate) fn plots(&self) -> Data {
        let done = self.runs.iter();
        let computed = done.filter_map(|run| {
            let (name, done) = (run.variant.name.clone(), run.variant.done()?);
            let line = line(name, "computed", zipped(&drawn(done)?));
            Some((line, done.is_bad()))
        });
        let wanted = self.wanted().map(StepForce::curve);
        let wanted = wanted
            .iter()
            .map(|curve| line("wanted", "exact", zipped(curve)));
        let title = self.contact().map(|name| format!("Contact {name}"));
        let lines = wanted.chain(of_runs(computed.collect())).collect();
        let drafts = title.map(|title| draft("plot-study", title, ("contact force", "N"), lines));
        let ends = self.runs.iter().filter_map(|run| run.variant.done());
        let mut block = Block::default();
        let page = Page {
            schema: SCHEMA,
            abscissa: page::schema::Quantity {
                name: "time".to_owned(),
                unit: "s",
            },
            begin: 0.0,
            end: ends.map(|done| done.summary.time.end).fold(0.0, f64::max),
            events: Vec::new(),
            plots: draft::plots(drafts.into_iter().collect(), &mut block),
            raster: None,
            model: None,
        };
        Data { page, block }
    }

    /// The run whose force is nearest to `wanted` by [`StepForce::distance`].
    fn nearest(&self, wanted: &StepForce) -> Option<&Run> {
        let far = |run: &Run| run.variant.done()?.history.force.distance(wanted);
        let runs = self.runs.iter().filter_map(|run| Some((far(run)?, run)));
        let nearest = runs.min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map(|(_, run)| run)
    }
}

/// The force of a run, if it has a contact and a step.
fn drawn(done: &Done) -> Option<Polyline> {
    let history = &done.history;
    let has = history.contact.is_some() && !history.force_curve.is_empty();
    has.then(|| history.force_curve.columns())
}
