//! `fake:FILE`: a made-up controller whose registers are kept in a file, like a real one keeps them in its chip. They outlive
//! the program, however it dies, so that another one can see whether the LEDs were left on, or switch them off.
//!
//! The file is JSON, read before and written (beside, then renamed) after every transaction; who reads it sees a whole state.
//! A file that is not there is a module just switched on. Faults can be put into it by hand.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use rustix::fs::{FlockOperation, flock};

use super::{FakeModule, Faults};
use crate::hw::i2c::{I2cBus, I2cError};
use crate::hw::light::module::Module;

/// Larger files are none of ours.
const LARGEST_BYTES: u64 = 1 << 20;

fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(suffix);
    name.into()
}

/// A bus whose only module lives in a file.
#[derive(Debug)]
pub struct StoredBus {
    path: PathBuf,
    lock: File,
}

impl StoredBus {
    /// Opens the file, or begins it with a module of this family just switched on.
    ///
    /// # Errors
    /// It cannot be read or written, or holds something else.
    pub fn open(path: &Path, module: Module) -> Result<StoredBus, I2cError> {
        let opening = |why: String| I2cError::Open { bus: format!("fake:{}", path.display()), why };
        let beside = with_suffix(path, ".lock");
        let lock = File::options().create(true).truncate(false).write(true).open(beside);
        let bus = StoredBus { path: path.into(), lock: lock.map_err(|error| opening(error.to_string()))? };
        bus.locked(|| match bus.load()? {
            Some(_) => Ok(()),
            None => bus.save(&FakeModule::new(module, Faults::default())),
        })
        .map_err(|error| opening(error.to_string()))?;
        Ok(bus)
    }

    /// The module in a file, for whoever wants to look.
    ///
    /// # Errors
    /// It is not there or holds something else.
    pub fn look(path: &Path) -> io::Result<FakeModule> {
        if fs::metadata(path)?.len() > LARGEST_BYTES {
            return Err(io::Error::other("it is too large for the state of a module"));
        }
        serde_json::from_slice(&fs::read(path)?).map_err(io::Error::other)
    }

    fn load(&self) -> io::Result<Option<FakeModule>> {
        match StoredBus::look(&self.path) {
            Ok(module) => Ok(Some(module)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error),
        }
    }

    fn save(&self, module: &FakeModule) -> io::Result<()> {
        let beside = with_suffix(&self.path, ".new");
        fs::write(&beside, serde_json::to_vec_pretty(module).map_err(io::Error::other)?)?;
        fs::rename(&beside, &self.path)
    }

    /// Does something while no other program does anything to the file.
    fn locked<T>(&self, what: impl FnOnce() -> io::Result<T>) -> io::Result<T> {
        flock(&self.lock, FlockOperation::LockExclusive)?;
        let done = what();
        flock(&self.lock, FlockOperation::Unlock)?;
        done
    }

    fn transact(&self, what: impl FnOnce(&mut FakeModule) -> Result<(), I2cError>) -> Result<(), I2cError> {
        self.locked(|| {
            let mut module = self.load()?.ok_or(io::ErrorKind::NotFound)?;
            let done = what(&mut module);
            self.save(&module)?;
            Ok(done)
        })
        .map_err(|error| I2cError::Gone { bus: self.describe(), why: error.to_string() })?
    }
}

impl I2cBus for StoredBus {
    fn write(&mut self, address: u8, bytes: &[u8]) -> Result<(), I2cError> {
        self.transact(|module| module.write(address, bytes))
    }

    fn read(&mut self, address: u8, buffer: &mut [u8]) -> Result<(), I2cError> {
        self.transact(|module| module.read(address, buffer))
    }

    fn describe(&self) -> String {
        format!("fake:{}", self.path.display())
    }
}
