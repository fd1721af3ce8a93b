//! Discretised bodies: mass, forces, tangents, energies.
