//! The files of a comparison: table, figures, page.

use std::path::PathBuf;

use carom_output::table::{Table, write_csv};
use carom_output::{Absent, Error, Folder, atomic};
use carom_pages::form::NOTHING;
use carom_pages::html::{self, class, code, each, head, line, messages, quantity, text, wide};
use carom_pages::page::STYLE;
use carom_pages::plot::unless_empty;

use crate::compare::figures::{figures, page};
use crate::compare::{Comparison, Standard, Variant, columns};

impl Comparison {
    /// The table for people.
    pub fn table(&self) -> Table {
        columns::table(&self.variants)
    }

    /// The empty cells of the table, each with its reason.
    pub fn absent(&self) -> Vec<Absent> {
        columns::absent(self)
    }

    /// Writes `comparison.csv`, the figures `plots/*.svg` and `report.html` into the folder; returns the path of the page.
    ///
    /// # Errors
    /// The first file that could not be written.
    pub fn write(&self, folder: &mut Folder) -> Result<PathBuf, Error> {
        let verdicts: Vec<_> = self.variants.iter().map(|v| v.verdict()).collect();
        let rows = self.variants.iter().zip(&verdicts);
        let rows: Vec<_> = rows
            .map(|(variant, (_, reason))| columns::cells(variant, reason))
            .collect();
        write_csv(&folder.file("comparison.csv")?, &columns::names(), &rows)?;
        let mut drawn = Vec::new();
        for (name, figure) in figures(self) {
            let Some(svg) = unless_empty(figure)? else {
                continue;
            };
            atomic::write_text(&folder.file(name)?, &svg)?;
            drawn.push(svg);
        }
        let page = folder.file("report.html")?;
        atomic::write_text(&page, &self.html(&drawn)?)?;
        Ok(page)
    }

    fn html(&self, figures: &[String]) -> Result<String, carom_pages::Error> {
        let title = format!("{}: comparison", self.title);
        let contact = self
            .contact()
            .map(|name| format!(" · contact {}", text(name)));
        let unseen = self
            .unseen()
            .map(|unseen| format!("<p>{}</p>\n", code(&unseen)));
        let mut done = self.variants.iter().filter_map(Variant::done);
        let window = done.find_map(|done| Some(done.contact()?.window));
        let mean = match self.standard {
            Standard::Run(_) => "mean ",
            Standard::Exact | Standard::Nothing => "",
        };
        let absent = self.absent();
        let absent: Vec<String> = absent.iter().map(|absent| code(&absent.text())).collect();
        let verdicts = self.variants.iter().map(|v| (v.name.as_str(), v.verdict()));
        Ok(format!("{}<header>
<h1>{}</h1>
<p class=\"faint\">{} variants against {}{} · carom {}</p>
</header>

{}{}<p class=\"faint\">Force error: relative L² error, step by step, against the mean of the reference over the step, where the reference has a force.
Overshoot: largest force of a single step relative to the largest {mean}force of the reference, minus one; it does not converge with the mesh where the exact force jumps. Of the mean: the same for the largest mean over {}.
Energy: kinetic and strain energy at the end relative to the start, minus one. By contact: work of the contact forces, negative when lost. Lost by scheme: numerical dissipation.</p>
{}
{}
<section id=\"plots\">
<div class=\"still\">{}</div>
<p class=\"faint live-only\">Point at a curve to read it; drag to zoom all plots, double click to show all. Click at a name to hide or show its curve; at first those of runs graded bad are hidden, which would hide the others.</p>
<div id=\"plot-comparison\"></div>
</section>

<h2>Variants</h2>
{}{}</body>
</html>",
            head(&title, &format!("\n{STYLE}"), " class=\"broad\""),
            text(&title),
            self.variants.len(),
            code(&self.standard_text()),
            contact.unwrap_or_default(),
            env!("CARGO_PKG_VERSION"),
            self.merits(),
            unseen.unwrap_or_default(),
            quantity(window, "s"),
            messages("Reasons", &reasons(verdicts)),
            messages("Empty cells", &absent),
            each(figures, |figure| format!("\n<figure>{figure}</figure>\n")),
            self.changes(),
            html::program(&page(self).texts()?),
        ))
    }

    /// The table of the figures of merit, with the verdicts.
    fn merits(&self) -> String {
        let table = self.table();
        let rows = self.variants.iter().zip(&table.rows);
        let rows = each(rows, |(variant, cells)| {
            verdict_row(variant, "", inner(cells))
        });
        verdict_table("Variant", inner(&table.heads), &rows)
    }

    /// What the variants change.
    fn changes(&self) -> String {
        let rows = each(&self.variants, |variant| {
            let done = variant.done();
            let scheme = done.map(|done| text(&done.summary.scheme));
            let law = done.and_then(|done| Some(text(&done.contact()?.law)));
            let overrides = text(&variant.overrides.join(" · "));
            let shown = [
                scheme.unwrap_or(NOTHING.to_owned()),
                law.unwrap_or(NOTHING.to_owned()),
                overrides,
            ];
            line(
                &variant.name,
                &each(shown, |shown| format!("<td class=\"text\">{shown}</td>")),
            )
        });
        let heads = ["scheme", "law", "changes of the case"];
        let heads = each(heads, |head| format!("<th class=\"text\">{head}</th>"));
        format!(
            "<div class=\"wide\"><table class=\"dense\">\n<thead><tr><th>Variant</th>{heads}</tr></thead>\n<tbody>{rows}\n</tbody></table></div>\n"
        )
    }
}

/// A row of a table of runs: the name, which leads to the page of the run, with what stands before it, the verdict, the cells.
pub(crate) fn verdict_row(variant: &Variant, before: &str, shown: &[String]) -> String {
    let (verdict, _) = variant.verdict();
    let name = text(&variant.name);
    let name = match variant.done() {
        Some(_) => format!("<a href=\"{name}/report.html\">{name}</a>"),
        None => name,
    };
    let cells = each(shown, |cell| format!("<td>{}</td>", text(cell)));
    let class = class(verdict);
    format!(
        "\n<tr><th scope=\"row\">{before}{name}</th><td><b class=\"{class}\">{verdict}</b></td>{cells}</tr>"
    )
}

/// A table of runs.
pub(crate) fn verdict_table(first: &str, names: &[String], rows: &str) -> String {
    let names = names.iter().map(|name| text(name));
    let heads = [first.to_owned(), "verdict".to_owned()];
    let heads: Vec<String> = heads.into_iter().chain(names).collect();
    wide(true, &heads, rows)
}

/// The reasons of verdicts, each after its run.
pub(crate) fn reasons<'a>(
    verdicts: impl Iterator<Item = (&'a str, (&'static str, String))>,
) -> Vec<String> {
    let given = verdicts.filter(|(_, (_, reason))| !reason.is_empty());
    let one = |(name, (verdict, reason)): (&str, (&str, String))| {
        let class = class(verdict);
        format!(
            "{}, <b class=\"{class}\">{verdict}</b>: {}",
            text(name),
            code(&reason)
        )
    };
    given.map(one).collect()
}

/// What stands between the name and the verdict.
pub(crate) fn inner(cells: &[String]) -> &[String] {
    let last = cells.len().saturating_sub(1);
    cells.get(1..last).unwrap_or_default()
}
