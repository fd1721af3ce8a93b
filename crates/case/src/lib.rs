//! From a case file to a model, and the run.
