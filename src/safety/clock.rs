//! Which clock to believe, and whether it can be believed at all. The Sun's place hangs on it.

use crate::sky::time::Utc;

/// No clock can be right that shows an earlier time than this program's release: 2026-01-01T00:00:00Z. A dead battery in
/// the mount shows 2000 or 2003, a Raspberry Pi without network 1970.
pub const RELEASED: Utc = Utc(1_767_225_600.0);

/// The Sun's place is computed from 1900 on: 1900-01-01T00:00:00Z.
const FIRST: Utc = Utc(-2_208_988_800.0);

/// ... and until 2100-01-01T00:00:00Z.
const LAST: Utc = Utc(4_102_444_800.0);

/// Two clocks further apart than this are shown to disagree.
pub const AGREEMENT_S: f64 = 60.0;

/// The session's clock, and who vouches for it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Clock {
    /// There is none, or none that can be believed.
    #[default]
    Unknown,
    /// Read from a device: this machine or the mount. It may be wrong, so it is held against [`RELEASED`].
    Measured(Utc),
    /// Given by a person (`--time`) or by the simulator: any date is meant as it stands.
    Stated(Utc),
}

/// Why a clock is not believed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ClockError {
    /// Nobody knows the time.
    #[error("date and time are unknown")]
    Unknown,
    /// Earlier than this program.
    #[error("the clock shows {}, before this program was made", .0.to_rfc3339())]
    BeforeRelease(Utc),
    /// Outside the years for which the Sun's place is known here, or not a number.
    #[error("the clock shows {}, outside 1900 to 2100", .0.to_rfc3339())]
    OutOfRange(Utc),
}

impl Clock {
    /// The time, if it can be believed.
    ///
    /// # Errors
    /// Unknown, before this program's release, or beyond the years that are computed here.
    pub fn trusted(&self) -> Result<Utc, ClockError> {
        match *self {
            Clock::Unknown => Err(ClockError::Unknown),
            Clock::Measured(utc) | Clock::Stated(utc) if !(FIRST..LAST).contains(&utc) => {
                Err(ClockError::OutOfRange(utc))
            }
            Clock::Measured(utc) if utc < RELEASED => Err(ClockError::BeforeRelease(utc)),
            Clock::Measured(utc) | Clock::Stated(utc) => Ok(utc),
        }
    }

    /// Chooses between the mount's clock and this machine's, read at the same instant. The mount's is taken when it can be
    /// believed and agrees, or when ours cannot be believed; ours when they disagree, because a mount loses its date with
    /// its battery and a wrong zone is easily keyed in. The second value is how far the mount is ahead, if they disagree.
    #[must_use]
    pub fn chosen(mount: Option<Utc>, ours: Option<Utc>) -> (Clock, Option<f64>) {
        let trusted = |utc: Option<Utc>| utc.and_then(|utc| Clock::Measured(utc).trusted().ok());
        let ahead_s = match (mount, ours) {
            (Some(mount), Some(ours)) => Some(mount.0 - ours.0).filter(|ahead| ahead.abs() > AGREEMENT_S),
            _ => None,
        };
        let clock = match (trusted(mount), trusted(ours)) {
            (Some(mount), None) => Clock::Measured(mount),
            (Some(mount), Some(_)) if ahead_s.is_none() => Clock::Measured(mount),
            (_, Some(ours)) => Clock::Measured(ours),
            (None, None) => Clock::Unknown,
        };
        (clock, ahead_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn utc(text: &str) -> Utc {
        Utc::from_rfc3339(text).unwrap()
    }

    #[test]
    fn the_constants_are_the_dates_they_claim_to_be() {
        assert_eq!(RELEASED, utc("2026-01-01T00:00:00Z"));
        assert_eq!(FIRST, utc("1900-01-01T00:00:00Z"));
        assert_eq!(LAST, utc("2100-01-01T00:00:00Z"));
    }

    #[test]
    fn a_measured_clock_before_the_release_is_refused_and_a_stated_one_is_meant() {
        let past = utc("2003-03-01T00:00:00Z");
        assert_eq!(Clock::Measured(past).trusted(), Err(ClockError::BeforeRelease(past)));
        assert_eq!(Clock::Stated(past).trusted(), Ok(past));
        assert!(matches!(Clock::Stated(Utc(f64::NAN)).trusted(), Err(ClockError::OutOfRange(_))));
        assert!(matches!(Clock::Stated(utc("1600-01-01T00:00:00Z")).trusted(), Err(ClockError::OutOfRange(_))));
        assert_eq!(Clock::Unknown.trusted(), Err(ClockError::Unknown));
    }

    #[test]
    fn the_mounts_clock_is_taken_when_it_agrees_and_ours_when_it_does_not() {
        let (ours, near, far, dead) = (
            utc("2026-11-22T20:00:00Z"),
            utc("2026-11-22T20:00:30Z"),
            utc("2026-11-22T21:00:00Z"),
            utc("2003-01-01T00:00:00Z"),
        );
        assert_eq!(Clock::chosen(Some(near), Some(ours)), (Clock::Measured(near), None));
        assert_eq!(Clock::chosen(Some(far), Some(ours)), (Clock::Measured(ours), Some(3600.0)));
        assert_eq!(Clock::chosen(Some(near), None), (Clock::Measured(near), None));
        assert_eq!(Clock::chosen(Some(near), Some(dead)).0, Clock::Measured(near));
        assert_eq!(Clock::chosen(Some(dead), Some(ours)).0, Clock::Measured(ours));
        assert_eq!(Clock::chosen(Some(dead), None).0, Clock::Unknown);
        assert_eq!(Clock::chosen(None, None), (Clock::Unknown, None));
    }
}
