//! The projector's light. A module's LEDs are off until somebody has measured what they give, and from then on their
//! luminance at the eyepiece is a number in cd/m2.
//!
//! ```text
//! asked cd/m2 --plan--> LED current codes, pixel gain, filter to insert --Controller--> I2cBus
//! ```

use crate::hw::i2c::{BusAddress, I2cBus, I2cError, linux};

/// What the light costs dark-adapted eyes.
pub mod adaptation;
/// What somebody measured.
pub mod calibration;
/// The controller of the LEDs.
pub mod controller;
/// Why the light is not as it was asked.
pub mod error;
/// A made-up controller, with faults.
pub mod fake;
/// A second process that makes it dark if this one is killed.
pub mod guard;
/// A calibrated lamp.
pub mod lamp;
/// The families of modules.
pub mod module;
/// From cd/m2 to currents, pixel gain and filter.
pub mod plan;
/// Settings as bytes.
pub mod wire;

pub use calibration::Calibration;
pub use controller::Controller;
pub use error::LightError;
pub use lamp::Lamp;
pub use module::Module;
pub use plan::{Plan, plan};

/// Opens the bus at an address; a made-up one gets a module of this family.
///
/// # Errors
/// It is not there, or not ours.
pub fn open_bus(address: &BusAddress, module: Module) -> Result<Box<dyn I2cBus>, I2cError> {
    Ok(match address {
        BusAddress::Device(path) => Box::new(linux::LinuxBus::open(path, module::ADDRESS)?),
        #[cfg(feature = "pi")]
        BusAddress::Pi(number) => Box::new(crate::hw::i2c::pi::PiBus::open(*number)?),
        #[cfg(not(feature = "pi"))]
        BusAddress::Pi(number) => {
            Box::new(linux::LinuxBus::open(format!("/dev/i2c-{number}").as_ref(), module::ADDRESS)?)
        }
        BusAddress::Fake(path) => Box::new(fake::stored::StoredBus::open(path, module)?),
    })
}
