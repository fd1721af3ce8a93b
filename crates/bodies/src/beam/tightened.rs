//! Which cells of beams a static stage tightens.

use carom_mesh::ElementId;

use crate::{Bolt, TightenedCell};

/// Bolts of a body, and their elements.
#[derive(Debug, Default)]
pub(super) struct Bolts {
    pub(super) all: Vec<Bolt>,
    pub(super) elements: Vec<usize>,
    /// Whether they have no axial stiffness.
    pub(super) tighten: bool,
}

impl Bolts {
    /// The cells that are tightened, before any stiffness is computed.
    pub(super) fn of(cells: &[ElementId], tightened: &[TightenedCell]) -> Bolts {
        let mut bolts = Bolts::default();
        for given in tightened {
            let element = cells.iter().position(|cell| *cell == given.cell);
            let Some(element) = element else { continue };
            bolts.elements.push(element);
            bolts.tighten |= given.tightens;
            bolts.all.push(Bolt {
                name: given.name.clone(),
                force: given.force,
                stiffness: 0.0,
                row: Vec::new(),
            });
        }
        bolts
    }

    /// Whether an element has no axial stiffness.
    pub(super) fn loosens(&self, element: usize) -> bool {
        self.tighten && self.elements.contains(&element)
    }
}
