//! What takes the steps of a built case.

use std::sync::Arc;

use carom_dynamics::{Costs, Driver, Error, RankShare, State, Stepper};
use carom_output::Piece;
use carom_output::summary::Zones;
use carom_ranks::Ranks;
use carom_zones::Whole;

use crate::lower::Built;

/// What takes the steps of a built case.
pub(crate) enum Stepping {
    /// One driver, of zones too that step together.
    One(Box<Driver>),
    /// Zones that step apart.
    Apart(Box<Whole>),
}

impl Stepping {
    /// At the initial state; or, with the bytes of a state ([`Stepper::saved`]), at that one.
    ///
    /// # Errors
    /// The run cannot begin, or the bytes are no state of this model.
    pub(crate) fn new(built: &Built, saved: Option<&[u8]>) -> Result<Stepping, Error> {
        let system = Arc::clone(&built.system);
        if let (Some(zoned), true) = (&built.zoned, built.apart) {
            let whole = match saved {
                None => Whole::new(zoned, system),
                Some(bytes) => Whole::resume(zoned, system, bytes),
            };
            return Ok(Stepping::Apart(Box::new(whole?)));
        }
        let driver = match saved {
            None => Driver::new(system),
            Some(bytes) => State::from_bytes(&system, bytes)
                .and_then(|state| Driver::resume(Arc::clone(&system), state)),
        };
        Ok(Stepping::One(Box::new(driver?)))
    }

    /// The same where several ranks take all of each step; they share the products of iterations ([`Driver::alike`]).
    ///
    /// # Errors
    /// As [`Stepping::new`].
    pub(crate) fn alike(
        built: &Built,
        saved: Option<&[u8]>,
        ranks: &Ranks,
    ) -> Result<Stepping, Error> {
        // zones that step apart have factors, which ranks do not share
        if built.zoned.is_some() && built.apart {
            return Stepping::new(built, saved);
        }
        let driver = Driver::alike(&built.system, saved, ranks)?;
        Ok(Stepping::One(Box::new(driver)))
    }

    /// What this rank has and sends; none of a run in one process.
    pub(crate) fn rank_share(&self) -> Option<RankShare> {
        match self {
            Stepping::One(driver) => driver.rank_share(),
            Stepping::Apart(_) => None,
        }
    }

    /// The elements that this rank computes, where each has some of its own.
    pub(crate) fn piece(&self, ranks: &Ranks) -> Option<Piece> {
        let Stepping::One(driver) = self else {
            return None;
        };
        Some(Piece {
            rank: ranks.rank(),
            ranks: ranks.count(),
            elements: driver.own_elements()?,
        })
    }

    /// Adds what the run has cost before it was cut.
    pub(crate) fn add_earlier(&mut self, costs: &Costs) {
        match self {
            Stepping::One(driver) => driver.add_earlier(costs),
            Stepping::Apart(whole) => whole.add_earlier(costs),
        }
    }

    pub(crate) fn get(&self) -> &dyn Stepper {
        match self {
            Stepping::One(driver) => &**driver,
            Stepping::Apart(whole) => &**whole,
        }
    }

    pub(crate) fn get_mut(&mut self) -> &mut dyn Stepper {
        match self {
            Stepping::One(driver) => &mut **driver,
            Stepping::Apart(whole) => &mut **whole,
        }
    }

    /// What the summary says of the zones, if there are any.
    pub(crate) fn zones(&self, built: &Built) -> Option<Zones> {
        match (self, &built.zoned) {
            (Stepping::Apart(whole), _) => Some(Zones::of(whole)),
            (Stepping::One(driver), Some(zoned)) => Some(Zones::together(driver, zoned)),
            (Stepping::One(_), None) => None,
        }
    }
}
