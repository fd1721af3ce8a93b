//! What the number of a row is judged by.

use std::fmt;

/// What the number of a row is judged by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// An exact solution, an identity, a conservation law, a theorem, or a bound or order that theory states. So is what
    /// must be true for the check to show anything, such as that bodies thrown at each other press.
    ClosedForm,
    /// A figure printed in the literature; the header of the check names the source.
    Published,
    /// A figure of an implementation that shares no code with Carom.
    OtherCode,
    /// Another scheme, law, mesh, formulation or run of Carom agrees, within a tolerance whose reason the header states.
    SecondFormulation,
    /// Carom's own figure, found earlier: the row shows that it has not changed, not that it is right.
    Regression,
    /// Shown and not judged.
    Information,
}

impl Kind {
    /// All kinds, in the order of the summary.
    pub const ALL: [Kind; 6] = [
        Kind::ClosedForm,
        Kind::Published,
        Kind::OtherCode,
        Kind::SecondFormulation,
        Kind::Regression,
        Kind::Information,
    ];

    /// The words of the output.
    pub fn name(self) -> &'static str {
        match self {
            Kind::ClosedForm => "closed form",
            Kind::Published => "published",
            Kind::OtherCode => "another code",
            Kind::SecondFormulation => "second formulation",
            Kind::Regression => "regression",
            Kind::Information => "information",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// How many rows there are of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts([usize; Kind::ALL.len()]);

impl Counts {
    /// Counts one row.
    pub fn add(&mut self, kind: Kind) {
        self.0[kind as usize] += 1;
    }

    /// Rows of a kind.
    pub fn of(&self, kind: Kind) -> usize {
        self.0[kind as usize]
    }

    /// Rows of all kinds.
    pub fn total(&self) -> usize {
        self.0.iter().sum()
    }
}

/// `5 closed form, 1 regression`: kinds of which there are none are left out.
impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = Kind::ALL.map(|kind| (self.of(kind), kind));
        let counted = counts.iter().filter(|(count, _)| *count > 0);
        for (k, (count, kind)) in counted.enumerate() {
            let comma = if k > 0 { ", " } else { "" };
            write!(f, "{comma}{count} {kind}")?;
        }
        Ok(())
    }
}
