//! The row of data of each kind.

use crate::{Element, Kind};

macro_rules! rows {
    ([] $($(#[$doc:meta])* $kind:ident $module:ident $nodes:literal,)*) => {
        impl Kind {
            /// The number of nodes in the list, which macros see before any row of data.
            #[cfg(test)]
            pub(crate) fn listed_nodes(self) -> usize {
                match self {
                    $(Kind::$kind => $nodes,)*
                }
            }

            /// The row of data of this kind.
            pub fn table(self) -> &'static Element {
                match self {
                    $(Kind::$kind => &crate::$module::ELEMENT,)*
                }
            }
        }
    };
}

kinds!(rows);

impl Kind {
    /// The kind with this Gmsh element type number; `None` if no kind has it.
    pub fn from_gmsh(code: u32) -> Option<Kind> {
        Kind::ALL.into_iter().find(|kind| kind.table().gmsh == code)
    }
}
