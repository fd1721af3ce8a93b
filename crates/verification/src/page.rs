//! The page of a verification: of each check the problem, its reference and the reason for the tolerance in words, and the rows with
//! their errors, drawn as parts of what is allowed.

use std::fmt::Write as _;

use crate::check::{Expected, Made, Row, Verdict, short};
use crate::witness::Shown;

const STYLE: &str = ":root { color-scheme: light dark; --faint: #6a6a6a; --line: #dddddd; --good: #1b7f4f; --bad: #b3261e; }
@media screen and (prefers-color-scheme: dark) { :root { --faint: #a0a09c; --line: #34373b; --good: #53c08a; --bad: #f2857c; } }
body { max-width: 72rem; margin: 0 auto; padding: 1.5rem 1rem 4rem; font: 15px/1.5 system-ui, 'Liberation Sans', sans-serif; }
h2 { font-size: 1.1rem; margin: 2.2rem 0 .3rem; border-bottom: 1px solid var(--line); } p { margin: .4rem 0; max-width: 62rem; }
.faint, details { color: var(--faint); font-size: .9rem; } .good { color: var(--good); } .bad { color: var(--bad); }
.wide { overflow-x: auto; } table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .9rem .2rem 0; text-align: left; border-bottom: 1px solid var(--line); } td.number { text-align: right; white-space: nowrap; }
meter { width: 7rem; } figure { margin: 0; flex: 1 1 20rem; max-width: 36rem; background: #fff; }
.pictures { display: flex; flex-wrap: wrap; gap: .7rem; margin: .7rem 0; } figure svg { width: 100%; height: auto; display: block; }
@media print { h2 { break-after: avoid; } figure, tr { break-inside: avoid; } } ol { columns: 16rem; font-size: .9rem; }";

/// The page as HTML. `head`: the head of the file of a check by its name; `draw`: pictures of what it has shown, as SVG.
pub(crate) fn page(
    made: &[Made],
    verdict: &Verdict,
    head: impl Fn(&str) -> String,
    draw: impl Fn(&Shown) -> Vec<String>,
) -> String {
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Verification of Carom</title>\n<style>{STYLE}</style>\n</head>\n<body>\n\
         <h1>Verification of Carom</h1>\n<p><b class=\"{}\">{}</b></p>\n<ol>\n",
        if verdict.holds() { "good" } else { "bad" },
        escaped(&verdict.to_string()),
    );
    for one in made {
        let name = one.check.name;
        let _ = writeln!(
            html,
            "<li><a href=\"#{name}\">{name}</a> {}</li>",
            mark(one)
        );
    }
    html += "</ol>\n";
    for one in made {
        section(&mut html, one, &head(one.check.name), &draw(&one.shown));
    }
    html + "</body>\n</html>\n"
}

fn mark(made: &Made) -> &'static str {
    match made.holds() {
        true => "<b class=\"good\">holds</b>",
        false => "<b class=\"bad\">fails</b>",
    }
}

fn section(html: &mut String, made: &Made, head: &str, pictures: &[String]) {
    let name = made.check.name;
    let _ = write!(
        html,
        "<h2 id=\"{name}\">{name} {}</h2>\n<p>{}.</p>\n<details><summary>Problem, reference and tolerance</summary>\n",
        mark(made),
        escaped(made.check.fact),
    );
    for paragraph in head.split("\n\n") {
        let _ = writeln!(html, "<p>{}</p>", escaped(paragraph));
    }
    html.push_str("</details>\n");
    if !pictures.is_empty() {
        html.push_str("<div class=\"pictures\">\n");
        for picture in pictures {
            let _ = writeln!(html, "<figure>{picture}</figure>");
        }
        html.push_str("</div>\n");
    }
    match &made.rows {
        Ok(rows) => table(html, rows),
        Err(error) => {
            let _ = writeln!(
                html,
                "<p class=\"bad\">It could not be made: {}</p>",
                escaped(&error.to_string())
            );
        }
    }
    let _ = writeln!(html, "<p class=\"faint\">{:.1} s</p>", made.seconds);
}

fn table(html: &mut String, rows: &[Row]) {
    html.push_str(
        "<div class=\"wide\"><table>\n<thead><tr><th></th><th>Quantity</th><th>Value</th><th>Reference</th><th>Error</th>\
         <th>Allowed</th><th>Part of it</th><th>Kind of the reference</th></tr></thead>\n<tbody>\n",
    );
    for row in rows {
        let [reference, error, allowed] = numbers(row);
        let verdict = match (row.holds(), row.expected) {
            (false, _) => "<b class=\"bad\">fails</b>",
            (true, Expected::Anything) => "",
            (true, _) => "<b class=\"good\">holds</b>",
        };
        let part = part(row).map_or(String::new(), |part| {
            format!(
                "<meter value=\"{:.4}\">{:.0} %</meter>",
                part.min(1.0),
                100.0 * part
            )
        });
        let _ = writeln!(
            html,
            "<tr><td>{verdict}</td><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{reference}</td>\
             <td class=\"number\">{error}</td><td class=\"number\">{allowed}</td><td>{part}</td><td>{}</td></tr>",
            escaped(&row.quantity),
            short(row.value),
            row.kind,
        );
    }
    html.push_str("</tbody></table></div>\n");
}

/// Reference, error and what is allowed.
fn numbers(row: &Row) -> [String; 3] {
    match row.expected {
        Expected::Near {
            reference,
            tolerance,
        } => [
            short(reference),
            format!("{:.1e}", row.value - reference),
            match tolerance {
                0.0 => "equal".to_owned(),
                tolerance => format!("±{tolerance:.1e}"),
            },
        ],
        Expected::AtMost(bound) => [String::new(), String::new(), format!("≤ {}", short(bound))],
        Expected::AtLeast(bound) => [String::new(), String::new(), format!("≥ {}", short(bound))],
        Expected::Anything => [const { String::new() }; 3],
    }
}

/// Part of the tolerance, or of an upper bound, that the row takes; `None` where there is no such part.
pub fn part(row: &Row) -> Option<f64> {
    let part = match row.expected {
        Expected::Near {
            reference,
            tolerance,
        } if tolerance > 0.0 => (row.value - reference).abs() / tolerance,
        Expected::AtMost(bound) if bound > 0.0 => row.value.max(0.0) / bound,
        _ => return None,
    };
    part.is_finite().then_some(part)
}

/// The comment at the head of a source file, without its marks and the brackets of its links; paragraphs apart by an empty line.
pub fn head(source: &str) -> String {
    let lines = source.lines().map_while(|line| line.strip_prefix("//!"));
    let lines: Vec<&str> = lines.map(str::trim).collect();
    lines.join("\n").replace("[`", "`").replace("`]", "`")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
