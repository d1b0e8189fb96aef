//! Rig files, that a person edits: one that is taken names no port twice and moves nothing that has no power.

use std::collections::BTreeSet;

use scotopic::cli::rig::Rig;

use super::assert_harmless;

/// Checks one input.
///
/// # Panics
/// Something does not hold.
pub fn check(data: &[u8]) {
    let Ok(text) = str::from_utf8(data) else { return };
    let rig = match Rig::from_toml(text) {
        Ok(rig) => rig,
        Err(error) => return assert_harmless(&error.to_string()),
    };
    let ports = rig.ports();
    let different: BTreeSet<&str> = ports.iter().map(|(_, port)| *port).collect();
    assert_eq!(different.len(), ports.len(), "a port twice: {ports:?}");
    assert!(ports.iter().all(|(_, port)| !port.starts_with("/dev/ttyUSB")), "a passing name: {ports:?}");
    assert!(rig.mount.is_none_or(|mount| mount.motors || !mount.may_move), "it moves without motors");
}
