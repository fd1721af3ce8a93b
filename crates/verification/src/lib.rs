//! Cases with an analytic or published answer.
