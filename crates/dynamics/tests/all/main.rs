//! Facts about whole steps that need no exact solution.

// Helpers of tests panic as the tests themselves do.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod allocation;
mod assemblies;
mod beams;
mod beside;
mod cores;
mod crossing;
mod direct;
mod discrete;
mod edges;
mod explicit;
mod far;
mod floating;
mod flowing;
mod fold;
mod friction;
mod held;
mod impacts;
mod initial;
mod interface;
mod many_bodies;
mod many_points;
mod material_work;
mod moments;
mod momentum;
mod mortar;
mod newton;
mod passage;
mod pieces;
mod quadrature;
mod refusals;
mod rolling;
mod sliding;
mod small;
mod solvers;
mod stability;
mod stages;
mod stops;
mod supports;
mod thrown;
mod trough;

#[global_allocator]
static COUNTER: carom_testing::Counter = carom_testing::Counter;
