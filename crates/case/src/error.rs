//! What is wrong with a case: one [`Problem`] for each cause, all of them collected before anything is refused.

use carom_quantities::nearest;
use std::fmt;

use crate::offenders::Offenders;

/// A place in one of the texts that make up a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// Index into [`crate::Input::sources`]: 0 is the case file, the overrides follow.
    pub source: usize,
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

/// One thing that is wrong, where it stands, and what would be right.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Key path of the value concerned (`contact.shock.primary`); empty for the file as a whole.
    pub path: String,
    /// What is wrong, in one sentence without a full stop.
    pub message: String,
    /// Where: filled by [`crate::Locator::locate`] from the key path when it is not known before.
    pub place: Option<Place>,
    /// The value found, as the user wrote it.
    pub found: Option<String>,
    /// What is accepted there: names, or one description.
    pub accepted: Vec<String>,
    /// The accepted name nearest to the one found.
    pub nearest: Option<String>,
    /// Further facts, one sentence each.
    pub notes: Vec<String>,
    /// The cells that it is about.
    pub offenders: Option<Offenders>,
    /// Whether nothing is wrong with the case, and this machine has too little memory for it.
    pub lacks_memory: bool,
}

impl Problem {
    /// A problem of the value at the key path `path`.
    pub fn new(path: impl Into<String>, message: impl Into<String>) -> Problem {
        Problem {
            path: path.into(),
            message: message.into(),
            place: None,
            found: None,
            accepted: Vec::new(),
            nearest: None,
            notes: Vec::new(),
            offenders: None,
            lacks_memory: false,
        }
    }

    /// Sets the place, for what has no key path or for a key rather than its value.
    #[must_use]
    pub fn at(mut self, place: Place) -> Problem {
        self.place = Some(place);
        self
    }

    /// Sets the value found.
    #[must_use]
    pub fn found(mut self, value: impl fmt::Display) -> Problem {
        self.found = Some(value.to_string());
        self
    }

    /// Sets what is accepted.
    #[must_use]
    pub fn accepted<T: Into<String>>(mut self, names: impl IntoIterator<Item = T>) -> Problem {
        self.accepted = names.into_iter().map(Into::into).collect();
        self
    }

    /// For a `name` that is none of `names`: sets what was found, what is accepted and the nearest of it.
    #[must_use]
    pub fn unknown<'a>(self, name: &str, names: impl IntoIterator<Item = &'a str>) -> Problem {
        let names: Vec<&str> = names.into_iter().collect();
        let nearest = nearest(name, names.iter().copied()).map(str::to_owned);
        Problem {
            nearest,
            ..self.found(name).accepted(names)
        }
    }

    /// Adds a fact.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Problem {
        self.notes.push(note.into());
        self
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.path.is_empty() {
            f.write_str(&self.message)
        } else {
            write!(f, "{}: {}", self.path, self.message)
        }
    }
}
