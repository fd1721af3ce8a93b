//! Runs with each feature that are taken twice and must end in the same bytes.
//!
//! The models are those of [`crate::features`]: each feature with every scheme and one of the laws that they take, another law with
//! each scheme. Quick sizes take every third of these pairs.

use carom_dynamics::Stepper;

use crate::Error;
use crate::check::{Row, Size};
use crate::features::{Built, Feature, each_pair};

/// Pairs of runs with one feature.
#[derive(Clone, Copy, Default)]
pub(crate) struct Pairs {
    steps: usize,
    different_steps: usize,
    ends: usize,
    different_ends: usize,
    untouched: usize,
}

impl Pairs {
    /// Compares the ends of two runs byte by byte.
    pub(crate) fn compare(&mut self, one: &dyn Stepper, other: &dyn Stepper) -> Result<(), Error> {
        self.compare_ends(&end(one)?, &end(other)?);
        Ok(())
    }

    /// Compares the ends of one step byte by byte.
    pub(crate) fn compare_step(
        &mut self,
        one: &dyn Stepper,
        other: &dyn Stepper,
    ) -> Result<(), Error> {
        self.steps += 1;
        self.different_steps += usize::from(one.saved()? != other.saved()?);
        Ok(())
    }

    /// Compares two ends byte by byte.
    pub(crate) fn compare_ends(&mut self, one: &End, other: &End) {
        self.ends += 1;
        self.different_ends += usize::from(one.bytes != other.bytes);
        self.untouched += usize::from(!one.touched);
    }

    fn rows(&self, feature: Feature) -> Vec<Row> {
        let name = |what: &str| format!("{}: {what}", feature.name());
        let mut rows = vec![
            Row::shown(name("pairs"), self.ends as f64),
            Row::count(name("ends that differ in a byte"), self.different_ends, 0)
                .second_formulation(),
            Row::count(name("pairs that never touched"), self.untouched, 0),
        ];
        if self.steps > 0 {
            let what = format!("of {} single steps that differ in a byte", self.steps);
            rows.push(Row::count(name(&what), self.different_steps, 0).second_formulation());
        }
        rows
    }
}

/// The end of a run.
pub(crate) struct End {
    bytes: Vec<u8>,
    touched: bool,
}

pub(crate) fn end(run: &dyn Stepper) -> Result<End, Error> {
    let closing = run.state().records.contacts[0].first_closing;
    Ok(End {
        bytes: run.saved()?,
        touched: closing.is_some(),
    })
}

/// Steps until so many have been taken since the start of the run.
pub(crate) fn advance(run: &mut dyn Stepper, steps: u64) -> Result<(), Error> {
    while run.state().step < steps {
        run.step()?;
    }
    Ok(())
}

/// Rows of so many features; `pair` takes both runs of a pair. `size`: which of the models are run, and how fine they are,
/// as [`each_pair`] takes them.
pub(crate) fn rows(
    features: usize,
    size: (usize, usize),
    pair: impl Fn(&mut Pairs, Feature, &Built) -> Result<(), Error>,
) -> Result<Vec<Row>, Error> {
    let mut all = [Pairs::default(); Feature::ALL.len()];
    each_pair(size, |feature, built| {
        let place = Feature::ALL.iter().position(|other| *other == feature);
        place.map_or(Ok(()), |place| pair(&mut all[place], feature, built))
    })?;
    let compared = Feature::ALL.into_iter().zip(&all);
    let compared: Vec<_> = compared.filter(|(_, pairs)| pairs.ends > 0).collect();
    let mut rows = vec![Row::count("features", compared.len(), features)];
    rows.extend(
        compared
            .iter()
            .flat_map(|(feature, pairs)| pairs.rows(*feature)),
    );
    Ok(rows)
}

/// Every which model a size takes.
pub(crate) fn stride(size: Size) -> usize {
    match size {
        Size::Quick => 3,
        Size::Full => 1,
    }
}
