//! Bytes and devices. Each device is a pure protocol (bytes in, bytes out, a clock handed in), a thin adapter that owns the
//! file descriptor, and a simulator.
//!
//! "Now" is a [`std::time::Duration`] since the program started, handed in by the caller: no protocol reads a clock.

/// A bad cable between any two ports, by a seed.
pub mod fault_line;
/// The hand controller's tapped cable, and what stands in for it.
pub mod handbox;
/// The I2C bus that a projector's controller sits on.
pub mod i2c;
/// The projector's light: LED currents over I2C, and what they are in cd/m2.
pub mod light;
/// The telescope's mount: an LX200GPS and its dialect.
pub mod mount;
/// A line to a device, and why it failed.
pub mod port;
/// The projector: framebuffer, files, memory, window.
pub mod projector;
/// Pseudo terminals, for simulators.
mod pty;
/// A serial port, or a pty that looks like one.
pub mod serial;
/// A second process that stops the mount if this one dies during a slew.
pub mod supervisor;
/// A bridge that carries a serial line over TCP.
pub mod tcp;
/// Conversations recorded and replayed.
pub mod trace;
