//! Benchmarks live in `benches/benches`; this library is empty so that tests never build criterion.
