//! What sort of thing an object is: OpenNGC's types, and a star.

/// The sort of an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A single star (or one whose companions the catalogue does not tell).
    Star,
    /// Two stars, listed by Dreyer as one object.
    DoubleStar,
    /// An association of stars.
    Association,
    /// An open cluster.
    OpenCluster,
    /// A globular cluster.
    GlobularCluster,
    /// An open cluster in its nebula.
    ClusterWithNebula,
    /// A galaxy.
    Galaxy,
    /// Two galaxies.
    GalaxyPair,
    /// Three galaxies.
    GalaxyTriplet,
    /// Four galaxies or more.
    GalaxyGroup,
    /// A planetary nebula.
    PlanetaryNebula,
    /// A region of ionised hydrogen.
    HiiRegion,
    /// A dark nebula.
    DarkNebula,
    /// A nebula that shines by itself.
    EmissionNebula,
    /// A nebula of which no more is said.
    Nebula,
    /// A nebula that shines by the light of a star.
    ReflectionNebula,
    /// What a supernova left.
    SupernovaRemnant,
    /// A nova.
    Nova,
    /// The Sun, the Moon or a planet: not of the catalogue.
    SolarSystem,
    /// Something else, or a star that Dreyer took for a nebula.
    Other,
}

/// Every kind with OpenNGC's code for it and its name in plain words.
const TABLE: [(Kind, &str, &str); 20] = [
    (Kind::Star, "*", "star"),
    (Kind::DoubleStar, "**", "double star"),
    (Kind::Association, "*Ass", "association of stars"),
    (Kind::OpenCluster, "OCl", "open cluster"),
    (Kind::GlobularCluster, "GCl", "globular cluster"),
    (Kind::ClusterWithNebula, "Cl+N", "cluster with nebula"),
    (Kind::Galaxy, "G", "galaxy"),
    (Kind::GalaxyPair, "GPair", "pair of galaxies"),
    (Kind::GalaxyTriplet, "GTrpl", "triplet of galaxies"),
    (Kind::GalaxyGroup, "GGroup", "group of galaxies"),
    (Kind::PlanetaryNebula, "PN", "planetary nebula"),
    (Kind::HiiRegion, "HII", "HII region"),
    (Kind::DarkNebula, "DrkN", "dark nebula"),
    (Kind::EmissionNebula, "EmN", "emission nebula"),
    (Kind::Nebula, "Neb", "nebula"),
    (Kind::ReflectionNebula, "RfN", "reflection nebula"),
    (Kind::SupernovaRemnant, "SNR", "supernova remnant"),
    (Kind::Nova, "Nova", "nova"),
    (Kind::SolarSystem, "Sol", "body of the solar system"),
    (Kind::Other, "Other", "object of another sort"),
];

impl Kind {
    /// From OpenNGC's code; an unknown code is [`Kind::Other`].
    #[must_use]
    pub fn from_code(code: &str) -> Kind {
        TABLE.iter().find(|row| row.1 == code).map_or(Kind::Other, |row| row.0)
    }

    /// OpenNGC's code: `G`, `PN`, `OCl`...
    #[must_use]
    pub fn code(self) -> &'static str {
        TABLE.iter().find(|row| row.0 == self).map_or("Other", |row| row.1)
    }

    /// All of them.
    pub fn all() -> impl Iterator<Item = Kind> {
        TABLE.iter().map(|row| row.0)
    }

    /// From its plain words.
    #[must_use]
    pub fn from_words(words: &str) -> Option<Kind> {
        TABLE.iter().find(|row| row.2 == words).map(|row| row.0)
    }

    /// In plain words: "planetary nebula".
    #[must_use]
    pub fn words(self) -> &'static str {
        TABLE.iter().find(|row| row.0 == self).map_or("object of another sort", |row| row.2)
    }
}
