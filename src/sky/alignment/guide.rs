//! How to align, to point more precisely, and to train the drive: plain words for a screen, with the numbers in one place.
//!
//! Sources: thesis, section 8.4, after Meade's LX200GPS manual (2003) for pointing and Greiner (1998) for the periodic
//! error. The hand controller's menus differ a little between firmware versions.

/// The mount's pointing after a good alignment, as its maker states it: arcminutes.
pub const POINTING_ARCMIN: f64 = 2.0;

/// Periodic error training looks at the worm in so many intervals...
pub const PEC_INTERVALS: u32 = 200;

/// ... of so many seconds: together one turn of the worm, 8 minutes.
pub const PEC_INTERVAL_S: f64 = 2.4;

/// Peak to peak tracking error before training: arcseconds.
pub const PEC_BEFORE_ARCSEC: f64 = 25.0;

/// Peak to peak tracking error after training: arcseconds.
pub const PEC_AFTER_ARCSEC: f64 = 5.0;

/// One thing explained.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Guide {
    /// Its name.
    pub title: &'static str,
    /// When it is needed and what it brings.
    pub why: String,
    /// What to do, one step after the other.
    pub steps: Vec<String>,
    /// Where the numbers come from.
    pub source: &'static str,
}

/// Aligning on two stars.
#[must_use]
pub fn two_star_alignment() -> Guide {
    Guide {
        title: "Two-star alignment",
        why: format!(
            "The mount finds level and magnetic north by itself, but magnetic north is not true north and iron bends it. Two \
             stars, centred well and at least 90° apart, tell it where the sky is: it then points within about \
             {POINTING_ARCMIN:.0}′. Every {POINTING_ARCMIN:.0}′ are a hundred pixels of the picture in the eyepiece."
        ),
        steps: vec![
            "Wait until the mount has finished its own start (level, north, GPS).".into(),
            "On the hand controller: SETUP > ALIGN > TWO STAR, and choose the first star proposed here.".into(),
            "Centre it in an eyepiece of short focal length, best one with a lit crosshair. Come from the same side each time; \
             press ENTER."
                .into(),
            "Choose the second star proposed here, centre it in the same way, press ENTER.".into(),
            "Go to any bright object: it should stand near the middle. If not, begin again with two other stars.".into(),
        ],
        source: "Meade LX200GPS manual, 2003; thesis 8.4",
    }
}

/// High precision pointing.
#[must_use]
pub fn high_precision() -> Guide {
    Guide {
        title: "High precision pointing",
        why: "When two arcminutes are too many. Before each go-to the mount stops at a bright star near the object; you centre it, \
              and the short way from there is much more exact. It costs a minute for each object."
            .into(),
        steps: vec![
            "On the hand controller: SETUP > TELESCOPE > HIGH PRECISION > ON.".into(),
            "Go to the object from here, as always: the mount goes to a star first and its hand controller asks you to centre it."
                .into(),
            "Centre the star with the arrow keys and press ENTER: it goes on to the object.".into(),
            "If a go-to seems never to end, look at the hand controller: it waits for that ENTER.".into(),
        ],
        source: "Meade LX200GPS manual, 2003; thesis 8.4",
    }
}

/// Training of the periodic error correction.
#[must_use]
pub fn periodic_error() -> Guide {
    let minutes = f64::from(PEC_INTERVALS) * PEC_INTERVAL_S / 60.0;
    Guide {
        title: "Periodic error correction (PEC)",
        why: format!(
            "The worm that turns the mount is not quite round: in each of its turns of {minutes:.0} minutes the picture wanders \
             by up to {PEC_BEFORE_ARCSEC:.0}″ and back. The mount can learn this and undo it: {PEC_INTERVALS} intervals of \
             {PEC_INTERVAL_S} s, after which {PEC_AFTER_ARCSEC:.0}″ or less remain. It is remembered over power-off, and worth \
             doing once for each mount."
        ),
        steps: vec![
            "Align first. Choose a star of middle brightness near the celestial equator, not low.".into(),
            "Centre it at high magnification with a lit crosshair.".into(),
            "On the hand controller: SETUP > TELESCOPE > RA PEC > TRAIN.".into(),
            format!(
                "For {minutes:.0} minutes keep the star on the crosshair with the arrow keys, at guide speed, with small touches."
            ),
            "Train once or twice more with UPDATE: the mean is better than one. Then set it to ON.".into(),
        ],
        source: "Greiner, 1998, and Meade LX200GPS manual, 2003, in thesis 8.4 and figure 8.4",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worm_turns_once_in_eight_minutes() {
        assert!((f64::from(PEC_INTERVALS) * PEC_INTERVAL_S / 60.0 - 8.0).abs() < 1e-12);
        let guide = periodic_error();
        for number in ["8 minutes", "200 intervals", "2.4 s", "25″", "5″"] {
            assert!(guide.why.contains(number), "{number} is missing: {}", guide.why);
        }
    }

    #[test]
    fn each_guide_says_why_how_and_whence() {
        for guide in [two_star_alignment(), high_precision(), periodic_error()] {
            assert!(
                guide.why.len() > 80 && guide.steps.len() >= 4 && guide.source.contains("thesis 8.4"),
                "{}",
                guide.title
            );
        }
        assert!(two_star_alignment().why.contains("90° apart"));
    }
}
