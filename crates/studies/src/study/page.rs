//! Tables, figure and page of a study.

use std::path::PathBuf;

use carom_output::rows::Cell;
use carom_output::table::{Table, write_csv};
use carom_output::{Absent, Error, Folder, atomic};
use carom_pages::form::NOTHING;
use carom_pages::html::{self, code, each, head, messages, text, texts, when};
use carom_pages::page::STYLE;
use carom_pages::plot::{Logarithmic, Series, quantity, rounded};

use crate::compare::page::{inner, reasons, verdict_row, verdict_table};
use crate::compare::{Done, StepForce};
use crate::study::{Abscissa, Order, Quantity, Run, Source, Study};

/// What is said wherever the raw peak is shown.
pub const RAW_PEAK: &str = "the raw peak of a single step does not converge where the force jumps; use the peak of the mean";

impl Study {
    /// The history that a fit comes nearest to.
    pub(crate) fn wanted(&self) -> Option<&StepForce> {
        self.fitted.as_ref()?.goal.history()
    }

    /// What a fit found, in a line for people; `None` of other studies, and where it found nothing.
    pub fn fitted_text(&self) -> Option<String> {
        self.fitted.as_ref()?.text(&self.runs)
    }

    /// The runs for people: values of the keys, step, quantities.
    pub fn table(&self) -> Table {
        let keys = self.keys.iter().map(|(key, _)| self.head(key).to_owned());
        let quantities = self.shown();
        let names = quantities.iter().map(|quantity| quantity.name().to_owned());
        let heads = [String::new()].into_iter().chain(keys);
        let wanted = self.wanted();
        let heads = heads.chain(["step".to_owned()]).chain(names);
        let heads = heads.chain(wanted.map(|_| "distance".to_owned()));
        let row = |(k, run): (usize, &Run)| {
            let keys = self.keys.iter().map(|(_, values)| values[k].clone());
            let step = run.variant.done().map(|d| d.summary.time.largest_step);
            let step = step.map_or(NOTHING.to_owned(), |step| quantity(step, "s"));
            let cells = quantities.iter().map(|q| match q.of(run) {
                Some(measure) => quantity(measure.value, q.unit()),
                None => NOTHING.to_owned(),
            });
            let name = [run.variant.name.clone()].into_iter();
            let cells = name.chain(keys).chain([step]).chain(cells);
            let distance = wanted.map(|wanted| {
                let done = run.variant.done();
                let distance = done.and_then(|done| done.history.force.distance(wanted));
                distance.map_or(NOTHING.to_owned(), |distance| quantity(distance, ""))
            });
            let cells = cells.chain(distance);
            cells.chain([run.variant.verdict().0.to_owned()]).collect()
        };
        Table {
            heads: heads.chain(["verdict".to_owned()]).collect(),
            rows: self.runs.iter().enumerate().map(row).collect(),
        }
    }

    /// The empty cells of the table, each with its reason.
    pub fn absent(&self) -> Vec<Absent> {
        let done = self.runs.iter();
        let done: Vec<(&Run, &Done)> = done
            .filter_map(|run| Some((run, run.variant.done()?)))
            .collect();
        let cells = self.shown().into_iter().flat_map(|quantity| {
            let empty = done
                .iter()
                .filter(move |(run, _)| quantity.of(run).is_none());
            empty.map(move |(run, done)| {
                (
                    quantity.name(),
                    run.variant.name.as_str(),
                    quantity.reason(done),
                )
            })
        });
        Absent::gather(cells, done.len())
    }

    /// The orders for people.
    pub fn order_table(&self) -> Table {
        let row = |order: &Order| {
            let number =
                |value: Option<f64>| value.map_or(NOTHING.to_owned(), |v| format!("{v:.3}"));
            let error_bar = order.fit.and_then(|fit| fit.error_bar);
            let between: Vec<String> = order.consecutive.iter().map(|p| number(*p)).collect();
            vec![
                order.name(),
                number(order.fit.map(|fit| fit.order)),
                error_bar.map_or(NOTHING.to_owned(), |bar| format!("± {bar:.3}")),
                between.join(", "),
                order.source.text().to_owned(),
                order.extrapolated.map_or(NOTHING.to_owned(), |value| {
                    rounded(value, order.quantity.unit(), 5)
                }),
                order
                    .saturation
                    .map_or(NOTHING.to_owned(), |x| self.abscissa_value(x)),
            ]
        };
        Table {
            heads: [
                "",
                "order",
                "error bar",
                "between neighbours",
                "from",
                "extrapolated",
                "saturated from",
            ]
            .map(str::to_owned)
            .to_vec(),
            rows: self.orders().iter().map(row).collect(),
        }
    }

    /// What the orders are taken against, with its unit.
    pub fn abscissa_text(&self) -> String {
        match (&self.abscissa, self.keys.first()) {
            (Abscissa::Step, _) => "time step (s)".to_owned(),
            (Abscissa::Key, Some((key, _))) => key.clone(),
            (Abscissa::Key, None) | (Abscissa::Nothing, _) => String::new(),
        }
    }

    /// A value of what the orders are taken against, for people.
    fn abscissa_value(&self, x: f64) -> String {
        match self.abscissa {
            Abscissa::Step => quantity(x, "s"),
            Abscissa::Key | Abscissa::Nothing => quantity(x, ""),
        }
    }

    /// Writes `study.csv`, `fit.json` (of a fit), `orders.csv`, `plots/orders.svg` (if there is an order and one axis), `plots/force.svg` (if the
    /// runs have a contact and can be told apart) and `report.html` into the folder; returns the path of the page.
    ///
    /// # Errors
    /// The first file that could not be written.
    pub fn write(&self, folder: &mut Folder) -> Result<PathBuf, Error> {
        self.write_runs(folder)?;
        if let Some(fitted) = &self.fitted {
            let text = fitted.json(&self.runs);
            atomic::write_text(&folder.file("fit.json")?, &text)?;
        }
        let orders = self.orders();
        self.write_orders(folder, &orders)?;
        self.write_envelope(folder)?;
        let figure = self.figure(&orders);
        let one = self.series().len() == 1;
        let drawn = one && figure.series.iter().any(|s| !s.points.is_empty());
        let svg = if drawn { figure.svg().ok() } else { None };
        if let Some(svg) = &svg {
            atomic::write_text(&folder.file("plots/orders.svg")?, svg)?;
        }
        let forces = self.force_figure();
        if let Some(forces) = &forces {
            atomic::write_text(&folder.file("plots/force.svg")?, forces)?;
        }
        let page = folder.file("report.html")?;
        atomic::write_text(&page, &self.html(svg, forces)?)?;
        Ok(page)
    }

    /// The last two parts of a key path, or all of it where another key ends in the same way.
    fn head<'a>(&self, key: &'a str) -> &'a str {
        let short = |key: &'a str| match key.rmatch_indices('.').nth(1) {
            Some((at, _)) => &key[at..],
            None => key,
        };
        let same = self
            .keys
            .iter()
            .filter(|(other, _)| other.ends_with(short(key)));
        if same.count() > 1 {
            key
        } else {
            short(key).trim_start_matches('.')
        }
    }

    /// The quantities that at least one run has.
    fn shown(&self) -> Vec<Quantity> {
        let exists = |q: &Quantity| self.runs.iter().any(|run| q.of(run).is_some());
        Quantity::ALL.into_iter().filter(exists).collect()
    }

    fn write_runs(&self, folder: &mut Folder) -> Result<(), Error> {
        let keys = self.keys.iter().map(|(key, _)| key.clone());
        let mut names: Vec<String> = ["run".to_owned()].into_iter().chain(keys).collect();
        names.extend(["contact", "step_s"].map(str::to_owned));
        for quantity in Quantity::ALL {
            names.push(quantity.column().to_owned());
            names.push(format!("exact.{}", quantity.column()));
        }
        names.extend(self.wanted().map(|_| "distance".to_owned()));
        names.extend(["wall_s", "verdict", "reason"].map(str::to_owned));
        let verdicts: Vec<_> = self.runs.iter().map(|run| run.variant.verdict()).collect();
        let row = |k: usize| {
            let run = &self.runs[k];
            let done = run.variant.done();
            let mut cells = vec![Cell::Text(&run.variant.name)];
            cells.extend(self.keys.iter().map(|(_, values)| Cell::Text(&values[k])));
            let contact = done.and_then(|d| d.history.contact.as_deref());
            cells.push(contact.map_or(Cell::Empty, Cell::Text));
            cells.push(done.map(|d| d.summary.time.largest_step).into());
            for quantity in Quantity::ALL {
                let measure = quantity.of(run);
                cells.push(measure.map(|m| m.value).into());
                cells.push(measure.and_then(|m| m.exact).into());
            }
            if let Some(wanted) = self.wanted() {
                cells.push(done.and_then(|d| d.history.force.distance(wanted)).into());
            }
            let wall = done.and_then(|d| d.summary.timings.get("total").copied());
            let (verdict, reason) = &verdicts[k];
            cells.extend([wall.into(), Cell::Text(verdict), Cell::Text(reason)]);
            cells
        };
        let rows: Vec<Vec<Cell>> = (0..self.runs.len()).map(row).collect();
        write_csv(&folder.file("study.csv")?, &names, &rows)
    }

    fn write_orders(&self, folder: &mut Folder, orders: &[Order]) -> Result<(), Error> {
        let names = [
            "quantity",
            "series",
            "order",
            "standard_error",
            "factor",
            "from",
            "points",
            "extrapolated",
            "saturated_from",
        ];
        let row = |k: usize| {
            let order = &orders[k];
            vec![
                Cell::Text(order.quantity.column()),
                Cell::Text(&order.series),
                order.fit.map(|fit| fit.order).into(),
                order.fit.and_then(|fit| fit.error_bar).into(),
                order.fit.map(|fit| fit.factor).into(),
                Cell::Text(order.source.text()),
                Cell::Number(order.points.len() as f64),
                order.extrapolated.into(),
                order.saturation.into(),
            ]
        };
        let rows: Vec<Vec<Cell>> = (0..orders.len()).map(row).collect();
        write_csv(&folder.file("orders.csv")?, &names, &rows)
    }

    fn figure(&self, orders: &[Order]) -> Logarithmic {
        let series = |order: &Order| {
            let name = order.name();
            Series {
                name: match order.fit {
                    Some(fit) => format!("{name}, order {:.2}", fit.order).replace('-', "−"),
                    None => name,
                },
                points: order.points.clone(),
                law: order.fit.map(|fit| (fit.order, fit.factor)),
            }
        };
        Logarithmic {
            title: format!("{}: errors", self.title),
            abscissa: self.abscissa_text(),
            ordinate: "error, or difference of neighbours".to_owned(),
            series: orders.iter().map(series).collect(),
        }
    }

    fn html(&self, figure: Option<String>, forces: Option<String>) -> Result<String, Error> {
        let title = format!("{}: study", self.title);
        let keys: Vec<&str> = self.keys.iter().map(|(key, _)| key.as_str()).collect();
        let contact = self
            .contact()
            .map(|name| format!(" · contact {}", text(name)));
        let absent = self.absent();
        let absent: Vec<String> = absent.iter().map(|absent| code(&absent.text())).collect();
        let verdicts = self.runs.iter().map(|run| &run.variant);
        let verdicts = verdicts.map(|variant| (variant.name.as_str(), variant.verdict()));
        Ok(format!(
            "{}<header>
<h1>{}</h1>
<p class=\"faint\">{} runs over {}{} · carom {}</p>
</header>

{}{}{}
{}
{}
{}
{}
{}</body>
</html>",
            head(&title, &format!("\n{STYLE}"), " class=\"broad\""),
            text(&title),
            self.runs.len(),
            text(&keys.join(", ")),
            contact.unwrap_or_default(),
            env!("CARGO_PKG_VERSION"),
            self.runs_html(),
            self.forces_html(forces),
            self.envelope_html(),
            messages("Reasons", &reasons(verdicts)),
            messages("Empty cells", &absent),
            self.orders_html(),
            each(figure, |figure| format!("\n<figure>{figure}</figure>\n")),
            html::program(&self.plots().texts()?),
        ))
    }

    /// What a fit found, and the table of the runs.
    fn runs_html(&self) -> String {
        let table = self.table();
        let found = self.fitted.as_ref().map(|fitted| &fitted.found);
        let nearest = found.and_then(|found| Some(found.as_ref().ok()?.run));
        let unfitted = found.and_then(|found| found.as_ref().err());
        let rows = self.runs.iter().zip(&table.rows).enumerate();
        let rows = each(rows, |(k, (run, cells))| {
            let mark = if nearest == Some(k) { "→ " } else { "" };
            verdict_row(&run.variant, mark, inner(cells))
        });
        let wanted = match self.wanted() {
            Some(_) => {
                " Distance: that of the force from the wanted history, relative, L². The errors are those from an exact solution."
            }
            None => "",
        };
        let fitted = self.fitted_text();
        let arrow = when(fitted.is_some(), || {
            " The arrow marks the run that the fit took.".to_owned()
        });
        format!("{}{}<h2>Runs</h2>
{}<p class=\"faint\">Note: {}. Energy change: energy gained without the work of the loads, relative to the initial energy.{wanted}{arrow}</p>
",
            each(&fitted, |fitted| format!("<p><b>Fitted: {}</b></p>\n", text(fitted))),
            each(unfitted, |why| format!("<p><b>Nothing was fitted: {}</b></p>\n", text(why))),
            verdict_table("Run", inner(&table.heads), &rows),
            text(RAW_PEAK),
        )
    }

    /// The contact forces of the runs.
    fn forces_html(&self, forces: Option<String>) -> String {
        if self.contact().is_none() {
            return String::new();
        }
        let (still, live) = match self.wanted() {
            Some(_) => (
                "The pale line is the wanted history, the thin one that of the run nearest to it.",
                "The pale line is the wanted history. ",
            ),
            None => ("All runs over each other.", ""),
        };
        let still = each(forces, |forces| {
            format!(
                "<div class=\"still\"><figure>{forces}</figure>\n<p class=\"faint\">{still}</p></div>\n"
            )
        });
        format!("<section id=\"plots\">
<h2>Contact force</h2>
{still}<p class=\"faint live-only\">{live}Point at a curve to read it; drag to zoom, double click to show all. Click at a name to hide or show its curve; at first those of runs graded bad are hidden, which would hide the others.</p>
<div id=\"plot-study\"></div>
</section>
")
    }

    /// The largest values over all runs.
    fn envelope_html(&self) -> String {
        let envelope = self.envelope_table();
        when(!envelope.rows.is_empty(), || {
            let table = texts(false, &envelope.heads, &envelope.rows);
            format!(
                "\n<h2>Envelope of the runs</h2>\n{table}<p class=\"faint\">Largest values of an impact over all runs, and smallest margins, each with the run that governs. Contacts by themselves are in envelope.csv. A dash under a margin: the level names no allowable; under friction: no contact of it has any.</p>\n"
            )
        })
    }

    /// The orders against step or key.
    fn orders_html(&self) -> String {
        let orders = self.order_table();
        let grid = match self.series().len() > 1 {
            true => "One order for each combination of the values after the first axis. ",
            false => "",
        };
        when(!orders.rows.is_empty(), || {
            let heads = orders.heads.iter().skip(1).cloned();
            let heads = ["Quantity".to_owned()].into_iter().chain(heads);
            let table = texts(false, &heads.collect::<Vec<_>>(), &orders.rows);
            let abscissa = text(&self.abscissa_text());
            format!(
                "\n<h2>Orders against {abscissa}</h2>\n{table}<p class=\"faint\">Order: exponent of a power law through the errors, by least squares of the logarithms; error bar: its standard error. {grid}Errors are relative distances from the exact solution; without an exact solution they are differences of neighbouring runs. A dash under extrapolated: an error, whose limit is zero, or no three runs in a constant ratio; under saturated: the error falls up to the finest run.</p>\n"
            )
        })
    }
}

impl Order {
    /// Quantity and series, for people.
    fn name(&self) -> String {
        match self.series.is_empty() {
            true => self.quantity.name().to_owned(),
            false => format!("{}, {}", self.quantity.name(), self.series),
        }
    }
}

impl Source {
    /// For people.
    pub fn text(self) -> &'static str {
        match self {
            Source::Exact => "exact solution",
            Source::Differences => "differences",
        }
    }
}
