//! Prints the problems of a case, each under the line that it concerns.
//!
//! The text is the same on every machine: colours are the only thing that depends on the terminal.

use std::fmt::Write as _;

use annotate_snippets::{AnnotationKind, Element, Group, Level, Renderer, Snippet};
use carom_case::{Problem, Source};

/// Columns after which a long line of the case is cut around the caret.
const WIDTH: usize = 120;

/// All problems as text, in the order given, and their number. `styled` adds colours for a terminal.
pub fn render(sources: &[Source], problems: &[Problem], styled: bool) -> String {
    let renderer = if styled {
        Renderer::styled()
    } else {
        Renderer::plain()
    }
    .term_width(WIDTH);
    let mut text = String::new();
    for problem in problems {
        let rendered = renderer.render(&[group(sources, problem)]);
        text.push_str(rendered.trim_end());
        text.push_str("\n\n");
    }
    let plural = if problems.len() == 1 { "" } else { "s" };
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{} problem{plural} found.", problems.len());
    text
}

/// The sentence, the line with its caret, then what was found, what is accepted and what may be meant.
fn group<'a>(sources: &'a [Source], problem: &'a Problem) -> Group<'a> {
    let place = problem
        .place
        .and_then(|place| Some((place, sources.get(place.source)?)));
    let snippet = place.map(|(place, source)| {
        let label = (!problem.path.is_empty()).then_some(problem.path.as_str());
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
    let found = problem.found.iter().map(|found| format!("found: {found}"));
    let accepted = (!problem.accepted.is_empty())
        .then(|| format!("accepted: {}", problem.accepted.join(", ")));
    let facts = found
        .chain(accepted)
        .map(|text| Element::from(Level::NOTE.no_name().message(text)));
    let notes = problem
        .notes
        .iter()
        .map(|note| Element::from(Level::NOTE.message(note)));
    let help = problem
        .nearest
        .iter()
        .map(|name| Element::from(Level::HELP.message(format!("did you mean `{name}`?"))));
    Level::ERROR
        .primary_title(&problem.message)
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
