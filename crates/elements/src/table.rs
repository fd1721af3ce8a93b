//! The row of data of each kind.

use crate::{Element, Kind};

macro_rules! rows {
    ($($(#[$doc:meta])* $kind:ident $module:ident,)*) => {
        impl Kind {
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
