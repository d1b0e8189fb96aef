//! Seeded random streams. Integrators, roots and optimisers join them when the physics needs them.

/// Random numbers that are the same for one seed on every machine.
pub mod streams;
