//! A display controller of Linux (DRM/KMS) as projector, without a desktop.

/// The calls into the kernel: two dumb buffers and page flips.
#[cfg(feature = "kms")]
pub mod controller;
/// Which connector, mode and scan-out are taken: pure.
pub mod plan;
