//! Bars and beams whose metal flows: fibres under uniaxial stress at small strain, with a history.

mod elements;
mod section;

pub(crate) use elements::{Flowing, Point};
pub use section::Fibre;
pub(crate) use section::{FibreSection, Strains};
