//! Constitutive laws at one point.
