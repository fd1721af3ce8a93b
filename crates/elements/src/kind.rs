//! The kinds of elements.

use serde::{Deserialize, Serialize};

macro_rules! declare {
    ([] $($(#[$doc:meta])* $kind:ident $module:ident $nodes:literal,)*) => {
        /// The kind of an element: the key of its row of data.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
        #[serde(rename_all = "lowercase")]
        pub enum Kind {
            $($(#[$doc])* $kind,)*
        }

        impl Kind {
            /// All kinds, in the order of their declaration.
            pub const ALL: [Kind; [$(Kind::$kind),*].len()] = [$(Kind::$kind),*];
        }
    };
}

kinds!(declare);
