//! The mount, spoken as it really speaks.

/// What we believe of the mount, and how sure we are.
pub mod belief;
