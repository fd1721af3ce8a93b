//! Unilateral contact between surfaces.
