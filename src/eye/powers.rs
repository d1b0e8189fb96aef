//! Which magnifications show an object best: a range, because the peak is flat, and the best of the eyepieces owned.

use super::{Model, Patch, Reading, Viewing};
use crate::units::SurfaceBrightness;

/// Powers whose reserve comes so near to the greatest, in powers of ten, show an object as well.
const FLAT_DEX: f64 = 0.1;

/// From this reserve on an object is very easy, and more contrast is no reason for another power.
const ENOUGH_DEX: f64 = 1.0;

/// So many times an object's width the field should show.
const ROOM: f64 = 1.25;

/// No exit pupil is narrower: below it the eye's own floaters and the diffraction of the aperture are what is seen, mm.
const NARROWEST_PUPIL_MM: f64 = 0.5;

/// A blur of so many arcminutes at the eye is seen as soft.
const SOFT_ARCMIN: f64 = 4.0;

/// Seeing of an ordinary night, arcseconds.
const SEEING_ARCSEC: f64 = 2.0;

/// An eyepiece as this choice needs it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// Magnification.
    pub magnification: f64,
    /// Diameter of the sky that it shows, arcminutes.
    pub true_field_arcmin: f64,
}

/// What is useful for one object.
#[derive(Debug, Clone, PartialEq)]
pub struct Powers {
    /// Lowest and highest useful magnification, if there is any at which the object can be seen.
    pub range: Option<(f64, f64)>,
    /// Which of the eyepieces are useful: indices, in the order in which they were given.
    pub useful: Vec<usize>,
    /// The best of them; if none is useful, the one with the greatest reserve.
    pub best: Option<usize>,
    /// Reserve with the best.
    pub best_reserve: Option<f64>,
    /// Whether the object is wider than every field leaves room for.
    pub overflows: bool,
}

/// The magnification from which the seeing of an ordinary night, 2 arcseconds, shows as softness: 120.
#[must_use]
pub fn soft_from() -> f64 {
    SOFT_ARCMIN * 60.0 / SEEING_ARCSEC
}

/// Finds the useful magnifications of an object and the best of the eyepieces.
///
/// Useful are those within 0.1 dex of the greatest reserve (or of 1, where it is greater), above the threshold, with an exit pupil no wider than the eye's
/// and no narrower than 0.5 mm, whose field is 1.25 times as wide as the object. (With what the mean of a galaxy says; its core
/// bears more.) Of the useful eyepieces the best is the one of the greatest reserve among those under [`soft_from`]; if all are
/// above, the lowest.
///
/// Carlin's argument (bbastrodesigns.com/blackwel.html) is in the reserve: along the powers size and background move together.
#[must_use]
pub fn useful(object: &Patch, viewing: &Viewing, sky: SurfaceBrightness, model: Model, owned: &[Choice]) -> Powers {
    let reserve =
        |magnification: f64| Reading::of(object, &Viewing { magnification, ..*viewing }, sky, model).reserve();
    let lowest = viewing.aperture_mm / viewing.pupil_mm;
    let highest = (viewing.aperture_mm / NARROWEST_PUPIL_MM).max(lowest);

    // Sample the reserve along all powers that the exit pupil allows.
    const STEPS: u32 = 200;
    let at = |step: u32| lowest * (highest / lowest).powf(f64::from(step) / f64::from(STEPS));
    let samples: Vec<(f64, f64)> = (0..=STEPS).map(|step| (at(step), reserve(at(step)))).collect();
    let greatest = samples.iter().map(|sample| sample.1).fold(f64::NEG_INFINITY, f64::max);
    let good = |reserve: f64, greatest: f64| reserve > 0.0 && reserve >= greatest.min(ENOUGH_DEX) - FLAT_DEX;
    let mut good_powers = samples.iter().filter(|sample| good(sample.1, greatest)).map(|sample| sample.0);
    let range = good_powers.next().map(|first| (first, good_powers.next_back().unwrap_or(first)));

    // Hold the eyepieces against it: first those that show the whole object, else all.
    let shows_all = |choice: &Choice| choice.true_field_arcmin >= ROOM * object.major_arcmin;
    let overflows = !owned.iter().any(shows_all);
    let pupil_fits = |choice: &Choice| (lowest * 0.999..=highest * 1.001).contains(&choice.magnification);
    let candidates = owned.iter().enumerate().filter(|(_, choice)| overflows || shows_all(choice));
    let candidates: Vec<(usize, f64, f64)> = candidates
        .filter(|(_, choice)| pupil_fits(choice))
        .map(|(index, choice)| (index, choice.magnification, reserve(choice.magnification)))
        .collect();
    let peak = candidates.iter().map(|candidate| candidate.2).fold(f64::NEG_INFINITY, f64::max);
    let useful: Vec<&(usize, f64, f64)> = candidates.iter().filter(|candidate| good(candidate.2, peak)).collect();
    let calm = useful.iter().filter(|candidate| candidate.1 <= soft_from()).max_by(|a, b| a.2.total_cmp(&b.2));
    let lowest_power = useful.iter().min_by(|a, b| a.1.total_cmp(&b.1));
    let best = calm.or(lowest_power).copied().or(candidates.iter().max_by(|a, b| a.2.total_cmp(&b.2)));
    Powers {
        range,
        useful: useful.iter().map(|candidate| candidate.0).collect(),
        best: best.map(|candidate| candidate.0),
        best_reserve: best.map(|candidate| candidate.2),
        overflows,
    }
}

/// No higher power shows a planet better under [`SEEING_ARCSEC`]: they would be 8 arcminutes at the eye.
const MOST_POWER: f64 = 250.0;

/// So many times its width the field should show of a bright disc.
const ROOM_OF_DISC: f64 = 1.1;

/// The powers of Moon and planets: bright discs bear any, so the best eyepiece is not the model's but the highest power up to
/// 250 (and an exit pupil of 0.5 mm) whose field shows the whole disc; without one, the lowest. A documented rule, not a model.
#[must_use]
pub fn of_disc(disc: &Patch, viewing: &Viewing, sky: SurfaceBrightness, owned: &[Choice]) -> Powers {
    let most = MOST_POWER.min(viewing.aperture_mm / NARROWEST_PUPIL_MM);
    let lowest = (viewing.aperture_mm / viewing.pupil_mm).min(most);
    let reserve_at =
        |magnification| Reading::of(disc, &Viewing { magnification, ..*viewing }, sky, Model::Crumey).reserve();
    let shows_all = |choice: &Choice| choice.true_field_arcmin >= ROOM_OF_DISC * disc.major_arcmin;
    let fits = |choice: &Choice| choice.magnification <= most * 1.001 && shows_all(choice);
    let useful: Vec<usize> = (0..owned.len()).filter(|index| fits(&owned[*index])).collect();
    let by_power = |a: &usize, b: &usize| owned[*a].magnification.total_cmp(&owned[*b].magnification);
    let best = useful.iter().copied().max_by(by_power).or_else(|| (0..owned.len()).min_by(by_power));
    let best_reserve = best.map(|index| reserve_at(owned[index].magnification)).filter(|reserve| !reserve.is_nan());
    Powers { range: Some((lowest, most)), overflows: !owned.iter().any(shows_all), useful, best, best_reserve }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The thesis' eyepieces: 32, 24, 15, 10 and 5 mm at 2500 mm.
    const OWNED: [Choice; 5] = [
        Choice { magnification: 78.125, true_field_arcmin: 37.1 },
        Choice { magnification: 104.17, true_field_arcmin: 37.1 },
        Choice { magnification: 166.7, true_field_arcmin: 18.7 },
        Choice { magnification: 250.0, true_field_arcmin: 12.5 },
        Choice { magnification: 500.0, true_field_arcmin: 9.6 },
    ];

    fn powers(object: &Patch, sky: f64, model: Model) -> Powers {
        useful(object, &Viewing::typical(254.0, 100.0), SurfaceBrightness(sky), model, &OWNED)
    }

    #[test]
    fn the_peak_of_the_ring_nebula_is_flat_and_peaks_where_the_table_says() {
        // Reserves 1.176, 1.182 and 1.147 at 78, 104 and 200 times under 18.5: all within 0.1, the best 104.
        let m57 = Patch { v_mag: 8.8, major_arcmin: 1.4, minor_arcmin: 1.0 };
        let found = powers(&m57, 18.5, Model::Blackwell);
        assert_eq!((found.best, found.overflows), (Some(1), false));
        // At 500 times 0.97: still very easy, and the field is wide enough.
        assert_eq!(found.useful, [0, 1, 2, 3, 4]);
        assert!((found.best_reserve.unwrap() - 1.182).abs() < 1e-3);
        let (low, high) = found.range.unwrap();
        assert!(low < 78.0 && high > 500.0, "{low} {high}");
    }

    #[test]
    fn a_faint_disc_is_best_within_a_tenth_of_its_greatest_reserve() {
        // The Owl under 20.5, Blackwell: 0.671 at 78, 0.427 at 200, 0.234 at 300 times.
        let m97 = Patch { v_mag: 9.9, major_arcmin: 3.4, minor_arcmin: 3.3 };
        let found = powers(&m97, 20.5, Model::Blackwell);
        assert_eq!((found.best, found.useful), (Some(0), vec![0, 1]));
        let (low, high) = found.range.unwrap();
        assert!(low < 78.0 && (104.0..200.0).contains(&high), "{low} {high}");
    }

    #[test]
    fn the_andromeda_galaxy_wants_the_lowest_power_and_overflows_every_field() {
        let m31 = Patch { v_mag: 3.4, major_arcmin: 190.0, minor_arcmin: 60.0 };
        let found = powers(&m31, 21.5, Model::Crumey);
        assert_eq!((found.best, found.overflows), (Some(0), true));
        assert!(found.range.unwrap().0 < 40.0);
    }

    #[test]
    fn what_cannot_be_seen_has_no_useful_power_but_a_least_hopeless_one() {
        let faint = Patch { v_mag: 14.0, major_arcmin: 10.0, minor_arcmin: 10.0 };
        let found = powers(&faint, 18.5, Model::Crumey);
        assert_eq!((found.range, found.useful.len()), (None, 0));
        assert!(found.best.is_some() && found.best_reserve.unwrap() < 0.0);
    }

    #[test]
    fn an_empty_case_has_no_best() {
        let m57 = Patch { v_mag: 8.8, major_arcmin: 1.4, minor_arcmin: 1.0 };
        let found = useful(&m57, &Viewing::typical(254.0, 1.0), SurfaceBrightness(20.0), Model::Crumey, &[]);
        assert_eq!((found.best, found.useful.len()), (None, 0));
    }
}
