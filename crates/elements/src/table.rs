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

#[cfg(test)]
mod tests {
    use super::*;

    /// The difference of order d + 1 along a line vanishes for a polynomial of degree d, that of order d does not.
    #[test]
    fn the_degree_is_that_of_the_shape_functions() {
        let direction = [0.31, 0.47, -0.23];
        for element in Kind::ALL
            .map(Kind::table)
            .into_iter()
            .filter(|element| element.kind != Kind::Pyramid5)
        {
            let difference = |order: usize, a: usize| {
                let mut values: Vec<f64> = (0..=order)
                    .map(|k| {
                        let xi = [0, 1, 2].map(|i| match i < element.dim {
                            true => 0.1 + k as f64 * direction[i],
                            false => 0.0,
                        });
                        {
                            let mut n = vec![f64::NAN; element.nodes];
                            (element.shape)(&xi, &mut n);
                            n[a]
                        }
                    })
                    .collect();
                while values.len() > 1 {
                    values = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
                }
                values[0].abs()
            };
            let largest = |order| {
                (0..element.nodes)
                    .map(|a| difference(order, a))
                    .fold(0.0, f64::max)
            };
            assert!(largest(element.degree) > 1e-4, "{}", element.name);
            assert!(largest(element.degree + 1) < 1e-11, "{}", element.name);
        }
    }
}
