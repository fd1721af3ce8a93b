//! From a state to the next one.
