//! Prints the problems of a case, each under the line that it concerns.
//!
//! The text is the same on every machine: colours are the only thing that depends on the terminal.

use std::borrow::Cow;
use std::fmt::Write as _;

use annotate_snippets::{AnnotationKind, Element, Group, Level, Renderer, Snippet};
use carom_case::{Problem, Source};

use crate::terminal::{line, shortened};

/// Columns after which a long line of the case is cut around the caret.
const WIDTH: usize = 120;
/// Problems shown.
const MOST: usize = 50;
/// Letters of a name, or of a value that was found, that are shown.
const VALUE: usize = 200;
/// Accepted names shown.
const NAMES: usize = 40;

/// Problems as text, in the order given, and their number; the first [`MOST`] of them. `styled` adds colours for a terminal.
pub fn render(sources: &[Source], problems: &[Problem], styled: bool) -> String {
    let renderer = if styled {
        Renderer::styled()
    } else {
        Renderer::plain()
    }
    .term_width(WIDTH);
    let sources: Vec<Source> = sources.iter().map(shown).collect();
    let mut text = String::new();
    for problem in problems.iter().take(MOST) {
        let words = Words::new(problem);
        let rendered = renderer.render(&[group(&sources, problem, &words)]);
        text.push_str(rendered.trim_end());
        text.push_str("\n\n");
    }
    let plural = if problems.len() == 1 { "" } else { "s" };
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{} problem{plural} found.", problems.len());
    if problems.len() > MOST {
        let _ = writeln!(text, "The first {MOST} of them are shown.");
    }
    text
}

/// The source for the renderer, which makes all control characters visible but those of the block C1: each becomes a point,
/// which has as many bytes.
fn shown(source: &Source) -> Source {
    let point = |letter| match letter {
        '\u{80}'..='\u{9f}' => '·',
        other => other,
    };
    Source {
        name: line(&source.name).into_owned(),
        text: source.text.chars().map(point).collect(),
    }
}

/// What a problem says, in pieces that fit a terminal.
struct Words<'a> {
    message: Cow<'a, str>,
    path: Cow<'a, str>,
    facts: Vec<String>,
    notes: Vec<Cow<'a, str>>,
    help: Option<String>,
}

impl Words<'_> {
    fn new(problem: &Problem) -> Words<'_> {
        let found = problem.found.iter();
        let found = found.map(|found| format!("found: {}", shortened(found, VALUE)));
        let nearest = problem.nearest.as_ref();
        Words {
            message: line(&problem.message),
            path: shortened(&problem.path, VALUE),
            facts: found.chain(accepted(&problem.accepted)).collect(),
            notes: problem.notes.iter().map(|note| line(note)).collect(),
            help: nearest.map(|name| format!("did you mean `{}`?", shortened(name, VALUE))),
        }
    }
}

/// The accepted names, the first [`NAMES`] of them.
fn accepted(names: &[String]) -> Option<String> {
    let shown = names.iter().take(NAMES);
    let shown: Vec<_> = shown.map(|name| shortened(name, VALUE)).collect();
    match names.len() {
        0 => None,
        count if count > NAMES => Some(format!(
            "accepted: {} ... ({} more)",
            shown.join(", "),
            count - NAMES
        )),
        _ => Some(format!("accepted: {}", shown.join(", "))),
    }
}

/// The sentence, the line with its caret, then what was found, what is accepted and what may be meant.
fn group<'a>(sources: &'a [Source], problem: &Problem, words: &'a Words) -> Group<'a> {
    let place = problem
        .place
        .and_then(|place| Some((place, sources.get(place.source)?)));
    let snippet = place.map(|(place, source)| {
        let label = (!words.path.is_empty()).then_some(&*words.path);
        let end = place.end.max(place.start).min(source.text.len());
        let caret = AnnotationKind::Primary
            .span(place.start.min(end)..end)
            .label(label);
        Element::from(
            Snippet::source(&source.text)
                .path(&source.name)
                .annotation(caret),
        )
    });
    let facts = words.facts.iter();
    let facts = facts.map(|text| Element::from(Level::NOTE.no_name().message(text)));
    let notes = words.notes.iter();
    let notes = notes.map(|note| Element::from(Level::NOTE.message(&**note)));
    let help = words.help.iter();
    let help = help.map(|text| Element::from(Level::HELP.message(text)));
    Level::ERROR
        .primary_title(&*words.message)
        .elements(snippet.into_iter().chain(facts).chain(notes).chain(help))
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_case::Place;

    #[test]
    fn a_problem_is_shown_under_its_line_with_what_would_be_right() {
        let sources = [Source {
            name: "case.toml".to_owned(),
            text: "[material.steel]\ndensty = 7844.0\n".to_owned(),
        }];
        let problem = Problem::new("material.steel.densty", "unknown key `densty`")
            .unknown("densty", ["density", "elastic"])
            .at(Place {
                source: 0,
                start: 17,
                end: 23,
            });
        let expected = "\
error: unknown key `densty`
 --> case.toml:2:1
  |
2 | densty = 7844.0
  | ^^^^^^ material.steel.densty
  |
  = found: densty
  = accepted: density, elastic
  = help: did you mean `density`?

1 problem found.
";
        assert_eq!(render(&sources, &[problem], false), expected);
    }

    #[test]
    fn a_problem_without_a_place_is_still_told() {
        let problem = Problem::new("", "cannot read the case file `a.toml`").note("it is a folder");
        let text = render(&[], &[problem], false);
        assert!(
            text.starts_with("error: cannot read the case file `a.toml`\n"),
            "{text}"
        );
        assert!(text.contains("note: it is a folder"), "{text}");
    }

    #[test]
    fn a_place_beyond_its_text_does_not_panic() {
        let sources = [Source {
            name: "case.toml".to_owned(),
            text: "a".to_owned(),
        }];
        let problem = Problem::new("", "out").at(Place {
            source: 0,
            start: 5,
            end: 9,
        });
        assert!(render(&sources, &[problem], false).starts_with("error: out"));
    }
}
