//! What a run leaves behind: the results folder and every file in it.
//!
//! [`Results`] observes a run and fills the folder; the other modules turn plain data into files and know neither the case file nor the command line. Every file is
//! either written whole and renamed into place ([`atomic`]) or grows by complete rows ([`rows`]), so that a run cut
//! anywhere, by a full disk or by a signal, leaves files that can be read.
//!
//! Units are SI throughout; the names of columns and fields carry them.

mod absent;
pub mod atomic;
pub mod checkpoint;
pub mod expectations;
pub mod folder;
#[cfg(feature = "hdf5")]
mod hdf5;
pub mod history;
pub mod impacts;
pub mod maxima;
pub mod pvd;
pub mod report;
pub mod results;
pub mod rows;
pub mod statistics;
pub mod summary;
pub mod table;
pub mod verdict;
#[cfg(feature = "hdf5")]
mod vtkhdf;
pub mod vtu;
pub mod window;

mod error;
mod writer;

pub use absent::Absent;
pub use error::Error;
pub use folder::Folder;
pub use history::{History, column};
pub use impacts::{ImpactRow, ImpactTable};
pub use pvd::Collection;
pub use report::Report;
pub use results::{
    AllowableSettings, Bearer, BodyQuality, Checkpoints, Ending, Fields, LevelSettings, Piece,
    Pieces, Probe, Quantity, Reference, Results, Settings, Spectrum, Zoning, columns_with_units,
    model_picture, qualities, quantities, watched,
};
pub use statistics::{Allowable, Check, Level, Margin, Statistics, takes_energy};
pub use summary::Summary;
pub use verdict::{Grade, Verdict};
