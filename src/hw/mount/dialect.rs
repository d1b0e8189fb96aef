//! How mounts of one family differ from another, as a value: no parser asks which mount it reads.

/// What may be relied upon with a mount.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dialect {
    /// The family's name.
    pub name: &'static str,
    /// Whether `:G0#` answers a lone `#` at once, so that a silent command can be fenced with it.
    pub fence: bool,
    /// Whether `:GW#` tells alignment and tracking.
    pub status: bool,
    /// Whether the hand controller can be read and pressed (`:ED#`, `:EK#`).
    pub handset: bool,
}

impl Dialect {
    /// Product `LX2001`.
    pub const LX200GPS: Dialect = Dialect { name: "LX200GPS", fence: true, status: true, handset: true };
    /// Other Autostars and what imitates them: identity, status and handset, but no fence.
    pub const AUTOSTAR: Dialect = Dialect { name: "Autostar", fence: false, status: true, handset: true };
    /// The LX200 of 1992 and most home-made mounts: they do not say who they are.
    pub const CLASSIC: Dialect = Dialect { name: "LX200 classic", fence: false, status: false, handset: false };

    /// The dialect of a mount by the answer to `:GVP#`, or of one that keeps silent to it.
    #[must_use]
    pub fn of(product: Option<&str>) -> Dialect {
        match product {
            Some("LX2001") => Dialect::LX200GPS,
            Some(_) => Dialect::AUTOSTAR,
            None => Dialect::CLASSIC,
        }
    }
}
