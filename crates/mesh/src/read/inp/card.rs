//! Keyword lines with the data lines behind them.

use std::str::FromStr;

use super::fault::Fault;

/// A keyword with its parameters and data.
#[derive(Debug)]
pub(super) struct Card<'a> {
    /// Line of the keyword, from 1.
    pub line: usize,
    /// The keyword without its star, in capital letters.
    pub name: String,
    parameters: Vec<(String, Option<&'a str>)>,
    /// Lines that are not empty.
    pub data: Vec<Data<'a>>,
}

/// A line of data.
#[derive(Clone, Copy, Debug)]
pub(super) struct Data<'a> {
    pub line: usize,
    text: &'a str,
}

/// The cards of a file, in their order; comments (`**`) and empty lines are left out. A keyword line that ends with a comma goes on in the next one.
pub(super) fn cards(text: &str) -> Result<Vec<Card<'_>>, Fault> {
    let mut cards: Vec<Card> = Vec::new();
    let mut goes_on = false;
    for (number, text) in (1..).zip(text.lines()) {
        let text = text.trim();
        if text.is_empty() || text.starts_with("**") {
            continue;
        }
        let card = cards.last_mut();
        if let (true, Some(card)) = (goes_on, card) {
            goes_on = text.ends_with(',');
            card.parameters.extend(parameters(text.split(',')));
        } else if let Some(rest) = text.strip_prefix('*') {
            goes_on = text.ends_with(',');
            let mut words = rest.split(',');
            let name = words.next().unwrap_or_default().trim().to_uppercase();
            cards.push(Card {
                line: number,
                name,
                parameters: parameters(words).collect(),
                data: Vec::new(),
            });
        } else if let Some(card) = cards.last_mut() {
            card.data.push(Data { line: number, text });
        } else {
            return Err(Fault::new(number, quoted(text), "a keyword, such as *NODE"));
        }
    }
    Ok(cards)
}

fn parameters<'a>(
    words: impl Iterator<Item = &'a str>,
) -> impl Iterator<Item = (String, Option<&'a str>)> {
    words.filter(|word| !word.trim().is_empty()).map(|word| {
        let mut parts = word.splitn(2, '=');
        let key = parts.next().unwrap_or_default().trim().to_uppercase();
        let value = parts.next();
        (key, value.map(|value| value.trim().trim_matches('"')))
    })
}

impl<'a> Card<'a> {
    /// Whether a parameter is there, with a value or without.
    pub fn has(&self, key: &str) -> bool {
        self.parameters.iter().any(|(name, _)| name == key)
    }

    /// The value of a parameter.
    pub fn get(&self, key: &str) -> Option<&'a str> {
        let found = self.parameters.iter().find(|(name, _)| name == key)?;
        found.1.filter(|value| !value.is_empty())
    }

    /// The value of a parameter that has to be there.
    pub fn required(&self, key: &str) -> Result<&'a str, Fault> {
        self.get(key).ok_or_else(|| {
            let found = format!("*{} without {key}", self.name);
            Fault::new(self.line, found, format!("{key}=..."))
        })
    }
}

impl<'a> Data<'a> {
    /// Its words, without empty ones.
    pub fn words(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        let words = self.text.split(',').map(str::trim);
        words.filter(|word| !word.is_empty())
    }

    /// Whether the line ends with a comma.
    pub fn goes_on(&self) -> bool {
        self.text.ends_with(',')
    }

    /// A word as a number.
    pub fn number<T: FromStr>(&self, word: Option<&str>, expected: &str) -> Result<T, Fault> {
        let Some(word) = word else {
            return Err(Fault::new(self.line, "the end of the line", expected));
        };
        // exponents of FORTRAN
        let number = word.parse();
        let number = number.or_else(|_| word.replace(['d', 'D'], "e").parse());
        number.map_err(|_| self.fault(word, expected))
    }

    pub fn fault(&self, word: &str, expected: &str) -> Fault {
        Fault::new(self.line, quoted(word), expected)
    }
}

/// A text of the file for a message.
fn quoted(text: &str) -> String {
    let short: String = text.chars().take(40).collect();
    format!("\"{}\"", short.escape_debug())
}
