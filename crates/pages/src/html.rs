//! HTML of the pages: texts that are escaped, numbers as people read them, rows and tables.

use crate::form::{self, NOTHING};
use crate::plot::{self, digits, scientific};

/// The head of a page up to the tag of its body; `style` stands after the style of all pages, `class` is that of the body.
pub fn head(title: &str, style: &str, class: &str) -> String {
    let shared = include_str!("../templates/style.css");
    format!(
        "<!DOCTYPE html>
<html lang=\"en\">
<head>
<meta charset=\"utf-8\">
<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">
<title>{}</title>
<style>
{}{style}</style>
</head>
<body{class}>
",
        text(title),
        shared.trim_end_matches('\n'),
    )
}

/// A text as HTML, also within the quotes of an attribute.
pub fn text(text: &str) -> String {
    let mut html = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '<' => html.push_str("&lt;"),
            '>' => html.push_str("&gt;"),
            '&' => html.push_str("&amp;"),
            '"' => html.push_str("&quot;"),
            '\'' => html.push_str("&#x27;"),
            '/' => html.push_str("&#x2f;"),
            _ => html.push(letter),
        }
    }
    html
}

/// A message as HTML: what stands between two backticks is code.
pub fn code(message: &str) -> String {
    let mut html = String::new();
    let parts: Vec<&str> = message.split('`').collect();
    for (k, part) in parts.iter().enumerate() {
        // no line begins with the sign of a per cent
        let part = text(&part.replace(" %", "\u{a0}%"));
        html += &match k {
            0 => part,
            // a backtick without its other one stands as it is
            k if k % 2 == 1 && k + 1 == parts.len() => format!("`{part}"),
            k if k % 2 == 1 => format!("<code>{}</code>", options(&part)),
            _ => part,
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

/// The HTML of each item, one after the other.
pub fn each<T>(items: impl IntoIterator<Item = T>, html: impl FnMut(T) -> String) -> String {
    items.into_iter().map(html).collect()
}

/// The HTML, or nothing.
pub fn when(condition: bool, html: impl FnOnce() -> String) -> String {
    if condition { html() } else { String::new() }
}

/// A number with its unit, or the sign for none.
pub fn quantity(value: impl Into<Option<f64>>, unit: &str) -> String {
    let shown = value.into().map(|value| plot::quantity(value, unit));
    shown.map_or(NOTHING.to_owned(), |shown| text(&shown))
}

/// A part as per cent, or the sign for none.
pub fn percent(part: impl Into<Option<f64>>) -> String {
    part.into().map_or(NOTHING.to_owned(), form::percent)
}

/// A number of a balance: seven digits, or a power of ten where it is very small or very large; or the sign for none.
pub fn exact(value: impl Into<Option<f64>>) -> String {
    let Some(value) = value.into() else {
        return NOTHING.to_owned();
    };
    match value.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e6).contains(&size) => digits(value, 7),
        size if size.is_finite() => scientific(value, 3),
        _ => value.to_string(),
    }
}

/// A number of bytes with the prefix that people expect.
pub fn bytes(count: u64) -> String {
    match count as f64 {
        count if count >= 1e9 => format!("{:.2} GB", count / 1e9),
        count if count >= 1e6 => format!("{:.1} MB", count / 1e6),
        count if count >= 1e3 => format!("{:.1} kB", count / 1e3),
        count => format!("{count} B"),
    }
}

/// A row of a table with a value, both as HTML but for the label, which is a text.
pub fn row(label: &str, value: impl std::fmt::Display) -> String {
    let label = text(label);
    format!("<tr><th scope=\"row\">{label}</th><td>{value}</td></tr>")
}

/// Cells of a row.
pub fn cells(cells: &[String]) -> String {
    each(cells, |cell| format!("<td>{cell}</td>"))
}

/// A line of a table below its head: the name as text, then [`cells`].
pub fn line(name: &str, cells: &str) -> String {
    format!("\n<tr><th scope=\"row\">{}</th>{cells}</tr>", text(name))
}

/// The heads of columns, which are HTML.
pub fn heads<S: AsRef<str>>(heads: &[S]) -> String {
    let cells = each(heads, |head| format!("<th>{}</th>", head.as_ref()));
    format!("<tr>{cells}</tr>")
}

/// A table of its own width with its heads; `dense`: of small letters.
pub fn wide<S: AsRef<str>>(dense: bool, names: &[S], lines: &str) -> String {
    let class = if dense { " class=\"dense\"" } else { "" };
    let heads = heads(names);
    format!(
        "<div class=\"wide\"><table{class}>
<thead>{heads}</thead>
<tbody>{lines}
</tbody></table></div>
"
    )
}

/// A table of texts, whose rows each begin with their name.
pub fn texts(dense: bool, names: &[String], rows: &[Vec<String>]) -> String {
    let names: Vec<String> = names.iter().map(|name| text(name)).collect();
    let row = |row: &Vec<String>| {
        let rest = row.iter().skip(1).map(|cell| text(cell));
        let first = row.first().map_or("", String::as_str);
        line(first, &cells(&rest.collect::<Vec<_>>()))
    };
    wide(dense, &names, &each(rows, row))
}

/// A section of messages under a head; nothing without any.
pub fn messages(head: &str, items: &[String]) -> String {
    when(!items.is_empty(), || {
        let items = each(items, |item| format!("<li>{item}</li>"));
        format!("\n<h2>{head}</h2>\n<ul class=\"plain\">{items}</ul>")
    })
}

/// The class of the word of a verdict.
pub fn class(verdict: &str) -> &str {
    match verdict {
        "good" | "look" => verdict,
        _ => "bad",
    }
}

/// What the program of a page reads, and the program.
pub fn program([head, block]: &[String; 2]) -> String {
    format!(
        "<script id=\"carom-page\" type=\"application/json\">{head}</script>
<script id=\"carom-data\" type=\"text/plain\">{block}</script>
<script>{}</script>
",
        crate::page::PROGRAM
    )
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
