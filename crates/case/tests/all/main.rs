//! Stage one, from texts to cases or to problems.

// Helpers of tests panic as the tests themselves do.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod across_zones;
mod allowables;
mod assumed;
mod bolts;
mod bystanders;
mod checks;
mod compare;
mod damaged;
mod defaults;
mod events;
mod forged;
mod general;
mod grades;
mod hinged;
mod interrupts;
mod large;
mod levels;
mod losses;
mod means;
mod offset;
mod pieces;
mod quadrature;
mod quiet;
mod ranks;
mod ranks_contacts;
mod ranks_implicit;
mod ranks_parts;
mod reactions;
mod reductions;
mod reference;
mod refine;
mod repeat;
mod resolved;
mod resume;
mod resume_cases;
mod simulation;
mod stage_one;
mod stages;
mod stops;
mod symmetries;
mod verdict;
mod warnings;
mod zones;
