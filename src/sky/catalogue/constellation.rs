//! The constellation of a position, and the constellations' names.

use std::sync::OnceLock;

use glam::DVec3;

use crate::sky::coords::{Equatorial, J2000};

/// The boundaries: right ascension from and to in hours, southern edge in degrees, abbreviation; equinox B1875.
///
/// Source: Roman (1987), PASP 99, 695; CDS catalogue VI/42. The first row that holds a position names its constellation.
static BOUNDARIES: &str = include_str!("data/constellations_roman_1987.txt");

/// Julian date of the Besselian epoch 1875.0.
const B1875: f64 = 2_405_889.258_550_475;

struct Boundary {
    from_h: f64,
    to_h: f64,
    south_deg: f64,
    abbreviation: &'static str,
}

fn boundaries() -> &'static [Boundary] {
    static PARSED: OnceLock<Vec<Boundary>> = OnceLock::new();
    PARSED.get_or_init(|| {
        BOUNDARIES
            .lines()
            .filter(|line| !line.starts_with('#'))
            .filter_map(|line| {
                let mut words = line.split_whitespace();
                Some(Boundary {
                    from_h: words.next()?.parse().ok()?,
                    to_h: words.next()?.parse().ok()?,
                    south_deg: words.next()?.parse().ok()?,
                    abbreviation: words.next()?,
                })
            })
            .collect()
    })
}

/// The IAU abbreviation of the constellation in which a position lies.
///
/// The position is precessed to B1875 by the IAU 2006 precession; the boundaries were drawn with Newcomb's, which differs
/// by some arcseconds.
#[must_use]
pub fn at(position: &Equatorial<J2000>) -> &'static str {
    static MATRIX: OnceLock<[DVec3; 3]> = OnceLock::new();
    let rows = MATRIX.get_or_init(|| sofars::pnp::pmat06(B1875, 0.0).map(DVec3::from));
    let v = position.direction();
    let then: Equatorial<J2000> =
        Equatorial::from_direction(DVec3::new(rows[0].dot(v), rows[1].dot(v), rows[2].dot(v)));
    let (hours, degrees) = (then.ra().to_hours(), then.dec().to_degrees());
    boundaries()
        .iter()
        .find(|row| degrees >= row.south_deg && hours >= row.from_h && hours < row.to_h)
        .map_or("Oct", |row| row.abbreviation)
}

/// Abbreviation, nominative and genitive of the 88 constellations. Source: International Astronomical Union.
pub(super) const NAMES: [(&str, &str, &str); 88] = [
    ("And", "Andromeda", "Andromedae"),
    ("Ant", "Antlia", "Antliae"),
    ("Aps", "Apus", "Apodis"),
    ("Aql", "Aquila", "Aquilae"),
    ("Aqr", "Aquarius", "Aquarii"),
    ("Ara", "Ara", "Arae"),
    ("Ari", "Aries", "Arietis"),
    ("Aur", "Auriga", "Aurigae"),
    ("Boo", "Bootes", "Bootis"),
    ("CMa", "Canis Major", "Canis Majoris"),
    ("CMi", "Canis Minor", "Canis Minoris"),
    ("CVn", "Canes Venatici", "Canum Venaticorum"),
    ("Cae", "Caelum", "Caeli"),
    ("Cam", "Camelopardalis", "Camelopardalis"),
    ("Cap", "Capricornus", "Capricorni"),
    ("Car", "Carina", "Carinae"),
    ("Cas", "Cassiopeia", "Cassiopeiae"),
    ("Cen", "Centaurus", "Centauri"),
    ("Cep", "Cepheus", "Cephei"),
    ("Cet", "Cetus", "Ceti"),
    ("Cha", "Chamaeleon", "Chamaeleontis"),
    ("Cir", "Circinus", "Circini"),
    ("Cnc", "Cancer", "Cancri"),
    ("Col", "Columba", "Columbae"),
    ("Com", "Coma Berenices", "Comae Berenices"),
    ("CrA", "Corona Australis", "Coronae Australis"),
    ("CrB", "Corona Borealis", "Coronae Borealis"),
    ("Crt", "Crater", "Crateris"),
    ("Cru", "Crux", "Crucis"),
    ("Crv", "Corvus", "Corvi"),
    ("Cyg", "Cygnus", "Cygni"),
    ("Del", "Delphinus", "Delphini"),
    ("Dor", "Dorado", "Doradus"),
    ("Dra", "Draco", "Draconis"),
    ("Equ", "Equuleus", "Equulei"),
    ("Eri", "Eridanus", "Eridani"),
    ("For", "Fornax", "Fornacis"),
    ("Gem", "Gemini", "Geminorum"),
    ("Gru", "Grus", "Gruis"),
    ("Her", "Hercules", "Herculis"),
    ("Hor", "Horologium", "Horologii"),
    ("Hya", "Hydra", "Hydrae"),
    ("Hyi", "Hydrus", "Hydri"),
    ("Ind", "Indus", "Indi"),
    ("LMi", "Leo Minor", "Leonis Minoris"),
    ("Lac", "Lacerta", "Lacertae"),
    ("Leo", "Leo", "Leonis"),
    ("Lep", "Lepus", "Leporis"),
    ("Lib", "Libra", "Librae"),
    ("Lup", "Lupus", "Lupi"),
    ("Lyn", "Lynx", "Lyncis"),
    ("Lyr", "Lyra", "Lyrae"),
    ("Men", "Mensa", "Mensae"),
    ("Mic", "Microscopium", "Microscopii"),
    ("Mon", "Monoceros", "Monocerotis"),
    ("Mus", "Musca", "Muscae"),
    ("Nor", "Norma", "Normae"),
    ("Oct", "Octans", "Octantis"),
    ("Oph", "Ophiuchus", "Ophiuchi"),
    ("Ori", "Orion", "Orionis"),
    ("Pav", "Pavo", "Pavonis"),
    ("Peg", "Pegasus", "Pegasi"),
    ("Per", "Perseus", "Persei"),
    ("Phe", "Phoenix", "Phoenicis"),
    ("Pic", "Pictor", "Pictoris"),
    ("PsA", "Piscis Austrinus", "Piscis Austrini"),
    ("Psc", "Pisces", "Piscium"),
    ("Pup", "Puppis", "Puppis"),
    ("Pyx", "Pyxis", "Pyxidis"),
    ("Ret", "Reticulum", "Reticuli"),
    ("Scl", "Sculptor", "Sculptoris"),
    ("Sco", "Scorpius", "Scorpii"),
    ("Sct", "Scutum", "Scuti"),
    ("Ser", "Serpens", "Serpentis"),
    ("Sex", "Sextans", "Sextantis"),
    ("Sge", "Sagitta", "Sagittae"),
    ("Sgr", "Sagittarius", "Sagittarii"),
    ("Tau", "Taurus", "Tauri"),
    ("Tel", "Telescopium", "Telescopii"),
    ("TrA", "Triangulum Australe", "Trianguli Australis"),
    ("Tri", "Triangulum", "Trianguli"),
    ("Tuc", "Tucana", "Tucanae"),
    ("UMa", "Ursa Major", "Ursae Majoris"),
    ("UMi", "Ursa Minor", "Ursae Minoris"),
    ("Vel", "Vela", "Velorum"),
    ("Vir", "Virgo", "Virginis"),
    ("Vol", "Volans", "Volantis"),
    ("Vul", "Vulpecula", "Vulpeculae"),
];

/// The abbreviation in its one spelling, if it is one.
pub(super) fn abbreviation(text: &str) -> Option<&'static str> {
    NAMES.iter().map(|row| row.0).find(|known| known.eq_ignore_ascii_case(text))
}

/// The constellation's full name from its abbreviation; what is no abbreviation is returned as it is.
#[must_use]
pub fn full_name(abbreviation: &str) -> &str {
    NAMES.iter().find(|row| row.0 == abbreviation).map_or(abbreviation, |row| row.1)
}

/// The genitive from the abbreviation, as it stands in "alpha Centauri".
pub(super) fn genitive(abbreviation: &str) -> &str {
    NAMES.iter().find(|row| row.0 == abbreviation).map_or(abbreviation, |row| row.2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Angle;

    /// Stars that bear their constellation's name.
    #[test]
    fn bright_stars_lie_in_their_constellations() {
        for (ra, dec, name) in [
            (101.287, -16.716, "CMa"),
            (279.235, 38.784, "Lyr"),
            (37.955, 89.264, "UMi"),
            (219.902, -60.834, "Cen"),
            (2.097, 29.090, "And"),
            (0.0, -89.9, "Oct"),
            (266.417, -29.008, "Sgr"),
            (114.825, 5.225, "CMi"),
            (236.067, 6.426, "Ser"),
        ] {
            assert_eq!(at(&Equatorial::new(Angle::degrees(ra), Angle::degrees(dec))), name);
        }
    }

    #[test]
    fn all_boundaries_are_read_and_name_a_constellation() {
        assert_eq!(boundaries().len(), 357);
        assert!(boundaries().iter().all(|row| abbreviation(row.abbreviation) == Some(row.abbreviation)));
    }
}
