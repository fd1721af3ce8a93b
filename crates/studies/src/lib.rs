//! What several runs of a case say together: studies of steps and meshes, comparisons with references and with each other, natural modes.

pub mod compare;
pub mod modes;
pub mod study;
