//! Tables of what cases must give, in their pages: the rows of `[expect]` as the case file has them.
//!
//! The table stands between two comments, with the name of the case file beside the page:
//!
//! ```text
//! <!-- expect case.toml -->
//! ...
//! <!-- end of expect -->
//! ```
//!
//! Only the form that the cases of the project have is read: one table `[expect.name]` for each row, one key a line, texts in double
//! quotes on one line.

const BEGIN: &str = "<!-- expect ";
const CLOSE: &str = " -->";
const END: &str = "<!-- end of expect -->";
const HEAD: &str =
    "| row | quantity | expected | tolerance | kind | source |\n|---|---|---|---|---|---|\n";

/// The case file of a line that begins a table.
pub fn named(line: &str) -> Option<&str> {
    line.strip_prefix(BEGIN)?.strip_suffix(CLOSE)
}

/// `page` with its tables anew; `read`: the text of a file by its name beside the page.
pub fn expand(page: &str, read: impl Fn(&str) -> Result<String, String>) -> Result<String, String> {
    let mut out = String::new();
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        out += line;
        out.push('\n');
        let Some(file) = named(line) else { continue };
        if !lines.any(|line| line == END) {
            return Err(format!("`{line}` has no `{END}`"));
        }
        let rows = table(&read(file)?);
        if rows.is_empty() {
            return Err(format!("{file} has no rows of `[expect]`"));
        }
        out += &format!("\n{HEAD}{rows}\n{END}\n");
    }
    Ok(out)
}

/// The rows of a case file.
fn table(case: &str) -> String {
    let mut rows = String::new();
    let mut row: Option<Row> = None;
    for line in case.lines().chain(["["]) {
        if line.starts_with('[') {
            rows.extend(row.take().map(|row| row.text()));
        }
        if let Some(name) = line.strip_prefix("[expect.") {
            row = Some(Row::new(name.trim_end().trim_end_matches(']')));
        } else if let (Some(row), Some((key, value))) = (&mut row, line.split_once('=')) {
            row.keys.push((key.trim(), value.trim().trim_matches('"')));
        }
    }
    rows
}

struct Row<'a> {
    name: &'a str,
    keys: Vec<(&'a str, &'a str)>,
}

impl<'a> Row<'a> {
    fn new(name: &'a str) -> Row<'a> {
        let keys = Vec::new();
        Row { name, keys }
    }

    fn get(&self, key: &str) -> Option<&'a str> {
        let found = self.keys.iter().find(|(own, _)| *own == key);
        found.map(|(_, value)| *value)
    }

    fn text(&self) -> String {
        let quantity = match (self.get("summary"), self.get("column"), self.get("take")) {
            (Some(keys), _, _) => format!("`{keys}`"),
            (None, column, take) => {
                let take = take.unwrap_or_default();
                let take = match take.split_once("at = ") {
                    Some((_, time)) => format!("at {}", time.trim_matches(['"', ' ', '}'])),
                    None => take.to_owned(),
                };
                format!("`{}`, {take}", column.unwrap_or_default())
            }
        };
        let bounds = [("at-least", "at least"), ("at-most", "at most")];
        let bounds = bounds.map(|(key, words)| Some(format!("{words} {}", self.get(key)?)));
        let bounds: Vec<String> = bounds.into_iter().flatten().collect();
        let expected = match self.get("value") {
            Some(value) => value.to_owned(),
            None => bounds.join(", "),
        };
        let kind = self.get("kind").unwrap_or_default().replace('-', " ");
        let source = self.get("source").unwrap_or_default();
        let source = match self.get("reason") {
            Some(reason) => format!("{source}. Tolerance: {reason}"),
            None => source.to_owned(),
        };
        let tolerance = self.get("tolerance").unwrap_or_default();
        // a bare number is a part
        let tolerance = match tolerance.parse::<f64>() {
            Ok(part) => format!("{} %", digits(100.0 * part)),
            Err(_) => tolerance.to_owned(),
        };
        format!(
            "| {} | {quantity} | {expected} | {tolerance} | {kind} | {source} |\n",
            self.name
        )
    }
}

/// A part in per cent without the last bits of its product.
fn digits(value: f64) -> String {
    ((value * 1e9).round() / 1e9).to_string()
}

#[cfg(test)]
mod tests {
    use super::expand;

    #[test]
    fn rows_of_a_case_become_a_table_that_is_written_anew() {
        let case = "[time]\nend = 1\n\n[expect.peak]\nsummary = \"contacts.a.peak_force\"\nvalue = \"2 kN\"\ntolerance = 0.07\nkind = \"closed-form\"\nsource = \"Z v\"\n\n[expect.late]\ncolumn = \"probe.a.displacement_x_m\"\ntake = { at = \"1 ms\" }\nat-least = 1\nat-most = 2\nkind = \"regression\"\nsource = \"a run\"\nreason = \"round-off\"\n\n[output]\n";
        let read = |file: &str| match file {
            "case.toml" => Ok(case.to_owned()),
            _ => Ok(String::new()),
        };
        let page = "a\n<!-- expect case.toml -->\nold\n<!-- end of expect -->\nb\n";
        let new = "a\n<!-- expect case.toml -->\n\n| row | quantity | expected | tolerance | kind | source |\n|---|---|---|---|---|---|\n| peak | `contacts.a.peak_force` | 2 kN | 7 % | closed form | Z v |\n| late | `probe.a.displacement_x_m`, at 1 ms | at least 1, at most 2 |  | regression | a run. Tolerance: round-off |\n\n<!-- end of expect -->\nb\n";
        assert_eq!(expand(page, read).as_deref(), Ok(new));
        assert_eq!(expand(new, read).as_deref(), Ok(new));
        assert!(expand("<!-- expect case.toml -->\n", read).is_err());
        assert!(expand(&page.replace("case.toml", "other.toml"), read).is_err());
    }
}
