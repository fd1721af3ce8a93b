//! Figures as SVG, the data of interactive pages, HTML, and how numbers are shown to people: plain data become text, and nothing here knows a run.

mod error;
mod escape;
pub mod form;
pub mod html;
pub mod page;
pub mod plot;

pub use error::Error;
pub use escape::escape;
