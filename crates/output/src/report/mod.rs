//! The report: one page for people, in one file that needs no network.
//!
//! This file has the frame of the page and what stands on top: summary, verdict, model and histories, with the figures inline (so that
//! they follow the light or dark theme of the reader), and the text of the case; the others its tables. What the program of the page
//! shows is in [`carom_pages::page`].

pub(crate) mod anchors;
mod balances;
mod contacts;
mod levels;
mod tables;
mod work;

use std::path::Path;

use carom_pages::html;
use carom_pages::html::{code, each, messages, text, when};
use carom_pages::page::{Data, STYLE};

use crate::report::anchors::section;
use crate::results::{BodyQuality, Tile};
use crate::summary::Summary;
use crate::verdict::{Grade, Verdict};
use crate::{Error, ImpactRow, atomic};

/// What the page shows.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// The summary.
    pub summary: &'a Summary,
    /// The impacts, in their order; or the first of them, if the summary counts more.
    pub impacts: &'a [ImpactRow],
    /// Figures as SVG documents ([`carom_pages::plot::Figure::svg`]).
    pub figures: &'a [String],
    /// The text of the case file.
    pub case: &'a str,
    /// What stands on top.
    pub tiles: &'a [Tile],
    /// Quality of the cells of the bodies.
    pub quality: &'a [BodyQuality],
    /// What the program of the page shows; a page without has its tables and figures alone.
    pub data: Option<&'a Data>,
}

/// Places of plots, with their titles; those without one have none and stand below the plot before.
const PLOTS: [(&str, &str); 12] = [
    ("plot-force", "Contact forces"),
    ("plot-status", ""),
    ("plot-gap", ""),
    ("plot-impulse", ""),
    ("plot-moment", ""),
    ("plot-motion", ""),
    ("plot-probe", "Probes"),
    ("plot-reaction", "Supports"),
    ("plot-load", "Loads"),
    ("plot-energy", "Energies"),
    ("plot-residual", "Residuals"),
    ("plot-spectra", "Spectra"),
];

impl Report<'_> {
    /// The page as HTML.
    ///
    /// # Errors
    /// [`Error::Json`].
    pub fn html(&self) -> Result<String, Error> {
        let summary = self.summary;
        let texts = self.data.map(Data::texts).transpose()?;
        let plots = self.data.map(sections).unwrap_or_default();
        Ok([
            html::head(&summary.title, &format!("\n{STYLE}"), ""),
            self.header(),
            self.navigation(&plots),
            "<main>\n".to_owned(),
            format!(
                "<section class=\"tiles\" aria-label=\"Main results\">\n{}</section>\n\n",
                each(self.tiles, tile)
            ),
            verdict(&summary.verdict),
            warnings(summary),
            self.model(),
            self.histories(&plots),
            contacts::table(summary),
            levels::levels(summary),
            levels::allowables(summary),
            levels::statistics(summary),
            levels::strongest(summary),
            tables::expectations(summary),
            tables::impacts(summary, self.impacts),
            tables::discrete(summary),
            tables::bolts(summary),
            tables::loads(summary),
            tables::exact(summary),
            balances::tables(summary),
            work::zones(summary),
            work::quality(summary, self.quality),
            work::work(summary),
            self.end(),
            texts.as_ref().map_or(String::new(), html::program),
            "</body>\n</html>".to_owned(),
        ]
        .concat())
    }

    /// Writes the page as one file, whole or not at all.
    ///
    /// # Errors
    /// As [`Report::html`], and [`Error::File`].
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        atomic::write_text(path, &self.html()?)
    }

    fn header(&self) -> String {
        let summary = self.summary;
        let contacts = match summary.contacts.len() {
            count if count > contacts::FEW => format!(" · {count} contacts"),
            _ => each(&summary.contacts, |(name, contact)| {
                format!(" · {}: {}", text(name), text(&contact.law))
            }),
        };
        format!(
            "<header>
<h1>{}</h1>
<p class=\"faint\">{}{contacts} · carom {} · case {}</p>
</header>

",
            text(&summary.title),
            text(&summary.scheme),
            text(&summary.version),
            text(&summary.case_hash),
        )
    }

    fn navigation(&self, plots: &[&str]) -> String {
        let summary = self.summary;
        let has_model = self.data.is_some_and(|data| data.page.model.is_some());
        let link = |id: &str, title: &str| format!("<a href=\"#{id}\">{title}</a>\n");
        let of_plots = PLOTS
            .iter()
            .filter(|(id, title)| !title.is_empty() && plots.contains(id));
        let before = [(has_model, "model", "Model")];
        let after = [
            (!summary.contacts.is_empty(), "contacts", "Contacts"),
            (!summary.levels.is_empty(), "levels", "Levels"),
            (!summary.allowables.is_empty(), "allowables", "Allowables"),
            (
                summary.expectations.is_some(),
                "expectations",
                "Expectations",
            ),
            (!self.impacts.is_empty(), "impacts", "Impacts"),
            (summary.exact.is_some(), "exact", "Exact solution"),
            (true, "balances", "Balances"),
            (!self.quality.is_empty(), "quality", "Mesh"),
            (true, "work", "Work"),
        ];
        let links = |list: &[(bool, &str, &str)]| {
            each(
                list.iter().filter(|(exists, ..)| *exists),
                |(_, id, title)| link(id, title),
            )
        };
        [
            "<nav aria-label=\"Sections of the report\">".to_owned(),
            links(&before),
            each(of_plots, |(id, title)| link(id, title)),
            links(&after),
            "<a href=\"#case\">Case file</a></nav>\n\n".to_owned(),
        ]
        .concat()
    }

    fn model(&self) -> String {
        let Some(model) = self.data.and_then(|data| data.page.model.as_ref()) else {
            return "<a id=\"model\"></a>\n".to_owned();
        };
        let decimated = match model.decimated_from {
            None | Some(0) => String::new(),
            Some(all) => format!(
                "<p class=\"faint\">Drawn with {} of the {all} nodes of the surface; the cells with the largest stress of an instant are among them where they lie on it.</p>",
                model.nodes
            ),
        };
        format!("<section id=\"model\">
<h2>Model</h2>
<p id=\"model-note\" class=\"faint\" hidden></p>
<div id=\"model-app\" role=\"group\" aria-label=\"Model at the kept instants\" hidden>
<div id=\"model-time\"></div>
<div id=\"model-view\" role=\"img\" aria-label=\"The model, coloured by a field; its largest values are in the tiles above\"></div>
<div id=\"model-legend\"></div>
<div id=\"model-settings\"></div>
<p id=\"model-pick\" class=\"faint\">Click at a node to read its values. Stresses are means of cells, and only those of the kept instants.</p>
{decimated}
</div>
</section>
")
    }

    fn histories(&self, plots: &[&str]) -> String {
        let has_any = !self.figures.is_empty() || !plots.is_empty();
        let place = |(id, title): &(&str, &str)| {
            let is_titled = !title.is_empty() && plots.contains(id);
            let role = when(is_titled, || {
                format!(" role=\"group\" aria-label=\"{title}\"")
            });
            let head = when(is_titled, || {
                format!("<h3 class=\"live-only\">{title}</h3>")
            });
            format!("<div id=\"{id}\" class=\"section\"{role}>{head}</div>\n")
        };
        [
            "<section id=\"plots\" aria-label=\"Histories\">\n".to_owned(),
            when(has_any, || "<h2>Histories</h2>".to_owned()),
            "\n<div class=\"still\">".to_owned(),
            each(self.figures, |figure| format!("\n<figure>{figure}</figure>\n")),
            "</div>\n".to_owned(),
            when(!plots.is_empty(), || "<p class=\"faint live-only\">Point at a curve to read it; drag to zoom all plots, double click to show all; click to set the instant of the model. Dotted lines: first closing, largest force, last release. Extremes are those of the raw signal.</p>".to_owned()),
            "\n".to_owned(),
            each(&PLOTS, place),
            "</section>\n".to_owned(),
        ].concat()
    }

    fn end(&self) -> String {
        let file = |file: &String| {
            let file = text(file);
            format!("<li><a href=\"{file}\">{file}</a></li>")
        };
        let files = when(!self.summary.outputs.is_empty(), || {
            let files = each(&self.summary.outputs, file);
            format!("\n<h2>Files</h2>\n<ul class=\"plain\">{files}</ul>\n")
        });
        let case = text(self.case);
        format!("<h2 id=\"case\">Case</h2>\n<pre class=\"long\">{case}</pre>\n{files}\n</main>\n")
    }
}

/// The sections of the page that have plots.
fn sections(data: &Data) -> Vec<&'static str> {
    let plots = data.page.plots.iter().map(|plot| plot.id);
    plots
        .chain(data.page.raster.as_ref().map(|raster| raster.id))
        .collect()
}

fn tile(tile: &Tile) -> String {
    let time = tile
        .time
        .map_or(String::new(), |time| format!(" data-time=\"{time}\""));
    let field = when(!tile.field.is_empty(), || {
        format!(" data-field=\"{}\"", text(tile.field))
    });
    format!(
        "<a class=\"tile {}\" href=\"#{}\"{time}{field}><span class=\"label\">{}</span><strong>{}</strong><span class=\"note\">{}</span></a>\n",
        tile.grade,
        tile.section,
        text(tile.label),
        text(&tile.value),
        text(&tile.note)
    )
}

fn verdict(verdict: &Verdict) -> String {
    let of_grade = |grade: Grade| verdict.lines.iter().filter(move |line| line.grade == grade);
    let link = |name: &str, sentence: &str| {
        format!("<a href=\"#{}\">{}</a>", section(name), code(sentence))
    };
    let marked = |grade: Grade| {
        let word = grade.word();
        each(of_grade(grade), |line| {
            let link = link(&line.name, &line.sentence);
            let remedy = code(&line.remedy);
            format!("<li><b class=\"{word}\">{word}</b> {link}. Remedy: {remedy}</li>\n")
        })
    };
    let good = |line: &crate::verdict::Line| {
        let link = link(&line.name, &line.sentence);
        format!("<li><b class=\"good\">good</b> {link}</li>\n")
    };
    let told = match verdict.grade {
        Grade::Good => "Good: the run is complete and every line is within its bounds.",
        Grade::Look => "Look at the lines below before you use the result.",
        Grade::Bad => "Not to be relied on.",
    };
    [
        format!(
            "<section id=\"verdict\" class=\"verdict {}\" aria-label=\"Verdict\">\n<strong>{told}</strong>\n<ul>\n",
            verdict.grade.word()
        ),
        each(&verdict.unfinished, |why| {
            format!("<li><b class=\"bad\">bad</b> {}</li>\n", code(why))
        }),
        marked(Grade::Bad),
        marked(Grade::Look),
        each(&verdict.unchecked, |what| {
            format!("<li><b class=\"faint\">not checked</b> {}</li>\n", code(what))
        }),
        "</ul>\n<details><summary>The lines that are good, with their numbers and bounds</summary><ul>\n".to_owned(),
        each(of_grade(Grade::Good), good),
        "</ul></details>\n</section>\n".to_owned(),
    ]
    .concat()
}

fn warnings(summary: &Summary) -> String {
    let all = summary.warnings.iter().chain(&summary.notices);
    let all: Vec<String> = all.map(|warning| code(warning)).collect();
    let warnings = messages("Warnings", &all);
    when(!all.is_empty(), || warnings + "\n") + "\n"
}
