//! Cases with an analytic or published answer.

pub mod bars;
