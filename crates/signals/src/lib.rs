//! Functions of time: amplitudes, records of earthquakes, their integrals, response spectra, filters of impact tests, random and
//! synthetic signals.
//!
//! All numbers are in SI units. Nothing here knows a mesh, a body or a case file. Theory: `docs/src/theory/signals.md`.

mod amplitude;
mod baseline;
mod channel;
mod csv;
mod error;
mod field;
mod fourier;
mod oscillator;
mod random;
mod record;
mod spectrum;
mod synthetic;

pub use amplitude::{Amplitude, Held};
pub use baseline::corrected;
pub use channel::ChannelFilter;
pub use csv::{Column, Table};
pub use error::Error;
pub use field::RandomField;
pub use oscillator::{Oscillator, Response};
pub use record::{Record, Steps};
pub use spectrum::{ResponseSpectrum, response_spectrum};
pub use synthetic::Synthetic;
