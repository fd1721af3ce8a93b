//! What the files say, read back by code that shares nothing with the writers.

mod figures;
mod files;
mod grids;
mod pages;
mod tables;
