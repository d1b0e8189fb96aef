//! SIGTERM, SIGINT, SIGHUP: the session ends as if it had been asked to.

use std::io::Read;
use std::os::unix::net::UnixStream;
use std::thread;

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};

/// Calls `told` at each signal that asks the session to end, from a thread of its own.
///
/// # Errors
/// The system has no more file descriptors.
pub(in crate::cli) fn listen(mut told: impl FnMut() + Send + 'static) -> std::io::Result<()> {
    let (mut heard, said) = UnixStream::pair()?;
    for signal in [SIGTERM, SIGINT, SIGHUP] {
        signal_hook::low_level::pipe::register(signal, said.try_clone()?)?;
    }
    thread::Builder::new().name("signals".into()).spawn(move || {
        let mut byte = [0];
        while heard.read_exact(&mut byte).is_ok() {
            told();
        }
    })?;
    Ok(())
}
