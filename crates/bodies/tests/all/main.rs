//! Facts about discretised bodies, over every element kind and kinematics.

// Helpers of the tests may unwrap as the tests do.
#![allow(clippy::unwrap_used)]

mod allocation;
mod axisymmetry;
mod bars;
mod beam_weights;
mod beams;
mod derivatives;
mod discrete;
mod distortion;
mod finite;
mod flowing;
mod locking;
mod mass;
mod one_point_shells;
mod patch;
mod peaks;
mod quadratic;
mod refusals;
mod sample;
mod section_stresses;
mod share;
mod shells;
mod sizes;
mod stiffness;
mod stresses;
mod threads;
mod tightened;
mod weights;

#[global_allocator]
static COUNTER: carom_testing::Counter = carom_testing::Counter;
