//! The report: one page for people, in one file that needs no network.
//!
//! The page is `templates/report.html`; this file fills it with the summary, the impacts, the figures (inline, so that
//! they follow the light or dark theme of the reader) and the text of the case, and with what its program shows
//! ([`crate::page`]).

use std::fmt::Write as _;
use std::path::Path;

use minijinja::value::Serde;
use minijinja::{Environment, HtmlEscape, Value, context};

use crate::expectations::Expectations;
use crate::form::{NOTHING, near, percent};
use crate::page::anchors::section;
use crate::page::{Data, PROGRAM, STYLE};
use crate::plot::{digits, quantity, scientific};
use crate::results::{BodyQuality, Tile};
use crate::summary::{Angular, Summary};
use crate::{Error, ImpactRow, atomic};

/// What the page shows.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// The summary.
    pub summary: &'a Summary,
    /// The impacts, in their order; or the first of them, if the summary counts more.
    pub impacts: &'a [ImpactRow],
    /// Figures as SVG documents ([`crate::plot::Figure::svg`]).
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

impl Report<'_> {
    /// The page as HTML.
    ///
    /// # Errors
    /// [`Error::Template`], which would be a fault of the template.
    pub fn html(&self) -> Result<String, Error> {
        let mut environment = environment()?;
        environment.add_template("report.html", include_str!("../templates/report.html"))?;
        let figures: Vec<Value> = self
            .figures
            .iter()
            .cloned()
            .map(Value::from_safe_string)
            .collect();
        let texts = self.data.map(Data::texts).transpose()?;
        let [head, block] = texts.unwrap_or_default();
        let model = self.data.and_then(|data| data.page.model.as_ref());
        let program = self.data.map(|_| PROGRAM.to_owned());
        let contacts = self.summary.contacts.values();
        let impacts: usize = contacts.map(|contact| contact.impacts).sum();
        let page = environment.get_template("report.html")?.render(context! {
            summary => Serde(self.summary),
            expected => Serde(self.summary.expectations.as_ref().map(Expectations::told)),
            impacts => Serde(self.impacts),
            many => self.summary.contacts.values().any(|contact| contact.impacts > 1),
            hidden => impacts.saturating_sub(self.impacts.len()),
            figures,
            moved => self.summary.maxima.displacement.as_ref().map_or(0.0, |most| most.value),
            turning => self.summary.momentum.angular.as_ref().map_or(0.0, Angular::largest),
            case => self.case,
            tiles => Serde(self.tiles),
            quality => Serde(self.quality),
            plots => self.data.map(sections).unwrap_or_default(),
            has_model => model.is_some(),
            decimated => model.and_then(|model| model.decimated_from),
            drawn => model.map(|model| model.nodes),
            head => Value::from_safe_string(head),
            block => Value::from_safe_string(block),
            program => program.map(Value::from_safe_string),
            program_style => Value::from_safe_string(STYLE.to_owned()),
        })?;
        Ok(page)
    }

    /// Writes the page as one file, whole or not at all.
    ///
    /// # Errors
    /// As [`Report::html`], and [`Error::File`].
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        atomic::write_text(path, &self.html()?)
    }
}

/// The sections of the page that have plots.
fn sections(data: &Data) -> Vec<&'static str> {
    let plots = data.page.plots.iter().map(|plot| plot.id);
    plots
        .chain(data.page.raster.as_ref().map(|raster| raster.id))
        .collect()
}

/// What all pages share: the style and the ways to show a number.
///
/// # Errors
/// [`Error::Template`].
pub(crate) fn environment() -> Result<Environment<'static>, Error> {
    let mut environment = Environment::new();
    environment.add_filter("quantity", |value: Value, unit: &str| {
        show(&value, |x| quantity(x, unit))
    });
    environment.add_filter("exact", |value: Value| show(&value, exact));
    environment.add_filter("near", without_rounding);
    environment.add_filter("percent", |value: Value| show(&value, percent));
    environment.add_filter("section", |line: &str| section(line));
    environment.add_filter("code", |text: &str| Value::from_safe_string(code(text)));
    environment.add_filter("bytes", |value: Value| show(&value, bytes));
    environment.add_template("style.css", include_str!("../templates/style.css"))?;
    Ok(environment)
}

/// A message as HTML: what stands between two backticks is code.
fn code(message: &str) -> String {
    let mut html = String::new();
    let parts: Vec<&str> = message.split('`').collect();
    for (k, part) in parts.iter().enumerate() {
        // no line begins with the sign of a per cent
        let part = part.replace(" %", "\u{a0}%");
        let part = HtmlEscape(&part);
        let _ = match k {
            0 => write!(html, "{part}"),
            // a backtick without its other one stands as it is
            k if k % 2 == 1 && k + 1 == parts.len() => write!(html, "`{part}"),
            k if k % 2 == 1 => write!(html, "<code>{}</code>", options(&part.to_string())),
            _ => write!(html, "{part}"),
        };
    }
    html
}

/// Options of a command in words that no line ends within: a browser breaks lines after their dashes.
fn options(code: &str) -> String {
    let words = code.split(' ').map(|word| match word.starts_with("--") {
        true => format!("<span class=\"option\">{word}</span>"),
        false => word.to_owned(),
    });
    words.collect::<Vec<_>>().join(" ")
}

fn show(value: &Value, text: impl Fn(f64) -> String) -> String {
    f64::try_from(value.clone()).map_or_else(|_| NOTHING.to_owned(), text)
}

/// What is rounding beside numbers of this size is zero; what is no number stays as it is.
fn without_rounding(value: Value, size: f64) -> Value {
    match f64::try_from(value.clone()) {
        Ok(number) => Value::from(near(number, size)),
        Err(_) => value,
    }
}

/// A number of a balance: seven digits, or a power of ten where it is very small or very large.
fn exact(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e6).contains(&size) => digits(value, 7),
        size if size.is_finite() => scientific(value, 3),
        _ => value.to_string(),
    }
}

/// A number of bytes with the prefix that people expect.
fn bytes(count: f64) -> String {
    match count {
        count if count >= 1e9 => format!("{:.2} GB", count / 1e9),
        count if count >= 1e6 => format!("{:.1} MB", count / 1e6),
        count if count >= 1e3 => format!("{:.1} kB", count / 1e3),
        _ => format!("{count} B"),
    }
}

#[cfg(test)]
mod tests {
    use super::code;

    #[test]
    fn what_stands_between_backticks_is_code_and_all_is_escaped() {
        for (message, html) in [
            ("plain", "plain"),
            ("run `carom study` now", "run <code>carom study</code> now"),
            ("`a<b` and `c`", "<code>a&lt;b</code> and <code>c</code>"),
            ("one ` alone", "one ` alone"),
            (
                "`carom study --vary a=1`",
                "<code>carom study <span class=\"option\">--vary</span> a=1</code>",
            ),
            ("7 % of 9", "7\u{a0}% of 9"),
            ("", ""),
        ] {
            assert_eq!(code(message), html);
        }
    }
}
