//! The files of a comparison: table, figures, page.

use std::path::PathBuf;

use minijinja::{Value, context};

use crate::compare::figures::{figures, page};
use crate::compare::{Comparison, Standard, columns};
use crate::page::{PROGRAM, STYLE};
use crate::plot::unless_empty;
use crate::report::environment;
use crate::table::{Table, write_csv};
use crate::{Absent, Error, Folder, atomic};

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
        atomic::write_text(&page, &self.html(drawn)?)?;
        Ok(page)
    }

    fn html(&self, figures: Vec<String>) -> Result<String, Error> {
        let mut environment = environment()?;
        environment.add_template(
            "comparison.html",
            include_str!("../../templates/comparison.html"),
        )?;
        let table = self.table();
        let [head, block] = page(self).texts()?;
        let variants: Vec<Value> = self
            .variants
            .iter()
            .zip(&table.rows)
            .map(|(variant, cells)| {
                let (verdict, reason) = variant.verdict();
                let done = variant.done();
                context! {
                    name => variant.name.clone(),
                    overrides => variant.overrides.clone(),
                    cells => inner(cells),
                    verdict,
                    reason,
                    page => done.is_some(),
                    scheme => done.map(|done| done.summary.scheme.clone()),
                    law => done.and_then(|done| Some(done.contact()?.law.clone())),
                }
            })
            .collect();
        let window = self
            .variants
            .iter()
            .find_map(|v| Some(v.done()?.contact()?.window));
        let page = environment
            .get_template("comparison.html")?
            .render(context! {
                title => self.title.clone(),
                standard => self.standard_text(),
                unseen => self.unseen(),
                contact => self.contact(),
                run => matches!(self.standard, Standard::Run(_)),
                heads => inner(&table.heads),
                variants,
                window,
                absent => self.absent().iter().map(Absent::text).collect::<Vec<_>>(),
                head => Value::from_safe_string(head),
                block => Value::from_safe_string(block),
                program => Value::from_safe_string(PROGRAM.to_owned()),
                program_style => Value::from_safe_string(STYLE.to_owned()),
                version => env!("CARGO_PKG_VERSION"),
                figures => figures.into_iter().map(Value::from_safe_string).collect::<Vec<_>>(),
            })?;
        Ok(page)
    }
}

/// What stands between the name and the verdict.
pub(crate) fn inner(cells: &[String]) -> Vec<String> {
    let last = cells.len().saturating_sub(1);
    cells.get(1..last).unwrap_or_default().to_vec()
}
