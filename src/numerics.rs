//! Integrals, roots, steps of differential equations, and seeded random streams.

/// Names of things that are kept.
pub mod hash;
/// Integrals by Gauss and Kronrod.
pub mod quadrature;
/// Where a function is zero.
pub mod roots;
/// One step of a differential equation, with its error.
pub mod runge_kutta;
/// Random numbers that are the same for one seed on every machine.
pub mod streams;
