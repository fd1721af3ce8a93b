//! What a check shows besides its rows: a model that it builds, and computed values over their references.
//!
//! Nothing is kept unless somebody looks ([`look`]): the page of a verification. Checks build systems on several threads, so that what is
//! seen is behind a lock; checks run one after the other while it is looked at.

use std::sync::{Arc, Mutex, PoisonError};

use carom_dynamics::{Model, System};
use carom_zones::{Zoned, Zones};

/// Most cells of a model that is kept where a check has several.
const CELLS: usize = 6000;

/// Most curves of a check.
const CURVES: usize = 4;

/// What a check has shown.
#[derive(Debug, Default)]
pub struct Shown {
    /// The largest model of at most 6000 cells, else the smallest one.
    pub model: Option<Model>,
    /// The first curves.
    pub curves: Vec<Compared>,
}

/// Computed values over their reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// What is computed, and by which scheme or mesh.
    pub title: String,
    /// Name and unit of the abscissa.
    pub abscissa: [&'static str; 2],
    /// Name and unit of the ordinate.
    pub ordinate: [&'static str; 2],
    /// Abscissae, ascending.
    pub x: Vec<f64>,
    /// Computed values there.
    pub computed: Vec<f64>,
    /// What they are to be.
    pub reference: Vec<f64>,
}

static SHOWN: Mutex<Option<Shown>> = Mutex::new(None);

fn with<T>(act: impl FnOnce(&mut Option<Shown>) -> T) -> T {
    // what a check that panicked has left is as good as before
    act(&mut SHOWN.lock().unwrap_or_else(PoisonError::into_inner))
}

/// Runs something, and returns what it has shown too.
pub fn look<T>(act: impl FnOnce() -> T) -> (T, Shown) {
    with(|shown| *shown = Some(Shown::default()));
    let result = act();
    (result, with(Option::take).unwrap_or_default())
}

/// Whether somebody looks.
pub fn looks() -> bool {
    with(|shown| shown.is_some())
}

/// [`System::new`], of a model that is shown.
///
/// # Errors
/// Those of [`System::new`].
pub fn system(model: Model) -> Result<Arc<System>, carom_system::Error> {
    show(&model);
    System::new(model)
}

/// [`Zones::new`], of a model that is shown.
///
/// # Errors
/// Those of [`Zones::new`].
pub(crate) fn zones(zoned: &Zoned) -> Result<Zones, carom_zones::Error> {
    show(&zoned.model);
    Zones::new(zoned)
}

/// Shows a model.
pub(crate) fn show(model: &Model) {
    with(|shown| {
        let Some(shown) = shown else {
            return;
        };
        let cells = |model: &Model| -> usize {
            model.bodies.iter().map(|body| body.spec.cells.len()).sum()
        };
        let now = cells(model);
        let better = shown.model.as_ref().is_none_or(|kept| {
            let before = cells(kept);
            match (before <= CELLS, now <= CELLS) {
                (true, within) => within && now > before,
                (false, _) => now < before,
            }
        });
        if better {
            shown.model = Some(model.clone());
        }
    });
}

/// Shows computed values over their reference, where somebody looks and there is room.
pub(crate) fn compare(make: impl FnOnce() -> Compared) {
    with(|shown| {
        if let Some(shown) = shown
            && shown.curves.len() < CURVES
        {
            shown.curves.push(make());
        }
    });
}
