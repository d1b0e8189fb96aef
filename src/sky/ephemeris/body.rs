//! The bodies of the solar system that the ephemeris knows.

/// A body of the solar system that is shown as a disc.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Body {
    /// The Sun.
    Sun,
    /// The Earth's Moon.
    Moon,
    /// Mercury.
    Mercury,
    /// Venus.
    Venus,
    /// Mars.
    Mars,
    /// Jupiter.
    Jupiter,
    /// Saturn.
    Saturn,
    /// Uranus.
    Uranus,
    /// Neptune.
    Neptune,
}

impl Body {
    /// All of them, from the Sun outwards (the Moon after the Sun).
    pub const ALL: [Body; 9] = [
        Body::Sun,
        Body::Moon,
        Body::Mercury,
        Body::Venus,
        Body::Mars,
        Body::Jupiter,
        Body::Saturn,
        Body::Uranus,
        Body::Neptune,
    ];

    /// The English name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Body::Sun => "Sun",
            Body::Moon => "Moon",
            Body::Mercury => "Mercury",
            Body::Venus => "Venus",
            Body::Mars => "Mars",
            Body::Jupiter => "Jupiter",
            Body::Saturn => "Saturn",
            Body::Uranus => "Uranus",
            Body::Neptune => "Neptune",
        }
    }

    /// The body of this name, whatever its case; "the Moon" is the Moon.
    #[must_use]
    pub fn from_name(text: &str) -> Option<Body> {
        let text = text.trim();
        let text = text.strip_prefix("the ").or_else(|| text.strip_prefix("The ")).unwrap_or(text);
        Body::ALL.into_iter().find(|body| body.name().eq_ignore_ascii_case(text))
    }

    /// What sort of thing it is, in words.
    #[must_use]
    pub const fn type_words(self) -> &'static str {
        match self {
            Body::Sun => "star",
            Body::Moon => "moon",
            _ => "planet",
        }
    }

    /// Equatorial radius in kilometres: IAU working group (Archinal et al. 2018), the gas giants at 1 bar; the Moon's is the
    /// mean radius, the Sun's that of its photosphere (695700 km, IAU 2015 B3).
    #[must_use]
    pub const fn equatorial_radius_km(self) -> f64 {
        match self {
            Body::Sun => 695_700.0,
            Body::Moon => 1737.4,
            Body::Mercury => 2440.53,
            Body::Venus => 6051.8,
            Body::Mars => 3396.19,
            Body::Jupiter => 71_492.0,
            Body::Saturn => 60_268.0,
            Body::Uranus => 25_559.0,
            Body::Neptune => 24_764.0,
        }
    }

    /// Polar radius in kilometres (Archinal et al. 2018).
    #[must_use]
    pub const fn polar_radius_km(self) -> f64 {
        match self {
            Body::Mercury => 2438.26,
            Body::Mars => 3376.20,
            Body::Jupiter => 66_854.0,
            Body::Saturn => 54_364.0,
            Body::Uranus => 24_973.0,
            Body::Neptune => 24_341.0,
            round => round.equatorial_radius_km(),
        }
    }
}

impl std::fmt::Display for Body {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}
