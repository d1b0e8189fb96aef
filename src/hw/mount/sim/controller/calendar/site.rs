//! The four site memories.

use crate::hw::mount::sim::settings::Settings;

/// The longest name of a site.
const LONGEST: usize = 15;

/// One remembered site. Longitude east positive, as everywhere but on the line.
#[derive(Debug, Clone)]
pub(in super::super) struct Memory {
    name: Vec<u8>,
    pub(in super::super) latitude_deg: f64,
    pub(in super::super) longitude_deg: f64,
}

impl Memory {
    /// The site of the settings, and three as they come from the factory.
    pub(super) fn four(settings: &Settings) -> [Memory; 4] {
        let escapes: &[u8] = if settings.faults.escapes { b"\x1b[2J\x1b[31m" } else { b"" };
        let memory = |name: &[u8], latitude_deg, longitude_deg| Memory {
            name: [escapes, name].concat(),
            latitude_deg,
            longitude_deg,
        };
        let east = settings.site.longitude.to_degrees();
        let east = if settings.faults.longitude_sign { -east } else { east };
        let irvine = |name: &[u8]| memory(name, 33.66, -117.76);
        [
            memory(b"Irvine", settings.site.latitude.to_degrees(), east),
            irvine(b"Site 2"),
            irvine(b"Site 3"),
            irvine(b"Site 4"),
        ]
    }

    pub(super) fn told_name(&self) -> Vec<u8> {
        [&self.name[..], b"#"].concat()
    }

    pub(super) fn rename(&mut self, name: &[u8]) -> Option<()> {
        if name.is_empty() {
            return None;
        }
        self.name = name.iter().copied().take(LONGEST).collect();
        Some(())
    }
}
