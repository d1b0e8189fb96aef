//! Two stars to align on tonight, and how to align: bright, named, comfortably high, and at least 90 degrees apart.

use super::astrometry::{Astrometry, Reduction};
use super::catalogue::{Catalogue, StarId};
use super::coords::{Airless, Equatorial, Horizontal, J2000, OfDate};
use super::horizon::Horizon;
use super::site::Site;
use super::sun;
use super::time::Moment;
use crate::units::{Angle, Magnitude};

/// How to align, to point more precisely, and to train the drive, in plain words.
pub mod guide;

/// Two stars of an alignment should be at least this far apart (thesis, section 8.4).
pub const APART: Angle = Angle::degrees(90.0);

/// Lower, refraction lifts a star by more than the mount's 2 arcminutes (2.1 arcminutes at 25 degrees: Saemundsson 1986).
pub const LOWEST: Angle = Angle::degrees(25.0);

/// Higher, the azimuth of an alt-azimuth mount is badly determined: an arcminute on the sky is four of azimuth at 75 degrees.
pub const HIGHEST: Angle = Angle::degrees(75.0);

/// Never propose to point nearer to the Sun than this.
const FROM_SUN: Angle = Angle::degrees(40.0);

/// Stars brighter than this are seen without doubt in a finder, from a town too.
const FAINTEST: Magnitude = Magnitude(2.5);

/// A bright star with a name.
#[derive(Debug, Clone, PartialEq)]
pub struct BrightStar {
    /// Its proper name, as the hand controller lists it.
    pub name: String,
    /// V magnitude.
    pub v_mag: f64,
    /// Where it is and how it moves.
    pub astrometry: Astrometry,
}

/// A star of a proposal, as it stands now.
#[derive(Debug, Clone, PartialEq)]
pub struct Proposed {
    /// Its proper name.
    pub name: String,
    /// V magnitude.
    pub v_mag: f64,
    /// Right ascension and declination of date.
    pub position: Equatorial<OfDate>,
    /// Where it stands.
    pub seen: Horizontal<Airless>,
}

/// Two stars to align on.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// The brighter one, to begin with.
    pub first: Proposed,
    /// The other one.
    pub second: Proposed,
    /// How far apart they are: 90 degrees or more.
    pub separation: Angle,
}

/// The named stars of the catalogue that are bright enough to align on, brightest first.
#[must_use]
pub fn bright_stars(catalogue: &Catalogue) -> Vec<BrightStar> {
    let pole = Equatorial::<J2000>::new(Angle::ZERO, Angle::degrees(90.0));
    let found = catalogue.within(&pole, Angle::degrees(180.0), FAINTEST);
    let mut stars: Vec<BrightStar> = found
        .stars
        .iter()
        .filter(|star| matches!(star.id, StarId::Hipparcos(_)))
        .filter_map(|star| {
            let name = catalogue.star_name(star.id).filter(|name| is_proper(name))?;
            Some(BrightStar { name, v_mag: f64::from(star.v_mag), astrometry: star.astrometry })
        })
        .collect();
    stars.sort_by(|a, b| a.v_mag.total_cmp(&b.v_mag));
    stars
}

/// A name, and not a designation such as `alpha Cen` or `61 Cyg`.
fn is_proper(name: &str) -> bool {
    name.chars().next().is_some_and(char::is_uppercase) && !name.chars().any(|c| c.is_ascii_digit())
}

/// The best pairs at a moment, at most `most`, best first: bright stars at middling altitude come first, and no star is in
/// more than two pairs, so that a tree before one of them does not spoil all. Empty if no two fit.
#[must_use]
pub fn propose(stars: &[BrightStar], moment: &Moment, site: &Site, most: usize) -> Vec<Pair> {
    let standing = standing(stars, moment, site);
    let mut pairs: Vec<(f64, Pair)> = Vec::new();
    for (i, first) in standing.iter().enumerate() {
        for second in &standing[i + 1..] {
            let separation = first.position.separation(&second.position);
            if separation >= APART {
                let pair = Pair { first: first.clone(), second: second.clone(), separation };
                pairs.push((burden(first) + burden(second), pair));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut chosen: Vec<Pair> = Vec::new();
    for (_, pair) in pairs {
        let used = |name: &str| chosen.iter().filter(|p| p.first.name == name || p.second.name == name).count();
        if chosen.len() < most && used(&pair.first.name) < 2 && used(&pair.second.name) < 2 {
            chosen.push(pair);
        }
    }
    chosen
}

/// The stars that stand well now.
fn standing(stars: &[BrightStar], moment: &Moment, site: &Site) -> Vec<Proposed> {
    let reduction = Reduction::at(moment);
    let horizon = Horizon::new(&reduction, site);
    let sun = sun::apparent_at(&reduction);
    stars
        .iter()
        .map(|star| {
            let position = reduction.apparent(&star.astrometry);
            Proposed { name: star.name.clone(), v_mag: star.v_mag, position, seen: horizon.airless(&position) }
        })
        .filter(|star| (LOWEST..=HIGHEST).contains(&star.seen.altitude()))
        .filter(|star| star.position.separation(&sun) >= FROM_SUN)
        .collect()
}

/// What speaks against a star: a magnitude weighs as much as 25 degrees away from the comfortable altitude of 50.
fn burden(star: &Proposed) -> f64 {
    star.v_mag + (star.seen.altitude().to_degrees() - 50.0).abs() / 25.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::time::Utc;

    fn stars() -> Vec<BrightStar> {
        bright_stars(Catalogue::embedded())
    }

    #[test]
    fn the_brightest_named_stars_are_the_ones_everybody_knows() {
        let stars = stars();
        let names: Vec<&str> = stars.iter().take(5).map(|star| star.name.as_str()).collect();
        assert_eq!(names[..2], ["Sirius", "Canopus"]);
        assert!(names.contains(&"Arcturus") && names.contains(&"Vega"), "{names:?}");
        assert!(stars.len() > 50, "{}", stars.len());
        assert!(stars.windows(2).all(|two| two[0].v_mag <= two[1].v_mag));
    }

    #[test]
    fn every_pair_is_90_degrees_apart_between_25_and_75_degrees_high_and_away_from_the_sun() {
        let stars = stars();
        let begin = Utc::from_rfc3339("2026-01-01T00:00:00Z").unwrap();
        let mut without = 0;
        for latitude in [-70.0, -35.0, 0.0, 35.0, 60.17, 78.0] {
            let site = Site::new(latitude, 25.0, 0.0).unwrap();
            for hour in 0..96u32 {
                // A step of 91.3 hours walks through all times of day and year.
                let moment = Moment::at(begin.plus_seconds(f64::from(hour) * 91.3 * 3600.0));
                let pairs = propose(&stars, &moment, &site, 3);
                let dark = sun::horizontal(&moment, &site).altitude().to_degrees() < -6.0;
                without += usize::from(dark && pairs.is_empty());
                for pair in pairs {
                    assert!(pair.separation.to_degrees() >= 90.0);
                    assert!(
                        (pair.first.position.separation(&pair.second.position) - pair.separation).abs().to_arcseconds()
                            < 1.0
                    );
                    assert!(pair.first.v_mag <= pair.second.v_mag);
                    for star in [&pair.first, &pair.second] {
                        assert!((25.0..=75.0).contains(&star.seen.altitude().to_degrees()));
                        assert!(star.position.separation(&sun::apparent(&moment)).to_degrees() >= 40.0);
                    }
                }
            }
        }
        assert_eq!(without, 0, "whenever it is dark there are two stars");
    }

    #[test]
    fn the_same_star_is_not_in_every_pair() {
        let site = Site::new(60.17, 24.94, 30.0).unwrap();
        let moment = Moment::at(Utc::from_rfc3339("2026-11-22T20:00:00Z").unwrap());
        let pairs = propose(&stars(), &moment, &site, 3);
        assert_eq!(pairs.len(), 3);
        for pair in &pairs {
            let times = pairs.iter().filter(|p| p.first.name == pair.first.name || p.second.name == pair.first.name);
            assert!(times.count() <= 2);
        }
    }

    #[test]
    fn on_a_november_evening_in_helsinki_capella_is_in_the_east_and_vega_in_the_north_west() {
        let site = Site::new(60.17, 24.94, 30.0).unwrap();
        let moment = Moment::at(Utc::from_rfc3339("2026-11-22T20:00:00Z").unwrap());
        let standing = standing(&stars(), &moment, &site);
        let azimuth =
            |name: &str| standing.iter().find(|star| star.name == name).map(|star| star.seen.azimuth().to_degrees());
        assert!((90.0..180.0).contains(&azimuth("Capella").unwrap()), "{:?}", azimuth("Capella"));
        assert!((270.0..330.0).contains(&azimuth("Vega").unwrap()), "{:?}", azimuth("Vega"));
    }

    #[test]
    fn nothing_fits_and_nothing_is_proposed_when_there_is_one_star() {
        let site = Site::new(60.17, 24.94, 30.0).unwrap();
        let moment = Moment::at(Utc::from_rfc3339("2026-11-22T20:00:00Z").unwrap());
        assert!(propose(&stars()[..1], &moment, &site, 3).is_empty());
        assert!(propose(&[], &moment, &site, 3).is_empty());
    }
}
